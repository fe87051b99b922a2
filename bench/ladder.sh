#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# ladder.sh [BUILD [OUT]] -- cost beside error, over scenes and settings, with the programs of BUILD/bin.
#   OUT/ladder.tsv   a row for each scene and setting; its head names the machine.  OUT is bench/results if not said
#   OUT/choice.txt   for an error of 5 %, 1 % and 0.1 %: the longest step that kept it, scene by scene
#   OUT/*.png        error against cost, cost against bodies, cost against threads (by gnuplot, where it is there)
# What a run is: bench/README.md.  Ice, structures and tables of the runs stay in BUILD/ladder.
#   FLOE_QUICK=1     fewer and shorter rows, a minute or two in all
#   SCENES='pair *'  patterns of the scenes that are wanted
#   TIMES=3          times that a row is run, if one of them takes less than 3 s; the least counts
set -u
LC_ALL=C
export LC_ALL
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
fail() { echo "ladder.sh: $*" >&2; exit 4; }

# run SCENE NAME PROGRAM OPTION...: one run; leaves NAME.loads .state .report .status in the folder of the scene.
run()
{
    s=$1 n=$2 p=$3
    shift 3
    "$p" -q --ice "$s/ice.dat" --structure "$s/structure.dat" \
        --set run.duration="$(cat "$s/seconds")" --set output.state="$s/$n.state" --set output.state_every="$(cat "$s/seconds")" \
        --report "$s/$n.report" -o "$s/$n.loads" "$@" "$s/scene" 2>"$s/$n.err"
    echo $? >"$s/$n.status"
}
if [ "${1-}" = run ]; then # as xargs calls it
    shift
    run "$@"
    exit 0
fi

build=$(cd "${1:-$bench/../build}" && pwd) || exit 4
out=${2:-$bench/results}
mkdir -p "$out" "$build/ladder" || exit 4
out=$(cd "$out" && pwd)
PATH=$build/bin:$PATH
quick=${FLOE_QUICK:-0} wanted=${SCENES:-*}
[ "$quick" = 0 ] && times=${TIMES:-3} || times=${TIMES:-1}
here=$build/ladder/$$ # two ladders at a time do not meet
mkdir -p "$here" && cd "$here" || exit 4
trap 'rm -rf "$here"' EXIT
trap 'exit 130' INT TERM HUP
cores=$(getconf _NPROCESSORS_ONLN)

# is NAME PATTERNS: is it like one of them?
is()
{
    set -f # patterns, not the files that are like them
    for p in $2; do
        # shellcheck disable=SC2254 # a pattern
        case $1 in
        $p) set +f && return 0 ;;
        esac
    done
    set +f
    return 1
}
# --- the scenes ------------------------------------------------------------------------------------

# A field of N floes with a cylinder for every 200 of them.
field() # N
{
    awk -v n="$1" 'BEGIN {
        side = 50 * sqrt(n / 200); m = int(sqrt(n / 200) + 0.5); m = m > 0 ? m : 1
        for (i = 0; i < m; i++) for (k = 0; k < m; k++)
            printf " --name leg%d --cylinder 1,-5,5,%.6g,%.6g", ++c,
                (i + 0.5) * side / m - side / 2, (k + 0.5) * side / m - side / 2
    }' >legs
    # shellcheck disable=SC2046 # options
    struct-import -q $(cat legs) -o structure.dat || exit 4
    side=$(awk -v n="$1" 'BEGIN { printf "%.6g", 50 * sqrt(n / 200) }')
    voronoi-ice -q --size "${side}x$side" --floes "$1" --thickness 0.5 --radius 0.05 --velocity 0.5,0 \
        --keep-out structure.dat | awk -f "$bench/stir.awk" >ice.dat
}
pack() # LAYERS
{
    voronoi-ice -q --lattice hcp --layers "$1" --diameter 0.25 --size 18x16 -o ice.dat || exit 4
    low=$(awk '/^v / { z = $4 < z ? $4 : z } END { printf "%.17g", z - 0.125 }' ice.dat)
    struct-import -q --name plate --box "-10,-9,-6,10,9,$low" -o structure.dat
}

