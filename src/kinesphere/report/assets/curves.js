/* One chart a joint: its angles over time, its residual below, and what is flagged. */
function niceStep(range, count) {
  const rough = range / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((k) => k * power).find((step) => step >= rough);
}

/* What every chart shares: the stretch of time on view, and how time and pixels convert. */
class TimeView {
  constructor(duration) {
    this.duration = Math.max(duration, 1e-6);
    this.show(0, this.duration);
    this.watchers = [];
  }
  show(start, end) {
    const span = Math.min(this.duration, Math.max(end - start, this.duration / 2000, 0.05));
    this.start = Math.max(0, Math.min(start, this.duration - span));
    this.end = this.start + span;
    (this.watchers || []).forEach((watch) => watch());
  }
  zoom(at, k) {
    this.show(at - (at - this.start) * k, at + (this.end - at) * k);
  }
}

class Chart {
  constructor(element, index, scene, data, view, theme) {
    Object.assign(this, { element, index, scene, data, view, theme });
    this.canvas = element.querySelector("canvas");
    this.cursor = element.querySelector(".cursor");
    this.readouts = [...element.querySelectorAll(".value")];
    this.hidden = new Set();
    this.visible = false;
    this.stale = true;
    this.margin = { left: 38, right: 6, top: 8, bottom: 16 };
    [this.unit, this.step, this.scale] = ["°", 5, 1]; // of the labels at the left
    this.residualHeight = 26;
    this.range = this.findRange();
  }
  values(k) {
    if (k === 3) return { array: this.data.twists, series: this.index };
    return { array: this.data.angles, series: 3 * this.index + k };
  }
  findRange() {
    let [low, high] = [Infinity, -Infinity];
    for (let k = 0; k < 4; k++) {
      if (this.hidden.has(k)) continue;
      const { array, series } = this.values(k);
      for (let f = 0; f < array.frames; f++) {
        const v = array.at(series, f);
        if (v < low) low = v;
        if (v > high) high = v;
      }
    }
    const least = this.leastRange();
    if (!(high >= low)) [low, high] = [-least / 2, least / 2];
    if (high - low < least) [low, high] = [(low + high - least) / 2, (low + high + least) / 2];
    const room = (high - low) * 0.06;
    return [low - room, high + room];
  }
  leastRange() {
    return 20;
  }
  colour(k) {
    return this.theme.series[k];
  }
  x(time) {
    const wide = this.canvas.clientWidth - this.margin.left - this.margin.right;
    return this.margin.left + ((time - this.view.start) / (this.view.end - this.view.start)) * wide;
  }
  time(x) {
    const wide = this.canvas.clientWidth - this.margin.left - this.margin.right;
    return this.view.start + ((x - this.margin.left) / wide) * (this.view.end - this.view.start);
  }
  point(frame) {
    const time = frame / this.scene.rate;
    const x = this.x(time);
    const inside = x >= this.margin.left - 1 && x <= this.canvas.clientWidth - this.margin.right + 1;
    this.cursor.style.transform = `translateX(${x}px)`;
    this.cursor.style.opacity = inside ? 1 : 0;
    this.readouts.forEach((readout) => {
      const k = Number(readout.dataset.series);
      const { array, series } = this.values(k);
      const v = k === 4 ? this.data.joint_residuals.at(this.index, frame) : array.at(series, frame);
      const text = k === 4 ? `${Math.max(0, v).toFixed(1)} mm` : `${Math.round(v) || 0}°`;
      readout.textContent = Number.isFinite(v) ? text : "–";
    });
  }
  draw() {
    const { canvas, margin, theme, view } = this;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width) return;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = "10px system-ui, sans-serif";
    const floor = height - margin.bottom - this.residualHeight - 6;
    this.paintGrid(context, width, floor, height);
    context.save();
    context.beginPath();
    context.rect(margin.left, 0, width - margin.left - margin.right, height - margin.bottom + 1);
    context.clip();
    this.paintRuns(context, floor);
    const y = (v) => floor - ((v - this.range[0]) / (this.range[1] - this.range[0])) * (floor - margin.top);
    for (const k of [3, 2, 1, 0]) {
      if (this.hidden.has(k)) continue;
      const { array, series } = this.values(k);
      context.strokeStyle = this.colour(k);
      context.lineWidth = k === 3 ? 1.2 : 1.6;
      context.setLineDash(k === 3 ? [4, 3] : []);
      this.paintCurve(context, array, series, y, 180); // where an angle wraps there is no line
    }
    context.setLineDash([]);
    this.paintResidual(context, floor + 6, height - margin.bottom);
    context.restore();
    this.stale = false;
  }
  paintGrid(context, width, floor, height) {
    const { margin, theme, view } = this;
    context.lineWidth = 1;
    context.textAlign = "right";
    context.textBaseline = "middle";
    const [low, high] = this.range;
    const step = Math.max(this.step / this.scale, niceStep(high - low, 5));
    for (let v = Math.ceil(low / step) * step; v <= high; v += step) {
      const y = Math.round(floor - ((v - low) / (high - low)) * (floor - margin.top)) + 0.5;
      context.strokeStyle = Math.abs(v) < 1e-9 ? theme.zero : theme.rule;
      context.beginPath();
      context.moveTo(margin.left, y);
      context.lineTo(width - margin.right, y);
      context.stroke();
      context.fillStyle = theme.dim;
      context.fillText(`${Math.round(v * this.scale)}${this.unit}`, margin.left - 6, y);
    }
    const seconds = niceStep(view.end - view.start, Math.max(2, width / 90));
    context.textAlign = "center";
    context.textBaseline = "alphabetic";
    for (let t = Math.ceil(view.start / seconds) * seconds; t <= view.end + 1e-9; t += seconds) {
      const decimals = seconds < 0.1 ? 2 : seconds < 1 ? 1 : 0;
      context.fillStyle = theme.dim;
      const x = this.x(t);
      if (x < width - 14) context.fillText(`${t.toFixed(decimals)} s`, Math.max(x, margin.left + 8), height - 3);
    }
  }
  paintRuns(context, floor) {
    const { margin, theme, scene } = this;
    context.fillStyle = theme.measured;
    for (const [start, end] of scene.measured_s[this.index]) {
      const [a, b] = [this.x(start), this.x(end)];
      context.fillRect(a, margin.top - 6, Math.max(1, b - a), floor - margin.top + 6);
    }
    for (const [name, runs] of Object.entries(scene.flags[this.index]))
      for (const [first, end] of runs) {
        const [a, b] = [this.x(first / scene.rate), this.x(end / scene.rate)];
        context.fillStyle = theme.flags[name] || theme.flags.unseen;
        context.fillRect(a, margin.top, Math.max(1, b - a), floor - margin.top);
      }
    context.fillStyle = theme.accent;
    for (const [first, end] of scene.moving[this.index]) {
      const [a, b] = [this.x(first / scene.rate), this.x(end / scene.rate)];
      context.fillRect(a, margin.top - 6, Math.max(1, b - a), 3);
    }
  }
  /* Every pixel column shows its lowest and highest value, so no peak is lost in a long trial. */
  paintCurve(context, array, series, y, wrap) {
    const { scene, view } = this;
    const first = Math.max(0, Math.floor(view.start * scene.rate) - 1);
    const end = Math.min(array.frames, Math.ceil(view.end * scene.rate) + 2);
    const dense = (end - first) / Math.max(1, this.canvas.clientWidth) > 2;
    context.beginPath();
    let open = false;
    let before = NaN;
    let column = null;
    const flush = () => {
      if (!column) return;
      context.lineTo(column.x, y(column.in));
      context.lineTo(column.x, y(column.low));
      context.lineTo(column.x, y(column.high));
      context.lineTo(column.x, y(column.out));
      column = null;
    };
    for (let f = first; f < end; f++) {
      const v = array.at(series, f);
      if (!Number.isFinite(v) || Math.abs(v - before) > wrap) {
        flush();
        open = false;
      }
      before = v;
      if (!Number.isFinite(v)) continue;
      const x = this.x(f / scene.rate);
      if (!open) context.moveTo(x, y(v));
      open = true;
      if (!dense) {
        context.lineTo(x, y(v));
        continue;
      }
      const at = Math.round(x);
      if (column && column.x !== at) flush();
      if (!column) column = { x: at, in: v, low: v, high: v };
      column.low = Math.min(column.low, v);
      column.high = Math.max(column.high, v);
      column.out = v;
    }
    flush();
    context.stroke();
  }
  paintResidual(context, top, bottom) {
    const { theme, data } = this;
    const array = data.joint_residuals;
    let high = 10;
    for (let f = 0; f < array.frames; f++) high = Math.max(high, array.at(this.index, f) || 0);
    const y = (v) => bottom - (Math.min(v, high) / high) * (bottom - top);
    context.strokeStyle = theme.rule;
    context.beginPath();
    context.moveTo(0, bottom + 0.5);
    context.lineTo(this.canvas.clientWidth, bottom + 0.5);
    context.stroke();
    context.strokeStyle = theme.series[4];
    context.lineWidth = 1;
    this.paintCurve(context, array, this.index, y, Infinity);
    context.fillStyle = theme.dim;
    context.textAlign = "left";
    const scale = [`residual, to ${high.toFixed(0)} mm`, this.margin.left + 4, top + 8];
    context.strokeStyle = theme.card;
    context.lineWidth = 3;
    context.strokeText(...scale);
    context.fillText(...scale);
  }
}
