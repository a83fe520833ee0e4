#!/usr/bin/env bats
# Limits of one request and of all together: time, memory, bodies. Later requests are served.

load helpers

teardown() {
  if [[ -n ${server_pid:-} ]] && kill -0 "$server_pid" 2>/dev/null; then server_is_well && stop_server; fi
}

is_sanitized() { grep -qaE '__(asan|tsan)_init' "$server"; }

@test "a refinement beyond the time limit is stopped, single or streamed" {
  start_server --max-compute-seconds 1 --max-output-faces 100000000 --max-compute-bytes 0
  "$papilio" refine "$coarse" -o "$BATS_TEST_TMPDIR/fine.drc" --levels 4
  request -H "$draco" --data-binary @"$BATS_TEST_TMPDIR/fine.drc" "$url/v1/refine?levels=4&flatness=1"
  expect_problem 507 takes_too_long
  [[ $(field detail) == *'1 seconds'* ]]
  request -H "$draco" -H 'Accept: multipart/mixed' --data-binary @"$coarse" "$url/v1/refine?levels=8&flatness=1"
  [ "$status" = 200 ]
  grep -aq '"code": "takes_too_long"' "$body"
  grep -aq 'Papilio-Levels: 0' "$body" # which had left before
  # The status was sent before: log and metrics have the outcome.
  eventually grep -q "msg=stream id=$(header X-Request-Id) code=takes_too_long detail=" "$BATS_FILE_TMPDIR/server.log"
  both_counted() { request "$url/metrics" && grep -q '^papilio_problems_total{code="takes_too_long"} 2' "$body"; }
  eventually both_counted
}

@test "a refinement beyond the memory limit is refused with the number" {
  start_server --max-compute-bytes 50000000
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=6&flatness=1"
  expect_problem 507 result_too_large
  [[ $(field detail) == *MiB*47* ]]
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=3&flatness=1"
  [ "$status" = 200 ]
}

@test "the address space is bounded: unforeseen allocations fail for their request only" {
  ! is_sanitized || skip "sanitizers reserve terabytes"
  start_server --slots 1 --connections 4 --max-memory-bytes 300000000 --max-compute-bytes 0
  [ "$(awk '/Max address space/ { print $4 }' "/proc/$server_pid/limits")" = 300000000 ]
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=6&output.normals=true"
  [[ $(field code) == result_too_large || $(field code) == out_of_memory ]]
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=3"
  [ "$status" = 200 ]
}

@test "the default address space follows from the settings" {
  ! is_sanitized || skip "sanitizers reserve terabytes"
  start_server --slots 1
  small=$(awk '/Max address space/ { print $4 }' "/proc/$server_pid/limits")
  stop_server
  start_server --slots 2
  (($(awk '/Max address space/ { print $4 }' "/proc/$server_pid/limits") > small + (2 << 30)))
}

@test "bodies have a common limit: one body above it is refused, the others continue" {
  start_server --max-body-bytes 3000000 --max-held-bytes 3000000 --read-seconds 60
  head -c 2000000 /dev/urandom >"$BATS_TEST_TMPDIR/bytes"
  # One request holds two of three megabytes, and delays the rest of its body.
  exec 5<>"/dev/tcp/127.0.0.1/${url##*:}"
  { printf 'POST /v1/refine HTTP/1.1\r\nHost: x\r\nContent-Type: application/x-draco\r\nContent-Length: 2000001\r\n\r\n'
    cat "$BATS_TEST_TMPDIR/bytes"; } >&5
  sleep 3 # until it is read: else the one too many may be this one
  for _ in {1..200}; do
    request -H "$draco" --data-binary @"$BATS_TEST_TMPDIR/bytes" "$url/v1/refine"
    [ "$status" != 429 ] || break
    sleep 0.1
  done
  expect_problem 429 busy
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=1"
  [ "$status" = 200 ]
  printf x >&5
  answer=$(timeout 20 head -1 <&5)
  exec 5>&-
  [[ $answer == *' 422 '* ]]
  request -H "$draco" --data-binary @"$BATS_TEST_TMPDIR/bytes" "$url/v1/refine"
  expect_problem 422 mesh_not_draco
}

