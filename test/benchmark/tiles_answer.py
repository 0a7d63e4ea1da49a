#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
"""How far the answer of tiles is from that of the whole cloud, as a table with tabs.

usage: tiles_answer.py [--sizes 3000,8000,20000] [--turn] [--jobs N] PROGRAM CLOUD ...

Each cloud is oriented in memory and in tiles of at most so many points. For each size:
  signs   points of 10,000 whose normal is more than 90 degrees from the whole's, or missing
  sides   of these, how many look to the other side of the surface: where faces meet at right angles,
          a point may take the normal of either, and of all of the whole's normals at it and at its
          eight nearest, the one that is most parallel tells on which side it is
  rifts   of these, how many are in a pair of nearest neighbours that looks the other way only in
          tiles: none where whole parts are turned over, many where a border of tiles shows
  strays  points that are of no surface, as their normal in CLOUD is NaN while others have one:
          these have no side, and are in no other column; here, how many of 10,000 differ
  labels  % of the points whose segment is not the whole's, matched one to one as well as can be
--turn: the same between the whole and the whole with its axes turned, as a last column: how much of
the answer hangs on where segments begin to grow.
"""

import argparse
import concurrent.futures
import pathlib
import subprocess
import tempfile

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.sparse import coo_matrix
from scipy.spatial import cKDTree

TYPES = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4",
         "float": "<f4", "double": "<f8", "int8": "i1", "uint8": "u1", "int16": "<i2",
         "uint16": "<u2", "int32": "<i4", "uint32": "<u4", "float32": "<f4", "float64": "<f8"}


COLUMNS = ("signs", "sides", "rifts", "strays", "labels")


def load(path):
    """Rows of a binary PLY, as the program writes it."""
    with open(path, "rb") as file:
        fields = []
        while (line := file.readline().split())[0] != b"end_header":
            if line[:2] == [b"element", b"vertex"]:
                size = int(line[2])
            if line[0] == b"property":
                fields.append((line[2].decode(), TYPES[line[1].decode()]))
        return np.fromfile(file, np.dtype(fields), size)


def columns(cloud, names):
    return np.stack([cloud[n].astype(float) for n in names], 1)


def save(path, places):
    with open(path, "wb") as file:
        head = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % len(places)
        head += "".join("property double %s\n" % a for a in "xyz") + "end_header\n"
        file.write(head.encode())
        file.write(np.ascontiguousarray(places, "<f8").tobytes())


def share_of_other_labels(a, b):
    """Least share of the points whose labels are not matched, by any one-to-one matching."""
    _, a = np.unique(a, return_inverse=True)
    _, b = np.unique(b, return_inverse=True)
    both = coo_matrix((np.ones(len(a)), (a, b))).tocsr()
    # Rows and columns that meet nothing else than each other need no choice.
    table = both.toarray() if both.shape[0] * both.shape[1] < 5e7 else None
    if table is None:
        return float("nan")
    rows, cols = linear_sum_assignment(-table)
    return 1.0 - table[rows, cols].sum() / len(a)


def find_strays(path, size):
    """Rows of the input whose normals say that they are of no surface."""
    none = np.zeros(size, bool)
    if not str(path).endswith(".ply"):
        return none
    cloud = load(path)
    if len(cloud) != size or not {"nx", "ny", "nz"} <= set(cloud.dtype.names):
        return none
    strays = ~np.isfinite(columns(cloud, ("nx", "ny", "nz"))).all(1)
    return none if strays.all() else strays


def compare(whole, other, places, strays):
    n, m = columns(whole, ("nx", "ny", "nz")), columns(other, ("nx", "ny", "nz"))
    known = np.isfinite(n).all(1) | np.isfinite(m).all(1)
    differ = known & ~((n * m).sum(1) >= 0)
    lost = differ & strays
    differ &= ~strays
    rows = np.flatnonzero(np.isfinite(places).all(1))
    near = rows[cKDTree(places[rows]).query(places[rows], min(9, len(rows)))[1]]
    cosines = np.nan_to_num((n[near] * m[rows][:, None]).sum(2))
    parallel = cosines[np.arange(len(rows)), np.abs(cosines).argmax(1)]
    turned = np.ones(len(n), bool)
    turned[rows] = parallel <= 0
    opposed = lambda v: (v[rows][:, None] * v[near]).sum(2) < 0
    rift = np.zeros(len(n), bool)
    rift[rows] = (opposed(m) & ~opposed(n)).any(1)
    labels = share_of_other_labels(whole["label"], other["label"])
    of_10000 = lambda which: which.sum() * 1e4 / len(n)
    return "%.1f\t%.1f\t%d\t%.1f\t%.2f" % (of_10000(differ), of_10000(differ & turned),
                                          (differ & rift).sum(), of_10000(lost), 100 * labels)


def row(program, cloud, sizes, turn):
    with tempfile.TemporaryDirectory() as folder:
        def orient(*arguments):
            out = folder + "/out.ply"
            subprocess.run([program, "orient", *arguments[:1], out, "-q", "--threads", "1",
                            *arguments[1:]], check=True, stderr=subprocess.DEVNULL)
            return load(out)

        whole = orient(cloud)
        places = columns(whole, "xyz")
        strays = find_strays(cloud, len(whole))
        cells = []
        for size in sizes:
            tiles = orient(cloud, "--memory", "1G", "--tile-points", size)
            cells.append(compare(whole, tiles, places, strays))
        if turn:
            save(folder + "/turned.ply", places[:, [1, 2, 0]])
            turned = orient(folder + "/turned.ply")
            for name, axis in zip(("nx", "ny", "nz"), columns(turned, ("nz", "nx", "ny")).T):
                turned[name] = axis
            cells.append(compare(whole, turned, places, strays))
        return "\t".join([pathlib.Path(cloud).name, *cells])


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--sizes", default="3000,8000,20000")
    parser.add_argument("--turn", action="store_true")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("program")
    parser.add_argument("clouds", nargs="+")
    options = parser.parse_args()
    sizes = options.sizes.split(",")
    names = sizes + ["turned"] * options.turn
    print("cloud", *("%s %s" % (k, s) for s in names for k in COLUMNS),
          sep="\t", flush=True)
    lines = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for line in pool.map(lambda c: row(options.program, c, sizes, options.turn),
                             options.clouds):
            lines.append([float(x) for x in line.split("\t")[1:]])
            print(line, flush=True)
    table = np.array(lines)
    print("%d clouds" % len(table), flush=True)
    for s, name in enumerate(names):
        signs, sides, _, _, labels = table[:, len(COLUMNS) * s:len(COLUMNS) * (s + 1)].T
        print("%s: over 1 of 10,000 on %d (other sides: %d); labels differ in %.1f %% (median %.1f)"
              % (name, (signs > 1).sum(), (sides > 1).sum(), np.nanmean(labels),
                 np.nanmedian(labels)))
    signs = table[:, 0:len(COLUMNS) * len(sizes):len(COLUMNS)]
    print("over 1 of 10,000 in any size: %d" % (signs > 1).any(1).sum())


if __name__ == "__main__":
    main()
