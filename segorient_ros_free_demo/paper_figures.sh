#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
#
# paper_figures.sh [CLOUDS [BUILD]]: the paper's figures 9 to 11 anew, in segorient/doc/pictures/.
# Each object is oriented by the paper's combination of methods, with normals recomputed twice, and
# drawn from two sides, every segment in a tint of its own; red is what faces the wrong way, violet
# what no method decided.
# The Fandisk is in the repository; dino_19521.ply and thorlike_71292.ply, which stand in for the
# paper's other two objects, are looked for in CLOUDS.
set -euo pipefail

clouds=${1:-}
[ -z "$clouds" ] || clouds=$(realpath "$clouds")
build=$(realpath "${2:-$(dirname "$(realpath "$0")")/../build}")
cd "$(dirname "$(realpath "$0")")/.."
program=$build/bin/segorient
[ -x "$program" ] || { echo "$program: not built yet; run.sh builds it" >&2; exit 1; }
pictures=segorient/doc/pictures
mkdir -p "$pictures"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# figure CLOUD NAME [RENDER OPTION...]
figure() {
  local cloud=$1 name=$2
  shift 2
  "$program" orient "$cloud" "$scratch/$name.pcd" --method combined --recompute 2 \
    --report "$scratch/$name.json" --quiet
  "$program" render "$scratch/$name.pcd" "$pictures/$name.png" --color orientation \
    --report "$scratch/$name.json" --width 900 --height 450 "$@"
  echo "== $pictures/$name.png"
  "$program" evaluate "$cloud" "$scratch/$name.pcd"
}

figure test/data/fandisk_16475.pcd figure09_fandisk
if [ -n "$clouds" ]; then
  figure "$clouds/dino_19521.ply" figure10_dino
  figure "$clouds/thorlike_71292.ply" figure11_open_figure --azimuth 0 --elevation 75
else
  echo "figures 10 and 11: name the directory of their clouds, $0 CLOUDS"
fi
