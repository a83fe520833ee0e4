#!/usr/bin/env bats
# The server program: settings, start, health, load, draining, log.

load helpers

large_levels=6 # of requests that take seconds

teardown() {
  if [[ -n ${server_pid:-} ]] && kill -0 "$server_pid" 2>/dev/null; then stop_server; fi
}

@test "the only line on standard output states the address" {
  start_server
  stop_server
  [ "$(wc -l <"$BATS_FILE_TMPDIR/server.out")" = 1 ]
  grep -qE '^listening on http://127\.0\.0\.1:[0-9]+$' "$BATS_FILE_TMPDIR/server.out"
}

@test "health, readiness and info are served" {
  start_server --max-output-faces 12345
  request "$url/health"
  [ "$status" = 200 ]
  [ "$(field status)" = alive ]
  request "$url/ready"
  [ "$status" = 200 ]
  request "$url/v1/info"
  [ "$status" = 200 ]
  [ "$(header Content-Type)" = application/json ]
  [ "$(field limits.max_output_faces)" = 12345 ]
  [ "$(field 'schemes[0]')" = red-green ]
  [ "$(field 'parameters | map(.name) | index("view.edge_pixels") != null')" = true ]
  [ -n "$(field version)" ]
  request -I "$url/health"
  [ "$status" = 200 ]
}

@test "settings: a flag overrides the environment, and refusals state the setting and its range" {
  PAPILIO_MAX_BODY_BYTES=1000 start_server
  request "$url/v1/info"
  [ "$(field limits.max_body_bytes)" = 1000 ]
  stop_server
  PAPILIO_MAX_BODY_BYTES=1000 start_server --max-body-bytes 2000
  request "$url/v1/info"
  [ "$(field limits.max_body_bytes)" = 2000 ]
  stop_server
  run "$server" --port 70000
  [ "$status" = 2 ]
  [[ $output == *--port*65535* ]]
  PAPILIO_SLOTS=many run timeout 20 "$server" --port 0
  [ "$status" = 2 ]
  [[ $output == *slots* && $output == *PAPILIO_SLOTS=many* ]]
  PAPILIO_TLS_CERT=/nowhere PAPILIO_TLS_KEY=/nowhere run timeout 20 "$server" --port 0
  [ "$status" = 2 ]
  [[ $output == */nowhere* && $output != *listening* ]]
  run "$server" --colour red
  [ "$status" = 2 ]
  run "$server" --help
  [ "$status" = 0 ]
  [[ $output == *PAPILIO_MAX_BODY_BYTES* ]]
}

@test "a used port and a foreign address are refused with a message" {
  start_server
  run "$server" --port "${url##*:}"
  [ "$status" = 1 ]
  [[ $output == *"${url##*:}"* ]]
  run "$server" --host 192.0.2.1 --port 0 --allow-open
  [ "$status" = 1 ]
  [[ $output == *192.0.2.1* ]]
}

@test "inconsistent settings are refused before the address is printed" {
  run timeout 20 "$server" --port 0 --max-body-bytes 2000000 --max-held-bytes 1000000
  [ "$status" = 2 ]
  [[ $output == *--max-held-bytes*--max-body-bytes* && $output != *listening* ]]
  run timeout 20 "$server" --port 0 --connections 1000 --max-memory-bytes 1000000000
  [ "$status" = 2 ]
  [[ $output == *--max-memory-bytes*--connections* && $output != *listening* ]]
}

@test "a refusal quotes the environment without passwords" {
  PAPILIO_PORT=99999 PAPILIO_STORE=redis://user:secret@localhost run timeout 20 "$server"
  [ "$status" = 2 ]
  [[ $output == *PAPILIO_PORT=99999* && $output == *PAPILIO_STORE* && $output != *secret* ]]
}

# long_request ID QUERY: starts a request in the background; sets $running to its process. Its status goes to file "code".
long_request() {
  curl -sS --noproxy '*' -o "$BATS_TEST_TMPDIR/fine.drc" -w '%{http_code}' -H "$draco" -H "X-Request-Id: $1" \
    --data-binary @"$coarse" "$url/v1/refine?$2" >"$BATS_TEST_TMPDIR/code" 3>&- &
  running=$!
}

