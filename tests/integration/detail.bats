#!/usr/bin/env bats
# Packed models: pack, unpack, the other commands on packed models, and invalid files.

bats_require_minimum_version 1.5.0
load helpers

fine=$PAPILIO_MESHES/bunny.obj

setup_file() {
  "$papilio" pack "$fine" -o "$BATS_FILE_TMPDIR/model.glb" --rms 0.003 --no-simplify --json >"$BATS_FILE_TMPDIR/report.json"
}
setup() {
  cd "$BATS_TEST_TMPDIR" || return
  cp "$BATS_FILE_TMPDIR/model.glb" "$BATS_FILE_TMPDIR/report.json" .
}

# distance A B KEY: prints a distance between two surfaces, as a share of the diagonal of A.
distance() { "$papilio" compare --json "$1" "$2" | jq ".$3 / .diagonal"; }
# attributes SCENE: prints the attributes of its first mesh.
attributes() { "$papilio" info --json "$1" | jq -c '.meshes[0].attributes'; }
# is_within A B: tests that A is at most B.
is_within() { jq -ne "$1 <= $2" >/dev/null || { echo "$1 > $2"; return 1; }; }
report() { jq -r "$1" report.json; }

@test "the surface of every level has the stated distance from the original" {
  [ "$(report .format)" = packed ]
  is_within "$(report '.levels[-1].rms')" 0.003
  levels=$(report '.levels | length')
  for ((level = 0; level <= levels; ++level)); do
    "$papilio" unpack model.glb -o "level$level.ply" --levels "$level"
    stated=$(report "([.base] + .levels)[$level]")
    # Both the report and this test sample the distance.
    is_within "$(distance "$fine" "level$level.ply" rms)" "1.1 * $(jq .rms <<<"$stated")"
    is_within "$(distance "$fine" "level$level.ply" hausdorff)" "1.3 * $(jq .largest <<<"$stated")"
    [ "$("$papilio" info --json "level$level.ply" | jq -c '[.faces, .closed, .euler_characteristic]')" = \
      "[$(jq .faces <<<"$stated"),true,$("$papilio" info --json "$fine" | jq .euler_characteristic)]" ]
  done
}

@test "a packed model is smaller than plain Draco at the same distance" {
  [ "$(report .bytes)" = "$(stat -c %s model.glb)" ]
  is_within "$(report .bytes)" "$(report .plain.bytes)"
}

@test "a model unpacks to each output format with the same surface" {
  "$papilio" unpack model.glb -o out.obj
  for kind in drc ply off stl glb gltf; do
    "$papilio" unpack model.glb -o "out.$kind"
    is_within "$(distance out.obj "out.$kind" hausdorff)" 1e-12
  done
  # Scenes get normals even without those of an original, as viewers would show facets otherwise.
  ! grep -q '^vn ' out.obj
  for kind in glb gltf; do [ "$(attributes "out.$kind")" = '["NORMAL","POSITION"]' ]; done
  "$papilio" unpack model.glb -o flat.glb --normals false --levels 1
  [ "$(attributes flat.glb)" = '["POSITION"]' ]
  "$papilio" unpack model.glb -o smooth.obj --normals true --levels 1
  grep -q '^vn ' smooth.obj
  "$papilio" unpack - -o - --to obj <model.glb | cmp - out.obj
}

# ball: writes a small closed surface.
ball() { "$papilio" refine "${BATS_TEST_DIRNAME:?}/../../client/examples/octahedron.obj" -o ball.obj --levels 4; }

# bats test_tags=many_encodings
@test "packing is deterministic, from each input format" {
  ball
  "$papilio" pack - -o - --rms 0.005 --no-simplify <ball.obj >ball.glb
  for kind in drc ply stl; do
    "$papilio" convert ball.obj "in.$kind"
    "$papilio" pack "in.$kind" -o "$kind.glb" --rms 0.005 --no-simplify --json | jq -e '.folds >= 0' >/dev/null
    "$papilio" unpack "$kind.glb" -o out.off
    is_within "$(distance "in.$kind" out.off rms)" 0.0055
  done
  cmp ball.glb ply.glb
}

