#!/usr/bin/env bats
# glTF scenes: the command line and the server.

bats_require_minimum_version 1.5.0
load helpers

scene='Content-Type: model/gltf-binary'

setup_file() { start_server; }
teardown_file() { stop_server; }
teardown() { [[ -z ${stub_pid:-} ]] || kill "$stub_pid"; }
setup() {
  cd "$BATS_TEST_TMPDIR" || return
  "$papilio" convert "$coarse" in.glb
}

# two_nodes: writes a scene that shows the mesh of in.glb twice, as two.gltf with two.bin.
two_nodes() {
  "$papilio" convert in.glb two.gltf
  jq '.nodes += [{mesh: 0, translation: [0, 50, 0], extras: "kept"}] | .scenes[0].nodes = [0, 1]' two.gltf >edited.gltf
  mv edited.gltf two.gltf
}

@test "a scene is refined to the same bytes locally and remotely" {
  for flags in '--levels 2' '--tolerance 0.001' '--levels 2 --compress draco' '--levels 1 --compress meshopt'; do
    # shellcheck disable=SC2086
    "$papilio" refine in.glb -o here.glb $flags
    # shellcheck disable=SC2086
    "$papilio" refine in.glb -o there.glb --server "$url" $flags
    cmp here.glb there.glb
  done
  "$papilio" refine in.glb -o here.glb --levels 2
  [ "$("$papilio" info --json here.glb | jq .faces)" = 9600 ]
}

@test "a scene has the surface of its mesh as Draco" {
  "$papilio" refine in.glb -o fine.glb --levels 2
  "$papilio" refine "$coarse" -o fine.drc --levels 2 --output.position_bits 16
  [ "$("$papilio" compare --json fine.glb fine.drc | jq '.hausdorff / .diagonal < 0.0001')" = true ]
}

@test ".gltf files are read with their files, and written with one" {
  two_nodes
  "$papilio" refine two.gltf -o fine.gltf --levels 1
  [ -s fine.bin ]
  [ "$(jq -r '.nodes[1].extras' fine.gltf)" = kept ]
  [ "$(jq -r '.buffers[0].uri' fine.gltf)" = fine.bin ]
  [ "$("$papilio" info --json fine.gltf | jq -c '[.faces, .nodes, .meshes[0].nodes]')" = '[2400,2,2]' ]
  [ "$("$papilio" convert fine.gltf both.ply && "$papilio" info --json both.ply | jq .faces)" = 4800 ]
}

@test "a .gltf file without its images is refined, with a warning" {
  two_nodes
  jq '.images = [{uri: "lost.png", extras: "kept"}, {uri: "http://127.0.0.1:1/far.png"}]' two.gltf >edited.gltf
  mkdir out
  run --separate-stderr "$papilio" refine edited.gltf -o out/fine.gltf --levels 1 --json
  [ "$status" = 0 ]
  [[ ${stderr_lines[0]} == 'warning: lost.png: cannot be opened:'*'. The image keeps its URI' ]]
  [[ ${stderr_lines[1]} == 'warning: edited.gltf: names "http://127.0.0.1:1/far.png", which is not in its folder'* ]]
  [ "$(jq -c .images out/fine.gltf)" = '[{"uri":"lost.png","extras":"kept"},{"uri":"http://127.0.0.1:1/far.png"}]' ]
  run --separate-stderr "$papilio" convert edited.gltf out/flat.ply
  [ "$status" = 0 ]
  [ -z "$stderr" ]
}

@test "scenes convert to and from meshes" {
  for kind in drc obj ply off stl; do
    "$papilio" convert in.glb "out.$kind"
    "$papilio" convert "out.$kind" back.glb
    [ "$("$papilio" info --json back.glb | jq .faces)" = 600 ]
  done
}

