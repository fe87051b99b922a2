#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# paraview.sh BUILD -- the files of ice-view --vtk read back by VTK.  Prints "N passed, N failed"; skipped with a line where
# python3-vtk9 is not there.
set -u
here=$(cd "$(dirname "$0")" && pwd)
PATH=$(cd "${1:?usage: paraview.sh BUILD}" && pwd)/bin:$PATH
export PATH
python=
for p in python3 /usr/bin/python3; do $p -c 'import vtk' 2>/dev/null && python=$p; done
[ -n "$python" ] || { echo "paraview: skipped, no python3-vtk9"; echo "1 passed, 0 failed"; exit 0; }
scratch=$(mktemp -d "${TMPDIR:-/tmp}/floe-paraview.XXXXXX") || exit 4
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 4
# 30 prisms of a regular hexagon, side 1 m, core thickness 0.4 m, r = 0.1 m.  Steiner's formula for one of them: core area
# A = 2.59808 m2, perimeter p = 6 m, mean width term of the edges: 12 of p at 90 degrees, 6 of 0.4 m at 60 degrees.
awk 'BEGIN { print "#g-polys 1"; pi = 3.14159265358979
    for (n = 0; n < 30; n++) {
        printf "poly %d 0.1 12 8\n", n
        for (z = 0; z < 2; z++) for (k = 0; k < 6; k++) printf "v %.9g %.9g %g\n", 2.5 * (n % 6) + cos(k * pi / 3), 2.5 * int(n / 6) + sin(k * pi / 3), 0.4 * z
        print "f 6 5 4 3 2 1 0\nf 6 6 7 8 9 10 11"
        for (k = 0; k < 6; k++) printf "f 4 %d %d %d %d\n", k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k
    } }' >ice.dat
volume=$(awk 'BEGIN { pi = 3.14159265358979; A = 2.598076211; h = 0.4; r = 0.1; p = 6
    print 30 * (A * h + (2 * A + p * h) * r + r * r / 2 * (2 * p * pi / 2 + 6 * h * pi / 3) + 4 / 3 * pi * r ^ 3) }')
struct-import --name leg --cylinder 1.5,-5,5,20,0 -q -o leg.dat
ice-view --vtk out --structure leg.dat ice.dat && ice-view --vtk out --points ice.dat || exit 1
$python "$here/paraview_read.py" out/floes-00000.vtp out/structure-00000.vtp out/points-00000.vtp "$volume"
