#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
#
# Installs what is missing, builds everything, and runs all tests.
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
. segorient_ros_free_demo/setup.sh

install_packages "${BUILD_PACKAGES[@]}" "${TEST_PACKAGES[@]}"
say "building (the first time takes some minutes)"
configure -DSEGORIENT_BUILD_TESTS=ON -DSEGORIENT_TEST_PRECOMPILE=ON
build
say "testing"
exec ctest --test-dir build --output-on-failure -j "$(build_jobs)"
