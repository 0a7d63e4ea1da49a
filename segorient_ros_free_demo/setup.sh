# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
#
# What run.sh and test/run.sh have in common: packages, configuration, build. Sourced by them, in the
# root of the repository.

say() { printf '== %s\n' "$*"; }

# install_packages NAME...: installs those that are missing, on Debian and Ubuntu; elsewhere says what
# is needed and goes on, as it may be there under other names.
install_packages() {
  if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    say "no apt-get here; if something is missing below, install what these Debian packages hold:"
    say "$*"
    return 0
  fi
  local missing=() package
  for package in "$@"; do
    if [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
      missing+=("$package")
    fi
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  say "installing ${missing[*]}"
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      say "neither root nor sudo: please install ${missing[*]}"
      return 1
    fi
    as_root=(sudo)
  fi
  local install=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q
    --no-install-recommends "${missing[@]}")
  # The lists of a fresh machine are empty or old.
  "${install[@]}" || { "${as_root[@]}" apt-get update -q && "${install[@]}"; }
}

# One compiler a core, but no more than memory allows: PCL's headers take up to 2 GB each.
build_jobs() {
  local cores memory
  cores=$(nproc 2>/dev/null || echo 2)
  memory=$(awk '/^MemAvailable/ {print int($2 / 2097152)}' /proc/meminfo 2>/dev/null || echo 2)
  [ "${memory:-2}" -ge 1 ] || memory=1
  echo $((cores < memory ? cores : memory))
}

# configure [OPTION...]: into build/, Release, with Ninja where there is one.
configure() {
  local generator=()
  if [ ! -f build/CMakeCache.txt ] && command -v ninja >/dev/null; then generator=(-G Ninja); fi
  # The system's Python, which the packages are for; another one may come first in PATH.
  local python=()
  if [ -x /usr/bin/python3 ]; then python=(-DPython_EXECUTABLE=/usr/bin/python3); fi
  cmake -S . -B build "${generator[@]}" "${python[@]}" -DCMAKE_BUILD_TYPE=Release "$@" >build.log 2>&1 ||
    { cat build.log; rm -f build.log; return 1; }
  rm -f build.log
}

# build [TARGET...]: everything, or these targets.
build() {
  local targets=()
  [ $# -eq 0 ] || targets=(--target "$@")
  cmake --build build -j "$(build_jobs)" "${targets[@]}"
}

# python3-dev and pybind11-dev are for the Python package, which is left out without them.
BUILD_PACKAGES=(g++ cmake ninja-build libpcl-dev libeigen3-dev libflann-dev libboost-dev
  libboost-program-options-dev python3-dev pybind11-dev python3-numpy)
# chromium: pages are tested in it, where it is there; python3-distributed: one of the engines for
# tiles.
TEST_PACKAGES=(libgtest-dev doxygen dpkg-dev pkg-config chromium python3-distributed)
