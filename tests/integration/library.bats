#!/usr/bin/env bats
# The core as a library of others: installed, found, linked.

load helpers

@test "an installed core is found by find_package and refines" {
  cd "$BATS_TEST_TMPDIR"
  cmake --install "$PAPILIO_BUILD" --prefix "$PWD/prefix" >/dev/null
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
  # The sanitizers of the build at hand, if any, are what the library needs to link.
  flags=$(sed -n 's/^PAPILIO_SANITIZE:STRING=\(..*\)$/-fsanitize=\1/p' "$PAPILIO_BUILD/CMakeCache.txt")
  cmake -G Ninja -S user -B build -DCMAKE_PREFIX_PATH="$PWD/prefix" -DCMAKE_CXX_FLAGS="$flags" >/dev/null
  cmake --build build >/dev/null
  [ "$(build/user)" = 64 ]
  "$PWD/prefix/bin/papilio" --version
}
