#!/usr/bin/env bats
# Known attacks on HTTP libraries and on Draco's decoder, against the real server. More are in errors.bats, service.bats,
# nginx.bats and the unit tests of server/http.

bats_require_minimum_version 1.5.0
load helpers

setup() { start_server "${arguments[@]}"; }
teardown() {
  if [[ -n ${server_pid:-} ]] && kill -0 "$server_pid" 2>/dev/null; then
    server_is_well
    stop_server
  fi
}

port() { echo "${url##*:}"; }
post() { request -H "$draco" --data-binary @"$1" "${@:2}"; }
peak_kilobytes() { sed -n 's/^VmHWM:[[:space:]]*\([0-9]*\) kB/\1/p' "/proc/$server_pid/status"; }

# stays_within MEGABYTES COMMAND...: bounds the growth of the server's peak memory during a command.
stays_within() {
  local before after allowed=$1
  # The thread sanitizer adds about eight bytes for each byte of the program, including its history.
  ! grep -qa __tsan_init "$server" || allowed=$((8 * allowed))
  before=$(peak_kilobytes)
  "${@:2}"
  after=$(peak_kilobytes)
  ((after - before < allowed * 1024)) || { echo "from $before to $after kB"; return 1; }
}

# HTTP

@test "a small gzip body that would expand to a large one is not expanded" {
  head -c 100000000 /dev/zero | gzip -1 >"$BATS_TEST_TMPDIR/bomb"
  stays_within 50 post "$BATS_TEST_TMPDIR/bomb" -H 'Content-Encoding: gzip' "$url/v1/refine"
  expect_problem 415 unsupported_encoding
}

@test "a Content-Length above the limit is refused before the body arrives" {
  printf 'POST /v1/refine HTTP/1.1\r\nHost: x\r\nContent-Type: application/x-draco\r\nContent-Length: 99999999999\r\n\r\n' \
    >"$BATS_TEST_TMPDIR/head"
  exchange "$(port)" <"$BATS_TEST_TMPDIR/head" >"$BATS_TEST_TMPDIR/answer"
  [[ $(head -1 "$BATS_TEST_TMPDIR/answer") == 'HTTP/1.1 413 '* ]]
  grep -q '"code": "body_too_large"' "$BATS_TEST_TMPDIR/answer"
}

@test "a chunked body above the limit is refused while it arrives, and not kept" {
  stop_server
  start_server --max-body-bytes 1000000
  head -c 60000000 /dev/zero >"$BATS_TEST_TMPDIR/large"
  stays_within 50 post "$BATS_TEST_TMPDIR/large" -H 'Transfer-Encoding: chunked' "$url/v1/refine"
  expect_problem 413 body_too_large
}

@test "REMOTE_ADDR and similar headers: a forged address does not reach the log" {
  request -H 'REMOTE_ADDR: 6.6.6.6' -H 'Remote-Addr: 6.6.6.6' -H 'X-Forwarded-For: 6.6.6.6' -H 'X-Real-IP: 6.6.6.6' \
    -H 'Forwarded: for=6.6.6.6' -H 'X-Request-Id: forger' "$url/v1/info"
  [ "$status" = 200 ]
  stop_server
  eventually grep -q 'id=forger .* remote=127\.0\.0\.1' "$BATS_FILE_TMPDIR/server.log"
  run ! grep -F 6.6.6.6 "$BATS_FILE_TMPDIR/server.log"
}

@test "idle connections, three times as many as threads, do not block others" {
  stop_server
  start_server --connections 4 --idle-seconds 3600
  local fds=() fd line
  for _ in {1..12}; do
    exec {fd}<>"/dev/tcp/127.0.0.1/$(port)"
    printf 'GET /health HTTP/1.1\r\nHost: x\r\n\r\n' >&"$fd"
    read -r -t 20 line <&"$fd" # answered; and then idle
    [[ $line == 'HTTP/1.1 200 '* ]]
    fds+=("$fd")
  done
  server_is_well
  post "$coarse" "$url/v1/refine?levels=0"
  [ "$status" = 200 ]
  for fd in "${fds[@]}"; do exec {fd}>&-; done
}

@test "SIGTERM during a stream: the stream is completed" {
  stop_server
  start_server --drain-seconds 3600
  mkfifo "$BATS_TEST_TMPDIR/stream"
  curl -sSN --noproxy '*' -o "$BATS_TEST_TMPDIR/stream" -H "$draco" -H 'Accept: multipart/mixed' --data-binary @"$coarse" \
    "$url/v1/refine?levels=6" 3>&- &
  running=$!
  exec 5<"$BATS_TEST_TMPDIR/stream"
  head -c 100 <&5 >"$BATS_TEST_TMPDIR/whole"
  kill -TERM "$server_pid"
  cat <&5 >>"$BATS_TEST_TMPDIR/whole"
  exec 5<&-
  wait "$running"    # curl fails if a stream is truncated
  wait "$server_pid" # 0: nothing was
  server_pid=
  [ "$(grep -ac '^Papilio-Faces: ' "$BATS_TEST_TMPDIR/whole")" = 7 ]
  tail -c 4 "$BATS_TEST_TMPDIR/whole" | cmp - <(printf -- '--\r\n')
}

