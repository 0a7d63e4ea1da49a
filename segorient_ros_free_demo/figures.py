#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
"""Makes the figures of the README and of the documentation anew.

usage: figures.py [BUILD_DIRECTORY [CLOUDS]]
       figures.py BUILD_DIRECTORY --worst PICTURE CLOUD.ply ...

The shipped Fandisk is enough for most of them. With CLOUDS, a directory of clouds with true normals,
their manifest.tsv and the generator make_synthetic.py, those of the paper's other objects, a real
scan and the worst places are drawn (which needs matplotlib). Where these targets were built, the
table of the methods of orientation is printed (orientation_benchmark) and the plot of the search is
drawn (search_benchmark), which takes minutes. The second form draws only the worst place of each
CLOUD, whose normals are the true ones.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FANDISK = ROOT / "test/data/fandisk_16475.pcd"
PICTURES = ROOT / "segorient/doc/pictures"
SIZE = ["--width", "1000", "--height", "500"]


def run(*words):
    print(*(Path(w).name if i == 0 else w for i, w in enumerate(words)), flush=True)
    subprocess.run([str(w) for w in words], check=True)


def read_fandisk(np):
    """Points and true normals: a PCD of floats, compressed by LZF, columns one after another."""
    data = FANDISK.read_bytes()
    header, body = data.split(b"DATA binary_compressed\n", 1)
    packed = body[8 : 8 + int.from_bytes(body[:4], "little")]
    out = bytearray()
    at = 0
    while at < len(packed):
        control = packed[at]
        at += 1
        if control < 32:  # literal bytes
            out += packed[at : at + control + 1]
            at += control + 1
            continue
        length = (control >> 5) + 2  # a copy of what came before
        if length == 9:
            length += packed[at]
            at += 1
        start = len(out) - ((control & 31) << 8 | packed[at]) - 1
        at += 1
        for i in range(start, start + length):
            out.append(out[i])
    columns = np.frombuffer(bytes(out), "<f4").reshape(6, -1)
    return columns[:3].T.copy(), columns[3:].T.copy()


def colored(program, points, normals, value, path, np):
    """A picture of points coloured by a value between 0 (grey) and 1 (red)."""
    value = np.clip(np.nan_to_num(value, nan=1.0), 0.0, 1.0)[:, None]
    color = (200, 198, 190) * (1.0 - value) + (200, 20, 10) * value
    names = ["float x", "float y", "float z", "float nx", "float ny", "float nz",
             "uchar red", "uchar green", "uchar blue"]
    with tempfile.TemporaryDirectory() as directory:
        cloud = Path(directory) / "cloud.ply"
        with open(cloud, "w") as file:
            file.write(f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n")
            file.writelines(f"property {name}\n" for name in names)
            file.write("end_header\n")
            for p, n, c in zip(points, normals, color.astype(int)):
                file.write(" ".join(f"{v:.7g}" for v in (*p, *n)) + f" {c[0]} {c[1]} {c[2]}\n")
        run(program, "render", cloud, path, "--color", "rgb", "--single", "--width", 500, "--height", 500)


def figures(build):
    program = build / "bin/segorient"
    PICTURES.mkdir(exist_ok=True)
    run(program, "compare", FANDISK, "--picture", ROOT / "segorient_ros_free_demo/fandisk_compare.png")
    with tempfile.TemporaryDirectory() as directory:
        for command, picture, options in (("segment", "segments.png", ["--recompute", 2]),
                                          ("triangulate", "triangles.png", [])):
            result = Path(directory) / "result.ply"
            run(program, command, FANDISK, result, "--quiet", *options)
            run(program, "render", result, PICTURES / picture, "--color", "segment", *SIZE)

    sys.path.insert(0, str(build / "python"))
    import numpy as np
    import segorient

    points, truth = read_fandisk(np)
    for picture, rounds in (("normals_plane.png", 0), ("normals_recomputed.png", 1)):
        normals = segorient.normals(points, normals="plane", recompute=rounds).normals
        cosine = np.abs((normals * truth).sum(axis=1)).clip(0.0, 1.0)
        angle = np.degrees(np.arccos(cosine))
        colored(program, points, truth, angle / 30.0, PICTURES / picture, np)
    distance = segorient.knn(points, 16).distances[:, 15]
    low, high = np.percentile(distance, [1, 99])
    colored(program, points, truth, (distance - low) / (high - low), PICTURES / "knn.png", np)


def scan(build, cloud):
    """A real scan, PCL's normals beside ours: ten range scans of the Stanford Bunny, merged."""
    run(build / "bin/segorient", "compare", cloud, "--picture", PICTURES / "scan.png",
        "--azimuth", 265, "--elevation", 65, "--quiet")


