#!/usr/bin/env bats
# The command line: refine (local and remote), info, convert, compare.

load helpers

setup_file() { start_server; }
teardown_file() { stop_server; }
setup() { cd "$BATS_TEST_TMPDIR" || return; }
teardown() { [[ -z ${stub_pid:-} ]] || kill "$stub_pid"; }

# nan_mesh: writes an OBJ file with a NaN coordinate.
nan_mesh() { printf 'v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n'; }

@test "local and remote results have the same bytes, from each input format to each output format" {
  for kind in obj ply off stl drc; do "$papilio" convert "$coarse" "in.$kind"; done
  for kind in obj ply off stl drc; do
    for flags in '--levels 2' '--levels 2 --flatness 0.8,0.9' '--levels 3 --view.eye 0,5,30 --output.normals true'; do
      # shellcheck disable=SC2086
      "$papilio" refine "in.$kind" -o here.drc $flags
      # shellcheck disable=SC2086
      "$papilio" refine "in.$kind" -o there.drc --server "$url" $flags
      cmp here.drc there.drc
    done
    "$papilio" refine in.drc -o "here.$kind"
    "$papilio" refine in.drc -o "there.$kind" --server "$url"
    cmp "here.$kind" "there.$kind"
    [ "$("$papilio" info --json "here.$kind" | jq .faces)" = 9600 ]
  done
}

@test "texture coordinates and normals are kept, locally and remotely" {
  cat >square.obj <<'END'
v 0 0 0
v 1 0 0
v 1 1 0.5
v 0 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vt 0.1 1.7
vn 0 0 1
f 1/1/1 2/2/1 3/3/1
f 1/5/1 3/3/1 4/4/1
END
  for flags in '--levels 2' '--levels 2 --output.normals true' '--levels 2 --output.speed 0'; do
    # shellcheck disable=SC2086
    "$papilio" refine square.obj -o here.drc $flags
    # shellcheck disable=SC2086
    "$papilio" refine square.obj -o there.drc --server "$url" $flags
    cmp here.drc there.drc
    draco_decoder -i here.drc -o seen.obj
    # 25 vertices, and 4 more texture coordinates along the seam, which meets the other chart in one corner.
    [ "$(grep -c '^v ' seen.obj)" = 25 ]
    [ "$(grep -c '^vn ' seen.obj)" -gt 0 ]
  done
  "$papilio" refine square.obj -o fine.obj
  [ "$(grep -c '^v ' fine.obj)" = 25 ]
  [ "$(grep -c '^vt ' fine.obj)" = 29 ]
  [ "$(grep -c '^vn ' fine.obj)" -gt 1 ] # those of the bent surface, where the input had one
  [ "$(grep -Ec '^f [0-9]+/[0-9]+/[0-9]+ [0-9]+/[0-9]+/[0-9]+ [0-9]+/[0-9]+/[0-9]+$' fine.obj)" = 32 ]
  "$papilio" convert square.obj all.drc
  "$papilio" convert --exact square.obj exact.drc
  for name in all exact; do
    "$papilio" convert $name.drc back.obj
    [ "$(grep -c '^vt ' back.obj)" = 5 ]
  done
}

@test "a target out of reach of the levels is a warning, locally and remotely" {
  for where in '' "--server $url"; do
    # shellcheck disable=SC2086
    "$papilio" refine "$coarse" -o fine.drc --tolerance 0.0001 --levels 1 $where 2>warnings
    grep -q '^warning: tolerance=0.0001 is not reached: the remaining error is 0\.0.* Raise levels above 1' warnings
    # shellcheck disable=SC2086
    "$papilio" refine "$coarse" -o fine.drc --tolerance 0.0001 $where 2>warnings
    if grep warning warnings; then return 1; fi
  done
}

@test "curl receives the bytes of the command line" {
  "$papilio" refine "$coarse" -o here.drc --levels 2 --flatness 0.8,0.9
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=2&flatness=0.8,0.9"
  cmp here.drc "$body"
}