# Ice, structure and scene of a rung in the folder of its name.
make_scene() # NAME
{
    mkdir "$1" && cd "$1" || exit 4
    case $1 in
    field-*) field "${1#field-}" ;;
    pack-100000) pack 19 ;;
    pack-*) pack 1 ;;
    pair) struct-import -q --name post --cylinder 1,-2,2,2.05,0.1 -o structure.dat ;;
    stack) struct-import -q --name plate --box -2,-2,-1,2,2,0 -o structure.dat ;;
    hard-pebble) struct-import -q --name post --cylinder 0.5,-1,1,0.5,0 -o structure.dat ;;
    hard-thin) struct-import -q --name block --box -1,-1,-1,0.5,1,0 -o structure.dat ;;
    hard-pinched)
        struct-import -q --name left --cylinder 0.8,-2,2,2,1.5 --name right --cylinder 0.8,-2,2,2,-1.5 \
            -o structure.dat
        ;;
    hard-cradle) struct-import -q --name block --box 0.55,-1,-1,1.5,1,1 -o structure.dat ;;
    hard-hook)
        struct-import -q --name one --box -1,-1,-1,0,3,1 --name two --box 0,-1,-1,3,0,1 -o structure.dat
        ;;
    hard-fast) struct-import -q --name block --box 0,-3,-3,1,3,3 -o structure.dat ;;
    esac || fail "$1: could not be made"
    scene=$bench/scenes/${1%-[0-9]*}.scene
    [ -f "$bench/scenes/$1.floes" ] && awk -f "$bench/floes.awk" "$bench/scenes/$1.floes" >ice.dat
    cp "$scene" scene && cd "$here" && seconds "$1" >"$1/seconds" || exit 4
}

# Seconds of a scene, and the fractions of the critical step that are tried; the last is for the reference.
seconds() # NAME
{
    case $1:$quick in
    field-200:0) echo 0.8 ;;
    field-2000:0) echo 0.6 ;;
    field-2000:*) echo 0.3 ;;
    field-*) echo 0.4 ;;
    *) awk '$1 == "duration" { print $3 * ($4 == "ms" ? 1e-3 : 1) }' "$bench/scenes/${1%-[0-9]*}.scene" ;;
    esac
}
fractions() # NAME
{
    case $1:$quick in
    field-20000:*) echo 0.4 0.2 0.1 0.025 ;;
    pack-*) echo 0.2 0.1 0.05 0.0125 ;;
    field-2000:0) echo 0.8 0.4 0.2 0.1 0.05 0.0125 ;;
    *:0) echo 0.8 0.4 0.2 0.1 0.05 0.025 0.003125 ;;
    *) echo 0.4 0.2 0.1 0.025 ;;
    esac
}

# --- runs ------------------------------------------------------------------------------------------

# critical SCENE LAW: the critical step of the stiffest contact any body can make.
critical()
{
    dem-solve -j 1 --plan --ice "$1/ice.dat" --structure "$1/structure.dat" --set contact.law="$2" \
        "$1/scene" |
        awk '{ for (k = 1; k < NF; k++) if ($k == "critical") print $(k + 1) }'
}

# step SCENE LAW FRACTION: that fraction of it, or a little less, so that steps divide the rows of the loads.
step()
{
    [ -f "$1/critical.$2" ] || critical "$1" "$2" >"$1/critical.$2"
    awk -v f="$3" 'NR == FNR { c = $1 } $1 == "loads_every" { every = 1e-3 * $3 } END {
        m = every / (f * c); m = m > int(m) ? int(m) + 1 : int(m)
        printf "%.17g\n", every / m }' "$1/critical.$2" "$1/scene"
}
number() { awk -v key="$2" 'index($0, key) { sub(".*" key " *", ""); print $1 + 0; exit }' "$1"; }

# least BY SCENE NAME PROGRAM OPTION...: a run, as often as it is short; what is kept is the report of least BY.
least()
{
    by=$1
    shift
    run "$@"
    k=1
    while [ $k -lt "$times" ] && [ "$(cat "$1/$2.status")" = 0 ] &&
        [ "$(number "$1/$2.report" "$by" | cut -d. -f1)" -lt 3 ]; do
        mv "$1/$2.report" "$1/$2.best"
        run "$@"
        awk -v a="$(number "$1/$2.best" "$by")" -v b="$(number "$1/$2.report" "$by")" \
            'BEGIN { exit !(a < b) }' &&
            mv "$1/$2.best" "$1/$2.report"
        k=$((k + 1))
    done
}

# row SCENE SETTING VALUE LAW THREADS NAME: what the run took, and how far it is off the reference of its law.
row()
{
    printf '%s\t%s\t%s\t%s\t%s\t' "$1" "$2" "$3" "$4" "$5"
    touch "$1/$6.report" "$1/$6.loads" "$1/$6.state"
    awk -v bodies="$(grep -c '^poly' "$1/ice.dat")" -v status="$(cat "$1/$6.status")" -f "$bench/row.awk" \
        "$1/$6.report" "$1/$6.loads" "$1/reference.$4.loads" "$1/$6.state" "$1/reference.$4.state"
}
told() { printf '%-14s %-9s %s\n' "$1" "$2" "$3" >&2; }

