# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
"""The Python package against analytic surfaces, brute force and the program."""

import inspect
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.request
import warnings
from pathlib import Path
from unittest import mock

import numpy as np

import segorient

MAP = np.array([500000.125, 5400000.5, 312.25])  # map coordinates, metres


def sphere(n=3000, centre=(0.0, 0.0, 0.0), radius=1.0):
    """Points and outward normals of a sphere."""
    i = np.arange(n)
    z = 1.0 - 2.0 * (i + 0.5) / n
    r = np.sqrt(1.0 - z * z)
    angle = 2.399963229728653 * i
    outward = np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)
    return np.asarray(centre) + radius * outward, outward


def cube(n=2000, seed=3):
    """Points of a cube's faces, outward normals and faces."""
    random = np.random.default_rng(seed)
    points = random.uniform(-1.0, 1.0, (n, 3))
    face = random.integers(0, 6, n)
    outward = np.zeros((n, 3))
    outward[np.arange(n), face % 3] = np.where(face < 3, 1.0, -1.0)
    points[np.arange(n), face % 3] = outward[np.arange(n), face % 3]
    return points, outward, face


def bowl(n=3000):
    """The lower part of a sphere: open, so that nothing but a viewpoint tells its sides."""
    points, outward = sphere(2 * n)
    chosen = points[:, 2] < 0.0
    return points[chosen], outward[chosen]


def share(a, b):
    return np.mean((a * b).sum(axis=1) > 0.0)


