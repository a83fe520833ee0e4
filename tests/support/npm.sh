# Functions for npm packages, sourced by set-up scripts after apt.sh.
# shellcheck shell=bash disable=SC2154

# npm_packages FOLDER NAME: installs missing packages of FOLDER/package-lock.json into FOLDER/node_modules, which is not
# committed. The copy of the lock is written last and marks a complete installation.
npm_packages() {
  local copy=$1/node_modules/.papilio-lock.json log=$deps/npm.log
  ! cmp -s "$1/package-lock.json" "$copy" || return 0
  say "fetching $2"
  (cd "$1" && npm ci </dev/null >"$log" 2>&1) || {
    cat "$log" >&2
    die "npm could not fetch $2"
  }
  cp "$1/package-lock.json" "$copy"
}
