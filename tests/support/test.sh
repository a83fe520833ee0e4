#!/usr/bin/env bash
# test.sh PRESET [FILTER]: the unit tests (CTest), then the integration tests (bats), of what is built in build/PRESET;
# FILTER is a regular expression on their names. Both run whatever comes of the first.
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
"${unit[@]}" || failed=1

if compgen -G 'tests/integration/*.bats' >/dev/null; then
  command='bats --tap'
  [[ -z $filter ]] || command+=" --filter ${filter// /.}" # prove splits it at spaces
  prove --failures --comments --exec "$command" tests/integration/*.bats || failed=1
else
  echo "no integration tests in tests/integration"
fi
exit "$failed"
