#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# blocks.sh [BUILD [OUT]] -- 216 blocks beside other programs that know polyhedra, Rockable (rockable), LAMMPS
# (lmp) and YADE (yade), in turns on one thread: time of a step, and what becomes of the energy of a gas of
# blocks that rub on nothing and lose nothing.
#   OUT/blocks.tsv   a row for each scene and program; its head names the machine.  OUT is bench/results
# A program that is not there has no rows; where none is, the table stays as it is.  What the columns are, and
# in what the programs differ: bench/README.md.  The blocks are made by blocks.awk; blocks.lmp and blocks.py
# are what LAMMPS and YADE do with them.
#   TURNS=3        how often the pack is timed by each; the least counts
#   FLOE_QUICK=1   the gas for a tenth of the time, the pack once, in shorter windows
# shellcheck disable=SC2154 # of begin
set -u
LC_ALL=C OMP_NUM_THREADS=1
export LC_ALL OMP_NUM_THREADS
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
# shellcheck source=/dev/null # it lies beside this file
. "$bench/beside.sh"
begin blocks "${1:-}" "${2:-}" rockable lmp yade
[ "${FLOE_QUICK:-0}" = 0 ] && turns=${TURNS:-3} until=0.5 fewer=1 || turns=${TURNS:-1} until=0.05 fewer=5
bodies=216
PATH=$build/bin:$PATH

# blocks SCENE PROGRAM [DT UNTIL WINDOWS]: the blocks as the program reads them
blocks()
{
    awk -v scene="$1" -v as="$2" -v dt="${3:-0}" -v until="${4:-0}" -v windows="${5:-1}" -f "$bench/blocks.awk"
}

# Each runs a scene in steps of dt for so many and leaves in `told` rows: `step` seconds of the least window,
# `energy` at the start and at the end, `pairs` that touch.
floe() # SCENE DT STEPS SURROGATE
{
    blocks "$1" floe >ice.dat
    [ "$1" = gas ] && e=1 friction=0 || e=0.3 friction=0.3
    end=$(awk -v dt="$2" -v steps="$3" 'BEGIN { print dt * steps }')
    cat >scene <<END
#scene 1
[run]
gravity = 0
threads = 1
dt = $2
duration = $end
[contact]
restitution = $e
friction = $friction
stiffness = 5e7
surrogate = $4
[output]
loads_every = $end
energy = energy
energy_every = $end
END
    dem-solve -q --ice ice.dat --report report -o loads scene 2>err || fail "dem-solve: $(cat err)"
    awk -v bodies=$bodies '
        /ns per body-step/ {
            print "step", $1 * bodies / 1e9
            for (k = 1; k < NF; k++) if (sub(/^\(/, "", $k)) print "pairs", $k
        }
        FILENAME == "energy" && /^[0-9]/ { printf "energy %.17g\n", $2 + $4 }' report energy >told
}
lmp_run() # SCENE DT STEPS
{
    blocks "$1" lmp >data
    [ "$1" = gas ] && elastic=1 windows=1 || elastic=0 windows=5
    lmp -in "$bench/blocks.lmp" -log none -var data data -var elastic "$elastic" -var dt "$2" \
        -var windows "$windows" -var steps $(($3 / windows)) >log 2>&1 </dev/null ||
        fail "lmp: $(tail -n 2 log)"
    awk '/^Loop time/ && $9 > 0 { t = $4 / $9; least = least == "" || t < least ? t : least }
        /^ *Step/ { next }
        NF == 3 && $1 ~ /^[0-9]+$/ { printf "energy %.17g\n", $2 + $3 }
        END { print "step", least }' log >told
}
yade_run() # SCENE DT STEPS
{
    blocks "$1" yade >placed
    [ "$1" = gas ] && elastic=1 windows=1 || elastic=0 windows=5
    BLOCKS=placed ELASTIC=$elastic DT=$2 WINDOWS=$windows STEPS=$(($3 / windows)) \
        yade -n -x -j 1 "$bench/blocks.py" >log 2>err </dev/null || fail "yade: $(tail -n 2 err)"
    awk '/^energy/ { print }
        /^window/ { least = least == "" || $2 < least ? $2 : least }
        END { print "step", least }' log >told
}
rockable_run() # SCENE DT STEPS
{
    end=$(awk -v dt="$2" -v n="$3" 'BEGIN { print dt * n }')
    [ "$1" = gas ] && windows=20 || windows=5
    rm -rf rock && mkdir rock
    blocks "$1" rockable "$2" "$end" "$windows" >all
    sed '/^shape$/,$d' all >rock/input
    sed '1,/^shape$/d' all >rock/block.shp
    (cd rock && rockable input) >log 2>&1 </dev/null || fail "rockable: $(tail -n 2 log)"
    # it tells seconds of the scene for a second of its own, window by window
    awk -v scene="$1" -v dt="$2" '
        FILENAME ~ /perf/ { n++; t = dt / $2; sum += t; least = least == "" || t < least ? t : least; next }
        { e = $2 + $3 }
        FNR == 1 { printf "energy %.17g\n", e }
        END { printf "energy %.17g\n", e; print "step", scene == "gas" ? sum / n : least }' \
        rock/perf.txt rock/kineticEnergy.txt >told
}

run() # PROGRAM SCENE DT STEPS SURROGATE
{
    case $1 in
    floe) floe "$2" "$3" "$4" "$5" ;;
    *) "$1_run" "$2" "$3" "$4" ;;
    esac
}