class Orient(unittest.TestCase):
    def test_a_sphere_is_oriented_outward_and_results_are_as_documented(self):
        points, outward = sphere()
        result = segorient.orient(points)
        n = len(points)
        self.assertEqual(share(result.normals, outward), 1.0)
        self.assertGreater((result.normals * outward).sum(axis=1).min(), 0.98)
        for array, shape, kind in (
            (result.normals, (n, 3), np.float32),
            (result.curvatures, (n,), np.float32),
            (result.labels, (n,), np.int32),
            (result.confidences, (n,), np.float32),
            (result.components, (n,), np.int32),
        ):
            self.assertEqual(array.shape, shape)
            self.assertEqual(array.dtype, kind)
        self.assertEqual(result.report["points"], n)
        self.assertEqual(len(result.report["components"]), 1)
        self.assertEqual(set(np.unique(result.components)), {0})
        normals, *_ = result  # a plain tuple as well
        self.assertIs(normals, result.normals)

    def test_the_result_shows_itself_as_one_page(self):
        points, _, _ = cube()
        cloud = segorient.orient(points + MAP, viewpoints=np.tile(MAP + [0.0, 0.0, 9.0], (len(points), 1)))
        with tempfile.TemporaryDirectory() as directory:
            path = Path(directory) / "cloud.html"
            cloud.save_html(path, points=500, title="<a cube>")
            page = path.read_text()
            self.assertEqual(os.listdir(directory), ["cloud.html"])
            head = json.loads(re.search('id="head">(.*?)</script>', page, re.DOTALL).group(1))
            self.assertEqual(head["title"], "<a cube>")
            self.assertEqual((head["points"], head["all"]), (500, len(points)))
            self.assertLess(np.abs(np.array(head["low"]) - (points + MAP).min(axis=0)).max(), 0.01)
            self.assertEqual(len(head["sensors"]), 1)
            self.assertIn("by ", head["segments"][0]["text"])
            for name in ("positions", "normals", "labels", "confidences"):
                self.assertIn(f'id="{name}"', page)
            self.assertNotRegex(page.replace("http://www.w3.org", ""), "https?://")
            missing = Path(directory) / "none" / "cloud.html"
            with self.assertRaises(OSError):
                cloud.save_html(missing)
            for wrong in (0, -1):
                with self.assertRaises(ValueError):
                    cloud.save_html(path, points=wrong)
            with self.assertRaises(TypeError):
                cloud.save_html(path, points="many")
            self.assertEqual(path.read_text(), page)  # what was there stays
        frame = cloud._repr_html_()
        self.assertTrue(frame.startswith("<iframe") and frame.endswith("</iframe>"))
        self.assertIn("&lt;canvas", frame)
        with mock.patch("webbrowser.open") as opened:
            cloud.show()
        shown = Path(urllib.request.url2pathname(opened.call_args.args[0][len("file://"):]))
        self.assertIn("<canvas", shown.read_text())
        shown.unlink()
        shown.parent.rmdir()

    def test_a_page_of_nothing_and_of_broken_points(self):
        for points in (np.zeros((0, 3)), np.zeros((1, 3)), np.full((3, 3), np.nan)):
            self.assertIn("iframe", segorient.orient(points)._repr_html_())

    def test_a_cube_far_from_the_origin_loses_nothing_in_float64(self):
        points, outward, face = cube()
        near = segorient.orient(points)
        far = segorient.orient(points + MAP)
        self.assertGreater(share(near.normals, outward), 0.999)
        self.assertGreater(share(far.normals, outward), 0.999)
        self.assertGreater(np.mean((near.normals * far.normals).sum(axis=1) > 0.999), 0.99)
        self.assertEqual(near.report["segments_by_kind"]["regular"], 6)

    def test_any_layout_gives_the_same(self):
        points = sphere(1500)[0].astype(np.float32)
        wide = np.zeros((1500, 7), np.float32)
        wide[:, 2:5] = points
        expected = segorient.orient(points).normals
        for name, array in (
            ("columns of a wider array", wide[:, 2:5]),
            ("column-major", np.asfortranarray(points)),
            ("every other row", np.repeat(points, 2, axis=0)[::2]),
            ("reversed", points[::-1][::-1]),
            ("big endian", points.astype(">f4")),
            ("float64", points.astype(np.float64)),
            ("list", points.tolist()),
        ):
            with self.subTest(name):
                np.testing.assert_array_equal(segorient.orient(array).normals, expected)
        flipped = segorient.orient(points[::-1]).normals
        np.testing.assert_array_equal(flipped[::-1], expected)
        whole = (1000.0 * points).astype(np.int64)
        self.assertEqual(share(segorient.orient(whole).normals, points), 1.0)

    def test_hints_decide_what_the_surface_leaves_open(self):
        points, outward = bowl()
        points = points + MAP
        above = MAP + [0.0, 0.0, 50.0]
        below = MAP - [0.0, 0.0, 50.0]
        rows = np.tile(below, (len(points), 1))
        some = slice(0, 5)
        for name, hints, sign in (
            ("viewpoint above", {"viewpoint": above, "closed": False}, -1.0),
            ("viewpoint below", {"viewpoint": below, "closed": False}, 1.0),
            ("viewpoints", {"viewpoints": rows, "closed": False}, 1.0),
            ("keep", {"keep": -outward}, -1.0),
            ("seeds", {"seeds": (points[some], outward[some])}, 1.0),
            ("other seeds", {"seeds": (points[some], -outward[some])}, -1.0),
        ):
            with self.subTest(name):
                result = segorient.orient(points, **hints)
                self.assertEqual(share(result.normals, sign * outward), 1.0)

    def test_arguments_without_effect_are_named(self):
        points, _ = sphere(300)
        cases = (
            ("gamma", lambda: segorient.orient(points, gamma=20)),
            ("normals", lambda: segorient.orient(points, normals="ldt")),
            ("recompute", lambda: segorient.orient(points, recompute=1)),
            ("viewpoint", lambda: segorient.orient(points, method="combined", viewpoint=[9, 0, 0])),
            ("delta", lambda: segorient.orient(points, method="combined", delta=20)),
            ("alpha", lambda: segorient.normals(points, alpha=20)),
            ("delta", lambda: segorient.segment(points, delta=20)),
            ("faces", lambda: segorient.segment(points, method="combined", faces=True)),
        )
        for name, call in cases:
            with self.assertWarnsRegex(UserWarning, f"^{name} changes nothing") as caught:
                call()
            self.assertEqual(caught.filename, __file__)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            segorient.orient(points, method="combined", gamma=20, normals="ldt", recompute=1, delta=20)
            segorient.orient(points, viewpoint=[9, 0, 0], closed=True)
            segorient.normals(points, recompute=1, alpha=20)
            segorient.segment(points, faces=True)

    def test_every_method_and_option_is_taken(self):
        points, outward, _ = cube()
        for method in ("auto", "propagation", "boundary", "combined", "extremal"):
            with self.subTest(method), warnings.catch_warnings():
                if method == "auto":  # some are for the others, and are named
                    warnings.simplefilter("ignore")
                result = segorient.orient(
                    points, method=method, k=14, normals="ldt", alpha=20, beta=30.0, gamma=35,
                    delta=np.float32(30), epsilon=10, recompute=1, threads=1)
                self.assertEqual(result.report["method"], method)
                self.assertGreater(share(result.normals, outward), 0.99)
                np.testing.assert_array_equal(
                    result.normals,
                    segorient.orient(
                        points, method=method, k=14, normals="ldt", alpha=20, beta=30, gamma=35,
                        delta=30, epsilon=10, recompute=1, threads=2).normals)


