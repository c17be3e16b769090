/* What a hand points at in the player: a joint, a marker or a limb, the nearest on the screen. */
const PICK_REACH = 14; // pixels

class Picker {
  constructor(player) {
    this.player = player;
  }
  /* Return { kind, index } of what is nearest to a point of the canvas, null if nothing is near. */
  nearest(x, y) {
    const { player } = this;
    const { scene, camera, frame, show } = player;
    const poses = player.posesNow;
    let best = null;
    const offer = (kind, index, distance, p) => {
      // within reach the nearer to the eye wins, unless it is clearly farther off on the screen
      const cost = distance + 6 * p[3];
      if (distance < PICK_REACH && (!best || cost < best.cost)) best = { kind, index, cost };
    };
    const point = (kind, index, at) => {
      const p = at && camera.project(at);
      if (p) offer(kind, index, Math.hypot(p[0] - x, p[1] - y), p);
    };
    scene.joints.forEach((_, i) => point("joint", i, player.jointCentre(i, poses)));
    if (show.markers) scene.markers.forEach((_, i) => point("marker", i, player.point("markers", i, frame)));
    if (best || !poses) return best;
    for (const { limb, near, far } of player.bones(poses)) {
      const [a, b] = [camera.project(near), camera.project(far)];
      if (!a || !b) continue;
      const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
      const t = Math.max(0, Math.min(1, ((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy || 1)));
      offer("limb", scene.limbs.indexOf(limb), Math.hypot(a[0] + t * dx - x, a[1] + t * dy - y), a);
    }
    // a limb stands for the joint it hangs from: that is where its angles are
    if (best && best.kind === "limb" && best.index > 0) best = { kind: "joint", index: best.index - 1 };
    return best;
  }
  name(picked) {
    const { scene } = this.player;
    if (!picked) return "";
    if (picked.kind === "marker") return scene.markers[picked.index].label;
    const list = picked.kind === "joint" ? scene.joints : scene.limbs;
    return list[picked.index].name.replaceAll("_", " ");
  }
}

/* The coordinates of a picked marker over time, as any motion-capture program draws them. */
class TrackChart extends Chart {
  constructor(element, scene, data, view, theme) {
    super(element, 0, scene, data, view, theme);
    this.unit = " mm";
    this.step = 1;
    this.scale = 1000;
    this.margin.left = 46;
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
