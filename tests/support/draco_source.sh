#!/usr/bin/env bash
# draco_source.sh: the source of the installed Draco, from Debian's source package, into build/deps/draco-source. The
# fuzzer sees into what is built from it; where it is not to be had, the library itself serves.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/support/apt.sh
source "$here/apt.sh"
[[ ! -d $deps/draco-source ]] || exit 0

say "fetching Draco's source"
unfinished=$(unfinished_folder draco-source)
mkdir -p "$unfinished/lists/partial"
# Where the binary packages come from the source packages are too.
# shellcheck disable=SC2016 # apt-get expands it
apt-get indextargets --format 'deb-src $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
  sort -u >"$unfinished/sources.list"
# apt_source ARGUMENT...: apt-get that knows these sources alone and leaves the machine's lists as they are.
apt_source() {
  (cd "$unfinished" && apt_get -o "Dir::Etc::SourceList=$unfinished/sources.list" -o Dir::Etc::SourceParts=- \
    -o "Dir::State::Lists=$unfinished/lists" "$@")
}
version=$(dpkg-query -W -f '${source:Version}' libdraco-dev)
if apt_source update && apt_source source "draco=$version"; then
  mkdir "$unfinished/taken"
  mv "$unfinished"/draco-*/src "$unfinished/taken/"
  mv -T "$unfinished/taken" "$deps/draco-source"
else
  say "Draco's source is not to be had; the fuzzer will not see into Draco"
fi
rm -r "$unfinished"
