#!/usr/bin/env bats
# Stored meshes: the routes, entity tags and caches, and each kind of store.

load helpers

setup_file() { start_server; }
teardown_file() { stop_server; }

upload() { request -H "$draco" --data-binary @"${1:-$coarse}" "$url/v1/meshes"; }
coarse_id() { sha256sum <"$coarse" | cut -d' ' -f1; }

@test "a mesh is stored under its SHA-256, and described" {
  upload
  [ "$status" = 201 ]
  [ "$(field id)" = "$(coarse_id)" ]
  [ "$(header Location)" = "/v1/meshes/$(coarse_id)" ]
  [ "$(field faces)" = 600 ]
  [ "$(field bytes)" = "$(stat -c %s "$coarse")" ]
  upload
  [ "$status" = 200 ]
  [ "$(field id)" = "$(coarse_id)" ]
  request "$url$(header Location)"
  [ "$status" = 200 ]
  [ "$(header Content-Type)" = application/x-draco ]
  cmp "$body" "$coarse"
  request -H 'Accept: application/json' "$url/v1/meshes/$(coarse_id)"
  [ "$(field vertices)" = 302 ]
  [ "$(field refined)" = "/v1/meshes/$(coarse_id)/refined" ]
}

@test "a refinement of a stored mesh has the bytes of the one-shot request, by GET and by POST" {
  upload
  query='levels=3&flatness=0.9,0.95&view.eye=0,0,3&output.speed=5'
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?$query"
  cp "$body" "$BATS_TEST_TMPDIR/shot.drc"
  request "$url/v1/meshes/$(coarse_id)/refined?$query"
  [ "$status" = 200 ]
  cmp "$body" "$BATS_TEST_TMPDIR/shot.drc"
  [ -n "$(header Papilio-Faces)" ]
  request -H 'Content-Type: application/json' \
    -d '{"output":{"speed":5},"view":{"eye":[0,0,3]},"flatness":[0.9,0.95],"levels":3}' \
    "$url/v1/meshes/$(coarse_id)/refined"
  [ "$status" = 200 ]
  [ "$(header Cache-Control)" = no-store ]
  cmp "$body" "$BATS_TEST_TMPDIR/shot.drc"
}

@test "levels of a stored mesh are streamed as those of the one-shot request" {
  upload
  request -H 'Accept: multipart/mixed' "$url/v1/meshes/$(coarse_id)/refined?levels=2"
  [ "$status" = 200 ]
  [[ $(header Content-Type) == multipart/mixed* ]]
  [ "$(grep -ac '^Papilio-Faces: ' "$body")" = 3 ]
  [ -z "$(header ETag)" ]
}

@test "the entity tag is that of the canonical parameters, and 304 follows from it" {
  upload
  refined="$url/v1/meshes/$(coarse_id)/refined"
  request "$refined?levels=2&tension=soft&view.eye=0,0,3.0"
  [ "$status" = 200 ]
  tag=$(header ETag)
  [[ $tag == '"'*'"' ]]
  [[ $(header Cache-Control) == public,\ max-age=* ]]
  request "$refined?view.eye=0,0,3&growth=1" # the same in other words: 2 levels are the default, and so is the eye
  [ "$(header ETag)" = "$tag" ]
  [[ $(header Server-Timing) == *'refine;dur=0.000'* ]] # from the cache
  request -H "If-None-Match: $tag" "$refined?view.eye=0,0,3"
  [ "$status" = 304 ]
  [ "$(header ETag)" = "$tag" ]
  [ ! -s "$body" ]
  request -H "If-None-Match: \"other\", W/$tag" "$refined?view.eye=0,0,3"
  [ "$status" = 304 ]
  request -H 'If-None-Match: "other"' "$refined?view.eye=0,0,3"
  [ "$status" = 200 ]
  request "$refined?view.eye=0,0,4"
  [ "$(header ETag)" != "$tag" ]
  request -H 'Accept: application/octet-stream' "$refined?view.eye=0,0,3"
  [ "$(header ETag)" != "$tag" ] # another representation
}

