#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
"""Draws what search_benchmark measured: plot_search.py RESULTS.csv PICTURE.svg

Needs matplotlib (Debian: python3-matplotlib). One thread and the largest cloud size of the file
that has all methods; one panel a cloud, speed over k as a multiple of pcl::search::KdTree's.
"""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

METHODS = [
    ("all points", "MedianHash, all points", "C0", "-"),
    ("query by query", "MedianHash, query by query", "C0", "--"),
    ("nanoflann", "nanoflann", "C1", "-"),
    ("flann", "FLANN", "C2", "-"),
    ("pcl kdtree", "pcl::search::KdTree", "0.5", "-"),
]


def main(results, picture):
    with open(results, newline="") as file:
        rows = [r for r in csv.DictReader(file) if r["task"] == "nearest" and r["threads"] == "1"]
    points = max(rows, key=lambda r: int(r["points"]))["points"]
    rows = [r for r in rows if r["points"] == points]
    panels = sorted({(r["cloud"], r["order"]) for r in rows}, key=lambda p: (p[1], p[0]))
    columns = min(3, len(panels))
    lines = -(-len(panels) // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(3.4 * columns, 2.6 * lines), sharey=True,
                                squeeze=False)
    for axis, (cloud, order) in zip(axes.flat, panels):
        for method, label, color, style in METHODS:
            line = sorted((int(r["k"]), float(r["times_as_fast"])) for r in rows
                          if (r["cloud"], r["order"], r["method"]) == (cloud, order, method))
            if line:
                axis.plot(*zip(*line), style, color=color, marker=".", label=label)
        axis.set_title(f"{cloud}, {order} order", fontsize=9)
        axis.grid(alpha=0.3)
    drawn = {method for method, *_ in METHODS}
    top = max(float(r["times_as_fast"]) for r in rows if r["method"] in drawn)
    axes[0, 0].set_ylim(0, 1.05 * top)  # for all panels
    for axis in axes[-1]:
        axis.set_xlabel("k")
    for axis in axes[:, 0]:
        axis.set_ylabel("times as fast")
    figure.legend(*axes.flat[0].get_legend_handles_labels(), loc="lower center", ncol=5, fontsize=8,
                  frameon=False)
    figure.tight_layout(rect=(0, 0.06 if lines > 1 else 0.1, 1, 1))
    plt.rcParams["svg.fonttype"] = "none"
    figure.savefig(picture)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
