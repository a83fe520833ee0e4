#!/usr/bin/env bats
# docker/nginx.conf in a real nginx in front of a real server: requests that it refuses, and those that it forwards.

bats_require_minimum_version 1.5.0
load helpers
PATH=$PATH:/usr/sbin # where nginx is

# start_proxy NAME [SED-EXPRESSION]...: starts nginx with the shipped files, on a free port, in front of $url; sets $proxy
# and $proxy_pid. Each expression must change nginx.conf or limits.conf.
start_proxy() {
  local folder=$BATS_FILE_TMPDIR/$1 before
  shift
  mkdir -p "$folder/conf"
  cp -r "$BATS_TEST_DIRNAME/../../docker/nginx.conf" "$BATS_TEST_DIRNAME/../../docker/nginx" "$folder/conf"
  local files=("$folder/conf/nginx.conf" "$folder/conf/nginx/limits.conf")
  for expression in "$@"; do
    before=$(md5sum "${files[@]}")
    sed -i "$expression" "${files[@]}"
    [[ $(md5sum "${files[@]}") != "$before" ]] || { echo "changes nothing: $expression" >&2; return 1; }
  done
  sed -i "s/127\.0\.0\.1:8080/${url#http://}/" "$folder/conf/nginx/upstream.conf"
  grep -qF "server ${url#http://} " "$folder/conf/nginx/upstream.conf"
  local as_root=()
  ((EUID != 0)) || as_root=(-g 'user root;') # the workers must get into the test's folder
  for _ in {1..20}; do # nginx takes no port 0
    proxy_port=$((RANDOM % 20000 + 20000))
    sed -i "s/^listen [0-9.:]*/listen 127.0.0.1:$proxy_port/" "$folder/conf/nginx/listen.conf"
    nginx -p "$folder" -c "$folder/conf/nginx.conf" "${as_root[@]}" >"$folder/access.log" 2>"$folder/error.log" 3>&- &
    proxy_pid=$!
    for _ in {1..100}; do
      if curl -sS --noproxy '*' -o "$folder/first" "http://127.0.0.1:$proxy_port/health" 2>/dev/null; then
        export proxy=http://127.0.0.1:$proxy_port proxy_port proxy_pid
        return 0
      fi
      kill -0 "$proxy_pid" 2>/dev/null || break
      sleep 0.1
    done
  done
  cat "$folder/error.log" >&2
  return 1
}

stop_proxy() {
  kill -TERM "$1"
  wait "$1" 2>/dev/null || true
}

# One server and one proxy for most tests, with shorter timeouts and more than 20 requests a second for an address.
setup_file() {
  start_server --max-body-bytes 70000000 --read-seconds 2 --slots 1 --queue 0
  start_proxy main 's/\(client_header_timeout\|client_body_timeout\) 10s/\1 2s/' 's/keepalive_timeout 15s/keepalive_timeout 1s/' \
    's/lingering_time 5s/lingering_time 1s/' 's/rate=20r/rate=100000r/' 's/burst=40/burst=10000/'
}
teardown_file() {
  stop_proxy "$proxy_pid"
  stop_server
}
teardown() { proxy_is_well; }

proxy_is_well() { [[ $(curl -sS --noproxy '*' --max-time 10 "$proxy/health" | jq -r .status) == alive ]]; }

logged() { grep -q "$1" "$BATS_FILE_TMPDIR/server.log"; }

@test "answers have the same bytes as without the proxy, in both forms" {
  for accept in application/x-draco multipart/mixed; do
    request -H "$draco" -H "Accept: $accept" --data-binary @"$coarse" "$url/v1/refine?levels=3"
    mv "$body" "$BATS_TEST_TMPDIR/direct"
    request -H "$draco" -H "Accept: $accept" --data-binary @"$coarse" "$proxy/v1/refine?levels=3"
    [ "$status" = 200 ]
    # The boundary is random, and times are measured.
    strip='/^--papilio/d; /^Server-Timing: /d; /^Content-Length: /d; /"milliseconds"/,/}/d'
    cmp <(sed "$strip" "$body") <(sed "$strip" "$BATS_TEST_TMPDIR/direct")
    [ -z "$(header X-Accel-Buffering)" ]
    [ "$(header Server)" = nginx ] # and no version
  done
}

