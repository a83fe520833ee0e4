#!/usr/bin/env bash
# demo_samples.sh FOLDER: real coarse meshes as samples for the viewer, from build/deps/meshes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
mkdir -p "$1"
cp build/deps/meshes/bunny600.drc "$1/bunny.drc"
cp build/deps/meshes/elephant2k.drc "$1/elephant.drc"
