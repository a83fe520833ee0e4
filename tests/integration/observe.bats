#!/usr/bin/env bats
# Metrics, logs, and the OpenAPI document.

load helpers

setup_file() { start_server --log-format json --max-output-faces 100000 --max-input-faces 5000; }
teardown_file() { stop_server; }

metric() { sed -n "s/^papilio_$1 //p" "$body"; }

@test "metrics count requests, refusals, faces, stages, lookups" {
  upload
  request "$url/v1/meshes/$(coarse_id)/refined?levels=1"
  request "$url/v1/meshes/$(coarse_id)/refined?levels=1"
  request "$url/v1/refine?levels=x" -H "$draco" --data-binary @"$coarse"
  request "$url/v1/refine?levels=1" -H "$draco" --data-binary @"$coarse"
  request "$url/nowhere/to/be/found"
  request -X BREW "$url/v1/info"
  all_counted() { request "$url/metrics" && [ "$(awk '/^papilio_requests_total/ { n += $2 } END { print n }' "$body")" -ge 7 ]; }
  eventually all_counted
  [ "$status" = 200 ]
  [[ $(header Content-Type) == 'text/plain; version=0.0.4'* ]]
  [ "$(metric 'requests_total{method="POST",route="\/v1\/meshes",status="201"}')" = 1 ]
  [ "$(metric 'requests_total{method="GET",route="\/v1\/meshes\/{id}\/refined",status="200"}')" = 2 ]
  [ "$(metric 'requests_total{method="GET",route="none",status="404"}')" = 1 ]
  [ "$(metric 'requests_total{method="other",route="none",status="405"}')" = 1 ]
  [ "$(metric 'problems_total{code="bad_parameter"}')" = 1 ]
  [ "$(metric faces_in_total)" = 1200 ]
  [ "$(metric faces_out_total)" = 4800 ]
  [ "$(metric 'cache_lookups_total{cache="results",outcome="hit"}')" = 1 ]
  [ "$(metric 'cache_lookups_total{cache="results",outcome="miss"}')" = 1 ]
  for stage in decode refine encode; do [ "$(metric "stage_seconds_count{stage=\"$stage\"}")" = 2 ]; done
  (($(metric 'stage_seconds_count{stage="queue"}') == 3))
  [ "$(metric slots_busy)" = 0 ]
  [ "$(metric queue_length)" = 0 ]
  [ "$(metric store_meshes)" = 1 ]
  (($(metric 'cache_bytes{cache="results"}') > 1000))
  grep -q '^process_resident_memory_bytes [1-9]' "$body"
  # The format of scrapers: each name is described before it is used.
  ! grep -vE '^(# .*|[a-z_]+(\{([a-z_]+="[^"]*",?)+\})? [0-9.e+-]+|[a-z_]+_bucket\{.*\} [0-9]+)$' "$body" | grep .
}

@test "the log has one JSON object a line, with the id, the route's answer and the trace" {
  trace=4bf92f3577b34da6a3ce929d0e0e4736
  request -H 'X-Request-Id: 1e5' -H "traceparent: 00-$trace-00f067aa0ba902b7-01" -H "$draco" \
    --data-binary @"$coarse" "$url/v1/refine?levels=x%22%7D"
  [ "$(header traceparent)" = "00-$trace-00f067aa0ba902b7-01" ]
  request -H 'traceparent: 00-none-of-it' "$url/v1/info"
  [ -z "$(header traceparent)" ]
  request "$url/health"
  eventually grep -q '"path":"/v1/info"' "$BATS_FILE_TMPDIR/server.log"
  jq -es 'all(.time != null and .level != null and .msg != null)' "$BATS_FILE_TMPDIR/server.log"
  jq -es --arg trace "$trace" 'map(select(.id == "1e5")) == [.[] | select(.trace == $trace)] and
    (map(select(.id == "1e5")) | length == 1 and .[0].status == 400 and .[0].code == "bad_parameter" and
      .[0].method == "POST" and .[0].path == "/v1/refine" and (.[0].ms | type) == "number" and .[0].in > 100)' \
    "$BATS_FILE_TMPDIR/server.log"
  ! grep -q '"path":"/health"' "$BATS_FILE_TMPDIR/server.log"
}

@test "the OpenAPI document passes an independent linter" {
  request "$url/openapi.json"
  [ "$status" = 200 ]
  [ "$(field openapi)" = 3.1.0 ]
  cp "$body" "$BATS_TEST_TMPDIR/openapi.json"
  cd "$BATS_TEST_TMPDIR"
  REDOCLY_TELEMETRY=off REDOCLY_SUPPRESS_UPDATE_NOTICE=true \
    "$PAPILIO_MESHES/../redocly/node_modules/.bin/redocly" lint openapi.json
}

@test "the operations of the document exist, and no others" {
  request "$url/openapi.json"
  cp "$body" "$BATS_TEST_TMPDIR/openapi.json"
  jq -r '.paths | to_entries[] | .key as $path | .value | keys[] | "\(.) \($path)"' "$BATS_TEST_TMPDIR/openapi.json" \
    >"$BATS_TEST_TMPDIR/operations"
  (($(wc -l <"$BATS_TEST_TMPDIR/operations") >= 14))
  while read -r method path; do
    method=${method^^}
    address=$url${path//\{id\}/$(coarse_id)}
    address=${address/samples\/\{name\}/samples\/mug}
    address=${address/assets\/\{name\}/assets\/$(basename "$PAPILIO_BUILD"/web/assets/index-*.css)}
    request -X "$method" -H "$draco" -d x "$address"
    [[ $status != 405 && $(field code 2>/dev/null || true) != not_found ]]
    request -X OPTIONS "$address"
    [[ ", $(header Allow)," == *" $method,"* ]]
    # There is no method that the document lacks, except those that it declares for all paths.
    for allowed in $(header Allow | tr -d ,); do
      [[ $allowed == OPTIONS || $allowed == HEAD ]] || grep -qxF "${allowed,,} $path" "$BATS_TEST_TMPDIR/operations"
    done
  done <"$BATS_TEST_TMPDIR/operations"
}

@test "the document has the server's parameters, limits and errors" {
  request "$url/openapi.json"
  cp "$body" "$BATS_TEST_TMPDIR/openapi.json"
  request "$url/v1/info"
  # Every parameter, by name, range and choices, in the query and in the JSON object.
  jq -e --slurpfile info "$body" '
    .components as $c
    | [$info[0].parameters[] | . as $p
      | ($c.parameters | map(select(.name == $p.name))[0].schema | if .type == "array" then .items else . end) as $query
      | ($c.schemas.Parameters.properties | getpath($p.name | split(".") | join(" properties ") | split(" "))
          | if .type == "array" then .items else . end) as $json
      | def range: map(if . == null then . else . + 0 end); # jq 1.7 compares literals, beyond 2^53 by their digits
        ($p | [.min, .max] | range) as $range
      | ([$query.minimum, $query.maximum] | range) == $range and $query.enum == $p.choices
        and ([$json.minimum, $json.maximum] | range) == $range and $json.enum == $p.choices]
    | length > 20 and all' "$BATS_TEST_TMPDIR/openapi.json"
  [ "$(field 'parameters | length')" = "$(jq '[.components.parameters[] | select(.in == "query")] | length' "$BATS_TEST_TMPDIR/openapi.json")" ]
  # Every limit has its configured value.
  jq -e --slurpfile info "$body" '.components.schemas.Info.properties.limits.properties
    | map_values(.const) | . == $info[0].limits and .max_output_faces == 100000 and .max_input_faces == 5000' \
    "$BATS_TEST_TMPDIR/openapi.json"
  # Actual errors are documented for their operation.
  declared() { jq -e --arg path "$1" --arg method "$2" --arg status "$3" --arg code "$4" \
    '.paths[$path][$method].responses[$status].description | contains($code + ":")' "$BATS_TEST_TMPDIR/openapi.json"; }
  request "$url/v1/refine?levels=9" -H "$draco" --data-binary @"$coarse"
  declared /v1/refine post "$status" "$(field code)"
  request "$url/v1/refine" -H "$draco" -d x
  declared /v1/refine post "$status" "$(field code)"
  request "$url/v1/refine" -H 'Content-Type: text/html' -d x
  declared /v1/refine post "$status" "$(field code)"
  request -X DELETE "$url/v1/meshes/x"
  declared '/v1/meshes/{id}' delete "$status" "$(field code)"
  request -H 'Accept: text/html' "$url/v1/meshes/x/refined"
  declared '/v1/meshes/{id}/refined' get "$status" "$(field code)"
  # Meshes that were stored under wider limits.
  start_server --store "directory:$BATS_TEST_TMPDIR/meshes"
  upload
  stop_server
  start_server --store "directory:$BATS_TEST_TMPDIR/meshes" --max-output-faces 100
  request -H 'Accept: application/json' "$url/v1/meshes/$(coarse_id)"
  declared '/v1/meshes/{id}' get "$status" "$(field code)"
  upload
  declared /v1/meshes post "$status" "$(field code)"
  stop_server
  start_server --store "directory:$BATS_TEST_TMPDIR/meshes" --max-input-faces 100
  request -H 'Accept: application/json' "$url/v1/meshes/$(coarse_id)"
  declared '/v1/meshes/{id}' get "$status" "$(field code)"
  stop_server
}

@test "every error code is documented" {
  request "$url/openapi.json"
  jq -e '.components.schemas.Problem.properties.code.enum as $codes
    | [.paths[][].responses[].description] | join("; ") as $all | $codes | length > 25 and all(. as $c | $all | contains($c + ":"))' "$body"
}

@test "README names every path" {
  request "$url/openapi.json"
  while read -r path; do grep -qF "$path" "$BATS_TEST_DIRNAME/../../README.md"; done < <(field 'paths | keys[]')
}
