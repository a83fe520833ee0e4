#!/usr/bin/env bash
# Installs the tools that check docker/kubernetes: kubectl, which renders it (Debian's kubernetes-client, unpacked, not
# installed, into build/deps/kubectl), and Kubernetes' schemas and types by npm, as locked by
# tests/container/package-lock.json.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/support/apt.sh
source "$here/apt.sh"
# shellcheck source=tests/support/npm.sh
source "$here/npm.sh"

if [[ ! -d $deps/kubectl ]]; then
  unfinished=$(unfinished_folder kubectl)
  unpack_package kubernetes-client "$unfinished"
  mv -T "$unfinished" "$deps/kubectl"
fi

npm_packages "$here/../container" "the schemas of Kubernetes' objects"
