#!/usr/bin/env bash
# wasm.sh: builds the WebAssembly modules (build/wasm) and the npm package with them (build/npm). Requires the set-up.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."
mkdir -p build
# Configured each time: source files may have been added or removed.
cmake -S client/wasm -B build/wasm -G Ninja -DCMAKE_TOOLCHAIN_FILE="$PWD/client/wasm/toolchain.cmake" >build/configure.log 2>&1 || {
  cat build/configure.log >&2
  exit 1
}
"$here/compile.sh" build/wasm wasm

# Unchanged files keep their dates: the viewer is built from them.
rm -rf build/npm.new
mkdir -p build/npm.new build/npm
cp client/npm/package.json client/npm/README.md LICENSE build/npm.new/
client/web/node_modules/.bin/tsc -p client/npm --outDir build/npm.new/dist
cp build/wasm/papilio.wasm build/wasm/papilio-detail.wasm build/wasm/papilio-files.wasm build/npm.new/dist/
(cd build/npm && find . -type f) | while read -r file; do
  [[ -f build/npm.new/$file ]] || rm "build/npm/$file"
done
(cd build/npm.new && find . -type f) | while read -r file; do
  cmp -s "build/npm.new/$file" "build/npm/$file" || install -D -m 644 "build/npm.new/$file" "build/npm/$file"
done
rm -rf build/npm.new
