#!/usr/bin/env bats
# What ./dev promises beyond the product: its checks, its set-up, its demo.

load helpers

support=$BATS_TEST_DIRNAME/../support

# clang_stubs VERSION: programs first in PATH that say they are of that version.
clang_stubs() {
  local name
  mkdir -p "$BATS_TEST_TMPDIR/stubs"
  for name in clang-format clang-tidy clang-format-14 clang-tidy-14; do
    printf '#!/bin/sh\necho "Debian %s version %s"\n' "$name" "$1" >"$BATS_TEST_TMPDIR/stubs/$name"
    chmod +x "$BATS_TEST_TMPDIR/stubs/$name"
  done
  PATH=$BATS_TEST_TMPDIR/stubs:$PATH
}

@test "the check fails with clang tools of another version, and says which it needs" {
  clang_stubs 19.1.7
  run "$support/check.sh"
  [ "$status" = 1 ]
  [[ $output == *"clang-format 14 is required, and there is only: Debian clang-format version 19.1.7"* ]]
  [[ $output == *"apt-get install clang-format-14"* ]]
}
