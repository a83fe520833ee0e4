#!/usr/bin/env bash
# check.sh: what is judged without running the programs: formatting (clang-format, prettier), static analysis (clang-tidy,
# with the compile commands of build/release; tsc) and the shell scripts (shellcheck). All of them run, whatever comes of
# the others. clang-format and clang-tidy differ from version to version; without version 14, Debian 12's, nothing runs.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."
failed=()
version=14

# clang_tool NAME: the program of the required version.
clang_tool() {
  local program
  for program in "$1-$version" "$1"; do
    if [[ $("$program" --version 2>/dev/null) == *"version $version."* ]]; then
      echo "$program"
      return
    fi
  done
  echo "check: $1 $version is required, and there is only: $({ "$1" --version 2>/dev/null || echo none; } | head -n 1)." \
    "Debian 12 has it: apt-get install $1-$version. On another system, run ./dev check in a container of Debian 12." >&2
  return 1
}
clang_format=$(clang_tool clang-format)
clang_tidy=$(clang_tool clang-tidy)
export clang_tidy

# files PATTERN...: tracked files and new ones, less those deleted from disk.
files() {
  git ls-files --cached --others --exclude-standard --deduplicate -- "$@" | while read -r file; do
    [[ ! -f $file ]] || echo "$file"
  done
}
mapfile -t sources < <(files {core,proto,server,client,tests}/{'*.h','*.cpp'})
mapfile -t analysed < <(files {core,proto,server,client}/'*.cpp')
mapfile -t scripts < <(files dev .ci/run '*.sh')

echo "clang-format: ${#sources[@]} files"
"$clang_format" --dry-run --Werror "${sources[@]}" || failed+=(clang-format)

# clang-tidy is slow: a file that passed is not read again, in whichever checkout, until it, a header of the project that
# it includes, the rules or its compile command change.
export TIDY_CACHE=${XDG_CACHE_HOME:-$HOME/.cache}/papilio/clang-tidy
mkdir -p "$TIDY_CACHE"
TIDY_RULES=$({ "$clang_tidy" --version && cat .clang-tidy; } | sha256sum)
export TIDY_RULES
tidy() {
  local entry object key output
  entry=$(jq -c --arg file "$PWD/$1" 'map(select(.file == $file))[0] // empty' build/release/compile_commands.json)
  if [[ -z $entry ]]; then
    echo "$1: no target of the build compiles it"
    return 1
  fi
  object=$(jq -r '.command | capture(" -o (?<object>[^ ]+)").object' <<<"$entry")
  mapfile -t headers < <(ninja -C build/release -t deps "$object" | sed -nE "s#^ *($PWD/|(\.\./)+)([a-z].*\.h)\$#\3#p")
  key=$({ echo "$TIDY_RULES ${entry//$PWD/}" && cat "$1" "${headers[@]}"; } | sha256sum | cut -d' ' -f1)
  [[ ! -f $TIDY_CACHE/$key ]] || return 0
  output=$("$clang_tidy" --quiet -p build/release --extra-arg=-Wno-unknown-warning-option "$1" 2>&1) || {
    printf '%s\n' "$output" | grep -vE '^[0-9]+ warnings? (generated|treated)' # counts what system headers hide
    return 1
  }
  touch "$TIDY_CACHE/$key"
}
export -f tidy
echo "clang-tidy: ${#analysed[@]} files"
# shellcheck disable=SC2016 # the inner shell expands it
printf '%s\0' "${analysed[@]}" | xargs -0 -r -n1 -P2 bash -c 'tidy "$1"' tidy || failed+=(clang-tidy)

mapfile -t web < <(files client/web tests/{web,scenes,container,openapi} | grep -E '\.(ts|mjs|json|html|css)$' | grep -v package-lock)
echo "prettier: ${#web[@]} files"
client/web/node_modules/.bin/prettier --log-level warn --check "${web[@]}" || failed+=(prettier)
echo "tsc: client/web"
client/web/node_modules/.bin/tsc --project client/web || failed+=(tsc)

echo "core_tree: the includes of the tree"
python3 tests/support/core_tree.py || failed+=(core_tree)

echo "shellcheck: ${#scripts[@]} scripts"
shellcheck --external-sources "${scripts[@]}" || failed+=(shellcheck)

if ((${#failed[@]})); then
  echo "check: failed: ${failed[*]}" >&2
  exit 1
fi
echo "check: passed"