# until_busy [WAITING]: returns once one request computes and WAITING (default 0) requests wait.
until_busy() {
  for _ in {1..500}; do
    request "$url/metrics"
    ! grep -q '^papilio_slots_busy 1$' "$body" || ! grep -q "^papilio_queue_length ${1:-0}\$" "$body" || return 0
  done
  return 1
}

# leave PROCESS: kills the client without closing its connection in order.
leave() {
  kill -KILL "$1"
  wait "$1" || true
}

@test "busy: with all slots and places taken, large requests get 429 and Retry-After, small ones an answer" {
  start_server --slots 1 --queue 0
  long_request long "levels=$large_levels&output.normals=true"
  until_busy
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=$large_levels"
  expect_problem 429 busy
  [[ $(header Retry-After) =~ ^[0-9]+$ ]]
  server_is_well
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=0"
  [ "$status" = 200 ]
  request "$url/ready"
  [ "$status" = 200 ]
  wait "$running"
  [ "$(cat "$BATS_TEST_TMPDIR/code")" = 200 ]
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=$large_levels"
  [ "$status" = 200 ]
}

@test "not ready: while even small requests are refused" {
  start_server --slots 1 --queue 0
  long_request long "levels=$large_levels&flatness=1&growth=2&output.normals=true"
  first=$running
  until_busy
  # Each holds the express slot until it is found to be large, and is then refused.
  curl -s --noproxy '*' --parallel --parallel-max 4 -o /dev/null -H "$draco" --data-binary @"$coarse" \
    "$url/v1/refine?levels=$large_levels&flatness=1&growth=2&w=0.0[01-40]" 3>&- &
  running=$!
  for _ in {1..500}; do
    request "$url/ready"
    [ "$status" = 200 ] || break
  done
  expect_problem 503 not_ready
  kill "$running" 2>/dev/null || true # if it is not through with all of them
  wait "$running" || true
  leave "$first"
}

@test "small requests are answered while large ones hold every slot and wait; the large ones finish" {
  start_server --slots 2 --max-compute-seconds 0
  large=()
  for number in {1..6}; do
    curl -sS --noproxy '*' -o /dev/null -w '%{http_code}\n' -H "$draco" --data-binary @"$coarse" \
      "$url/v1/refine?levels=$large_levels&flatness=1&growth=2&w=0.0$number" >"$BATS_TEST_TMPDIR/large$number" 3>&- &
    large+=($!)
  done
  all_in() { request "$url/metrics" && (($(awk '/^papilio_(slots_busy|queue_length) / { n += $2 } END { print n }' "$body") >= 6)); }
  eventually all_in
  for query in 'levels=2' 'levels=8&tolerance=0.01'; do
    curl -sS --noproxy '*' -o "$BATS_TEST_TMPDIR/#1.drc" -w '%{http_code}\n' -H "$draco" \
      --data-binary @"$coarse" "$url/v1/refine?$query&crease_angle=[101-125]" >>"$BATS_TEST_TMPDIR/small"
    # Number of large requests that were finished by then; under sanitizers, which are slow, all may be.
    large_ones_done=$(cat "$BATS_TEST_TMPDIR"/large* | wc -l)
    [[ $PAPILIO_BUILD != */release ]] || ((large_ones_done < 6))
  done
  wait "${large[@]}"
  [ "$(grep -c '^200' "$BATS_TEST_TMPDIR/small")" = 50 ]
  [ "$(cat "$BATS_TEST_TMPDIR"/large* | grep -c '^200')" = 6 ]
}

