#!/usr/bin/env bash
# Installs the packages of the viewer, its build and its tests, as locked by client/web/package-lock.json.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/support/apt.sh
source "$here/apt.sh"
# shellcheck source=tests/support/npm.sh
source "$here/npm.sh"
npm_packages "$here/../../client/web" "the viewer's packages"