class Sensors(unittest.TestCase):
    def test_up_and_a_trajectory_tell_the_side_of_a_bowl(self):
        points, outward = bowl()
        points = points + MAP
        inward = segorient.orient(points, up=True, closed=False)
        self.assertEqual(share(inward.normals, -outward), 1.0)
        times = np.linspace(0.0, 10.0, len(points))
        below = np.array([[0.0, 0.0, 0.0, -9.0], [10.0, 0.0, 0.0, -9.0]]) + np.concatenate([[0.0], MAP])
        down = segorient.orient(points, trajectory=below, times=times, closed=False)
        self.assertEqual(share(down.normals, outward), 1.0)

    def test_the_end_of_a_trajectory_is_said(self):
        points, _ = bowl()
        times = np.linspace(0.0, 10.0, len(points))
        with self.assertWarnsRegex(UserWarning, "outside of the trajectory"):
            segorient.orient(points, trajectory=[[0, 0, 0, 9], [5, 0, 0, 9]], times=times)
        with self.assertRaisesRegex(ValueError, "points 0 to 10, trajectory 20 to 30"):
            segorient.orient(points, trajectory=[[20, 0, 0, 9], [30, 0, 0, 9]], times=times)

    def test_scans_and_grids_are_taken(self):
        x, y = np.meshgrid(np.linspace(-1, 1, 40), np.linspace(-1, 1, 30))
        points = np.stack([x, y, np.full_like(x, 2.0)], axis=-1).reshape(-1, 3)
        scans = np.repeat([0, 1], 600)
        result = segorient.orient(points, organized=(30, 40), scans=scans, viewpoint=(0, 0, 0))
        self.assertTrue((result.normals[:, 2] < 0.0).all())

    def test_bad_ones_are_errors_that_say_why(self):
        points, _ = bowl()
        n = len(points)
        path = [[0, 0, 0, 0]]
        for error, text, options in (
            (TypeError, "belong together", {"trajectory": path}),
            (TypeError, "belong together", {"times": np.zeros(n)}),
            (ValueError, "\\(m, 4\\)", {"trajectory": np.zeros((2, 3)), "times": np.zeros(n)}),
            (ValueError, "times must have one", {"trajectory": path, "times": np.zeros(3)}),
            (TypeError, "up must be", {"up": 1}),
            (ValueError, "exclude each other", {"up": True, "viewpoint": (0, 0, 0)}),
            (TypeError, "scans must be whole", {"scans": np.zeros(n)}),
            (ValueError, "scans must have", {"scans": [1, 2]}),
            (ValueError, "height and width", {"organized": (2, 3)}),
            (TypeError, "organized", {"organized": 5}),
        ):
            with self.subTest(options=list(options)), self.assertRaisesRegex(error, text):
                segorient.orient(points, **options)


class CheckNormals(unittest.TestCase):
    def test_right_normals_and_a_cap_that_is_turned_over(self):
        points, outward = sphere()
        points = points + MAP
        right = segorient.check(points, outward)
        self.assertFalse(right.contradictions.any())
        self.assertEqual(right.report["places"], [])
        cap = outward[:, 2] > 0.8
        turned = np.where(cap[:, None], -outward, outward)
        found = segorient.check(points, turned)
        self.assertTrue((found.contradictions[cap] == 2).all())
        self.assertFalse(found.contradictions[~cap].any())
        np.testing.assert_array_equal(found.places, np.where(cap, 0, -1))
        place = found.report["places"][0]
        self.assertEqual(place["contradicts"], "surface")
        self.assertLess(np.abs(np.array([place["x"], place["y"], place["z"]]) - MAP - [0, 0, 0.9]).max(), 0.05)

    def test_a_sensor_tells_the_side_of_an_open_surface(self):
        points, outward = bowl()
        self.assertEqual(segorient.check(points, outward, closed=False).report["contradicting"], 0)
        found = segorient.check(points, outward, up=True)
        self.assertEqual(found.report["places"][0]["contradicts"], "sensor")

    def test_bad_arguments(self):
        points, outward = sphere(100)
        with self.assertRaises(ValueError):
            segorient.check(points, outward[:50])
        with self.assertRaises(TypeError):
            segorient.check(points, outward, closed=1)


