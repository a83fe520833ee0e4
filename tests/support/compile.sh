#!/usr/bin/env bash
# compile.sh FOLDER TARGET...: builds the targets in a configured build folder. First prints the number of steps and their
# estimated time with an empty compiler cache: 4 s of one core each, or 9 s where a step compiles several sources.
set -euo pipefail
folder=$1
shift
cores=$(nproc)
each=4
! grep -qiE '^PAPILIO_UNITY:[A-Z]*=(ON|TRUE)$' "$folder/CMakeCache.txt" || each=9
# A copy: a dry run of CMake's file ends at the rule that regenerates it.
cp "$folder/build.ninja" "$folder/steps.ninja"
steps=$(ninja -C "$folder" -f steps.ninja -n "$@" | sed -nE 's#^\[[0-9]+/([0-9]+)\].*#\1#p' | tail -n 1)
if ((${steps:-0} > 20)); then
  printf 'build: %d steps on %d cores, up to about %d min\n' "$steps" "$cores" "$(((steps * each / cores + 59) / 60))"
fi
cmake --build "$folder" --parallel "$cores" --target "$@"
