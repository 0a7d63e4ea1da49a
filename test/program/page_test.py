# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
"""Pages that `segorient render` writes, in a real browser. Environment: SEGORIENT_PROGRAM,
SEGORIENT_TEST_DATA."""

import math
import os
import random
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

import browser

PROGRAM = os.environ["SEGORIENT_PROGRAM"]
FANDISK = Path(os.environ["SEGORIENT_TEST_DATA"]) / "fandisk_16475.pcd"
WIDTH, HEIGHT, CELL = 640, 400, 40

# Of each cell of the picture: shares of pixels that are drawn and red, and the sum of colours.
PIXELS = """(() => {
  const page = window.segorient, gl = page.drawing.gl;
  page.draw(true);
  const w = gl.drawingBufferWidth, h = gl.drawingBufferHeight;
  const cell = 40 * w / page.canvas.clientWidth, one = 1 / cell ** 2;
  const p = new Uint8Array(4 * w * h), across = Math.ceil(w / cell), out = [];
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, p);
  let sum = 0;
  for (let y = 0; y < h; ++y) for (let x = 0; x < w; ++x) {
    const i = 4 * ((h - 1 - y) * w + x), c = Math.floor(y / cell) * across + Math.floor(x / cell);
    out[c] = out[c] || [0, 0];
    if (p[i] + p[i + 1] + p[i + 2] < 765) out[c][0] += one;
    if (p[i] > 2 * p[i + 1] && p[i] > 2 * p[i + 2]) out[c][1] += one;
    sum = (sum * 31 + p[i] + 3 * p[i + 1] + 7 * p[i + 2]) % 1000003;
  }
  return {cells: out, sum};
})()"""


def run(*words):
    subprocess.run([PROGRAM, *map(str, words), "--quiet"], check=True)


