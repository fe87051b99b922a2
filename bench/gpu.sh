#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# gpu.sh check|bench [BUILD [OUT]] -- spheres on a card against the processor, with the programs of BUILD/bin.
#   check   state hashes and checkpoints: a free pack, a heap with rolling, a periodic shear, spheres that fall onto a
#           cone, a solid and a mesh that move, a sheet that breaks on a cone, on a leg of joined cones, in waves, a sheet
#           without end, the reduced jz20-2 and jack-up of share/examples; then a run that goes from the processor to the
#           card and back.  Status 1 if one differs
#   bench   steps a second, and ns a body and a contact or bond, from 10 000 to 10 million spheres, with searches and
#           tables; sizes that would not end in time are left out
#   OUT/gpu.tsv   rows of either are put in the place of its last ones; its head names card and processor.  OUT is
#                 bench/results
# Each takes less than eight minutes.
#   DEVICE=serial     another device than gpu, to try the script without a card
#   FLOE_QUICK=1      fewer steps; of bench the smallest size alone
#   SECONDS_MOST=400  no size is begun that late
set -u
LC_ALL=C
export LC_ALL
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
fail() { echo "gpu.sh: $*" >&2; exit 4; }
what=${1-}
case $what in check | bench) ;; *) echo "usage: gpu.sh check|bench [BUILD [OUT]]" >&2; exit 2 ;; esac
build=$(cd "${2:-$bench/../build}" && pwd) || exit 4
out=${3:-$bench/results}
mkdir -p "$out" "$build/gpu" || exit 4
out=$(cd "$out" && pwd)
PATH=$build/bin:$PATH
device=${DEVICE:-gpu} quick=${FLOE_QUICK:-0} begun=$(date +%s)
here=$build/gpu/$$
mkdir -p "$here" && cd "$here" || exit 4
trap 'rm -rf "$here"' EXIT
trap 'exit 130' INT TERM HUP

# base FILE BOUNDARY MIN MAX KEYS...: a scene of spheres without water.
base()
{
    printf '[ice]\nfile = %s\n[material ice]\nyoung = 1e8 Pa\n[boundary]\ntype = %s\nmin = %s\nmax = %s\n' "$1" "$2" "$3" "$4"
    printf '[contact]\nfriction = 0.4\nrestitution = 0.5\n%s\n[run]\ngravity = %s\ndt = %s\nduration = %s\n' "$5" "$6" "$7" "$8"
    printf '[output]\nloads_every = 1 s\n'
}

# sheet NAME SIZE ORIGIN THICKNESS LAYERS: a bonded sheet that is pushed against a cone.
sheet()
{
    voronoi-ice --lattice hcp --layers "$5" --thickness "$4" --size "$2" --origin="$3" --rows across --edges 1 --bonded \
        --velocity 1,0 --flexural "$6" --young 0.1GPa --scene "$1-keys.scene" -q -o "$1.dat" || fail "no sheet"
    printf '#g_struct 1\npart 0 cone\ncone 0 0 -0.5 1.0  0 0 0.5 0.5\n' >cone.dat
    printf 'include = %s-keys.scene\n[ice]\nfile = %s.dat\n[structure]\nfile = cone.dat\nfriction = 0.15\n' "$1" "$1"
    printf '[water]\ncurrent = 1 0 0\nadded_mass = 0 0 3\n[boundary]\ntype = free\ndrive = 1 0 0\ndrive_group = edge\n'
    printf 'drive_fixed = x y rx rz\ndrive_foundation = 10 kN/m3\n[output]\nloads_every = 50 ms\n'
}

# prism ID Z0 Z1 X Y X Y ...: a part of a structure file, over a polygon that its first corner sees all of.
prism()
{
    echo "part $1 prism$1"
    echo "$@" | awk '{
        n = (NF - 3)/2
        for (top = 0; top < 2; top++) for (k = 0; k < n; k++) print "v", $(4 + 2*k), $(5 + 2*k), $(2 + top)
        for (k = 1; k + 1 < n; k++) { print "t", 0, k + 1, k; print "t", n, n + k, n + k + 1 }
        for (k = 0; k < n; k++) { l = (k + 1)%n; print "t", k, l, n + l; print "t", k, n + l, n + k }
    }'
}