@test "HEAD has the headers of GET and no body" {
  upload
  for path in "/v1/meshes/$(coarse_id)" "/v1/meshes/$(coarse_id)/refined?levels=1"; do
    request "$url$path"
    cp "$headers" "$BATS_TEST_TMPDIR/of_get"
    request -I "$url$path"
    [ "$status" = 200 ]
    diff <(grep -viE '^(date|x-request-id|server-timing)' "$BATS_TEST_TMPDIR/of_get") \
      <(grep -viE '^(date|x-request-id|server-timing)' "$headers")
  done
}

@test "a deleted mesh is gone, its results too" {
  upload
  request "$url/v1/meshes/$(coarse_id)/refined?levels=1"
  [ "$status" = 200 ]
  request -X DELETE "$url/v1/meshes/$(coarse_id)"
  [ "$status" = 204 ]
  for path in "" /refined '/refined?levels=1'; do
    request "$url/v1/meshes/$(coarse_id)$path"
    expect_problem 404 mesh_not_found
  done
  request -X DELETE "$url/v1/meshes/$(coarse_id)"
  expect_problem 404 mesh_not_found
}

@test "what is no mesh is not stored, and what is no id is not found" {
  printf 'solid cube' >"$BATS_TEST_TMPDIR/solid"
  upload "$BATS_TEST_TMPDIR/solid"
  expect_problem 422 mesh_not_draco
  request "$url/v1/meshes/$(sha256sum <"$BATS_TEST_TMPDIR/solid" | cut -d' ' -f1)"
  expect_problem 404 mesh_not_found
  for id in x ../../etc/passwd %2e%2e%2fetc%2fpasswd "$(coarse_id | tr a-f A-F)" "$(coarse_id)0"; do
    request --path-as-is "$url/v1/meshes/$id"
    [ "$status" = 404 ]
  done
  request -H "$draco" --data-binary @"$coarse" "$url/v1/meshes?levels=1"
  expect_problem 400 unknown_parameter
  request --data-binary @"$coarse" "$url/v1/meshes"
  expect_problem 415 unsupported_media_type
}

@test "each refusal of a refinement comes for stored meshes too" {
  upload
  refined="$url/v1/meshes/$(coarse_id)/refined"
  request "$refined?level=1"
  expect_problem 400 unknown_parameter
  request "$refined?levels=1&levels=1"
  expect_problem 400 bad_parameter
  request -H 'Accept: text/html' "$refined"
  expect_problem 406 not_acceptable
  request "$refined?levels=9"
  expect_problem 507 result_too_large
  request -H 'Content-Type: application/json' -d '{"levels": "many"}' "$refined"
  expect_problem 400 bad_parameter
  request -H 'Content-Type: text/plain' -d '{}' "$refined"
  expect_problem 415 unsupported_media_type
  request -H 'Content-Type: application/json' -d '{}' "$refined?levels=1"
  expect_problem 400 bad_request
}

@test "equal requests in flight are computed once" {
  stop_server
  start_server --slots 2
  upload
  requests=()
  for i in {1..6}; do requests+=(-o "$BATS_TEST_TMPDIR/$i.drc" "$url/v1/meshes/$(coarse_id)/refined?levels=6"); done
  curl -sS --noproxy '*' --parallel --parallel-immediate --parallel-max 6 "${requests[@]}"
  for i in {2..6}; do cmp "$BATS_TEST_TMPDIR/1.drc" "$BATS_TEST_TMPDIR/$i.drc"; done
  request "$url/metrics"
  [ "$(sed -n 's/^papilio_stage_seconds_count{stage="refine"} //p' "$body")" = 1 ]
}

