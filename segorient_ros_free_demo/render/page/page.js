// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// The page: controls, pointers and keys, and when to draw.

const FRAME = 45;        // milliseconds that a moving picture may take
const LEAST = 20000;     // points that it has at least
const FIRST = 50000;     // and at first, before the others are unpacked
const REST = 160;        // milliseconds without a movement until all points are drawn
const SIDES = ["may be either", "outside", "outside", "wrong", "wrong"];
const element = (id) => document.getElementById(id);
const make = (tag, ...children) => {
  const made = document.createElement(tag);
  made.append(...children);
  return made;
};

class Page {
  constructor() {
    this.canvas = element("view");
    this.cloud = new Cloud(FIRST);
    this.count = FIRST;
    this.coloring = "";
    this.drawing = new Drawing(this.canvas, this.cloud);
    this.camera = new Camera(this.cloud.positions);
    this.box = this.cloud.box();
    this.canvas.setAttribute("aria-label", `${this.cloud.title}: ${this.counts()}, to be turned`);
    this.controls();
    this.pointers();
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.resize();
    this.color(this.cloud.colorings()[0][0]);
  }

  // All points, once the first have been drawn.
  load() {
    this.cloud = new Cloud(this.cloud.points);
    this.box = this.cloud.box();
    this.drawing.load(this.cloud);
    this.color(this.coloring);
  }

  counts() {
    const {points, all} = this.cloud, text = points.toLocaleString("en");
    return points === all ? `${text} points` : `${text} of ${all.toLocaleString("en")} points`;
  }

  controls() {
    const select = element("coloring");
    for (const [name, text] of this.cloud.colorings()) select.add(new Option(text, name));
    select.onchange = () => this.color(select.value);
    for (const id of ["strokes", "marks", "axis", "cut"]) element(id).oninput = () => this.redraw();
    element("reset").onclick = () => this.reset();
    if (!this.cloud.normals) element("strokes").parentElement.hidden = true;
    if (!this.drawing.marked) element("marks").parentElement.hidden = true;
  }

  reset() {
    this.camera.reset();
    element("cut").value = 1000;
    this.redraw();
  }

  color(name) {
    this.coloring = element("coloring").value = name;
    this.drawing.paint(name);
    this.legend();
    this.redraw();
  }

  legend() {
    const hex = (rgb) => "#" + rgb.toString(16).padStart(6, "0");
    const box = (background, className = "") => {
      const color = make("i");
      Object.assign(color, {className}).style.background = background;
      return color;
    };
    const key = (rgb, text) => make("span", box(hex(rgb)), text);
    const stops = [0, 1 / 3, 2 / 3, 1].map((t) => hex(ramp(t)));
    const bar = (low, high) => make("span", low, box(`linear-gradient(90deg, ${stops})`, "bar"), high);
    const {low, extent} = this.cloud, heights = this.box.map((b) => (low[2] + extent * b[2]).toPrecision(4));
    const count = key(0xffffff, this.counts());
    element("legend").replaceChildren(...{
      orientation: [key(FRONT, "true side"), key(BEHIND, "from behind"), key(WRONG, "wrong side"), key(NONE, "no normal")],
      normal: [key(0xff8080, "+x"), key(0x80ff80, "+y"), key(0x8080ff, "+z")],
      confidence: [bar("0", "1 confidence"), key(GREY, "not known")],
      height: [bar(heights[0], heights[1] + " height (z)")],
    }[this.coloring] || [], count);
  }

  options() {
    const axis = Number(element("axis").value), share = element("cut").value / 1000, cut = [0, 0, 0, 2];
    const [low, high] = this.box;
    cut[axis] = 1;
    if (share < 1) cut[3] = low[axis] + share * (high[axis] - low[axis]);
    return {cut, strokes: element("strokes").checked, marks: element("marks").checked, count: this.count,
      sided: this.coloring === "orientation"};
  }

  draw(fine) {
    this.drawing.draw(this.camera, {...this.options(), fine});
  }

  // Coarsely now, all of it once nothing moves.
  redraw() {
    if (!this.wanted) this.wanted = requestAnimationFrame((now) => this.frame(now));
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
    if (took > 4 * REST) return;
    const count = this.count * Math.max(0.5, Math.min(1.2, FRAME / took));
    this.count = Math.round(Math.max(LEAST, Math.min(this.cloud.points, count)));
  }

  resize() {
    const ratio = Math.min(2, window.devicePixelRatio || 1), {clientWidth, clientHeight} = this.canvas;
    this.canvas.width = Math.max(1, Math.round(clientWidth * ratio));
    this.canvas.height = Math.max(1, Math.round(clientHeight * ratio));
    this.redraw();
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
      if (down.size > 1 || event.buttons > 1 || event.shiftKey) {
        this.camera.pan(dx, dy, this.camera.scale(canvas.clientWidth, canvas.clientHeight));
      } else {
        this.camera.turn(0.4 * dx, 0.4 * dy);
      }
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

  key(event) {
    const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    const {clientWidth, clientHeight} = this.canvas;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const names = this.cloud.colorings().map((c) => c[0]);
    const action = step ? () => {
      if (event.shiftKey) this.camera.pan(20 * step[0], 20 * step[1], this.camera.scale(clientWidth, clientHeight));
      else this.camera.turn(5 * step[0], 5 * step[1]);
    } : {
      "+": () => this.camera.zoomBy(1.2),
      "=": () => this.camera.zoomBy(1.2),
      "-": () => this.camera.zoomBy(1 / 1.2),
      "0": () => this.reset(),
      "n": () => element("strokes").click(),
      "c": () => this.color(names[(names.indexOf(this.coloring) + 1) % names.length]),
      "Enter": () => this.pick(clientWidth / 2, clientHeight / 2),
    }[event.key];
    if (!action) return;
    action();
    event.preventDefault();
    this.redraw();
  }

  pick(x, y) {  // in the page's pixels
    const ratio = this.canvas.width / this.canvas.clientWidth;
    const i = this.drawing.pick(this.camera, {...this.options(), sided: false}, Math.floor(x * ratio), Math.floor(y * ratio));
    const facts = i < 0 ? [] : this.facts(i);
    const list = make("dl", ...facts.flatMap(([name, value]) => [make("dt", name), make("dd", value)]));
    element("picked").replaceChildren(...(facts.length ? [list] : []));
    this.draw(true);
    return i;
  }

  facts(i) {
    const cloud = this.cloud, normal = cloud.normal(i), confidence = cloud.confidence(i);
    const facts = [["point", cloud.position(i).map((v) => v.toPrecision(7)).join(", ")],
      ["normal", normal ? normal.map((v) => v.toFixed(3)).join(", ") : "none"]];
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
  const message = element("message");
  message.hidden = false;
  message.textContent = error.message === "no WebGL 2"
    ? "This page needs WebGL 2, which this browser does not have or has switched off."
    : `The cloud cannot be shown: ${error.message}`;
}