@test "200 simultaneous clients are all answered" {
  curl -sS --noproxy '*' --parallel --parallel-immediate --parallel-max 200 -o "$BATS_TEST_TMPDIR/#1" \
    -w '%{http_code} %{num_connects}\n' -H 'Connection: close' "$url/v1/info?[1-200]" >"$BATS_TEST_TMPDIR/codes"
  [ "$(grep -c '^200 1$' "$BATS_TEST_TMPDIR/codes")" = 200 ]
}

@test "curl's default form type, above the size at which libraries begin to parse it, is refused with a message" {
  head -c 100000 /dev/zero >"$BATS_TEST_TMPDIR/form"
  request --data-binary @"$BATS_TEST_TMPDIR/form" "$url/v1/refine"
  expect_problem 415 unsupported_media_type
}

# post_form BOUNDARY-PARAMETER FORM: posts the form, with escapes of printf and MESH replaced by the mesh.
post_form() {
  # shellcheck disable=SC2059
  { printf -- "${2%MESH*}"; cat "$coarse"; printf -- "${2#*MESH}"; } >"$BATS_TEST_TMPDIR/form"
  request -H "Content-Type: multipart/form-data; $1" --data-binary @"$BATS_TEST_TMPDIR/form" "$url/v1/refine"
}

@test "multipart bodies in unusual but valid forms are accepted" {
  post "$coarse" "$url/v1/refine?levels=1"
  mv "$body" "$BATS_TEST_TMPDIR/plain"
  local mesh='Content-Disposition: form-data; name="mesh"' params='\r\nContent-Disposition: form-data; name=params\r\n\r\n{"levels": 1}\r\n'
  local shapes=(
    "boundary=b|--b\r\n$mesh\r\n\r\nMESH\r\n--b$params--b--\r\n"
    "boundary=b|--b\r\n$mesh\r\n\r\nMESH\r\n--b$params--b--"                                    # no final line end
    "boundary=b|preamble\r\n\r\n--b\r\n$mesh\r\n\r\nMESH\r\n--b$params--b--\r\nepilogue --b"
    "boundary=b|--b  \t\r\n$mesh\r\n\r\nMESH\r\n--b \r\n${params#'\r\n'}--b-- \r\n"             # trailing white space
    "boundary=\"a (b)+c?=/:.\"|--a (b)+c?=/:.\r\n$mesh\r\n\r\nMESH\r\n--a (b)+c?=/:.$params--a (b)+c?=/:.--\r\n"
    "charset=utf-8; BOUNDARY=b|--b\r\n$mesh\r\n\r\nMESH\r\n--b$params--b--\r\n"
    "boundary=b|--b$params--b\r\n$mesh\r\n\r\nMESH\r\n--b--\r\n"                                 # other order
    "boundary=b|--b\r\ncontent-type: x/y\r\ncontent-disposition:form-data;filename=\"a;name=no.drc\";name=mesh\r\nX-Else: 1\r\n\r\nMESH\r\n--b$params--b--\r\n"
    "boundary=b|--b\r\n$mesh; filename=\"\\\\\"--b.drc\"; filename*=UTF-8''%%e2%%82%%ac\r\n\r\nMESH\r\n--b$params--b--\r\n"
    "boundary=$(printf 'x%.0s' {1..70})|--$(printf 'x%.0s' {1..70})\r\n$mesh\r\n\r\nMESH\r\n--$(printf 'x%.0s' {1..70})$params--$(printf 'x%.0s' {1..70})--\r\n"
  )
  local shape
  for shape in "${shapes[@]}"; do
    post_form "${shape%%|*}" "${shape#*|}"
    [ "$status" = 200 ] || { echo "$shape"; cat "$body"; return 1; }
    cmp "$body" "$BATS_TEST_TMPDIR/plain"
  done
}

@test "ambiguous and unterminated multipart bodies are refused" {
  local mesh='Content-Disposition: form-data; name="mesh"' form
  for form in "--b\r\n$mesh\r\n\r\nMESH" "--b\r\n$mesh\r\n\r\nMESH\r\n--b" "--bad\r\n$mesh\r\n\r\nMESH\r\n--bad--" \
    "--b\n$mesh\n\nMESH\n--b--\n" "--b\r\nContent-Type: x/y\r\n\r\nMESH\r\n--b--" "--b--\r\nMESH"; do
    post_form boundary=b "$form"
    expect_problem 400 bad_request
  done
  post_form "boundary=$(printf 'x%.0s' {1..71})" "--b\r\n$mesh\r\n\r\nMESH\r\n--b--"
  expect_problem 400 bad_request
}