# solve DEVICE NAME ARGUMENTS: a run; its report is NAME.report.
solve()
{
    on=$1 name=$2
    shift 2
    dem-solve --report "$name.report" -o "$name.loads" --set run.device="$on" "$@" 2>"$name.err" || {
        cat "$name.err" >&2
        fail "$name did not end"
    }
}
hash_of() { awk '/^state hash/ { print $3 }' "$1.report"; }

# head of the table: rows of the other kind are kept.
begin_table()
{
    card=$( (nvidia-smi --query-gpu=name,driver_version --format=csv,noheader || echo none) 2>/dev/null | head -n 1)
    model=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo 2>/dev/null | head -n 1)
    kept=$(grep "^$([ "$what" = check ] && echo bench || echo check)" "$out/gpu.tsv" 2>/dev/null)
    {
        printf '#gpu 1\n#by %s\n#card %s\n#processor %s\n#device %s\n' "$(dem-solve --version | head -n 1)" "${card:-none}" "$model" "$device"
        printf 'kind\tscene\tspheres\tsteps\tcpu\tcard\tequal\tsteps_per_s\tbody_ns\tcontact_ns\n'
        [ -z "$kept" ] || echo "$kept"
    } >gpu.tsv
}

wrong=0
# compare SCENE STEPS ARGUMENTS: hashes of the processor and of the card.
compare()
{
    scene=$1 steps=$2
    solve cpu "$scene-cpu" "$scene.scene"
    solve "$device" "$scene-card" "$scene.scene"
    a=$(hash_of "$scene-cpu") b=$(hash_of "$scene-card") same=no
    for k in cpu card; do grep -v '^#' "$scene-$k.loads" >"$scene-$k.loads.n"; done
    [ "$a" = "$b" ] && cmp -s "$scene-cpu.loads.n" "$scene-card.loads.n" && same=yes
    [ $same = yes ] || wrong=1
    printf 'check\t%s\t%s\t%s\t%s\t%s\t%s\t\t\t\n' "$scene" "$(grep -c '^poly' "$3")" "$steps" "$a" "$b" $same | tee -a gpu.tsv
}

# checkpoints SCENE: a third of the run on the card ends in the state of one that stayed.
checkpoints()
{
    solve cpu stayed --set run.duration="$2" --set output.checkpoint=stayed.ck "$1.scene"
    solve cpu goes --set run.duration="$3" --set output.checkpoint=goes.ck "$1.scene"
    dem-solve -q --resume goes.ck --set run.device="$device" --set run.duration="$4" || fail "the card did not take the checkpoint"
    dem-solve -q --resume goes.ck --set run.device=cpu --set run.duration="$2" || fail "the checkpoint of the card is no good"
    for k in stayed goes; do
        { gzip -dc "$k.ck" 2>/dev/null || cat "$k.ck"; } | sed -n '/part state/,/^end /p' | grep -av '^end \|part state' >"$k.state"
    done
    same=no
    [ -s stayed.state ] && cmp -s stayed.state goes.state && same=yes
    [ $same = yes ] || wrong=1
    printf 'check\t%s, cpu card cpu\t%s\t\t%s\t%s\t%s\t\t\t\n' "$1" "$(grep -c '^poly' "$5")" "$(cksum <stayed.state | cut -d ' ' -f 1)" \
        "$(cksum <goes.state | cut -d ' ' -f 1)" $same | tee -a gpu.tsv
}