class OtherStages(unittest.TestCase):
    def test_normals_of_a_sphere_by_every_estimator(self):
        points, outward = sphere()
        for name in ("plane", "lct", "ldt", "awas", "awas3"):
            with self.subTest(name):
                result = segorient.normals(points, normals=name)
                cosine = np.abs((result.normals * outward).sum(axis=1))
                self.assertGreater(cosine.min(), 0.99)
                self.assertTrue((result.curvatures >= 0.0).all())

    def test_recomputation_sharpens_the_edges_of_a_cube(self):
        points, outward, _ = cube(6000)

        def rms(normals):
            cosine = np.abs((normals * outward).sum(axis=1)).clip(0.0, 1.0)
            return np.sqrt(np.mean(np.degrees(np.arccos(cosine)) ** 2))

        plain = rms(segorient.normals(points).normals)
        self.assertLess(rms(segorient.normals(points, recompute=1).normals), 0.6 * plain)
        self.assertLess(rms(segorient.normals(points, recompute=1, delta=40).normals), 0.9 * plain)

    def test_segments_are_the_faces_of_a_cube(self):
        points, outward, face = cube(6000)
        result = segorient.segment(points)
        self.assertEqual(result.labels.max() + 1, len(result.kinds))
        for f in range(6):
            labels = result.labels[face == f]
            most = np.bincount(labels).argmax()
            self.assertGreater(np.mean(labels == most), 0.9)
            own = result.normals[result.labels == most]
            self.assertGreater((own @ own[0]).min(), 0.0)

    def test_neighbours_are_those_of_brute_force(self):
        points = np.random.default_rng(5).normal(size=(400, 3)).astype(np.float32)
        queries = np.random.default_rng(6).normal(size=(50, 3))
        for places, result in (
            (points, segorient.knn(points, 7)),
            (queries, segorient.knn(points, 7, queries=queries)),
        ):
            distances = np.linalg.norm(points[None].astype(float) - places[:, None], axis=2)
            np.testing.assert_allclose(result.distances, np.sort(distances)[:, :7], atol=1e-6)
            np.testing.assert_allclose(
                np.take_along_axis(distances, result.indices.astype(int), 1), result.distances, atol=1e-6)
        np.testing.assert_array_equal(segorient.knn(points, 3).indices[:, 0], np.arange(400))
        far = segorient.knn(points.astype(float) + MAP, 7, queries=points[:9] + MAP)
        np.testing.assert_array_equal(far.indices, segorient.knn(points, 7).indices[:9])

    def test_a_camera_is_found_by_its_image(self):
        v, u = np.mgrid[0:30, 0:40]
        depth = np.where(u < 15, 2.0, 3.0) + 0.02 * v
        points = np.stack([depth * (u - 20) / 50, depth * (v - 15) / 50, depth], -1).reshape(-1, 3)
        for shift in (np.array([1.0, 2.0, 3.0]), np.array([500000.0, 6000000.0, 100.0])):
            found = segorient.sensors(points + shift, width=40)
            self.assertEqual(len(found.sensors), 1)
            camera = found.sensors[0]
            self.assertEqual((camera["kind"], camera["sure"]), ("camera", True))
            np.testing.assert_allclose([camera[a] for a in "xyz"], shift, atol=0.05)
            np.testing.assert_array_equal(found.sensor_of, np.zeros(len(points), np.int32))
        nothing = segorient.sensors(sphere()[0])
        self.assertEqual(nothing.sensors, [])
        self.assertEqual(nothing.directions.shape, (0, 3))
        self.assertRaises(ValueError, segorient.sensors, points, width=-1)
        self.assertRaises(ValueError, segorient.sensors, points, suggestions=[1.0, 2.0, 3.0])
        self.assertRaises(TypeError, segorient.orient, points, find_sensors=1)

    def test_what_is_not_there_is_said(self):
        points = sphere(500)[0]
        points[7] = np.nan
        points[9, 1] = np.inf
        result = segorient.orient(points)
        self.assertTrue(np.isnan(result.normals[[7, 9]]).all())
        self.assertEqual(list(result.labels[[7, 9]]), [-1, -1])
        self.assertEqual(result.report["non_finite"], 2)
        few = segorient.knn(points[:3], 5)
        self.assertEqual(sorted(few.indices[0, :3]), [0, 1, 2])
        self.assertEqual(list(few.indices[0, 3:]), [-1, -1])
        self.assertTrue(np.isinf(few.distances[0, 3:]).all())
        for empty in (np.zeros((0, 3)), np.zeros((0, 3), np.float32)):
            self.assertEqual(segorient.orient(empty).normals.shape, (0, 3))
            self.assertEqual(segorient.normals(empty).normals.shape, (0, 3))
            self.assertEqual(segorient.segment(empty).labels.shape, (0,))
            self.assertEqual(segorient.knn(empty, 4).indices.shape, (0, 4))
        for n in (1, 2, 3):
            self.assertTrue(np.isnan(segorient.orient(np.zeros((n, 3))).normals).all())