def street(build, cloud):
    """A street seen by a moving lidar, positions only: turned to the origin as PCL does, and by segorient orient,
    which finds the way of the scanner; red turns its back to it."""
    sys.path.insert(0, str(build / "python"))
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np
    import segorient

    program = build / "bin/segorient"
    points, _ = read_ply(cloud, np)
    lines = segorient.normals(points, normals="plane", k=30).normals
    to_origin = lines * np.where((points * lines).sum(axis=1) > 0.0, -1.0, 1.0)[:, None]
    ours = segorient.orient(points).normals
    figure, axes = plt.subplots(1, 2, figsize=(12, 4.8))
    with tempfile.TemporaryDirectory() as directory:
        places = Path(directory) / "sensors.json"
        picture = Path(directory) / "picture.png"
        for axis, title, normals in zip(axes, ("turned to the origin", "segorient orient"), (to_origin, ours)):
            oriented = Path(directory) / "oriented.ply"
            with open(oriented, "w") as file:
                file.write(f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n")
                file.writelines(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
                file.write("end_header\n")
                np.savetxt(file, np.hstack([points, normals]), fmt="%.7g")
            if not places.exists():
                run(program, "sensors", oriented, places, "--quiet")
            run(program, "render", oriented, picture, "--sensors", places, "--single", "--elevation", 55,
                "--width", 900, "--height", 720, "--quiet")
            axis.imshow(plt.imread(picture))
            axis.set_title(title)
            axis.set_axis_off()
    figure.tight_layout()
    figure.savefig(PICTURES / "street.png", dpi=90, bbox_inches="tight")


def missed(build, generator):
    """Worst places in thin and noisy clouds: shape, seed, sampling, noise as a share of the diagonal."""
    with tempfile.TemporaryDirectory() as directory:
        clouds = []
        for shape, seed, sampling, noise in (("box_holes", 1503, "striped", "0"), ("plate_k2", 1503, "striped", "0.0025"),
                                             ("open_fold", 1501, "random", "0.0025")):
            run(sys.executable, generator, "--shape", shape, "--n", 12000, "--seed", seed, "--sampling", sampling,
                "--noise", noise, "--out", directory)
            clouds.append(Path(directory) / f"{shape}_n12000_s{seed}_{sampling}_{noise}.ply")
        worst(build, clouds, PICTURES / "missed.png")


def read_ply(path, np):
    """Points and normals of a binary PLY whose vertices are numbers only."""
    types = {"float": "<f4", "double": "<f8", "int": "<i4", "uint": "<u4", "short": "<i2",
             "ushort": "<u2", "char": "i1", "uchar": "u1"}
    head, body = path.read_bytes().split(b"end_header\n", 1)
    lines = [line.split() for line in head.decode().splitlines()]
    count = next(int(line[2]) for line in lines if line[:2] == ["element", "vertex"])
    fields = [(line[2], types[line[1]]) for line in lines if line[0] == "property" and len(line) == 3]
    rows = np.frombuffer(body, np.dtype(fields), count)
    columns = [np.stack([rows[name] for name in names], axis=1).astype(np.float32)
               for names in (("x", "y", "z"), ("nx", "ny", "nz"))]
    return columns[0], columns[1]


def worst(build, clouds, picture):
    """Close-ups of the places where most points of each cloud get the wrong side."""
    sys.path.insert(0, str(build / "python"))
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np
    import segorient

    figure, axes = plt.subplots(1, len(clouds), figsize=(13, 4.6), squeeze=False)
    for axis, cloud in zip(axes[0], clouds):
        points, truth = read_ply(cloud, np)
        normals = segorient.orient(points).normals
        right = (normals * truth).sum(axis=1) > 0.0
        right = right if right.mean() > 0.5 else ~right
        spacing = np.median(segorient.knn(points, 7).distances[:, 1:])
        wrong = points[~right]
        crowd = [(np.linalg.norm(wrong - p, axis=1) < 6 * spacing).sum() for p in wrong]
        center = wrong[int(np.argmax(crowd))]
        near = np.abs(points - center).max(axis=1) < 6 * spacing
        # Along all surfaces as far as can be, so that they are seen edge-on.
        frame = np.linalg.svd(truth[near], full_matrices=False)[2]
        flat = (points[near] - center) @ frame[:2].T / spacing
        arrow = truth[near] @ frame[:2].T
        for chosen, color in ((right[near], "0.6"), (~right[near], "red")):
            axis.quiver(*flat[chosen].T, *arrow[chosen].T, color=color, width=0.003, scale=14)
            axis.plot(*flat[chosen].T, ".", color=color, markersize=4)
        axis.set_title(f"{cloud.stem}: {(~right).sum()} of {len(points)}", fontsize=9)
        axis.set(xlim=(-6.5, 6.5), ylim=(-6.5, 6.5), aspect="equal")
        axis.set_xlabel("spacings")
    figure.tight_layout()
    figure.savefig(picture, dpi=75)


def main():
    build = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build").resolve()
    if sys.argv[2:3] == ["--worst"]:
        if len(sys.argv) < 5:
            sys.exit(__doc__)
        return worst(build, [Path(cloud) for cloud in sys.argv[4:]], sys.argv[3])
    figures(build)
    if len(sys.argv) > 2:
        names = ("thorlike_71292", "demosthenes_20k", "wingnut_20k")
        worst(build, [Path(sys.argv[2]) / f"{name}.ply" for name in names], PICTURES / "worst.png")
        missed(build, Path(sys.argv[2]) / "make_synthetic.py")
        scan(build, Path(sys.argv[2]) / "real_bunny10scans_60k.ply")
        street(build, Path(sys.argv[2]) / "scans/street_32beams_4poses.ply")
        run(ROOT / "segorient_ros_free_demo/paper_figures.sh", sys.argv[2], build)
    if len(sys.argv) > 2 and (build / "bin/orientation_benchmark").exists():
        run(build / "bin/orientation_benchmark", sys.argv[2])
    if (build / "bin/search_benchmark").exists():
        with tempfile.TemporaryDirectory() as directory:
            table = Path(directory) / "search.csv"
            run(build / "bin/search_benchmark", "--csv", table)
            run(ROOT / "test/benchmark/plot_search.py", table, ROOT / "test/benchmark/search_speed.svg")


if __name__ == "__main__":
    main()
