#!/usr/bin/env bats
# Results are the same on every processor. The C library has a sine for each kind; GLIBC_TUNABLES chooses an older one.

load helpers

older='glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2'

# Prints a sum of many sines of the C library.
sum_of_sines() {
  python3 -c 'import hashlib, math
print(hashlib.sha256("".join(math.sin(i / 1e4).hex() for i in range(200000)).encode()).hexdigest())'
}

@test "results are as recorded with the C library's functions for older processors" {
  [ -x "$PAPILIO_BUILD/unit_tests" ] || skip "there are no unit tests in this build"
  tests=$("$PAPILIO_BUILD/unit_tests" --gtest_list_tests)
  [[ $tests == *RecordedResults.* ]] || ! sanitized || skip "the thread sanitizer's build has no such test"
  [ "$(sum_of_sines)" != "$(GLIBC_TUNABLES=$older sum_of_sines)" ] || skip "this C library has one sine for both"
  run env GLIBC_TUNABLES=$older "$PAPILIO_BUILD/unit_tests" --gtest_filter='RecordedResults.*'
  echo "$output"
  [ "$status" = 0 ]
  [[ $output == *"[  PASSED  ] 2 tests."* ]]
}