class BadArguments(unittest.TestCase):
    def test_are_errors_that_say_why(self):
        good = sphere(50)[0]
        for error, text, call in (
            (ValueError, r"\(n, 3\)", lambda: segorient.orient(np.zeros(3))),
            (ValueError, r"\(n, 3\)", lambda: segorient.orient(np.zeros((4, 2)))),
            (ValueError, r"\(n, 3\)", lambda: segorient.knn(np.zeros((2, 3, 3)))),
            (TypeError, "real numbers", lambda: segorient.orient(np.zeros((4, 3), complex))),
            (TypeError, "real numbers", lambda: segorient.orient([["a", "b", "c"]])),
            (TypeError, "real numbers", lambda: segorient.normals(None)),
            (ValueError, "method must be", lambda: segorient.orient(good, method="best")),
            (TypeError, "method", lambda: segorient.orient(good, method=1)),
            (ValueError, "normals must be", lambda: segorient.normals(good, normals="fft")),
            (ValueError, "k must be", lambda: segorient.normals(good, k=0)),
            (TypeError, "k must be", lambda: segorient.normals(good, k=2.5)),
            (TypeError, "k and threads", lambda: segorient.knn(good, None)),
            (ValueError, "alpha", lambda: segorient.segment(good, alpha=-1)),
            (ValueError, "beta", lambda: segorient.segment(good, beta=float("nan"))),
            (TypeError, "gamma", lambda: segorient.orient(good, gamma="35")),
            (ValueError, "threads", lambda: segorient.orient(good, threads=-1)),
            (TypeError, "split", lambda: segorient.segment(good, split=1.5)),
            (TypeError, "faces", lambda: segorient.segment(good, faces=1.5)),
            (ValueError, "faces", lambda: segorient.segment(good, faces=True, split=True)),
            (TypeError, "closed", lambda: segorient.orient(good, closed="yes")),
            (ValueError, "viewpoint", lambda: segorient.orient(good, viewpoint=[1, 2])),
            (TypeError, "viewpoint", lambda: segorient.orient(good, viewpoint="above")),
            (ValueError, "not finite", lambda: segorient.orient(good, viewpoint=[np.nan, 0, 0])),
            (ValueError, "normals has none", lambda: segorient.check(good, 0.0 * good)),
            (ValueError, "viewpoints", lambda: segorient.orient(good, viewpoints=good[1:])),
            (ValueError, "keep", lambda: segorient.orient(good, keep=good[1:])),
            (TypeError, "seeds", lambda: segorient.orient(good, seeds=good)),
            (ValueError, "seeds", lambda: segorient.orient(good, seeds=(good, good[1:]))),
            (TypeError, "unexpected keyword", lambda: segorient.orient(good, speed=1)),
            (TypeError, "callable|not supported|incompatible", lambda: segorient.orient(good, progress=3)),
        ):
            with self.subTest(text=text):
                self.assertRaisesRegex(error, text, call)


