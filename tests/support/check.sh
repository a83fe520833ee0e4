#!/usr/bin/env bash
# check.sh: checks without running programs: formatting (clang-format, prettier), static analysis (clang-tidy with the
# compile commands of build/check, where nothing is built; tsc) and the shell scripts (shellcheck). All checks run even
# after failures. clang-format and clang-tidy differ between versions: version 14, Debian 12's, is required.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."
failed=()
version=14

# clang_tool NAME: prints the program of the required version.
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

# files PATTERN...: prints tracked and new files, without files deleted from disk.
files() {
  git ls-files --cached --others --exclude-standard --deduplicate -- "$@" | while read -r file; do
    [[ ! -f $file ]] || echo "$file"
  done
}
mapfile -t sources < <(files {core,proto,server,client,tests}/{'*.h','*.cpp','*.c'})
mapfile -t analysed < <(files {core,proto,server,client}/'*.cpp' | grep -v '^client/wasm/') # which another compiler builds
mapfile -t scripts < <(files dev .ci/run '*.sh')

echo "clang-format: ${#sources[@]} files"
"$clang_format" --dry-run --Werror "${sources[@]}" || failed+=(clang-format)

echo "clang-tidy: ${#analysed[@]} files"
cmake --preset release -B build/check -DPAPILIO_UNITY=OFF -DPAPILIO_TESTS=ON -DPAPILIO_WEB=OFF >build/configure.log || cat build/configure.log
python3 tests/support/tidy.py "$clang_tidy" "${analysed[@]}" || failed+=(clang-tidy)

mapfile -t web < <(files client/{web,npm} tests/{web,npm,scenes,container,openapi} | grep -E '\.(ts|mjs|json|html|css)$' | grep -v package-lock)
echo "prettier: ${#web[@]} files"
client/web/node_modules/.bin/prettier --log-level warn --check "${web[@]}" || failed+=(prettier)
for project in client/web client/npm; do
  echo "tsc: $project"
  client/web/node_modules/.bin/tsc --project "$project" --noEmit || failed+=("tsc of $project")
done

echo "core_tree: the includes of the tree"
python3 tests/support/core_tree.py || failed+=(core_tree)

echo "shellcheck: ${#scripts[@]} scripts"
shellcheck --external-sources "${scripts[@]}" || failed+=(shellcheck)

if ((${#failed[@]})); then
  echo "check: failed: ${failed[*]}" >&2
  exit 1
fi
echo "check: passed"
