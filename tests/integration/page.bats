#!/usr/bin/env bats
# The viewer's files and sample meshes, as served. Its behaviour in a browser is tested in tests/web.

load helpers

setup_file() { start_server; }
teardown_file() { stop_server; }

# asset PATTERN: prints the name of a built file.
asset() { (cd "$PAPILIO_BUILD/web/assets" && compgen -G "$1" | head -1); }

@test "the page is revalidated each time, and loads nothing from other origins" {
  request "$url/"
  [ "$status" = 200 ]
  [ "$(header Content-Type)" = "text/html; charset=utf-8" ]
  [ "$(header Cache-Control)" = no-cache ]
  [ "$(header X-Content-Type-Options)" = nosniff ]
  policy=$(header Content-Security-Policy)
  [[ $policy == *"default-src 'none'"* && $policy == *"script-src 'self' 'wasm-unsafe-eval';"* ]]
  [[ $policy == *"worker-src 'self' blob:"* && $policy == *"frame-ancestors 'none'"* && $policy != *unsafe-inline* ]]
  cmp "$body" "$PAPILIO_BUILD/web/index.html"
  tag=$(header ETag)
  request -H "If-None-Match: $tag" "$url/"
  [ "$status" = 304 ]
  [ ! -s "$body" ]
}

@test "files of the page have names with a hash of the content, and are immutable" {
  for pattern in 'index-*.js' 'index-*.css' 'draco_decoder-*.wasm' 'draco_wasm_wrapper-*.js'; do
    name=$(asset "$pattern")
    request "$url/assets/$name"
    [ "$status" = 200 ]
    [ "$(header Cache-Control)" = 'public, max-age=31536000, immutable' ]
    cmp "$body" "$PAPILIO_BUILD/web/assets/$name"
  done
  [ "$(header Content-Type)" = "text/javascript; charset=utf-8" ]
  request "$url/assets/$(asset 'draco_decoder-*.wasm')"
  [ "$(header Content-Type)" = application/wasm ]
}

@test "the page is compressed for browsers that accept it, as another representation" {
  name=$(asset 'index-*.js')
  request "$url/assets/$name"
  plain=$(header ETag)
  [ -z "$(header Content-Encoding)" ]
  request -H 'Accept-Encoding: gzip, deflate, br' "$url/assets/$name"
  [ "$(header Content-Encoding)" = gzip ]
  [ "$(header Vary)" = Accept-Encoding ]
  [ "$(header ETag)" != "$plain" ]
  gunzip <"$body" | cmp - "$PAPILIO_BUILD/web/assets/$name"
  (($(stat -c %s "$body") * 3 < $(stat -c %s "$PAPILIO_BUILD/web/assets/$name")))
  request -I -H 'Accept-Encoding: gzip' "$url/assets/$name"
  [ "$status" = 200 ]
}

@test "the page serves no other files, for any path" {
  for path in assets/none.js assets/..%2findex.html assets/%2e%2e%2f%2e%2e%2fCMakeCache.txt assets/.gz assets/ index.html; do
    request --path-as-is "$url/$path"
    [ "$status" = 404 ]
  done
  expect_problem 404 not_found
  request -X POST -d x "$url/"
  expect_problem 405 method_not_allowed
}

