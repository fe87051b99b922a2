#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# righting.sh OUT -- the righting arm GZ of a floe of 10 x 4 x 1 m against its heel, as a table on standard output.
# With fixed heel the floe heaves about its floating height.  A mean with weights that decrease towards both ends of the
# record, repeated five times, gives that height.
# Released there, the floe has the spin alpha t at first, and GZ = I alpha / (m g).
out=$1
hold="group.floe.fixed=x y rx ry rz"
mean()
{
    awk '/^[0-9]/ && NF > 5 { w = (1 - cos(2 * atan2(0, -1) * $1 / 20))^2; n += w; s += w * $5 } END { printf "%.17g\n", s / n }' "$1"
}
printf 'heel[deg]\tGZ[m]\n'
for heel in 1 2 5 10 20 45; do
    z=-0.378
    for _ in 1 2 3 4 5; do
        sh run.sh "$out" righting "10 4 1 $z $heel" "$hold" || exit
        z=$(mean "$out/righting.dat")
    done
    sh run.sh "$out" righting "10 4 1 $z $heel" "run.duration=1 ms" "run.dt=0.1 ms" "output.state_every=1 ms" || exit
    awk -v "heel=$heel" '/^[0-9]/ && NF > 5 { t = $1; spin = $13 }
        END { printf "%s\t%.8f\n", heel, -spin / t * (4 * 4 + 1) / 12 / 9.81 }' "$out/righting.dat"
done