class Memory(unittest.TestCase):
    def test_float_arrays_are_not_copied_and_results_outlive_their_source(self):
        import tracemalloc

        points = sphere(200000)[0].astype(np.float32)
        tracemalloc.start()
        result = segorient.normals(points, k=4)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        self.assertLess(peak, points.nbytes / 4)  # numpy tells tracemalloc of every array it makes
        expected = result.normals.copy()
        normals = result.normals
        del result, points
        np.testing.assert_array_equal(normals, expected)
        normals[0] = 0.0  # and they may be written to

    def test_input_is_left_alone(self):
        points = sphere(500)[0] + MAP
        before = points.copy()
        points.flags.writeable = False
        segorient.orient(points, keep=points)
        np.testing.assert_array_equal(points, before)
        readonly = before.astype(np.float32)
        readonly.flags.writeable = False
        segorient.orient(readonly)


class Running(unittest.TestCase):
    def longest_pause_of_others(self, points):
        """While neighbours are searched, as a share of the time that this takes."""
        ticks = []
        done = threading.Event()

        def tick():
            while not done.is_set():
                ticks.append(time.perf_counter())
                time.sleep(0.001)

        thread = threading.Thread(target=tick)
        thread.start()
        begin = time.perf_counter()
        segorient.knn(points, 20, threads=1)
        end = time.perf_counter()
        done.set()
        thread.join()
        inside = [begin] + [t for t in ticks if begin < t < end] + [end]
        return np.diff(inside).max() / (end - begin)

    def test_other_threads_go_on(self):
        points = sphere(300000)[0].astype(np.float32)
        # With the lock held nothing would ever happen in between. Without it, a machine that is
        # busy with other things may still leave a thread waiting now and then.
        self.assertTrue(any(self.longest_pause_of_others(points) < 0.5 for _ in range(5)))

    def test_progress_is_told_and_may_end_the_work(self):
        told = []
        segorient.orient(sphere(1000)[0], progress=lambda stage, fraction: told.append((stage, fraction)))
        self.assertEqual(told[0], ("search", 0.0))
        self.assertEqual(told[-1][1], 1.0)
        self.assertEqual(sorted(f for _, f in told), [f for _, f in told])

        def stop(stage, fraction):
            raise KeyError(stage)

        for function in (segorient.orient, segorient.normals, segorient.segment):
            self.assertRaises(KeyError, function, sphere(1000)[0], progress=stop)

    def test_control_c_ends_the_work(self):
        def interrupt(stage, fraction):
            os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            segorient.orient(sphere(1000)[0], progress=interrupt)


