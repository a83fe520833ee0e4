#!/usr/bin/env bash
# What makes clients out of the OpenAPI document, as tests/openapi/package-lock.json has it.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/support/apt.sh
source "$here/apt.sh"
# shellcheck source=tests/support/npm.sh
source "$here/npm.sh"
npm_packages "$here/../openapi" "the generators of clients"