@test "the report has base, levels, distances and the ratio" {
  ball
  run --separate-stderr "$papilio" pack ball.obj -o again.glb --rms 0.005 --no-simplify
  [ "$status" = 0 ]
  [ "$stderr" = "" ]
  [[ $output == *"base "*" faces, "*" bytes: RMS "*" %, largest "*"level 1 "*"plain Draco at the same distance"*"times as many"* ]]
}

@test "a simplified mesh that is smaller replaces the model, unless levels are requested" {
  ball
  "$papilio" refine ball.obj -o fine_ball.obj --levels 1 >/dev/null
  run --separate-stderr "$papilio" pack fine_ball.obj -o simple.glb --rms 0.005
  [ "$status" = 0 ]
  [[ $output == *"bytes of Draco, simplified to "* ]]
  [[ $stderr == *"a simplified mesh as Draco, without levels"*"and a packed model "* ]]
  run "$papilio" unpack simple.glb -o simple.ply
  [ "$status" = 0 ]
  is_within "$(distance fine_ball.obj simple.ply rms)" 0.005
  "$papilio" pack fine_ball.obj -o packed.glb --rms 0.005 --no-simplify >/dev/null
  (($(stat -c %s simple.glb) < $(stat -c %s packed.glb)))
}

@test "info describes a packed model" {
  "$papilio" info --json model.glb >info.json
  [ "$(jq -c '.detail.levels' info.json)" = "$(report '.levels' | jq -c .)" ]
  [ "$(jq .faces info.json)" = "$(report .base.faces)" ]
  [[ $("$papilio" info model.glb) == *"detail.levels.0.rms"* ]]
}

@test "a prefix is a coarser model, if prefixes are allowed" {
  size=$(stat -c %s model.glb)
  last=$(report '.levels[-1].bytes')
  head -c $((size - last / 2)) model.glb >cut.glb
  run "$papilio" unpack cut.glb -o out.obj
  [ "$status" = 1 ]
  [[ $output == *"header declares $size bytes"* ]]
  [ ! -e out.obj ]
  run --separate-stderr "$papilio" unpack cut.glb -o out.obj --truncated
  [ "$status" = 0 ]
  [[ $stderr == *"levels are whole"* ]]
  "$papilio" unpack model.glb -o coarser.obj --levels $(($(report '.levels | length') - 1))
  cmp out.obj coarser.obj
}

@test "levels in pieces have the same surface, and a prefix has its complete pieces" {
  "$papilio" pack "$fine" -o pieces.glb --rms 0.003 --no-simplify --piece-bytes 64 --json >pieces.json
  "$papilio" unpack pieces.glb -o pieces.obj
  "$papilio" unpack model.glb -o whole.obj
  cmp pieces.obj whole.obj
  pieces=$(jq '[.levels[].pieces | select(.)][-1]' pieces.json)
  ((pieces > 1))
  behind=$(jq '.levels | map(has("pieces")) as $has | [.[($has | rindex(true)) + 1:][].bytes] | add // 0' pieces.json)
  head -c $(($(stat -c %s pieces.glb) - behind - 10)) pieces.glb >cut-pieces.glb
  run --separate-stderr "$papilio" unpack cut-pieces.glb -o cut-pieces.obj --truncated
  [ "$status" = 0 ]
  [[ $stderr == *"and of the next one $((pieces - 1)) of $pieces pieces"* ]]
  ! cmp cut-pieces.obj whole.obj
}

@test "refine accepts levels of a packed model, for each output format" {
  levels=$(report '.levels | length')
  for ((level = 0; level <= levels; ++level)); do
    "$papilio" unpack model.glb -o "level$level.ply" --levels "$level"
    run --separate-stderr "$papilio" refine model.glb -o refined.glb --levels "$level" --compress none
    [ "$status" = 0 ]
    [[ $stderr != *"warning"* ]]
    is_within "$(distance "level$level.ply" refined.glb hausdorff)" 1e-12
    [ "$("$papilio" info --json refined.glb | jq .detail)" = null ]
    ! grep -q PAPILIO_detail refined.glb
  done
  for kind in obj ply drc; do
    "$papilio" refine model.glb -o "refined.$kind" --levels "$levels" --output.position_bits 16
    [ "$("$papilio" info --json "refined.$kind" | jq .faces)" = "$(report '.levels[-1].faces')" ]
    is_within "$(distance "level$levels.ply" "refined.$kind" hausdorff)" 2e-5
  done
}

