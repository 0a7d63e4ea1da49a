// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// The cloud in the page: arrays as the page writer packed them, and colours by what is wanted.

// As in the program: the true side, the wrong one, the true one from behind, and no normal.
const FRONT = 0xe6e2d8, WRONG = 0xd03020, BEHIND = 0x94836c, NONE = 0x3060c0, GREY = 0x909090;

class Bits {  // of a text, five letters for 32, the highest first
  constructor(text) {
    Object.assign(this, {text, at: 0, letters: 0, left: 0, word: 0, have: 0});
  }
  refill() {
    let word = 0;
    for (const end = this.at + 5; this.at < end; ++this.at) {
      const letter = this.text.charCodeAt(this.at);
      word = word * 85 + letter - (letter > 92 ? 42 : letter > 60 ? 41 : 40);
    }
    this.letters = word | 0;
    this.left = 32;
  }
  peek(count) {  // at most 24
    for (; this.have < count; this.have += 8, this.left -= 8) {
      if (!this.left) this.refill();
      this.word = this.word << 8 | this.letters >>> 24;
      this.letters <<= 8;
    }
    return this.word >>> this.have - count & (1 << count) - 1;
  }
  take(count) {
    const value = this.peek(count);
    this.have -= count;
    return value;
  }
}

// The first rows of an array of numbers, as many columns in each, or null; see packing.h. A number
// is its length in bits, by the code of its column, and all of its bits but the highest, a 1.
function unpack(name, rows, width, Type) {
  const text = document.getElementById(name)?.textContent;
  if (!text) return null;
  const bits = new Bits(text), out = new Type(rows * width), columns = [];
  while (columns.length < width) {
    const differences = bits.take(1), table = new Uint16Array(4096);
    const lengths = Array.from({length: 25}, () => bits.take(4));
    for (let length = 1, at = 0; length <= 12; ++length) {
      lengths.forEach((own, number) => {
        if (own === length) table.fill(number << 4 | length, at, at += 4096 >> length);
      });
    }
    columns.push({differences, table, last: 0});
  }
  for (let i = 0; i < out.length; ++i) {
    const column = columns[i % width], code = column.table[bits.peek(12)], length = code >> 4;
    bits.have -= code & 15;
    let value = length < 2 ? length : 1 << length - 1 | bits.take(length - 1);
    // Differences of either sign: the lowest bit is the sign.
    if (column.differences) value = column.last + (value >>> 1 ^ -(value & 1));
    out[i] = column.last = value;
  }
  return out;
}

class Cloud {
  constructor(level) {  // up to the end of a level: to there, points are spread evenly
    Object.assign(this, JSON.parse(document.getElementById("head").textContent));
    const n = this.loaded = this.levels[Math.min(level, this.levels.length - 1)];
    this.positions = unpack("positions", n, 3, Uint16Array);
    this.radii = unpack("radii", n, 1, Uint8Array);
    this.cuts = unpack("cuts", n, 6, Uint8Array);
    this.normals = unpack("normals", n, 2, Uint8Array);
    this.sides = unpack("sides", n, 1, Uint8Array);
    this.labels = unpack("labels", n, 1, Uint32Array);
    this.scanOf = unpack("scans", n, 1, Uint32Array);
    this.confidences = unpack("confidences", n, 1, Uint8Array);
    this.colors = unpack("colors", n, 3, Uint8Array);
    this.box = this.bounds();
  }

  colorings() {  // what can be shown: [name, text]
    const known = this.segments.some((s) => s.confidence !== undefined);
    return [
      ["orientation", "Orientation", this.normals],
      ["segment", "Segments", this.labels],
      ["normal", "Direction of normals", this.normals],
      ["confidence", "Confidence", this.confidences || known],
      ["rgb", "Colours of the input", this.colors],
      ["scan", "Scans", this.scanOf],
      ["height", "Height", true],
    ].filter((c) => c[2]).map((c) => c.slice(0, 2));
  }

  hasNormal(i) {
    return this.normals !== null && this.normals[2 * i] > 0;
  }

  normal(i) {  // unit
    let x = (this.normals[2 * i] - 128) / 127, y = (this.normals[2 * i + 1] - 128) / 127;
    const z = 1 - Math.abs(x) - Math.abs(y);
    if (z < 0) [x, y] = [(1 - Math.abs(y)) * (x < 0 ? -1 : 1), (1 - Math.abs(x)) * (y < 0 ? -1 : 1)];
    const length = Math.hypot(x, y, z);
    return [x / length, y / length, z / length];
  }

  bounds() {  // lower and upper corner in the cube
    const low = [65535, 65535, 65535], high = [0, 0, 0], p = this.positions;
    for (let i = 0; i < p.length; ++i) {
      if (p[i] < low[i % 3]) low[i % 3] = p[i];
      if (p[i] > high[i % 3]) high[i % 3] = p[i];
    }
    return [low, high].map((corner) => corner.map((v) => v / 65535));
  }

  place(i) {  // in the cube
    return [0, 1, 2].map((a) => this.positions[3 * i + a] / 65535);
  }

  confidence(i) {  // undefined where it is not known
    if (this.confidences) return this.confidences[i] === 255 ? undefined : this.confidences[i] / 254;
    return this.labels ? this.segments[this.labels[i]].confidence : undefined;
  }

  rampAt(value) {  // 0 to 1
    return value >= 0 ? this.ramp[Math.min(255, value * 255 | 0)] : GREY;
  }

  colorOf(coloring, i) {  // packed rgb of the side that is seen, of the front in "orientation"
    const low = this.box[0][2], high = this.box[1][2];
    if (coloring === "segment") return this.segments[this.labels[i]].color;
    if (coloring === "scan") return this.scans[this.scanOf[i]].color;
    if (coloring === "rgb") return this.colors[3 * i] << 16 | this.colors[3 * i + 1] << 8 | this.colors[3 * i + 2];
    if (coloring === "height") return this.rampAt((this.positions[3 * i + 2] / 65535 - low) / (high - low));
    if (coloring === "confidence") return this.rampAt(this.confidence(i));
    if (!this.hasNormal(i)) return NONE;
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
