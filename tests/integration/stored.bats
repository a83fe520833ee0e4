#!/usr/bin/env bats
# Stored meshes: routes, entity tags, caches, and each kind of store.

load helpers

setup_file() { start_server; }
teardown_file() { stop_server; }

@test "a mesh is stored under its SHA-256 with a description" {
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

@test "a refinement of a stored mesh has the bytes of the single request, by GET and by POST" {
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

@test "streamed levels of a stored mesh equal those of the single request" {
  upload
  request -H 'Accept: multipart/mixed' "$url/v1/meshes/$(coarse_id)/refined?levels=2"
  [ "$status" = 200 ]
  [[ $(header Content-Type) == multipart/mixed* ]]
  [ "$(grep -ac '^Papilio-Faces: ' "$body")" = 3 ]
  [ -z "$(header ETag)" ]
}

@test "the entity tag follows from the canonical parameters, and is answered with 304" {
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
  request -H 'If-None-Match: "other"' -H "If-None-Match: $tag" "$refined?view.eye=0,0,3" # one list, in two lines
  [ "$status" = 304 ]
  request -H 'Accept: text/html' -H 'Accept: application/x-draco' "$refined?view.eye=0,0,3"
  [ "$status" = 200 ]
  request -H 'If-None-Match: "other"' "$refined?view.eye=0,0,3"
  [ "$status" = 200 ]
  request "$refined?view.eye=0,0,4"
  [ "$(header ETag)" != "$tag" ]
  request -H 'Accept: application/octet-stream' "$refined?view.eye=0,0,3"
  [ "$(header ETag)" != "$tag" ] # another representation
}

@test "stored bytes are constant; their description may change with the server" {
  upload
  request "$url/v1/meshes/$(coarse_id)"
  [[ $(header Cache-Control) == *immutable* ]]
  request -H 'Accept: application/json' "$url/v1/meshes/$(coarse_id)"
  [[ $(header Cache-Control) == public,\ max-age=86400 ]]
  tag=$(header ETag)
  [[ $tag != *"$(coarse_id | cut -c1-32)"* ]]
  request -H 'Accept: application/json' -H "If-None-Match: $tag" "$url/v1/meshes/$(coarse_id)"
  [ "$status" = 304 ]
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

@test "a deleted mesh is gone with its results" {
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

@test "invalid meshes are not stored, and invalid ids are not found" {
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

@test "refinements of stored meshes have the same refusals" {
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
