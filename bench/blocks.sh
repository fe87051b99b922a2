#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# blocks.sh [BUILD [OUT]] -- compares dem-solve with other programs for polyhedra, Rockable (rockable), LAMMPS
# (lmp) and YADE (yade), on 216 blocks and one thread: time of a step, and change of the energy of a gas of
# elastic blocks without friction.
#   OUT/blocks.tsv   a row for each scene and program; its head names the machine.  OUT is bench/results
# A program that is not installed has no rows; without any of them the table is left unchanged.  bench/README.md
# explains the columns and the differences of the programs.  blocks.awk writes the blocks; blocks.lmp and
# blocks.py are the input scripts of LAMMPS and YADE.
#   TURNS=3        number of timings of the pack per program; the least is kept
#   FLOE_QUICK=1   a tenth of the duration of the gas, one timing of the pack in shorter windows
# shellcheck disable=SC2154 # build, out and peers are set by begin
set -u
LC_ALL=C OMP_NUM_THREADS=1
export LC_ALL OMP_NUM_THREADS
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
# shellcheck source=/dev/null # in the same folder
. "$bench/beside.sh"
begin blocks "${1:-}" "${2:-}" rockable lmp yade
[ "${FLOE_QUICK:-0}" = 0 ] && turns=${TURNS:-3} until=0.5 fewer=1 || turns=${TURNS:-1} until=0.05 fewer=5
bodies=216
PATH=$build/bin:$PATH

# blocks SCENE PROGRAM [DT UNTIL WINDOWS]: writes the blocks in the format of the program
blocks()
{
    awk -v scene="$1" -v as="$2" -v dt="${3:-0}" -v until="${4:-0}" -v windows="${5:-1}" -f "$bench/blocks.awk"
}

# PROGRAM_run SCENE DT STEPS: runs the scene and writes rows to the file `measured`: `step` with the seconds of a
# step in the fastest window, `energy` at the start and at the end, `pairs` in contact.
dem_solve_run() # SCENE DT STEPS LAW:SURROGATE
{
    blocks "$1" dem-solve >ice.dat
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
law = ${4%:*}
stiffness = 5e7
surrogate = ${4#*:}
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
        FILENAME == "energy" && /^[0-9]/ { printf "energy %.17g\n", $2 + $4 }' report energy >measured
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
        END { print "step", least }' log >measured
}
yade_run() # SCENE DT STEPS
{
    blocks "$1" yade >placed
    [ "$1" = gas ] && elastic=1 windows=1 || elastic=0 windows=5
    BLOCKS=placed ELASTIC=$elastic DT=$2 WINDOWS=$windows STEPS=$(($3 / windows)) \
        yade -n -x -j 1 "$bench/blocks.py" >log 2>err </dev/null || fail "yade: $(tail -n 2 err)"
    awk '/^energy/ { print }
        /^window/ { least = least == "" || $2 < least ? $2 : least }
        END { print "step", least }' log >measured
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
    # perf.txt holds simulated seconds per second of computing, window by window
    awk -v scene="$1" -v dt="$2" '
        FILENAME ~ /perf/ { n++; t = dt / $2; sum += t; least = least == "" || t < least ? t : least; next }
        { e = $2 + $3 }
        FNR == 1 { printf "energy %.17g\n", e }
        END { printf "energy %.17g\n", e; print "step", scene == "gas" ? sum / n : least }' \
        rock/perf.txt rock/kineticEnergy.txt >measured
}

run() # PROGRAM SCENE DT STEPS LAW:SURROGATE
{
    case $1 in
    dem-solve) dem_solve_run "$2" "$3" "$4" "$5" ;;
    *) "$1_run" "$2" "$3" "$4" ;;
    esac
}

# laws PROGRAM: the laws and tolerances of surrogates it runs with
laws() { [ "$1" = dem-solve ] && echo "patch:0 patch:1e-3 quick:0 quick:1e-3" || echo patch:0; }
# name PROGRAM LAW:SURROGATE: the name in the table
name() { echo "$1, $2" | sed 's/, patch:/, /; s/, 0$//; s/:0$//; s/quick:/quick, /'; }

# The gas, in steps of 0.1 ms and 0.05 ms.
for p in dem-solve $peers; do
    for law in $(laws "$p"); do
        for dt in 0.0001 0.00005; do
            run "$p" gas $dt "$(awk -v t="$until" -v dt=$dt 'BEGIN { printf "%.0f", t / dt }')" "$law"
            awk -v name="$(name "$p" "$law")" -v dt=$dt -v OFS='\t' '
                $1 == "step" { step = $2 }
                $1 == "energy" && !n++ { before = $2 }
                $1 == "energy" { after = $2 }
                END { printf "gas\t%s\t%s\t%s\t-\t%.17g\n", name, dt, step, after / before - 1 }' measured >>rows
        done
    done
done
turn=0
while [ $turn -lt "$turns" ]; do
    turn=$((turn + 1))
    for p in dem-solve $peers; do
        case $p in
        dem-solve | rockable) steps=$((100 / fewer)) ;;
        lmp) steps=$((50 / fewer)) ;;
        yade) steps=5 ;;
        esac
        for law in $(laws "$p"); do
            run "$p" pack 0.0001 "$steps" "$law"
            awk -v name="$(name "$p" "$law")" -v OFS='\t' '
                $1 == "step" { step = $2 }
                $1 == "pairs" { pairs = $2 }
                END { print "pack", name, "0.0001", step, pairs, "-" }' measured >>rows
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
        $5 > 0 { pairs[$1] = $5 } # the blocks are the same for all programs
        { energy[$1, $2, $3] = $6 }
        END {
            for (k = 1; k <= n; k++) {
                split(list[k], of, SUBSEP)
                t = step[list[k]]
                print of[1], of[2], version[of[2]], of[3], sprintf("%.4g", 1e9 * t / bodies),
                    of[1] == "pack" ? sprintf("%.4g", 1e9 * t / pairs["pack"]) : "-",
                    sprintf("%.3g", t / step[of[1], "dem-solve", of[3]]),
                    of[1] == "gas" ? sprintf("%.2g", energy[list[k]]) : "-"
            }
        }' versions rows
} >blocks.tsv
keep
