#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# one.sh SEED -- one run of the ensemble: its own field of ice, its loads, their summary.
# Writes SEED.sum, and SEED.loads and SEED.report beside it, into the folder OUT (out); needs OUT/leg.dat, which
# `make OUT/leg.dat` makes. The same seed gives the same files, on every machine and in any order.
set -eu
cd "$(dirname "$0")"
seed=$1 out=${OUT:-out}

# A field of 24 m x 16 m that drifts along x; the cylinder stands downstream of it.
voronoi-ice --gaps even --size 24x16 --floes 48 --concentration 0.8 --thickness 0.5 --radius 0.05 --velocity 0.5,0 \
    --seed "$seed" -q -o "$out/$seed.ice"
dem-solve -j 1 -q --ice "$out/$seed.ice" --structure "$out/leg.dat" --report "$out/$seed.report" \
    -o "$out/$seed.loads" ensemble.scene
rm "$out/$seed.ice"
# Statistics begin at 9 s, when the front has passed the cylinder by two diameters.
loadstats --summary --from "${FROM:-9}" --component fx,fh --part leg --block 5 "$out/$seed.loads" -o "$out/$seed.sum"
