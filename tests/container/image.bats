#!/usr/bin/env bats
# docker/Dockerfile: what the image is, and that a container of it is a good citizen.

bats_require_minimum_version 1.5.0
load helpers

teardown() { podman rm --all --force --time 2 >/dev/null; }

@test "the image says what it is, and starts the server itself" {
  local version
  version=$("$server" --version | cut -d' ' -f2)
  [ "$(podman image inspect --format '{{json .Config.Entrypoint}}' papilio)" = '["papilio-server"]' ]
  [ "$(podman image inspect --format '{{.Config.User}}' papilio)" = 10001:10001 ]
  [ "$(podman image inspect --format '{{.Config.StopSignal}}' papilio)" = SIGTERM ]
  [ "$(podman image inspect --format '{{index .Config.Labels "org.opencontainers.image.version"}}' papilio)" = "$version" ]
  [ "$(podman image inspect --format '{{index .Config.Labels "org.opencontainers.image.licenses"}}' papilio)" = Apache-2.0 ]
  # Nothing of where it was built.
  [ "$(podman image inspect --format '{{join .Config.Env "\n"}}' papilio | cut -d= -f1 | sort | paste -sd' ')" = "PAPILIO_HOST PAPILIO_LOG_FORMAT PATH" ]
  [ "$(podman run --rm --no-healthcheck --network none papilio --version)" = "papilio-server $version" ]
}

@test "the image has no compiler, no node, no package lists and nothing else to build with" {
  run podman run --rm --no-healthcheck --network none --entrypoint sh papilio -c \
    'ls /var/lib/apt/lists; for tool in cc c++ gcc cmake ninja node npm python3 curl git; do command -v $tool; done; true'
  [ "$status" = 0 ]
  [ -z "$output" ]
  # Beside Debian itself it takes less than 64 MB.
  local debian
  debian=$(sed -n 's/^ARG DEBIAN=//p' "$BATS_TEST_DIRNAME/../../docker/Dockerfile")
  (($(podman image inspect --format '{{.Size}}' papilio) - $(podman image inspect --format '{{.Size}}' "$debian") < 64000000))
}

@test "without keys a container that others can reach does not start, and says what to do" {
  run podman run --rm --no-healthcheck --network none papilio
  [ "$status" = 2 ]
  [[ $output == *--keys* && $output == *--allow-open* ]]
}

@test "it runs as nobody, writes nothing, and refines to the same bytes as outside" {
  start_container --
  local pid
  pid=$(inspect "$container" '{{.State.Pid}}')
  [ "$(awk '/^Uid:/ { print $2, $3 }' "/proc/$pid/status")" = "10001 10001" ]
  [ "$(awk '/^CapEff:/ { print $2 }' "/proc/$pid/status")" = 0000000000000000 ]
  "$papilio" refine "$coarse" -o "$BATS_TEST_TMPDIR/here.drc" --levels 3 --tolerance 0.001
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=3&tolerance=0.001"
  [ "$status" = 200 ]
  cmp "$body" "$BATS_TEST_TMPDIR/here.drc"
  request "$url/"
  [[ $status == 200 && $(header Content-Type) == text/html* ]]
  request -H "$draco" --data-binary @"$coarse" "$url/v1/meshes"
  [ "$status" = 201 ]
  run podman exec "$container" sh -c 'echo >/usr/share/papilio/new'
  [[ $status != 0 && $output == *"Read-only file system"* ]]
}

@test "its health check is papilio health, and the container engine sees it" {
  start_container --
  healthy() { podman healthcheck run "$container" >/dev/null; }
  eventually healthy
  podman pause "$container" >/dev/null
  run timeout 60 "$papilio" health --server "$url"
  [ "$status" != 0 ]
  podman unpause "$container" >/dev/null
  eventually healthy
}

@test "SIGTERM lets what runs finish, and the container ends with 0" {
  start_container --
  # Levels leave as they are made: the first is here while the last is not.
  curl -sS --noproxy '*' -N -H "$draco" -H 'Accept: multipart/mixed' --data-binary @"$coarse" -o "$BATS_TEST_TMPDIR/stream" \
    "$url/v1/refine?levels=6" &
  local curl_pid=$!
  begun() { [[ -s $BATS_TEST_TMPDIR/stream ]]; }
  eventually begun
  podman stop --time 30 "$container" >/dev/null
  wait "$curl_pid"
  [ "$(inspect "$container" '{{.State.ExitCode}}')" = 0 ]
  grep -aq '"stop_reason"' "$BATS_TEST_TMPDIR/stream" # the summary, the last part
}

@test "a container's cores and memory bound its slots and its memory" {
  start_container --memory 1g --cpus 1 --
  request "$url/metrics"
  grep -qx 'papilio_slots 1' "$body"
  local pid space
  pid=$(inspect "$container" '{{.State.Pid}}')
  space=$(awk '/Max data size/ { print $4 }' "/proc/$pid/limits")
  ((space > 900 << 20 && space < 1100 << 20)) # and the stacks
}

# large_requests: eight at once, of more than a container of 384 MB can hold; each is refused in words or right.
large_requests() {
  local running=() number
  for number in {1..8}; do
    curl -sS --noproxy '*' --max-time 300 -H "$draco" --data-binary @"$coarse" -o "$BATS_TEST_TMPDIR/answer$number" \
      -w '%{http_code}' "$url/v1/refine?levels=6&output.normals=true" >"$BATS_TEST_TMPDIR/code$number" 2>/dev/null &
    running+=($!)
  done
  wait "${running[@]}" || true
}

@test "at its memory's limit a container refuses in words, goes on, and gives no wrong answer" {
  "$papilio" refine "$coarse" -o "$BATS_TEST_TMPDIR/right.drc" --levels 6 --output.normals true
  start_container --memory 384m --memory-swap 384m -- --queue 16 --slots 2
  large_requests
  local number code refused=0
  for number in {1..8}; do
    code=$(cat "$BATS_TEST_TMPDIR/code$number")
    case $code in
      200) cmp "$BATS_TEST_TMPDIR/answer$number" "$BATS_TEST_TMPDIR/right.drc" ;;
      507)
        refused=$((refused + 1))
        [[ $(jq -r .code "$BATS_TEST_TMPDIR/answer$number") == @(out_of_memory|result_too_large) ]]
        ;;
      *) echo "status $code"; return 1 ;;
    esac
  done
  ((refused > 0))
  [ "$(inspect "$container" '{{.State.Status}} {{.State.OOMKilled}}')" = "running false" ]
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=2"
  [ "$status" = 200 ]
}

@test "a container that is killed for its memory starts again, and no answer was wrong" {
  "$papilio" refine "$coarse" -o "$BATS_TEST_TMPDIR/right.drc" --levels 6 --output.normals true
  # With a bound that is not the container's.
  start_container --memory 256m --memory-swap 256m --restart always -- --queue 16 --slots 2 --max-memory-bytes 20000000000
  large_requests
  local number killed=0
  for number in {1..8}; do
    case $(cat "$BATS_TEST_TMPDIR/code$number") in
      200) cmp "$BATS_TEST_TMPDIR/answer$number" "$BATS_TEST_TMPDIR/right.drc" ;;
      000) killed=$((killed + 1)) ;; # no answer at all
      *) cat "$BATS_TEST_TMPDIR/answer$number"; return 1 ;;
    esac
  done
  ((killed > 0))
  eventually answers "$url"
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=2"
  [ "$status" = 200 ]
}