@test "the memory store forgets what was used longest ago" {
  stop_server
  start_server --store-bytes 5000 # two of them, with what an entry takes, and not three
  for faces in 1 2 3; do
    "$papilio" refine "$coarse" -o "$BATS_TEST_TMPDIR/$faces.drc" --levels 0 --output.position_bits $((8 + faces))
    upload "$BATS_TEST_TMPDIR/$faces.drc"
    [ "$status" = 201 ]
  done
  request "$url/v1/meshes/$(sha256sum <"$BATS_TEST_TMPDIR/1.drc" | cut -d' ' -f1)"
  expect_problem 404 mesh_not_found
  request "$url/v1/meshes/$(sha256sum <"$BATS_TEST_TMPDIR/3.drc" | cut -d' ' -f1)"
  [ "$status" = 200 ]
  "$papilio" refine "$coarse" -o "$BATS_TEST_TMPDIR/large.drc" --levels 2
  upload "$BATS_TEST_TMPDIR/large.drc"
  expect_problem 507 store_full
}

@test "the directory store outlives kill -9, and says so when it is full or damaged" {
  stop_server
  store=$BATS_TEST_TMPDIR/meshes
  start_server --store "directory:$store"
  upload
  [ "$status" = 201 ]
  kill -KILL "$server_pid"
  wait "$server_pid" || true
  mkdir -p "$store/00"
  touch -d '1 hour ago' "$store/00/1-2.part" # what an interrupted write leaves
  start_server --store "directory:$store" --store-bytes 2000
  [ ! -e "$store/00/1-2.part" ]
  request "$url/v1/meshes/$(coarse_id)"
  cmp "$body" "$coarse"
  "$papilio" refine "$coarse" -o "$BATS_TEST_TMPDIR/other.drc" --levels 0
  upload "$BATS_TEST_TMPDIR/other.drc"
  expect_problem 507 store_full
  file=$store/$(coarse_id | cut -c1-2)/$(coarse_id).drc
  printf 'x' | dd of="$file" bs=1 seek=700 conv=notrunc status=none
  request "$url/v1/meshes/$(coarse_id)"
  expect_problem 404 mesh_not_found
  grep -q 'the content is not what the name says' "$BATS_FILE_TMPDIR/server.log"
  upload # it can be sent again
  [ "$status" = 201 ]
  request "$url/v1/meshes/$(coarse_id)"
  cmp "$body" "$coarse"
  [ -z "$(find "$store" -name '*.part')" ]
}

