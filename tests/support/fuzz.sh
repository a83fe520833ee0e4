#!/usr/bin/env bash
# fuzz.sh SECONDS: runs every fuzzer of build/asan in turn, two at a time with two cores, for SECONDS in total.
#   build/fuzz-seeds     initial inputs, regenerated each time, in addition to tests/fuzz/cases
#   build/fuzz-corpus    inputs that increased coverage; kept for the next run
#   build/fuzz-findings  failing inputs, and each target's log
# Exit status 1 if there is a finding.
set -euo pipefail
seconds=$1
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."
# shellcheck source=tests/support/sanitizers.sh
source "$here/sanitizers.sh"
# By default freed stack frames are quarantined, which halves the speed.
export ASAN_OPTIONS=$ASAN_OPTIONS:detect_stack_use_after_return=0

rm -rf build/fuzz-seeds build/fuzz-findings
mkdir -p build/fuzz-seeds build/fuzz-findings
build/asan/fuzz_seeds build/fuzz-seeds

targets=()
for program in build/asan/*_fuzz; do
  target=${program##*/}
  targets+=("${target%_fuzz}")
done
at_once=$(($(nproc) > 1 ? 2 : 1))
export each=$((seconds * at_once / ${#targets[@]}))
((each > 0)) || each=1

# shellcheck disable=SC2317 # xargs runs it
# run TARGET: runs a target; its log build/fuzz-findings/TARGET.log ends with its exit status.
run() {
  local status=0 findings=build/fuzz-findings/$1 folders=("build/fuzz-corpus/$1" "build/fuzz-seeds/$1" "tests/fuzz/cases/$1")
  mkdir -p "$findings" "${folders[@]}"
  "build/asan/$1_fuzz" -max_total_time="$each" -timeout=20 -rss_limit_mb=2048 -max_len=4096 -print_final_stats=1 \
    -dict=build/fuzz-seeds/words -artifact_prefix="$findings/" "${folders[@]}" >"$findings.log" 2>&1 || status=$?
  echo "exit status $status" >>"$findings.log"
}
export -f run
# shellcheck disable=SC2016 # the inner shell expands it
printf '%s\0' "${targets[@]}" | xargs -0 -n1 -P"$at_once" bash -c 'set -euo pipefail; run "$1"' run

# figure TARGET PATTERN: prints the last match of the pattern, a sed expression with one group, in the target's log.
figure() { sed -nE "s/$2/\1/p" "build/fuzz-findings/$1.log" | tail -1; }

broken=()
printf '\n%-20s %12s %9s %9s\n' target executions coverage seconds
for target in "${targets[@]}"; do
  printf '%-20s %12s %9s %9s\n' "$target" "$(figure "$target" '^#([0-9]+)\t.*')" \
    "$(figure "$target" '^#.* cov: ([0-9]+) .*')" "$(figure "$target" '^Done [0-9]+ runs in ([0-9]+) second.*')"
  [[ $(figure "$target" '^exit status (.*)') == 0 ]] || broken+=("$target")
done
((${#broken[@]})) || exit 0

for target in "${broken[@]}"; do
  log=build/fuzz-findings/$target.log
  printf '\nFINDING in %s; all it said is in %s:\n' "$target" "$log"
  grep -E '^(SUMMARY|does not hold|==[0-9]+==ERROR|terminate called|  what\(\)|.*runtime error)' "$log" | head -5 || tail -5 "$log"
  for input in "build/fuzz-findings/$target"/*; do
    [[ -f $input ]] || continue
    printf '%s\n' "$input" "  again:       build/asan/${target}_fuzz $input" \
      "  as a case:   cp $input tests/fuzz/cases/$target/WHAT-IT-WAS    (./dev test FuzzCases replays it)"
  done
done
exit 1
