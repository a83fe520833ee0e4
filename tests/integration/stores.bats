#!/usr/bin/env bats
# Stores of meshes: memory, a directory, a real Redis. Results are computed once.

bats_require_minimum_version 1.5.0
load helpers

teardown() {
  if [[ -n ${server_pid:-} ]] && kill -0 "$server_pid" 2>/dev/null; then stop_server; fi
  if [[ -n ${redis_pid:-} ]]; then stop_redis; fi
  if [[ -n ${helper_pids:-} ]]; then
    kill -TERM "${helper_pids[@]}" 2>/dev/null || true
    wait "${helper_pids[@]}" || true
  fi
}

@test "equal simultaneous requests are computed once" {
  start_server --slots 2
  upload
  requests=()
  for i in {1..6}; do requests+=(-o "$BATS_TEST_TMPDIR/$i.drc" "$url/v1/meshes/$(coarse_id)/refined?levels=6"); done
  curl -sS --noproxy '*' --parallel --parallel-immediate --parallel-max 6 "${requests[@]}"
  for i in {2..6}; do cmp "$BATS_TEST_TMPDIR/1.drc" "$BATS_TEST_TMPDIR/$i.drc"; done
  request "$url/metrics"
  [ "$(sed -n 's/^papilio_stage_seconds_count{stage="refine"} //p' "$body")" = 1 ]
}

@test "equal requests share one slot, even with no place to wait" {
  start_server --slots 2 --queue 0
  upload
  requests=()
  for i in 1 2 3; do requests+=(-o "$BATS_TEST_TMPDIR/$i.drc" "$url/v1/meshes/$(coarse_id)/refined?levels=6"); done
  codes=$(curl -sS --noproxy '*' --parallel --parallel-immediate --parallel-max 3 -w '%{http_code} ' "${requests[@]}")
  [ "$codes" = '200 200 200 ' ]
}

