#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
#
# run.sh [FILE]: installs what is missing, builds, and orients the Fandisk that comes with the
# repository, and FILE (PCD, PLY, OBJ, text) if one is named. Results are in build/demo/.
set -euo pipefail

case "${1:-}" in
  -h | --help)
    echo "usage: $0 [FILE]   builds segorient and orients the shipped Fandisk, and FILE (PCD, PLY, OBJ, text)"
    exit 0
    ;;
esac
file=""
if [ $# -gt 0 ]; then
  [ -f "$1" ] || { echo "$1: no such file" >&2; exit 1; }
  file=$(realpath "$1")
fi
cd "$(dirname "$(realpath "$0")")/.."
. segorient_ros_free_demo/setup.sh

install_packages "${BUILD_PACKAGES[@]}"
say "building (the first time takes some minutes)"
# A build directory that is there already, with or without tests, looks after itself.
if [ ! -f build/build.ninja ] && [ ! -f build/Makefile ]; then configure -DSEGORIENT_BUILD_TESTS=OFF; fi
build segorient_program

# orient FILE NAME
orient() {
  local name=build/demo/$2
  say "segorient orient $1 ${name}_oriented.pcd"
  build/bin/segorient orient "$1" "${name}_oriented.pcd" --report "${name}_report.json"
  build/bin/segorient render "${name}_oriented.pcd" "${name}_segments.png" --color segment
  build/bin/segorient render "${name}_oriented.pcd" "${name}_normals.png" --color normal
  build/bin/segorient render "${name}_oriented.pcd" "${name}.html" --report "${name}_report.json"
}

mkdir -p build/demo
orient test/data/fandisk_16475.pcd fandisk
say "compared with the true normals"
build/bin/segorient evaluate test/data/fandisk_16475.pcd build/demo/fandisk_oriented.pcd
results=(fandisk)
if [ -n "$file" ]; then
  name=$(basename "${file%.*}")
  # The shipped object keeps its own files.
  [ "$name" != fandisk ] || name=fandisk_of_yours
  orient "$file" "$name"
  results+=("$name")
fi

say "results in $PWD/build/demo"
for name in "${results[@]}"; do
  echo "  ${name}_oriented.pcd   the cloud with oriented normals, segment labels and colours"
  echo "  ${name}_segments.png   segments in colours, from two sides"
  echo "  ${name}_normals.png    shaded by normal; what faces the wrong way is red"
  echo "  ${name}.html           open it in a browser: turns, cuts, tells what is picked"
  echo "  to look at it:  build/bin/segorient view build/demo/${name}_oriented.pcd"
  if command -v pcl_viewer >/dev/null; then
    echo "            or:   pcl_viewer -normals 10 -normals_scale 0.1 $PWD/build/demo/${name}_oriented.pcd"
  fi
done
