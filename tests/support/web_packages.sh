#!/usr/bin/env bash
# The packages of the viewer, of its build and of its tests, as client/web/package-lock.json has them, by npm into
# client/web/node_modules; never committed.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/support/apt.sh
source "$here/apt.sh"
cd "$here/../../client/web"

# What is there is whole only once the copy of the lock is.
copy=node_modules/.papilio-lock.json
if ! cmp -s package-lock.json "$copy"; then
  say "fetching the viewer's packages"
  npm ci </dev/null >"$deps/web_packages.log" 2>&1 || {
    cat "$deps/web_packages.log" >&2
    die "npm could not fetch the viewer's packages"
  }
  cp package-lock.json "$copy"
fi