@test "the viewer is served through the proxy: page, policy, and immutable compressed files" {
  request "$proxy/"
  [ "$status" = 200 ]
  [[ $(header Content-Security-Policy) == *"default-src 'none'"* && $(header Cache-Control) == no-cache ]]
  script=$(grep -o 'assets/index-[^"]*\.js' "$body")
  request -H 'Accept-Encoding: gzip' "$proxy/$script"
  [ "$(header Content-Encoding)" = gzip ]
  [[ $(header Cache-Control) == *immutable ]]
  gunzip <"$body" | cmp - "$PAPILIO_BUILD/web/$script"
  request "$proxy/v1/samples/mug"
  [ "$(decoded_faces "$body")" = 344 ]
}

@test "refusals of the server pass unchanged" {
  request -H "$draco" --data-binary @"$coarse" "$proxy/v1/refine?levels=11"
  expect_problem 400 bad_parameter
  request "$proxy/nowhere"
  expect_problem 404 not_found
  request -H "$draco" -H 'Range: bytes=0-9' --data-binary @"$coarse" "$proxy/v1/refine"
  expect_problem 416 range_not_supported
  request -H "$draco" -H 'Content-Encoding: gzip' --data-binary @"$coarse" "$proxy/v1/refine"
  expect_problem 415 unsupported_encoding
}

@test "a request id is kept through all hops; an invalid one is replaced" {
  request -H 'X-Request-Id: end-to-end.1' "$proxy/nowhere"
  [ "$(header X-Request-Id)" = end-to-end.1 ]
  eventually logged 'id=end-to-end.1 .*status=404'
  grep -q 'id=end-to-end.1 ' "$BATS_FILE_TMPDIR/main/access.log"
  request -H 'X-Request-Id: a b"c' "$proxy/nowhere"
  made=$(header X-Request-Id)
  [[ $made =~ ^[0-9a-f]{32}$ ]]
  eventually logged "id=$made "
}

@test "large headers, many headers and long addresses are refused" {
  request -H "X-Large: $(head -c 9000 /dev/zero | tr '\0' x)" "$proxy/health"
  expect_problem 431 headers_too_large
  many=()
  for i in {1..800}; do many+=(-H "X-$i: $(head -c 50 /dev/zero | tr '\0' x)"); done
  request "${many[@]}" "$proxy/health"
  expect_problem 431 headers_too_large
  request "$proxy/$(head -c 9000 /dev/zero | tr '\0' x)"
  expect_problem 414 uri_too_long
}

@test "slow request heads are closed without reaching the server, and others are served meanwhile" {
  local fds=() fd
  for _ in {1..50}; do
    exec {fd}<>"/dev/tcp/127.0.0.1/$proxy_port"
    printf 'GET /slow-head HTTP/1.1\r\nHost: x\r\nX-Drip: ' >&"$fd"
    fds+=("$fd")
  done
  proxy_is_well
  request -H "$draco" --data-binary @"$coarse" "$proxy/v1/refine?levels=0"
  [ "$status" = 200 ]
  for fd in "${fds[@]}"; do
    until_closed "$fd" >"$BATS_TEST_TMPDIR/answer"
    [ ! -s "$BATS_TEST_TMPDIR/answer" ]
    exec {fd}>&-
  done
  run ! logged slow-head
}

@test "a slow body is closed without reaching the server" {
  printf 'POST /slow-body HTTP/1.1\r\nHost: x\r\nContent-Length: 100\r\n\r\nDRACO' >"$BATS_TEST_TMPDIR/slow"
  exchange "$proxy_port" <"$BATS_TEST_TMPDIR/slow" >"$BATS_TEST_TMPDIR/answer"
  run ! logged slow-body
}