@test "the page is below 400 KB without the decoder, compressed" {
  total=0
  for file in "$PAPILIO_BUILD"/web/index.html.gz "$PAPILIO_BUILD"/web/assets/*.{js,css,svg}.gz; do
    [[ $file == *draco_wasm_wrapper* ]] || total=$((total + $(stat -c %s "$file")))
  done
  echo "$total bytes"
  ((total > 50000 && total < 400000))
}

@test "a knot, a mug and a wheel are always available and refinable" {
  request "$url/v1/info"
  [ "$(jq -c '[.samples[] | [.name, .vertices, .faces]]' "$body")" = '[["knot",216,432],["mug",172,344],["wheel",163,290]]' ]
  for name in knot mug wheel; do
    request "$url/v1/info"
    expected=$(jq -r ".samples[] | select(.name == \"$name\") | .faces" "$body")
    bytes=$(jq -r ".samples[] | select(.name == \"$name\") | .bytes" "$body")
    request "$url/v1/samples/$name"
    [ "$status" = 200 ]
    [ "$(header Content-Type)" = application/x-draco ]
    [ "$(stat -c %s "$body")" = "$bytes" ]
    [ "$(decoded_faces "$body")" = "$expected" ]
    cp "$body" "$BATS_TEST_TMPDIR/$name.drc"
    request -H "If-None-Match: $(header ETag)" "$url/v1/samples/$name"
    [ "$status" = 304 ]
    request -H "$draco" --data-binary @"$BATS_TEST_TMPDIR/$name.drc" "$url/v1/refine?levels=1"
    [ "$status" = 200 ]
    [ "$(header Papilio-Faces)" = $((4 * expected)) ]
    [ -z "$(header Papilio-Found)" ]
  done
  request "$url/v1/samples/teapot"
  expect_problem 404 not_found
}

@test "an operator's meshes are samples; an unusable one is refused at start-up" {
  mkdir "$BATS_TEST_TMPDIR/samples"
  cp "$coarse" "$BATS_TEST_TMPDIR/samples/rabbit-600.drc"
  echo "no mesh" >"$BATS_TEST_TMPDIR/samples/readme.txt"
  BATS_FILE_TMPDIR=$BATS_TEST_TMPDIR start_server --samples "$BATS_TEST_TMPDIR/samples"
  request "$url/v1/info"
  [ "$(field 'samples | map(.name) | join(" ")')" = "knot mug wheel rabbit-600" ]
  [ "$(field 'samples[3].faces')" = 600 ]
  request "$url/v1/samples/rabbit-600"
  cmp "$body" "$coarse"
  stop_server
  refused() {
    run "$server" --port 0 --samples "$BATS_TEST_TMPDIR/samples"
    [ "$status" = 1 ]
    [[ $output == *"--samples: "*"$1"* ]]
  }
  echo "no mesh" >"$BATS_TEST_TMPDIR/samples/broken.drc"
  refused broken.drc
  rm "$BATS_TEST_TMPDIR/samples/broken.drc"
  cp "$coarse" "$BATS_TEST_TMPDIR/samples/a b.drc"
  refused 'rename the file'
  mv "$BATS_TEST_TMPDIR/samples/a b.drc" "$BATS_TEST_TMPDIR/samples/mug.drc"
  refused 'rename the file'
  run "$server" --port 0 --samples "$BATS_TEST_TMPDIR/none"
  [ "$status" = 1 ]
  [[ $output == *"--samples: "*"No such file"* ]]
}

@test "without a page the service works, and states how to add the page" {
  BATS_FILE_TMPDIR=$BATS_TEST_TMPDIR start_server --web ""
  request "$url/"
  expect_problem 404 not_found
  [[ $(field detail) == *--web* ]]
  server_is_well
  stop_server
  run "$server" --port 0 --web "$BATS_TEST_TMPDIR"
  [ "$status" = 1 ]
  [[ $output == *"--web: "*index.html* ]]
}

@test "with keys the page is public, and the samples are not" {
  echo 'someone 0123456789abcdef0123456789abcdef' >"$BATS_TEST_TMPDIR/keys"
  BATS_FILE_TMPDIR=$BATS_TEST_TMPDIR start_server --keys "$BATS_TEST_TMPDIR/keys"
  request "$url/"
  [ "$status" = 200 ]
  request "$url/v1/samples/mug"
  expect_problem 401 unauthorized
  request -H 'Authorization: Bearer 0123456789abcdef0123456789abcdef' "$url/v1/samples/mug"
  [ "$status" = 200 ]
  stop_server
}
