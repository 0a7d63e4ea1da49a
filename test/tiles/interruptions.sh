#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
# Interrupts `orient` in tiles: kill -9 at random moments, then a full disk (a small tmpfs, for which
# it has to be root). Each time the command is repeated, which must give the bytes of an undisturbed
# run; before that, no output may be there that is not whole.
#   interruptions.sh PROGRAM CLOUD [TIMES]     prints counts; status 1 if a run differs
set -u
program=$(realpath "$1")
cloud=$(realpath "$2")
times=${3:-10}
folder=$(mktemp -d)
trap 'umount "$folder/disk" 2> /dev/null; rm -rf "$folder"' EXIT
cd "$folder" || exit 1
options=(--memory 1G --tile-points 3000 -q)
bad=0

# Whether the output $1 is as it should be, and nothing else is left.
same() { cmp -s "$1" whole.ply && [ ! -e "$1.work" ]; }
# An output that is there after an interruption must be whole.
whole_or_none() { [ ! -e "$1" ] || cmp -s "$1" whole.ply; }
fail() { echo "$*"; bad=1; }

start=$(date +%s%N)
"$program" orient "$cloud" whole.ply "${options[@]}" || exit 1
ms=$((($(date +%s%N) - start) / 1000000))
bytes=$(stat -c %s whole.ply)
echo "undisturbed: $ms ms, $bytes bytes"

resumed=0
hit=0
for _ in $(seq "$times"); do
  rm -rf out.ply out.ply.work
  moment=$((RANDOM * ms / 32768))
  "$program" orient "$cloud" out.ply "${options[@]}" &
  sleep "$((moment / 1000)).$(printf %03d $((moment % 1000)))"
  kill -9 $! 2> /dev/null
  wait $! 2> /dev/null
  [ $? -eq 137 ] && hit=$((hit + 1))
  whole_or_none out.ply || fail "killed after $moment ms: half an output"
  if "$program" orient "$cloud" out.ply "${options[@]}" && same out.ply; then
    resumed=$((resumed + 1))
  else
    fail "killed after $moment ms: the repeat differs"
  fi
done
echo "kills: $hit of $times hit, $resumed repeats with the same bytes"

resumed=0
hit=0
mkdir disk
for i in $(seq "$times"); do
  size=$((bytes * i / times / 1024 + 16))  # kB, up to a little more than the output alone
  mount -t tmpfs -o "size=${size}k" tmpfs disk || exit 1
  "$program" orient "$cloud" disk/out.ply "${options[@]}" 2> message || hit=$((hit + 1))
  whole_or_none disk/out.ply || fail "disk of $size kB: half an output"
  mount -o "remount,size=$((bytes * 20 / 1024))k" disk
  if "$program" orient "$cloud" disk/out.ply "${options[@]}" && same disk/out.ply; then
    resumed=$((resumed + 1))
  else
    fail "disk of $size kB: the repeat differs"
  fi
  umount disk
done
echo "full disks: $hit of $times hit, $resumed repeats with the same bytes"
exit $bad
