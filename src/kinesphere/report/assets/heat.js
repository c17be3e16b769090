/* The time line: a row a limb, coloured by how far its markers are from a rigid limb. */
class HeatMap {
  constructor(element, scene, data, view, theme) {
    Object.assign(this, { element, scene, data, view, theme });
    this.canvas = element.querySelector("canvas");
    this.cursor = element.querySelector(".cursor");
    this.left = 92;
    this.row = 10;
    this.canvas.style.height = `${scene.limbs.length * this.row}px`;
    this.high = this.findHigh();
  }
  /* 98 % of all residuals lie below the hottest colour; what skin does on any limb never has it. */
  findHigh() {
    const known = [...this.data.limb_residuals.values].filter(Number.isFinite).sort((a, b) => a - b);
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
    const { canvas, scene, view, theme, left, row } = this;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width) return;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const context = canvas.getContext("2d");
    const columns = canvas.width - Math.round(left * ratio);
    const image = context.createImageData(Math.max(1, columns), scene.limbs.length);
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
    context.drawImage(small, Math.round(left * ratio), 0, columns, canvas.height);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.font = "9px system-ui, sans-serif";
    context.textBaseline = "middle";
    context.textAlign = "right";
    scene.limbs.forEach((limb, i) => {
      context.fillStyle = theme.dim;
      context.fillText(limb.name.replaceAll("_", " "), left - 8, (i + 0.5) * row);
      context.fillStyle = theme.card;
      context.fillRect(left, (i + 1) * row - 0.5, width - left, 1);
    });
  }
}