@test "2,000 silent connections do not block others" {
  ulimit -Sn "$(ulimit -Hn)"
  most=$(($(ulimit -n) == 0 || $(ulimit -n) > 5000 ? 2000 : $(ulimit -n) / 3))
  start_server --connections 8 --idle-seconds 3600
  python3 -c 'import socket, sys, time
silent = [socket.create_connection(("127.0.0.1", int(sys.argv[1]))) for _ in range(int(sys.argv[2]))]
print("open", flush=True)
time.sleep(600)' "${url##*:}" "$most" >"$BATS_TEST_TMPDIR/silent" 3>&- &
  silent=$!
  eventually test -s "$BATS_TEST_TMPDIR/silent"
  for _ in {1..20}; do
    server_is_well
  done
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=0"
  [ "$status" = 200 ]
  leave "$silent"
}

@test "a waiting request is answered in its turn" {
  start_server --slots 1 --queue 4
  curl -sS --noproxy '*' --parallel --parallel-max 5 -o "$BATS_TEST_TMPDIR/#1.drc" -w '%{http_code}\n' -H "$draco" \
    --data-binary @"$coarse" "$url/v1/refine?levels=4&w=0.0[1-5]" >"$BATS_TEST_TMPDIR/codes"
  [ "$(grep -c '^200$' "$BATS_TEST_TMPDIR/codes")" = 5 ]
}

@test "a client that disconnects stops its work" {
  start_server --slots 1 --queue 0
  long_request leaver "levels=$large_levels&flatness=1&growth=2&output.normals=true"
  until_busy
  leave "$running"
  stop_server
  eventually grep -q 'id=leaver .* status=499 .*code=cancelled' "$BATS_FILE_TMPDIR/server.log"
}

@test "a client that disconnects while it waits frees its place" {
  start_server --slots 1 --queue 1
  long_request first "levels=$large_levels&output.normals=true"
  first=$running
  long_request waiter "levels=$large_levels&flatness=1&growth=2&output.normals=true"
  until_busy 1
  leave "$running"
  wait "$first"
  stop_server
  [ "$(grep -cE 'id=(first|waiter) .* status=499 .*code=cancelled' "$BATS_FILE_TMPDIR/server.log")" = 1 ]
}

@test "SIGTERM lets a running request finish, refuses others, and exits 0" {
  start_server --slots 1 --queue 0 --drain-seconds 300
  long_request long "levels=$large_levels&output.normals=true"
  until_busy
  kill -TERM "$server_pid"
  request "$url/v1/info"
  expect_problem 503 draining
  server_is_well
  wait "$running"
  [ "$(cat "$BATS_TEST_TMPDIR/code")" = 200 ]
  [ "$(decoded_faces "$BATS_TEST_TMPDIR/fine.drc")" = $((600 * 4 ** large_levels)) ]
  wait "$server_pid"
  server_pid=
}

@test "SIGHUP during the last requests truncates none of them" {
  start_server --slots 1 --queue 0 --drain-seconds 300
  long_request long "levels=$large_levels&output.normals=true"
  until_busy
  kill -TERM "$server_pid"
  until grep -q msg=draining "$BATS_FILE_TMPDIR/server.log"; do sleep 0.05; done
  kill -HUP "$server_pid"
  wait "$running"
  [ "$(cat "$BATS_TEST_TMPDIR/code")" = 200 ]
  wait "$server_pid"
  server_pid=
}

@test "the log has one structured line a request, and health checks only when they fail" {
  start_server
  request -H 'X-Request-Id: log-me' -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=9"
  request -H 'X-Request-Id: bad-one' -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=x"
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?a%22%20status%3D200%20x%3D%22=1"
  request -H 'X-Request-Id: alive-question' "$url/health"
  stop_server
  log=$BATS_FILE_TMPDIR/server.log
  [ "$(grep -c 'id=log-me ' "$log")" = 1 ]
  grep -q 'id=log-me method=POST path="/v1/refine" status=507 .*code=result_too_large' "$log"
  grep -q 'id=bad-one .*status=400 .*code=bad_parameter' "$log"
  # Text from the client stays inside its quotes.
  grep -q 'detail="Unknown parameter \\"a\\" status=200' "$log"
  ! grep -q alive-question "$log"
}
