#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# pack.sh [BUILD [OUT]] -- packings by growth: processor time beside porosity, grading error and overlap, beside LIGGGHTS
# (liggghts) and YADE (yade) on one job; and the same box filled by falling.  Programs of BUILD/bin, one thread.
#   OUT/pack.tsv   a row for each job and program.  OUT is bench/results
# Jobs: spheres to a solid part of 0.60 in a box of 20.6 d, discs of 1 to 2 m to 0.82; graded: spheres of 1 to 2 m, uniform
# by mass, to 0.55 in a box of 20 m with hard walls, also by the other programs, which bench/README.md tells about;
# growth: 1 m spheres to 0.55 in a box of 10 m; falling: the same number from a cloud of twice the height, with friction
# 0.1, to rest.  A program that is not installed has no rows.
#   FLOE_QUICK=1   smaller boxes
set -u
LC_ALL=C OMP_NUM_THREADS=1
export LC_ALL OMP_NUM_THREADS
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
build=$(cd "${1:-$bench/../build}" && pwd) || exit 4
out=${2:-$bench/results}
mkdir -p "$out" && out=$(cd "$out" && pwd) || exit 4
PATH=$build/bin:$PATH
scratch=$(mktemp -d "${TMPDIR:-/tmp}/floe-pack.XXXXXX") || exit 4
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 4
quick=${FLOE_QUICK:-0}
if [ "$quick" = 0 ]; then side=20.6 plane=440 tower=10 graded=20; else side=10 plane=60 tower=5 graded=10; fi

# Processor seconds of a command, in $seconds; status 1 of a packing that jams is an answer.
clock()
{
    { /usr/bin/time -f '%U' -o clock "$@"; } 2>message
    status=$?
    [ $status -le 1 ] || { cat message >&2; exit 4; }
    seconds=$(tail -n 1 clock)
}

# row JOB: the certificate of the last run.
row()
{
    awk -F'\t' -v job="$1" -v seconds="$seconds" '{ got[$1] = $4 }
        END { printf "%s\tpack\t%d\t%.2f\t%.5f\t%.2g\t%.2g\t%d\n", job, got["bodies"], seconds, got["porosity"],
              got["grading-by-mass"], got["overlap-largest"], got["steps-of-relaxation"] }' certificate >>pack.tsv
}

# peer PROGRAM STEPS FILE: spheres of another program, of the graded job, measured from their places.
peer()
{
    awk -v side="$graded" -v lo=1 -v hi=2 -f "$bench/pack.awk" "$3" |
        awk -v program="$1" -v seconds="$seconds" -v steps="$2" '
            { printf "graded\t%s\t%d\t%.2f\t%.5f\t%.2g\t%.2g\t%d\n", program, $1, seconds, $2, $3, $4, steps }' >>pack.tsv
}
# liggghts_run SCALE FRACTION GROW REST
liggghts_run()
{
    clock liggghts -in "$bench/pack.lig" -log none -var side "$graded" -var dt 5e-3 -var drag 300 -var s "$1" \
        -var fraction "$2" -var grow "$3" -var rest "$4" -var state spheres >/dev/null
}

{
    echo '#pack 1'
    echo "#processor $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1), $(uname -m)"
    echo "#load $(uptime | sed 's/.*: //') over 1, 5 and 15 minutes, the programs being 1"
} >pack.tsv
printf 'job\tprogram\tbodies\tcpu[s]\tporosity\tgrading\toverlap\tsteps\n' >>pack.tsv
clock pack -q --in "box:0,0,0,$side,$side,$side" --grading single:1 --solid 0.60 --certificate certificate -o bodies
row spheres
clock pack -q --in "box:0,0,0,$plane,$plane,0" --dim 2 --grading uniform:1,2 --solid 0.82 --certificate certificate -o bodies
row discs
clock pack -q --in "box:0,0,0,$graded,$graded,$graded" --grading uniform:1,2 --solid 0.55 --certificate certificate -o bodies
row graded
if command -v liggghts >/dev/null; then
    liggghts_run 1 0.55 10 10
    peer 'liggghts, thrown' 20 spheres
    liggghts_run 0.5 0.06875 6000 3000
    peer 'liggghts, fix adapt' 9000 spheres
fi
if command -v yade >/dev/null; then
    SIDE=$graded POROSITY=0.45 STEPS=4000 REST=4000 STATE=spheres clock yade -n -x -j 1 "$bench/pack.py" >/dev/null </dev/null
    peer yade 8000 spheres
fi
clock pack -q --in "box:0,0,0,$tower,$tower,$tower" --grading single:1 --solid 0.55 --certificate certificate -o bodies
row growth
high=$((2 * tower))
pack -q --in "box:0,0,0,$tower,$tower,$high" --grading single:1 --solid 0.275 -o cloud || exit 4
printf '[run]\nduration = 6 s\n[material ice]\nyoung = 100 MPa\nfriction = 0.1\nrestitution = 0.2\n[ice]\nfile = cloud\n' >fall.scene
printf '[boundary]\ntype = rigid rigid rigid\nmin = 0 0 0\nmax = %s %s none\n[output]\nstate = state\nstate_every = 6 s\n' \
    "$tower" "$tower" >>fall.scene
clock dem-solve -q -o loads fall.scene
# the solid part below the height that holds nine tenths of the spheres
awk -v side="$tower" -v seconds="$seconds" '
    $1 ~ /^[0-9]/ { if ($1 != t) n = 0; t = $1; z[n++] = $5; v = sqrt($10 ^ 2 + $11 ^ 2 + $12 ^ 2); sum[t] += v * v }
    END {
        for (i = 1; i < n; i++) for (j = i; j > 0 && z[j - 1] > z[j]; j--) { h = z[j]; z[j] = z[j - 1]; z[j - 1] = h }
        k = int(0.9 * n)
        printf "falling\tdem-solve\t%d\t%.2f\t%.3f\t-\t-\t-\n#falling: speed %.2g m/s\n", n, seconds,
            1 - k * 0.5235988 / (side * side * z[k]), sqrt(sum[t] / n)
    }' state >>pack.tsv
cp pack.tsv "$out/pack.tsv" && cat pack.tsv
