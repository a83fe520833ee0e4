#!/usr/bin/env bash
# web_test.sh [OPTION]... FILE: runs one file of tests/web under node, for prove. Its TAP has YAML that prove cannot read;
# here what failed comes as comments.
set -euo pipefail
node --test-reporter=tap "$@" |
  sed -E '/^TAP version/d; /^ +(---|\.\.\.|(duration_ms|type|location|failureType|code|name):.*)$/d; s/^ +/#   /'