read_slowly() { # PATH: 100 KB a second for 15 seconds; nginx closes no connection meanwhile
  python3 -c 'import socket, sys, time
client = socket.create_connection(("127.0.0.1", int(sys.argv[1])))
client.sendall(b"GET %s HTTP/1.1\r\nHost: x\r\n\r\n" % sys.argv[2].encode())
for _ in range(150):
    time.sleep(0.1)
    if not client.recv(10000): sys.exit("closed")' "$proxy_port" "$1"
}

@test "a client that reads slowly but steadily is not disconnected" {
  { cat "$coarse" && head -c 20000000 /dev/zero; } >"$BATS_TEST_TMPDIR/large.drc" # no decoder minds what follows
  request -H "$draco" --data-binary @"$BATS_TEST_TMPDIR/large.drc" "$url/v1/meshes"
  local path kept_proxy=$proxy kept_port=$proxy_port kept_pid=$proxy_pid outcome=0
  path=$(header Location)
  start_proxy slow 's/send_timeout 30s/send_timeout 5s/'
  read_slowly "$path" || outcome=$?
  stop_proxy "$proxy_pid"
  proxy=$kept_proxy proxy_port=$kept_port proxy_pid=$kept_pid
  [ "$outcome" = 0 ]
}

@test "many simultaneous requests of one address: 429, while another address is served" {
  local fds=() fd
  for _ in {1..8}; do # nginx's limit_conn
    exec {fd}<>"/dev/tcp/127.0.0.1/$proxy_port"
    printf 'POST /slow-body HTTP/1.1\r\nHost: x\r\nContent-Length: 100\r\n\r\nDRACO' >&"$fd"
    fds+=("$fd")
  done
  too_many() { request "$proxy/health" && [[ $status == 429 ]]; }
  eventually too_many
  expect_problem 429 too_many_requests
  [ "$(header Retry-After)" = 1 ]
  request --interface 127.0.0.2 "$proxy/health"
  [ "$status" = 200 ]
  for fd in "${fds[@]}"; do exec {fd}>&-; done
  eventually proxy_is_well
}

@test "many requests a second of one address: 429, at the shipped rate" {
  many() { curl -sS --noproxy '*' --parallel --parallel-max 6 -o "$BATS_TEST_TMPDIR/#1" -w '%{http_code}\n' \
    "$proxy/v1/info?[1-300]" >"$BATS_TEST_TMPDIR/codes"; }
  beside rate "$url" many
  (($(grep -c 200 "$BATS_TEST_TMPDIR/codes") >= 40))
  (($(grep -c 429 "$BATS_TEST_TMPDIR/codes") > 0))
  [ "$(grep -cvE '200|429' "$BATS_TEST_TMPDIR/codes")" = 0 ]
  [ "$(grep -l too_many_requests "$BATS_TEST_TMPDIR"/[0-9]* | wc -l)" = "$(grep -c 429 "$BATS_TEST_TMPDIR/codes")" ]
}

@test "a large body is refused by its length, and in chunks" {
  head -c 68000000 /dev/zero >"$BATS_TEST_TMPDIR/large"
  request -H "$draco" --data-binary @"$BATS_TEST_TMPDIR/large" "$proxy/too-large"
  expect_problem 413 body_too_large
  request -H "$draco" -H 'Transfer-Encoding: chunked' --data-binary @"$BATS_TEST_TMPDIR/large" "$proxy/too-large"
  expect_problem 413 body_too_large
  run ! logged too-large
}

@test "metrics are not accessible from outside, in any spelling" {
  for path in /metrics //metrics /%6detrics /./metrics /x/../metrics '/metrics?x=1'; do
    request --path-as-is "$proxy$path"
    expect_problem 404 not_found
  done
  run ! logged metrics
}

# beside NAME URL COMMAND...: runs the command with a second nginx, $proxy, in front of the URL.
beside() {
  local name=$1 kept_url=$url kept_proxy=$proxy kept_pid=$proxy_pid outcome=0
  url=$2
  start_proxy "$name" 's/worker_processes auto/worker_processes 1/' || return # which keeps its connections to itself
  url=$kept_url
  "${@:3}" || outcome=$?
  stop_proxy "$proxy_pid"
  proxy=$kept_proxy
  proxy_pid=$kept_pid
  return "$outcome"
}