# rung SCENE SETTING VALUE: that row.  Everything that is not said is law patch, a tenth of the critical step, one
# thread, searches when the skin is used up, and the vectors of the machine.
rung()
{
    told "$@"
    law=patch threads=1 program=dem-solve name=$2-$3 f=0.1 by=processor more=
    case $2 in
    step) f=$3 ;;
    law) law=${3%:*} f=${3#*:} ;;
    threads) threads=$3 by='simulated in' ;;
    skin) more="--set run.search_every=$3" ;;
    width) program=$build/bench/dem-solve-$3 ;;
    esac
    if [ "$2" = error ]; then more="--set run.error=$3"
    else more="$more --set run.dt=$(step "$1" "$law" "$f")"; fi
    # shellcheck disable=SC2086 # options
    least "$by" "$1" "$name" "$program" -j "$threads" --set contact.law="$law" $more
    row "$1" "$2" "$3" "$law" "$threads" "$name" >>rows
}

scenes=
if [ "$quick" = 0 ]; then all="field-200 field-2000 field-20000 pack-100000"
else all="field-20 field-200 field-2000 pack-6000"; fi
for s in $all pair stack hard-pebble hard-thin hard-pinched hard-cradle hard-hook hard-fast; do
    is "$s" "$wanted" || continue
    make_scene "$s"
    scenes="$scenes $s"
done
[ "$scenes" ] || fail "no scene is like $wanted"

# References, the longest first, on all cores.
laws_of()
{
    if is "$1" "field-200 pair stack hard-cradle"; then echo patch core manual-si; else echo patch; fi
}
for s in $scenes; do
    for law in $(laws_of "$s"); do
        echo run "$s" "reference.$law" dem-solve -j 1 --set contact.law="$law" \
            --set run.dt="$(step "$s" "$law" "$(fractions "$s" | awk '{ print $NF }')")"
    done
done | awk '{ n = $2; sub(/.*-/, "", n); print (n + 0) "\t" $0 }' | sort -s -k 1,1nr | cut -f 2 >list
told references "" "$(grep -c . list)"
xargs -L 1 -P "$cores" sh "$bench/ladder.sh" <list
for s in $scenes; do
    for law in $(laws_of "$s"); do
        [ "$(cat "$s/reference.$law.status")" = 0 ] || fail "$s: reference of $law: $(cat "$s/reference.$law.err")"
    done
done

# The rows.
: >rows
for s in $scenes; do
    for f in $(fractions "$s" | awk 'NF-- > 1'); do rung "$s" step "$f"; done
    is "$s" "field-2000* pack-*" || for e in 5% 1% 0.1%; do rung "$s" error $e; done
    for law in $(laws_of "$s"); do
        [ "$law" = patch ] || for f in 0.2 0.1 0.05; do rung "$s" law "$law:$f"; done
    done
    is "$s" "field-20 field-2000 pack-*" && for k in 1 10 100; do rung "$s" skin $k; done
    is "$s" "field-* pack-*" && [ "$cores" -gt 1 ] && {
        j=1
        while [ $j -le "$cores" ]; do rung "$s" threads $j && j=$((2 * j)); done
    }
    is "$s" "field-200 field-2000 stack" && for w in plain avx2; do
        [ -x "$build/bench/dem-solve-$w" ] && { [ $w = plain ] || grep -q avx2 /proc/cpuinfo; } &&
            rung "$s" width $w
    done
done

# --- what is made of them ---------------------------------------------------------------------------

{
    echo '#ladder 1'
    echo "#by $(dem-solve --version)"
    model=$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1)
    echo "#processor ${model:-unknown}, $(uname -m), $cores cores"
    echo "#compiler $(sh -c "${CC:-cc} --version" | head -n 1)"
    echo "#load $(uptime | sed 's/.*: //') over 1, 5 and 15 minutes, the ladder itself being 1; least of $times"
    awk -f "$bench/table.awk" rows rows
} >ladder.tsv
awk -f "$bench/choice.awk" ladder.tsv >choice.txt
cp ladder.tsv choice.txt "$out" || exit 4
if command -v gnuplot >/dev/null; then
    awk -f "$bench/curves.awk" ladder.tsv >curves.dat
    gnuplot -e "out='$out'; scenes='${scenes# }'" "$bench/ladder.gp" || fail "gnuplot failed"
else
    told plots "" "skipped, there is no gnuplot"
fi
cat "$out/choice.txt"
