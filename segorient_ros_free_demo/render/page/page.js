// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// The page: controls, pointers and keys, and when to draw.

const FRAME = 30;        // milliseconds that a moving picture may take
const LEAST = 10000;     // points that it has at least
const SHARP = 60000;     // with fewer, it is drawn with half as many rows and columns as well
const SMOOTH = 100000;   // points with which a picture at rest is drawn twice as large, so that edges are smooth
const FIRST = 1;         // the level that is drawn before all others are unpacked
const REST = 160;        // milliseconds without a movement until all points are drawn
const KEYS = 8;          // scans that the legend lists
const SIDES = ["may be either", "outside", "outside", "wrong", "wrong"];
const element = (id) => document.getElementById(id);
const make = (tag, ...children) => {
  const made = document.createElement(tag);
  made.append(...children);
  return made;
};
const grouped = (number) => number.toLocaleString("en");

class Page {
  constructor() {
    this.canvas = element("view");
    this.cloud = new Cloud(FIRST);
    this.count = this.cloud.loaded;
    this.drawing = new Drawing(this.canvas, this.cloud);
    this.camera = new Camera(this.cloud.positions);
    element("count").textContent = this.counts();
    this.canvas.setAttribute("aria-label", `${this.cloud.title}: ${this.counts()}, to be turned`);
    this.controls();
    this.pointers();
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.redraw()).observe(this.canvas);
    this.color(this.cloud.colorings()[0][0]);
  }

  // All points, once the first have been drawn.
  load() {
    this.cloud = new Cloud(Infinity);
    this.drawing.load(this.cloud);
    this.color(this.coloring);
  }

  counts() {
    const {points, all} = this.cloud;
    return points === all ? `${grouped(points)} points` : `${grouped(points)} of ${grouped(all)} points`;
  }

  controls() {
    const select = element("coloring"), {sensors, contradictions, normals} = this.cloud;
    for (const [name, text] of this.cloud.colorings()) select.add(new Option(text, name));
    select.onchange = () => this.color(select.value);
    for (const id of ["strokes", "marks", "axis", "cut"]) element(id).oninput = () => this.redraw();
    element("reset").onclick = () => this.reset();
    element("strokes").parentElement.hidden = !normals;
    element("marks").parentElement.hidden = !sensors.length && !contradictions.length;
    if (contradictions.length) element("marksText").textContent = sensors.length ? "Sensors, contradictions" : "Contradictions";
  }

  reset() {
    this.camera.reset();
    element("cut").value = 1000;
    this.redraw();
  }

  color(name) {
    this.coloring = element("coloring").value = name;
    this.drawing.paint(name);
    element("legend").replaceChildren(...this.legend());
    this.redraw();
  }

  legend() {
    const hex = (rgb) => "#" + rgb.toString(16).padStart(6, "0"), cloud = this.cloud;
    const box = (background, className = "") => {
      const color = make("i");
      Object.assign(color, {className}).style.background = background;
      return color;
    };
    const key = (rgb, text, className) => make("span", box(hex(rgb), className), text);
    const stops = cloud.ramp.filter((_, i) => i % 51 === 0).map(hex);
    const bar = (title, low, high) => [title, make("span", low, box(`linear-gradient(90deg, ${stops})`, "bar"), high)];
    const named = ({label, color}) => key(color, label === undefined ? "none" : String(label));
    const height = (corner) => (cloud.low[2] + cloud.extent * corner[2]).toPrecision(4);
    const marks = [cloud.sensors.length && key(0x145adc, "sensor", "sensor"),
      cloud.contradictions.length && key(0xffffff, "contradicts its sensor or surface", "ring")];
    return [...({
      orientation: () => this.sideKeys(key),
      segment: () => [`${grouped(cloud.segments.length)} segments`],
      normal: () => ["Normals", key(0xff8080, "+x"), key(0x80ff80, "+y"), key(0x8080ff, "+z")],
      confidence: () => [...bar("Confidence", "0", "1"), key(GREY, "not known")],
      scan: () => ["Scans", ...cloud.scans.slice(0, KEYS).map(named), cloud.scans.length > KEYS ? "…" : ""],
      height: () => bar("Height (z)", ...cloud.box.map(height)),
    }[this.coloring] || (() => []))(), ...marks].filter(Boolean);
  }

  // Only what there is, but always how many points are wrong.
  sideKeys(key) {
    const cloud = this.cloud, n = cloud.loaded, of = [0, 0, 0, 0, 0];
    for (let i = 0; i < n; ++i) ++of[cloud.sides[i]];
    const none = cloud.normals.reduce((sum, v, i) => sum + (i % 2 === 0 && v === 0 ? 1 : 0), 0);
    const wrong = n < cloud.points ? "" : `: ${grouped(of[3] + of[4])}`;
    return [key(FRONT, "true side"), of[0] + of[1] > none && key(BEHIND, "from behind"), key(WRONG, "wrong side" + wrong),
      none && key(NONE, "no normal")];
  }

  options() {
    const axis = Number(element("axis").value), share = element("cut").value / 1000, cut = [0, 0, 0, 2];
    const [low, high] = this.cloud.box;
    cut[axis] = 1;
    if (share < 1) cut[3] = low[axis] + share * (high[axis] - low[axis]);
    return {cut, strokes: element("strokes").checked, marks: element("marks").checked, count: this.count,
      sided: this.coloring === "orientation" ? 1 : 0};
  }

  draw(fine) {
    // Once it had to be coarse, it is so whenever it moves: a picture that changes all the time is worse.
    this.coarse ||= this.count < Math.min(SHARP, this.cloud.loaded);
    const own = Math.min(2, window.devicePixelRatio || 1), many = this.cloud.loaded > SMOOTH;
    const ratio = fine ? many ? own : 2 : this.coarse ? own / 2 : own;
    for (const [side, shown] of [["width", "clientWidth"], ["height", "clientHeight"]]) {
      const pixels = Math.max(1, Math.round(this.canvas[shown] * ratio));
      if (this.canvas[side] !== pixels) this.canvas[side] = pixels;
    }
    this.drawing.draw(this.camera, {...this.options(), fine});
    this.scaleBar();
  }

  scaleBar() {
    const {clientWidth, clientHeight} = this.canvas, bar = element("scale");
    const pixels = this.camera.scale(clientWidth, clientHeight) / this.cloud.extent;  // of a unit
    const power = 10 ** Math.floor(Math.log10(120 / pixels));
    const length = power * [5, 2, 1].find((f) => f * power * pixels <= 120);
    bar.style.width = `${length * pixels}px`;
    bar.textContent = String(Number(length.toPrecision(1)));
    bar.setAttribute("aria-label", `Scale: ${bar.textContent} units`);
  }

  // Coarsely now, all of it once nothing moves.
  redraw() {
    this.wanted ||= requestAnimationFrame((now) => this.frame(now));
    clearTimeout(this.rest);
    this.rest = setTimeout(() => requestAnimationFrame(() => this.draw(true)), REST);
  }

  frame(now) {
    this.wanted = 0;
    this.draw(false);
    if (this.cloud.loaded < this.cloud.points) this.loading ??= setTimeout(() => this.load());
    // As many points as a frame has time for, by what the last ones took while the picture moved.
    const took = now - (this.last || 0);
    this.last = now;
    if (took > 2 * REST) return;
    const count = this.count * Math.max(0.5, Math.min(1.2, FRAME / took));
    this.count = Math.round(Math.max(LEAST, Math.min(this.cloud.points, count)));
  }

  pointers() {
    const canvas = this.canvas, down = new Map();
    let moved = 0;
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => {
      if (!down.size) moved = 0;
      down.set(event.pointerId, [event.clientX, event.clientY]);
      canvas.setPointerCapture(event.pointerId);
    });
    const middle = () => {
      const all = [...down.values()], n = all.length;
      const x = all.reduce((sum, p) => sum + p[0], 0) / n, y = all.reduce((sum, p) => sum + p[1], 0) / n;
      return [x, y, n > 1 ? Math.hypot(all[0][0] - all[1][0], all[0][1] - all[1][1]) : 0];
    };
    canvas.addEventListener("pointermove", (event) => {
      if (!down.has(event.pointerId)) return;
      const before = middle();
      down.set(event.pointerId, [event.clientX, event.clientY]);
      const after = middle(), dx = after[0] - before[0], dy = after[1] - before[1];
      moved += Math.abs(dx) + Math.abs(dy);
      if (down.size > 1 || event.buttons > 1 || event.shiftKey) this.pan(dx, dy);
      else this.camera.turn(0.4 * dx, 0.4 * dy);
      if (before[2] > 0 && after[2] > 0) this.camera.zoomBy(after[2] / before[2]);
      this.redraw();
    });
    const up = (event) => {
      if (!down.delete(event.pointerId) || event.type === "pointercancel") return;
      if (moved < 4 && !down.size) this.pick(event.offsetX, event.offsetY);
    };
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.camera.zoomBy(Math.exp(-0.0015 * event.deltaY));
      this.redraw();
    }, {passive: false});
  }

  pan(dx, dy) {
    this.camera.pan(dx, dy, this.camera.scale(this.canvas.clientWidth, this.canvas.clientHeight));
  }

  key(event) {
    const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const names = this.cloud.colorings().map((c) => c[0]);
    const action = step ? () => {
      if (event.shiftKey) this.pan(20 * step[0], 20 * step[1]);
      else this.camera.turn(5 * step[0], 5 * step[1]);
    } : {
      "+": () => this.camera.zoomBy(1.2),
      "=": () => this.camera.zoomBy(1.2),
      "-": () => this.camera.zoomBy(1 / 1.2),
      "0": () => this.reset(),
      "n": () => element("strokes").click(),
      "c": () => this.color(names[(names.indexOf(this.coloring) + 1) % names.length]),
      "Enter": () => this.pick(this.canvas.clientWidth / 2, this.canvas.clientHeight / 2),
    }[event.key];
    if (!action) return;
    action();
    event.preventDefault();
    this.redraw();
  }

  pick(x, y) {  // in the page's pixels
    this.draw(true);
    const ratio = this.canvas.width / this.canvas.clientWidth, options = {...this.options(), sided: 0};
    const i = this.drawing.pick(this.camera, options, Math.floor(x * ratio), Math.floor(y * ratio));
    this.drawing.picked = this.drawing.markers(i < 0 ? [] : [[this.cloud.place(i), PICKED]]);
    const facts = i < 0 ? [] : this.facts(i).flatMap(([name, value]) => [make("dt", name), make("dd", value)]);
    element("picked").replaceChildren(...(i < 0 ? [] : [make("dl", ...facts)]));
    element("picked").hidden = i < 0;
    this.draw(true);
    return i;
  }

  facts(i) {
    const cloud = this.cloud, confidence = cloud.confidence(i);
    const vector = (values, text) => values.map(text).join(", ");
    const place = cloud.place(i).map((v, a) => cloud.low[a] + cloud.extent * v);
    const digits = Math.max(0, Math.min(12, 4 - Math.floor(Math.log10(cloud.extent))));
    const facts = [["point", vector(place, (v) => Number(v.toFixed(digits)))],
      ["normal", cloud.hasNormal(i) ? vector(cloud.normal(i), (v) => v.toFixed(3)) : "none"]];
    if (cloud.labels) {
      const segment = cloud.segments[cloud.labels[i]];
      facts.push(["segment", segment.label ?? "none"]);
      if (segment.text) facts.push(["decided", segment.text]);
    }
    if (cloud.scanOf) facts.push(["scan", cloud.scans[cloud.scanOf[i]].label ?? "none"]);
    if (cloud.sides) facts.push(["side", SIDES[cloud.sides[i]]]);
    if (confidence !== undefined) facts.push(["confidence", confidence.toFixed(2)]);
    return facts;
  }
}

try {
  window.segorient = new Page();
} catch (error) {
  const textContent = error.message === "no WebGL 2"
    ? "This page needs WebGL 2, which this browser does not have or has switched off."
    : `The cloud cannot be shown: ${error.message}`;
  Object.assign(element("message"), {hidden: false, textContent});
}
