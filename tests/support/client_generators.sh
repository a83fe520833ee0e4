#!/usr/bin/env bash
# Installs the generators of clients from the OpenAPI document, as locked by tests/openapi/package-lock.json.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/support/apt.sh
source "$here/apt.sh"
# shellcheck source=tests/support/npm.sh
source "$here/npm.sh"
npm_packages "$here/../openapi" "the generators of clients"