# beside_stub NAME COMMAND...: as beside, in front of tests/support/stub_server.py.
beside_stub() {
  local outcome=0
  python3 "$BATS_TEST_DIRNAME/../support/stub_server.py" >"$BATS_TEST_TMPDIR/stub" 3>&- &
  local stub_pid=$!
  eventually test -s "$BATS_TEST_TMPDIR/stub"
  beside "$1" "http://127.0.0.1:$(cat "$BATS_TEST_TMPDIR/stub")" "${@:2}" || outcome=$?
  kill "$stub_pid"
  wait "$stub_pid" 2>/dev/null || true
  return "$outcome"
}

@test "without a server: 502 as a problem document" {
  beside alone http://127.0.0.1:1 request_to /v1/info
  expect_problem 502 bad_gateway
}
request_to() { request "${@:2}" "$proxy$1"; }

@test "the server receives the trace, the real address and the id" {
  beside_stub seen request_to /x -H 'traceparent: 00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01' \
    -H 'X-Forwarded-For: 6.6.6.6' -H 'X-Request-Id: mine'
  grep -q '^traceparent: 00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01' "$body"
  grep -q '^X-Forwarded-For: 127.0.0.1' "$body"
  grep -q '^X-Request-Id: mine' "$body"
  run ! grep -q 6.6.6.6 "$body"
}

@test "a request whose connection fails is sent once more, including POST" {
  beside_stub retry request_to /drop --data-binary x # on the connection that start_proxy's question has left
  [ "$status" = 200 ]
  [ "$(header Count)" = 1 ]
}

@test "an unreachable server is skipped, including for POST" {
  # A socket with a full queue neither accepts nor refuses connections.
  python3 -c 'import socket, time
full = socket.socket()
full.bind(("127.0.0.1", 0))
full.listen(0)
waiting = [socket.socket() for _ in range(3)]
for one in waiting: one.setblocking(False) or one.connect_ex(full.getsockname())
print(full.getsockname()[1], flush=True)
time.sleep(60)' >"$BATS_TEST_TMPDIR/full" 3>&- &
  local full_pid=$! before=$proxy conf=$BATS_FILE_TMPDIR/passed/conf/nginx/upstream.conf
  eventually test -s "$BATS_TEST_TMPDIR/full"
  start_proxy passed
  sed -i "s/^  server .*/  server 127.0.0.1:$(<"$BATS_TEST_TMPDIR/full");\n  server ${url#http:\/\/};/" "$conf"
  kill -HUP "$proxy_pid"
  sleep 1
  for _ in 1 2 3; do
    request -H "$draco" --data-binary @"$coarse" "$proxy/v1/refine?levels=1"
    [ "$status" = 200 ]
  done
  grep -q 'upstream timed out' "$BATS_FILE_TMPDIR/passed/error.log" # it has been tried
  kill "$proxy_pid" "$full_pid"
  proxy=$before # for teardown
}

expect_cached() { # PATH STATUS [CURL-ARGUMENT...]
  request "${@:3}" "$proxy$1"
  [[ $status == 200 && $(header X-Cache-Status) == "$2" ]] || { echo "$1: $status $(header X-Cache-Status)"; return 1; }
}
use_cache() {
  local open=/v1/meshes/public_max-age=600/refined closed=/v1/meshes/private_max-age=600/refined
  expect_cached "$open?levels=1" MISS &&
    expect_cached "$open?levels=1" HIT &&
    expect_cached "$open?levels=1" HIT -I &&
    expect_cached "$open?levels=2" MISS &&
    expect_cached "$open?levels=1" BYPASS -H 'Authorization: Bearer x' &&
    expect_cached "$open?levels=3" BYPASS -H 'Authorization: Bearer x' &&
    expect_cached "$open?levels=3" MISS &&
    expect_cached "$closed?levels=1" MISS &&
    expect_cached "$closed?levels=1" MISS &&
    expect_cached /v1/meshes/max-age=600/refined MISS &&
    expect_cached /v1/meshes/max-age=600/refined MISS &&
    request -X POST --data-binary x "$proxy$open?levels=1" && [[ $(header Count) == 2 ]] &&
    request -H 'If-None-Match: "tag"' "$proxy$open?levels=1" && [[ $status == 304 && $(header X-Cache-Status) == HIT ]]
}
revalidate() {
  local short=/v1/meshes/public_max-age=1/refined
  expect_cached "$short" MISS && sleep 2.1 && expect_cached "$short" REVALIDATED && [[ -s $body ]]
}

