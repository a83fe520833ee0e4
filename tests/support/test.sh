#!/usr/bin/env bash
# test.sh PRESET [FILTER]: the unit tests (CTest), the integration tests (bats) and those of the viewer (node), of what is
# built in build/PRESET; FILTER is a regular expression on their names. All run whatever comes of the others, as many at a
# time as there are cores: each starts its own servers.
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
# The thread sanitizer has the tests alone that name threads, servers or HTTP (tests/CMakeLists.txt); of these, without long
# ones of what runs in one thread.
one_thread='DetailLevels\.Boundaries|DracoAttributes|Growth|Tolerance\.(Holds|Error)|.*RedGreen(OnReal|Real)Mesh'
[[ $preset != tsan ]] || unit+=(-E "^($one_thread)")
# And of one kernel, whose memory other tests look at in all its functions.
[[ $preset != asan ]] || unit+=(-E '^(DetailBaseline|Edgebreaker/EdgebreakerAtSpeed|Growth|Pack\.TakesTheSimplified)')
[[ ${PAPILIO_TEST_UNITS:-yes} != yes ]] || "${unit[@]}" || failed=1

integration='bats --tap'
# Sanitized encoders of detail take minutes, and are tested by CTest.
[[ $preset == release ]] || integration+=' --filter-tags !many_encodings'
web=tests/support/web_test.sh
if [[ -n $filter ]]; then # prove splits it at spaces
  integration+=" --filter ${filter// /.}"
  web+=" --test-name-pattern=${filter// /.}"
fi
# What a sanitizer has nothing to find in: programs and pages that are built without, a proxy before the server, and for
# threads the command line.
apart='^$'
[[ $preset != asan ]] || apart='(c_library|dev|generated|library|nginx|page)\.bats$'
[[ $preset != tsan ]] || apart='(c_library|client|detail|dev|generated|library|nginx|page)\.bats$'
# Pages, and what only scripts and the proxy have to say, are the same on each Debian; its proxy is in the image's tests.
has_pages=${PAPILIO_TEST_PAGES:-yes}
[[ $has_pages == yes ]] || apart='(dev|generated|library|nginx|page)\.bats$'
mapfile -t suites < <(printf '%s\n' tests/integration/*.bats | grep -vE "$apart")
prove --failures --comments --timer --jobs "$(nproc)" --exec "$integration" "${suites[@]}" || failed=1
# Pages look at what the programs have written, which is the same under sanitizers. What they ask the server for, the
# integration tests have asked for. The module for browsers is compiled once.
[[ $preset != tsan && $has_pages == yes ]] || exit "$failed"
pages=(tests/{web,scenes,npm}/*.test.mjs)
[[ $preset == release ]] || pages=(tests/scenes/scenes.test.mjs)
prove --failures --comments --timer --jobs "$(nproc)" --exec "$web" "${pages[@]}" || failed=1
exit "$failed"
