#!/usr/bin/env bash
# coarse_meshes.sh PRESET: makes, in build/deps/meshes and unless they are there, with the programs of build/PRESET:
#   bunny600.obj, bunny600.drc   the bunny in 600 faces
#   elephant2000.obj             the elephant in 2000
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
programs=$root/build/$1
cd "$root/build/deps/meshes"
[[ -f bunny600.obj ]] || "$programs/simplify_mesh" bunny.obj bunny600.obj 600
[[ -f elephant2000.obj ]] || "$programs/simplify_mesh" cgal/elephant.off elephant2000.obj 2000
if [[ ! -f bunny600.drc ]]; then
  "$programs/papilio" convert bunny600.obj unfinished.drc
  mv unfinished.drc bunny600.drc
fi
