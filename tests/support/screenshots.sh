#!/usr/bin/env bash
# screenshots.sh: makes the pictures that README shows, in client/web/screenshots.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
tests/support/coarse_meshes.sh release
build/release/papilio-gallery --sheet client/web/screenshots/shapes.png build/deps/meshes/cgal/{couplingdown,anchor,joint}.off
tests/support/demo_samples.sh build/screenshots/samples
PAPILIO_BUILD=$PWD/build/release node tests/web/screenshots.mjs client/web/screenshots build/screenshots/samples \
  tests/scenes/node_modules/@webxr-input-profiles/assets/dist/profiles/hp-mixed-reality/left.glb