@test "a body as large as the common limit is read" {
  start_server --max-body-bytes 300001 --max-held-bytes 300001
  head -c 300001 /dev/urandom >"$BATS_TEST_TMPDIR/bytes"
  request -H "$draco" --data-binary @"$BATS_TEST_TMPDIR/bytes" "$url/v1/refine"
  expect_problem 422 mesh_not_draco
}

@test "slow clients do not each hold a copy of the stored mesh" {
  start_server
  { cat "$coarse" && head -c 20000000 /dev/zero; } >"$BATS_TEST_TMPDIR/fine.drc" # no decoder minds what follows
  upload "$BATS_TEST_TMPDIR/fine.drc"
  [ "$status" = 201 ]
  path=$(header Location)
  request "$url$path"
  resident() { awk '/^VmRSS/ { print $2 * 1024 }' "/proc/$server_pid/status"; }
  before=$(resident)
  readers=()
  for _ in {1..60}; do
    exec {reader}<>"/dev/tcp/127.0.0.1/${url##*:}"
    printf 'GET %s HTTP/1.1\r\nHost: x\r\n\r\n' "$path" >&"$reader"
    readers+=("$reader")
  done
  for reader in "${readers[@]}"; do
    IFS= read -r -t 20 -u "$reader" line # the rest is not read, and fits into no socket's buffer
    [[ $line == *' 200 '* ]]
  done
  after=$(resident)
  for reader in "${readers[@]}"; do exec {reader}>&-; done
  ((after - before < 30 * $(stat -c %s "$BATS_TEST_TMPDIR/fine.drc")))
}

@test "a stream's slot is free before a slow client has read the stream" {
  start_server --slots 1 --queue 0 --write-seconds 300 # under a sanitizer the client waits long
  # The answer has megabytes, more than socket buffers hold, and is not read.
  exec 5<>"/dev/tcp/127.0.0.1/${url##*:}"
  { printf 'POST /v1/refine?levels=6&output.position_bits=16 HTTP/1.1\r\nHost: x\r\nAccept: multipart/mixed\r\n'
    printf 'Connection: close\r\nContent-Type: application/x-draco\r\nContent-Length: %d\r\n\r\n' "$(stat -c %s "$coarse")"
    cat "$coarse"; } >&5
  for _ in {1..300}; do
    request "$url/metrics"
    ! grep -q '^papilio_stage_seconds_count{stage="encode"} 1' "$body" || break
    sleep 0.1
  done
  for _ in {1..50}; do
    request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=6"
    [ "$status" = 429 ] || break
    sleep 0.1
  done
  [ "$status" = 200 ]
  timeout 120 cat <&5 >"$BATS_TEST_TMPDIR/stream" # and then it gets all of it
  exec 5>&-
  [ "$(grep -ac '^Papilio-Faces: ' "$BATS_TEST_TMPDIR/stream")" = 7 ]
}

@test "a client that disconnects from a stream or a stored mesh stops the work" {
  start_server --slots 1 --queue 0
  upload
  gone() { awk '/^papilio_problems_total.code="(cancelled|not_sent)"/ { n += $2 } END { print n + 0 }' "$body"; }
  leavers=0
  for path in "/v1/meshes/$(coarse_id)/refined?levels=6&flatness=1&growth=2" \
    "/v1/meshes/$(coarse_id)/refined?levels=6&flatness=1&growth=2&view.eye=0,0,30&view.edge_pixels=0"; do
    for accept in application/x-draco multipart/mixed; do
      curl -sS --noproxy '*' -o /dev/null -H "Accept: $accept" "$url$path" 3>&- &
      leaver=$!
      for _ in {1..500}; do
        request "$url/metrics"
        ! grep -q '^papilio_slots_busy 1' "$body" || break
      done
      kill -KILL "$leaver"
      wait "$leaver" || true
      leavers=$((leavers + 1))
      for _ in {1..300}; do # the slot is free before the request is counted
        request "$url/metrics"
        ! grep -q '^papilio_slots_busy 0' "$body" || (($(gone) < leavers)) || break
        sleep 0.1
      done
      grep -q '^papilio_slots_busy 0' "$body"
      [ "$(gone)" = "$leavers" ]
    done
  done
  # No request was completed.
  grep -q '^papilio_stage_seconds_count{stage="encode"} 0$' "$body"
}
