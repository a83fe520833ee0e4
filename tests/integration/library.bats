#!/usr/bin/env bats
# The core as a library of others: installed, found, linked.

load helpers

# use_core FLAGS: a program that finds the core under $PWD/prefix, links it and refines.
use_core() {
  mkdir user
  cat >user/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES CXX)
find_package(papilio 0.1 REQUIRED)
add_executable(user main.cpp)
target_link_libraries(user papilio::core)
END
  cat >user/main.cpp <<'END'
#include <papilio/refine.h>

#include <iostream>

int main() {
  const papilio::TriangleMesh tetrahedron{{{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}},
                                          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  std::cout << papilio::refine(papilio::build_mesh(tetrahedron), {}).mesh.topology.face_count() << '\n';
}
END
  cmake -G Ninja -S user -B build -DCMAKE_PREFIX_PATH="$PWD/prefix" -DCMAKE_CXX_FLAGS="$1" >/dev/null
  cmake --build build >/dev/null
  [ "$(build/user)" = 64 ]
}

@test "an installed core is found by find_package and refines" {
  cd "$BATS_TEST_TMPDIR"
  cmake --install "$PAPILIO_BUILD" --prefix "$PWD/prefix" >/dev/null
  # The sanitizers of the build at hand, if any, are what the library needs to link.
  use_core "$(sed -n 's/^PAPILIO_SANITIZE:STRING=\(..*\)$/-fsanitize=\1/p' "$PAPILIO_BUILD/CMakeCache.txt")"
  "$PWD/prefix/bin/papilio" --version
}

@test "the core alone is built and installed without what only server and client need" {
  skip_if_sanitized
  cd "$BATS_TEST_TMPDIR"
  options=(-DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG='' -DCMAKE_CXX_COMPILER_LAUNCHER="$(command -v ccache)")
  for package in draco spdlog nlohmann_json CLI11 OpenSSL prometheus-cpp PkgConfig GTest benchmark; do
    options+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON") # as if it were not installed
  done
  cmake -G Ninja -S "$BATS_TEST_DIRNAME/../../core" -B core "${options[@]}" >/dev/null
  cmake --build core >/dev/null
  cmake --install core --prefix "$PWD/prefix" >/dev/null
  use_core ""
  # Both ways install the same version, and warnings are errors to the project alone.
  cmake --install "$PAPILIO_BUILD" --prefix "$PWD/whole" >/dev/null
  cmp {prefix,whole}/lib/cmake/papilio/papilioConfigVersion.cmake
  ! grep -q -- -Werror core/build.ninja
}
