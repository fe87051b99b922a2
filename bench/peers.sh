#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# peers.sh [BUILD [OUT]] -- compares dem-solve on the pack of bench_spheres with other programs that have the
# Hertz-Mindlin law, LAMMPS (lmp) and LIGGGHTS (liggghts), in turns on one thread: time per contact-step and error.
#   OUT/peers.tsv   a row for each pack and program; its head names the machine.  OUT is bench/results
# A program that is not installed has no rows; without either the table is left unchanged.  bench/README.md
# explains the columns and the differences of the programs.  The scene is in peers.lmp and peers.lig.
#   FLOE_QUICK=1        the pack of 1 000, once, in shorter windows
#   TURNS=3             number of runs of each program, in turn, with each of three skins of the neighbour lists of
#                       the peers; the fastest window of all is kept, with its skin
# shellcheck disable=SC2154 # build, out and peers are set by begin
set -u
LC_ALL=C OMP_NUM_THREADS=1
export LC_ALL OMP_NUM_THREADS
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
# shellcheck source=/dev/null # in the same folder
. "$bench/beside.sh"
begin peers "${1:-}" "${2:-}" lmp liggghts
quick=${FLOE_QUICK:-0}
[ "$quick" = 0 ] && turns=${TURNS:-3} packs='1 3 10' || turns=${TURNS:-1} packs=1
spheres=$build/tests/bench/bench_spheres

# The pack in the format of LAMMPS and LIGGGHTS.
data()
{
    awk 'NR == 1 {
            printf "pack\n\n%d atoms\n2 atom types\n\n", $1
            printf "0 %s xlo xhi\n0 %s ylo yhi\n-0.2 2 zlo zhi\n\nAtoms\n\n", $3, $3
            next
        }
        {
            print NR - 1, 1, sprintf("%.17g", 2 * $1), 917, $2, $3, $4
            v[NR - 1] = $5 " " $6 " " $7 " " $8 " " $9 " " $10
        }
        END { printf "\nVelocities\n\n"; for (k = 1; k < NR; k++) print k, v[k] }' "$1"
}

# peer PROGRAM TILES SKIN WINDOWS STEPS PARTS: windows of steps, each step cut in parts; leaves log and state.
peer()
{
    [ "$1" = lmp ] && deck=$bench/peers.lmp || deck=$bench/peers.lig
    dt=$(awk -v parts="$6" 'NR == 1 { printf "%.17g", $2 / parts; exit }' "pack.$2")
    "$1" -in "$deck" -log none -var data "data.$2" -var skin "$3" -var dt "$dt" -var windows "$4" \
        -var steps $(($5 * $6)) -var state state >log 2>&1 </dev/null || fail "$1: $(tail -n 2 log)"
}

# Contacts in state: pairs, and spheres on the floor.
contacts() { awk 'NF == 5 && !/^ITEM/ { n += $5 / 2 + ($4 < $1) } END { print n }' state; }

# Appends a row to rows: spheres, program, skin, ns in the fastest window, contacts.
time_own() # TILES STEPS
{
    "$spheres" 1 "$1" "$2" >log || fail "bench_spheres: $(tail -n 1 log)"
    awk 'END { printf "%d\tdem-solve\t-\t%s\t%.0f\n", $1, $5, $1 * $6 }' log >>rows
}
time_peer() # PROGRAM TILES SKIN WINDOWS STEPS
{
    peer "$@" 1
    awk -v n="$(head -n 1 "pack.$2")" -v p="$1" -v skin="$3" -v contacts="$(contacts)" '
        /^Loop time/ && $9 > 0 { t = $4 / $9; least = least == "" || t < least ? t : least }
        END { printf "%d\t%s\t%s\t%.2f\t%.0f\n", n, p, skin, 1e9 * least / contacts, contacts }' log >>rows
}

# error_of A B: root mean square of the differences of the positions in A and B, over that of the displacements in B.
error_of()
{
    awk -v side="$(awk '{ print $3; exit }' pack.1)" '
        function image(d) { return d - side * int(d / side + (d < 0 ? -0.5 : 0.5)) }
        FNR == 1 { file++; n = 0 }
        NF < 5 || /^ITEM/ { next }
        {
            n++
            for (k = 2; k < 5; k++) {
                x[file, n, k] = $k
                if (file == 3) {
                    off += image(x[1, n, k] - $k) ^ 2
                    moved += image(x[2, n, k] - $k) ^ 2
                }
            }
        }
        END { printf "%.2g", sqrt(off / moved) }' "$1" pack.1 "$2"
}

