#!/usr/bin/env bash
# The packages of the viewer, of its build and of its tests, as client/web/package-lock.json has them.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/support/apt.sh
source "$here/apt.sh"
# shellcheck source=tests/support/npm.sh
source "$here/npm.sh"
npm_packages "$here/../../client/web" "the viewer's packages"