@test "results go to standard output only on request" {
  "$papilio" refine "$coarse" -o - --levels 1 2>messages >out.drc
  [ "$(decoded_faces out.drc)" = 2400 ]
  "$papilio" refine "$coarse" -o file.drc --levels 1 2>messages >out
  [ ! -s out ]
  grep -q '2400 faces' messages
  cmp file.drc out.drc
  [ "$("$papilio" refine "$coarse" -o file.drc --levels 1 --json | jq .faces)" = 2400 ]
}

@test "a folder has all its meshes refined under their names, and failures are reported by name" {
  mkdir -p models/deep
  "$papilio" convert "$coarse" models/a.obj
  "$papilio" convert "$coarse" models/deep/b.ply
  echo 'not a mesh' >models/readme.txt
  "$papilio" refine models -o refined --levels 1 --jobs 2
  [ "$("$papilio" info --json refined/a.drc | jq .faces)" = 2400 ]
  [ "$("$papilio" info --json refined/deep/b.drc | jq .faces)" = 2400 ]
  echo 'rubbish' >models/c.off
  run "$papilio" refine models -o again --to off --server "$url"
  [ "$status" = 1 ]
  [[ $output == *c.off* ]]
  [ -s again/a.off ]
  [ ! -e again/c.off ]
  before=$(md5sum models/*.*)
  for inside in models models/refined; do
    run "$papilio" refine models -o "$inside"
    [ "$status" = 2 ]
    [[ $output == *'outside of it'* ]]
  done
  [ "$(md5sum models/*.*)" = "$before" ]
  [ ! -e models/refined ]
  cp models/a.obj models/a.stl
  run "$papilio" refine models -o third
  [ "$status" = 2 ]
  [[ $output == *'would both become'* ]]
}

@test "info describes a mesh" {
  run "$papilio" info "$PAPILIO_MESHES/bunny600.obj"
  [ "$status" = 0 ]
  [[ $output == *'euler_characteristic    2'* ]]
  [ "$("$papilio" info --json "$coarse" | jq -c '[.vertices, .faces, .closed]')" = '[302,600,true]' ]
  [ "$("$papilio" info --json "$coarse" | jq -c .attributes)" = '["POSITION"]' ]
  printf 'v %s\n' '0 0 0' '1 0 0' '0 1 0' >textured.obj
  printf '%s\n' 'vt 0 0' 'vt 1 0' 'vt 0 1' 'vn 0 0 1' 'f 1/1/1 2/2/1 3/3/1' >>textured.obj
  [ "$("$papilio" info --json textured.obj | jq -c '.attributes | sort')" = '["NORMAL","POSITION","TEXCOORD_0"]' ]
}

@test "convert takes its output by position or by option" {
  "$papilio" convert "$coarse" place.ply
  "$papilio" convert "$coarse" -o name.ply
  cmp place.ply name.ply
  run "$papilio" convert "$coarse" one.ply -o other.ply
  [ "$status" = 2 ]
  [ ! -e one.ply ] && [ ! -e other.ply ]
}

@test "convert --exact keeps positions bit-identical" {
  "$papilio" convert --exact "$PAPILIO_MESHES/bunny600.obj" exact.drc
  "$papilio" convert exact.drc back.obj
  "$papilio" convert "$PAPILIO_MESHES/bunny600.obj" once.obj
  cmp <(grep '^v ' back.obj | sort) <(grep '^v ' once.obj | sort)
}

@test "smoothing groups of OBJ stay sharp and are written again, locally and remotely" {
  # A pyramid of five faces over a square: smooth sides in group 1, a base without a group.
  pyramid() { printf 'v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 0 0 0.5\n%bf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n%bf 4 3 2 1\n' "$@"; }
  pyramid 's 1\n' 's off\n' >groups.obj
  pyramid 's 1\n' '' >one.obj
  pyramid 's off\n' '' >off.obj
  [ "$("$papilio" info --json groups.obj | jq .marked_creases)" = 4 ]
  [ "$("$papilio" info --json one.obj | jq .marked_creases)" = 0 ]
  [ "$("$papilio" info --json off.obj | jq .marked_creases)" = 0 ]
  [[ $("$papilio" info groups.obj) == *'4 marked by smoothing groups'* ]]
  "$papilio" refine groups.obj -o here.drc --levels 2 --shape organic
  "$papilio" refine groups.obj -o there.drc --levels 2 --shape organic --server "$url"
  cmp here.drc there.drc
  # The base stays planar, and its rim is the only crease of the result.
  "$papilio" refine groups.obj -o fine.obj --levels 2 --shape organic
  "$papilio" refine one.obj -o smooth.obj --levels 2 --shape organic
  ! cmp -s fine.obj smooth.obj
  [ "$(grep -c '^s ' fine.obj)" -ge 2 ]
  [ "$("$papilio" info --json fine.obj | jq '.marked_creases > 15')" = true ]
  # A scene has them, too, and gives them back.
  "$papilio" convert groups.obj groups.glb
  "$papilio" refine groups.glb -o fine.glb --levels 2 --shape organic
  [ "$("$papilio" compare --json fine.obj fine.glb | jq '.hausdorff < 1e-4')" = true ]
  [ "$("$papilio" compare --json smooth.obj fine.glb | jq '.hausdorff > 1e-2')" = true ]
  for compression in none draco meshopt; do
    "$papilio" refine groups.glb -o "$compression.glb" --levels 2 --shape organic --output.compress "$compression"
    "$papilio" convert "$compression.glb" "$compression.obj"
    [ "$("$papilio" info --json "$compression.obj" | jq .marked_creases)" = 16 ]
  done
}

@test "concave polygons are triangulated inside, without folds" {
  cat >plate.obj <<'END'
v 0 0 0
v 4 0 0
v 4 4 0
v 3 4 0
v 3 1 0
v 1 1 0
v 1 4 0
v 0 4 0
f 5 6 7 8 1 2 3 4
END
  "$papilio" refine plate.obj -o fine.obj --levels 3
  # Signed area of all faces (shoelace formula): the area of a U, with no inverted face.
  awk '$1 == "v" { x[++n] = $2; y[n] = $3 }
    $1 == "f" { split($2, a, "/"); split($3, b, "/"); split($4, c, "/"); i = a[1]; j = b[1]; k = c[1]
      s = ((x[j] - x[i]) * (y[k] - y[i]) - (x[k] - x[i]) * (y[j] - y[i])) / 2; sum += s; if (s < 0) turned++ }
    END { print turned + 0, (sum > 9.9 && sum < 10.1) }' fine.obj >figures
  [ "$(cat figures)" = "0 1" ]
}

@test "compare measures distances" {
  "$papilio" refine "$coarse" -o fine.drc --levels 2
  "$papilio" compare --json fine.drc fine.drc | jq -e '.hausdorff < 1e-12 * .diagonal'
  run "$papilio" compare "$coarse" fine.drc
  [ "$status" = 0 ]
  [[ $output == *'Hausdorff'*'RMS'* ]]
  "$papilio" compare --json "$coarse" fine.drc | jq -e '.hausdorff > .rms and .rms > 0 and .rms < 0.05 * .diagonal'
}

@test "failures have status 1 or 2, a message, and no partial file" {
  run "$papilio" refine missing.obj -o out.drc
  [ "$status" = 1 ]
  [[ $output == *missing.obj* ]]
  long=$(printf 'x%.0s' {1..300}).obj
  for arguments in "$long -o out.drc" "$long" "$coarse -o $long" "$coarse -o $long/out.drc"; do
    # shellcheck disable=SC2086
    run "$papilio" refine $arguments
    [ "$status" = 1 ]
    [[ $output == "papilio: $long"*': cannot be '* ]]
  done
  run "$papilio" refine "$coarse" -o out.xyz
  [ "$status" = 2 ]
  [[ $output == *xyz* ]]
  run "$papilio" refine "$coarse" -o out.drc --levels 99
  [ "$status" = 2 ]
  [[ $output == *'levels must be an integer in 0..10'* ]]
  run "$papilio" refine "$coarse" -o out.drc --level 2
  [ "$status" = 2 ]
  run "$papilio" refine "$coarse" -o out.drc --server "${url%:*}:1"
  [ "$status" = 1 ]
  [[ $output == *'papilio-server running'* ]]
  run "$papilio" refine "$coarse" -o out.drc --server localhost
  [ "$status" = 2 ]
  [[ $output == *URL* ]]
  head -c 300 "$coarse" >short.drc
  for where in '' "--server $url"; do
    # shellcheck disable=SC2086
    run "$papilio" refine short.drc -o out.drc $where
    [ "$status" = 1 ]
    [[ $output == *'truncated'* ]]
  done
  [ ! -e out.drc ]
  for command in "info $coarse" parameters "refine $coarse -o fine.drc --json" "refine $coarse -o -"; do
    # shellcheck disable=SC2086
    ! "$papilio" $command >/dev/full
  done
  run "$papilio" refine "$coarse" -o absent/out.drc
  [ "$status" = 1 ]
  run "$papilio"
  [ "$status" = 2 ]
}

@test "any answer of a server leaves a complete mesh, or the previous output" {
  python3 "$BATS_TEST_DIRNAME/../support/stub_server.py" >port 3>&- &
  stub_pid=$!
  eventually test -s port
  stub=http://127.0.0.1:$(cat port)/raw
  local ok='HTTP/1.1 200 OK\r\n' type='Content-Type: application/x-draco\r\n'
  printf '%bContent-Type: text/html\r\nContent-Length: 5\r\n\r\nhello' "$ok" >html
  printf '%b%bContent-Length: 5\r\n\r\nhello' "$ok" "$type" >hello
  type+='Papilio-Faces: 600\r\n'
  { printf '%b%bContent-Length: %d\r\n\r\n' "$ok" "$type" "$(stat -c %s "$coarse")" && cat "$coarse"; } >whole
  head -c -100 whole >cut
  { printf '%b%b\r\n' "$ok" "$type" && head -c -100 "$coarse"; } >open_ended
  printf '%bContent-Type: \033[2Jtext\r\n\r\n' "$ok" >escape
  printf 'HTTP/1.1 500 No\r\n\r\n{"detail": "gone\\u001b[2J"}' >problem
  for answer in html hello cut open_ended escape problem; do
    for out in out.drc out.obj; do
      echo precious >$out
      run "$papilio" refine "$coarse" -o $out --server "$stub/$answer"
      [ "$status" = 1 ]
      [[ $output == papilio:* && $output != *$'\e'* ]]
      [ "$(cat $out)" = precious ]
    done
    run "$papilio" refine "$coarse" -o - --server "$stub/$answer"
    [[ $status == 1 && $output == papilio:* ]]
    run "$papilio" health --server "$stub/$answer"
    [[ $status == 1 && $output == papilio:* && $output != *$'\e'* ]]
  done
  [ -z "$(find . -name '*.tmp')" ]
  "$papilio" refine "$coarse" -o out.drc --server "$stub/whole"
  cmp out.drc "$coarse"
}

@test "flags may have hyphens, underscores or dots; a misspelt flag is answered with a suggestion" {
  "$papilio" refine "$coarse" -o a.drc --crease_angle 30 --view.edge_pixels=2 --view.eye=0,0,5
  "$papilio" refine "$coarse" -o b.drc --crease-angle 30 --view.edge-pixels=2 --view-eye 0,0,5
  cmp a.drc b.drc
  run "$papilio" refine "$coarse" -o c.drc --tolerence 0.1
  [ "$status" = 2 ]
  [ "$output" = 'papilio: papilio refine has no flag --tolerence. Did you mean --tolerance?' ]
  run "$papilio" refine --jsn
  [[ $status == 2 && $output == *'Did you mean --json?'* ]]
  run "$papilio" --verison
  [[ $status == 2 && $output == *'Did you mean --version?'* ]]
  run "$papilio" refine "$coarse" --jobs 0
  [[ $status == 2 && $output == 'papilio: --jobs: '*'papilio refine --help'* ]]
  run "$papilio" refin "$coarse"
  [[ $status == 2 && $output == *'Did you mean refine?'* ]]
  run "$papilio" refine "$coarse" more.drc -o c.drc
  [[ $status == 2 && $output == *'"more.drc" is not expected after papilio refine.'* ]]
  run "$papilio" refine "$coarse" -o c.drc --view.eye 1e19,0,0
  [[ $status == 2 && $output == *'at most 1e+18, not 1e+19'* ]]
  [ ! -e c.drc ]
}

@test "without -o the result is written beside the input, and replaces no file" {
  mkdir deep
  "$papilio" convert "$coarse" deep/in.OBJ
  "$papilio" refine deep/in.OBJ --levels 1
  [ "$("$papilio" info --json deep/in.refined.OBJ | jq .faces)" = 2400 ]
  run "$papilio" refine deep/in.OBJ
  [[ $status == 2 && $output == *'deep/in.refined.OBJ exists already'* ]]
  [ "$("$papilio" info --json deep/in.refined.OBJ | jq .faces)" = 2400 ]
  "$papilio" refine deep/in.OBJ --levels 1 --to ply
  [ "$("$papilio" info --json deep/in.refined.ply | jq .faces)" = 2400 ]
  run "$papilio" refine deep
  [[ $status == 2 && $output == *'-o FOLDER'* ]]
  run "$papilio" refine deep/in.OBJ -o deep
  [[ $status == 2 && $output == *'is a folder'* ]]
  run "$papilio" refine deep/in.OBJ -o out.obj --to ply
  [[ $status == 2 && $output == *'leave --to away'* ]]
}

@test "- is standard input, with its format detected, and standard output" {
  "$papilio" refine "$coarse" -o fine.drc --levels 1
  for kind in obj ply off stl drc; do
    "$papilio" convert "$coarse" in.$kind
    "$papilio" refine in.$kind -o fine.$kind --levels 1
    "$papilio" refine - -o - --to $kind --levels 1 <in.$kind 2>messages | cmp - fine.$kind
    "$papilio" refine - --from $kind --levels 1 <in.$kind 2>messages >out.drc
    [ "$(decoded_faces out.drc)" = 2400 ]
    [ "$("$papilio" info - --json <in.$kind | jq -c '[.file, .bytes, .faces]')" = \
      "[\"standard input\",$(stat -c %s in.$kind),600]" ]
    "$papilio" convert - - --to obj <in.$kind | "$papilio" compare --json - in.$kind | jq -e '.hausdorff < 1e-3'
  done
  grep -q '^-: .* 2400 faces' messages
  run "$papilio" info - </dev/null
  [[ $status == 1 && $output == *'standard input: is empty'* ]]
  run "$papilio" info - <<<'hello'
  [[ $status == 1 && $output == *'standard input: '*'--from'* ]]
  run "$papilio" refine . -o elsewhere --from obj
  [[ $status == 2 && $output == *--from* ]]
  run script -qec "'$papilio' refine '$coarse' -o -" /dev/null
  [[ $status == 2 && $output == *'standard output is a terminal'* ]]
}

@test "errors of a mesh name its file, once" {
  nan_mesh >nan.obj
  : >empty.drc
  echo hello >hello.drc
  "$papilio" convert --exact "$coarse" whole.drc
  head -c 300 whole.drc >short.drc
  for file in nan.obj empty.drc hello.drc short.drc; do
    for command in "refine $file -o out.drc" "refine $file -o out.drc --server $url" "info $file" \
      "convert $file out.drc" "compare whole.drc $file" "compare $file whole.drc"; do
      # shellcheck disable=SC2086
      run "$papilio" $command
      [ "$status" = 1 ]
      [[ $output == "papilio: $file"* && $output != *'body'* && $output != *'Send'* ]]
    done
  done
  [ ! -e out.drc ]
  for where in '' "--server $url"; do
    # shellcheck disable=SC2086
    run "$papilio" refine . -o "$BATS_FILE_TMPDIR/refined" $where
    [ "$status" = 1 ]
    for file in nan.obj empty.drc hello.drc short.drc; do [ "$(grep -c "$file" <<<"$output")" = 1 ]; done
  done
}

@test "a folder run lists skipped files" {
  mkdir models
  "$papilio" convert "$coarse" models/a.obj
  touch models/b.mtl
  run "$papilio" refine models -o refined --levels 0
  [[ $status == 0 && $output == *'skipped, not meshes by their extension: 1 file: b.mtl' ]]
  touch models/{c,d,e,f}.txt $'models/g\e[2J'
  run "$papilio" refine models -o refined --levels 0 --json
  [[ $status == 0 && $output == *'6 files: b.mtl, c.txt, d.txt, e.txt, f.txt and 1 more' ]]
  [ "$("$papilio" refine models -o refined --levels 0 --json 2>messages | jq -c .)" = '{"files":1,"failed":0,"skipped":6}' ]
  mv models/a.obj $'models/a\e[2J.obj'
  echo rubbish >$'models/b\e[2J.off'
  run "$papilio" refine models -o refined
  [[ $status == 1 && $output == *'b\x1b[2J.off: '* && $output != *$'\e'* ]]
}

@test "README's curl lines work as written" {
  local line count=0
  "$PAPILIO_BUILD/coarsen" "$PAPILIO_MESHES/cgal/bunny00.off" bunny.obj 600 # as the demo makes it
  "$papilio" convert bunny.obj bunny.drc
  "$papilio" convert bunny.obj bunny.glb
  cp bunny.glb model.glb # the reader's own
  while read -r line; do
    [[ $line == *http://localhost:8080/* ]]
    line=${line//http:\/\/localhost:8080/$url}
    line=${line//build\/demo/.}
    no_proxy='*' eval "$line"
    count=$((count + 1))
  done < <(grep '^curl ' "$BATS_TEST_DIRNAME/../../README.md")
  [ "$count" = 5 ]
  [ "$("$papilio" info --json fine.glb | jq '.faces > 600')" = true ]
  [ "$(decoded_faces fine.drc)" -gt 600 ]
  [ "$(decoded_faces view.drc)" -gt 600 ]
}

@test "README has the parameter table of the program" {
  readme=$BATS_TEST_DIRNAME/../../README.md
  "$papilio" parameters >table
  sed -n '/^| parameter |/,/^$/p' "$readme" | sed '/^$/d' >found
  diff found table
}

@test "health returns a server's state as an exit status" {
  run "$papilio" health --server "$url"
  [ "$status" = 0 ]
  [ "$output" = alive ]
  run "$papilio" health --ready --server "$url"
  [ "$status" = 0 ]
  [ "$output" = ready ]
  run "$papilio" health --server http://127.0.0.1:1
  [ "$status" = 1 ]
  [[ $output == *"No answer from http://127.0.0.1:1"* ]]
  run "$papilio" health --server "$url/v1"
  [ "$status" = 1 ]
  run "$papilio" health --server localhost
  [ "$status" != 0 ]
  [[ $output == *"must be a URL"* ]]
}