@test "the memory store drops the least recently used" {
  start_server --store-bytes 3000 # two of them, with what an entry takes, and not three
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

@test "the directory store survives kill -9, and reports when it is full or damaged" {
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
  eventually grep -q 'the content is not what the name says' "$BATS_FILE_TMPDIR/server.log"
  upload # it can be sent again
  [ "$status" = 201 ]
  request "$url/v1/meshes/$(coarse_id)"
  cmp "$body" "$coarse"
  [ -z "$(find "$store" -name '*.part')" ]
}

# acknowledged_again: expects that a POST of the coarse mesh stores it, and that acknowledged meshes exist.
acknowledged_again() {
  upload
  [ "$status" = 201 ] || { echo "status $status"; return 1; }
  request "$url/v1/meshes/$(coarse_id)"
  cmp "$body" "$coarse"
  upload
  [ "$status" = 200 ]
}

put_folder_at() {
  rm "$1"
  mkdir "$1"
}

@test "the directory store: a POST replaces a damaged mesh, and a folder is no mesh" {
  store=$BATS_TEST_TMPDIR/meshes
  start_server --store "directory:$store"
  file=$store/$(coarse_id | cut -c1-2)/$(coarse_id).drc
  upload
  for damage in 'truncate -s 700' 'truncate -s 0' 'truncate -s +1' put_folder_at; do
    $damage "$file"
    acknowledged_again
    $damage "$file"
    request "$url/v1/meshes/$(coarse_id)"
    expect_problem 404 mesh_not_found
    acknowledged_again
  done
  rm "$file"
  mkdir "$file"
  touch "$file/of_others"
  request "$url/v1/meshes/$(coarse_id)"
  expect_problem 404 mesh_not_found
  request "$url/v1/meshes/$(coarse_id)/refined?levels=2"
  expect_problem 404 mesh_not_found
  upload
  expect_problem 503 store_unavailable
  grep -q "path=\"$file\" reason=\"a folder with files is in the place of a mesh; move it away" "$BATS_FILE_TMPDIR/server.log"
  [ -e "$file/of_others" ]
}

@test "kill -9 during uploads leaves only complete meshes" {
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

@test "a store that cannot be opened is refused with a message, without its password" {
  run "$server" --port 0 --store directory:/proc/nothing
  [ "$status" = 1 ]
  [[ $output == *"/proc/nothing"* ]]
  run "$server" --port 0 --store ftp://user:secret@host/
  [ "$status" = 1 ]
  [[ $output == *"--store"* && $output != *secret* ]]
}

# start_redis [ARGUMENT...]: sets $redis_port and $redis_pid.
start_redis() {
  redis_port=${redis_port:-$(free_port)}
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
  redis_pid=
}

@test "Redis: servers share meshes, and use extends their lifetime" {
  redis_password='of/the@test'
  start_redis --requirepass "$redis_password"
  store=redis://:of%2Fthe%40test@127.0.0.1:$redis_port/3
  start_server --store "$store" --store-seconds 1000
  first=$url
  first_pid=$server_pid
  upload
  [ "$status" = 201 ]
  key=papilio:mesh:$(coarse_id)
  ask_redis() { redis-cli --no-auth-warning -a "$redis_password" -p "$redis_port" -n 3 "$@"; }
  (($(ask_redis ttl "$key") > 990))
  request "$url/metrics"
  [ "$status" = 200 ]
  run ! grep '^papilio_store' "$body" # what it holds is not known here: no figure rather than a wrong one
  ask_redis expire "$key" 5
  start_server --store "$store" --store-seconds 1000
  request "$url/v1/meshes/$(coarse_id)"
  cmp "$body" "$coarse"
  (($(ask_redis ttl "$key") > 990)) # it was used
  upload
  [ "$status" = 200 ]
  ask_redis set "$key" damaged
  request "$url/v1/meshes/$(coarse_id)"
  expect_problem 404 mesh_not_found
  upload
  [ "$status" = 201 ]
  request -X DELETE "$url/v1/meshes/$(coarse_id)"
  [ "$status" = 204 ]
  request "$first/v1/meshes/$(coarse_id)"
  expect_problem 404 mesh_not_found
  kill -TERM "$first_pid"
  wait "$first_pid"
}

@test "Redis: 503 during an outage, and no data lost afterwards" {
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
  for _ in {1..50}; do # it is asked again once a second
    request "$url/v1/meshes/$(coarse_id)"
    [ "$status" = 503 ] || break
    sleep 0.1
  done
  [ "$status" = 200 ]
  cmp "$body" "$coarse"
  kill -STOP "$redis_pid" # it keeps silent
  request "$url/v1/meshes/$(coarse_id)"
  expect_problem 503 store_unavailable
  for _ in {1..8}; do curl -sS --noproxy '*' -o /dev/null "$url/v1/meshes/$(coarse_id)" 3>&- & done
  server_is_well
  kill -CONT "$redis_pid"
  for _ in {1..50}; do
    request "$url/v1/meshes/$(coarse_id)"
    [ "$status" = 503 ] || break
    sleep 0.1
  done
  [ "$status" = 200 ]
}

@test "Redis: a POST replaces damaged values and values of another type" {
  start_redis
  start_server --store "redis://127.0.0.1:$redis_port"
  key=papilio:mesh:$(coarse_id)
  upload
  [ "$status" = 201 ]
  for damage in "set $key short" "setrange $key 700 x" "append $key x" "lpush $key x"; do
    ask_redis() { redis-cli -p "$redis_port" "$@" >/dev/null; }
    [[ $damage != lpush* ]] || ask_redis del "$key"
    # shellcheck disable=SC2086 # several words
    ask_redis $damage
    acknowledged_again
    [[ $damage != lpush* ]] || ask_redis del "$key"
    # shellcheck disable=SC2086
    ask_redis $damage
    request "$url/v1/meshes/$(coarse_id)"
    expect_problem 404 mesh_not_found
    acknowledged_again
  done
}

# start_pair: starts a primary and a replica behind an address that forwards to the one named in the file `primary`.
start_pair() {
  for name in a b; do
    redis_port=$(free_port)
    mkdir "$BATS_TEST_TMPDIR/$name"
    start_redis --dir "$BATS_TEST_TMPDIR/$name" --appendonly no --repl-diskless-sync-delay 0
    helper_pids+=("$redis_pid")
    ports+=("$redis_port")
  done
  redis_pid=
  redis-cli -p "${ports[1]}" replicaof 127.0.0.1 "${ports[0]}" >/dev/null
  eventually follows "${ports[1]}"
  echo "${ports[0]}" >"$BATS_TEST_TMPDIR/primary"
  python3 "$BATS_TEST_DIRNAME/../support/switch_proxy.py" "$BATS_TEST_TMPDIR/primary" >"$BATS_TEST_TMPDIR/proxy" 3>&- &
  helper_pids+=($!)
  eventually test -s "$BATS_TEST_TMPDIR/proxy"
}
follows() { redis-cli -p "$1" info replication | grep -q '^master_link_status:up'; }
leads() { redis-cli -p "$1" role | grep -q '^master'; }

# write_until_told NAME FILE: deletes and stores a mesh repeatedly; NAME.code has the status of the last POST.
write_until_told() {
  for _ in {1..3000}; do
    curl -s --noproxy '*' -o /dev/null -X DELETE "$url/v1/meshes/$(sha256sum <"$2" | cut -d' ' -f1)" || true
    curl -s --noproxy '*' -o /dev/null -w '%{http_code}' -H "$draco" --data-binary @"$2" "$url/v1/meshes" >"$1.code"
    [[ ! -e $BATS_TEST_TMPDIR/enough ]] || break
  done
}

# is_written_anew: tests that the coarse mesh can be deleted and stored.
is_written_anew() {
  request -X DELETE "$url/v1/meshes/$(coarse_id)"
  [[ $status == 204 || $status == 404 ]] || return 1
  upload
  [[ $status == 201 ]]
}

@test "Redis: after a failover writes succeed without a restart, and no acknowledged mesh is lost" {
  start_pair
  start_server --store "redis://127.0.0.1:$(<"$BATS_TEST_TMPDIR/proxy")"
  is_written_anew
  writers=()
  for bits in 9 10 11; do
    "$papilio" refine "$coarse" -o "$BATS_TEST_TMPDIR/$bits.drc" --levels 0 --output.position_bits "$bits"
    write_until_told "$BATS_TEST_TMPDIR/$bits" "$BATS_TEST_TMPDIR/$bits.drc" 3>&- &
    writers+=($!)
    helper_pids+=($!)
  done
  for next in 1 0; do # a hand-over that waits for the replica
    redis-cli -p "${ports[1 - next]}" failover to 127.0.0.1 "${ports[next]}" >/dev/null
    eventually leads "${ports[next]}"
    echo "${ports[next]}" >"$BATS_TEST_TMPDIR/primary"
    eventually is_written_anew
    for _ in {1..5}; do is_written_anew; done
    eventually follows "${ports[1 - next]}"
  done
  touch "$BATS_TEST_TMPDIR/enough"
  wait "${writers[@]}"
  for bits in 9 10 11; do
    grep -q 201 "$BATS_TEST_TMPDIR/$bits.code"
    request "$url/v1/meshes/$(sha256sum <"$BATS_TEST_TMPDIR/$bits.drc" | cut -d' ' -f1)"
    cmp "$body" "$BATS_TEST_TMPDIR/$bits.drc"
  done
  redis-cli -p "${ports[1]}" replicaof no one >/dev/null # by an operator, with idle connections to the old primary
  redis-cli -p "${ports[0]}" replicaof 127.0.0.1 "${ports[1]}" >/dev/null
  upload
  [[ $status == 200 || $status == 503 ]] # the address still leads to the replica
  request "$url/v1/meshes/$(coarse_id)"
  [ "$status" = 200 ] # which answers reads
  echo "${ports[1]}" >"$BATS_TEST_TMPDIR/primary"
  eventually is_written_anew
}

@test "Redis full: refused by the server's limit and by Redis's own" {
  start_redis --maxmemory 3mb --maxmemory-policy noeviction
  start_server --store "redis://127.0.0.1:$redis_port" --store-bytes 1024
  upload
  expect_problem 507 store_full
  stop_server
  start_server --store "redis://127.0.0.1:$redis_port"
  redis-cli -p "$redis_port" setrange fill 4000000 x >/dev/null || true
  upload
  expect_problem 507 store_full
}
