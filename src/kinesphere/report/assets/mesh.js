/* The body as a surface that its limbs carry, drawn by the graphics card on a canvas of its own;
   the player paints that picture between the floor and the sticks. Without WebGL there is none. */
const MESH_VERTEX = `#version 300 es
precision highp float;
uniform vec4 limbs[LIMBS * 2]; // a unit dual quaternion each
uniform vec3 eye, right, up, back;
uniform vec2 focal, depths;
uniform float picked;
in vec3 at, normal;
in vec4 limb, weight;
out vec3 facing;
out float hot;
vec3 turned(vec4 q, vec3 p) { return p + 2.0 * cross(q.xyz, cross(q.xyz, p) + q.w * p); }
void main() { // screws blended by their shares, each on the side of the first (Kavan et al. 2008)
  vec4 first = limbs[2 * int(limb.x)];
  vec4 q = vec4(0.0), e = vec4(0.0);
  for (int k = 0; k < 4; k++) {
    vec4 one = limbs[2 * int(limb[k])];
    float share = dot(one, first) < 0.0 ? -weight[k] : weight[k];
    q += share * one;
    e += share * limbs[2 * int(limb[k]) + 1];
  }
  float size = length(q);
  q /= size;
  e /= size;
  vec3 d = turned(q, at) + 2.0 * (q.w * e.xyz - e.w * q.xyz + cross(q.xyz, e.xyz)) - eye;
  vec3 n = turned(q, normalize(normal));
  facing = vec3(dot(n, right), dot(n, up), dot(n, back));
  hot = dot(weight, vec4(equal(limb, vec4(picked))));
  float depth = -dot(d, back);
  gl_Position = vec4(focal * vec2(dot(d, right), dot(d, up)), depths.x * depth + depths.y, depth);
}`;
const MESH_FRAGMENT = `#version 300 es
precision mediump float;
uniform vec3 colour, accent;
in vec3 facing;
in float hot;
out vec4 painted;
void main() {
  vec3 n = normalize(facing);
  float key = max(0.0, dot(n, normalize(vec3(-0.45, 0.65, 0.6))));
  float rim = pow(1.0 - abs(n.z), 3.0);
  vec3 base = mix(colour, accent, 0.75 * hot);
  painted = vec4(base * (0.5 + 0.16 * n.y + 0.46 * key) + 0.14 * rim, 1.0);
}`;

class BodyMesh {
  /* Return the surface of a scene, null where there is none or nothing can draw it. */
  static of(scene, data) {
    if (!scene.mesh) return null;
    const canvas = document.createElement("canvas");
    const gl = canvas.getContext("webgl2", { alpha: true, antialias: true, premultipliedAlpha: true });
    if (!gl || gl.getParameter(gl.MAX_VERTEX_UNIFORM_VECTORS) < 2 * scene.limbs.length + 10) return null;
    try {
      return new BodyMesh(canvas, gl, scene, data);
    } catch {
      return null; // a driver that cannot: the sticks are still there
    }
  }
  constructor(canvas, gl, scene, data) {
    Object.assign(this, { canvas, gl, scene });
    this.program = this.link(scene.limbs.length);
    const table = (name, n) => BodyMesh.rows(data[name], n);
    const at = table("mesh_vertices", 3);
    const faces = Uint32Array.from(table("mesh_faces", 3), Math.round);
    this.count = faces.length;
    this.screws = new Float32Array(8 * scene.limbs.length);
    gl.useProgram(this.program);
    this.attribute("at", at, 3);
    this.attribute("normal", BodyMesh.normals(at, faces), 3);
    this.attribute("limb", table("mesh_limbs", 4), 4);
    this.attribute("weight", table("mesh_weights", 4), 4);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, faces, gl.STATIC_DRAW);
    gl.enable(gl.DEPTH_TEST);
    canvas.addEventListener("webglcontextlost", () => (this.lost = true));
  }
  /* Packed arrays hold one component after another; a buffer wants one vertex after another. */
  static rows(array, n) {
    const rows = new Float32Array(array.frames * n);
    for (let f = 0; f < array.frames; f++) for (let k = 0; k < n; k++) rows[f * n + k] = array.at(k, f);
    return rows;
  }
  static normals(at, faces) {
    const normals = new Float32Array(at.length);
    for (let f = 0; f < faces.length; f += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => 3 * faces[f + k]);
      const [u, v] = [b, c].map((p) => [0, 1, 2].map((k) => at[p + k] - at[a + k]));
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      for (const p of [a, b, c]) for (let k = 0; k < 3; k++) normals[p + k] += n[k];
    }
    return normals;
  }
  link(n_limbs) {
    const gl = this.gl;
    const program = gl.createProgram();
    const sources = [[gl.VERTEX_SHADER, MESH_VERTEX.replace("LIMBS", n_limbs)], [gl.FRAGMENT_SHADER, MESH_FRAGMENT]];
    for (const [kind, source] of sources) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    return program;
  }
  attribute(name, values, size) {
    const gl = this.gl;
    const place = gl.getAttribLocation(this.program, name);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, gl.FLOAT, false, 0, 0);
  }
  /* From where each limb was bound to where it is; one without a pose goes with its parent. */
  carry(poses) {
    this.scene.limbs.forEach((limb, i) => {
      const screw = this.screws.subarray(8 * i, 8 * i + 8);
      if (!poses[i]) {
        screw.set(this.screws.subarray(8 * limb.parent, 8 * limb.parent + 8));
        return;
      }
      const [x, y, z, w] = poses[i].quaternion;
      const [a, b, c] = add(poses[i].origin, scaled(turned([x, y, z, w], this.scene.mesh.rest[i]), -1));
      screw.set([x, y, z, w,
        (a * w + b * z - c * y) / 2, (b * w + c * x - a * z) / 2, (c * w + a * y - b * x) / 2,
        -(a * x + b * y + c * z) / 2]);
    });
    return this.screws;
  }
  /* Return a canvas with the body as the camera sees it; null if there is nothing to see. */
  draw(poses, camera, width, height, ratio, theme, picked) {
    if (this.lost || !poses[0]) return null;
    const { gl, canvas, program } = this;
    const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
    gl.viewport(0, 0, w, h);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const at = (name) => gl.getUniformLocation(program, name);
    gl.uniform4fv(at("limbs"), this.carry(poses));
    for (const name of ["eye", "right", "up", "back"]) gl.uniform3fv(at(name), camera[name]);
    gl.uniform2f(at("focal"), (2 * camera.focal) / width, (2 * camera.focal) / height);
    const [near, far] = [0.05, 80];
    gl.uniform2f(at("depths"), (far + near) / (far - near), (-2 * far * near) / (far - near));
    gl.uniform1f(at("picked"), picked);
    gl.uniform3fv(at("colour"), theme.mesh);
    gl.uniform3fv(at("accent"), theme.meshPicked);
    gl.drawElements(gl.TRIANGLES, this.count, gl.UNSIGNED_INT, 0);
    return canvas;
  }
}
