#!/usr/bin/env bash
# container.sh [programs|suite|throughput|images]: builds the images of docker/ and tests them in containers, by themselves,
# in the composition and as kubernetes would run them; programs: runs the integration tests on the images' Debian; suite: all
# tests there; throughput: measures the composition with one server and two; images: only builds. Uses buildah and podman
# instead of a Docker engine, with a separate storage in build/containers. Removes all containers at the end; the compiler's
# cache is in the user's cache. Requires root, to make networks.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
containers=$root/build/containers
cache=${XDG_CACHE_HOME:-$HOME/.cache}/papilio/containers
part=${1:-test}
export PAPILIO_CONTAINERS=$containers PAPILIO_BUILD=$root/build/release PAPILIO_MESHES=$root/build/deps/meshes
export CONTAINERS_STORAGE_CONF=$containers/storage.conf CONTAINERS_CONF=$containers/containers.conf
cd "$root"

((EUID == 0)) || {
  echo "container: this needs root, for its networks: sudo ./dev container" >&2
  exit 1
}
mkdir -p "$containers" "$cache"
exec 8>"$containers/lock"
flock -n 8 || {
  echo "container: another ./dev container runs here" >&2
  exit 1
}

cat >"$CONTAINERS_STORAGE_CONF" <<END
[storage]
driver = "overlay"
runroot = "$containers/run"
graphroot = "$containers/storage"
END
cat >"$CONTAINERS_CONF" <<END
[containers]
default_ulimits = ["nofile=8192:8192", "nproc=4096:4096"]
[engine]
runtime = "runc"
cgroup_manager = "cgroupfs"
events_logger = "file"
tmp_dir = "$containers/tmp"
[network]
network_backend = "netavark"
network_config_dir = "$containers/networks"
END

# base NAME: builds the images' Debian from this machine's sources of packages; no other network access is required.
base() {
  local keyring=/usr/share/keyrings/debian-archive-keyring.gpg site security sources
  podman image exists "$1" && return 0
  echo "container: making $1"
  site=$(site_of main)
  security=$(site_of security)
  sources=("deb [signed-by=$keyring] $site trixie main" "deb [signed-by=$keyring] $site trixie-updates main")
  [[ -z $security ]] || sources+=("deb [signed-by=$keyring] $security trixie-security main")
  # Like Debian's slim image: no manuals, documents or translations.
  mmdebstrap --quiet --variant=minbase --include=ca-certificates \
    --dpkgopt='path-exclude=/usr/share/man/*' --dpkgopt='path-exclude=/usr/share/info/*' \
    --dpkgopt='path-exclude=/usr/share/locale/*' --dpkgopt='path-exclude=/usr/share/doc/*' \
    --dpkgopt='path-include=/usr/share/doc/*/copyright' trixie "$containers/base.tar" "${sources[@]}"
  podman import --quiet "$containers/base.tar" "$1" >/dev/null
  rm "$containers/base.tar"
}

# site_of main|security: prints this machine's source of Debian or of its security updates.
site_of() {
  # shellcheck disable=SC2016 # apt's own variables
  apt-get indextargets --format '$(SITE) $(RELEASE)' 'Created-By: Packages' 'Origin: Debian' |
    awk -v security="$1" '($2 ~ /-security$/) == (security == "security") && !found++ { print $1 }'
}

# image NAME DOCKERFILE [UNITS]: builds the image, with unit tests if UNITS is yes. Retries once after a failure before the
# first test: downloads may fail.
image() {
  local log=$containers/$1.log began=$SECONDS
  echo "container: building $1"
  build_image "$@" || { no_test_ran "$log" && sleep 15 && echo "container: once more" && build_image "$@"; } || {
    echo "container: $2 cannot be built; all it said is in ${log#"$root"/}" >&2
    return 1
  }
  echo "container: $1 is built, in $((SECONDS - began)) s, $(podman image inspect --format '{{.Size}}' "$1" |
    awk '{ printf "%.0f MB", $1 / 1e6 }')"
}
no_test_ran() { ! grep -qE '^(not )?ok |tests passed' "$1"; }

