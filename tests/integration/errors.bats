#!/usr/bin/env bats
# Each refusal has a status, a code and a helpful message, and the server continues.

load helpers

setup_file() {
  start_server --max-body-bytes 100000 --max-input-faces 2000 --max-output-faces 20000 --read-seconds 2
  head -c 200000 /dev/zero >"$BATS_FILE_TMPDIR/large"
}
teardown_file() { stop_server; }
teardown() { server_is_well; }

post() { request -H "$draco" --data-binary @"${file:-$coarse}" "$@"; }

@test "bad_parameter names parameters that are out of range, ill-typed or repeated" {
  post "$url/v1/refine?levels=11"
  expect_problem 400 bad_parameter
  [ "$(field parameter)" = levels ]
  [[ $(field detail) == *0..10* ]]
  post "$url/v1/refine?flatness=0.8,high"
  expect_problem 400 bad_parameter
  [ "$(field parameter)" = flatness ]
  post "$url/v1/refine?levels=1&levels=2"
  expect_problem 400 bad_parameter
  post "$url/v1/refine?view.eye=0,0,0"
  expect_problem 400 bad_parameter
  [ "$(field parameter)" = view.target ]
  post "$url/v1/refine?simplify_hidden=true"
  expect_problem 400 bad_parameter
  [ "$(field parameter)" = simplify_hidden ]
  post "$url/v1/refine?view.lights=0,0,1,1"
  expect_problem 400 bad_parameter
  [[ $(field detail) == *"1 to 8 times 3 numbers"* ]]
  post "$url/v1/refine?tolerance=2"
  expect_problem 400 bad_parameter
}

@test "unknown_parameter names the parameter" {
  post "$url/v1/refine?level=2"
  expect_problem 400 unknown_parameter
  [ "$(field parameter)" = level ]
  [[ $(field detail) == *levels* ]]
  request -F mesh=@"$coarse" -F 'params={"view": {"eyes": [0, 0, 1]}}' "$url/v1/refine"
  expect_problem 400 unknown_parameter
  [ "$(field parameter)" = view.eyes ]
}

@test "bad_request: malformed forms and JSON" {
  request -F mesh=@"$coarse" -F 'params={"levels": ' "$url/v1/refine"
  expect_problem 400 bad_request
  request -F 'params={}' "$url/v1/refine"
  expect_problem 400 bad_request
  request -F mesh=@"$coarse" -F 'params={"levels": 1e400}' "$url/v1/refine"
  expect_problem 400 bad_request
  nested=$(printf '[%.0s' {1..30000})$(printf ']%.0s' {1..30000})
  printf '{"levels": %s}' "$nested" >"$BATS_TEST_TMPDIR/nested"
  request -F mesh=@"$coarse" -F "params=<$BATS_TEST_TMPDIR/nested" "$url/v1/refine"
  expect_problem 400 bad_request
  request -F mesh=@"$coarse" -F mesh=@"$coarse" "$url/v1/refine"
  expect_problem 400 bad_request
  request -F mesh=@"$coarse" -F other=1 "$url/v1/refine"
  expect_problem 400 bad_request
  request -F mesh=@"$coarse" "$url/v1/refine?levels=1"
  expect_problem 400 bad_request
  request -H 'Content-Type: multipart/form-data' --data-binary @"$coarse" "$url/v1/refine"
  expect_problem 400 bad_request
}

@test "not_found and method_not_allowed" {
  request "$url/v2/refine"
  expect_problem 404 not_found
  request "$url/v1/refine"
  expect_problem 405 method_not_allowed
  [[ $(header Allow) == *POST* ]]
  request -X DELETE "$url/health"
  expect_problem 405 method_not_allowed
  [[ $(header Allow) == *GET* ]]
}

@test "not_acceptable" {
  post -H 'Accept: text/html' "$url/v1/refine"
  expect_problem 406 not_acceptable
}

@test "length_required" {
  # curl always sends a length or chunks: send the request directly.
  exec 5<>"/dev/tcp/127.0.0.1/${url##*:}"
  printf 'POST /v1/refine HTTP/1.1\r\nHost: x\r\nContent-Type: application/x-draco\r\n\r\n' >&5
  answer=$(timeout 20 cat <&5)
  exec 5>&-
  [[ $answer == 'HTTP/1.1 411 '* ]]
  [[ $answer == *length_required* ]]
}

@test "body_too_large: refused by its length, at once" {
  file=$BATS_FILE_TMPDIR/large post "$url/v1/refine"
  expect_problem 413 body_too_large
  [[ $(field detail) == *100000* ]]
}

@test "body_too_large: refused in chunks, as soon as the limit is passed" {
  file=$BATS_FILE_TMPDIR/large post -H 'Transfer-Encoding: chunked' "$url/v1/refine"
  expect_problem 413 body_too_large
}

@test "mesh_too_large: refused by the declared count" {
  "$papilio" refine "$coarse" -o "$BATS_TEST_TMPDIR/fine.drc" --levels 1
  file=$BATS_TEST_TMPDIR/fine.drc post "$url/v1/refine?levels=0"
  expect_problem 413 mesh_too_large
  [[ $(field detail) == *2400*2000* ]]
}

