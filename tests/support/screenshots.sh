#!/usr/bin/env bash
# screenshots.sh: makes the pictures of the viewer that README shows, in client/web/screenshots.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
tests/support/coarse_meshes.sh release
tests/support/demo_samples.sh build/screenshots/samples
PAPILIO_BUILD=$PWD/build/release node tests/web/screenshots.mjs client/web/screenshots build/screenshots/samples
