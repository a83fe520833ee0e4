#!/usr/bin/env bats
# Access control: keys, their rights and their reload; other origins; listening beyond loopback.

load helpers

setup_file() {
  export keys=$BATS_FILE_TMPDIR/keys
  { echo '# name key [manage]'
    echo 'viewer   viewer-key-0123456789'
    echo "operator sha256:$(printf %s operator-key-0123456789 | sha256sum | cut -d' ' -f1) manage"
  } >"$keys"
  start_server --keys "$keys" --cors-origins https://a.example,https://b.example:8443
}
teardown_file() { stop_server; }

# as NAME ARGUMENT...: sends a request with the key of NAME.
as() { request -H "Authorization: Bearer $1-key-0123456789" "${@:2}"; }

# Table of endpoints and required rights: METHOD PATH OPEN|USE|MANAGE.
endpoints() {
  cat <<END
POST /v1/refine use
POST /v1/meshes use
GET /v1/meshes/$(coarse_id) use
HEAD /v1/meshes/$(coarse_id) use
GET /v1/meshes/$(coarse_id)/refined use
POST /v1/meshes/$(coarse_id)/refined use
DELETE /v1/meshes/$(coarse_id) manage
GET /metrics manage
GET /v1/info open
GET /openapi.json open
GET /v1/samples/mug use
GET / open
GET /assets/$(basename "$PAPILIO_BUILD"/web/assets/index-*.css) open
GET /health open
GET /ready open
END
}

@test "each endpoint requires a key as in the table" {
  local method path needs count=0
  while read -r method path needs; do
    send=(-X "$method")
    [[ $method != HEAD ]] || send=(-I)
    [[ $method != POST ]] || send+=(-H 'Content-Type: application/json' -d '{}')
    request "${send[@]}" "$url$path"
    if [[ $needs == open ]]; then [ "$status" = 200 ]; else [ "$status" = 401 ]; fi
    request "${send[@]}" -H 'Authorization: Bearer nobody-key-0123456789' "$url$path"
    if [[ $needs == open ]]; then [ "$status" = 200 ]; else [ "$status" = 401 ]; fi
    as viewer "${send[@]}" "$url$path"
    if [[ $needs == manage ]]; then [ "$status" = 403 ]; else [[ $status != 401 && $status != 403 ]]; fi
    as operator "${send[@]}" "$url$path"
    [[ $status != 401 && $status != 403 ]]
    count=$((count + 1))
  done < <(endpoints)
  # The table is complete: the document has as many operations. GET of a mesh also represents HEAD.
  request "$url/openapi.json"
  [ "$(field 'paths | map(length) | add')" = $((count - 1)) ]
}

@test "refusals state how to send a key, and reveal nothing else" {
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine"
  expect_problem 401 unauthorized
  [[ $(header WWW-Authenticate) == Bearer* ]]
  [[ $(field detail) == *'Authorization: Bearer'* ]]
  request -H 'Authorization: Basic dXNlcjpwYXNz' "$url/metrics"
  expect_problem 401 unauthorized
  as viewer "$url/metrics"
  expect_problem 403 forbidden
  ! grep -qE '(viewer|operator|nobody)-key' "$BATS_FILE_TMPDIR/server.log"
}

@test "the command line sends its key, and reports a missing one" {
  run "$papilio" refine "$coarse" -o "$BATS_TEST_TMPDIR/fine.drc" --server "$url" --levels 1
  [ "$status" = 1 ]
  [[ $output == *"An access key is required"* ]]
  PAPILIO_KEY=viewer-key-0123456789 "$papilio" refine "$coarse" -o "$BATS_TEST_TMPDIR/fine.drc" --server "$url" --levels 1
  "$papilio" refine "$coarse" -o "$BATS_TEST_TMPDIR/here.drc" --levels 1
  cmp "$BATS_TEST_TMPDIR/fine.drc" "$BATS_TEST_TMPDIR/here.drc"
}

@test "with keys, answers may be cached only by the client" {
  as viewer -H "$draco" --data-binary @"$coarse" "$url/v1/meshes"
  as viewer "$url/v1/meshes/$(coarse_id)/refined?levels=1"
  [ "$status" = 200 ]
  [[ $(header Cache-Control) == private,* ]]
}

@test "the log names the key's owner" {
  as viewer -H 'X-Request-Id: who' -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=0"
  [ "$status" = 200 ]
  eventually grep -q 'id=who .*client=viewer' "$BATS_FILE_TMPDIR/server.log"
}