# cube: writes an OBJ file with two materials in smoothing groups, its library and two images: one pixel, and a format
# that glTF lacks.
cube() {
  base64 -d >wood.png <<'END'
iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg==
END
  printf 'BM' >old.bmp
  printf '%s\n' 'newmtl wood' 'Kd 0.8 0.6 0.4' 'map_Kd -s 1 1 1 .\wood.png' 'newmtl pale metal' 'Pm 1' 'Pr 0.25' >cube.mtl
  printf '%s\n' 'mtllib cube.mtl' 'v 0 0 0' 'v 1 0 0' 'v 1 1 0' 'v 0 1 0' 'v 0 0 1' 'v 1 0 1' 'v 1 1 1' 'v 0 1 1' \
    'vt 0 0' 'vt 1 0' 'vt 1 1' 'vt 0 1' 'usemtl wood' 's 1' 'f 4/1 3/2 2/3 1/4' 'f 5/1 6/2 7/3 8/4' \
    'usemtl pale metal' 's 2' 'f 1/1 2/2 6/3 5/4' 'f 2/1 3/2 7/3 6/4' 'f 3/1 4/2 8/3 7/4' 'f 4/1 1/2 5/3 8/4' >cube.obj
}

# json_of SCENE: prints its document.
json_of() {
  "$papilio" convert "$1" "$BATS_TEST_TMPDIR/document.gltf"
  cat "$BATS_TEST_TMPDIR/document.gltf"
}

@test "materials of an .obj file are converted to a scene's, and back" {
  cube
  run --separate-stderr "$papilio" convert cube.obj cube.glb
  [ "$status" = 0 ]
  [ -z "$stderr" ]
  [ "$(json_of cube.glb | jq -c '[.materials[].name, .meshes[0].primitives[].material]')" = '["wood","pale metal",0,1]' ]
  [ "$(json_of cube.glb | jq -c '[.images[0].mimeType, (.images | length)]')" = '["image/png",1]' ]
  mkdir back
  "$papilio" convert cube.glb back/new.obj
  [ "$(cd back && echo *)" = 'new.mtl new.obj new_wood.png' ]
  cmp wood.png back/new_wood.png
  grep -qx 'mtllib new.mtl' back/new.obj
  [ "$(grep ^usemtl back/new.obj | paste -sd,)" = 'usemtl wood,usemtl pale metal' ]
  grep -qx 'Kd 0.8 0.6 0.4' back/new.mtl
  grep -qx 'map_Kd new_wood.png' back/new.mtl
  "$papilio" convert back/new.obj again.glb
  [ "$(json_of again.glb | jq -c .materials)" = "$(json_of cube.glb | jq -c .materials)" ]
  "$papilio" convert cube.obj cube.gltf
  [ "$(jq '.materials | length' cube.gltf)" = 2 ]
}

# leaf: writes a scene with all that .mtl files lack in its material, of which a second one is unused.
leaf() {
  cube
  printf '\xff\xd8\xff dark' >dark.jpg
  "$papilio" refine cube.obj -o ball.obj --levels "$1" --tension off
  "$papilio" convert ball.obj plain.gltf
  jq '.materials = [.materials[1], {name: "leaf", alphaMode: "MASK", alphaCutoff: 0.25, doubleSided: true,
      pbrMetallicRoughness: {baseColorTexture: {index: 1}}, occlusionTexture: {index: 0, strength: 0.5}, extras: {index: 3},
      emissiveTexture: {index: 1, texCoord: 1}, extensions: {KHR_materials_clearcoat: {clearcoatTexture: {index: 1}}}}]
    | .textures = [{source: 1, sampler: 1}, {source: 0, sampler: 1}] | .images += [{uri: "dark.jpg"}]
    | .samplers = [{}, {magFilter: 9728, wrapS: 33071, wrapT: 33071}]
    | .extensionsUsed = ["KHR_materials_clearcoat"] | .meshes[0].primitives[].material = 1' plain.gltf >leaf.gltf
}

