#!/usr/bin/env bats
# docker/kubernetes: what kustomize makes of it is right by Kubernetes' own schemas and types, says what it should, and runs.

bats_require_minimum_version 1.5.0
load helpers

manifests=$BATS_TEST_DIRNAME/../../docker/kubernetes
key=0123456789abcdef0123456789abcdef

kubectl() { "$BATS_TEST_DIRNAME/../../build/deps/kubectl/usr/bin/kubectl" "$@"; }
validate() { node "$BATS_TEST_DIRNAME/validate_manifests.mjs" "$1"; }
# object KIND JQ-EXPRESSION: of the rendered manifests in $rendered.
object() { to_json "$rendered" "$1" | jq -r "$2"; }
to_json() { node "$BATS_TEST_DIRNAME/to_json.mjs" "$@"; }
# secret NAME JQ-EXPRESSION: gives podman the Secret of here.yaml whose name begins so.
secret() {
  to_json here.yaml Secret | jq -c "select(.metadata.name | startswith(\"$1\")) | $2" >"$1.secret"
  podman secret create "$(to_json here.yaml Secret | jq -r ".metadata.name | select(startswith(\"$1\"))")" "$1.secret" >/dev/null
}

setup() {
  rendered=$BATS_TEST_TMPDIR/rendered.yaml
  kubectl kustomize "$manifests" >"$rendered"
}
teardown() {
  podman pod rm --all --force >/dev/null 2>&1
  podman rm --all --force --time 2 >/dev/null
  podman volume rm --all --force >/dev/null
  podman secret ls --quiet | xargs --no-run-if-empty podman secret rm >/dev/null
  podman network rm papilio-kubernetes >/dev/null 2>&1 || true
}

@test "the manifests are valid, and all that was asked for is there" {
  run validate "$rendered"
  echo "$output"
  [ "$status" = 0 ]
  local kind
  for kind in Namespace ConfigMap Secret Service Deployment HorizontalPodAutoscaler PodDisruptionBudget NetworkPolicy; do
    [[ $'\n'$output == *$'\n'"$kind/papilio"* || $output == "$kind/papilio"* ]]
  done
}

@test "what is wrong in a manifest is found: a misspelt field, a wrong type, a kind that does not exist" {
  sed 's/maxUnavailable: 1/maxUnavaileble: 1/' "$rendered" >"$BATS_TEST_TMPDIR/wrong.yaml"
  run validate "$BATS_TEST_TMPDIR/wrong.yaml"
  [[ $status == 1 && $output == *maxUnavaileble* ]]
  sed 's/minReplicas: 2/minReplicas: two/' "$rendered" >"$BATS_TEST_TMPDIR/wrong.yaml"
  run validate "$BATS_TEST_TMPDIR/wrong.yaml"
  [[ $status == 1 && $output == *minReplicas* ]]
  sed 's/kind: NetworkPolicy/kind: NetworkPolice/' "$rendered" >"$BATS_TEST_TMPDIR/wrong.yaml"
  run validate "$BATS_TEST_TMPDIR/wrong.yaml"
  [[ $status == 1 && $output == *NetworkPolice* ]]
}

@test "the objects agree with each other and with the image" {
  local labels
  labels=$(object Deployment '.spec.template.metadata.labels["app.kubernetes.io/name"]')
  [ "$labels" = papilio ]
  [ "$(object Service '.spec.selector["app.kubernetes.io/name"]')" = "$labels" ]
  [ "$(object PodDisruptionBudget '.spec.selector.matchLabels["app.kubernetes.io/name"]')" = "$labels" ]
  [ "$(object NetworkPolicy '.spec.podSelector.matchLabels["app.kubernetes.io/name"]')" = "$labels" ]
  [ "$(object HorizontalPodAutoscaler .spec.scaleTargetRef.name)" = "$(object Deployment .metadata.name)" ]
  # The autoscaler's metric is one that the server has.
  start_server
  request "$url/metrics"
  grep -q "^$(object HorizontalPodAutoscaler '.spec.metrics[] | select(.type == "Pods").pods.metric.name') " "$body"
  stop_server
  # The image's user, and the version of this tree.
  [ "$(object Deployment .spec.template.spec.securityContext.runAsUser)" = "$(podman image inspect --format '{{.Config.User}}' papilio | cut -d: -f1)" ]
  [ "$(object Deployment '.spec.template.spec.containers[0].image')" = "papilio:$("$server" --version | cut -d' ' -f2)" ]
  # Time to drain after the pause before it.
  local grace drain pause
  grace=$(object Deployment .spec.template.spec.terminationGracePeriodSeconds)
  drain=$(object ConfigMap .data.PAPILIO_DRAIN_SECONDS)
  pause=$(object Deployment '.spec.template.spec.containers[0].lifecycle.preStop.exec.command[1]')
  ((grace > drain + pause))
  # Every setting is one that the server knows.
  local setting
  for setting in $(object ConfigMap '.data | keys[]') PAPILIO_STORE; do "$server" --help | grep -q "Env:$setting)"; done
}

@test "the Deployment runs under podman: keys, Redis and settings reach it, and SIGTERM ends it with 0" {
  cp -r "$manifests" "$BATS_TEST_TMPDIR/here"
  cd "$BATS_TEST_TMPDIR"
  printf 'app %s\nmonitoring monitoring%s manage\n' "$key" "$key" >>here/keys
  sed -i 's#redis://redis.redis.svc:6379#redis://redis:6379#; s#newName: papilio#newName: localhost/papilio#; s#newTag: .*#newTag: latest#' \
    here/kustomization.yaml
  kubectl kustomize here >here.yaml
  local secrets=Secret
  if [[ $(podman --version) == *" 4.3."* ]]; then # it leaves Secrets encoded in volumes, and cannot read them for variables
    secrets=
    secret papilio-store .data
    secret papilio-keys '.data |= map_values(@base64d)'
  fi
  # shellcheck disable=SC2086 # one kind or none; YAML may be JSON
  to_json here.yaml ConfigMap Deployment $secrets | sed 's/^/---\n/' >play.yaml
  podman network create papilio-kubernetes >/dev/null
  podman run --detach --health-interval disable --name redis --network papilio-kubernetes papilio-store >/dev/null
  podman play kube --network papilio-kubernetes play.yaml >/dev/null
  local container address
  container=$(podman ps --quiet --filter ancestor=localhost/papilio)
  url=http://$(podman inspect --format '{{(index .NetworkSettings.Networks "papilio-kubernetes").IPAddress}}' \
    "$(podman ps --quiet --filter name=infra)"):8080
  eventually answers "$url" || { podman logs "$container"; return 1; }
  request "$url/ready"
  [ "$status" = 200 ]
  request -H "$draco" --data-binary @"$coarse" "$url/v1/meshes"
  expect_problem 401 unauthorized
  request -H "Authorization: Bearer $key" -H "$draco" --data-binary @"$coarse" "$url/v1/meshes"
  [ "$status" = 201 ]
  [ "$(podman exec redis redis-cli exists "papilio:mesh:$(coarse_id)")" = 1 ]
  request -H "Authorization: Bearer $key" "$url/v1/meshes/$(coarse_id)/refined?levels=2"
  [ "$status" = 200 ]
  # Its limits are the slots and the memory.
  request -H "Authorization: Bearer monitoring$key" "$url/metrics"
  grep -qx 'papilio_slots 2' "$body"
  local pid
  pid=$(podman inspect --format '{{.State.Pid}}' "$container")
  (($(awk '/Max data size/ { print $4 }' "/proc/$pid/limits") < 4 << 30))
  [ "$(awk '/^Uid:/ { print $2 }' "/proc/$pid/status")" = 10001 ]
  podman pod stop --time 40 --all >/dev/null
  [ "$(podman inspect --format '{{.State.ExitCode}}' "$container")" = 0 ]
}