# example NAME TIME: a reduced case of share/examples, on the processor and on the card.
example()
{
    same=no
    for d in cpu "$device"; do
        make -s -C "$bench/../share/examples/$1" BIN="$build/bin" OUT="$here/$1-$d" TIME="$2" SET="--set run.device=$d" \
            "$here/$1-$d/loads.tsv" >"$1.err" 2>&1 || { cat "$1.err" >&2; fail "$1 did not end"; }
        grep -v '^#' "$here/$1-$d/loads.tsv" >"$1-$d.loads.n"
    done
    a=$(awk '/^state hash/ { print $3 }' "$here/$1-cpu/report.txt") b=$(awk '/^state hash/ { print $3 }' "$here/$1-$device/report.txt")
    [ "$a" = "$b" ] && cmp -s "$1-cpu.loads.n" "$1-$device.loads.n" && same=yes
    [ $same = yes ] || wrong=1
    printf 'check\t%s\t%s\t%s\t%s\t%s\t%s\t\t\t\n' "$1" "$(grep -c '^poly' "$here/$1-cpu/ice.dat")" \
        "$(awk '/^steps / { print $2; exit }' "$here/$1-cpu/report.txt")" "$a" "$b" $same | tee -a gpu.tsv
}

if [ "$what" = check ]; then
    begin_table
    n=10000 t=0.5 long=1
    [ "$quick" = 0 ] || n=1000 t=0.05 long=0.3
    pack --in box:0,0,0,2,2,2 --grading uniform:0.14,0.2 --porosity 0.5 --seed 2 --density 900 -q -o pack.dat || fail "no packing"
    pack --in box:0,0,0,2,2,2 --periodic xy --grading uniform:0.14,0.2 --porosity 0.5 --seed 3 --density 900 -q -o cell.dat ||
        fail "no packing"
    base pack.dat rigid '0 0 0' '2 2 2.5' '' '1 0.5 -9.81' '0.05 ms' "$t s" >free.scene
    base pack.dat rigid '-1 -1 0' '3 3 2.5' 'rolling = 0.2' 9.81 '0.05 ms' "$t s" >heap.scene
    base cell.dat 'periodic periodic rigid' '0 0 0' '2 2 2.5' '' '4 1 -9.81' '0.05 ms' "$t s" >shear.scene
    pack --in box:0,0,0.9,2,2,2.5 --grading uniform:0.14,0.2 --porosity 0.5 --seed 4 --density 900 -q -o fall.dat || fail "no packing"
    {
        printf '#g_struct 1\npart 0 cone\ncone 1.5 1.5 0 0.4  1.5 1.5 0.8 0.1\n'
        prism 1 0 0.7 0.1 0.1 0.8 0.1 0.8 0.8 0.1 0.8
        prism 2 0 0.8 1.1 0.1 1.9 0.1 1.9 0.4 1.4 0.4 1.4 0.8 1.1 0.8
    } >pieces.dat
    base fall.dat rigid '0 0 0' '2 2 3' '' '1 0.5 -9.81' '0.05 ms' "$t s" >pieces.scene
    printf '[structure]\nfile = pieces.dat\nvelocity = 0.05 0 0.02\n' >>pieces.scene
    sheet sheet 3x3 -3.95,-1.5 0.3 2 60kPa >sheet.scene
    printf '[run]\ndt = 0.1 ms\nduration = %s s\n' $long >>sheet.scene
    compare free $n pack.dat
    compare heap $n pack.dat
    compare shear $n cell.dat
    compare pieces $n fall.dat
    # on a joined leg; the same in waves and wind; a sheet without end
    printf '#g_struct 1\npart 0 leg\ncone 0 0 -0.5 1.0  0 0 0.5 0.5\ncone 0 0 0.5 0.5  0 0 1.5 0.5\ncone 0 0 0.2 0.1  1 0 1.2 0.1\n' >leg.dat
    sed -e 's/^file = cone.dat/file = leg.dat/' sheet.scene >leg.scene
    sed -e 's/^added_mass = .*/added_mass = 0\nwave = airy\nheight = 0.2 m\nperiod = 2 s/' sheet.scene >waves.scene
    printf '[ice]\nslab = none\n[wind]\nvelocity = 10 0 0\n' >>waves.scene
    voronoi-ice --lattice hcp --layers 2 --thickness 0.3 --size 3x3 --origin=-3.95,-1.5 --rows across --edges 1 --endless --bonded \
        --velocity 1,0 --flexural 60kPa --young 0.1GPa --scene inflow-keys.scene -q -o inflow.dat || fail "no sheet without end"
    sed -e 's/sheet-keys.scene/inflow-keys.scene/; s/sheet.dat/inflow.dat/; /^type = free/d' sheet.scene >inflow.scene
    printf '[boundary]\nmax = 0.2 none none\n' >>inflow.scene
    compare sheet "$(awk -v t=$long 'BEGIN { print t * 10000 }')" sheet.dat
    compare leg "$(awk -v t=$long 'BEGIN { print t * 10000 }')" sheet.dat
    compare waves "$(awk -v t=$long 'BEGIN { print t * 10000 }')" sheet.dat
    compare inflow "$(awk -v t=$long 'BEGIN { print t * 10000 }')" inflow.dat
    third=$(awk -v t=$long 'BEGIN { print t / 3 }') two=$(awk -v t=$long 'BEGIN { print 2 * t / 3 }')
    example jz20-2 "$([ "$quick" = 0 ] && echo 2 s || echo 0.11 s)"
    example jack-up "$([ "$quick" = 0 ] && echo 0.3 s || echo 0.03 s)"
    checkpoints sheet $long "$third" "$two" sheet.dat