@test "packed scenes and their plain Draco keep materials, textures and samplers as they are" {
  for levels in 0 5; do
    leaf $levels
    run --separate-stderr "$papilio" pack leaf.gltf -o leaf.glb --rms 0.002 --no-simplify --json
    [ "$status" = 0 ]
    [ "$(jq -r .format <<<"$output")" = "$([ $levels = 0 ] && echo draco || echo packed)" ]
    [ "${stderr_lines[0]}" = 'warning: leaf.gltf: smoothing groups are left out; edges are sharp by their angle.' ]
    [ "${stderr_lines[1]}" = 'warning: leaf.gltf: emissiveTexture of the material "leaf" is left out: it uses TEXCOORD_1, and only TEXCOORD_0 is kept, which its other textures use.' ]
    "$papilio" unpack leaf.glb -o unpacked.glb
    for file in leaf unpacked; do
      [ "$(json_of $file.glb | jq -Sc .materials)" = "$(jq -Sc '[.materials[1] | del(.emissiveTexture)
        | .pbrMetallicRoughness.baseColorTexture.index = 0 | .occlusionTexture.index = 1
        | .extensions[].clearcoatTexture.index = 0]' leaf.gltf)" ]
      [ "$(json_of $file.glb | jq -Sc '[.samplers, .textures]')" = \
        '[[{"magFilter":9728,"wrapS":33071,"wrapT":33071}],[{"sampler":0,"source":0},{"sampler":0,"source":1}]]' ]
      [ "$(json_of $file.glb | jq -c '[.images[].mimeType, any(.extensionsUsed[]; . == "KHR_materials_clearcoat")]')" = \
        '["image/png","image/jpeg",true]' ]
    done
    mkdir out$levels
    "$papilio" unpack leaf.glb -o out$levels/leaf.obj
    [ "$(cd out$levels && echo *.* | wc -w)" = 3 ] # the image that .mtl has a keyword for
    cmp wood.png out$levels/*.png
  done
}

@test "missing parts of materials are reported and dropped" {
  cube
  rm wood.png
  run --separate-stderr "$papilio" convert cube.obj cube.glb
  [ "$status" = 0 ]
  [ "$stderr" = 'warning: cube.mtl: names the image "./wood.png", which is not there; it is left out' ]
  [ "$(json_of cube.glb | jq -c '[.materials[].name, .images]')" = '["wood","pale metal",null]' ]
  sed -i 's/wood.png/old.bmp/' cube.mtl
  run --separate-stderr "$papilio" convert cube.obj cube.glb
  [[ $stderr == 'warning: old.bmp: is neither a PNG nor a JPEG image'* ]]
  rm cube.mtl
  run --separate-stderr "$papilio" convert cube.obj cube.glb
  [ "$status" = 0 ]
  [ "$stderr" = 'warning: cube.obj: names the material library "cube.mtl", which is not there; it is left out' ]
  [ "$(json_of cube.glb | jq .materials)" = null ]
  printf 'newmtl wood\nKd red\n' >cube.mtl
  run "$papilio" convert cube.obj cube.glb
  [ "$status" = 1 ]
  [[ $output == *'cube.mtl: line 2: expected a finite number'* ]]
}

@test "refinement keeps materials between .obj files and scenes, with the same bytes locally and remotely" {
  cube
  "$papilio" refine cube.obj -o here.glb --levels 2
  "$papilio" refine cube.obj -o there.glb --levels 2 --server "$url"
  cmp here.glb there.glb
  [ "$(json_of here.glb | jq -c '[.materials[].name, .images[0].mimeType]')" = '["wood","pale metal","image/png"]' ]
  [ "$("$papilio" info --json here.glb | jq -c '[.faces, .meshes[0].primitives]')" = '[192,2]' ]
  [ "$("$papilio" convert here.glb flat.ply && "$papilio" info --json flat.ply | jq .closed)" = true ]
  # Smoothing groups are creases: without them the cube would have another shape.
  sed '/^s /d' cube.obj >smooth.obj
  "$papilio" refine cube.obj -o groups.glb --levels 2 --shape organic
  "$papilio" refine smooth.obj -o smooth.glb --levels 2 --shape organic
  [ "$("$papilio" compare --json groups.glb smooth.glb | jq '.hausdorff > 0.01')" = true ]
  "$papilio" convert cube.obj cube.glb
  mkdir out
  "$papilio" refine cube.glb -o out/fine.obj --levels 1
  [ "$(cd out && echo *)" = 'fine.mtl fine.obj fine_wood.png' ]
  [ "$(grep -c ^usemtl out/fine.obj)" = 2 ]
  "$papilio" refine cube.obj -o out/again.obj --levels 1
  [ -s out/again_wood.png ]
}

@test "standard streams have no materials" {
  cube
  "$papilio" convert cube.obj cube.glb
  "$papilio" convert cube.glb - --to obj >out.obj
  run ! grep -q mtl out.obj
  [ ! -e out.mtl ]
  run --separate-stderr "$papilio" convert - out.glb --from obj <cube.obj
  [ "$status" = 0 ]
  [[ $stderr == *'name the .obj file instead of -'* ]]
  "$papilio" convert in.glb plain.obj
  [ ! -e plain.mtl ]
}

@test "a scene on standard input stays a scene on standard output" {
  "$papilio" refine in.glb -o fine.glb --levels 1
  "$papilio" refine - -o - --levels 1 <in.glb 2>messages | cmp - fine.glb
  "$papilio" refine in.glb -o - --levels 1 --to drc 2>messages | head -c 5 | grep -qx DRACO
}

@test "a folder's scenes stay scenes" {
  mkdir models
  cp in.glb models/a.glb
  "$papilio" convert in.glb models/b.obj
  "$papilio" refine models -o refined --levels 1
  [ "$(cd refined && echo *)" = 'a.glb b.drc' ]
  "$papilio" refine models -o all --levels 1 --to glb
  [ "$(cd all && echo *)" = 'a.glb b.glb' ]
}

@test "files outside of the folder are refused, and so is .gltf on standard output" {
  two_nodes
  jq '.buffers[0].uri = "../two.bin"' two.gltf >outside.gltf
  run "$papilio" refine outside.gltf -o out.glb
  [ "$status" = 1 ]
  [[ $output == *'not in its folder'* ]]
  run "$papilio" refine in.glb -o - --to gltf
  [ "$status" = 2 ]
}

@test "the server answers in the request's format, or as Accept says" {
  request -H "$scene" --data-binary @in.glb "$url/v1/refine?levels=1"
  [ "$status" = 200 ]
  [ "$(header Content-Type)" = model/gltf-binary ]
  [ "$(header Papilio-Faces)" = 2400 ]
  [ "$(head -c 4 "$body")" = glTF ]
  request -H "$scene" -H 'Accept: application/x-draco' --data-binary @in.glb "$url/v1/refine?levels=1"
  [ "$status" = 200 ]
  [ "$(head -c 5 "$body")" = DRACO ]
  request -H "$draco" -H 'Accept: model/gltf-binary' --data-binary @"$coarse" "$url/v1/refine?levels=1"
  [ "$status" = 200 ]
  [ "$(head -c 4 "$body")" = glTF ]
  request -H 'Content-Type: application/octet-stream' --data-binary @in.glb "$url/v1/refine?levels=1"
  [ "$(header Content-Type)" = model/gltf-binary ]
  request -F mesh=@in.glb -F 'params={"levels": 1}' "$url/v1/refine"
  [ "$status" = 200 ]
  [ "$(header Papilio-Faces)" = 2400 ]
}

@test "Draco of a scene of several meshes is refused with the reason" {
  two_nodes
  "$papilio" convert two.gltf two.glb
  request -H "$scene" -H 'Accept: application/x-draco' --data-binary @two.glb "$url/v1/refine"
  expect_problem 406 not_acceptable
}

# glb_parts BODY: prints the number of parts that are scenes.
glb_parts() { grep -ac '^Content-Type: model/gltf-binary' "$1"; }

@test "the levels of a scene arrive separately, posted and stored, the last equal to the single answer" {
  two_nodes
  "$papilio" convert two.gltf two.glb
  "$papilio" refine two.glb -o fine.glb --levels 2
  request -H "$scene" -H 'Accept: multipart/mixed' --data-binary @two.glb "$url/v1/refine?levels=2"
  [ "$status" = 200 ]
  [ "$(glb_parts "$body")" = 3 ]
  grep -aq '"stop_reason": "levels"' "$body"
  python3 -c 'import sys; sys.exit(open("fine.glb", "rb").read() not in open(sys.argv[1], "rb").read())' "$body"
  id=$(curl -sS -H "$scene" --data-binary @two.glb "$url/v1/meshes" | jq -r .id)
  request -H 'Accept: multipart/mixed' "$url/v1/meshes/$id/refined?levels=2"
  [ "$status" = 200 ]
  [ "$(glb_parts "$body")" = 3 ]
  python3 -c 'import sys; sys.exit(open("fine.glb", "rb").read() not in open(sys.argv[1], "rb").read())' "$body"
  request -X DELETE "$url/v1/meshes/$id"
  [ "$status" = 204 ]
}

@test "nodes that share a mesh get their own on request" {
  two_nodes
  jq '.nodes[1].scale = [0.001, 0.001, 0.001]' two.gltf >edited.gltf
  mv edited.gltf two.gltf
  "$papilio" refine two.gltf -o together.glb --tolerance 0.001
  "$papilio" refine two.gltf -o apart.glb --tolerance 0.001 --split-instances true
  [ "$("$papilio" info --json together.glb | jq -c '.meshes | length')" = 1 ]
  [ "$("$papilio" info --json apart.glb | jq -c '[(.meshes | length), .meshes[1].faces]')" = '[2,600]' ]
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?split_instances=true"
  expect_problem 400 bad_parameter
}

@test "a stored scene is described, refined, cached and deleted like a mesh" {
  two_nodes
  "$papilio" convert two.gltf two.glb
  id=$(sha256sum two.glb | cut -d' ' -f1)
  request -H "$scene" --data-binary @two.glb "$url/v1/meshes"
  [ "$status" = 201 ]
  [ "$(header Location)" = "/v1/meshes/$id" ]
  [ "$(jq -c '[.id, .faces, .nodes, .meshes[0].nodes]' "$body")" = "[\"$id\",600,2,2]" ]
  request "$url/v1/meshes/$id"
  [ "$(header Content-Type)" = model/gltf-binary ]
  cmp "$body" two.glb
  request -H 'Accept: application/json' "$url/v1/meshes/$id"
  [ "$(field faces)" = 600 ]
  request "$url/v1/meshes/$id/refined?levels=1"
  [ "$status" = 200 ]
  [ "$(header Papilio-Faces)" = 2400 ]
  "$papilio" refine two.glb -o fine.glb --levels 1
  cmp "$body" fine.glb
  tag=$(header ETag)
  request -H "If-None-Match: $tag" "$url/v1/meshes/$id/refined?levels=1"
  [ "$status" = 304 ]
  request -H 'Content-Type: application/json' -d '{"levels": 1}' "$url/v1/meshes/$id/refined"
  cmp "$body" fine.glb
  request -X DELETE "$url/v1/meshes/$id"
  [ "$status" = 204 ]
  request "$url/v1/meshes/$id/refined"
  expect_problem 404 mesh_not_found
}

@test "stored scenes and meshes are answered in the format that Accept says" {
  id=$(curl -sS -H "$scene" --data-binary @in.glb "$url/v1/meshes" | jq -r .id)
  request "$url/v1/meshes/$id/refined?levels=1"
  tag=$(header ETag)
  for _ in made kept; do
    request -H 'Accept: application/x-draco' "$url/v1/meshes/$id/refined?levels=1"
    [ "$(header Content-Type)" = application/x-draco ]
    [ "$(header Vary)" = Accept ]
    [ "$(header ETag)" != "$tag" ]
    [ "$(decoded_faces "$body")" = 2400 ]
  done
  cp "$body" stored.drc
  request -H "$scene" -H 'Accept: application/x-draco' --data-binary @in.glb "$url/v1/refine?levels=1"
  cmp "$body" stored.drc
  tag=$(curl -sS -o again -D - -H 'Accept: application/x-draco' "$url/v1/meshes/$id/refined?levels=1" | tr -d '\r' |
    sed -n 's/^ETag: //p')
  request -H 'Accept: application/x-draco' -H "If-None-Match: $tag" "$url/v1/meshes/$id/refined?levels=1"
  [ "$status" = 304 ]
  request -X DELETE "$url/v1/meshes/$id"

  two_nodes
  "$papilio" convert two.gltf two.glb
  id=$(curl -sS -H "$scene" --data-binary @two.glb "$url/v1/meshes" | jq -r .id)
  request -H 'Accept: application/x-draco' "$url/v1/meshes/$id/refined?levels=1"
  expect_problem 406 not_acceptable
  [[ $(field detail) == 'The scene has several meshes'* ]]
  request -X DELETE "$url/v1/meshes/$id"

  upload
  request -H 'Accept: model/gltf-binary' "$url/v1/meshes/$(coarse_id)/refined?levels=1"
  [ "$(header Content-Type)" = model/gltf-binary ]
  cp "$body" stored.glb
  [ "$("$papilio" info --json stored.glb | jq .faces)" = 2400 ]
  request -H "$draco" -H 'Accept: model/gltf-binary' --data-binary @"$coarse" "$url/v1/refine?levels=1"
  cmp "$body" stored.glb
  request -X DELETE "$url/v1/meshes/$(coarse_id)"
}

@test "the server fetches no external file of a scene" {
  python3 "$BATS_TEST_DIRNAME/../support/stub_server.py" >port 3>&- &
  stub_pid=$!
  eventually test -s port
  far=http://127.0.0.1:$(cat port)/far
  two_nodes
  jq --arg far "$far" '.images = [{uri: $far}] | .textures = [{source: 0}] |
    .materials = [{pbrMetallicRoughness: {baseColorTexture: {index: 0}}}] | .meshes[0].primitives[0].material = 0' two.gltf >image.gltf
  "$papilio" convert image.gltf image.glb
  id=$(curl -sS -H "$scene" --data-binary @image.glb "$url/v1/meshes" | jq -r .id)
  request -H 'Accept: application/json' "$url/v1/meshes/$id"
  [ "$(field images)" = 1 ]
  request "$url/v1/meshes/$id/refined?levels=1"
  [ "$status" = 200 ]
  grep -aqF "\"uri\":\"$far\"" "$body"
  request -X DELETE "$url/v1/meshes/$id"
  request -H "$scene" --data-binary @image.glb "$url/v1/refine?levels=1&output.compress=none"
  [ "$status" = 200 ]
  jq --arg far "$far" '.buffers[0].uri = $far' two.gltf >buffer.gltf
  request -H "$scene" --data-binary @buffer.gltf "$url/v1/refine?levels=1"
  expect_problem 422 mesh_unsupported
  request "$far"
  [ "$(header Count)" = 0 ]
}

@test "bodies that are no scenes, or refer to files, are refused by name" {
  request -H "$scene" --data-binary 'glTF of a kind' "$url/v1/refine"
  expect_problem 422 mesh_not_gltf
  request -H "$scene" --data-binary '{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": "http://127.0.0.1:1/a.bin"}]}' "$url/v1/refine"
  expect_problem 422 mesh_unsupported
  [[ $(field detail) == *'not fetched'* ]]
  head -c 1000 in.glb >cut.glb
  request -H "$scene" --data-binary @cut.glb "$url/v1/refine"
  expect_problem 422 mesh_not_gltf
  request -H "$scene" --data-binary @in.glb "$url/v1/refine?levels=10"
  expect_problem 507 result_too_large
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?output.compress=draco"
  expect_problem 400 bad_parameter
}

@test "the grid of Draco in a scene is as fine as the tolerance needs" {
  "$papilio" convert "$PAPILIO_MESHES/bunny600.obj" coarse.glb
  "$papilio" refine coarse.glb -o grid.glb --levels 0 --tolerance 0.0001 --output.compress draco
  [ "$("$papilio" compare --json coarse.glb grid.glb | jq '.hausdorff / .diagonal <= 0.0000125')" = true ]
}
