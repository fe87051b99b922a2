#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# instructions.sh [update] -- instruction counts by callgrind, which do not depend on the load of the machine.
# Prints them beside those kept in instructions.txt, with their ratio; `update` keeps the new ones.  They hold
# for the vector width that valgrind supports.  Cases:
#   1, 2, ...           one contact of that case of bench_contact
#   surrogate-2, ...    the same with surrogates of 1e-3, one of eight contacts, exact evaluations included
#   quick-2, ..., quick-surrogate-2, ...  both of the law quick
#   wall, cylinder, hull  bench_structure: a wall of 20 000 triangles, an exact cylinder, a hull of 50 000
#                       triangles; `-edge`: edge-on
#   spheres, rolls      a contact and step of spheres in a lattice, everything included; with rolling resistance
#   dry, water, added, waves, held, facets
#                       a body and step of floes without contacts
#   members             a contact and step of a dome of members, its share of the balls included
#   bonds               a bond and step, its share of the bodies included
#   hard-S, plain-S     a step of a floe on S, a wall, pile, cone, mesh or floe (ice), elastic, and with
#                       crushing_law = plain; quick-hard-ice, quick-plain-ice: under the law quick
#   whole, strong       a body and step of 200 floes among piles; with failures, of which none happens
#   strip-31, strip-248 a step of a pile in ice that crushes by its speed, with 31 and 248 elements on its front
#   sums-one, sums-any  a body and step of floes with contacts: ordered sums, and sums in the order of threads,
#                       which lock every sum
# Variables:
#   BENCH  the folder of the benchmark programs
#   ONLY   the one case that is counted
set -e
cd "$(dirname "$0")"
BENCH=${BENCH:-../../build/tests/bench}
FEW=200 MANY=1200 CASES=11
kept=instructions.txt
fresh=$(mktemp)
trap 'rm -f "$fresh"' EXIT

counted() { # program, its arguments: instructions, and the number of units if the program prints it
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$BENCH/$1" "$2" "$3" ${4:+"$4"} ${5:+"$5"} 2>&1 |
        awk '/^[0-9]+$/ { units = $1 } /Collected/ { print $NF, units }'
}

each() { # name, program, its argument, few, many, units between the two if the program does not print them, tolerance, law
    [ -z "$ONLY" ] || [ "$ONLY" = "$1" ] || return 0
    echo "$(counted "$2" "$3" "$4" "$7" "$8") $(counted "$2" "$3" "$5" "$7" "$8")" | awk -v name="$1" -v n="$6" '
        { printf "%s %.0f\n", name, n ? ($2 - $1) / n : ($3 - $1) / ($4 - $2) }'
}

all() {
    k=1
    while [ $k -lt $CASES ]; do
        each $k bench_contact $k $FEW $MANY $((MANY - FEW))
        k=$((k + 1))
    done
    for k in 2 5 6; do each surrogate-$k bench_contact $k 4000 6000 2000 0.001; done
    for k in 2 3 4 5 6 7; do
        each quick-$k bench_contact $k $FEW $MANY $((MANY - FEW)) 0 quick
        each quick-surrogate-$k bench_contact $k 4000 6000 2000 0.001 quick
    done
    each wall bench_structure 4 $FEW $MANY $((MANY - FEW))
    each cylinder bench_structure 18 $FEW $MANY $((MANY - FEW))
    each cylinder-edge bench_structure 19 $FEW $MANY $((MANY - FEW))
    each hull bench_structure 24 $FEW $MANY $((MANY - FEW))
    each hull-edge bench_structure 25 $FEW $MANY $((MANY - FEW))
    each spheres bench_spheres count 20 120
    each rolls bench_spheres rolls 20 120
    each dry bench_step dry 20 120
    each sums-one bench_step one 500 1500
    each sums-any bench_step any 500 1500
    each water bench_step water 20 120
    each added bench_step added 20 120
    each waves bench_step waves 20 120
    each held bench_step held 20 120
    each facets bench_step facets 20 120
    each bonds bench_step bonds 20 120
    each members bench_members count 20 120
    for k in wall-hard wall-plain pile-hard pile-plain cone-hard cone-plain mesh-hard mesh-plain ice-hard ice-plain; do
        each ${k#*-}-${k%-*} bench_strip ${k#*-}-${k%-*} $FEW $MANY
    done
    for k in hard plain; do each quick-$k-ice bench_strip quick-$k-ice $FEW $MANY; done
    for k in whole strong; do each $k bench_step $k 200 600; done
    for k in 31 248; do each strip-$k bench_strip pile-$k $FEW $MANY; done
}
all > "$fresh"

if [ "$1" = update ]; then
    awk 'NR == FNR { now[$1] = $2; next } { print $1, $1 in now ? now[$1] : $2; delete now[$1] }
         END { for (k in now) print k, now[k] }' "$fresh" $kept > "$fresh.all"
    mv "$fresh.all" $kept
fi
awk 'NR == FNR { kept[$1] = $2; next }
     FNR == 1 { printf "%13s %12s %12s %7s\n", "case", "kept", "now", "ratio" }
     { printf "%13s %12d %12d %7.3f\n", $1, kept[$1], $2, kept[$1] ? $2 / kept[$1] : 0 }' $kept "$fresh"