class Inputs(unittest.TestCase):
    def test_a_mask_hides_points(self):
        points, outward = sphere(2000)
        hidden = np.zeros(points.shape, bool)
        hidden[::50, 1] = True
        for dtype in (np.float64, np.float32):
            spoilt = np.where(hidden, 77.0, points).astype(dtype)
            cloud = segorient.orient(np.ma.masked_array(spoilt, hidden))
            self.assertTrue(np.isnan(cloud.normals[::50]).all())
            rest = ~hidden.any(axis=1)
            self.assertTrue((np.sum(cloud.normals[rest] * outward[rest], axis=1) > 0.5).all())
            plain = segorient.orient(points[rest].astype(dtype))
            np.testing.assert_array_equal(cloud.normals[rest], plain.normals)
        whole = np.ma.masked_array((100.0 * points).astype(np.int32), hidden)
        self.assertTrue((segorient.knn(whole, 3).indices[::50] == -1).all())

    def test_a_structured_array_gets_the_remedy(self):
        fields = np.zeros(10, [("x", "f4"), ("y", "f4"), ("z", "f4")])
        with self.assertRaisesRegex(TypeError, "structured_to_unstructured"):
            segorient.orient(fields)

    def test_strays_do_not_cost_precision(self):
        points, outward = sphere(2000, MAP, 5.0)
        for at in (0.0, 1e30, np.nan):
            for count in (1, 10, 100):
                with self.subTest(f"{count} at {at}"):
                    spoilt = np.concatenate([np.full((count, 3), at), points])
                    cloud = segorient.orient(spoilt)
                    cosines = np.sum(cloud.normals[count:] * outward, axis=1)
                    self.assertGreater(cosines.min(), 0.99)
                    self.assertEqual(cloud.report["duplicates"], max(count - 1, 0) if at == 0.0 else 0)

    def test_strays_beyond_floats_are_no_points(self):
        points, outward = sphere(2000)
        for dtype in (np.float32, np.float64):
            clean = np.ascontiguousarray(points, dtype)
            expected = segorient.orient(clean), segorient.normals(clean), segorient.segment(clean)
            for at in (1e20, -1e30, np.nan):
                for count in (1, 10, 100):
                    with self.subTest(f"{dtype.__name__}, {count} at {at}"):
                        spoilt = np.concatenate([np.full((count, 3), at, dtype), clean])
                        found = segorient.orient(spoilt), segorient.normals(spoilt), segorient.segment(spoilt)
                        for old, new in zip(expected, found):
                            np.testing.assert_array_equal(new.normals[count:], old.normals)
                            self.assertTrue(np.isnan(new.normals[:count]).all())
                        np.testing.assert_array_equal(found[2].labels[count:], expected[2].labels)
                        self.assertEqual(found[0].report["non_finite"], count)
                        check = segorient.check(spoilt, found[0].normals)
                        self.assertFalse(check.contradictions.any())
                        near = segorient.knn(spoilt, 3)
                        self.assertTrue((near.indices[:count] == -1).all())
                        self.assertTrue((near.indices[count:] >= count).all())
                        found[0]._html(1000, "strays")

    def test_float32_is_used_where_it_is(self):
        points = np.ascontiguousarray(sphere(1000)[0], np.float32)
        points[5] = np.nan
        self.assertTrue(np.shares_memory(segorient._local(points)[0], points))

    def test_what_a_mask_hides_is_not_known(self):
        points, outward = sphere(1000)
        hidden = np.zeros(len(points), bool)
        hidden[::3] = True
        times = np.linspace(0.0, 1.0, len(points))
        path = np.array([[0.0, 0.0, 0.0, 9.0], [0.4, 3.0, 0.0, 9.0], [1.0, 5.0, 5.0, 9.0]])
        three = np.repeat(hidden[:, None], 3, axis=1)
        viewpoints = 3.0 * points
        scans = np.arange(len(points)) % 7

        def options(**given):
            return segorient._sensors(
                len(points), np.zeros(3), *(given.get(n) for n in ("viewpoint", "viewpoints", "trajectory", "times")),
                False, given.get("scans"), None)

        seen = options(viewpoints=np.ma.masked_array(viewpoints, three))["viewpoints"]
        np.testing.assert_array_equal(np.isnan(seen).any(axis=1), hidden)
        seen = options(trajectory=path, times=np.ma.masked_array(times, hidden))["viewpoints"]
        np.testing.assert_array_equal(np.isnan(seen).any(axis=1), hidden)
        masked = np.ma.masked_array(path, np.zeros(path.shape, bool))
        masked[1, 2] = np.ma.masked  # half a pose is none
        seen = options(trajectory=masked, times=times)["viewpoints"]
        np.testing.assert_array_equal(seen, options(trajectory=path[[0, 2]], times=times)["viewpoints"])
        numbers = options(scans=np.ma.masked_array(scans, hidden))["scans"]
        np.testing.assert_array_equal(numbers, np.where(hidden, -1, scans))
        for unsigned in (np.uint8, np.uint64):
            numbers = options(scans=np.ma.masked_array(scans.astype(unsigned), hidden))["scans"]
            np.testing.assert_array_equal(numbers, np.where(hidden, -1, scans))
        with self.assertRaisesRegex(ValueError, "viewpoint is masked"):
            segorient.orient(points, viewpoint=np.ma.masked_array([0.0, 0.0, 5.0], [0, 0, 1]))
        keep = np.ma.masked_array(np.where(three, -outward, outward), three)
        kept = segorient.orient(points, keep=keep)
        self.assertTrue((np.sum(kept.normals * outward, axis=1) > 0.0).all())

    def test_any_number_of_threads(self):
        points = sphere(1000)[0]
        expected = segorient.orient(points, threads=1).normals
        for threads in (2, 7, 65536, 65537, 2**31 - 1):
            np.testing.assert_array_equal(segorient.orient(points, threads=threads).normals, expected)


