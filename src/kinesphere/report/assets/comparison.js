"use strict";
/* Chooses which figures are shown, and reads both values under the pointer from the lines
   themselves: their coordinates are seconds and (downward) degrees. */
const figures = [...document.querySelectorAll("[data-joint]")];
const joint = document.getElementById("joint");
const kinds = [...document.querySelectorAll("button[data-kind]")];
function choose() {
  const wanted = new Set(
    kinds.filter((b) => b.getAttribute("aria-pressed") === "true").map((b) => b.dataset.kind),
  );
  let shown = 0;
  for (const figure of figures) {
    const { joint: name, kind } = figure.dataset;
    figure.hidden = (joint.value !== "" && name !== joint.value) || !wanted.has(kind);
    shown += figure.hidden ? 0 : 1;
  }
  document.getElementById("empty").hidden = shown > 0;
}
joint.addEventListener("change", choose);
for (const button of kinds) {
  button.addEventListener("click", () => {
    button.setAttribute("aria-pressed", button.getAttribute("aria-pressed") !== "true");
    choose();
  });
}
function valueAt(plot, css, time) {
  let best = null;
  for (const line of plot.querySelectorAll(`polyline.${css}`)) {
    for (const point of line.points) {
      const apart = Math.abs(point.x - time);
      if (best === null || apart < best.apart) best = { apart, value: -point.y, time: point.x };
    }
  }
  return best;
}
function read(plot, event) {
  const box = plot.getBoundingClientRect();
  const view = plot.querySelector("svg").viewBox.baseVal;
  const share = Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1);
  const time = view.x + share * view.width;
  for (const figure of figures) {
    if (figure.hidden) continue;
    const other = figure.querySelector("[data-curves]");
    const cursor = other.querySelector(".cursor");
    cursor.hidden = false;
    cursor.style.left = `${100 * share}%`;
    const [one, two] = [valueAt(other, "one", time), valueAt(other, "two", time)];
    const said = (found) => (found ? `${found.value.toFixed(1)}°` : "–");
    figure.querySelector(".read").textContent =
      `${time.toFixed(2)} s: first ${said(one)}, second ${said(two)}`;
  }
}
for (const plot of document.querySelectorAll("[data-curves]")) {
  plot.addEventListener("pointermove", (event) => read(plot, event));
  plot.addEventListener("pointerleave", () => {
    for (const figure of figures) {
      figure.querySelector(".cursor").hidden = true;
      figure.querySelector(".read").textContent = "";
    }
  });
}
choose();