# name PROGRAM SURROGATE: as the table has it
name() { [ "$1:$2" = floe:0 ] || [ "$1" != floe ] && echo "$1" || echo "$1, $2"; }

# What each does in the gas: by steps of 0.1 ms, and of half of that.
for p in floe $peers; do
    for tol in 0 1e-3; do
        [ "$p:$tol" = floe:1e-3 ] || [ $tol = 0 ] || continue
        for dt in 0.0001 0.00005; do
            run "$p" gas $dt "$(awk -v t="$until" -v dt=$dt 'BEGIN { printf "%.0f", t / dt }')" $tol
            awk -v name="$(name "$p" $tol)" -v dt=$dt -v OFS='\t' '
                $1 == "step" { step = $2 }
                $1 == "energy" && !n++ { before = $2 }
                $1 == "energy" { after = $2 }
                END { printf "gas\t%s\t%s\t%s\t-\t%.17g\n", name, dt, step, after / before - 1 }' told >>rows
        done
    done
done
turn=0
while [ $turn -lt "$turns" ]; do
    turn=$((turn + 1))
    for p in floe $peers; do
        case $p in
        floe | rockable) steps=$((100 / fewer)) ;;
        lmp) steps=$((50 / fewer)) ;;
        yade) steps=5 ;;
        esac
        for tol in 0 1e-3; do
            [ "$p:$tol" = floe:1e-3 ] || [ $tol = 0 ] || continue
            run "$p" pack 0.0001 "$steps" $tol
            awk -v name="$(name "$p" $tol)" -v OFS='\t' '
                $1 == "step" { step = $2 }
                $1 == "pairs" { pairs = $2 }
                END { print "pack", name, "0.0001", step, pairs, "-" }' told >>rows
        done
    done
done

cut -f 2 rows | sort -u | while read -r p; do printf '%s\t%s\n' "$p" "$(version "$p")"; done >versions
{
    heading "$turns turns of the pack"
    echo "#seconds $until of the gas"
    printf 'scene\tprogram\tversion\tdt[s]\tbody_step[ns]\tpair_step[ns]\tratio\tenergy\n'
    awk -v bodies=$bodies 'BEGIN { FS = OFS = "\t" }
        FILENAME == "versions" { version[$1] = $2; next }
        !(($1, $2, $3) in step) { list[++n] = $1 SUBSEP $2 SUBSEP $3 }
        !(($1, $2, $3) in step) || $4 < step[$1, $2, $3] { step[$1, $2, $3] = $4 }
        $5 > 0 { pairs[$1] = $5 } # the same blocks at the same places for all
        { energy[$1, $2, $3] = $6 }
        END {
            for (k = 1; k <= n; k++) {
                split(list[k], of, SUBSEP)
                t = step[list[k]]
                print of[1], of[2], version[of[2]], of[3], sprintf("%.4g", 1e9 * t / bodies),
                    of[1] == "pack" ? sprintf("%.4g", 1e9 * t / pairs["pack"]) : "-",
                    sprintf("%.3g", t / step[of[1], "floe", of[3]]),
                    of[1] == "gas" ? sprintf("%.2g", energy[list[k]]) : "-"
            }
        }' versions rows
} >blocks.tsv
keep
