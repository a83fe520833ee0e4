#!/usr/bin/env bash
# screenshots.sh: makes the pictures and the recording of README in client/web/screenshots.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
rm -rf build/screenshots/frames
tests/support/coarse_meshes.sh release
build/release/papilio-gallery --sheet client/web/screenshots/shapes.png build/deps/meshes/cgal/{couplingdown,anchor,joint}.off
tests/support/demo_samples.sh build/screenshots/samples
PAPILIO_BUILD=$PWD/build/release node tests/web/screenshots.mjs client/web/screenshots build/screenshots/samples \
  tests/scenes/node_modules/@webxr-input-profiles/assets/dist/profiles/hp-mixed-reality/left.glb \
  build/screenshots/frames
img2webp -loop 0 -lossy -q 60 -m 6 -d 70 build/screenshots/frames/*.png -o client/web/screenshots/viewer.webp >/dev/null
