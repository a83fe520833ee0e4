# Options of the sanitizers for every program of a sanitized build; other builds ignore them. Sourced.
# shellcheck shell=bash
suppressions=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/tsan.supp
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1:strict_string_checks=1:detect_stack_use_after_return=1
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS="suppressions='$suppressions':second_deadlock_stack=1"