# Draco

# stream NAME: writes the stream of tests/support/draco_bytes.py to a file; sets $stream to its name.
stream() {
  stream=$BATS_TEST_TMPDIR/$1.drc
  python3 "$BATS_TEST_DIRNAME/../support/draco_bytes.py" "$1" >"$stream"
}

@test "valid streams built byte by byte are read" {
  stream good
  post "$stream" "$url/v1/refine?levels=1"
  [ "$status" = 200 ]
  [ "$(header Papilio-Faces)" = 8 ]
  stream metadata_good
  post "$stream" "$url/v1/refine?levels=1"
  [ "$status" = 200 ]
}

@test "memory bombs: 70-byte streams that declare 100 million faces are refused, in old and new bitstreams" {
  for version in 1.0 1.1 1.2 1.3 1.4 1.5 2.0 2.1; do
    stream "bomb_$version"
    stays_within 20 post "$stream" "$url/v1/refine"
    expect_problem 422 mesh_unsupported
  done
  for kind in edgebreaker sequential; do
    stream "bomb_$kind"
    stays_within 20 post "$stream" "$url/v1/refine"
    expect_problem 413 mesh_too_large
  done
  # The streams are effective: Draco's own program fails on them with a gigabyte of memory.
  for name in bomb_1.0 bomb_1.5 bomb_2.1 bomb_edgebreaker; do
    stream "$name"
    run bash -c "ulimit -c 0 -v 1000000; exec draco_decoder -i '$stream' -o '$BATS_TEST_TMPDIR/out.obj'"
    ((status >= 128))
  done
}

@test "memory bombs: a stream within the limits needs no more memory than a mesh of its size" {
  for kind in edgebreaker sequential; do
    stream "limit_$kind"
    stays_within 150 post "$stream" "$url/v1/refine"
    expect_problem 422 mesh_not_draco
  done
}

@test "a stream that decodes to a face index out of range is refused" {
  stream index_out_of_range
  post "$stream" "$url/v1/refine"
  expect_problem 422 mesh_unusable
  [[ $(field detail) == *'Face 1 '* ]]
}

@test "a missing POSITION, or one of two, four or integer components, is refused" {
  for name in no_position four_components two_components integers; do
    stream "$name"
    post "$stream" "$url/v1/refine"
    expect_problem 422 mesh_unsupported
    [[ $(field detail) == *POSITION* ]]
  done
}

@test "NaN and infinite coordinates are refused" {
  for name in nan infinity; do
    stream "$name"
    post "$stream" "$url/v1/refine"
    expect_problem 422 mesh_unusable
    [[ $(field detail) == *'Point 3 '* ]]
  done
}

@test "isolated points are dropped and counted" {
  stream isolated_points
  post "$stream" "$url/v1/refine?levels=1"
  [ "$status" = 200 ]
  [ "$(header Papilio-Vertices)" = 9 ]
  [[ $(header Papilio-Found) == *isolated_points=2* ]]
}

@test "metadata nested 100,000 deep, or with counts of four billion entries, blocks or bytes, is refused" {
  stream metadata_deep
  stays_within 20 post "$stream" "$url/v1/refine"
  expect_problem 422 mesh_unsupported
  for name in metadata_entries metadata_blocks metadata_long_value; do
    stream "$name"
    stays_within 20 post "$stream" "$url/v1/refine"
    expect_problem 422 mesh_not_draco
  done
}

@test "streams truncated at every byte are refused" {
  stream good
  local size
  size=$(stat -c %s "$stream")
  local transfers=()
  for ((length = 0; length < size; ++length)); do
    head -c "$length" "$stream" >"$BATS_TEST_TMPDIR/cut$length"
    ((length == 0)) || transfers+=(--next)
    transfers+=(-sS --noproxy '*' --max-time 60 -o "$BATS_TEST_TMPDIR/answer$length" -w '%{http_code}\n' -H "$draco"
      --data-binary @"$BATS_TEST_TMPDIR/cut$length" "$url/v1/refine")
  done
  curl "${transfers[@]}" >"$BATS_TEST_TMPDIR/codes"
  [ "$(grep -c '^422$' "$BATS_TEST_TMPDIR/codes")" = "$size" ]
  [ "$(cat "$BATS_TEST_TMPDIR"/answer* | grep -c '"code": "mesh_not_draco"')" = "$size" ]
}
