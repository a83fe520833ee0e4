# What the tests in containers need besides those of tests/integration: podman on the images that container.sh has built.
# shellcheck shell=bash

load ../integration/helpers

# free_port_for NAME...: sets each variable to a port that nobody listens on.
free_port_for() {
  local name
  for name in "$@"; do printf -v "$name" %s "$(free_port)"; done
}

# answers URL: it is alive.
answers() { [[ $(curl -sS --noproxy '*' --max-time 5 "$1/health" 2>/dev/null | jq -r .status) == alive ]]; }

# inspect ID FORMAT
inspect() { podman inspect --format "$2" "$1"; }

# start_container [PODMAN-OPTION...] -- [ARGUMENT...]: papilio in a container as README starts it, in this machine's network;
# sets $container and $url.
start_container() {
  local options=(--health-interval disable) # as its timer wants systemd
  while [[ $1 != -- ]]; do
    options+=("$1")
    shift
  done
  local port
  port=$(free_port)
  url=http://127.0.0.1:$port
  # In the test's folder: where a container runs out of memory, its monitor leaves a file "oom" in the folder it began in.
  container=$(cd "$BATS_TEST_TMPDIR" && podman run --detach --network host --read-only --cap-drop ALL --security-opt no-new-privileges \
    -e PAPILIO_HOST=127.0.0.1 -e "PAPILIO_PORT=$port" "${options[@]}" papilio "${@:2}" 3>&-)
  eventually answers "$url"
}