@test "unsupported_media_type states the accepted types" {
  request --data-binary @"$coarse" "$url/v1/refine"
  expect_problem 415 unsupported_media_type
  [[ $(field detail) == *'Content-Type: application/x-draco'* ]]
}

@test "unsupported_encoding" {
  gzip -c "$coarse" >"$BATS_TEST_TMPDIR/mesh.gz"
  file=$BATS_TEST_TMPDIR/mesh.gz post -H 'Content-Encoding: gzip' "$url/v1/refine"
  expect_problem 415 unsupported_encoding
}

@test "range_not_supported" {
  post -H 'Range: bytes=0-99' "$url/v1/refine"
  expect_problem 416 range_not_supported
}

@test "headers_too_large" {
  post -H "X-Flood: $(head -c 60000 /dev/zero | tr '\0' x)" "$url/v1/refine"
  expect_problem 431 headers_too_large
}

@test "mesh_not_draco: an empty body, another format, a truncated stream" {
  file=/dev/null post "$url/v1/refine"
  expect_problem 422 mesh_not_draco
  printf 'solid cube' >"$BATS_TEST_TMPDIR/solid"
  file=$BATS_TEST_TMPDIR/solid post "$url/v1/refine"
  expect_problem 422 mesh_not_draco
  for size in 5 11 20 100 1000; do
    head -c "$size" "$coarse" >"$BATS_TEST_TMPDIR/short"
    file=$BATS_TEST_TMPDIR/short post "$url/v1/refine"
    expect_problem 422 mesh_not_draco
  done
}

@test "mesh_unsupported: another bitstream version, a point cloud" {
  { printf 'DRACO\001\001\001\001\000\000'; tail -c +12 "$coarse"; } >"$BATS_TEST_TMPDIR/old"
  file=$BATS_TEST_TMPDIR/old post "$url/v1/refine"
  expect_problem 422 mesh_unsupported
  draco_encoder -point_cloud -i "$PAPILIO_MESHES/bunny600.obj" -o "$BATS_TEST_TMPDIR/cloud.drc" >/dev/null
  file=$BATS_TEST_TMPDIR/cloud.drc post "$url/v1/refine"
  expect_problem 422 mesh_unsupported
}

@test "mesh_unusable: a mesh without a surface" {
  printf 'v 0 0 0\nv 0 0 0\nv 1 1 1\nf 1 2 3\nf 1 3 2\n' >"$BATS_TEST_TMPDIR/flat.obj"
  draco_encoder -i "$BATS_TEST_TMPDIR/flat.obj" -o "$BATS_TEST_TMPDIR/flat.drc" -qp 0 -cl 0 >/dev/null
  file=$BATS_TEST_TMPDIR/flat.drc post "$url/v1/refine"
  expect_problem 422 mesh_unusable
}

@test "mesh_unusable: NaN" {
  printf 'v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n' >"$BATS_TEST_TMPDIR/nan.obj"
  draco_encoder -i "$BATS_TEST_TMPDIR/nan.obj" -o "$BATS_TEST_TMPDIR/nan.drc" -qp 0 -cl 0 >/dev/null
  file=$BATS_TEST_TMPDIR/nan.drc post "$url/v1/refine"
  expect_problem 422 mesh_unusable
  [[ $(field detail) == *NaN* ]]
}

@test "result_too_large states the number, before the refinement" {
  post "$url/v1/refine?levels=9"
  expect_problem 507 result_too_large
  [[ $(field detail) == *38400*20000* ]]
  post "$url/v1/refine?levels=9&flatness=1"
  expect_problem 507 result_too_large
}

@test "a problem after the start of a stream is its last part" {
  post -H 'Accept: multipart/mixed' "$url/v1/refine?levels=9&flatness=1"
  [ "$status" = 200 ]
  grep -aq 'Content-Type: application/problem+json' "$body"
  grep -aq '"code": "result_too_large"' "$body"
  tail -c 4 "$body" | cmp - <(printf -- '--\r\n')
}

@test "request_timeout: a stalled body" {
  exec 5<>"/dev/tcp/127.0.0.1/${url##*:}"
  printf 'POST /v1/refine HTTP/1.1\r\nHost: x\r\nContent-Type: application/x-draco\r\nContent-Length: 100\r\n\r\nDRACO' >&5
  answer=$(timeout 20 cat <&5)
  exec 5>&-
  [[ $answer == 'HTTP/1.1 408 '* ]]
  [[ $answer == *request_timeout* ]]
}

@test "the body of a refused request is never read as the next request" {
  smuggled=$'GET /health HTTP/1.1\r\nHost: x\r\n\r\n'
  exec 5<>"/dev/tcp/127.0.0.1/${url##*:}"
  printf 'POST /nowhere HTTP/1.1\r\nHost: x\r\nContent-Length: %d\r\n\r\n%s' ${#smuggled} "$smuggled" >&5
  answer=$(timeout 20 cat <&5)
  exec 5>&-
  [ "$(grep -c '^HTTP/1.1' <<<"$answer")" = 1 ]
  [[ $answer == 'HTTP/1.1 404 '* ]]
}
