/* Where everything is in one frame: what the player paints, without a thought of painting. */
class Figure {
  constructor(scene, data) {
    Object.assign(this, { scene, data });
    this.floor = this.findFloor();
  }
  point(array, index, frame) {
    const a = this.data[array];
    const p = [a.at(3 * index, frame), a.at(3 * index + 1, frame), a.at(3 * index + 2, frame)];
    return Number.isFinite(p[0]) ? p : null;
  }
  pose(limb, frame) {
    const origin = this.point("origins", limb, frame);
    const q = this.data.quaternions;
    const quaternion = [0, 1, 2, 3].map((i) => q.at(4 * limb + i, frame));
    if (!origin || !Number.isFinite(quaternion[0])) return null;
    const size = Math.hypot(...quaternion);
    return { origin, quaternion: quaternion.map((v) => v / size) };
  }
  place(pose, p) {
    return add(pose.origin, turned(pose.quaternion, p));
  }
  jointCentre(joint, poses) {
    const { parent, centre } = this.scene.joints[joint];
    return poses && poses[parent] && !centre.includes(null) ? this.place(poses[parent], centre) : null;
  }
  firstSeen() {
    for (let f = 0; f < this.scene.n_frames; f++) if (this.point("origins", 0, f)) return f;
    return 0;
  }
  centreAt(frame) {
    const p = this.point("origins", 0, frame);
    return p && [p[0], this.floor + 0.56 * this.height(), p[2]];
  }
  height() {
    return Math.max(0.4, Math.min(2.6, this.top - this.floor));
  }
  findFloor() {
    const heights = [];
    for (const [name, size] of [["markers", this.scene.markers.length], ["origins", this.scene.limbs.length]]) {
      const step = Math.max(1, Math.floor(this.scene.n_frames / 200));
      for (let i = 0; i < size; i++)
        for (let f = 0; f < this.scene.n_frames; f += step) {
          const y = this.data[name].at(3 * i + 1, f);
          if (Number.isFinite(y)) heights.push(y);
        }
    }
    heights.sort((a, b) => a - b);
    const low = heights.length ? heights[Math.floor(heights.length * 0.005)] : 0;
    this.top = heights.length ? heights[Math.floor(heights.length * 0.98)] : low + 1.7;
    return Math.abs(low) < 0.15 ? 0 : low - 0.03;
  }
  /* The sticks of the figure: one from where a limb hangs to each joint it carries. */
  bones(poses) {
    const found = [];
    this.scene.limbs.forEach((limb, i) => {
      if (!poses[i] || limb.near.includes(null)) return;
      const near = this.place(poses[i], limb.near);
      for (const far of limb.far)
        if (!far.includes(null)) found.push({ limb, near, far: this.place(poses[i], far) });
    });
    return found;
  }
}
