#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
"""How fast a page is in headless Chromium with software rendering, as a Markdown table.

usage: page_benchmark.py [--repeat N] PAGE.html ...   (pages of `segorient render IN OUT.html`)

For each page: its size; milliseconds from navigation to the first picture, and to the one with all
points; frames a second while it turns, as many as the page chooses to draw. An empty page stands
beside them, loaded in turn: what the browser and the machine take. Best and median of N tries, 5 by
default.
"""

import statistics
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "program"))
sys.dont_write_bytecode = True
import browser  # noqa: E402

# When the first draw call of a frame was done, and the first frame of all points.
WATCH = """
window.times = {};
const done = (name, gl) => requestAnimationFrame(() => {
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  times[name] = times[name] || performance.now();
});
const draw = WebGL2RenderingContext.prototype.drawArrays;
WebGL2RenderingContext.prototype.drawArrays = function (mode, first, count) {
  draw.call(this, mode, first, count);
  if (!times.first) done("first", this);
  if (window.segorient && !times.all && count >= segorient.cloud.points) done("all", this);
};
"""

# Turns by pointer events for three seconds; frames a second of all but the first.
TURN = """new Promise((end) => {
  const canvas = document.getElementById("view"), stamps = [], counts = [];
  const event = (type, x) => canvas.dispatchEvent(new PointerEvent(type,
    {pointerId: 1, clientX: x, clientY: 400, buttons: 1, bubbles: true}));
  canvas.setPointerCapture = () => {};
  event("pointerdown", 300);
  const gl = segorient.drawing.gl, pixel = new Uint8Array(4);
  const step = (now) => {
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    stamps.push(performance.now());
    counts.push(segorient.count);
    event("pointermove", 300 + 7 * stamps.length % 900);
    if (stamps[stamps.length - 1] - stamps[0] < 3000) return requestAnimationFrame(step);
    event("pointerup", 300);
    const half = stamps.length >> 1;
    end({rate: 1000 * (stamps.length - 1 - half) / (stamps[stamps.length - 1] - stamps[half]), count: counts[counts.length - 1]});
  };
  requestAnimationFrame(step);
})"""
EMPTY = """<!DOCTYPE html><canvas id="view" width="1280" height="800"></canvas><script>
const gl = document.getElementById("view").getContext("webgl2");
gl.drawArrays(gl.POINTS, 0, 0);
</script>"""


def wait_for(page, name):
    until = time.monotonic() + 120
    while time.monotonic() < until:
        value = page.run(f"window.times && times.{name} || 0")
        if value:
            return value
        time.sleep(0.02)
    raise TimeoutError(name)


def main():
    words = sys.argv[1:]
    repeat = 5
    if words[:1] == ["--repeat"]:
        repeat, words = int(words[1]), words[2:]
    if not words:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as directory, browser.Browser(1280, 800) as page:
        empty = Path(directory) / "empty.html"
        empty.write_text(EMPTY)
        page.call("Page.addScriptToEvaluateOnNewDocument", source=WATCH)
        pages = [empty, *map(Path, words)]
        figures = {path: {} for path in pages}

        def add(path, name, value):
            figures[path].setdefault(name, []).append(value)

        for _ in range(repeat):
            for path in pages:
                page.load(path)
                add(path, "first", wait_for(page, "first"))
                if path == empty:
                    continue
                add(path, "all", wait_for(page, "all"))
                turned = page.run(TURN)
                add(path, "rate", turned["rate"])
                add(path, "count", turned["count"])
    print("| page | MB | first picture, ms | all points, ms | frames a second | of points |")
    print("|---|---|---|---|---|---|")

    def text(values, best):
        return f"{best(values):.0f} / {statistics.median(values):.0f}" if values else ""

    for path in pages:
        f = figures[path]
        size = f"{Path(path).stat().st_size / 1e6:.1f}" if path != empty else ""
        print(f"| {Path(path).stem} | {size} | {text(f.get('first'), min)} | {text(f.get('all'), min)} | "
              f"{text(f.get('rate'), max)} | {text(f.get('count'), max)} |")
    print("Best / median.")


if __name__ == "__main__":
    main()
