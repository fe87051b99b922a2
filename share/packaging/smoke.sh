#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# smoke.sh [BUILD] -- ice, a pile, two seconds, a table of statistics: by the programs of BUILD/bin, or of the PATH.
set -eu
[ $# -eq 0 ] || PATH=$(cd "$1" && pwd)/bin:$PATH
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
voronoi-ice -q --size 10x10 --floes 12 --concentration 0.8 --thickness 0.5 --radius 0.05 --velocity 0.5,0 \
    --keep-out circle:0,0,1 --seed 1 -o ice.dat
struct-import -q --cylinder 0.8,-3,3,0,0 -o leg.dat
printf '[structure]\nfile = leg.dat\n[water]\ncurrent = 0.5 0 0\n[run]\nduration = 2 s\n' >case.scene
dem-solve -q --ice ice.dat -o loads.tsv case.scene
loadstats -q -c fx loads.tsv | grep -q total
dem-solve --version
