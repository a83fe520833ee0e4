#!/usr/bin/env bats
# The C functions as a shared library: installed, linked by a C compiler, called from another language.

load helpers

setup_file() {
  export PREFIX=$BATS_FILE_TMPDIR/prefix
  cmake --install "$PAPILIO_BUILD" --prefix "$PREFIX" >/dev/null
}

setup() { skip_if_sanitized; } # neither Python nor a plain C program is built with them

@test "a C program compiles with the installed header and library, and runs" {
  cd "$BATS_TEST_TMPDIR"
  cat >use.c <<'END'
#include <papilio.h>
#include <stdio.h>
int main(void) {
  const float positions[] = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
  const uint32_t triangles[] = {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};
  const papilio_triangles tetrahedron = {4, 4, 0, positions, triangles, NULL};
  papilio_mesh* mesh = papilio_mesh_create(&tetrahedron);
  papilio_result* fine = papilio_refine(mesh, "levels=3&shape=plain", NULL);
  if (fine == NULL) return printf("%s\n", papilio_last_message());
  printf("%s %u\n", papilio_version(), papilio_result_mesh(fine)->face_count);
  papilio_result_free(fine);
  papilio_mesh_free(mesh);
  return 0;
}
END
  cc -std=c99 -Wall -Wextra -Wpedantic -Werror -I"$PREFIX/include" use.c -L"$PREFIX/lib" -lpapilio -Wl,-rpath,"$PREFIX/lib" -o use
  [ "$(./use)" = "$("$PREFIX/bin/papilio" --version | grep -o '[0-9.]*$') 256" ]
}

@test "Python bindings return results, levels, cancellation and errors with their text" {
  python3 "$BATS_TEST_DIRNAME/../support/c_library.py" "$PREFIX/lib/libpapilio.so"
}

@test "the library exports only its functions, and requires neither server nor Draco" {
  names=$(nm -D --defined-only "$PREFIX/lib/libpapilio.so" | awk '{ print $3 }' | sed 's/@.*//' | sort | xargs)
  declared=$(grep -oE '\bpapilio_[a-z_]+\(' "$PREFIX/include/papilio.h" | tr -d '(' | sort -u | xargs)
  [ "$names" = "$declared" ]
  needed=$(objdump -p "$PREFIX/lib/libpapilio.so" | awk '$1 == "NEEDED" { print $2 }' | xargs)
  [[ $needed != *draco* && $needed != *ssl* && $needed != *spdlog* ]]
}
