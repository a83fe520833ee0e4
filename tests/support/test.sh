#!/usr/bin/env bash
# test.sh PRESET [FILTER]: runs the unit tests (CTest), the integration tests (bats) and the viewer's tests (node) of
# build/PRESET; FILTER is a regular expression for their names. All run even after failures, in parallel on all cores:
# each starts its own servers.
set -euo pipefail
preset=$1
filter=${2:-}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
cd "$root"
# shellcheck source=tests/support/sanitizers.sh
source "$here/sanitizers.sh"
export PAPILIO_BUILD=$root/build/$preset
export PAPILIO_MESHES=$root/build/deps/meshes
failed=0

"$here/coarse_meshes.sh" "$preset" || failed=1

unit=(ctest --test-dir "build/$preset" --output-on-failure --parallel "$(nproc)")
if [[ -n $filter ]]; then unit+=(-R "$filter"); else unit+=(--no-tests=error); fi
# Excluded under sanitizers: long tests whose functions run in others, too, with small or random meshes; under the thread
# sanitizer, whose build has only tests that name threads, servers or HTTP (tests/CMakeLists.txt), those of one thread.
long='Growth|.*Real'
case $preset in
  asan)
    long+='|Edgebreaker\.BytesEqualLibdracos(OnEvery|WithExact|WithAttributes.*(Random|Refined))|Refinement\.Unreached'
    long+='|Detail\.Smooth|DetailBaseline|Pack\.|Packed(Materials\.Simplified|Parts\.(Decoded|Refined))|Refine\.BunnyEquals'
    long+='|SimplifiedDraco\.(Finely|Stated|Stream)'
    ;;
  tsan)
    long+='|Allocation|DetailLevels\.(Boundaries|Tolerance)|Displacement|DracoAttributes|Refinement\.(CancelledHook|Unreached)'
    long+='|PreparedMesh\.(Attributes|Cancelled|ErrorEquals|MemoryLimit|ResultsEqual|SharedEdges)|StoredRefinement\.BytesEqual'
    long+='|Tolerance\.(Cancellation|Error|TenLevels|ToleranceHolds)|Uniform\.Skipped'
    ;;
  *) long=- ;;
esac
unit+=(-E "^($long)")
[[ ${PAPILIO_TEST_UNITS:-yes} != yes ]] || "${unit[@]}" || failed=1

# longest_first FILE...: prints the files, the largest first: those take longest, and begun last they would run alone.
longest_first() { wc -c "$@" | grep -v ' total$' | sort -rn | sed 's/^ *[0-9]* //'; }

integration='bats --tap'
# Sanitized encoders of detail take minutes. CTest covers them.
[[ $preset == release ]] || integration+=' --filter-tags !many_encodings'
web=tests/support/web_test.sh
if [[ -n $filter ]]; then # prove splits it at spaces
  integration+=" --filter ${filter// /.}"
  web+=" --test-name-pattern=${filter// /.}"
fi
# Excluded under sanitizers: programs and pages built without, the proxy, and for threads the command line.
apart='^$'
[[ $preset != asan ]] || apart='(c_library|dev|generated|library|nginx|page)\.bats$'
[[ $preset != tsan ]] || apart='(c_library|client|detail|dev|generated|library|nginx|page)\.bats$'
# Pages, scripts and the proxy do not depend on the version of Debian; the image's tests cover its proxy.
has_pages=${PAPILIO_TEST_PAGES:-yes}
[[ $has_pages == yes ]] || apart='(dev|generated|library|nginx|page)\.bats$'
mapfile -t suites < <(longest_first tests/integration/*.bats | grep -vE "$apart")
prove --failures --comments --timer --jobs "$(nproc)" --exec "$integration" "${suites[@]}" || failed=1
# Pages are tested without sanitizers: outputs are equal, and the integration tests cover their requests. The module for
# browsers is compiled once.
[[ $preset != tsan && $has_pages == yes ]] || exit "$failed"
mapfile -t pages < <(longest_first tests/{web,scenes,npm}/*.test.mjs)
[[ $preset == release ]] || pages=(tests/scenes/scenes.test.mjs)
prove --failures --comments --timer --jobs "$(nproc)" --exec "$web" "${pages[@]}" || failed=1
exit "$failed"