@test "the cache holds only public answers" {
  beside_stub cache use_cache
}

@test "an expired cached answer is revalidated by its ETag" {
  beside_stub revalidate revalidate
}

@test "refinements of a stored mesh are computed once and then cached, including HEAD and 304" {
  request -H "$draco" --data-binary @"$coarse" "$proxy/v1/meshes"
  [[ $status == 201 || $status == 200 ]]
  refined="$proxy$(header Location)/refined?levels=2&w=0.01"
  request -H 'X-Request-Id: asked-first' "$refined"
  [ "$status" = 200 ]
  [ "$(header X-Cache-Status)" = MISS ]
  tag=$(header ETag)
  cp "$body" "$BATS_TEST_TMPDIR/first"
  request -H 'X-Request-Id: asked-second' "$refined"
  [ "$(header X-Cache-Status)" = HIT ]
  [ "$(header ETag)" = "$tag" ]
  cmp "$body" "$BATS_TEST_TMPDIR/first"
  request -I -H 'X-Request-Id: asked-third' "$refined"
  [ "$(header X-Cache-Status)" = HIT ]
  request -H "If-None-Match: $tag" -H 'X-Request-Id: asked-fourth' "$refined"
  [ "$status" = 304 ]
  request -H 'Accept: application/octet-stream' -H 'X-Request-Id: asked-otherwise' "$refined" # another representation
  [ "$(header X-Cache-Status)" = MISS ]
  [ "$(header ETag)" != "$tag" ]
  logged 'id=asked-first '
  logged 'id=asked-otherwise '
  ! logged 'id=asked-\(second\|third\|fourth\) '
}

@test "a stream's first level arrives before later ones exist; disconnecting stops the work" {
  mkfifo "$BATS_TEST_TMPDIR/stream"
  curl -sSN --noproxy '*' -o "$BATS_TEST_TMPDIR/stream" -H "$draco" -H 'Accept: multipart/mixed' -H 'X-Request-Id: streamer' \
    --data-binary @"$coarse" "$proxy/v1/refine?levels=6&flatness=1&growth=2&output.normals=true" 3>&- &
  running=$!
  exec 5<"$BATS_TEST_TMPDIR/stream"
  first=$(head -c 1000 <&5 | tr -d '\0')
  [[ $first == *'Papilio-Faces: 600'* ]]
  # Disconnect: if the last level had been made already, nothing would be truncated.
  kill -KILL "$running"
  wait "$running" || true
  exec 5<&-
  eventually logged 'id=streamer .*code=not_sent'
}

at_work() { request "$url/metrics" && grep -q '^papilio_slots_busy 1$' "$body"; }

@test "a busy answer of the server passes with Retry-After" {
  curl -sS --noproxy '*' -o /dev/null -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=6&flatness=1&growth=2&output.normals=true" 3>&- &
  running=$!
  eventually at_work
  request -H "$draco" --data-binary @"$coarse" "$proxy/v1/refine?levels=6"
  kill -KILL "$running"
  wait "$running" || true
  expect_problem 429 busy
  [ "$(header Retry-After)" = 1 ]
  idle() { ! at_work; }
  eventually idle
}

@test "a client that disconnects stops its work behind the proxy" {
  curl -sS --noproxy '*' -o /dev/null -H "$draco" -H 'X-Request-Id: leaver' --data-binary @"$coarse" \
    "$proxy/v1/refine?levels=6&flatness=1&growth=2&output.normals=true" 3>&- &
  running=$!
  eventually at_work
  kill -KILL "$running"
  wait "$running" || true
  eventually logged 'id=leaver .* status=499 .*code=cancelled'
}

