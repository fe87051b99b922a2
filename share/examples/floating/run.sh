#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh OUT NAME "l b h z heel" [SET ...] -- one floe, its motion to OUT/NAME.dat (state(5)).
out=$1 name=$2 size=$3
shift 3
set -f
# shellcheck disable=SC2086 # five numbers
set -- $size "$@"
l=$1 b=$2 h=$3 z=$4 heel=$5
shift 5
awk -v "l=$l" -v "b=$b" -v "h=$h" -v "z=$z" -v "heel=$heel" -f box.awk >"$out/$name.ice" || exit
for s; do
    set -- "$@" --set "$s"
    shift
done
exec dem-solve -q --ice "$out/$name.ice" --set "output.state=$out/$name.dat" "$@" -o "$out/$name.loads" floating.scene
