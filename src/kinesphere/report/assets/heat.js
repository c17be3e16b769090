/* The time line: what is missing, what is hard to believe, the file's events, and a row a limb
   coloured by how far its markers are from a rigid limb. */
class TimeLine {
  constructor(element, scene, data, view, theme) {
    Object.assign(this, { element, scene, data, view, theme });
    this.canvas = element.querySelector("canvas");
    this.cursor = element.querySelector(".cursor");
    this.left = 92;
    this.row = 10;
    this.lanes = [
      { name: "events", colour: "accent", of: (m) => m.kind === "event" },
      { name: "gaps", colour: "gap" },
      { name: "improbable", colour: "improbable" },
    ].filter((lane) => lane.name !== "events" || scene.moments.some(lane.of));
    this.lane = 13;
    this.top = this.lanes.length * this.lane + 3;
    this.most = Math.max(1, ...data.missing.values);
    this.canvas.style.height = `${this.top + scene.limbs.length * this.row}px`;
    this.high = this.findHigh();
  }
  /* 98 % of all residuals lie below the hottest colour; what skin does on any limb never has it. */
  findHigh() {
    const known = this.data.limb_residuals.values.filter(Number.isFinite).sort();
    return Math.max(8, known.length ? known[Math.floor(known.length * 0.98)] : 0);
  }
  x(time) {
    const wide = this.canvas.clientWidth - this.left;
    return this.left + ((time - this.view.start) / (this.view.end - this.view.start)) * wide;
  }
  time(x) {
    const wide = this.canvas.clientWidth - this.left;
    return this.view.start + ((x - this.left) / wide) * (this.view.end - this.view.start);
  }
  point(frame) {
    const x = this.x(frame / this.scene.rate);
    this.cursor.style.transform = `translateX(${x}px)`;
    this.cursor.style.opacity = x >= this.left - 1 ? 1 : 0;
  }
  colour(value) {
    const share = Math.max(0, Math.min(1, value / this.high));
    const stops = this.theme.heat;
    const at = share * (stops.length - 1);
    const i = Math.min(stops.length - 2, Math.floor(at));
    return stops[i].map((c, k) => c + (stops[i + 1][k] - c) * (at - i));
  }
  draw() {
    const { canvas, theme } = this;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width) return;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const context = canvas.getContext("2d");
    this.paintHeat(context, ratio);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.font = "9px system-ui, sans-serif";
    context.textBaseline = "middle";
    context.textAlign = "right";
    this.lanes.forEach((lane, i) => this.paintLane(context, lane, i * this.lane, width));
    this.scene.limbs.forEach((limb, i) => {
      context.fillStyle = theme.dim;
      context.fillText(limb.name.replaceAll("_", " "), this.left - 8, this.top + (i + 0.5) * this.row);
      context.fillStyle = theme.card;
      context.fillRect(this.left, this.top + (i + 1) * this.row - 0.5, width - this.left, 1);
    });
  }
  paintLane(context, lane, y, width) {
    const { left, scene, theme, data } = this;
    context.fillStyle = theme.dim;
    context.fillText(lane.name, left - 8, y + this.lane / 2);
    context.fillStyle = theme.rule;
    context.fillRect(left, y + 1, width - left, this.lane - 3);
    context.fillStyle = theme[lane.colour];
    const mark = (first, end, alpha) => {
      const a = Math.max(left, this.x(first / scene.rate));
      const b = Math.min(width, this.x(end / scene.rate));
      context.globalAlpha = alpha;
      if (b >= a) context.fillRect(a, y + 1, Math.max(2, b - a), this.lane - 3);
      context.globalAlpha = 1;
    };
    if (lane.name === "gaps") {
      let first = 0;
      for (let f = 1; f <= data.missing.frames; f++) {
        const n = data.missing.at(0, first);
        if (f < data.missing.frames && data.missing.at(0, f) === n) continue;
        if (n > 0) mark(first, f, 0.35 + (0.65 * n) / this.most);
        first = f;
      }
    } else if (lane.name === "improbable") {
      for (const [first, end] of scene.improbable) mark(first, end, 1);
    } else scene.moments.filter(lane.of).forEach((m) => mark(m.first, m.first, 1));
  }
  paintHeat(context, ratio) {
    const { canvas, scene, view, theme, left, top } = this;
    const columns = Math.max(1, canvas.width - Math.round(left * ratio));
    const image = context.createImageData(columns, scene.limbs.length);
    const array = this.data.limb_residuals;
    scene.limbs.forEach((_, limb) => {
      for (let c = 0; c < columns; c++) {
        const at = view.start + (c / columns) * (view.end - view.start);
        const next = view.start + ((c + 1) / columns) * (view.end - view.start);
        let worst = NaN;
        const end = Math.max(Math.floor(at * scene.rate) + 1, Math.floor(next * scene.rate));
        for (let f = Math.floor(at * scene.rate); f < Math.min(end, array.frames); f++) {
          const v = array.at(limb, f);
          if (!(worst >= v)) worst = Number.isFinite(v) ? v : worst;
        }
        const [r, g, b] = Number.isFinite(worst) ? this.colour(worst) : theme.empty;
        image.data.set([r, g, b, 255], 4 * (limb * columns + c));
      }
    });
    const small = document.createElement("canvas");
    small.width = columns;
    small.height = scene.limbs.length;
    small.getContext("2d").putImageData(image, 0, 0);
    context.imageSmoothingEnabled = false;
    const from = Math.round(top * ratio);
    context.drawImage(small, Math.round(left * ratio), from, columns, canvas.height - from);
  }
}
