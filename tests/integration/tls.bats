#!/usr/bin/env bats
# HTTPS: the service with certificates, and clients with other protocols.

load helpers

# make_authority NAME: makes a certificate authority.
make_authority() {
  openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 -subj "/CN=$1" \
    -keyout "$certificates/$1.key" -out "$certificates/$1.pem" 2>"$certificates/log"
}

setup_file() {
  export certificates=$BATS_FILE_TMPDIR
  make_authority authority
  make_authority stranger
  openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj /CN=server \
    -keyout "$certificates/server.key" -out "$certificates/server.csr" 2>>"$certificates/log"
  openssl x509 -req -in "$certificates/server.csr" -CA "$certificates/authority.pem" -CAkey "$certificates/authority.key" \
    -CAcreateserial -days 2 -extfile <(echo 'subjectAltName=IP:127.0.0.1') -out "$certificates/server.pem" \
    2>>"$certificates/log"
  export CURL_CA_BUNDLE=$certificates/authority.pem
}

teardown() {
  if [[ -n ${server_pid:-} ]] && kill -0 "$server_pid" 2>/dev/null; then stop_server; fi
}

start_https() {
  start_server --tls-cert "$certificates/server.pem" --tls-key "$certificates/server.key" "$@"
  address=${url#https://}
  port=${url##*:}
}

# handshake ARGUMENT...: runs openssl's client against the server.
handshake() { timeout 20 openssl s_client -connect "$address" "$@" </dev/null 2>&1; }

@test "HTTPS answers the same bytes as HTTP, and no plain port is open" {
  start_server
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=3"
  mv "$body" "$BATS_TEST_TMPDIR/plain"
  stop_server
  start_https
  [[ $(cat "$BATS_FILE_TMPDIR/server.out") == "listening on https://127.0.0.1:$port" ]]
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=3"
  [ "$status" = 200 ]
  cmp "$body" "$BATS_TEST_TMPDIR/plain"
  request -F mesh=@"$coarse" -F 'params={"levels": 3}' "$url/v1/refine"
  cmp "$body" "$BATS_TEST_TMPDIR/plain"
}

@test "the client verifies certificates by default, trusts --ca, and reports faults" {
  start_https
  cd "$BATS_TEST_TMPDIR"
  "$papilio" refine "$coarse" -o here.drc
  "$papilio" refine "$coarse" -o there.drc --server "$url" --ca "$certificates/authority.pem"
  cmp here.drc there.drc
  run "$papilio" refine "$coarse" -o x.drc --server "$url"
  [ "$status" = 1 ]
  [[ $output == *certificate*--ca* ]]
  run "$papilio" refine "$coarse" -o x.drc --server "$url" --ca "$certificates/stranger.pem"
  [ "$status" = 1 ]
  run "$papilio" refine "$coarse" -o x.drc --server "https://localhost:$port" --ca "$certificates/authority.pem"
  [ "$status" = 1 ] # the certificate is of 127.0.0.1, not of this name
  run "$papilio" refine "$coarse" -o x.drc --server "$url" --ca "$certificates/missing.pem"
  [ "$status" = 2 ]
  [ ! -e x.drc ]
}

@test "curl refuses the certificate under another authority" {
  start_https
  run curl -sS --noproxy '*' --max-time 20 --cacert "$certificates/stranger.pem" "$url/health"
  [ "$status" = 60 ]
}

@test "TLS 1.2 and 1.3 with forward secrecy; older and weaker ciphers and renegotiation are refused" {
  start_https
  [[ $(handshake -tls1_3) == *'New, TLSv1.3'* ]]
  [[ $(handshake -tls1_2) == *'New, TLSv1.2, Cipher is ECDHE-ECDSA-'* ]]
  # SECLEVEL=0: otherwise this client would not offer them.
  for version in tls1 tls1_1; do
    run handshake "-$version" -cipher DEFAULT@SECLEVEL=0
    [[ $output == *'alert protocol version'* ]]
  done
  run handshake -tls1_2 -cipher 'ECDHE-ECDSA-AES128-SHA256:AES128-SHA'
  [[ $output == *'handshake failure'* ]]
  run timeout 20 openssl s_client -tls1_2 -connect "$address" < <(echo R && exec sleep 20 3>&-)
  [[ $output == *'no renegotiation'* ]]
  server_is_well
}

@test "certificate and key are required together, readable, matching and without a passphrase" {
  run "$server" --port 0 --tls-cert "$certificates/server.pem"
  [ "$status" = 2 ]
  [[ $output == *--tls-key* ]]
  PAPILIO_TLS_KEY=$certificates/server.key run "$server" --port 0
  [ "$status" = 2 ]
  [[ $output == *--tls-cert* ]]
  run "$server" --port 0 --tls-cert "$certificates/missing.pem" --tls-key "$certificates/server.key"
  [ "$status" = 2 ]
  [[ $output == *--tls-cert*missing.pem* ]]
  run "$server" --port 0 --tls-cert "$certificates/server.key" --tls-key "$certificates/server.key"
  [ "$status" = 1 ]
  [[ $output == *--tls-cert*server.key* ]]
  run "$server" --port 0 --tls-cert "$certificates/server.pem" --tls-key "$certificates/stranger.key"
  [ "$status" = 1 ]
  [[ $output == *--tls-key*stranger.key*mismatch* ]]
  openssl ec -in "$certificates/server.key" -aes256 -passout pass:secret -out "$certificates/locked.key" 2>/dev/null
  run timeout 20 "$server" --port 0 --tls-cert "$certificates/server.pem" --tls-key "$certificates/locked.key"
  [ "$status" = 1 ]
  [[ $output == *--tls-key*locked.key* ]]
}

@test "settings from the environment enable TLS" {
  PAPILIO_TLS_CERT=$certificates/server.pem PAPILIO_TLS_KEY=$certificates/server.key start_server
  [[ $url == https://* ]]
  server_is_well
}

@test "plain HTTP on the TLS port is closed without an answer" {
  start_https
  run curl -sS --noproxy '*' --max-time 20 "http://$address/health"
  [[ $status == 52 || $status == 56 ]] # nothing came, or a reset
  [[ $output != *HTTP/* ]]
  server_is_well
}

@test "silent clients are closed at their deadline, and others are served" {
  start_https --idle-seconds 2 --connections 4
  exec 5<>"/dev/tcp/127.0.0.1/$port" 6<>"/dev/tcp/127.0.0.1/$port"
  printf '\x16\x03\x01\x02\x00\x01' >&6 # a handshake that is never finished
  server_is_well
  timeout 20 cat <&5
  timeout 20 cat <&6
  exec 5>&- 6>&-
  server_is_well
}

@test "one connection serves several requests" {
  start_https
  connects=$(curl -sS --noproxy '*' --max-time 20 -w '%{num_connects}' -o /dev/null "$url/health" -o /dev/null "$url/v1/info" \
    -o /dev/null "$url/ready")
  [ "$connects" = 100 ]
}

@test "a client that disconnects from HTTPS stops its work" {
  start_https --slots 1 --queue 0
  curl -sS --noproxy '*' -o /dev/null -H "$draco" -H 'X-Request-Id: leaver' --data-binary @"$coarse" \
    "$url/v1/refine?levels=6&flatness=1&growth=2&output.normals=true" 3>&- &
  running=$!
  at_work() { request "$url/metrics" && grep -q '^papilio_slots_busy 1$' "$body"; }
  eventually at_work
  kill -KILL "$running"
  wait "$running" || true
  stop_server
  eventually grep -q 'id=leaver .* status=499 .*code=cancelled' "$BATS_FILE_TMPDIR/server.log"
}

@test "a stream's first level arrives before later ones exist" {
  start_https
  mkfifo "$BATS_TEST_TMPDIR/stream"
  curl -sSN --noproxy '*' -o "$BATS_TEST_TMPDIR/stream" -H "$draco" -H 'Accept: multipart/mixed' -H 'X-Request-Id: leaver' \
    --data-binary @"$coarse" "$url/v1/refine?levels=6&flatness=1&growth=2&output.normals=true" 3>&- &
  running=$!
  exec 5<"$BATS_TEST_TMPDIR/stream"
  first=$(head -c 1000 <&5 | tr -d '\0')
  [[ $first == *'Papilio-Faces: 600'* ]]
  # Disconnect: if the last level had been made already, nothing would be truncated.
  kill -KILL "$running"
  wait "$running" || true
  exec 5<&-
  stop_server
  eventually grep -q 'id=leaver .*code=not_sent' "$BATS_FILE_TMPDIR/server.log"
}

@test "a stream over HTTPS differs only in its boundary" {
  start_https
  request -H "$draco" -H 'Accept: multipart/mixed' --data-binary @"$coarse" "$url/v1/refine?levels=3"
  [ "$status" = 200 ]
  [ "$(grep -ac '^Papilio-Faces: ' "$body")" = 4 ]
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=3"
  size=$(stat -c %s "$body")
  request -H "$draco" -H 'Accept: multipart/mixed' --data-binary @"$coarse" "$url/v1/refine?levels=3"
  grep -aq "^Content-Length: $size" "$body"
}

@test "a body of 60 MB is read completely" {
  start_https --max-body-bytes 70000000
  { printf DRACO; head -c 60000000 /dev/zero; } >"$BATS_TEST_TMPDIR/large"
  request -H "$draco" --data-binary @"$BATS_TEST_TMPDIR/large" "$url/v1/refine"
  expect_problem 422 mesh_unsupported
  stop_server
  eventually grep -qE ' in=6000[0-9]{4} ' "$BATS_FILE_TMPDIR/server.log"
}
