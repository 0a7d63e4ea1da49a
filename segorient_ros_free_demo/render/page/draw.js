// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// WebGL 2: points as discs across their normals, strokes, marks, and the numbers of points for picking.

const COMMON = `#version 300 es
precision highp float;
uniform mat3 axes;      // rows: right, up, towards the viewer
uniform vec3 center;
uniform vec2 scale;     // half pictures for the cube's side
uniform vec4 cut;       // shown where dot(cut.xyz, position) <= cut.w
vec4 place(vec3 p) {
  vec3 d = (p - center) * axes;
  return vec4(d.xy * scale, -0.25 * d.z, 1.0);
}
vec3 direction(vec2 packed) {
  if (packed.x < -1.005) return vec3(0.0);
  vec3 n = vec3(packed, 1.0 - abs(packed.x) - abs(packed.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  return normalize(n);
}
`;
const POINT = `${COMMON}
in vec3 position;
in vec2 normal;
in vec4 color;          // and the side, see sides.h: 0 open, 1 outer, 2 right, 3 contrary, 4 wrong
uniform float radius;   // of discs, in the cube
uniform float pixels;   // for the cube's side
uniform bool numbers;
uniform bool sided;     // colours tell sides
out vec3 shown;
flat out vec3 across;   // the true normal as seen
flat out float size;
void main() {
  gl_Position = place(position);
  int side = int(color.a * 255.0 + 0.5);
  vec3 n = direction(normal / 127.0) * axes;
  bool wrong = side > 2;
  across = n == vec3(0.0) ? vec3(0.0, 0.0, 1.0) : wrong ? -n : n;
  // Nearly from the edge either side may be seen. The back of a closed surface is not, unless it is cut.
  bool back = across.z < -0.15;
  bool closed = side == 2 || side == 4;
  size = radius * (back ? 0.75 : 1.0);
  gl_PointSize = max(2.0, 2.0 * size * pixels);
  vec3 base = !sided ? color.rgb : wrong ? vec3(208.0, 48.0, 32.0) / 255.0
    : back ? vec3(148.0, 131.0, 108.0) / 255.0 : color.rgb;
  const vec3 light = normalize(vec3(-0.35, 0.45, 1.0));
  shown = base * (0.45 + 0.55 * abs(dot(across, light)));
  if (numbers) {
    int id = gl_VertexID + 1;
    shown = vec3(float(id & 255), float(id >> 8 & 255), float(id >> 16 & 255)) / 255.0;
  }
  bool hidden = back && closed && cut.w >= 2.0;
  if (hidden || dot(cut.xyz, position) > cut.w) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`;
const DISC = `#version 300 es
precision highp float;
in vec3 shown;
flat in vec3 across;
flat in float size;
out vec4 pixel;
void main() {
  vec2 d = (gl_PointCoord * 2.0 - 1.0) * vec2(1.0, -1.0);
  float z = -dot(across.xy, d) / (across.z < 0.0 ? min(across.z, -0.1) : max(across.z, 0.1));
  float d2 = dot(d, d) + z * z;
  if (d2 > 1.0) discard;
  gl_FragDepth = gl_FragCoord.z - 0.125 * size * (z - 0.15 * d2);
  pixel = vec4(shown, 1.0);
}`;
const SQUARE = `#version 300 es
precision mediump float;
in vec3 shown;
out vec4 pixel;
void main() { pixel = vec4(shown, 1.0); }`;
const STROKE = `${COMMON}
in vec3 position;
in vec2 normal;
uniform float radius;
out vec3 shown;
void main() {
  gl_Position = place(position + direction(normal / 127.0) * (gl_VertexID == 1 ? 3.0 * radius : 0.0));
  gl_Position.z -= 0.25 * radius;
  shown = vec3(0.1, 0.2, 0.55);
  if (dot(cut.xyz, position) > cut.w) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`;
const MARK = `${COMMON}
in vec3 position;
in vec4 color;
out vec3 shown;
void main() {
  gl_Position = place(position);
  gl_Position.z = -0.9;
  gl_PointSize = 12.0;
  shown = color.rgb;
}`;
const STROKES = 20000;  // more would hide each other; the first points are spread evenly

class Drawing {
  constructor(canvas, cloud) {
    this.canvas = canvas;
    const gl = canvas.getContext("webgl2", {antialias: false, preserveDrawingBuffer: true});
    if (!gl) throw new Error("no WebGL 2");
    this.gl = gl;
    this.discs = this.program(POINT, DISC);
    this.squares = this.program(POINT, SQUARE);
    this.lines = this.program(STROKE, SQUARE);
    this.marks = this.program(MARK, SQUARE);
    this.load(cloud);
    const places = [...cloud.sensors.map((s) => [s, [20, 90, 220, 255]]),
      ...cloud.contradictions.map((s) => [s, [190, 0, 150, 255]])];
    this.marked = places.length;
    this.places = this.arrays([
      [0, this.buffer(new Float32Array(places.flatMap(([s]) => [s.x, s.y, s.z]))), 3, gl.FLOAT, false, 0],
      [2, this.buffer(new Uint8Array(places.flatMap((p) => p[1]))), 4, gl.UNSIGNED_BYTE, true, 0]]);
    gl.enable(gl.DEPTH_TEST);
  }