@test "SIGHUP reloads the keys; a damaged file changes nothing" {
  cp "$keys" "$BATS_TEST_TMPDIR/before"
  echo 'late late-key-0123456789' >>"$keys"
  sed -i '/^viewer/d' "$keys"
  as late "$url/v1/meshes/$(coarse_id)"
  [ "$status" = 401 ]
  kill -HUP "$server_pid"
  for _ in {1..50}; do
    as late "$url/v1/meshes/$(coarse_id)"
    [ "$status" = 401 ] || break
    sleep 0.1
  done
  [[ $status == 200 || $status == 404 ]]
  as viewer "$url/v1/meshes/$(coarse_id)"
  [ "$status" = 401 ]
  echo 'short x' >"$keys"
  kill -HUP "$server_pid"
  for _ in {1..50}; do
    ! grep -q 'level=error msg=reload' "$BATS_FILE_TMPDIR/server.log" || break
    sleep 0.1
  done
  eventually grep -q 'level=error msg=reload what=keys .*at least 16' "$BATS_FILE_TMPDIR/server.log"
  as operator "$url/metrics"
  [ "$status" = 200 ]
  cp "$BATS_TEST_TMPDIR/before" "$keys"
  kill -HUP "$server_pid"
  for _ in {1..50}; do
    as viewer "$url/v1/meshes/$(coarse_id)"
    [ "$status" = 401 ] || break
    sleep 0.1
  done
  [ "$status" != 401 ]
}

@test "unreadable keys are refused at start-up, by file and line" {
  run "$server" --port 0 --keys "$BATS_TEST_TMPDIR/none"
  [ "$status" = 1 ]
  [[ $output == *"$BATS_TEST_TMPDIR/none"* ]]
  printf 'one one-key-0123456789\ntwo\n' >"$BATS_TEST_TMPDIR/bad"
  run "$server" --port 0 --keys "$BATS_TEST_TMPDIR/bad"
  [ "$status" = 1 ]
  [[ $output == *"bad:2:"* ]]
}

@test "other addresses than loopback require keys or an explicit option" {
  run "$server" --port 0 --host 0.0.0.0
  [ "$status" = 2 ]
  [[ $output == *--keys*--allow-open* ]]
  for arguments in "--allow-open" "--keys $keys"; do
    # shellcheck disable=SC2086 # two words
    "$server" --port 0 --host 0.0.0.0 $arguments >"$BATS_TEST_TMPDIR/out" 2>/dev/null 3>&- &
    for _ in {1..50}; do [[ ! -s $BATS_TEST_TMPDIR/out ]] || break; sleep 0.1; done
    grep -q '^listening on http://0.0.0.0:' "$BATS_TEST_TMPDIR/out"
    kill -TERM $!
    wait $!
    : >"$BATS_TEST_TMPDIR/out"
  done
}

@test "pages of allowed origins may read answers and send preflight requests" {
  request -H 'Origin: https://b.example:8443' "$url/v1/info"
  [ "$(header Access-Control-Allow-Origin)" = https://b.example:8443 ]
  [[ $(header Access-Control-Expose-Headers) == *ETag*Papilio-Faces* ]]
  [[ $(header Vary) == *Origin* ]]
  request -X OPTIONS -H 'Origin: https://a.example' -H 'Access-Control-Request-Method: DELETE' \
    "$url/v1/meshes/$(coarse_id)"
  [ "$status" = 204 ]
  [[ $(header Access-Control-Allow-Methods) == *DELETE* ]]
  [[ $(header Access-Control-Allow-Headers) == *Authorization* ]]
  request -H 'Origin: https://a.example' "$url/nowhere" # refusals can be read too
  [ "$(header Access-Control-Allow-Origin)" = https://a.example ]
  for origin in https://evil.example https://a.example.evil.example null http://a.example; do
    request -H "Origin: $origin" "$url/v1/info"
    [ -z "$(header Access-Control-Allow-Origin)" ]
    [[ $(header Vary) == *Origin* ]]
  done
}

@test "without a list no origin is allowed; an invalid origin is refused at start-up" {
  "$server" --port 0 >"$BATS_TEST_TMPDIR/out" 2>/dev/null 3>&- &
  for _ in {1..50}; do [[ ! -s $BATS_TEST_TMPDIR/out ]] || break; sleep 0.1; done
  request -H 'Origin: https://a.example' "$(sed 's/listening on //' "$BATS_TEST_TMPDIR/out")/v1/info"
  [ "$status" = 200 ]
  [ -z "$(header Access-Control-Allow-Origin)" ]
  kill -TERM $!
  wait $!
  run "$server" --port 0 --cors-origins a.example
  [ "$status" = 1 ]
  [[ $output == *--cors-origins* ]]
}