@test "kill -9 in the middle of uploads leaves whole meshes only" {
  stop_server
  store=$BATS_TEST_TMPDIR/meshes
  for round in 1 2 3; do
    start_server --store "directory:$store"
    for bits in {8..16}; do
      (
        "$papilio" refine "$coarse" -o "$BATS_TEST_TMPDIR/$round-$bits.drc" --levels "$round" --output.position_bits "$bits"
        curl -s --noproxy '*' -o /dev/null -w '%{http_code}' -H "$draco" \
          --data-binary @"$BATS_TEST_TMPDIR/$round-$bits.drc" "$url/v1/meshes" >"$BATS_TEST_TMPDIR/$round-$bits.code"
      ) 3>&- &
    done
    sleep 0.0$round
    kill -KILL "$server_pid"
    wait || true
  done
  while read -r file; do [ "$(sha256sum <"$file" | cut -d' ' -f1)" = "$(basename "$file" .drc)" ]; done \
    < <(find "$store" -name '*.drc')
  start_server --store "directory:$store"
  for code in "$BATS_TEST_TMPDIR"/*.code; do # what was acknowledged is there
    grep -q 201 "$code" || continue
    request "$url/v1/meshes/$(sha256sum <"${code%.code}.drc" | cut -d' ' -f1)"
    [ "$status" = 200 ]
  done
}

@test "a store that cannot be opened is refused in words, without its password" {
  run "$server" --port 0 --store directory:/proc/nothing
  [ "$status" = 1 ]
  [[ $output == *"/proc/nothing"* ]]
  run "$server" --port 0 --store ftp://user:secret@host/
  [ "$status" = 1 ]
  [[ $output == *"--store"* && $output != *secret* ]]
}

# start_redis [ARGUMENT...]: sets $redis_port and $redis_pid.
start_redis() {
  redis_port=${redis_port:-$(python3 -c 'import socket; s=socket.socket(); s.bind(("127.0.0.1",0)); print(s.getsockname()[1])')}
  redis-server --port "$redis_port" --bind 127.0.0.1 --save '' --appendonly yes --dir "$BATS_TEST_TMPDIR" "$@" \
    >"$BATS_TEST_TMPDIR/redis.log" 2>&1 3>&- &
  redis_pid=$!
  for _ in {1..100}; do
    [[ $(redis-cli -p "$redis_port" ${redis_password:+--no-auth-warning -a "$redis_password"} ping 2>/dev/null) != PONG ]] || return 0
    sleep 0.1
  done
  cat "$BATS_TEST_TMPDIR/redis.log" >&2
  return 1
}
stop_redis() {
  kill -TERM "$redis_pid"
  wait "$redis_pid" || true
}

@test "Redis: shared by servers, with a life that use prolongs" {
  stop_server
  redis_password=of-the-test
  start_redis --requirepass "$redis_password"
  store=redis://:$redis_password@127.0.0.1:$redis_port/3
  start_server --store "$store" --store-seconds 1000
  first=$url
  first_pid=$server_pid
  upload
  [ "$status" = 201 ]
  key=papilio:mesh:$(coarse_id)
  ask_redis() { redis-cli --no-auth-warning -a "$redis_password" -p "$redis_port" -n 3 "$@"; }
  (($(ask_redis ttl "$key") > 990))
  ask_redis expire "$key" 5
  start_server --store "$store" --store-seconds 1000
  request "$url/v1/meshes/$(coarse_id)"
  cmp "$body" "$coarse"
  (($(ask_redis ttl "$key") > 990)) # it was used
  upload
  [ "$status" = 200 ]
  request -X DELETE "$url/v1/meshes/$(coarse_id)"
  [ "$status" = 204 ]
  request "$first/v1/meshes/$(coarse_id)"
  expect_problem 404 mesh_not_found
  kill -TERM "$first_pid"
  wait "$first_pid"
  stop_redis
}

@test "Redis away: a clear 503 while it is, nothing lost once it is back" {
  stop_server
  start_redis
  start_server --store "redis://127.0.0.1:$redis_port"
  upload
  [ "$status" = 201 ]
  request "$url/v1/meshes/$(coarse_id)/refined?levels=1"
  [ "$status" = 200 ]
  stop_redis
  request "$url/v1/meshes/$(coarse_id)"
  expect_problem 503 store_unavailable
  [[ $(header Retry-After) =~ ^[0-9]+$ ]]
  upload
  expect_problem 503 store_unavailable
  request -X DELETE "$url/v1/meshes/$(coarse_id)"
  expect_problem 503 store_unavailable
  request "$url/v1/meshes/$(coarse_id)/refined?levels=1" # still in the cache
  [ "$status" = 200 ]
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=1" # needs no store
  [ "$status" = 200 ]
  server_is_well
  start_redis
  request "$url/v1/meshes/$(coarse_id)"
  [ "$status" = 200 ]
  cmp "$body" "$coarse"
  stop_redis
}

@test "Redis full: refused by our limit and by its own" {
  stop_server
  start_redis --maxmemory 3mb --maxmemory-policy noeviction
  start_server --store "redis://127.0.0.1:$redis_port" --store-bytes 1024
  upload
  expect_problem 507 store_full
  stop_server
  start_server --store "redis://127.0.0.1:$redis_port"
  redis-cli -p "$redis_port" setrange fill 4000000 x >/dev/null || true
  upload
  expect_problem 507 store_full
  stop_redis
}
