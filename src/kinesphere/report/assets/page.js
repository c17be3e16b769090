/* Ties player, curves and time line to one clock. */
const $ = (selector) => document.querySelector(selector);

function themeFromStyles() {
  const styles = getComputedStyle(document.documentElement);
  const read = (name) => styles.getPropertyValue(`--${name}`).trim();
  const rgb = (name) => read(name).split(",").map(Number);
  return {
    text: read("text"), dim: read("dim"), faint: read("faint"), card: read("card"),
    rule: read("rule"), zero: read("zero"), grid: read("grid"), accent: read("accent"),
    measured: read("measured"),
    gap: read("gap"), improbable: read("improbable"), mesh: rgb("mesh").map((c) => c / 255),
    meshPicked: rgb("mesh-picked").map((c) => c / 255),
    shadow: read("shadow"), outline: read("outline"), marker: read("marker"),
    series: ["axis1", "axis2", "axis3", "twist", "residual"].map(read),
    frame: ["frame-x", "frame-y", "frame-z"].map(read),
    bones: Object.fromEntries(
      ["left", "right", "middle"].map((s) => [s, [read(`${s}-light`), read(`${s}-dark`)]])),
    heat: ["heat-0", "heat-1", "heat-2", "heat-3"].map(rgb),
    empty: rgb("heat-none"),
    flags: Object.fromEntries(
      ["unseen", "unreachable", "singular", "twist_unknown", "filled", "dislocated"].map((f) => [
        f, read(`flag-${f.replace("_", "-")}`)])),
  };
}

