#!/usr/bin/env bash
# setup.sh [--list] [build|page|wasm|test|demo|bench|screenshots|check|fuzz|soak|container]...: installs the missing
# dependencies of these commands; without arguments, of all. Prints each step; prints nothing if nothing is missing.
# --list: only prints the names of the packages and programs.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/support/apt.sh
source "$here/apt.sh"

packages=()
programs=() # as program:package, for what may have been installed in some other way
meshes=() # as real_meshes.sh calls them
libraries=no # of the tests: GoogleTest, Google Benchmark, OpenMesh
page=no
scenes=no
manifests=no
list=no
if [[ ${1:-} == --list ]]; then
  list=yes
  shift
fi
(($#)) || set -- build page wasm test demo bench check fuzz soak container
for purpose in "$@"; do
  case $purpose in
    build)
      packages+=(g++ cmake ninja-build pkgconf ccache libcpp-httplib-dev nlohmann-json3-dev libdraco-dev libspdlog-dev
        libcli11-dev libmeshoptimizer-dev libssl-dev libhiredis-dev prometheus-cpp-dev ca-certificates)
      ;;
    page) page=yes ;;
    wasm)
      page=yes
      packages+=(clang-19 lld-19 wasi-libc libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32 binaryen
        libmeshoptimizer-dev nlohmann-json3-dev dpkg-dev ninja-build cmake ccache ca-certificates)
      ;;
    test)
      meshes=(cgal bunny) libraries=yes scenes=yes
      packages+=(bats perl curl jq draco ca-certificates openssl redis-server nginx)
      [[ ${PAPILIO_TEST_PAGES:-yes} != yes ]] || packages+=(chromium fonts-dejavu-core)
      programs+=(python3:python3)
      ;;
    demo) meshes+=(cgal) packages+=(curl jq ca-certificates) ;;
    bench) meshes=(cgal bunny) libraries=yes packages+=(ca-certificates) ;;
    screenshots) packages+=(webp) ;;
    check) page=yes libraries=yes packages+=(clang-format clang-tidy shellcheck git jq ca-certificates) ;;
    fuzz) packages+=(libgtest-dev clang-19 libclang-rt-19-dev dpkg-dev ca-certificates) ;;
    soak) meshes=(cgal bunny) libraries=yes packages+=(wrk curl jq ca-certificates) ;;
    container)
      meshes=(cgal bunny) libraries=yes manifests=yes
      packages+=(buildah podman runc netavark aardvark-dns catatonit docker-compose iptables iproute2 util-linux mmdebstrap bats perl curl jq
        wrk redis-server ca-certificates)
      ;;
    *) die "unknown purpose '$purpose'" ;;
  esac
done
[[ $libraries == no ]] || packages+=(libgtest-dev libgmock-dev libbenchmark-dev libpng-dev)
[[ $page$manifests == nono && " ${meshes[*]} " != *" bunny "* ]] || programs+=(node:nodejs npm:npm)
if [[ $list == yes ]]; then
  printf '%s\n' "${packages[@]}" "${programs[@]#*:}" | sort -u
  [[ $libraries == no ]] || echo libopenmesh-dev
  exit
fi

missing=()
if command -v dpkg-query >/dev/null; then
  installed=" $(dpkg-query -W -f '${db:Status-Abbrev}${Package} ' "${packages[@]}" 2>/dev/null | tr -s ' ' || true)"
  for package in "${packages[@]}"; do
    [[ $installed == *" ii $package "* || " ${missing[*]} " == *" $package "* ]] || missing+=("$package")
  done
else
  die "Debian 12 or 13 is needed here; elsewhere, provide: ${packages[*]}"
fi
for program in "${programs[@]}"; do
  command -v "${program%:*}" >/dev/null || missing+=("${program#*:}")
done

mkdir -p "$deps"
exec 9>"$deps/setup.lock"
flock 9 # two set-ups at once: the second finds nothing left to do

((${#missing[@]} == 0)) || apt_install "${missing[@]}"

# OpenMesh: the package of its library, whose name has a version, and only the headers of its development package, which
# depends on a viewer.
openmesh() {
  local library unfinished
  if ! compgen -G '/usr/lib/*/libOpenMeshCore.so.*' >/dev/null; then
    apt_update
    library=$(apt-cache depends libopenmesh-dev | sed -n 's/^ *Depends: \(libopenmesh[0-9].*\)$/\1/p')
    apt_install "$library"
  fi
  [[ ! -d $deps/openmesh ]] || return 0
  unfinished=$(unfinished_folder openmesh)
  unpack_package libopenmesh-dev "$unfinished"
  mv -T "$unfinished" "$deps/openmesh"
}

[[ $libraries == no ]] || openmesh
((${#meshes[@]} == 0)) || "$here/real_meshes.sh" "${meshes[@]}"
[[ $page == no ]] || "$here/web_packages.sh"
[[ $scenes == no ]] || "$here/scene_files.sh"
[[ $manifests == no ]] || "$here/manifest_tools.sh"
[[ " $* " != *" test "* ]] || { "$here/openapi_linter.sh" && "$here/client_generators.sh"; }
