/* The body as a surface that its limbs carry, drawn by the graphics card on a canvas of its own;
   the player paints that picture between the floor and the sticks. Without WebGL there is none. */
const MESH_VERTEX = `#version 300 es
precision highp float;
uniform vec4 limbs[LIMBS * 3];
uniform vec3 eye, right, up, back;
uniform vec2 focal, depths;
uniform float picked;
in vec3 at, normal;
in vec4 limb, weight;
out vec3 facing;
out float hot;
void main() {
  vec4 rows[3];
  for (int r = 0; r < 3; r++)
    rows[r] = weight.x * limbs[3 * int(limb.x) + r] + weight.y * limbs[3 * int(limb.y) + r]
      + weight.z * limbs[3 * int(limb.z) + r] + weight.w * limbs[3 * int(limb.w) + r];
  vec4 p = vec4(at, 1.0);
  vec3 d = vec3(dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)) - eye;
  vec3 n = normalize(vec3(dot(rows[0].xyz, normal), dot(rows[1].xyz, normal), dot(rows[2].xyz, normal)));
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
    if (!gl || gl.getParameter(gl.MAX_VERTEX_UNIFORM_VECTORS) < 3 * scene.limbs.length + 8) return null;
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
    this.matrices = new Float32Array(12 * scene.limbs.length);
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
  /* world_from_limb · limb_from_bind of each limb; one without a pose goes with its parent. */
  carry(poses) {
    this.scene.limbs.forEach((limb, i) => {
      const rows = this.matrices.subarray(12 * i, 12 * i + 12);
      if (!poses[i]) {
        rows.set(this.matrices.subarray(12 * limb.parent, 12 * limb.parent + 12));
        return;
      }
      const { origin, quaternion } = poses[i];
      const bind = this.scene.mesh.bind[i]; // 12 numbers: the rows of limb_from_bind
      const columns = [0, 1, 2, 3].map((c) => turned(quaternion, [bind[c], bind[4 + c], bind[8 + c]]));
      for (let r = 0; r < 3; r++)
        for (let c = 0; c < 4; c++) rows[4 * r + c] = columns[c][r] + (c === 3 ? origin[r] : 0);
    });
    return this.matrices;
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