# smuggle NAME HEAD BODY: sends both, with escapes of printf: one request whose body looks like another, or none.
smuggle() {
  # shellcheck disable=SC2059
  printf "$2\r\n\r\n$3" | exchange "$proxy_port" >"$BATS_TEST_TMPDIR/answer"
  if [[ $(grep -ac '^HTTP/1.1 [2-5]' "$BATS_TEST_TMPDIR/answer") != 1 ]] ||
    { grep -aq '^HTTP/1.1 [45]' "$BATS_TEST_TMPDIR/answer" && ! grep -aq '^Content-Type: application/problem+json' "$BATS_TEST_TMPDIR/answer"; }; then
    echo "$1:"
    cat "$BATS_TEST_TMPDIR/answer"
    return 1
  fi
}

@test "no request is smuggled through nginx" {
  # Control: a regular request with this name is logged.
  request "$proxy/admin-smuggled-control"
  eventually logged admin-smuggled-control
  local hidden='GET /admin-smuggled HTTP/1.1\r\nHost: x\r\n\r\n' length chunk post
  # shellcheck disable=SC2059
  length=$(printf "$hidden" | wc -c)
  post='POST /v1/refine HTTP/1.1\r\nHost: x\r\nContent-Type: application/x-draco'
  chunk="$(printf '%x' "$length")\r\n$hidden\r\n0\r\n\r\n"
  smuggle both "$post\r\nContent-Length: $((length + 5))\r\nTransfer-Encoding: chunked" "0\r\n\r\n$hidden"
  smuggle both-turned "$post\r\nTransfer-Encoding: chunked\r\nContent-Length: $((length + 5))" "0\r\n\r\n$hidden"
  smuggle two-lengths "$post\r\nContent-Length: $length\r\nContent-Length: 0" "$hidden"
  smuggle two-lengths-turned "$post\r\nContent-Length: 0\r\nContent-Length: $length" "$hidden"
  smuggle list "$post\r\nContent-Length: $length, 0" "$hidden"
  smuggle plus "$post\r\nContent-Length: +$length" "$hidden"
  smuggle xchunked "$post\r\nTransfer-Encoding: xchunked\r\nContent-Length: $length" "$hidden"
  smuggle percent "$post\r\nTransfer-Encoding: %%63hunked\r\nContent-Length: $length" "$hidden"
  smuggle two-encodings "$post\r\nTransfer-Encoding: chunked\r\nTransfer-Encoding: identity" "$chunk"
  smuggle encodings "$post\r\nTransfer-Encoding: identity, chunked" "$chunk"
  smuggle vertical-tab "$post\r\nTransfer-Encoding: \vchunked\r\nContent-Length: $length" "$hidden"
  smuggle space-before-colon "$post\r\nTransfer-Encoding : chunked\r\nContent-Length: $length" "$hidden"
  smuggle space-length "$post\r\nContent-Length : $length" "$hidden"
  smuggle fold "$post\r\nX: y\r\n Content-Length: $length" "$hidden"
  smuggle folded-encoding "$post\r\nTransfer-Encoding:\r\n chunked\r\nContent-Length: $length" "$hidden"
  smuggle bare-feed "$post\r\nX: y\nContent-Length: $length" "$hidden"
  smuggle bare-feed-encoding "$post\nTransfer-Encoding: chunked\r\nContent-Length: $length" "$hidden"
  smuggle bare-return "$post\r\nX: y\rContent-Length: $length" "$hidden"
  smuggle underscore "$post\r\nContent_Length: 0\r\nContent-Length: $length" "$hidden"
  smuggle nul "$post\r\nX: a\\0b\r\nContent-Length: $length" "$hidden"
  smuggle extension "$post\r\nTransfer-Encoding: chunked" "$(printf '%x' "$length");a=b\r\n$hidden\r\n0\r\n\r\n"
  smuggle extension-feed "$post\r\nTransfer-Encoding: chunked" "$(printf '%x' "$length");a\n$hidden\r\n0\r\n\r\n"
  smuggle zeros "$post\r\nTransfer-Encoding: chunked" "0000000000000$chunk"
  smuggle huge-size "$post\r\nTransfer-Encoding: chunked" "100000000000000$(printf '%x' "$length")\r\n$hidden\r\n0\r\n\r\n"
  smuggle negative "$post\r\nTransfer-Encoding: chunked" "-1\r\n$hidden\r\n0\r\n\r\n"
  smuggle hexadecimal "$post\r\nTransfer-Encoding: chunked" "0x$(printf '%x' "$length")\r\n$hidden\r\n0\r\n\r\n"
  smuggle no-feed-after-chunk "$post\r\nTransfer-Encoding: chunked" "1\r\nxx\r\n$hidden\r\n0\r\n\r\n"
  smuggle trailer "$post\r\nTransfer-Encoding: chunked" "0\r\nContent-Length: 5\r\nX: $hidden"
  smuggle http10 "POST /v1/refine HTTP/1.0\r\nHost: x\r\nTransfer-Encoding: chunked\r\nContent-Length: $length" "$hidden"
  smuggle get-with-body "GET /health HTTP/1.1\r\nHost: x\r\nContent-Length: $length" "$hidden"
  smuggle expect "$post\r\nExpect: 100-continue\r\nContent-Length: $length" "$hidden"
  smuggle refused "POST /nowhere HTTP/1.1\r\nHost: x\r\nContent-Length: $length" "$hidden"
  smuggle upgrade "GET /health HTTP/1.1\r\nHost: x\r\nConnection: Upgrade, HTTP2-Settings\r\nUpgrade: h2c\r\nContent-Length: $length" "$hidden"
  smuggle hop "$post\r\nConnection: Content-Length\r\nContent-Length: $length" "$hidden"
  smuggle method "TRACE /health HTTP/1.1\r\nHost: x\r\nContent-Length: $length" "$hidden"
  smuggle garbage "nonsense\r\nHost: x" "$hidden"
  smuggle query "GET /health?%%0d%%0a%%0d%%0aGET%%20/admin-smuggled HTTP/1.1\r\nHost: x" ''
  proxy_is_well
  run ! logged 'path="/admin-smuggled"'
  run ! grep 'path="/admin-smuggled"' "$BATS_FILE_TMPDIR/main/access.log"
}

