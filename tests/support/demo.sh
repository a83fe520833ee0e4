#!/usr/bin/env bash
# demo.sh [--exit]: starts the release server on loopback, refines a coarse bunny uniformly, adaptively and for a view,
# and prints the cost of each. The server runs with the viewer until Ctrl-C; with --exit it has no viewer and is stopped
# at once. Inputs and results are in build/demo.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
cd "$root"
server_pid=

# Ends the server with SIGTERM. Returns its exit status, or 1 if it had to be killed.
stop_server() {
  [[ -n $server_pid ]] || return 0
  local pid=$server_pid
  server_pid=
  kill -TERM "$pid" 2>/dev/null || true
  for _ in {1..150}; do
    kill -0 "$pid" 2>/dev/null || break
    sleep 0.1
  done
  kill -KILL "$pid" 2>/dev/null || true
  wait "$pid"
}
trap 'stop_server || true' EXIT

die() {
  printf 'demo: %s\n' "$*" >&2
  exit 1
}

programs=${PAPILIO_BUILD:-build/release}
coarse=build/demo/bunny.drc
rm -rf build/demo
mkdir -p build/demo/samples
"$programs/coarsen" build/deps/meshes/cgal/bunny00.off build/demo/bunny.obj 600
"$programs/papilio" convert build/demo/bunny.obj "$coarse"
cp "$coarse" build/demo/samples/
"$programs/papilio" convert build/demo/bunny.obj build/demo/bunny.glb
info=$("$programs/papilio" info --json "$coarse")
viewer=()
[[ ${1:-} != --exit ]] || viewer=(--web '')

# Port 8080, or a free port if 8080 is in use.
port=8080
if (exec 3<>/dev/tcp/127.0.0.1/8080) 2>/dev/null; then port=0; fi
"$programs/papilio-server" --host 127.0.0.1 --port "$port" --samples build/demo/samples "${viewer[@]}" \
  >build/demo/server.out 2>build/demo/server.log &
server_pid=$!
for _ in {1..100}; do
  if [[ -s build/demo/server.out ]] || ! kill -0 "$server_pid" 2>/dev/null; then break; fi
  sleep 0.1
done
url=$(sed -n '1s/^listening on \(http:.*\)$/\1/p' build/demo/server.out)
if [[ -z $url ]]; then
  cat build/demo/server.log >&2
  die "the server did not start"
fi

row() { printf '%-26s %9s %9s %9s %10s %9s\n' "$@"; }
header() { tr -d '\r' <build/demo/headers.txt | sed -n "s/^$1: *//Ip" | tail -1; }

# refine TITLE NAME QUERY: sends one request; prints its row of the table and stores its command line for the list below.
commands=
refine() {
  local command milliseconds result=build/demo/$2.drc
  command="curl -sS --fail-with-body --noproxy '*' -H 'Content-Type: application/x-draco' --data-binary @$coarse"
  command+=" -o $result '$url/v1/refine?$3'"
  eval "$command --dump-header build/demo/headers.txt" || {
    cat "$result" >&2 || true
    die "this request failed: $command"
  }
  # Server-Timing: decode;dur=1.2, refine;dur=3.4, encode;dur=5.6
  milliseconds=$(header Server-Timing | tr ',' '\n' | awk -F'dur=' '
    { total += $2 } /refine;/ { refine = $2 } END { printf "%.1f %.1f", refine, total }')
  # shellcheck disable=SC2086 # two columns
  row "$1" "$(header Papilio-Vertices)" "$(header Papilio-Faces)" "$(stat -c %s "$result")" $milliseconds
  commands+="  $command"$'\n'
}

# The bunny's front at the distance at which its height fills 40 degrees.
view=$(jq -r '
  def round4: . * 10000 | round / 10000;
  def triple: map(round4 | tostring) | join(",");
  .box as $box
  | [range(3) | ($box.min[.] + $box.max[.]) / 2] as $centre
  | (1.1 * ($box.max[1] - $box.min[1]) / 2 / ((20 * 3.141592653589793 / 180) | tan)) as $distance
  | "view.eye=\([$centre[0], $centre[1], $box.max[2] + $distance] | triple)&view.target=\($centre | triple)&view.fov_y=40"
' <<<"$info")

echo
row 'what' 'vertices' 'faces' 'bytes' 'refine ms' 'total ms'
# shellcheck disable=SC2046 # three columns
row 'coarse' $(jq -r '.vertices, .faces, .bytes' <<<"$info") - -
refine 'uniform, 3 levels' uniform 'levels=3'
refine 'to 0.1 % of its size' adaptive 'levels=3&tolerance=0.001'
refine 'to a pixel, from the front' view "levels=3&$view&view.error_pixels=1&view.edge_pixels=0"
refine 'the best 4000 faces' budget 'levels=3&max_faces=4000'
elapsed=$((EPOCHSECONDS - ${PAPILIO_DEMO_BEGAN:-EPOCHSECONDS}))
if [[ ${1:-} == --exit ]]; then
  printf '\nThe meshes are in build/demo.\n'
  stop_server || die "the server did not stop cleanly; what it said is in build/demo/server.log"
else
  printf '\nThe requests, to be pasted again in %s; the meshes are in build/demo:\n%s' "$root" "$commands"
  printf '\nThe viewer, with this and other meshes: %s/\n' "$url"
fi
printf '%s\n' "From the start of ./dev demo: $((elapsed / 60)) min $((elapsed % 60)) s."
[[ ${1:-} != --exit ]] || exit 0

printf 'The server stays up; Ctrl-C stops it.\n'
trap 'echo; stop_server || exit 1; exit 0' INT TERM
wait "$server_pid" || die "the server ended by itself; what it said is in build/demo/server.log"