  load(cloud) {
    const gl = this.gl, positions = this.buffer(cloud.positions);
    const normals = this.buffer(cloud.normals || new Int8Array(2 * cloud.loaded).fill(-128));
    this.cloud = cloud;
    this.colors = this.buffer(new Uint8Array(4 * cloud.loaded));
    this.points = this.arrays([[0, positions, 3, gl.UNSIGNED_SHORT, true, 0],
      [1, normals, 2, gl.BYTE, false, 0], [2, this.colors, 4, gl.UNSIGNED_BYTE, true, 0]]);
    this.strokes = this.arrays([[0, positions, 3, gl.UNSIGNED_SHORT, true, 1], [1, normals, 2, gl.BYTE, false, 1]]);
  }

  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    ["position", "normal", "color"].forEach((name, i) => gl.bindAttribLocation(program, i, name));
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      throw new Error(gl.getProgramInfoLog(program) || "shaders do not compile");
    }
    const places = {};
    for (let i = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i-- > 0;) {
      const {name} = gl.getActiveUniform(program, i);
      places[name] = gl.getUniformLocation(program, name);
    }
    return {program, places};
  }

  buffer(data) {
    const gl = this.gl, buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    return buffer;
  }

  arrays(attributes) {
    const gl = this.gl, arrays = gl.createVertexArray();
    gl.bindVertexArray(arrays);
    for (const [at, buffer, size, type, normalized, divisor] of attributes) {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, type, normalized, 0, 0);
      gl.vertexAttribDivisor(at, divisor);
    }
    return arrays;
  }

  paint(coloring) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.colors);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, this.cloud.paint(coloring));
  }

  use({program, places}, camera, cut, radius, numbers) {
    const gl = this.gl, {width, height} = this.canvas, scale = camera.scale(width, height);
    gl.useProgram(program);
    gl.uniformMatrix3fv(places.axes, false, camera.axes().flat());
    gl.uniform3fv(places.center, camera.center);
    gl.uniform2f(places.scale, 2 * scale / width, 2 * scale / height);
    gl.uniform4fv(places.cut, cut);
    gl.uniform1f(places.radius || null, radius);
    gl.uniform1f(places.pixels || null, scale);
    gl.uniform1i(places.numbers || null, numbers ? 1 : 0);
  }

  // fine: all points as discs; else `count` of them as squares, for pictures that move.
  draw(camera, {cut, fine, count, sided, strokes, marks, numbers}) {
    const gl = this.gl, cloud = this.cloud, n = fine ? cloud.loaded : Math.min(count, cloud.loaded);
    // Fewer points stand for more surface each. Squares cover with less.
    const radius = this.spacing(n) * (fine ? 1.1 : 0.55), program = fine ? this.discs : this.squares;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    if (numbers) gl.clearColor(0, 0, 0, 0); else gl.clearColor(1, 1, 1, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.bindVertexArray(this.points);
    this.use(program, camera, cut, radius, numbers);
    gl.uniform1i(program.places.sided, sided ? 1 : 0);
    gl.drawArrays(gl.POINTS, 0, n);
    if (numbers) return;
    if (strokes && cloud.normals) {
      const shown = Math.min(STROKES, cloud.loaded);
      this.use(this.lines, camera, cut, this.spacing(shown));
      gl.bindVertexArray(this.strokes);
      gl.drawArraysInstanced(gl.LINES, 0, 2, shown);
    }
    if (marks && this.marked) {
      this.use(this.marks, camera, cut, 0);
      gl.bindVertexArray(this.places);
      gl.drawArrays(gl.POINTS, 0, this.marked);
    }
  }

  spacing(count) {  // radius of discs if so many points stand for the surface
    return this.cloud.radius * Math.sqrt(this.cloud.points / Math.max(1, count));
  }

  // The point that is seen at a pixel from the top left, or -1. Leaves its number in the picture.
  pick(camera, options, x, y) {
    const gl = this.gl, pixel = new Uint8Array(4), up = this.canvas.height - 1 - y;
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(x, up, 1, 1);
    this.draw(camera, {...options, fine: true, numbers: true});
    gl.disable(gl.SCISSOR_TEST);
    gl.readPixels(x, up, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    return (pixel[0] | pixel[1] << 8 | pixel[2] << 16) - 1;
  }
}
