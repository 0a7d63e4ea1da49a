// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// The cloud in the page: arrays as the page writer packed them, and colours by what is wanted.

// As in the program: the true side, the wrong one, the true one from behind, and no normal.
const FRONT = 0xe6e2d8, WRONG = 0xd03020, BEHIND = 0x94836c, NONE = 0x3060c0, GREY = 0x909090;
const RAMP = [[48, 37, 107], [43, 122, 155], [88, 179, 104], [242, 227, 90]];

function decode(name, bytes) {  // the first bytes of an array, or null; five letters are four bytes
  const text = document.getElementById(name)?.textContent;
  if (!text) return null;
  const words = new Uint32Array(Math.ceil(bytes / 4));
  for (let i = 0, at = 0; i < words.length; ++i) {
    let word = 0;
    for (let c = 0; c < 5; ++c) {
      const letter = text.charCodeAt(at++);
      word = word * 85 + letter - (letter > 92 ? 42 : letter > 60 ? 41 : 40);
    }
    words[i] = word;
  }
  return words.buffer;
}

function ramp(value) {  // 0 to 1, as rampColor of the program
  if (!(value >= 0)) return GREY;
  const t = Math.min(value, 1) * (RAMP.length - 1);
  const stop = Math.min(Math.floor(t), RAMP.length - 2);
  const mixed = RAMP[stop].map((from, c) => Math.round(from + (RAMP[stop + 1][c] - from) * (t - stop)));
  return mixed[0] << 16 | mixed[1] << 8 | mixed[2];
}

function mix(color, other) {  // one part of the first and three of the other
  let out = 0;
  for (const shift of [16, 8, 0]) out |= ((color >> shift & 255) + 3 * (other >> shift & 255)) / 4 << shift;
  return out;
}

class Cloud {
  constructor(most) {  // with the first points only: they are spread evenly
    Object.assign(this, JSON.parse(document.getElementById("head").textContent));
    const n = this.loaded = Math.min(most, this.points);
    const array = (name, Type, size) => {
      const buffer = Type && decode(name, n * size * Type.BYTES_PER_ELEMENT);
      return buffer ? new Type(buffer, 0, n * size) : null;
    };
    const whole = {1: Uint8Array, 2: Uint16Array, 4: Uint32Array};
    this.positions = array("positions", Uint16Array, 3);
    this.normals = array("normals", Int8Array, 2);
    this.sides = array("sides", Uint8Array, 1);
    this.labels = array("labels", whole[this.labelBytes], 1);
    this.scanOf = array("scans", whole[this.scanBytes], 1);
    this.confidences = array("confidences", Uint8Array, 1);
    this.colors = array("colors", Uint16Array, 1);
    for (const segment of this.segments) segment.tint = mix(segment.color, FRONT);
    this.ramps = Array.from({length: 256}, (_, i) => ramp(i / 255));
  }

  colorings() {  // what can be shown: [name, text]
    const known = this.segments.some((s) => s.confidence !== undefined);
    return [
      ["orientation", "orientation", this.normals],
      ["segment", "segments", this.labels],
      ["normal", "direction of normals", this.normals],
      ["confidence", "confidence", this.confidences || known],
      ["rgb", "the input's colours", this.colors],
      ["scan", "scan", this.scanOf],
      ["height", "height", true],
    ].filter((c) => c[2]).map((c) => c.slice(0, 2));
  }

  normal(i) {  // unit, or null
    if (!this.normals || this.normals[2 * i] === -128) return null;
    let x = this.normals[2 * i] / 127, y = this.normals[2 * i + 1] / 127;
    const z = 1 - Math.abs(x) - Math.abs(y);
    if (z < 0) [x, y] = [(1 - Math.abs(y)) * (x < 0 ? -1 : 1), (1 - Math.abs(x)) * (y < 0 ? -1 : 1)];
    const length = Math.hypot(x, y, z);
    return [x / length, y / length, z / length];
  }

  box() {  // lower and upper corner in the cube
    const low = [65535, 65535, 65535], high = [0, 0, 0], p = this.positions;
    for (let i = 0; i < p.length; ++i) {
      if (p[i] < low[i % 3]) low[i % 3] = p[i];
      if (p[i] > high[i % 3]) high[i % 3] = p[i];
    }
    this.height = [low[2], Math.max(1, high[2] - low[2])];
    return [low, high].map((corner) => corner.map((v) => v / 65535));
  }

  position(i) {  // in the input's coordinates
    return [0, 1, 2].map((a) => this.low[a] + this.extent * this.positions[3 * i + a] / 65535);
  }

  confidence(i) {  // undefined where it is not known
    if (this.confidences) return this.confidences[i] === 255 ? undefined : this.confidences[i] / 254;
    return this.labels ? this.segments[this.labels[i]].confidence : undefined;
  }

  colorOf(coloring, i) {  // packed rgb of the side that is seen, of the front in "orientation"
    if (coloring === "segment") return this.segments[this.labels[i]].color;
    if (coloring === "scan") return this.scans[this.scanOf[i]].color;
    if (coloring === "rgb") {
      const c = this.colors[i];
      return (c >> 11) * 255 / 31 << 16 | (c >> 5 & 63) * 255 / 63 << 8 | (c & 31) * 255 / 31;
    }
    if (coloring === "height") {
      return this.ramps[(this.positions[3 * i + 2] - this.height[0]) * 255 / this.height[1] | 0];
    }
    if (coloring === "confidence") return ramp(this.confidence(i));
    if (this.normals[2 * i] === -128) return NONE;
    if (coloring === "orientation") return this.labels ? this.segments[this.labels[i]].tint : FRONT;
    return this.normal(i).reduce((rgb, v) => rgb << 8 | Math.round(127.5 * (1 + v)), 0);
  }

  paint(coloring) {  // four bytes a point; the last is its side
    const out = new Uint8Array(4 * this.loaded);
    for (let i = 0; i < this.loaded; ++i) {
      const c = this.colorOf(coloring, i);
      out[4 * i] = c >> 16;
      out[4 * i + 1] = c >> 8;
      out[4 * i + 2] = c;
      out[4 * i + 3] = this.sides ? this.sides[i] : 0;
    }
    return out;
  }
}
