#!/usr/bin/env bash
# soak.sh MINUTES PRESET: the server of build/PRESET under load: papilio-soak's mixed clients, and wrk with small requests
# in parallel. Prints figures at the end; the server's log is build/soak-PRESET/server.log. Exit status 1 on any fault: an
# unexpected answer, a failed end of the server (under asan: a leak), or memory that grows by more than 2 % (release, from
# 5 minutes up).
set -euo pipefail
minutes=$1 preset=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
cd "$root"
# shellcheck source=tests/support/sanitizers.sh
source "$here/sanitizers.sh"
programs=build/$preset
seconds=$((minutes * 60))
max_body_bytes=$((1 << 20))
growth=0
if [[ $preset == release ]] && ((minutes >= 5)); then growth=0.02; fi
failed=()

"$here/coarse_meshes.sh" "$preset"
mesh=build/deps/meshes/bunny600.drc
folder=build/soak-$preset
mkdir -p "$folder"
rm -f "$folder"/*

# The store and the caches are full after the warm-up.
"$programs/papilio-server" --port 0 --log-level warning --read-seconds 3 --max-body-bytes "$max_body_bytes" \
  --store-bytes $((1 << 17)) --result-cache-bytes $((1 << 20)) --mesh-cache-bytes $((1 << 20)) \
  >"$folder/server.out" 2>"$folder/server.log" &
server=$!
trap 'kill -KILL "$server" 2>/dev/null || true' EXIT
for _ in {1..100}; do
  if [[ -s "$folder/server.out" ]] || ! kill -0 "$server" 2>/dev/null; then break; fi
  sleep 0.1
done
port=$(sed -n '1s/^listening on http:.*:\([0-9]*\)$/\1/p' "$folder/server.out")
[[ -n $port ]] || {
  cat "$folder/server.log" >&2
  exit 1
}

PAPILIO_SOAK_MESH=$mesh wrk --threads 1 --connections 2 --duration "${seconds}s" --timeout 60s \
  --script tests/soak/small_requests.lua "http://127.0.0.1:$port" >"$folder/wrk.log" 2>&1 &
wrk=$!
"$programs/papilio-soak" --port "$port" --pid "$server" --seconds "$seconds" --mesh "$mesh" \
  --max-body-bytes "$max_body_bytes" --most-growth "$growth" || failed+=("the mixed clients")
wait "$wrk" || failed+=("wrk")
grep '^wrk: ' "$folder/wrk.log" || cat "$folder/wrk.log"
grep -q '^wrk: .*, wrong 0$' "$folder/wrk.log" || failed+=("wrk's requests")

trap - EXIT
status=0
kill -TERM "$server" || status=1
wait "$server" || status=$?
echo "server: exit status $status after SIGTERM"
((status == 0)) || failed+=("the server's end")
# Bugs of the server are answered with 500 and logged as internal. Sanitizers write to the log, too.
if grep -E -m5 'code=internal|ERROR: |runtime error|WARNING: ThreadSanitizer' "$folder/server.log"; then
  failed+=("the server's log")
fi

if ((${#failed[@]})); then
  printf 'soak: failed: %s\n' "${failed[*]}" >&2
  exit 1
fi
echo "soak: passed"
