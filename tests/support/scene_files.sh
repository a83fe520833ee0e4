#!/usr/bin/env bash
# scene_files.sh: installs real glTF scenes and their readers for tests/scenes; not committed.
#   tests/scenes/node_modules   as locked by its package-lock.json: readers, a validator, hands and controllers (MIT)
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
