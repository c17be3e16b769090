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
  /* A ring and a name on what is picked or pointed at; where a picked one was and goes, 1 s either way. */
  paint(poses, frame) {
    const { player } = this;
    const { context, camera, theme, scene } = player;
    const place = (picked, f, posed) => {
      if (picked.kind === "marker") return player.point("markers", picked.index, f);
      if (picked.kind === "limb") return posed[picked.index] && posed[picked.index].origin;
      const at = scene.joints[picked.index].parent;
      return player.jointCentre(picked.index, posed || { [at]: player.pose(at, f) });
    };
    if (player.picked && player.picked.kind !== "limb") {
      const reach = Math.round(scene.rate);
      const step = Math.max(1, Math.round(reach / 60));
      context.lineWidth = 1.6;
      context.strokeStyle = theme.accent;
      let before = null;
      for (let f = frame - reach; f <= frame + reach; f += step) {
        const at = f >= 0 && f < scene.n_frames ? place(player.picked, f) : null;
        const now = at && camera.project(at);
        if (now && before) {
          context.globalAlpha = 0.9 * (1 - Math.abs(f - frame) / (reach + 1));
          context.beginPath();
          context.moveTo(before[0], before[1]);
          context.lineTo(now[0], now[1]);
          context.stroke();
        }
        before = now;
      }
      context.globalAlpha = 1;
    }
    for (const picked of [player.pointed, player.picked]) {
      const at = picked && place(picked, frame, poses);
      const p = at && camera.project(at);
      if (!p) continue;
      context.strokeStyle = theme.accent;
      context.lineWidth = 2;
      context.beginPath();
      context.arc(p[0], p[1], Math.max(6, 0.03 * p[2]), 0, 2 * Math.PI);
      context.stroke();
      player.paintName(this.name(picked), [p[0] + 6, p[1] - 6], "600 12px", theme.text, []);
    }
  }
}