@test "tls.conf instead of listen.conf serves TLS" {
  folder=$BATS_FILE_TMPDIR/tls
  kept=$proxy
  kept_pid=$proxy_pid
  openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 -subj /CN=x \
    -addext subjectAltName=IP:127.0.0.1 -keyout "$BATS_TEST_TMPDIR/key" -out "$BATS_TEST_TMPDIR/certificate" 2>/dev/null
  start_proxy tls
  stop_proxy "$proxy_pid"
  sed "s|8443|127.0.0.1:$proxy_port|; s|/etc/papilio/tls.crt|$BATS_TEST_TMPDIR/certificate|
    s|/etc/papilio/tls.key|$BATS_TEST_TMPDIR/key|" "$folder/conf/nginx/tls.conf" >"$folder/conf/nginx/listen.conf"
  as_root=()
  ((EUID != 0)) || as_root=(-g 'user root;')
  nginx -p "$folder" -c "$folder/conf/nginx.conf" "${as_root[@]}" >"$folder/access.log" 2>"$folder/error.log" 3>&- &
  tls_pid=$!
  speaks_tls() { curl -sS --noproxy '*' --cacert "$BATS_TEST_TMPDIR/certificate" "https://127.0.0.1:$proxy_port/health"; }
  eventually speaks_tls
  request --cacert "$BATS_TEST_TMPDIR/certificate" -H "$draco" --data-binary @"$coarse" "https://127.0.0.1:$proxy_port/v1/refine?levels=0"
  stop_proxy "$tls_pid"
  proxy=$kept
  proxy_pid=$kept_pid
  [ "$status" = 200 ]
  [[ $(head -1 "$headers") == HTTP/2* ]]
}