@test "a tolerance holds against the finest level of a packed model" {
  "$papilio" unpack model.glb -o fine.ply
  for tolerance in 0.01 0.005 0.002; do
    "$papilio" refine model.glb -o refined.glb --tolerance $tolerance --compress none
    is_within "$(distance fine.ply refined.glb hausdorff)" $tolerance
    is_within "$("$papilio" info --json refined.glb | jq .faces)" "$(report '.levels[-1].faces') - 1"
  done
}

@test "convert and compare use the finest level of a packed model" {
  "$papilio" unpack model.glb -o fine.ply
  for kind in obj ply; do
    run --separate-stderr "$papilio" convert model.glb "converted.$kind"
    [ "$stderr" = "" ]
    is_within "$(distance fine.ply "converted.$kind" hausdorff)" 1e-12
  done
  is_within "$(distance model.glb fine.ply hausdorff)" 1e-12
  run --separate-stderr "$papilio" convert model.glb copy.glb
  [ "$stderr" = "" ]
  cmp model.glb copy.glb
  "$papilio" convert model.glb apart.gltf
  "$papilio" unpack apart.gltf -o a.obj
  "$papilio" unpack model.glb -o b.obj
  cmp a.obj b.obj
}

@test "a packed model of another version is read as its base, with a warning" {
  sed 's/"version":3,/"version":7,/' model.glb >newer.glb
  run --separate-stderr "$papilio" refine newer.glb -o refined.glb --levels 1
  [ "$status" = 0 ]
  [[ $stderr == *"Only its base is used"* ]]
  [ "$("$papilio" info --json refined.glb | jq .faces)" = "$((4 * $(report .base.faces)))" ]
}

@test "the server refines packed models as the command line does, posted and stored" {
  levels=$(report '.levels | length')
  start_server
  for query in "levels=$levels&output.compress=none" 'tolerance=0.002' 'levels=3&view.error_pixels=1'; do
    request -H 'Content-Type: model/gltf-binary' --data-binary @model.glb "$url/v1/refine?$query"
    [ "$status" = 200 ]
    cp "$body" "sent.glb"
    ! grep -q PAPILIO_detail sent.glb
    request -H 'Content-Type: model/gltf-binary' --data-binary @model.glb "$url/v1/meshes"
    id=$(sha256sum <model.glb | cut -d' ' -f1)
    for _ in 1 2; do
      request "$url/v1/meshes/$id/refined?$query"
      [ "$status" = 200 ]
      cmp "$body" sent.glb
    done
  done
  "$papilio" refine model.glb -o local.glb --levels "$levels" --compress none
  "$papilio" refine model.glb -o remote.glb --levels "$levels" --compress none --server "$url"
  cmp local.glb remote.glb
  "$papilio" refine model.glb -o local.obj --levels "$levels"
  "$papilio" refine model.glb -o remote.obj --levels "$levels" --server "$url"
  cmp local.obj remote.obj
  request -H 'Accept: application/x-draco' "$url/v1/meshes/$id/refined?levels=$levels"
  [ "$status" = 200 ]
  cp "$body" stored.drc
  stop_server
  "$papilio" refine model.glb -o local.drc --levels "$levels"
  cmp local.drc stored.drc
}

@test "a small open surface becomes plain Draco, with a message" {
  printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 1 1 0' 'v 0 1 1' 'f 1 2 3' 'f 1 3 4' >open.obj
  run --separate-stderr "$papilio" pack open.obj -o open.glb --json
  [ "$status" = 0 ]
  [[ $stderr == *"plain Draco"* ]]
  [ "$(jq -r .format <<<"$output")" = draco ]
  [ "$("$papilio" info --json open.glb | jq -c '[.faces, .compression, .detail]')" = '[2,"draco",null]' ]
  is_within "$(distance open.obj open.glb rms)" 0.0001
  run --separate-stderr "$papilio" unpack open.glb -o out.obj
  [ "$status" = 0 ]
  [[ $output == "out.obj: 4 vertices, 2 faces, plain Draco without levels" ]]
  [ "$stderr" = "" ]
  is_within "$(distance open.glb out.obj hausdorff)" 1e-12
  "$papilio" unpack open.glb -o out.glb
  [ "$(attributes out.glb)" = '["NORMAL","POSITION"]' ]
  run --separate-stderr "$papilio" unpack open.glb -o out.obj --levels 2
  [[ $stderr == *"has no levels"* ]]
  "$papilio" pack open.obj -o open.glb >report.txt 2>/dev/null
  [[ $(cat report.txt) == *" bytes of plain Draco ("*" bits, RMS "*")" ]]
}