def rows_of(png):
    """Rows of red, green, blue bytes of a PNG with 8 bits a channel."""
    data, at, packed = png.read_bytes(), 8, b""
    while at < len(data):
        size, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        if kind == b"IHDR":
            width, height = (int.from_bytes(data[at + k:at + k + 4], "big") for k in (8, 12))
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    raw, stride = zlib.decompress(packed), 3 * width
    above, rows = bytearray(stride), []
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left, up, corner = (row[i - 3] if i >= 3 else 0), above[i], (above[i - 3] if i >= 3 else 0)
            if kind == 4:
                guess = left + up - corner
                near = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]
            else:
                near = (0, left, up, (left + up) // 2)[kind]
            row[i] = (row[i] + near) & 255
        rows.append(row)
        above = row
    return rows


def cells_of(png):
    rows = rows_of(png)
    across = math.ceil(len(rows[0]) // 3 / CELL)
    cells = [[0.0, 0.0] for _ in range(across * math.ceil(len(rows) / CELL))]
    for y, row in enumerate(rows):
        for x in range(len(row) // 3):
            r, g, b = row[3 * x:3 * x + 3]
            cell = cells[y // CELL * across + x // CELL]
            cell[0] += (r + g + b < 765) / CELL**2
            cell[1] += (r > 2 * g and r > 2 * b) / CELL**2
    return cells


def ball(path, wrong, colors=False):
    """Points of a ball and its normals; those above `wrong` point inward."""
    chance = random.Random(3)
    lines = []
    for _ in range(5000):
        p = [chance.gauss(0, 1) for _ in range(3)]
        p = [v / math.hypot(*p) for v in p]
        n = [-v if p[2] > wrong else v for v in p]
        color = " 250 120 0" if colors else ""
        lines.append(" ".join(f"{v:.6f}" for v in p + n) + color)
    names = ["float x", "float y", "float z", "float nx", "float ny", "float nz"]
    names += ["uchar red", "uchar green", "uchar blue"] * colors
    path.write_text(f"ply\nformat ascii 1.0\nelement vertex {len(lines)}\n"
                    + "".join(f"property {name}\n" for name in names) + "end_header\n" + "\n".join(lines) + "\n")


@unittest.skipUnless(browser.find(), "no browser is installed")
class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory()
        cls.at = Path(cls.directory.name)
        run("orient", FANDISK, cls.at / "fandisk.pcd", "--report", cls.at / "report.json")
        run("render", cls.at / "fandisk.pcd", cls.at / "fandisk.html", "--report", cls.at / "report.json")
        ball(cls.at / "turned.ply", 0.3)
        (cls.at / "sensors.xyz").write_text("0 0 1.05\n")
        run("render", cls.at / "turned.ply", cls.at / "turned.html", "--sensors", cls.at / "sensors.xyz")
        ball(cls.at / "colored.ply", 2, colors=True)
        run("render", cls.at / "colored.ply", cls.at / "colored.html", "--points", "2000")
        chance = random.Random(4)
        lines = []
        for i in range(3000):
            p = [chance.gauss(0, 1) for _ in range(3)]
            p = [v / math.hypot(*p) for v in p]
            lines.append(" ".join(f"{v:.5f}" for v in p + p) + f" {i % 2}")
        (cls.at / "scans.txt").write_text("x y z normal_x normal_y normal_z scan\n" + "\n".join(lines) + "\n")
        run("render", cls.at / "scans.txt", cls.at / "scans.html")
        (cls.at / "large.xyz").write_text("".join(f"{i % 300} {i // 300} {chance.random():.3f}\n" for i in range(60000)))
        run("render", cls.at / "large.xyz", cls.at / "large.html")
        cls.browser = browser.Browser(WIDTH, HEIGHT)

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()
        cls.directory.cleanup()

    def load(self, name, width=WIDTH, height=HEIGHT):
        self.browser.resize(width, height)
        self.browser.load(self.at / name)
        self.run_js("new Promise((done) => setTimeout(done, 100))")

    def run_js(self, text):
        return self.browser.run(text)

    def tearDown(self):
        self.assertEqual(self.browser.errors, [])
        self.assertTrue(all(url.startswith(("file://", "data:")) for url in self.browser.requests))
        self.assertEqual(sum(url.startswith("file://") for url in self.browser.requests), 1)

    def pixels(self):
        return self.run_js(PIXELS)

    def compare(self, name, cloud, *options):
        """The page against the program's picture of the same cloud: what is drawn, and what is red."""
        self.load(name)
        page = self.pixels()["cells"]
        width, height = self.run_js("[segorient.canvas.clientWidth, segorient.canvas.clientHeight]")
        run("render", self.at / cloud, self.at / "a.png", "--single", "--width", width, "--height", height, *options)
        picture = cells_of(self.at / "a.png")
        self.assertEqual(len(page), len(picture))
        for k, limit in ((0, 0.03), (1, 0.03)):
            difference = sum(abs(a[k] - b[k]) for a, b in zip(page, picture)) / len(page)
            self.assertLess(difference, limit, ("drawn", "red")[k])
        return [sum(cell[k] for cell in page) / len(page) for k in (0, 1)]

    def test_a_cloud_that_is_right_is_drawn_as_by_the_program(self):
        drawn, red = self.compare("fandisk.html", "fandisk.pcd", "--color", "normal")
        self.assertGreater(drawn, 0.2)
        self.assertLess(red, 0.002)

    def test_a_patch_that_is_wrong_is_red(self):
        _, red = self.compare("turned.html", "turned.ply", "--color", "normal")
        self.assertGreater(red, 0.05)

    def test_it_turns_by_pointer_and_keys_and_comes_back(self):
        self.load("fandisk.html")
        home = self.pixels()["sum"]
        camera = "[segorient.camera.azimuth, segorient.camera.elevation, segorient.camera.zoom, ...segorient.camera.center]"
        start = self.run_js(camera)
        self.browser.drag(300, 200, 400, 230)
        turned = self.run_js(camera)
        self.assertAlmostEqual(turned[0], (start[0] - 40) % 360, delta=1)
        self.assertAlmostEqual(turned[1], start[1] + 12, delta=1)
        self.assertNotEqual(self.pixels()["sum"], home)
        self.run_js("document.getElementById('view').focus()")
        self.browser.key("ArrowLeft", 37)
        self.assertAlmostEqual(self.run_js(camera)[0], (turned[0] + 5) % 360, delta=0.1)
        self.browser.key("+", 187)
        self.assertAlmostEqual(self.run_js(camera)[2], 1.2, delta=0.01)
        self.browser.key("ArrowUp", 38, modifiers=8)
        self.assertNotEqual(self.run_js(camera)[3:], start[3:])
        self.browser.key("0", 48)
        self.assertEqual(self.run_js(camera), start)
        self.assertEqual(self.pixels()["sum"], home)

    def test_wheel_and_two_fingers_zoom(self):
        self.load("fandisk.html")
        self.browser.mouse("mouseWheel", 300, 200, deltaX=0, deltaY=-200)
        zoom = self.run_js("segorient.camera.zoom")
        self.assertGreater(zoom, 1.2)
        for kind, left, right in (("touchStart", 280, 320), ("touchMove", 240, 360), ("touchMove", 240, 360)):
            points = [{"x": left, "y": 200, "id": 1}, {"x": right, "y": 200, "id": 2}]
            self.browser.call("Input.dispatchTouchEvent", type=kind, touchPoints=points)
        self.browser.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
        self.assertGreater(self.run_js("segorient.camera.zoom"), 1.5 * zoom)

    def test_every_colour_and_switch_changes_the_picture(self):
        for name, colorings in (
            ("fandisk.html", ["orientation", "segment", "normal", "confidence", "height"]),
            ("colored.html", ["orientation", "normal", "rgb", "height"]),
        ):
            self.load(name)
            self.assertEqual(self.run_js("[...document.getElementById('coloring').options].map((o) => o.value)"), colorings)
            sums = []
            for coloring in colorings:
                self.assertEqual(self.run_js("segorient.coloring"), coloring)
                sums.append(self.pixels()["sum"])
                self.run_js("document.getElementById('view').focus()")
                self.browser.key("c", 67)
            self.assertEqual(len(set(sums)), len(colorings))
            self.assertEqual(self.run_js("segorient.coloring"), colorings[0])
        self.run_js("document.getElementById('strokes').click()")
        self.assertNotEqual(self.pixels()["sum"], sums[0])
        self.run_js("document.getElementById('strokes').click()")
        self.assertEqual(self.pixels()["sum"], sums[0])
        drawn = sum(cell[0] for cell in self.pixels()["cells"])
        self.run_js("(() => { const c = document.getElementById('cut'); c.value = 500; c.oninput(); })()")
        self.assertLess(sum(cell[0] for cell in self.pixels()["cells"]), 0.9 * drawn)

    def test_a_point_is_picked_and_told(self):
        self.load("fandisk.html")
        self.browser.click(WIDTH / 2, HEIGHT / 2 + 20)  # the middle of what is below the controls
        facts = dict(self.run_js("[...document.querySelectorAll('#picked dt')].map((t) => [t.textContent,"
                                 " t.nextSibling.textContent])"))
        self.assertEqual(list(facts), ["point", "normal", "segment", "decided", "side", "confidence"])
        self.assertIn("oriented by global", facts["decided"])
        normal = [float(v) for v in facts["normal"].split(",")]
        self.assertAlmostEqual(math.hypot(*normal), 1, delta=0.01)
        self.assertGreaterEqual(float(facts["confidence"]), 0)
        self.browser.click(3, HEIGHT - 3)  # beside the cloud
        self.assertTrue(self.run_js("document.getElementById('picked').hidden"))

    def test_scans_have_colours_and_sides_are_told(self):
        self.load("scans.html")
        self.assertEqual(self.run_js("[...document.getElementById('coloring').options].map((o) => o.value)"),
                         ["orientation", "normal", "scan", "height"])
        self.browser.click(WIDTH / 2, HEIGHT / 2 + 20)  # the middle of what is below the controls
        told = "Object.fromEntries([...document.querySelectorAll('#picked dt')].map((t) => [t.textContent, t.nextSibling.textContent]))"
        facts = self.run_js(told)
        self.assertIn(facts["scan"], ("0", "1"))
        self.assertEqual(facts["side"], "outside")
        before = self.pixels()["sum"]
        self.run_js("segorient.color('scan')")
        self.assertNotEqual(self.pixels()["sum"], before)
        self.load("turned.html")
        self.run_js("segorient.camera.turn(0, 90)")  # from above, where normals point inward
        self.run_js("segorient.pick(320, 200)")
        self.assertEqual(self.run_js(told)["side"], "wrong")

    def test_the_first_points_come_before_the_others(self):
        self.load("large.html")
        self.run_js("new Promise((done) => setTimeout(done, 1500))")
        self.assertEqual(self.run_js("segorient.cloud.loaded"), 60000)
        self.assertEqual(self.run_js("segorient.cloud.points"), 60000)
        self.assertEqual(self.run_js("segorient.drawing.cloud === segorient.cloud"), True)

    def test_every_array_arrives_as_it_was_written(self):
        self.load("scans.html")
        rows = self.run_js("Array.from({length: segorient.cloud.loaded}, (_, i) => { const c = segorient.cloud;"
                           " return [c.place(i).map((v, a) => c.low[a] + c.extent * v), c.normal(i),"
                           " c.scans[c.scanOf[i]].label]; })")
        given = [[float(v) for v in line.split()] for line in (self.at / "scans.txt").read_text().splitlines()[1:]]
        self.assertEqual(len(rows), len(given))
        for place, normal, scan in rows:
            nearest = min(given, key=lambda v: math.dist(v[:3], place))
            given.remove(nearest)
            self.assertLess(math.dist(nearest[:3], place), 3e-5)
            self.assertLess(math.dist(nearest[3:6], normal), 0.02)
            self.assertEqual(scan, nearest[6])

    def test_sensors_are_marked(self):
        self.load("turned.html")
        self.assertEqual(self.run_js("segorient.drawing.marks.count"), 1)
        before = self.pixels()["sum"]
        self.run_js("document.getElementById('marks').click()")
        self.assertNotEqual(self.pixels()["sum"], before)

    def test_a_large_cloud_is_thinned_and_says_so(self):
        self.load("colored.html")
        self.assertEqual(self.run_js("segorient.cloud.points"), 2000)
        self.assertIn("2,000 of 5,000 points", self.run_js("document.getElementById('count').textContent"))

    def test_it_fits_a_phone(self):
        self.load("fandisk.html", 360, 640)
        self.assertLessEqual(self.run_js("document.documentElement.scrollWidth"), 360)
        self.assertTrue(self.run_js("[...document.querySelectorAll('#tools *')].every((e) => "
                                    "e.getBoundingClientRect().right <= 360)"))
        self.assertGreater(sum(cell[0] for cell in self.pixels()["cells"]), 5)

    def test_all_controls_have_names(self):
        self.load("fandisk.html")
        nodes = self.browser.call("Accessibility.getFullAXTree")["nodes"]
        roles = [(n["role"]["value"], n.get("name", {}).get("value", "")) for n in nodes if not n.get("ignored")]
        for role in ("image", "combobox", "checkbox", "slider", "button"):
            names = [name for kind, name in roles if kind == role]
            self.assertTrue(names and all(names), (role, roles))

    def test_without_webgl_it_says_what_is_missing(self):
        script = self.browser.call("Page.addScriptToEvaluateOnNewDocument",
                                   source="HTMLCanvasElement.prototype.getContext = () => null")["identifier"]
        self.load("fandisk.html")
        self.browser.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script)
        self.assertIn("WebGL 2", self.run_js("document.getElementById('message').innerText"))


if __name__ == "__main__":
    if not browser.find():
        print("no browser is installed: pages are not tested")
        sys.exit(0)
    unittest.main(verbosity=2)
