# Functions for Debian packages, sourced by the set-up scripts.
# shellcheck shell=bash

deps=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/build/deps

say() { printf 'setup: %s\n' "$*"; }
die() {
  printf 'setup: %s\n' "$*" >&2
  exit 1
}

# apt_get ARGUMENT...: runs apt-get quietly; prints its output if it fails. Root downloads into the project's folders,
# which apt's sandbox user cannot write to: the sandbox is off to avoid warnings.
apt_get() {
  local log="$deps/apt.log"
  apt-get -qq -o APT::Sandbox::User=root -o DPkg::Lock::Timeout=600 "$@" >"$log" 2>&1 </dev/null || {
    cat "$log" >&2
    return 1
  }
}

# as_root NAME ARGUMENT...: runs apt-get as root, or prints the command to run.
as_root() {
  if ((EUID == 0)); then
    DEBIAN_FRONTEND=noninteractive apt_get "$@"
  elif command -v sudo >/dev/null; then
    sudo env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=600 "$@" </dev/null
  else
    die "this needs root: run as root \`apt-get $*\`, then this again"
  fi
}

# Runs once per set-up, only if something is fetched. Retries once after a failed download. A list that fails again may
# be unused.
apt_update() {
  [[ -z ${PAPILIO_APT_UPDATED:-} ]] || return 0
  export PAPILIO_APT_UPDATED=yes
  say "refreshing the package lists"
  as_root -o APT::Update::Error-Mode=any update 2>/dev/null && return 0
  sleep 10
  as_root update || say "some package lists could not be refreshed; going on with what there is"
}

apt_install() {
  if ((EUID != 0)) && ! command -v sudo >/dev/null; then
    die "this needs root: run \`apt-get update && apt-get install -y --no-install-recommends $*\` as root, then this again"
  fi
  apt_update
  local count began=$SECONDS
  count=$(apt-get install --simulate --no-install-recommends "$@" 2>/dev/null | grep -c '^Inst ') || true
  say "installing $count packages (about $((count / 150 + 1)) min): $*, and what they need"
  as_root install -y --no-install-recommends "$@" || { sleep 10 && as_root install -y --no-install-recommends "$@"; } ||
    die "could not install: $*"
  say "installed in $((SECONDS - began)) s"
}

# unpack_package PACKAGE FOLDER: unpacks the package's files into FOLDER without installing it or its dependencies.
unpack_package() {
  say "unpacking $1"
  if ! (cd "$2" && apt_get download "$1" 2>/dev/null); then
    apt_update
    (cd "$2" && apt_get download "$1") || die "could not download $1"
  fi
  dpkg-deb -x "$2/$1"_*.deb "$2"
  rm "$2/$1"_*.deb
}

# unfinished_folder NAME: makes an empty folder in build/deps, to be filled and then renamed: an interrupted set-up never
# leaves a folder that looks complete.
unfinished_folder() {
  rm -rf "$deps/$1.unfinished"
  mkdir -p "$deps/$1.unfinished"
  printf '%s\n' "$deps/$1.unfinished"
}
