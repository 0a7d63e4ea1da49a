#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
#
# Builds everything as a preset of CMakePresets.json says, into build/PRESET, and runs the tests.
#
#   ./test/sanitizers/run.sh asan|tsan|coverage
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/../.."
. segorient_ros_free_demo/setup.sh
preset=${1:?which preset: asan, tsan or coverage}

install_packages "${BUILD_PACKAGES[@]}" "${TEST_PACKAGES[@]}" clang-14 libclang-rt-14-dev libomp-14-dev
if command -v ninja >/dev/null; then export CMAKE_GENERATOR=Ninja; fi
cd test/sanitizers
say "building with preset $preset"
cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset" -j "$(build_jobs)"
find "../../build/$preset" -name '*.gcda' -delete
say "testing with preset $preset"
ctest --preset "$preset" -j "$(build_jobs)"
