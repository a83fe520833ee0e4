#!/usr/bin/env bats
# docker/compose.yaml as README starts it: nginx, two servers, one Redis; and what happens when one of them goes.

bats_require_minimum_version 1.5.0
load helpers

compose() { docker-compose -p papilio-test -f "$BATS_TEST_DIRNAME/../../docker/compose.yaml" "$@" 2>&1 3>&-; }
# id SERVICE: of its container. address SERVICE: where it is, beside the proxy.
id() { compose ps -q "$1" | tail -1; }
address() { echo "http://$(inspect "$(id "$1")" '{{range .NetworkSettings.Networks}}{{.IPAddress}}{{end}}'):8080"; }

light=('levels=3&tolerance=0.01' 'levels=3&tolerance=0.005' 'levels=3&tolerance=0.002' 'levels=3&tolerance=0.001')
heavy=('levels=5' 'levels=6')
right() { echo "$BATS_FILE_TMPDIR/$1.drc"; }

setup_file() {
  PAPILIO_PORT=$(free_port)
  export PAPILIO_PORT
  export url=http://127.0.0.1:$PAPILIO_PORT
  compose up -d --no-build >"$BATS_FILE_TMPDIR/up.log" || { cat "$BATS_FILE_TMPDIR/up.log" >&2; return 1; }
  first=$(address server-a)
  second=$(address server-b)
  export first second
  eventually answers "$url"
  eventually answers "$first"
  eventually answers "$second"
  # What the load's questions are answered with, by this machine's own build.
  local query
  for query in "${light[@]}" "${heavy[@]}"; do
    # shellcheck disable=SC2086,SC2046 # name=value&name=value as flags and their values
    "$papilio" refine "$coarse" -o "$(right "$query")" $(tr '&=' '  ' <<<"&$query" | sed -E 's/ ([a-z]+) ([^ ]+)/--\1 \2 /g')
  done
}
teardown_file() { compose down -v --timeout 5 >/dev/null; }

# What podman starts again has a new hardware address, and gives no notice of it: the others' kernels would look for the
# old one for up to a minute.
forget_hardware_addresses() {
  local container
  for container in $(compose ps -q); do
    nsenter --net --target "$(inspect "$container" '{{.State.Pid}}')" ip neigh flush all 2>/dev/null || true
  done
}

# started_again COMMAND...: in time it succeeds.
started_again() {
  forget_hardware_addresses
  eventually "$@"
}

# kill_container ID: its process, without a warning; returns when the engine has started it again.
kill_container() {
  local victim
  victim=$(inspect "$1" '{{.State.Pid}}')
  kill -KILL "$victim"
  is_another() { [[ $(inspect "$1" '{{.State.Status}}') == running && $(inspect "$1" '{{.State.Pid}}') != "$victim" ]]; }
  eventually is_another "$1"
}

