#!/usr/bin/env bats
# ./dev: its checks, its set-up, its demo.

load helpers

support=$BATS_TEST_DIRNAME/../support

# clang_stubs VERSION: puts programs first in PATH that report this version.
clang_stubs() {
  local name
  mkdir -p "$BATS_TEST_TMPDIR/stubs"
  for name in clang-format clang-tidy clang-format-14 clang-tidy-14; do
    printf '#!/bin/sh\necho "Debian %s version %s"\n' "$name" "$1" >"$BATS_TEST_TMPDIR/stubs/$name"
    chmod +x "$BATS_TEST_TMPDIR/stubs/$name"
  done
  PATH=$BATS_TEST_TMPDIR/stubs:$PATH
}

@test "the check fails with clang tools of another version, and names the required one" {
  clang_stubs 19.1.7
  run "$support/check.sh"
  [ "$status" = 1 ]
  [[ $output == *"clang-format 14 is required, and there is only: Debian clang-format version 19.1.7"* ]]
  [[ $output == *"apt-get install clang-format-14"* ]]
}

@test "build and demo require none of the tests' libraries" {
  tested=$("$support/setup.sh" --list build test)
  [[ $tested == *gtest* && $tested == *benchmark* && $tested == *openmesh* ]]
  needed=$("$support/setup.sh" --list build demo)
  [[ $needed == *g++* && $needed == *libdraco-dev* ]]
  [[ $needed != *gtest* && $needed != *benchmark* && $needed != *openmesh* && $needed != *npm* ]]
  for package in GTest benchmark; do
    options+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON") # as if it were not installed
  done
  cmake -G Ninja -S "$BATS_TEST_DIRNAME/../.." -B "$BATS_TEST_TMPDIR/build" "${options[@]}" \
    -DPAPILIO_TESTS=OFF -DPAPILIO_WEB=OFF -DPAPILIO_DEMO=ON -DPAPILIO_UNITY=OFF >/dev/null
  ! grep -qi openmesh "$BATS_TEST_TMPDIR/build/CMakeCache.txt"
  # The number of files to compile is printed first; nothing is compiled here.
  mkdir "$BATS_TEST_TMPDIR/stubs"
  printf '#!/bin/sh\n' >"$BATS_TEST_TMPDIR/stubs/cmake"
  chmod +x "$BATS_TEST_TMPDIR/stubs/cmake"
  run env PATH="$BATS_TEST_TMPDIR/stubs:$PATH" "$support/compile.sh" "$BATS_TEST_TMPDIR/build" papilio papilio-server coarsen
  [[ $output =~ ^build:\ [1-9][0-9][0-9]\ steps\ on\ [0-9]+\ cores,\ up\ to\ about\ [0-9]+\ min ]]
}

@test "the demo with --exit refines a bunny, and prints no address of the stopped viewer" {
  run "$support/demo.sh" --exit
  [ "$status" = 0 ]
  [[ $output =~ coarse\ +302\ +600 ]]
  [[ $output =~ uniform,\ 3\ levels\ +19202\ +38400 ]]
  [[ $output == *"From the start of ./dev demo:"* ]]
  [[ $output != *http* && $output != *iewer* ]]
}
