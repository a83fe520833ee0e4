#!/usr/bin/env bash
# Installs the linter of the OpenAPI document by package name into build/deps/redocly, which is not committed. Version 1
# is the last that runs on Debian 12's node.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/support/apt.sh
source "$here/apt.sh"
package=@redocly/cli@1.34.5

if [[ ! -d $deps/redocly ]]; then
  say "fetching the OpenAPI linter"
  unfinished=$(unfinished_folder redocly)
  (cd "$unfinished" && npm install --ignore-scripts --no-audit --no-fund "$package" </dev/null >npm.log 2>&1) || {
    cat "$unfinished/npm.log" >&2
    die "npm could not fetch $package"
  }
  mv -T "$unfinished" "$deps/redocly"
fi