# Numbers of parts that a step is divided into; errors are against the last.
parts='1 2 4 8 16 64'

# states PROGRAM: states of the pack after 400 steps, for each division of the step.
states()
{
    for cut in $parts; do
        if [ "$1" = dem-solve ]; then
            "$spheres" pack 1 400 "$cut" >state || fail "bench_spheres: no state"
        else
            peer "$1" 1 0.005 1 400 "$cut"
        fi
        mv state "$1.$cut"
    done
}

for tiles in $packs; do
    "$spheres" pack "$tiles" 0 1 >"pack.$tiles" || fail "bench_spheres: no pack"
    data "pack.$tiles" >"data.$tiles"
done
: >rows
turn=0
while [ $turn -lt "$turns" ]; do
    turn=$((turn + 1))
    for tiles in $packs; do
        case $tiles:$quick in
        1:0) steps=200 windows=40 ;;
        3:*) steps=50 windows=40 ;;
        10:*) steps=10 windows=40 ;;
        *) steps=50 windows=10 ;;
        esac
        for skin in 0.002 0.005 0.01; do # every program gets the same number of windows
            time_own "$tiles" $steps
            for p in $peers; do time_peer "$p" "$tiles" $skin $windows $steps; done
        done
    done
done
for p in dem-solve $peers; do
    states "$p"
    for cut in $parts; do
        printf '%s\t%s\t%s\n' "$p" "$cut" "$(error_of "$p.$cut" "$p.64")"
    done
    printf '%s\t%s\t%s\n' "$p" difference "$(error_of "$p.64" dem-solve.64)"
done >errors

for p in dem-solve $peers; do printf '%s\t%s\n' "$p" "$(version "$p")"; done >versions
{
    heading "$turns turns"
    printf 'spheres\tprogram\tversion\tskin[m]\tns\tratio\tcontacts\terror\terror_half\tdifference'
    printf '\tns_1e-3\tratio_1e-3\tns_1e-4\tratio_1e-4\n'
    awk 'BEGIN { FS = OFS = "\t" }
        # Fraction of the step with error e, by a power law between the steps on either side; 1 if the
        # whole step has no larger error.
        function part(p, e,  k) {
            if (error[p, 1] <= e) return 1
            for (k = 2; k <= 16 && error[p, k] > e;) k *= 2
            if (k > 16) return 0
            return exp(log(e / error[p, k]) / log(error[p, k / 2] / error[p, k]) * log(2)) / k
        }
        function at(p, ns, e) { return part(p, e) > 0 ? ns / part(p, e) : "-" }
        function both(p, ns, own, e) {
            if (at(p, ns, e) == "-" || at("dem-solve", own, e) == "-") return "-" OFS "-"
            return sprintf("%.1f", at(p, ns, e)) OFS sprintf("%.2f", at(p, ns, e) / at("dem-solve", own, e))
        }
        FILENAME == "versions" { version[$1] = $2; next }
        FILENAME == "errors" { error[$1, $2] = $3; next }
        !(($1, $2) in ns) { list[++n] = $1 SUBSEP $2 }
        !(($1, $2) in ns) || $4 < ns[$1, $2] { ns[$1, $2] = $4; rest[$1, $2] = $5; skin[$1, $2] = $3 }
        END {
            for (k = 1; k <= n; k++) {
                split(list[k], of, SUBSEP)
                print of[1], of[2], version[of[2]], skin[list[k]], ns[list[k]],
                    sprintf("%.2f", ns[list[k]] / ns[of[1], "dem-solve"]), rest[list[k]], error[of[2], 1],
                    error[of[2], 2], error[of[2], "difference"], both(of[2], ns[list[k]], ns[of[1], "dem-solve"], 1e-3),
                    both(of[2], ns[list[k]], ns[of[1], "dem-solve"], 1e-4)
            }
        }' versions errors rows
} >peers.tsv
keep
