#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# PCL's own tests of search, kd-tree, normal estimation and region growing, with our classes in the
# place of PCL's: exchanges the types that substitutions.txt lists, and runs what comes out.
#
#   test/pcl_suite/run.sh PCL_SOURCE [BUILD]
#
# PCL_SOURCE: PCL's source as of a release (nothing of it is kept or needed elsewhere).
# BUILD: where segorient is built (default: build). Needs gtest and PCL's development files.
# Ends with 0 if all tests passed.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
if [ $# -lt 1 ] || [ ! -f "$1/test/search/test_search.cpp" ]; then
  echo "usage: $0 PCL_SOURCE [BUILD]: PCL_SOURCE/test/search/test_search.cpp must be there" >&2
  exit 2
fi
pcl=$(cd "$1" && pwd)
build=$(cd "${2:-$root/build}" && pwd)
work=$build/pcl_suite
rm -rf "$work/sources"
mkdir -p "$work/sources" "$work/log"

cmake --install "$build" --prefix "$work/installed" >"$work/log/install.txt"

# Every test is copied, and what the list names is exchanged.
tests=(search/test_search search/test_kdtree search/test_flann_search kdtree/test_kdtree
  features/test_normal_estimation segmentation/test_segmentation)
for test in "${tests[@]}"; do
  mkdir -p "$work/sources/test/$(dirname "$test")"
  cp "$pcl/test/$test.cpp" "$work/sources/test/$test.cpp"
done
while read -r file change; do
  case $file in '' | '#'*) continue ;; esac
  before=$(cksum <"$work/sources/$file")
  sed -E -i "$change" "$work/sources/$file"
  if [ "$(cksum <"$work/sources/$file")" = "$before" ]; then
    echo "nothing to exchange in $file: $change" >&2
    exit 1
  fi
done <"$here/substitutions.txt"

cmake -S "$here" -B "$work/build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/installed" \
  -DPCL_SOURCE="$pcl" -DSOURCES="$work/sources" -DTESTS="$(IFS=';'; echo "${tests[*]}")" \
  >"$work/log/configure.txt" 2>&1
cmake --build "$work/build" -j"$(nproc)"

data=$pcl/test
arguments() {
  case $1 in
    search/test_search) echo "$data/table_scene_mug_stereo_textured.pcd" ;;
    kdtree/test_kdtree) echo "$data/sac_plane_test.pcd $data/kdtree/kdtree_unit_test_results.xml" ;;
    features/test_normal_estimation) echo "$data/bun0.pcd" ;;
    segmentation/test_segmentation) echo "$data/bun0.pcd $data/car6.pcd $data/colored_cloud.pcd" ;;
  esac
}
failed=0
for test in "${tests[@]}"; do
  name=${test//\//_}
  # shellcheck disable=SC2046  # a word each
  if "$work/build/bin/$name" $(arguments "$test") >"$work/log/$name.txt" 2>&1; then
    result=passed
  else
    result="FAILED, see $work/log/$name.txt"
    failed=1
  fi
  count=$(sed -n 's/^\[  PASSED  \] \([0-9]*\) test.*/\1/p' "$work/log/$name.txt" | tail -1)
  # A program that ran nothing has not passed.
  if [ -z "$count" ] || [ "$count" = 0 ]; then result=failed; failed=1; fi
  echo "$test: ${count:-0} tests passed; $result"
  grep '^\[  FAILED  \]' "$work/log/$name.txt" | sort -u || true
done
exit $failed
