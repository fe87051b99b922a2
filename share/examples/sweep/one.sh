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

# The legs at +-8 m in the axes of the platform, and as dem-solve turns them back by the angle: there floes leave room.
struct-import -q -n sw --cylinder 0.6,-5,5,-8,-8 -n nw --cylinder 0.6,-5,5,-8,8 -n se --cylinder 0.6,-5,5,8,-8 \
    -n ne --cylinder 0.6,-5,5,8,8 -o "$work/legs.dat"
struct-import -q --rotate "0,0,-1,$angle" "$work/legs.dat" -o "$work/turned.dat"
voronoi-ice --gaps even -q --size 60x48 --origin -45,-24 --floes 110 --periodic xy --concentration 0.4 --thickness "$thickness" \
    --velocity "$speed,0" --seed "$seed" --keep-out "$work/turned.dat" --margin 0.6 -o "$work/ice.dat"

# shellcheck disable=SC2086 # RUN is a list of options
dem-solve -q -j 1 --ice "$work/ice.dat" --structure "$work/legs.dat" --direction "${angle}deg" \
    --set "water.current=$speed 0 0" ${RUN:-} -o "$work/loads.tsv" "$here/sweep.scene" 2>"$work/said" || {
    cat "$work/said" >&2
    exit 1
}
awk -v angle="$angle" -v speed="$speed" -v thickness="$thickness" -v seed="$seed" -f "$here/row.awk" \
    "$work/loads.tsv" >"$work/row"
mv "$work/row" "$out/$case.row"