@test "unpack refuses a scene without a packed model" {
  "$papilio" convert "$fine" scene.glb
  run "$papilio" unpack scene.glb -o out.obj
  [ "$status" = 1 ]
  [[ $output == *"no packed model"* ]]
}

# bats test_tags=many_encodings
@test "no point is farther than --max, in either direction, with any number of jobs" {
  ball
  "$papilio" pack ball.obj -o far.glb --max 0.02 --json >far.json
  [ "$(jq -r .format far.json)" = packed ]
  is_within "$(jq .encodings far.json)" 7
  is_within "$(jq '.levels[-1].largest' far.json)" 0.02
  is_within 0.01 "$(jq '.levels[-1].largest' far.json)"
  "$papilio" unpack far.glb -o far.ply
  is_within "$(distance ball.obj far.ply hausdorff)" "1.1 * 0.02" # measured by other samples
  "$papilio" pack ball.obj -o several.glb --max 0.02 --jobs 5
  cmp far.glb several.glb
}

# bats test_tags=many_encodings
@test "plain Draco respects --max" {
  printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v .3 .7 .1' 'f 1 2 3' >open.obj
  "$papilio" pack open.obj -o open.glb --max 0.001 --json 2>/dev/null >open.json
  [ "$(jq -r .format open.json)" = draco ]
  is_within "$(distance open.obj open.glb hausdorff)" 0.001
  "$papilio" pack open.obj -o open.glb --bytes 1000 2>/dev/null
  is_within "$(stat -c %s open.glb)" 1000
}

# bats test_tags=many_encodings
@test "--bytes limits the size of a file" {
  ball
  "$papilio" pack ball.obj -o small.glb --bytes 1300 --json >small.json
  [ "$(jq -r .format small.json)" = packed ]
  is_within "$(stat -c %s small.glb)" 1300
  is_within 1000 "$(stat -c %s small.glb)"
  is_within "$(jq .encodings small.json)" 7
  run "$papilio" pack ball.obj -o none.glb --bytes 300
  [ "$status" = 1 ]
  [[ $output == *"smallest file found has "*" bytes, more than 300"* ]]
  [ ! -e none.glb ]
}

