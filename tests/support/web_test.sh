#!/usr/bin/env bash
# web_test.sh [OPTION]... FILE: runs one file of tests/web under node for prove, which cannot read the YAML in node's TAP:
# failures are printed as comments.
set -euo pipefail
node --test-reporter=tap "$@" |
  sed -E '/^TAP version/d; /^ +(---|\.\.\.|(duration_ms|type|location|failureType|code|name):.*)$/d; s/^ +/#   /'
