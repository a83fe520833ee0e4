#!/usr/bin/env bash
# check.sh: what is judged without running the programs: formatting (clang-format, prettier), static analysis (clang-tidy,
# with the compile commands of build/release; tsc) and the shell scripts (shellcheck). All of them run, whatever comes of
# the others.
# clang-format and clang-tidy judge otherwise in each version: that of Debian 12 counts, and with another they are left out.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."
failed=()
judge=14

# is_judge PROGRAM: whether it is of the version that counts; says so if not.
is_judge() {
  "$1" --version | grep -q "version $judge\." || {
    echo "$1: left out: version $judge counts, and this is another"
    return 1
  }
}

# files PATTERN...: tracked files and new ones, less those deleted from disk.
files() {
  git ls-files --cached --others --exclude-standard --deduplicate -- "$@" | while read -r file; do
    [[ ! -f $file ]] || echo "$file"
  done
}
mapfile -t sources < <(files {core,proto,server,client,tests}/{'*.h','*.cpp'})
mapfile -t analysed < <(files {core,proto,server,client}/'*.cpp')
mapfile -t scripts < <(files dev .ci/run '*.sh')

if is_judge clang-format && ((${#sources[@]})); then
  echo "clang-format: ${#sources[@]} files"
  clang-format --dry-run --Werror "${sources[@]}" || failed+=(clang-format)
fi

# clang-tidy is slow: a file that passed is not read again, in whichever checkout, until it, a header of the project that
# it includes, the rules or its compile command change.
export TIDY_CACHE=${XDG_CACHE_HOME:-$HOME/.cache}/papilio/clang-tidy
mkdir -p "$TIDY_CACHE"
TIDY_RULES=$({ clang-tidy --version && cat .clang-tidy; } | sha256sum)
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
  output=$(clang-tidy --quiet -p build/release --extra-arg=-Wno-unknown-warning-option "$1" 2>&1) || {
    printf '%s\n' "$output" | grep -vE '^[0-9]+ warnings? (generated|treated)' # counts what system headers hide
    return 1
  }
  touch "$TIDY_CACHE/$key"
}
export -f tidy
if is_judge clang-tidy; then
  echo "clang-tidy: ${#analysed[@]} files"
  # shellcheck disable=SC2016 # the inner shell expands it
  printf '%s\0' "${analysed[@]}" | xargs -0 -r -n1 -P2 bash -c 'tidy "$1"' tidy || failed+=(clang-tidy)
fi

mapfile -t web < <(files client/web tests/web tests/container tests/openapi | grep -E '\.(ts|mjs|json|html|css)$' | grep -v package-lock)
echo "prettier: ${#web[@]} files"
client/web/node_modules/.bin/prettier --log-level warn --check "${web[@]}" || failed+=(prettier)
echo "tsc: client/web"
client/web/node_modules/.bin/tsc --project client/web || failed+=(tsc)

echo "shellcheck: ${#scripts[@]} scripts"
shellcheck --external-sources "${scripts[@]}" || failed+=(shellcheck)

if ((${#failed[@]})); then
  echo "check: failed: ${failed[*]}" >&2
  exit 1
fi
echo "check: passed"
