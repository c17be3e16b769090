/* Points, quaternions (xyzw) and a camera that orbits a target in a world where y is up. */
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const scaled = (a, k) => [a[0] * k, a[1] * k, a[2] * k];

function turned(q, p) {
  const [x, y, z, w] = q;
  const tx = 2 * (y * p[2] - z * p[1]);
  const ty = 2 * (z * p[0] - x * p[2]);
  const tz = 2 * (x * p[1] - y * p[0]);
  return [
    p[0] + w * tx + y * tz - z * ty,
    p[1] + w * ty + z * tx - x * tz,
    p[2] + w * tz + x * ty - y * tx,
  ];
}

/* Return the convex outline of points on the screen (Andrew's monotone chain). */
function hull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (run) => {
    const chain = [];
    for (const p of run) {
      while (chain.length > 1) {
        const [a, b] = chain.slice(-2);
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        chain.pop();
      }
      chain.push(p);
    }
    return chain.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

class Camera {
  constructor() {
    this.reset();
  }
  reset() {
    this.yaw = 0.72;
    this.pitch = 0.16;
    this.distance = 3.6;
    this.target = [0, 0.95, 0];
    this.shift = [0, 0, 0];
  }
  /* Make the turned axes once a frame; project() then costs a few multiplications. */
  aim(width, height) {
    const [cy, sy, cp, sp] = [
      Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch),
    ];
    this.right = [cy, 0, -sy];
    this.up = [-sy * sp, cp, -cy * sp];
    this.back = [sy * cp, sp, cy * cp];
    this.eye = add(add(this.target, this.shift), scaled(this.back, this.distance));
    this.focal = 1.5 * Math.min(width, height * 0.9);
    this.middle = [width / 2, height / 2];
  }
  /* Return [x, y, pixels per metre, depth], or null behind the eye. */
  project(p) {
    const d = [p[0] - this.eye[0], p[1] - this.eye[1], p[2] - this.eye[2]];
    const depth = -(d[0] * this.back[0] + d[1] * this.back[1] + d[2] * this.back[2]);
    if (!(depth > 0.05)) return null;
    const k = this.focal / depth;
    const x = d[0] * this.right[0] + d[1] * this.right[1] + d[2] * this.right[2];
    const y = d[0] * this.up[0] + d[1] * this.up[1] + d[2] * this.up[2];
    return [this.middle[0] + x * k, this.middle[1] - y * k, k, depth];
  }
  pan(dx, dy) {
    const k = this.distance / this.focal;
    this.shift = add(this.shift, add(scaled(this.right, -dx * k), scaled(this.up, dy * k)));
  }
}
