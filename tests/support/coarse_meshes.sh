#!/usr/bin/env bash
# coarse_meshes.sh PRESET: makes missing meshes in build/deps/meshes with the programs of build/PRESET:
#   bunny600.obj, bunny600.drc   the bunny in 600 faces
#   elephant2000.obj             the elephant in 2000
#   elephant2k.drc, elephant10k.drc, elephant20k.drc, elephant62.5k.drc, elephant89k.drc
#                                a finer, closed elephant in 2000, 10000, 20000, 62,500 and
#                                all its 88,928 faces
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
programs=$root/build/$1
cd "$root/build/deps/meshes"
[[ -f bunny600.obj ]] || "$programs/simplify_mesh" bunny.obj bunny600.obj 600
[[ -f elephant2000.obj ]] || "$programs/simplify_mesh" cgal/elephant.off elephant2000.obj 2000
# in_draco_order FILE.obj FILE.drc
in_draco_order() {
  "$programs/papilio" convert "$1" unfinished.drc
  mv unfinished.drc "$2"
}
[[ -f bunny600.drc ]] || in_draco_order bunny600.obj bunny600.drc
for thousands in 2 10 20 62.5; do
  [[ ! -f elephant${thousands}k.drc ]] || continue
  "$programs/simplify_mesh" cgal/refined_elephant.off unfinished.obj "$(awk "BEGIN { print 1000 * $thousands }")"
  in_draco_order unfinished.obj "elephant${thousands}k.drc"
  rm unfinished.obj
done
[[ -f elephant89k.drc ]] || in_draco_order cgal/refined_elephant.off elephant89k.drc