@test "data that a packed model cannot hold is reported" {
  printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'v 0 0 1' 'vn 0 0 1' 'f 1//1 3//1 2//1' 'f 1//1 2//1 4//1' \
    'f 2//1 3//1 4//1' 'f 3//1 1//1 4//1' >smooth.obj
  run --separate-stderr "$papilio" pack smooth.obj -o smooth.glb
  [ "$status" = 0 ]
  [ "$stderr" = "$(grep 'plain Draco' <<<"$stderr")" ] # nothing of normals
  printf '%s\n' ply 'format ascii 1.0' 'element vertex 3' 'property float x' 'property float y' 'property float z' \
    'property uchar red' 'property uchar green' 'property uchar blue' 'property uchar alpha' 'element face 1' \
    'property list uchar int vertex_indices' end_header '0 0 0 9 9 9 8' '1 0 0 9 9 9 8' '0 1 0 9 9 9 8' '3 0 1 2' >red.ply
  run --separate-stderr "$papilio" pack red.ply -o red.glb
  [ "$status" = 0 ]
  [[ $stderr == *"the opacity of its colours is left out"* ]]
  printf '%s\n' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'v 0 0 1' 's 1' 'f 1 2 3' 's 2' 'f 1 3 4' >group.obj
  run --separate-stderr "$papilio" pack group.obj -o group.glb
  [ "$status" = 0 ]
  [[ $stderr == *"smoothing groups are left out; edges are sharp by their angle"* ]]
  cat >scene.gltf <<'END'
{"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_variants"],
 "extensions": {"KHR_materials_variants": {"variants": [{"name": "red"}]}},
 "buffers": [{"byteLength": 36, "uri": "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 0}]}]}],
 "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]}
END
  run --separate-stderr "$papilio" pack scene.gltf -o packed.glb
  [ "$status" = 0 ]
  [[ $stderr == *"scene.gltf: the scene's morph targets are left out."* ]]
  [[ $stderr == *"scene.gltf: the scene's KHR_materials_variants is left out."* ]]
}

# textured_ball: writes a small surface with a texture whose charts meet at seams.
textured_ball() {
  printf '\x89PNG\r\n\x1a\n' >wood.png
  printf '%s\n' 'newmtl wood' 'Kd 0.8 0.6 0.4' 'map_Kd wood.png' >cube.mtl
  printf '%s\n' 'mtllib cube.mtl' 'v 0 0 0' 'v 1 0 0' 'v 1 1 0' 'v 0 1 0' 'v 0 0 1' 'v 1 0 1' 'v 1 1 1' 'v 0 1 1' \
    'vt 0 0' 'vt 1 0' 'vt 1 1' 'vt 0 1' 'usemtl wood' 'f 4/1 3/2 2/3 1/4' 'f 5/1 6/2 7/3 8/4' 'f 1/1 2/2 6/3 5/4' \
    'f 3/1 4/2 8/3 7/4' 'f 2/1 3/2 7/3 6/4' 'f 4/1 1/2 5/3 8/4' >cube.obj
  "$papilio" refine cube.obj -o ball.obj --levels 5 --tension off --output.normals true
}

@test "a textured model keeps its texture, as base and unpacked" {
  textured_ball
  run --separate-stderr "$papilio" pack ball.obj -o ball.glb --rms 0.001 --json
  [ "$status" = 0 ]
  [ "$stderr" = "" ]
  [ "$(jq -r .format <<<"$output")" = packed ]
  [ "$(jq .image_bytes <<<"$output")" = 8 ]
  "$papilio" info --json ball.glb >info.json
  [ "$(jq -c '[.materials, .images, .meshes[0].attributes, .detail.base.texcoords]' info.json)" = \
    '[1,1,["POSITION","TEXCOORD_0"],true]' ]
  [ "$(jq -r .base.normals <<<"$output")" = smooth ]
  for command in unpack convert; do
    if [ $command = unpack ]; then "$papilio" unpack ball.glb -o out.obj; else "$papilio" convert ball.glb out.obj; fi
    is_within "$(distance ball.obj out.obj rms)" 0.0011
    grep -qx 'usemtl wood' out.obj
    grep -q '^vt ' out.obj
    grep -q '^vn ' out.obj
    image=$(sed -n 's/^map_Kd //p' out.mtl)
    cmp "$image" wood.png
    mv out.obj $command.obj
  done
  cmp unpack.obj convert.obj
  "$papilio" unpack ball.glb -o out.glb
  [ "$("$papilio" info --json out.glb | jq -c '[.materials, .images, .meshes[0].attributes]')" = \
    '[1,1,["NORMAL","POSITION","TEXCOORD_0"]]' ]
  # All levels by refine, as a scene and as a mesh.
  levels=$("$papilio" info --json ball.glb | jq '.detail.levels | length')
  "$papilio" refine ball.glb -o refined.glb --levels "$levels" --compress none
  "$papilio" convert refined.glb refined.obj
  for file in unpack.obj refined.obj; do grep '^vt ' $file | sort -u | head -c 100000 >$file.vt; done
  cmp unpack.obj.vt refined.obj.vt
  [ "$(attributes refined.glb)" = '["NORMAL","POSITION","TEXCOORD_0"]' ]
  "$papilio" refine ball.glb -o mesh.obj --levels "$levels"
  grep -q '^vn ' mesh.obj
  grep -qx 'usemtl wood' mesh.obj
  [ "$(grep -c '^f ' mesh.obj)" = "$(grep -c '^f ' unpack.obj)" ]
  cmp "$(sed -n 's/^map_Kd //p' mesh.mtl)" wood.png
}

@test "a coloured scan keeps its colours" {
  "$papilio" convert "$fine" plain.obj
  awk '/^v /{ printf "v %s %s %s\n", $2, $3, $4; next } /^f /' plain.obj >bare.obj
  n=$(grep -c '^v ' bare.obj)
  m=$(grep -c '^f ' bare.obj)
  { # red along y, from 0 to 255
    printf '%s\n' ply 'format ascii 1.0' "element vertex $n" 'property float x' 'property float y' 'property float z' \
      'property uchar red' 'property uchar green' 'property uchar blue' "element face $m" \
      'property list uchar int vertex_indices' end_header
    awk 'NR == FNR { if ($1 == "v") { if ($3 < low || !seen) low = $3; if ($3 > high || !seen) high = $3; seen = 1 } next }
      $1 == "v" { print $2, $3, $4, int(255 * ($3 - low) / (high - low)), 40, 200 }
      $1 == "f" { split($2, a, "/"); split($3, b, "/"); split($4, c, "/"); print 3, a[1] - 1, b[1] - 1, c[1] - 1 }' bare.obj bare.obj
  } >scan.ply
  run --separate-stderr "$papilio" pack scan.ply -o scan.glb --rms 0.003 --no-simplify --json
  [ "$status" = 0 ]
  [ "$stderr" = "" ]
  [ "$(jq -c '[.format, .base.colours]' <<<"$output")" = '["packed",true]' ]
  [ "$(attributes scan.glb)" = '["COLOR_0","POSITION"]' ]
  "$papilio" unpack scan.glb -o out.glb --normals false
  [ "$(attributes out.glb)" = '["COLOR_0","POSITION"]' ]
  "$papilio" unpack scan.glb -o out.ply
  grep -aq '^property uchar blue' out.ply
  is_within "$(distance scan.ply out.ply rms)" 0.0033
}

# faces_of FILE MATERIAL: prints the number of faces of an .obj file with the material.
faces_of() { awk -v name="$2" '$1 == "usemtl" { material = $2 } $1 == "f" && material == name' "$1" | wc -l; }
# two_materials: writes a cube of wood at its ends and steel around it, and a speck of wood that a coarse grid drops.
two_materials() {
  printf '%s\n' 'newmtl wood' 'Kd 0.8 0.6 0.4' 'newmtl steel' 'Kd 0.5 0.5 0.5' >two.mtl
  printf '%s\n' 'mtllib two.mtl' 'v 0 0 0' 'v 1 0 0' 'v 1 1 0' 'v 0 1 0' 'v 0 0 1' 'v 1 0 1' 'v 1 1 1' 'v 0 1 1' \
    'v 0.3 0.3 0.3' 'v 0.30001 0.3 0.3' 'v 0.3 0.30001 0.3' 'v 0.3 0.3 0.30001' 'usemtl wood' ${1:+'f 9 11 10'} \
    ${1:+'f 9 10 12'} ${1:+'f 9 12 11'} ${1:+'f 10 11 12'} 'f 4 3 2 1' 'f 5 6 7 8' 'usemtl steel' 'f 1 2 6 5' \
    'f 3 4 8 7' 'f 2 3 7 6' 'f 4 1 5 8' >two.obj
}

@test "a model of several materials keeps them, as base, unpacked and refined" {
  two_materials
  "$papilio" refine two.obj -o ball.obj --levels 5 --tension off --shape plain
  run --separate-stderr "$papilio" pack ball.obj -o ball.glb --rms 0.002 --json
  [ "$status" = 0 ]
  [ "$stderr" = "" ]
  [ "$(jq -r .format <<<"$output")" = packed ]
  [ "$("$papilio" info --json ball.glb | jq -c '[.materials, .meshes[0].primitives]')" = '[2,2]' ]
  "$papilio" unpack ball.glb -o out.obj
  "$papilio" convert ball.glb convert.obj
  "$papilio" refine ball.glb -o refine.obj --levels 1
  "$papilio" refine ball.glb -o refine.glb --levels 1
  "$papilio" convert refine.glb scene.obj
  for file in out convert refine scene; do
    is_within "$(distance ball.obj $file.obj rms)" 0.01
    steel=$(faces_of $file.obj steel)
    wood=$(faces_of $file.obj wood)
    [ $((steel + wood)) = "$(grep -c '^f ' $file.obj)" ]
    is_within "1.7 * $wood" "$steel" # twice as many, about
    is_within "$steel" "2.3 * $wood"
  done
}

@test "a plain file of several materials keeps them when faces are removed" {
  two_materials and-a-crumb
  "$papilio" pack two.obj -o two.glb --rms 0.01 2>/dev/null
  [ "$("$papilio" info --json two.glb | jq -c '[.materials, .detail]')" = '[2,null]' ]
  "$papilio" unpack two.glb -o out.glb # with normals, for which degenerate faces go
  "$papilio" convert out.glb out.obj
  [ "$(faces_of out.obj steel)" = 8 ]
  [ "$(faces_of out.obj wood)" = 4 ]
}

@test "a signal ends a search and leaves no file" {
  "$papilio" pack "$fine" -o searched.glb --max 0.001 --jobs 2 >out.txt 2>&1 &
  pid=$!
  sleep 0.7
  kill -TERM "$pid"
  status=0
  wait "$pid" || status=$?
  [ "$status" = 1 ]
  [[ $(cat out.txt) == *cancelled* ]]
  [ "$(find . -name '*searched.glb*')" = "" ]
}

@test "a signal ends packing and leaves no file" {
  "$papilio" pack "$PAPILIO_MESHES/elephant20k.drc" -o large.glb >out.txt 2>&1 &
  pid=$!
  sleep 0.7
  kill -TERM "$pid"
  status=0
  wait "$pid" || status=$?
  [ "$status" = 1 ]
  [[ $(cat out.txt) == *cancelled* ]]
  [ "$(find . -name '*large.glb*')" = "" ]
}

@test "usage errors and bad files have different statuses" {
  run "$papilio" pack "$fine" -o out.obj
  [ "$status" = 2 ]
  [[ $output == *".glb"* ]]
  for rms in 0 1 -0.1 nan; do
    run "$papilio" pack "$fine" -o out.glb --rms="$rms"
    [ "$status" = 2 ]
  done
  for largest in 0 2 -0.1 nan; do
    run "$papilio" pack "$fine" -o out.glb --max="$largest"
    [ "$status" = 2 ]
  done
  for bytes in 0 -5 many; do
    run "$papilio" pack "$fine" -o out.glb --bytes="$bytes"
    [ "$status" = 2 ]
  done
  for goals in '--rms 0.001 --max 0.01' '--rms 0.001 --bytes 1000' '--max 0.01 --bytes 1000'; do
    # shellcheck disable=SC2086
    run "$papilio" pack "$fine" -o out.glb $goals
    [ "$status" = 2 ]
    [[ $output == *"Give one"* ]]
  done
  run "$papilio" pack "$fine" -o out.glb --max 0.01 --jobs 0
  [ "$status" = 2 ]
  run "$papilio" unpack model.glb -o out.obj --levels 11
  [ "$status" = 2 ]
  run --separate-stderr "$papilio" unpack model.glb -o out.obj --levels 10
  [ "$status" = 0 ]
  [[ $stderr == *"has $(report '.levels | length') levels"* ]]
  sed 's/"version":3,/"version":7,/' model.glb >newer.glb
  run "$papilio" unpack newer.glb -o out.obj
  [ "$status" = 1 ]
  [[ $output == *"PAPILIO_detail has version 7"* ]]
  [[ $("$papilio" info newer.glb) == *"detail.fault"*"version 7"* ]]
}

@test "the in-place scheme is refused for packed models, with and without a criterion" {
  start_server
  for criterion in levels=2 tolerance=0.01 flatness=0.9; do
    run -2 "$papilio" refine model.glb -o out.glb --scheme in-place "--$criterion"
    [[ $output == *"The in-place scheme does not refine a packed model"*"Use the red-green scheme."* ]]
    [ ! -e out.glb ]
    request -H 'Content-Type: model/gltf-binary' --data-binary @model.glb "$url/v1/refine?scheme=in-place&$criterion"
    [ "$status" = 400 ]
    [ "$(field code)" = bad_parameter ]
    [ "$(field parameter)" = scheme ]
  done
  stop_server
}
