#!/usr/bin/env bash
# library_source.sh SOURCE PACKAGE: copies the folder src of the Debian source package SOURCE, in the version of the
# installed PACKAGE, to build/deps/SOURCE-source. Fails if it is not available.
set -euo pipefail
source_package=$1 package=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/support/apt.sh
source "$here/apt.sh"
[[ ! -d $deps/$source_package-source ]] || exit 0

say "fetching the source of $source_package"
unfinished=$(unfinished_folder "$source_package-source")
trap 'rm -rf "$unfinished"' EXIT
mkdir -p "$unfinished/lists/partial"
# Source packages are at the sites of the binary packages.
# shellcheck disable=SC2016 # apt-get expands it
apt-get indextargets --format 'deb-src $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
  sort -u >"$unfinished/sources.list"
# apt_source ARGUMENT...: runs apt-get with only these sources, without changes to the machine's lists.
apt_source() {
  (cd "$unfinished" && apt_get -o "Dir::Etc::SourceList=$unfinished/sources.list" -o Dir::Etc::SourceParts=- \
    -o "Dir::State::Lists=$unfinished/lists" "$@")
}
version=$(dpkg-query -W -f '${source:Version}' "$package")
if ! { apt_source update && apt_source source "$source_package=$version"; }; then
  say "the source of $source_package is not to be had"
  exit 1
fi
mkdir "$unfinished/taken"
mv "$unfinished/$source_package"-*/src "$unfinished/taken/"
mv -T "$unfinished/taken" "$deps/$source_package-source"
