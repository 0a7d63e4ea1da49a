#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
#
# Orients synthetic clouds of every shape, with seeds that nothing was tuned on.
#   fresh_clouds.sh GENERATOR BENCHMARK [SEEDS [POINTS [OPTION ...]]]
# GENERATOR is make_synthetic.py (needs numpy and scipy), BENCHMARK the built
# orientation_benchmark, SEEDS a list such as "101 102", OPTION one of the benchmark's. Each seed
# takes the next of four samplings, and runs at noise 0, 0.1, 0.25, 0.6 and 1.2 % of the diagonal.
set -euo pipefail
generator=$1
benchmark=$2
seeds=${3:-"101 102 103 104 105 106 107 108 109 110"}
points=${4:-12000}
shift $(($# < 4 ? $# : 4))
samplings=(random uniform striped gradient)
clouds=$(mktemp -d)
trap 'rm -rf "$clouds"' EXIT
for noise in 0 0.001 0.0025 0.006 0.012; do
  turn=0
  mkdir "$clouds/$noise"
  for seed in $seeds; do
    python3 "$generator" --suite "$clouds/$noise" --n "$points" --seed "$seed" \
      --sampling "${samplings[turn % 4]}" --noise "$noise" >/dev/null
    turn=$((turn + 1))
  done
  echo
  echo "### noise $noise of the diagonal"
  echo
  "$benchmark" "$@" "$clouds/$noise"
done
