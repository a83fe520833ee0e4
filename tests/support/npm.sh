# Packages by npm, for set-up scripts, which source this file after apt.sh.
# shellcheck shell=bash disable=SC2154

# npm_packages FOLDER WHAT: those of FOLDER/package-lock.json, into FOLDER/node_modules, unless they are there; never
# committed. What is there is whole only once the copy of the lock is.
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
