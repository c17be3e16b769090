/* The coordinates of a picked marker over time, as any motion-capture program draws them. */
class TrackChart extends Chart {
  constructor(element, scene, data, view, theme) {
    super(element, 0, scene, data, view, theme);
    this.unit = " mm";
    this.step = 1;
    this.scale = 1000;
    this.margin = { left: 92, right: 0, top: 8, bottom: 16 }; // as the time line below has it
    this.residualHeight = -6;
    this.visible = true;
  }
  values(k) {
    return k === 3 ? { array: { frames: 0, at: () => NaN }, series: 0 } : { array: this.data.markers, series: 3 * this.index + k };
  }
  leastRange() {
    return 0.02;
  }
  paintRuns() {}
  paintResidual() {}
  colour(k) {
    return this.theme.frame[k];
  }
  show(index) {
    this.index = index;
    this.range = this.findRange();
    this.draw();
  }
}