# start_pair: starts two servers on $first_port and $second_port; sets $pair_pid. Each answers its name, or 503 while the
# file of that name is in $BATS_TEST_TMPDIR.
start_pair() {
  first_port=$(free_port) second_port=$(free_port)
  python3 - "$BATS_TEST_TMPDIR" "$first_port" "$second_port" <<'END' 2>"$BATS_TEST_TMPDIR/pair.log" 3>&- &
import http.server, os, sys, threading
folder, *ports = sys.argv[1:]
class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    def do_GET(self):
        port = str(self.server.server_port)
        self.send_response(503 if os.path.exists(os.path.join(folder, port)) else 200)
        self.send_header("Content-Length", str(len(port)))
        self.end_headers()
        self.wfile.write(port.encode())
    def log_message(self, *_):
        pass
servers = [http.server.ThreadingHTTPServer(("127.0.0.1", int(port)), Handler) for port in ports]
threading.Thread(target=servers[0].serve_forever, daemon=True).start()
servers[1].serve_forever()
END
  pair_pid=$!
  eventually curl -s --noproxy '*' -o /dev/null "http://127.0.0.1:$second_port/"
}

# start_pair_proxy: starts nginx in front of the pair, as $proxy; sets $pair_proxy_pid.
start_pair_proxy() {
  local folder=$BATS_FILE_TMPDIR/pair as_root=()
  start_proxy pair 's/^worker_processes auto/worker_processes 1/' # a worker counts failures for itself
  stop_proxy "$proxy_pid"
  start_pair
  sed "s/10\.213\.77\.11:8080/127.0.0.1:$first_port/; s/10\.213\.77\.12:8080/127.0.0.1:$second_port/" \
    "$folder/conf/nginx/upstream.compose.conf" >"$folder/conf/nginx/upstream.conf"
  ((EUID != 0)) || as_root=(-g 'user root;')
  nginx -p "$folder" -c "$folder/conf/nginx.conf" "${as_root[@]}" >"$folder/access.log" 2>"$folder/error.log" 3>&- &
  pair_proxy_pid=$!
  eventually curl -s --noproxy '*' -o /dev/null "http://127.0.0.1:$proxy_port/health"
}

# statuses: prints the statuses of four requests through that proxy.
statuses() {
  for _ in 1 2 3 4; do curl -sS --noproxy '*' -o /dev/null -w '%{http_code} ' "http://127.0.0.1:$proxy_port/health"; done
}

@test "a server that refuses is passed over while the other is left out after a failure" {
  local kept=$proxy kept_pid=$proxy_pid pair_pid pair_proxy_pid first_port second_port before after
  start_pair_proxy
  touch "$BATS_TEST_TMPDIR/$second_port" # fails once, and is left out
  before=$(statuses)
  rm "$BATS_TEST_TMPDIR/$second_port"
  touch "$BATS_TEST_TMPDIR/$first_port"
  after=$(statuses)
  stop_proxy "$pair_proxy_pid"
  kill "$pair_pid"
  proxy=$kept proxy_pid=$kept_pid
  [ "$before" = '200 200 200 200 ' ]
  [ "$after" = '200 200 200 200 ' ]
}

@test "where both servers refuse, their 503 is passed on, however often" {
  local kept=$proxy kept_pid=$proxy_pid pair_pid pair_proxy_pid first_port second_port refused
  start_pair_proxy
  touch "$BATS_TEST_TMPDIR/$first_port" "$BATS_TEST_TMPDIR/$second_port"
  refused=$(statuses)
  stop_proxy "$pair_proxy_pid"
  kill "$pair_pid"
  proxy=$kept proxy_pid=$kept_pid
  [ "$refused" = '503 503 503 503 ' ]
}

@test "the cache holds keys for as many results as its size allows" {
  # nginx counts blocks of 4 KB; a key takes 128 bytes. With a smaller zone it would answer 500 once the zone is full.
  local zone size
  read -r zone size < <(sed -nE 's/.*proxy_cache_path .*keys_zone=refined:([0-9]+)m max_size=([0-9]+)g .*/\1 \2/p' \
    "$BATS_TEST_DIRNAME/../../docker/nginx.conf")
  (((zone << 20) / 128 > (size << 30) / 4096 * 5 / 4))
}
