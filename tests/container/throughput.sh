#!/usr/bin/env bash
# throughput.sh: the composition with one server and with two, each with one core, in turns: requests a second, and what
# two processes of plain arithmetic gain over one at the same time, which is all that this machine has to give. Called by
# container.sh, which has the images and the engine. Prints a table; medians of the rounds.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
mesh=$PAPILIO_MESHES/bunny600.drc
rounds=${PAPILIO_ROUNDS:-5}
seconds=${PAPILIO_SECONDS:-6}
folder=$(mktemp -d)
PAPILIO_PORT=$(python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
export PAPILIO_PORT
url=http://127.0.0.1:$PAPILIO_PORT

compose() { docker-compose -p papilio-throughput -f "$root/docker/compose.yaml" -f "$folder/override.yaml" "$@" >>"$folder/log" 2>&1; }
trap 'compose down -v --timeout 5 || true; rm -rf "$folder"' EXIT

both=$root/docker/nginx/upstream.compose.conf
cp "$both" "$folder/upstream.conf"
sed 's/rate=20r/rate=100000r/; s/burst=40/burst=10000/' "$root/docker/nginx/limits.conf" >"$folder/limits.conf"
chmod -R a+rX "$folder"
cat >"$folder/override.yaml" <<END
services:
  server-a:
    cpus: 1
  server-b:
    cpus: 1
  proxy:
    volumes:
      - $folder/upstream.conf:/etc/papilio/nginx/upstream.conf:ro
      - $folder/limits.conf:/etc/papilio/nginx/limits.conf:ro
END
compose up -d --no-build || {
  cat "$folder/log" >&2
  exit 1
}
for _ in {1..100}; do
  ! curl -sS --noproxy '*' -o "$folder/health" "$url/health" 2>>"$folder/log" || break
  sleep 0.1
done

# servers 1|2: so many are behind the proxy from now on. (Written in place: what is mounted is the file itself.)
servers() {
  if (($1 == 2)); then cat "$both"; else sed '/10\.213\.77\.12/d' "$both"; fi >"$folder/upstream.conf"
  podman kill --signal HUP "$(podman ps --quiet --filter name=proxy)" >/dev/null
  sleep 0.5
}

# ticks SERVICE...: hundredths of a second of processor time that their processes have taken.
ticks() {
  local service pid total=0
  for service in "$@"; do
    pid=$(podman inspect --format '{{.State.Pid}}' "$(podman ps --quiet --filter name="$service")")
    # shellcheck disable=SC2046 # several: nginx's workers
    total=$((total + $(awk '{ sum += $14 + $15 } END { print sum + 0 }' \
      $(printf '/proc/%s/stat ' "$pid" $(cat "/proc/$pid/task/$pid/children")))))
  done
  echo "$total"
}

# load PATH [MESH]: requests a second, p50 and p99 in ms, and microseconds of processor time a request in servers, proxy and
# Redis; fails when one was not answered with 200.
load() {
  local figures servers proxy store requests second p50 p99
  servers=$(ticks server-a server-b) proxy=$(ticks proxy) store=$(ticks store)
  figures=$(PAPILIO_MESH=${2:-} wrk --threads 1 --connections 4 --duration "${seconds}s" --timeout 30s \
    --script "$here/refine.lua" "$url$1" | sed -n 's/^figures: //p')
  [[ $figures == *" 0" ]] || {
    echo "throughput: $1: some requests failed: $figures; the proxy says:" >&2
    podman logs "$(podman ps --quiet --filter name=proxy)" 2>&1 | grep -v ' status=200 ' | tail -n 20 >&2
    return 1
  }
  read -r requests second p50 p99 _ <<<"$figures"
  echo "$second $p50 $p99 $((($(ticks server-a server-b) - servers) * 10000 / requests))" \
    "$((($(ticks proxy) - proxy) * 10000 / requests)) $((($(ticks store) - store) * 10000 / requests))"
}

# arithmetic PROCESSES: how many a second of a fixed piece of work get done.
arithmetic() {
  local began=$EPOCHREALTIME running=()
  for ((process = 0; process < $1; process++)); do
    awk 'BEGIN { x = 1; for (i = 0; i < 20000000; i++) x = x * 0.999999 + 1e-6 }' &
    running+=($!)
  done
  wait "${running[@]}"
  awk -v began="$began" -v ended="$EPOCHREALTIME" -v n="$1" 'BEGIN { print n / (ended - began) }'
}

id=$(curl -sS --noproxy '*' -H 'Content-Type: application/x-draco' --data-binary @"$mesh" "$url/v1/meshes" | jq -r .id)
small='/v1/refine?levels=3&tolerance=0.001'
large='/v1/refine?levels=5'
kept="/v1/meshes/$id/refined?levels=3&tolerance=0.001"
views="/v1/meshes/$id/refined?levels=4&view.error_pixels=0.5&view.verify=false&view.eye=EYE"
for ((round = 0; round < rounds; round++)); do
  for count in 1 2; do
    servers "$count"
    figures=$(load "$small" "$mesh")
    echo "small $count $figures"
    figures=$(load "$large" "$mesh")
    echo "large $count $figures"
    figures=$(load "$views")
    echo "views $count $figures"
    figures=$(load "$kept")
    echo "kept $count $figures"
    figures=$(arithmetic "$count")
    echo "arithmetic $count $figures"
  done
done >"$folder/figures"

awk -v rounds="$rounds" '
  function median(list, n,   i, j, t) {
    for (i = 2; i <= n; i++) for (j = i; j > 1 && list[j] < list[j - 1]; j--) { t = list[j]; list[j] = list[j - 1]; list[j - 1] = t }
    return list[int((n + 1) / 2)]
  }
  function of(what, count, field,   list, i) {
    for (i = 1; i <= rounds; i++) list[i] = value[what, count, field, i] + 0
    return median(list, rounds)
  }
  { n = ++seen[$1, $2]; for (f = 3; f <= NF; f++) value[$1, $2, f, n] = $f }
  function row(what, title) {
    printf "| %s | %.0f | %.0f | %.2f | %.0f, %.0f | %.0f | %.0f | %.0f |\n", title, of(what, 1, 3), of(what, 2, 3),
      of(what, 2, 3) / of(what, 1, 3), of(what, 2, 4), of(what, 2, 5), of(what, 2, 6), of(what, 2, 7), of(what, 2, 8)
  }
  END {
    print "| through the proxy, four clients | one server, requests/s | two servers | ratio | p50, p99, ms | servers, µs a request | proxy | Redis |"
    print "|---|---:|---:|---:|---:|---:|---:|---:|"
    row("small", "600 faces to 4,866, by tolerance")
    row("large", "600 faces to 614,400, uniform")
    row("views", "a new view of a stored mesh, to half a pixel")
    row("kept", "a stored mesh, refined before: from the proxy")
    printf "| plain arithmetic, one process and two | %.2f | %.2f | %.2f | | | | |\n", of("arithmetic", 1, 3), of("arithmetic", 2, 3),
      of("arithmetic", 2, 3) / of("arithmetic", 1, 3)
  }' "$folder/figures"
