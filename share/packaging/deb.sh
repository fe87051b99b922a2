#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# deb.sh BUILD [source] -- make BUILD/deb/dilateddem_VERSION.dsc and .tar.xz from the files of the tree, and the binary
# package unless `source` is given.  What dpkg-dev and debhelper need is said where it is not there.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
for program in dpkg-buildpackage dh fakeroot; do
    command -v $program >/dev/null || {
        echo "deb: $program is not there (packages dpkg-dev debhelper fakeroot)" >&2
        exit 2
    }
done
version=$(sed -n 's/^#define FL_VERSION "\(.*\)"/\1/p' "$root/lib/base/tool.h")
mkdir -p "$1/deb"
out=$(cd "$1/deb" && pwd)
rm -rf "$out/dilateddem-$version"
mkdir "$out/dilateddem-$version"
cd "$root"
# Files under version control where there is one, else all but builds.
if git rev-parse --git-dir >/dev/null 2>&1; then
    git ls-files -z | xargs -0 tar -cf - --
else
    tar --exclude=./build --exclude='./build-*' --exclude=out -cf - .
fi | tar -xf - -C "$out/dilateddem-$version"
sh share/packaging/source.sh >"$out/dilateddem-$version/SOURCE"
cd "$out/dilateddem-$version"
mv share/packaging/debian debian
printf 'dilateddem (%s) unstable; urgency=medium\n\n  * See CHANGES.md.\n\n -- DilatedDEM developers <dilateddem@example.org>  %s\n' \
    "$version" "$(date -R -d "@${SOURCE_DATE_EPOCH:-$(stat -c %Y CHANGES.md)}")" >debian/changelog
dpkg-source -b .
if [ "${2-}" = source ]; then
    ls "$out"/*.dsc
else
    dpkg-buildpackage -b -us -uc
    ls "$out"/*.deb
fi