# Builds once, with this machine's certificates and npm settings if any. Prints the reason of a failure.
build_image() {
  local log=$containers/$1.log
  # Warnings are errors, as in the suite's build: equal flags share the compiler's cache.
  local options=(--isolation chroot --layers --pull-never --format docker --build-arg PAPILIO_WERROR=ON
    --build-arg "PAPILIO_TEST_UNITS=${3:-yes}"
    -v /etc/ssl/certs:/etc/ssl/certs:ro -v "$containers/npmrc:/root/.npmrc:ro")
  { cat "$HOME/.npmrc" 2>/dev/null || true; echo "cafile=/etc/ssl/certs/ca-certificates.crt"; } >"$containers/npmrc"
  chmod 600 "$containers/npmrc"
  TMPDIR=$cache buildah bud "${options[@]}" -f "$2" -t "$1" . >"$log" 2>&1 && return 0
  { { grep -A12 '^not ok ' "$log" || true; } | head -n 100; tail -n 60 "$log"; } >&2
  return 1
}

# The engine of docker-compose, removed at the end.
service_pid=
chains_before=
forwarding=/proc/sys/net/ipv4/ip_forward
forwarding_before=
start_service() {
  chains_before=$(netavark_chains)
  forwarding_before=$(cat "$forwarding")
  export DOCKER_HOST=unix://$containers/podman.sock
  podman system service --time=0 "$DOCKER_HOST" >"$containers/service.log" 2>&1 8>&- &
  service_pid=$!
  for _ in {1..100}; do
    [[ ! -S $containers/podman.sock ]] || return 0
    sleep 0.1
  done
  cat "$containers/service.log" >&2
  return 1
}
netavark_chains() {
  local table
  for table in filter nat; do iptables -t "$table" -S 2>/dev/null | sed -n "s/^-N \(NETAVARK.*\)/$table \1/p"; done
}
clean_up() {
  podman pod rm --all --force >/dev/null 2>&1 || true
  podman rm --all --force --time 5 >/dev/null 2>&1 || true
  podman volume rm --all --force >/dev/null 2>&1 || true
  podman secret ls --quiet 2>/dev/null | xargs --no-run-if-empty podman secret rm >/dev/null 2>&1 || true
  podman network prune --force >/dev/null 2>&1 || true
  [[ -z $service_pid ]] || kill "$service_pid" 2>/dev/null || true
  rm -f "$containers/podman.sock"
  # netavark leaves empty chains and packet forwarding enabled.
  [[ -n $service_pid && -z $chains_before ]] || return 0
  [[ $(cat "$forwarding") == "$forwarding_before" ]] || echo "$forwarding_before" >"$forwarding"
  local table chain
  for table in filter nat; do
    iptables -t "$table" -S 2>/dev/null | sed -n 's/^-A \(.*-j NETAVARK.*\)/-D \1/p' |
      while read -r rule; do eval "iptables -t $table $rule" 2>/dev/null || true; done
  done
  netavark_chains | while read -r table chain; do iptables -t "$table" -F "$chain" 2>/dev/null || true; done
  netavark_chains | while read -r table chain; do iptables -t "$table" -X "$chain" 2>/dev/null || true; done
}
trap clean_up EXIT
trap 'exit 130' INT TERM
clean_up # of one that was killed

debian=$(sed -n 's/^ARG DEBIAN=//p' docker/Dockerfile)
base "$debian"
if [[ $part == suite || $part == programs ]]; then
  units=yes
  [[ $part == suite ]] || units=no
  echo "container: the $part on $debian"
  image papilio-suite tests/container/suite.Dockerfile "$units"
  grep -E 'tests passed|^Files=' "$containers/papilio-suite.log"
  exit
fi
image papilio docker/Dockerfile
image papilio-proxy docker/proxy.Dockerfile
image papilio-store docker/store.Dockerfile
[[ $part != images ]] || exit 0
start_service
if [[ $part == throughput ]]; then
  tests/container/throughput.sh
else
  prove --failures --comments --exec 'bats --tap' tests/container/*.bats
fi