async function start() {
  const scene = JSON.parse($("#scene").textContent);
  const names = Object.keys(scene.arrays);
  const arrays = await Promise.all(names.map((name) => unpack(scene.arrays[name])));
  const data = Object.fromEntries(names.map((name, i) => [name, arrays[i]]));
  const theme = themeFromStyles();
  const last = Math.max(0, scene.n_frames - 1);
  const view = new TimeView(last / scene.rate);
  const player = new Player($("#stage"), scene, data, theme);
  $("#stage").player = player; // for whoever scripts the page
  const charts = [...document.querySelectorAll(".chart")].map(
    (element) => new Chart(element, Number(element.dataset.joint), scene, data, view, theme));
  const heat = new TimeLine($("#heat"), scene, data, view, theme);
  const track = new TrackChart($("#track"), scene, data, view, theme);
  $("#heat-high").textContent = `${heat.high.toFixed(heat.high < 10 ? 1 : 0)} mm`;

  /* --- the clock --- */
  let time = player.firstSeen() / scene.rate;
  let playing = false;
  let then = 0;
  const slider = $("#time");
  slider.max = last;
  const toFrame = (t) => Math.max(0, Math.min(last, Math.round(t * scene.rate)));
  function seek(t) {
    time = Math.max(0, Math.min(view.duration, t));
    const frame = toFrame(time);
    slider.value = frame;
    $("#clock").textContent = `${time.toFixed(2)} s`;
    $("#frame").textContent = `frame ${scene.first_frame + frame * scene.stride}`;
    player.draw(frame);
    heat.point(frame);
    if (!track.element.hidden) track.point(frame);
    selection.tell(frame);
    charts.forEach((chart) => chart.visible && chart.point(frame));
  }
  function play(on) {
    if (on === playing) return;
    playing = on;
    $("#play").setAttribute("aria-label", on ? "Pause" : "Play");
    $("#play").classList.toggle("on", on);
    if (!on) return;
    if (time >= view.end - 1e-6) time = view.start;
    then = performance.now();
    requestAnimationFrame(tick);
  }
  function tick(now) {
    if (!playing) return;
    const next = time + ((now - then) / 1000) * Number($("#speed").value);
    then = now;
    seek(next > view.end ? view.start : next);
    requestAnimationFrame(tick);
  }

  /* --- drawing what is on view --- */
  let asked = false;
  function redraw() {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      heat.draw();
      if (!track.element.hidden) track.draw();
      charts.forEach((chart) => {
        chart.stale = true;
        if (chart.visible) chart.draw();
      });
      $("#unzoom").hidden = view.end - view.start > view.duration - 1e-6;
      seek(time);
    });
  }
  view.watchers.push(redraw);
  const watcher = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      const chart = charts.find((c) => c.element === entry.target);
      chart.visible = entry.isIntersecting;
      if (chart.visible && chart.stale) chart.draw();
      if (chart.visible) chart.point(toFrame(time));
    }
  }, { rootMargin: "200px" });
  for (const chart of charts) {
    chart.visible = chart.element.getBoundingClientRect().top < innerHeight + 200;
    watcher.observe(chart.element);
  }
  window.addEventListener("resize", redraw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    Object.assign(theme, themeFromStyles());
    redraw();
  });

  const selection = new Selection(scene, data, player, charts, track, () => seek(time));
  const pick = (picked, show) => selection.pick(picked, show);

  /* --- where to look --- */
  function visit(i) {
    const { first, about } = scene.moments[i];
    play(false);
    if (about) pick({ kind: about[0], index: about[1] }, false);
    seek(first / scene.rate);
  }
  function nextMoment(by) {
    const frame = toFrame(time);
    const order = scene.moments.map((_, i) => i);
    const next = by > 0
      ? order.find((i) => scene.moments[i].first > frame)
      : order.reverse().find((i) => scene.moments[i].first < frame);
    if (next !== undefined) visit(next);
  }
  document.querySelectorAll("[data-moment]").forEach((button) =>
    button.addEventListener("click", () => visit(Number(button.dataset.moment))));

  /* --- the hand on the time --- */
  function scrub(drawing) {
    const canvas = drawing.canvas;
    const move = (event) => {
      play(false);
      seek(drawing.time(event.offsetX));
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      move(event);
    });
    canvas.addEventListener("pointermove", (event) => event.buttons && move(event));
    canvas.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && !event.altKey) return;
      event.preventDefault();
      view.zoom(drawing.time(event.offsetX), Math.exp(Math.sign(event.deltaY) * 0.2));
    }, { passive: false });
    canvas.addEventListener("dblclick", () => view.show(0, view.duration));
  }
  [...charts, heat, track].forEach(scrub);
  $("#unzoom").addEventListener("click", () => view.show(0, view.duration));
  slider.addEventListener("input", () => {
    play(false);
    seek(Number(slider.value) / scene.rate);
  });
  $("#play").addEventListener("click", () => play(!playing));

  document.querySelectorAll("[data-show]").forEach((button) => {
    const set = (on) => {
      player.show[button.dataset.show] = on;
      button.setAttribute("aria-pressed", on);
    };
    if (button.dataset.show === "mesh" && !player.body) button.hidden = true;
    set(player.show[button.dataset.show]);
    button.addEventListener("click", () => {
      set(!player.show[button.dataset.show]);
      player.draw();
    });
  });
  const follow = $("#follow");
  follow.addEventListener("click", () => {
    player.follow = !player.follow;
    follow.setAttribute("aria-pressed", player.follow);
    player.draw();
  });
  document.querySelectorAll("[data-view]").forEach((button) =>
    button.addEventListener("click", () => player.reset(...button.dataset.view.split(",").map(Number))));
  document.querySelectorAll("[data-series]").forEach((button) => {
    if (button.tagName !== "BUTTON") return;
    button.addEventListener("click", () => {
      const on = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", on);
      charts.forEach((chart) => {
        chart.hidden[on ? "delete" : "add"](Number(button.dataset.series));
        chart.range = chart.findRange();
      });
      redraw();
    });
  });

  const look = (yaw, pitch, zoom = 1) => {
    player.orbit(yaw, pitch);
    player.zoom(zoom);
    player.draw();
  };
  const faster = (by) => {
    const speed = $("#speed");
    speed.selectedIndex = Math.max(0, Math.min(speed.options.length - 1, speed.selectedIndex + by));
  };
  const keys = {
    " ": () => play(!playing),
    ArrowLeft: (event) => seek(time - (event.shiftKey ? 1 : 1 / scene.rate)),
    ArrowRight: (event) => seek(time + (event.shiftKey ? 1 : 1 / scene.rate)),
    Home: () => seek(view.start),
    End: () => seek(view.end),
    m: () => $('[data-show="markers"]').click(),
    b: () => $('[data-show="bones"]').click(),
    x: () => $('[data-show="axes"]').click(),
    f: () => $('[data-show="frames"]').click(),
    n: () => $('[data-show="names"]').click(),
    o: () => player.body && $('[data-show="mesh"]').click(),
    r: () => player.reset(),
    a: () => look(0.1, 0), d: () => look(-0.1, 0), w: () => look(0, 0.1), s: () => look(0, -0.1),
    "+": () => look(0, 0, 1 / 1.15), "=": () => look(0, 0, 1 / 1.15), "-": () => look(0, 0, 1.15),
    ",": () => faster(-1), ".": () => faster(1),
    j: () => selection.step(1), J: () => selection.step(-1),
    "]": () => nextMoment(1), "[": () => nextMoment(-1),
    Escape: () => pick(null),
  };
  document.addEventListener("keydown", (event) => {
    const typing = ["TEXTAREA"].includes(event.target.tagName);
    if (typing || event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
    if (event.target.tagName === "SELECT" && event.key !== "Escape") return; // it has keys of its own
    if (event.key === " " && ["BUTTON", "SUMMARY"].includes(event.target.tagName)) return;
    if (event.target.type === "range" && event.key.startsWith("Arrow")) return;
    event.preventDefault();
    keys[event.key](event);
  });

  onPaper(() => {
    Object.assign(theme, themeFromStyles());
    heat.draw();
    charts.forEach((chart) => {
      chart.draw();
      chart.point(toFrame(time));
    });
    seek(time);
  });
  pick(null);
  document.body.classList.add("ready");
  redraw();
}

start().catch((error) => {
  $("#failed").hidden = false;
  $("#failed").textContent =
    `The moving part of this page does not work in this browser (${error.message}); ` +
    "the tables below are complete. Any browser since 2023 shows it.";
});
