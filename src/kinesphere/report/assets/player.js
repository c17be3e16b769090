/* The moving figure, painted far to near on a plain canvas: no graphics card needed. */
class Player extends Figure {
  constructor(canvas, scene, data, theme) {
    super(scene, data);
    Object.assign(this, { canvas, theme });
    this.context = canvas.getContext("2d");
    this.camera = new Camera();
    this.body = BodyMesh.of(scene, data);
    this.picker = new Picker(this);
    this.picked = null;
    this.pointed = null;
    this.onpick = () => {};
    this.show = { markers: true, bones: true, mesh: Boolean(this.body), axes: false, frames: false, names: false };
    this.follow = true;
    this.frame = this.firstSeen();
    this.home = this.centreAt(this.frame) || [0, 0.95, 0];
    this.reset();
    this.hand = new Hand(this);
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  /* --- the hand on the camera --- */
  /* Angles are told from the person's own front, in the frame on view. */
  reset(yaw = 0.6, pitch = 0.16) {
    this.camera.reset();
    this.camera.yaw = this.frontYaw(this.frame) + yaw;
    this.camera.pitch = pitch;
    this.camera.distance = 2.05 * this.height();
    this.camera.target = this.home;
    this.draw();
  }
  frontYaw(frame) {
    const root = this.pose(0, frame) || this.pose(0, this.firstSeen());
    const anterior = root ? turned(root.quaternion, [1, 0, 0]) : [0, 0, 1];
    return Math.atan2(anterior[0], anterior[2]);
  }
  orbit(yaw, pitch) {
    this.camera.yaw += yaw;
    this.camera.pitch = Math.max(-1.5, Math.min(1.55, this.camera.pitch + pitch));
  }
  pointAt(pointed) {
    if (this.picker.name(pointed) === this.picker.name(this.pointed)) return;
    this.pointed = pointed;
    this.canvas.classList.toggle("pointing", Boolean(pointed));
    this.draw();
  }
  zoom(k) {
    this.camera.distance = Math.max(0.3, Math.min(40, this.camera.distance * k));
  }

  /* --- painting --- */
  draw(frame = this.frame) {
    this.frame = frame;
    const { canvas, context } = this;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width || !height) return;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    if (this.follow) this.camera.target = this.centreAt(frame) || this.camera.target;
    this.camera.aim(width, height);
    const poses = this.scene.limbs.map((_, i) => this.pose(i, frame));
    this.posesNow = poses;
    const sticks = this.bones(poses);
    const bones = this.show.bones ? sticks : [];
    this.paintFloor();
    this.paintShadow(this.show.bones || (this.show.mesh && this.body) ? sticks : []);
    this.paintBody(poses, width, height, ratio);
    const items = [];
    if (this.show.bones) this.addTrunks(items, bones);
    for (const bone of bones) this.addBone(items, bone);
    if (this.show.markers) this.addMarkers(items, frame);
    if (this.show.frames) this.addFrames(items, poses);
    this.addAxes(items, poses);
    items.sort((a, b) => b.depth - a.depth).forEach((item) => item.paint());
    if (this.show.names) this.paintNames(bones, frame);
    this.picker.paint(poses, frame);
  }
  paintBody(poses, width, height, ratio) {
    if (!this.show.mesh || !this.body) return;
    const { context, camera, theme, picked } = this;
    const limb = picked && picked.kind !== "marker" ? picked.index + (picked.kind === "joint") : -1;
    const body = this.body.draw(poses, camera, width, height, ratio, theme, limb);
    if (!body) return;
    context.globalAlpha = this.show.bones ? 0.55 : 1;
    context.drawImage(body, 0, 0, width, height);
    context.globalAlpha = 1;
  }
  paintFloor() {
    const { context, camera, theme } = this;
    const step = 0.5;
    const middle = [0, 2].map((i) => Math.round(camera.target[i] / step) * step);
    const reach = 3.5;
    for (let k = -reach; k <= reach + 1e-6; k += step)
      for (const along of [0, 1]) {
        for (let s = -reach; s < reach - 1e-6; s += step) {
          const a = [middle[0] + (along ? k : s), this.floor, middle[1] + (along ? s : k)];
          const b = along ? [a[0], a[1], a[2] + step] : [a[0] + step, a[1], a[2]];
          const [pa, pb] = [camera.project(a), camera.project(b)];
          if (!pa || !pb) continue;
          const far = Math.hypot(s + step / 2, k) / reach;
          context.globalAlpha = Math.max(0, 1 - far * far) * 0.9;
          context.strokeStyle = theme.grid;
          context.lineWidth = 1;
          context.beginPath();
          context.moveTo(pa[0], pa[1]);
          context.lineTo(pb[0], pb[1]);
          context.stroke();
        }
      }
    context.globalAlpha = 1;
  }
  paintShadow(bones) {
    const { context, camera, theme } = this;
    if (camera.pitch < 0.02) return;
    const middle = camera.project([camera.target[0], this.floor, camera.target[2]]);
    if (!middle) return;
    context.strokeStyle = theme.shadow;
    context.lineCap = context.lineJoin = "round";
    context.lineWidth = 0.06 * middle[2];
    context.beginPath(); // one stroke for all: where two sticks' shadows meet it is no darker
    for (const { near, far } of bones) {
      const a = camera.project([near[0], this.floor, near[2]]);
      const b = camera.project([far[0], this.floor, far[2]]);
      if (!a || !b) continue;
      context.moveTo(a[0], a[1]);
      context.lineTo(b[0], b[1]);
    }
    context.stroke();
  }
  /* A limb that carries several others is a body, not a stick: fill what its joints span. */
  addTrunks(items, bones) {
    const { context, camera, theme } = this;
    for (const limb of new Set(bones.map((bone) => bone.limb))) {
      const own = bones.filter((bone) => bone.limb === limb);
      if (own.length < 3) continue;
      const points = [own[0].near, ...own.map((bone) => bone.far)].map((p) => camera.project(p));
      if (points.includes(null)) continue;
      items.push({
        depth: Math.max(...points.map((p) => p[3])),
        paint: () => {
          context.globalAlpha = 0.22;
          context.fillStyle = theme.bones[limb.side][1];
          context.beginPath();
          hull(points).forEach((p, i) => context[i ? "lineTo" : "moveTo"](p[0], p[1]));
          context.closePath();
          context.fill();
          context.globalAlpha = 1;
        },
      });
    }
  }
  addBone(items, { limb, near, far }) {
    const { context, camera, theme } = this;
    const [a, b] = [camera.project(near), camera.project(far)];
    if (!a || !b) return;
    const thick = Math.hypot(far[0] - near[0], far[1] - near[1], far[2] - near[2]);
    const wide = Math.max(0.012, Math.min(0.03, 0.075 * thick));
    const [ra, rb] = [Math.max(1.4, wide * a[2]), Math.max(1.1, wide * 0.7 * b[2])];
    const angle = Math.atan2(b[1] - a[1], b[0] - a[0]);
    items.push({
      depth: (a[3] + b[3]) / 2,
      paint: () => {
        const side = [Math.sin(angle), -Math.cos(angle)];
        const blend = context.createLinearGradient(
          a[0] + side[0] * ra, a[1] + side[1] * ra, a[0] - side[0] * ra, a[1] - side[1] * ra);
        const [light, dark] = theme.bones[limb.side];
        blend.addColorStop(0, side[1] < 0 ? light : dark);
        blend.addColorStop(1, side[1] < 0 ? dark : light);
        context.fillStyle = blend;
        context.strokeStyle = theme.outline;
        context.lineWidth = 1;
        context.beginPath();
        context.arc(a[0], a[1], ra, angle + Math.PI / 2, angle - Math.PI / 2);
        context.arc(b[0], b[1], rb, angle - Math.PI / 2, angle + Math.PI / 2);
        context.closePath();
        context.fill();
        context.stroke();
        context.fillStyle = light;
        context.beginPath();
        context.arc(a[0], a[1], ra * 1.25, 0, 2 * Math.PI);
        context.fill();
        context.stroke();
      },
    });
  }
  addMarkers(items, frame) {
    const { context, camera, theme } = this;
    this.scene.markers.forEach((marker, i) => {
      const p = this.point("markers", i, frame);
      const at = p && camera.project(p);
      if (!at) return;
      const radius = Math.max(1.5, (marker.colours.length ? 0.015 : marker.used ? 0.011 : 0.007) * at[2]);
      items.push({
        depth: at[3] - 0.03,
        paint: () => {
          const [own, next] = marker.colours;
          context.fillStyle = own || (marker.used ? theme.marker : theme.faint);
          context.strokeStyle = theme.outline;
          context.lineWidth = 0.75;
          context.beginPath();
          context.arc(at[0], at[1], radius, 0, 2 * Math.PI);
          context.fill();
          context.stroke();
          if (!next) return; // a marker at a joint wears the other limb's colour inside
          context.fillStyle = next;
          context.beginPath();
          context.arc(at[0], at[1], 0.5 * radius, 0, 2 * Math.PI);
          context.fill();
        },
      });
    });
  }
  addArrow(items, from, to, colour, width) {
    const { context, camera } = this;
    const [a, b] = [camera.project(from), camera.project(to)];
    if (!a || !b) return;
    items.push({
      depth: (a[3] + b[3]) / 2 - 0.06,
      paint: () => {
        context.strokeStyle = context.fillStyle = colour;
        context.lineWidth = width;
        context.lineCap = "round";
        context.beginPath();
        context.moveTo(a[0], a[1]);
        context.lineTo(b[0], b[1]);
        context.stroke();
        const angle = Math.atan2(b[1] - a[1], b[0] - a[0]);
        const size = 3 + width;
        context.beginPath();
        context.moveTo(b[0] + size * Math.cos(angle), b[1] + size * Math.sin(angle));
        for (const turn of [2.4, -2.4])
          context.lineTo(b[0] + size * Math.cos(angle + turn), b[1] + size * Math.sin(angle + turn));
        context.closePath();
        context.fill();
      },
    });
  }
  addFrames(items, poses) {
    const length = 0.055 * this.height();
    poses.forEach((pose) => {
      if (!pose) return;
      this.theme.frame.forEach((colour, i) => {
        const tip = [0, 0, 0];
        tip[i] = length;
        this.addArrow(items, pose.origin, this.place(pose, tip), colour, 1.8);
      });
    });
  }
  addAxes(items, poses) {
    const length = 0.08 * this.height();
    this.scene.joints.forEach((joint, index) => {
      if (!this.show.axes && !(this.picked?.kind === "joint" && this.picked.index === index)) return;
      const pose = poses[joint.parent];
      if (!pose || joint.centre.includes(null)) return;
      const centre = this.place(pose, joint.centre);
      joint.axes.forEach((axis, i) => {
        if (axis.includes(null)) return;
        const way = turned(pose.quaternion, scaled(axis, length));
        this.addArrow(items, add(centre, scaled(way, -0.6)), add(centre, way), this.theme.series[i], 2.4);
      });
    });
  }
  /* Limbs first, then markers from near to far; a name that finds no free place stays away. */
  paintNames(bones, frame) {
    const { camera, theme, show } = this;
    const taken = [];
    const named = new Set();
    for (const { limb, near, far } of bones) {
      if (named.has(limb.name)) continue;
      named.add(limb.name);
      const at = camera.project(scaled(add(near, far), 0.5));
      if (at) this.paintName(limb.name.replaceAll("_", " "), at, "600 11px", theme.text, taken);
    }
    if (!show.markers) return;
    const seen = this.scene.markers.map((marker, i) => {
      const p = this.point("markers", i, frame);
      return { label: marker.label, at: p && camera.project(p) };
    });
    seen.filter(({ at }) => at).sort((a, b) => a.at[3] - b.at[3]).forEach(({ label, at }) =>
      this.paintName(label, at, "10px", theme.dim, taken));
  }
  paintName(text, at, font, colour, taken) {
    const { context, theme } = this;
    context.font = `${font} system-ui, sans-serif`;
    const [wide, high, gap] = [context.measureText(text).width, 12, 6];
    const places = [[gap, 4], [-gap - wide, 4], [gap, -6], [-gap - wide, -6], [gap, 14], [-gap - wide, 14]];
    for (const [dx, dy] of places) {
      const [x, y] = [at[0] + dx, at[1] + dy];
      const free = taken.every((t) => x > t[0] + t[2] || x + wide < t[0] || y > t[1] + high || y < t[1] - high);
      if (!free) continue;
      taken.push([x, y, wide]);
      context.strokeStyle = theme.card;
      context.lineWidth = 3;
      context.lineJoin = "round";
      context.strokeText(text, x, y);
      context.fillStyle = colour;
      context.fillText(text, x, y);
      return;
    }
  }
}
