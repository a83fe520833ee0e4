#!/usr/bin/env bash
# scene_files.sh: real glTF scenes and what reads them, for tests/scenes; never committed.
#   tests/scenes/node_modules   as its package-lock.json has them: readers, a validator, hands and controllers (MIT)
#   build/deps/scenes           Debian's assimp-testmodels and gltfpack, unpacked, not installed
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/support/apt.sh
source "$here/apt.sh"
# shellcheck source=tests/support/npm.sh
source "$here/npm.sh"
mkdir -p "$deps"
npm_packages "$here/../scenes" "scenes and their readers"
if [[ ! -d $deps/scenes ]]; then
  unfinished=$(unfinished_folder scenes)
  unpack_package assimp-testmodels "$unfinished"
  unpack_package gltfpack "$unfinished"
  mv -T "$unfinished" "$deps/scenes"
fi