proxy_reaches() {
  local host=${1#http://}
  timeout 5 podman exec "$(id proxy)" bash -c "exec 3<>/dev/tcp/${host%:*}/${host#*:}" 2>/dev/null
}

# start_load QUERY...: four clients ask these in turn, each up to five times a second, until stop_load. A line each:
# curl's exit status, the answer's, and right or wrong.
start_load() {
  load_log=$BATS_TEST_TMPDIR/load
  : >"$load_log"
  touch "$BATS_TEST_TMPDIR/loading"
  load_pids=()
  local client
  for client in 1 2 3 4; do
    load_client "$client" "$@" 3>&- &
    load_pids+=($!)
  done
}
load_client() {
  local answer=$BATS_TEST_TMPDIR/load-$1 number=$1 queries=("${@:2}") query exit_status code verdict
  while [[ -e $BATS_TEST_TMPDIR/loading ]]; do
    query=${queries[number++ % ${#queries[@]}]}
    exit_status=0
    code=$(curl -sS --noproxy '*' --max-time 60 -H "$draco" --data-binary @"$coarse" -o "$answer" -w '%{http_code}' \
      "$url/v1/refine?$query" 2>/dev/null) || exit_status=$?
    verdict=right
    cmp -s "$answer" "$(right "$query")" || verdict=wrong
    echo "$exit_status $code $verdict" >>"$load_log"
    sleep 0.2
  done
}
stop_load() {
  rm "$BATS_TEST_TMPDIR/loading"
  wait "${load_pids[@]}"
  echo "# $(sort "$load_log" | uniq -c | awk '{ print $1 " x (curl " $2 ", " $3 ", " $4 ")" }' | paste -sd ' ')" >&3
}

@test "through the proxy: refined to the same bytes, the page, and every answer's own headers" {
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=3&tolerance=0.001"
  [ "$status" = 200 ]
  cmp "$body" "$(right "${light[3]}")"
  [ "$(header Papilio-Faces)" = "$(decoded_faces "$body")" ]
  request "$url/"
  [[ $status == 200 && $(header Content-Type) == text/html* ]]
  request "$url/metrics"
  [ "$status" = 404 ]
}

@test "what one server stored the other refines, and the proxy keeps it" {
  request -H "$draco" --data-binary @"$coarse" "$first/v1/meshes"
  [ "$status" = 201 ]
  request "$second/v1/meshes/$(coarse_id)/refined?levels=3&tolerance=0.001"
  [ "$status" = 200 ]
  cmp "$body" "$(right "${light[3]}")"
  local etag
  etag=$(header ETag)
  request "$url/v1/meshes/$(coarse_id)/refined?levels=3&tolerance=0.001"
  [[ $status == 200 && $(header X-Cache-Status) == MISS && $(header ETag) == "$etag" ]]
  request "$url/v1/meshes/$(coarse_id)/refined?levels=3&tolerance=0.001"
  [[ $status == 200 && $(header X-Cache-Status) == HIT && $(header ETag) == "$etag" ]]
  cmp "$body" "$(right "${light[3]}")"
  request -H "If-None-Match: $etag" "$url/v1/meshes/$(coarse_id)/refined?levels=3&tolerance=0.001"
  [ "$status" = 304 ]
}

@test "both servers work" {
  served() { curl -sS --noproxy '*' "$1/metrics" | awk '/^papilio_requests_total.*refine"/ { n += $2 } END { print n + 0 }'; }
  local before_first before_second
  before_first=$(served "$first") before_second=$(served "$second")
  start_load "${light[@]}"
  sleep 4
  stop_load
  (($(served "$first") > before_first && $(served "$second") > before_second))
  run -1 grep -v '^0 200 right$' "$load_log"
}

@test "kill -9 of one server under load: no request fails, none is wrong, and it comes back" {
  start_load "${heavy[@]}"
  sleep 2
  kill_container "$(id server-a)"
  sleep 5
  stop_load
  # An answer that was under way cannot be asked for again: curl says so (18), and has no whole mesh.
  run -1 grep -v -e '^0 200 right$' -e '^18 200 wrong$' "$load_log"
  (($(grep -c '^18 ' "$load_log") <= 4))
  (($(grep -c right "$load_log") > 8)) # two for each client, also on a busy machine
  started_again answers "$first"
}

@test "Redis away: 503 that says so, and what needs no store goes on; back again: nothing acknowledged is lost" {
  local other=$PAPILIO_MESHES/cgal/elephant.off stored=$BATS_TEST_TMPDIR/stored.drc id
  "$papilio" convert "$other" "$stored"
  id=$(sha256sum <"$stored" | cut -d' ' -f1)
  request -H "$draco" --data-binary @"$stored" "$url/v1/meshes"
  [ "$status" = 201 ]
  compose stop store >/dev/null
  request "$url/v1/meshes/$id"
  expect_problem 503 store_unavailable
  [ -n "$(header Retry-After)" ]
  request -H "$draco" --data-binary @"$coarse" "$url/v1/meshes"
  expect_problem 503 store_unavailable
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=3&tolerance=0.001"
  [ "$status" = 200 ]
  cmp "$body" "$(right "${light[3]}")"
  compose start store >/dev/null
  local server
  for server in "$first" "$second"; do
    found() { request "$server/v1/meshes/$id" && [[ $status == 200 ]]; }
    started_again found
    cmp "$body" "$stored"
  done
}

@test "Redis killed: nothing acknowledged is lost" {
  local number mesh=$BATS_TEST_TMPDIR/mesh.drc ids=()
  for number in 8 9 10 11 12; do # the same shape on other grids: other bytes
    "$papilio" refine "$coarse" -o "$mesh" --levels 1 --output.position_bits "$number"
    request -H "$draco" --data-binary @"$mesh" "$url/v1/meshes"
    [ "$status" = 201 ]
    ids+=("$(field id)")
  done
  kill_container "$(id store)"
  for number in "${ids[@]}"; do
    found() { request "$url/v1/meshes/$number" && [[ $status == 200 ]]; }
    started_again found
    [ "$(sha256sum <"$body" | cut -d' ' -f1)" = "$number" ]
  done
}

# start_stream NUMBER: one of all levels, read slowly enough to be under way for some seconds.
start_stream() {
  curl -sS --noproxy '*' -N --limit-rate 1M --max-time 120 -H "$draco" -H 'Accept: multipart/mixed' --data-binary @"$coarse" \
    -o "$BATS_TEST_TMPDIR/stream-$1" "$url/v1/refine?levels=6" 3>&- &
  streams+=($!)
}

# start_work SERVER: what it needs some seconds for, and says no to others in when it shuts down.
start_work() {
  local number
  for number in 1 2 3 4; do
    curl -sS --noproxy '*' -H "$draco" --data-binary @"$coarse" -o /dev/null -w '%{http_code}\n' \
      "$1/v1/refine?levels=6&output.normals=true&w=0.0$number" >>"$BATS_TEST_TMPDIR/work" 3>&- &
    work+=($!)
  done
}

@test "rolling restart: no stream is dropped, no request fails" {
  streams=() work=()
  start_load "${light[@]}"
  local number
  for number in 1 2; do start_stream "$number"; done
  start_work "$first"
  sleep 1
  compose restart --timeout 40 server-a >/dev/null
  started_again proxy_reaches "$first"
  sleep 11 # fail_timeout, for which nginx leaves out a server that was away
  for number in 3 4; do start_stream "$number"; done
  start_work "$second"
  sleep 1
  compose restart --timeout 40 server-b >/dev/null
  started_again proxy_reaches "$second"
  stop_load
  for number in "${streams[@]}" "${work[@]}"; do wait "$number"; done
  [ "$(grep -c '^200$' "$BATS_TEST_TMPDIR/work")" = 8 ]
  for number in 1 2 3 4; do
    grep -aq '"stop_reason"' "$BATS_TEST_TMPDIR/stream-$number" # the summary, the last part
    # The finest level, as it is without a stream, is in it.
    python3 - "$BATS_TEST_TMPDIR/stream-$number" "$(right levels=6)" <<'END'
import sys
stream, last = (open(name, "rb").read() for name in sys.argv[1:])
assert last in stream, "the last level is not there"
END
  done
  run -1 grep -v '^0 200 right$' "$load_log"
}