class Documentation(unittest.TestCase):
    def test_every_keyword_is_explained(self):
        for name in ("orient", "normals", "segment", "knn"):
            function = getattr(segorient, name)
            for keyword in inspect.signature(function).parameters:
                with self.subTest(f"{name}: {keyword}"):
                    self.assertRegex(inspect.getdoc(function), rf":param [\w, ]*\b{keyword}\b")

    def test_every_method_is_named(self):
        for method in ("auto", "propagation", "boundary", "combined", "extremal", "hoppe"):
            self.assertIn(f"``{method}``", inspect.getdoc(segorient.orient))

    def test_types_are_told(self):
        directory = os.path.dirname(segorient.__file__)
        for file in ("py.typed", "_core.pyi"):
            self.assertTrue(os.path.exists(os.path.join(directory, file)), file)
        for name in segorient.__all__:
            if inspect.isfunction(getattr(segorient, name)):
                parameters = inspect.signature(getattr(segorient, name)).parameters.values()
                self.assertNotIn(inspect.Parameter.empty, [p.annotation for p in parameters])


@unittest.skipUnless(os.environ.get("SEGORIENT_PROGRAM"), "without the program")
class AsTheProgram(unittest.TestCase):
    def run_program(self, directory, *words):
        path = os.path.join(directory, "out.ply")
        subprocess.run([os.environ["SEGORIENT_PROGRAM"], words[0], os.path.join(directory, "in.ply"), path,
                        *words[1:], "--quiet"], check=True)
        with open(path, "rb") as file:
            data = file.read()
        header, body = data.split(b"end_header\n", 1)
        types = {"float": "<f4", "uint": "<u4", "uchar": "u1", "double": "<f8"}
        fields = [line.split()[1:] for line in header.decode().splitlines() if line.startswith("property")]
        return np.frombuffer(body, [(name, types[kind]) for kind, name in fields])

    def test_results_are_the_same(self):
        points = np.vstack([cube(3000)[0], sphere(1000, (4, 0, 0))[0]]).astype("<f4")
        with tempfile.TemporaryDirectory() as directory:
            with open(os.path.join(directory, "in.ply"), "wb") as file:
                file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n".encode())
                file.write(b"property float x\nproperty float y\nproperty float z\nend_header\n")
                file.write(points.tobytes())
            report_path = os.path.join(directory, "report.json")
            by_program = self.run_program(directory, "orient", "--report", report_path)
            by_module = segorient.orient(points)
            for i, name in enumerate(("nx", "ny", "nz")):
                np.testing.assert_array_equal(by_module.normals[:, i], by_program[name])
            np.testing.assert_array_equal(by_module.labels, by_program["label"].astype(np.int32))
            with open(report_path) as file:
                report = json.load(file)
            self.assertEqual(set(report) - set(by_module.report), {"peak_memory_bytes_by_stage"})
            for key, value in by_module.report.items():
                self.assertIn(key, report)
                if key not in ("seconds", "peak_memory_bytes"):
                    self.assertEqual(json.loads(json.dumps(value), parse_float=lambda t: round(float(t), 4)),
                                     json.loads(json.dumps(report[key]), parse_float=lambda t: round(float(t), 4)))
            by_program = self.run_program(directory, "segment", "-k", "14", "--alpha", "15", "--recompute", "1")
            by_module = segorient.segment(points, k=14, alpha=15, recompute=1)
            np.testing.assert_array_equal(by_module.labels, by_program["label"].astype(np.int32))
            np.testing.assert_array_equal(by_module.kinds[by_module.labels], by_program["segment_kind"])
            by_program = self.run_program(directory, "segment")
            by_module = segorient.segment(points)
            np.testing.assert_array_equal(by_module.labels, by_program["label"].astype(np.int32))
            np.testing.assert_array_equal(by_module.labels, segorient.orient(points).labels)
            self.assertLess(len(segorient.segment(points, faces=True).kinds), len(by_module.kinds))  # a sphere is one
            by_program = self.run_program(directory, "normals", "--normals", "ldt")
            by_module = segorient.normals(points, normals="ldt")
            np.testing.assert_array_equal(by_module.curvatures, by_program["curvature"])


if __name__ == "__main__":
    unittest.main()
