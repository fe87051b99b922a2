#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# bonds.sh [BUILD [OUT]] -- cost of a bond between spheres beside YADE (yade), with the error of both: a free plate of
# three layers, 0.094 m, without loss, weight or water, swings in its twist.  Same lattice, masses, four stiffnesses of
# each bond, steps and start.  One thread, processor time.
#   OUT/bonds.tsv   a row for each plate and program.  OUT is bench/results
# Columns: time of a bond and step, all included but tables and set-up; largest change of the energy over its value;
# frequency of the twist, from the zeros of its speed; step "quarter" is the reference.  A plate of few steps has none.
#   FLOE_QUICK=1    the smallest plate alone
set -u
LC_ALL=C OMP_NUM_THREADS=1
export LC_ALL OMP_NUM_THREADS
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
# shellcheck source=/dev/null # in the same folder
. "$bench/beside.sh"
begin bonds "${1-}" "${2-}" yade
# shellcheck disable=SC2154 # set by begin
PATH=$build/bin:$PATH
young=0.88e9 density=900 ratio=0.38461538461538464 dt=1e-5

cat >plate.scene <<END
[ice]
file = plate.dat
[material ice]
density = $density kg/m3
young = $young
[run]
gravity = 0
threads = 1
[contact]
round_law = linear
restitution = 1
friction = 0
[bond]
on = true
young = $young
poisson = 0.3
normal_strength = 100 GPa
shear_strength = 100 GPa
softening = stretch
stretch = 2
END

# ours STEPS DT [OPTION...]: a run; its processor seconds in $seconds
ours()
{
    n=$1 step=$2
    shift 2
    dem-solve -q --set "run.duration=$(awk -v n="$n" -v dt="$step" 'BEGIN { printf "%.12g", n*dt }')" --set "run.dt=$step" "$@" \
        --report report -o loads plate.scene 2>message || { cat message >&2; exit 4; }
    seconds=$(awk '$1 == "processor" { print $2 }' report)
}
# swing DT EVERY: rows of our plate; EVERY steps apart
swing()
{
    rows=$(awk -v n="$2" -v dt="$1" 'BEGIN { printf "%.12g", n*dt }')
    ours "$(awk -v n="$steps" -v a="$dt" -v b="$1" 'BEGIN { print int(n*a/b + 0.5) }')" "$1" --set output.energy=energy \
        --set output.state=state --set "output.energy_every=$rows" --set "output.state_every=$rows"
    awk -v ours=1 -f "$bench/bonds.awk" plate.dat state energy | tail -n +2 >swing
}
# row PROGRAM STEP NS FILE
row()
{
    printf '%d\t%d\t%s\t%s\t%s\t%d\t%s\t%s\n' "$spheres" "$bonds" "$1" "$(version "${1%% *}")" "$2" "$steps" "$3" \
        "$(awk -v row=1 -f "$bench/bonds.awk" "$4")" >>bonds.tsv
}
# plate SIDE STEPS EVERY [TWICE]: a row of the table comes every so many steps; TWICE adds the reference
plate()
{
    side=$1 steps=$2 every=$3
    voronoi-ice -q --gaps even --lattice hcp --layers 3 --diameter 0.094 --size "${side}x$side" --velocity 1,0 --bonded \
        -o flat.dat || exit 4
    awk -v speed=0.01 -f "$bench/bonds.awk" flat.dat flat.dat >plate.dat
    spheres=$(grep -c '^poly' plate.dat) bonds=$(grep -c '^bond' plate.dat)
    # The dearer of two lengths less the cheaper leaves set-up out.
    ours "$steps" "$dt" && short=$seconds
    ours $((3 * steps)) "$dt"
    ns=$(awk -v a="$short" -v b="$seconds" -v n=$((2 * steps)) -v m="$bonds" 'BEGIN { printf "%.1f", 1e9*(b - a)/n/m }')
    swing "$dt" "$every" && row dem-solve whole "$ns" swing
    [ "${4-}" ] && swing "$(awk -v dt="$dt" 'BEGIN { print dt/4 }')" $((4 * every)) && row dem-solve quarter - swing
    PLATE=plate.dat DT=$dt STEPS=$steps EVERY=$every YOUNG=$young RATIO=$ratio DENSITY=$density STATE=peer \
        yade -n -x -j 1 "$bench/bonds.py" </dev/null >message 2>&1
    seconds=$(awk '$1 == "seconds" { print $2 }' message)
    [ "$seconds" ] || { cat message >&2; exit 4; }
    row yade whole "$(awk -v s="$seconds" -v n="$steps" -v m="$bonds" 'BEGIN { printf "%.1f", 1e9*s/n/m }')" peer
}

heading "a bond of spheres beside other programs" >bonds.tsv
printf 'spheres\tbonds\tprogram\tversion\tstep\tsteps\tbond-step[ns]\tenergy-error\tfrequency[Hz]\n' >>bonds.tsv
plate 1 1200 10 twice
if [ "${FLOE_QUICK:-0}" = 0 ]; then
    plate 2 4000 40 twice
    plate 5 300 50
fi
keep
