#!/usr/bin/env bash
# What checks docker/kubernetes: kubectl, which renders it (Debian's kubernetes-client, unpacked, not installed, into
# build/deps/kubectl), and Kubernetes' schemas and types by npm, as tests/container/package-lock.json has them.
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
