#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# one.sh ANGLE_SPEED_THICKNESS_SEED -- one run of the sweep; its row goes to $OUT/CASE.row. A row that is there stays.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=${OUT:-out} case=$1
[ -s "$out/$case.row" ] && exit 0
mkdir -p "$out"
IFS=_ read -r angle speed thickness seed <<END
$case
END
work=$(mktemp -d "$out/$case.XXXXXX")
trap 'rm -rf "$work"' EXIT

# The legs at +-8 m, turned by the angle against the drift; the places that floes leave free for them.
awk -v a="$angle" 'BEGIN {
    c = cos(a * atan2(0, -1) / 180); s = sin(a * atan2(0, -1) / 180)
    for (x = -8; x <= 8; x += 16)
        for (y = -8; y <= 8; y += 16)
            printf "%s%s %.9f,%.9f\n", y < 0 ? "s" : "n", x < 0 ? "w" : "e", x * c + y * s, y * c - x * s
}' >"$work/legs"
set -- # the options of struct-import
while read -r name at; do set -- "$@" -n "$name" --cylinder "0.6,-5,5,$at"; done <"$work/legs"
struct-import -q "$@" -o "$work/legs.dat"
set -- # those of voronoi-ice
while read -r name at; do set -- "$@" --keep-out "circle:$at,1.2"; done <"$work/legs"
voronoi-ice --gaps even -q --size 60x48 --origin -45,-24 --floes 110 --periodic xy --concentration 0.4 --thickness "$thickness" \
    --velocity "$speed,0" --seed "$seed" "$@" -o "$work/ice.dat"

# shellcheck disable=SC2086 # RUN is a list of options
dem-solve -q -j 1 --ice "$work/ice.dat" --structure "$work/legs.dat" --set "water.current=$speed 0 0" ${RUN:-} \
    -o "$work/loads.tsv" "$here/sweep.scene" 2>"$work/said"
awk -v angle="$angle" -v speed="$speed" -v thickness="$thickness" -v seed="$seed" -f "$here/row.awk" \
    "$work/loads.tsv" >"$work/row"
mv "$work/row" "$out/$case.row"