else
    begin_table
    sizes='10000 117024 332000 1000000 10000000'
    [ "$quick" = 0 ] || sizes=10000
    for n in $sizes; do
        [ $(($(date +%s) - begun)) -lt "${SECONDS_MOST:-400}" ] || { echo "gpu.sh: no time for $n spheres" >&2; break; }
        steps=$(awk -v n="$n" 'BEGIN { s = 2e9 / n; print int(s < 200 ? 200 : s > 20000 ? 20000 : s) }')
        [ "$quick" = 0 ] || steps=200
        # Spheres of 0.2 m in three layers; the pack in a box, ten layers high, under gravity.
        side=$(awk -v n="$n" 'BEGIN { printf "%.3f", sqrt(n / 3 * 0.2 * 0.2 * 0.8660254) }')
        sheet "sheet-$n" "${side}x$side" "$(awk -v s="$side" 'BEGIN { printf "%.3f,%.3f", -s - 0.95, -s / 2 }')" 0.52 3 600kPa >"sheet-$n.scene"
        printf '[run]\ndt = 0.01 ms\nduration = %s\n' "$(awk -v s="$steps" 'BEGIN { print s * 1e-5 }')" >>"sheet-$n.scene"
        side=$(awk -v n="$n" 'BEGIN { printf "%.3f", sqrt(n / 10 * 0.2 * 0.2 * 0.8660254) }')
        voronoi-ice --lattice hcp --layers 10 --diameter 0.2 --size "${side}x$side" --origin=0,0 -q -o "pack-$n.dat" || fail "no pack"
        base "pack-$n.dat" 'rigid rigid rigid' "-0.2 -0.2 -2" "$side $side 3" '' 9.81 '0.02 ms' \
            "$(awk -v s="$steps" 'BEGIN { print s * 2e-5 }') s" >"pack-$n.scene"
        for k in pack sheet; do
            solve "$device" "$k-$n" "$k-$n.scene"
            awk -v kind="bench" -v scene=$k -v n="$(grep -c '^poly' "$k-$n.dat")" '
                /^steps / { steps = $2 }
                / simulated in / { wall = $6 }
                /ns per body-step/ { body = $1; contact = $5 }
                END { printf "%s\t%s\t%d\t%d\t\t\t\t%.4g\t%s\t%s\n", kind, scene, n, steps, steps / wall, body, contact }' "$k-$n.report" |
                tee -a gpu.tsv
        done
        rm -f ./*-"$n".dat
    done
fi
mv gpu.tsv "$out/gpu.tsv" || exit 4
exit $wrong
