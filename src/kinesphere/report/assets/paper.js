/* On paper: light, every chart drawn, everything unfolded; afterwards as it was. */
function onPaper(paint) {
  addEventListener("beforeprint", () => {
    document.documentElement.classList.add("paper");
    document.querySelectorAll("details:not([open])").forEach((one) => {
      one.open = true;
      one.dataset.folded = "";
    });
    paint();
  });
  addEventListener("afterprint", () => {
    document.documentElement.classList.remove("paper");
    document.querySelectorAll("details[data-folded]").forEach((one) => {
      one.open = false;
      delete one.dataset.folded;
    });
    paint();
  });
}
