#!/usr/bin/env bats
# The core as a library: installed, found, linked; and its tree of folders.

load helpers

setup_file() {
  export PREFIX=$BATS_FILE_TMPDIR/prefix
  cmake --install "$PAPILIO_BUILD" --prefix "$PREFIX" >/dev/null
  # The library links with the sanitizers of this build, if any.
  SANITIZERS=$(sed -n 's/^PAPILIO_SANITIZE:STRING=\(..*\)$/-fsanitize=\1/p' "$PAPILIO_BUILD/CMakeCache.txt")
  export SANITIZERS
}

setup() { cd "$BATS_TEST_TMPDIR" || return; }

examples=$BATS_TEST_DIRNAME/../../client/examples

# build_examples PREFIX FLAGS: builds the examples with the core installed under PREFIX, and runs them.
build_examples() {
  cmake -G Ninja -S "$examples" -B examples -DCMAKE_PREFIX_PATH="$1" -DCMAKE_CXX_FLAGS="$2" >/dev/null
  cmake --build examples >/dev/null
  examples/example_refine_mesh "$examples/octahedron.obj" fine.obj
  [ "$(grep -c ^f fine.obj)" -gt 8 ]
  examples/example_levels | grep -q '^level 3: 512 faces, the last$'
  [ "$(examples/example_views | grep -c faces)" = 3 ]
}

@test "find_package finds an installed core, and the examples build and run with it" {
  build_examples "$PREFIX" "$SANITIZERS"
  "$PREFIX/bin/papilio" --version
}

@test "pkg-config finds an installed core, also after the tree was moved" {
  mkdir elsewhere
  cp -r "$PREFIX"/{include,lib} elsewhere
  for prefix in "$PREFIX" "$PWD/elsewhere"; do
    flags=$(PKG_CONFIG_PATH="$prefix/lib/pkgconfig" pkg-config --cflags --libs papilio)
    [[ $flags == *"$prefix/lib"* ]]
    # shellcheck disable=SC2086 # words
    "${CXX:-c++}" -std=c++20 $SANITIZERS "$examples/levels.cpp" $flags -o levels
    ./levels | grep -q '^level 3: 512 faces, the last$'
  done
  [ "$(PKG_CONFIG_PATH="$PREFIX/lib/pkgconfig" pkg-config --modversion papilio)" = "$("$PREFIX/bin/papilio" --version | grep -o '[0-9.]*$')" ]
}

@test "every installed header compiles as the first include, without warnings" {
  for header in "$PREFIX"/include/papilio/*; do
    echo "#include <papilio/${header##*/}>" >one.cpp
    "${CXX:-c++}" -std=c++20 -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I"$PREFIX/include" one.cpp
  done
}

@test "installed headers have no intrinsics and no macros, and include only installed headers" {
  cd "$PREFIX/include/papilio"
  [ "$(grep -rnE 'immintrin|_mm_|^ *# *define' . | wc -l)" = 0 ]
  [ "$(grep -rhE '^ *# *include' . | grep -cvE '^#include (<[a-z_]+>|"papilio/[a-z_0-9]+\.h")$')" = 0 ]
  for header in $(grep -rhoE '"papilio/[a-z_0-9]+\.h"' . | tr -d '"'); do [ -f "../$header" ]; done
  [ "$(ls .. | xargs)" = "papilio papilio.h" ] # and the C functions
}

@test "the core builds and installs without the dependencies of server and client" {
  skip_if_sanitized
  options=(-DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG='' -DCMAKE_UNITY_BUILD=ON
    -DCMAKE_CXX_COMPILER_LAUNCHER="$(command -v ccache)")
  for package in draco spdlog nlohmann_json CLI11 OpenSSL prometheus-cpp PkgConfig GTest benchmark; do
    options+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON") # as if it were not installed
  done
  cmake -G Ninja -S "$BATS_TEST_DIRNAME/../../core" -B core "${options[@]}" >/dev/null
  cmake --build core >/dev/null
  cmake --install core --prefix "$PWD/alone" >/dev/null
  build_examples "$PWD/alone" ""
  # Both ways install equal headers and versions.
  diff -r {alone,"$PREFIX"}/include/papilio
  cmp {alone,"$PREFIX"}/lib/cmake/papilio/papilioConfigVersion.cmake
  cmp {alone,"$PREFIX"}/lib/pkgconfig/papilio.pc
  [ "$(cd alone && find . -type f | grep -vE '^\./(include/papilio/|lib/cmake/papilio/|lib/pkgconfig/papilio\.pc$)')" = ./lib/libpapilio_core.a ]
}

@test "warnings are errors only in the project's presets" {
  cmake -G Ninja -S "$BATS_TEST_DIRNAME/../../core" -B core >/dev/null
  [ "$(grep -c -- -Werror core/build.ninja)" = 0 ]
  grep -q '^option(PAPILIO_WERROR .* OFF)$' "$BATS_TEST_DIRNAME/../../CMakeLists.txt"
}

@test "includes between folders have one direction" {
  cd "$BATS_TEST_DIRNAME/../.."
  python3 tests/support/core_tree.py
}
