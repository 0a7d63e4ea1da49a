// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// WebGL 2, by the shaders of shaders.html: points as discs across their normals, strokes, marks, and the
// numbers of points for picking.

const ATTRIBUTES = ["position", "normal", "color", "size", "cut1", "cut2"];
const STROKES = 20000;  // more would hide each other; the first points are spread evenly
const SENSOR = [20, 90, 220, 255], CONTRADICTION = [190, 0, 150, 0], PICKED = [0, 0, 0, 0];

class Drawing {
  constructor(canvas, cloud) {
    this.canvas = canvas;
    const gl = canvas.getContext("webgl2", {antialias: false, alpha: false});
    if (!gl) throw new Error("no WebGL 2");
    this.gl = gl;
    this.programs = {};
    this.load(cloud);
    const places = [...cloud.sensors.map((s) => [s, SENSOR]), ...cloud.contradictions.map((s) => [s, CONTRADICTION])];
    this.marks = this.markers(places.map(([s, color]) => [[s.x, s.y, s.z], color]));
    this.picked = this.markers([]);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(1, 1, 1, 1);
  }

  load(cloud) {
    const gl = this.gl, bytes = gl.UNSIGNED_BYTE, n = cloud.loaded;
    const positions = this.buffer(cloud.positions), cuts = this.buffer(cloud.cuts || new Uint8Array(6 * n));
    const normals = this.buffer(cloud.normals || new Uint8Array(2 * n));
    this.cloud = cloud;
    this.colors = this.buffer(new Uint8Array(4 * n));
    this.points = this.arrays([["position", positions, 3, gl.UNSIGNED_SHORT, true], ["normal", normals, 2, bytes],
      ["color", this.colors, 4, bytes, true], ["size", this.buffer(cloud.radii), 1, bytes],
      ["cut1", cuts, 3, bytes, false, 6, 0], ["cut2", cuts, 3, bytes, false, 6, 3]]);
    this.strokes = this.arrays([["position", positions, 3, gl.UNSIGNED_SHORT, true], ["normal", normals, 2, bytes]], 1);
  }

  markers(places) {  // [place in the cube, colour]
    const gl = this.gl;
    return {count: places.length, arrays: this.arrays([
      ["position", this.buffer(new Float32Array(places.flatMap((p) => p[0]))), 3, gl.FLOAT],
      ["color", this.buffer(new Uint8Array(places.flatMap((p) => p[1]))), 4, gl.UNSIGNED_BYTE, true]])};
  }

  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    const text = (name) => document.getElementById(name).textContent;
    for (const [type, source] of [[gl.VERTEX_SHADER, text("common") + text(vertex)], [gl.FRAGMENT_SHADER, text(fragment)]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, "#version 300 es\n" + source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    ATTRIBUTES.forEach((name, i) => gl.bindAttribLocation(program, i, name));
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

  arrays(attributes, divisor = 0) {
    const gl = this.gl, arrays = gl.createVertexArray();
    gl.bindVertexArray(arrays);
    for (const [name, buffer, size, type, normalized = false, stride = 0, offset = 0] of attributes) {
      const at = ATTRIBUTES.indexOf(name);
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, type, normalized, stride, offset);
      gl.vertexAttribDivisor(at, divisor);
    }
    return arrays;
  }

  paint(coloring) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.colors);
    gl.bufferData(gl.ARRAY_BUFFER, this.cloud.paint(coloring), gl.STATIC_DRAW);
  }

  use(vertex, fragment, arrays, camera, cut, values) {
    const gl = this.gl, {width, height} = this.canvas, scale = camera.scale(width, height);
    const {program, places} = this.programs[vertex + fragment] ??= this.program(vertex, fragment);
    gl.bindVertexArray(arrays);
    gl.useProgram(program);
    gl.uniformMatrix3fv(places.axes, false, camera.axes().flat());
    gl.uniform3fv(places.center, camera.center);
    gl.uniform2f(places.scale, 2 * scale / width, 2 * scale / height);
    gl.uniform4fv(places.cut, cut);
    for (const [name, value] of Object.entries({pixels: scale, ...values})) gl.uniform1f(places[name] || null, value);
  }

  // fine: all points as discs; else `count` of them as squares, for pictures that move.
  draw(camera, {cut, fine, count, strokes, marks, sided = 0, numbers = 0}) {
    const gl = this.gl, cloud = this.cloud;
    const n = fine ? cloud.loaded : cloud.levels.findLast((end) => end <= Math.min(count, cloud.loaded)) ?? cloud.loaded;
    // Fewer points stand for more surface each. Squares cover with less.
    const radius = this.spacing(n) * (fine ? 1.0 : 0.55);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.use("point", fine ? "disc" : "square", this.points, camera, cut, {radius, numbers, sided});
    gl.drawArrays(gl.POINTS, 0, n);
    if (numbers) return;
    if (strokes) {
      const shown = cloud.levels.findLast((end) => end <= STROKES) ?? cloud.loaded;
      this.use("stroke", "square", this.strokes, camera, cut, {radius: this.spacing(shown)});
      gl.drawArraysInstanced(gl.LINES, 0, 2, shown);
    }
    const pixels = 0.018 * Math.min(this.canvas.width, this.canvas.height) + 6;
    for (const {arrays, count} of [this.marks, this.picked].filter((m) => m.count && (marks || m !== this.marks))) {
      this.use("mark", "sign", arrays, camera, cut, {pixels});
      gl.drawArrays(gl.POINTS, 0, count);
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
    gl.clearColor(0, 0, 0, 1);
    this.draw(camera, {...options, fine: true, numbers: true});
    gl.clearColor(1, 1, 1, 1);
    gl.disable(gl.SCISSOR_TEST);
    gl.readPixels(x, up, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    return (pixel[0] | pixel[1] << 8 | pixel[2] << 16) - 1;
  }
}
