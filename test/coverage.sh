#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
#
# Line coverage of the library by the tests: builds with gcov's counters into build/coverage, runs all
# tests, and reports. Fails below the share that is asked for. Left out is what limits the size of
# files: the counters could not be written.
#
#   ./test/coverage.sh [PERCENT]
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
. segorient_ros_free_demo/setup.sh

install_packages gcovr
./test/sanitizers/run.sh coverage
# Exception paths that the compiler adds are no lines of ours.
gcovr --root . --filter 'segorient/' --exclude-throw-branches --exclude-unreachable-branches \
  --object-directory build/coverage/segorient --html-details build/coverage/report.html \
  --print-summary --fail-under-line "${1:-95}" build/coverage/segorient
say "details: build/coverage/report.html"
