#!/usr/bin/env bats
# Clients generated from the OpenAPI document compile under strict TypeScript and refine a mesh.

load helpers

setup_file() {
  start_server --web ''
  export clients=$BATS_FILE_TMPDIR/clients
  mkdir "$clients"
  cp "$BATS_TEST_DIRNAME"/../openapi/{package.json,tsconfig.json,*.ts} "$clients"
  ln -s "$(realpath "$BATS_TEST_DIRNAME/../openapi/node_modules")" "$clients/node_modules"
}
teardown_file() { stop_server; }
setup() {
  skip_if_sanitized
  cd "$clients"
}

# same_as_curl FILE: expects the bytes that curl receives for equal parameters.
same_as_curl() {
  request -H "$draco" --data-binary @"$coarse" "$url/v1/refine?levels=2&flatness=0.8,0.9&view.eye=0,0,3"
  [ "$status" = 200 ]
  cmp "$body" "$1"
}

@test "generated clients compile under strict TypeScript" {
  curl -sS --noproxy '*' --max-time 60 -o openapi.json "$url/openapi.json"
  node_modules/.bin/openapi-typescript openapi.json --output generated/papilio.d.ts
  node_modules/.bin/openapi-ts --input openapi.json --output generated/papilio --no-log-file
  node_modules/.bin/tsc
}

@test "a client by openapi-typescript and openapi-fetch refines a mesh" {
  node built/openapi_fetch.js "$url" "$coarse" "$BATS_TEST_TMPDIR/fine.drc"
  same_as_curl "$BATS_TEST_TMPDIR/fine.drc"
}

@test "a client by @hey-api/openapi-ts refines a mesh" {
  node built/hey_api.js "$url" "$coarse" "$BATS_TEST_TMPDIR/fine.drc"
  same_as_curl "$BATS_TEST_TMPDIR/fine.drc"
}

@test "lists as repeated fields have the ETag of lists with commas" {
  upload
  request "$url/v1/meshes/$(coarse_id)/refined?levels=1&flatness=0.8&view.eye=0&view.eye=0&flatness=0.9&view.eye=3"
  [ "$status" = 200 ]
  tag=$(header ETag)
  request -H "If-None-Match: $tag" "$url/v1/meshes/$(coarse_id)/refined?levels=1&flatness=0.8,0.9&view.eye=0,0,3"
  [ "$status" = 304 ]
  request "$url/v1/meshes/$(coarse_id)/refined?levels=1&levels=1"
  expect_problem 400 bad_parameter
}
