#!/usr/bin/env bash
# real_meshes.sh [cgal] [bunny]: real meshes for the tests, the benchmark and the demo, fetched by package name into
# build/deps/meshes; never committed.
#   cgal/*.off ...   the example data of CGAL (Debian's libcgal-demo, unpacked, not installed)
#   bunny.obj        the Stanford bunny, 3,674 faces, closed (npm's `bunny`, public domain)
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/support/apt.sh
source "$here/apt.sh"
meshes=$deps/meshes
mkdir -p "$meshes"

if [[ " $* " == *" cgal "* && ! -d $meshes/cgal ]]; then
  unfinished=$(unfinished_folder cgal)
  unpack_package libcgal-demo "$unfinished"
  tar -C "$unfinished" -xzf "$unfinished/usr/share/doc/libcgal-dev/data.tar.gz" data/meshes
  mv -T "$unfinished/data/meshes" "$meshes/cgal"
  rm -r "$unfinished"
fi

if [[ " $* " == *" bunny "* && ! -f $meshes/bunny.obj ]]; then
  say "fetching the bunny"
  unfinished=$(unfinished_folder bunny)
  (cd "$unfinished" && npm pack --silent bunny@1.0.1 </dev/null >npm.log 2>&1) || {
    cat "$unfinished/npm.log" >&2
    die "npm could not fetch bunny@1.0.1"
  }
  tar -C "$unfinished" -xzf "$unfinished/bunny-1.0.1.tgz"
  node "$here/bunny_to_obj.js" "$unfinished/package/index.js" >"$unfinished/bunny.obj"
  mv "$unfinished/bunny.obj" "$meshes/bunny.obj"
  rm -r "$unfinished"
fi
