# Shared by the integration tests: the built programs, a server on a free port, and requests that record answers.
# shellcheck shell=bash

papilio=$PAPILIO_BUILD/papilio
server=$PAPILIO_BUILD/papilio-server
coarse=$PAPILIO_MESHES/bunny600.drc
draco='Content-Type: application/x-draco'

# start_server [ARGUMENT...]: sets $url and $server_pid. Port 0: the system chooses a free one.
start_server() {
  rm -f "$BATS_FILE_TMPDIR/server.out"
  "$server" --port 0 "$@" >"$BATS_FILE_TMPDIR/server.out" 2>"$BATS_FILE_TMPDIR/server.log" 3>&- &
  server_pid=$!
  for _ in {1..100}; do
    [[ ! -s $BATS_FILE_TMPDIR/server.out ]] || break
    sleep 0.1
  done
  url=$(sed -n '1s/^listening on \(https\?:.*\)$/\1/p' "$BATS_FILE_TMPDIR/server.out")
  [[ -n $url ]] || { cat "$BATS_FILE_TMPDIR/server.log" >&2; return 1; }
  export url server_pid
}

# stop_server: sends SIGTERM, and expects exit status 0 after draining.
stop_server() {
  kill -TERM "$server_pid"
  wait "$server_pid"
}

sanitized() { grep -q '^PAPILIO_SANITIZE:STRING=.' "$PAPILIO_BUILD/CMakeCache.txt"; }

# skip_if_sanitized: for tests whose results do not depend on the build.
skip_if_sanitized() {
  ! sanitized || skip "the release build runs it"
}

# free_port: prints an unused port.
free_port() { python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }

# request ARGUMENT...: runs curl; sets $status, and the files $headers and $body.
request() {
  headers=$BATS_TEST_TMPDIR/headers
  body=$BATS_TEST_TMPDIR/body
  rm -f "$headers" "$body"
  status=$(curl -sS --noproxy '*' --max-time 60 -D "$headers" -o "$body" -w '%{http_code}' "$@")
}

header() { tr -d '\r' <"$headers" | sed -n "s/^$1: *//Ip" | tail -1; }
field() { jq -r ".$1" "$body"; }

# expect_problem STATUS CODE: expects a complete problem document with the request's id that must not be cached.
expect_problem() {
  [[ $status == "$1" ]] || { echo "status $status, not $1"; head -c 500 "$body" | cat -v; return 1; }
  [[ $(header Content-Type) == application/problem+json ]]
  [[ $(header Cache-Control) == no-store ]]
  [[ $(field code) == "$2" ]] || { echo "code $(field code), not $2"; return 1; }
  [[ $(field status) == "$1" ]]
  [[ $(field type) == "urn:papilio:problem:$2" ]]
  [[ $(field request_id) == "$(header X-Request-Id)" && -n $(header X-Request-Id) ]]
  local detail
  detail=$(field detail)
  ((${#detail} > 20)) || { echo "detail: $detail"; return 1; }
}

# upload [FILE]: stores a mesh. coarse_id: prints the id of the coarse mesh.
upload() { request -H "$draco" --data-binary @"${1:-$coarse}" "$url/v1/meshes"; }
coarse_id() { sha256sum <"$coarse" | cut -d' ' -f1; }

# decoded_faces FILE: prints the number of faces, by Debian's independent decoder.
decoded_faces() {
  draco_decoder -i "$1" -o "$BATS_TEST_TMPDIR/decoded.obj" >/dev/null
  grep -c '^f ' "$BATS_TEST_TMPDIR/decoded.obj"
}

# eventually COMMAND...: retries until success, for at most 20 s. (A request is counted and logged after its answer.)
eventually() {
  for _ in {1..200}; do
    if "$@"; then return 0; fi
    sleep 0.1
  done
  return 1
}

# Expects that the server still runs and answers.
server_is_well() {
  [[ $(curl -sS --noproxy '*' --max-time 10 "$url/health" | jq -r .status) == alive ]]
}

# exchange PORT: sends standard input unchanged, and prints the answer. Fails unless the peer closes or resets the
# connection. Ignores unsent input if the peer closes early.
exchange() {
  local fd
  exec {fd}<>"/dev/tcp/127.0.0.1/$1"
  cat 2>/dev/null >&"$fd" || true
  until_closed "$fd"
  exec {fd}>&-
}
until_closed() { timeout 30 cat <&"$1" 2>/dev/null || (($? != 124)); }
