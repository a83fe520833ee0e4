#!/usr/bin/env bats
# Messages of the command line about its arguments.

bats_require_minimum_version 1.5.0
load helpers

setup() { cd "$BATS_TEST_TMPDIR" || return; }

@test "a missing file is said to be missing, whatever its name ends in" {
  for name in nofile nofile.xyz nofile.drc; do
    for command in info "refine -o out.drc" "convert -o out.drc" "compare $PAPILIO_MESHES/bunny600.drc"; do
      # shellcheck disable=SC2086
      run -1 "$papilio" $command "$name"
      [[ $output == "papilio: $name: does not exist; check the name" ]]
    done
  done
  cp "$PAPILIO_MESHES/bunny600.drc" bunny
  run -1 "$papilio" info bunny
  [[ $output == *"has no extension"* ]]
}

@test "a missing argument has the name that the usage shows" {
  run -2 "$papilio" convert "$PAPILIO_MESHES/bunny600.drc"
  [ "$output" = "papilio: output is required. papilio convert --help lists what it takes." ]
  [[ $("$papilio" convert --help) == *"convert [OPTIONS] input output"* ]]
  run -2 "$papilio" convert
  [[ $output == *" input is required. "* ]]
  run -2 "$papilio" unpack model.glb
  [[ $output == *" --output is required. "* ]]
}
