#!/usr/bin/env bash
# demo_samples.sh FOLDER: copies coarse real meshes from build/deps/meshes as samples of the viewer.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
mkdir -p "$1"
cp build/deps/meshes/bunny600.drc "$1/bunny.drc"
cp build/deps/meshes/elephant2k.drc "$1/elephant.drc"
