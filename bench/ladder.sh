#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# ladder.sh [BUILD [OUT]] -- cost beside error, over scenes and settings, with the programs of BUILD/bin.
#   OUT/ladder.tsv   a row for each scene and setting; its head names the machine.  The default of OUT is bench/results
#   OUT/choice.txt   for an error of 5 %, 1 % and 0.1 %: the longest step that kept it, scene by scene
#   OUT/*.png        error against cost, cost against bodies, cost against threads, if gnuplot is installed
# bench/README.md explains scenes and columns.  The runs use a scratch folder in BUILD/ladder.
#   FLOE_QUICK=1     fewer and shorter rows, a minute or two in all
#   SCENES='pair *'  patterns of the scenes to run
#   TIMES=3          number of runs of a row, if one of them takes less than 3 s; the least time is kept
set -u
LC_ALL=C
export LC_ALL
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
fail() { echo "ladder.sh: $*" >&2; exit 4; }

# shellcheck source=/dev/null # in the same folder
. "$bench/rungs.sh"
if [ "${1-}" = run ]; then # called by xargs
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
here=$build/ladder/$$ # so that two ladders can run at a time
mkdir -p "$here" && cd "$here" || exit 4
trap 'rm -rf "$here"' EXIT
trap 'exit 130' INT TERM HUP
cores=$(getconf _NPROCESSORS_ONLN)

# Fractions of the critical step; the last is that of the reference.
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

# least BY SCENE NAME PROGRAM OPTION...: repeats a short run and keeps the report with the least BY.
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

# row SCENE SETTING VALUE LAW THREADS NAME: cost of the run, and its error against the reference of its law.
row()
{
    printf '%s\t%s\t%s\t%s\t%s\t' "$1" "$2" "$3" "$4" "$5"
    touch "$1/$6.report" "$1/$6.loads" "$1/$6.state"
    awk -v bodies="$(grep -c '^poly' "$1/ice.dat")" -v status="$(cat "$1/$6.status")" -f "$bench/row.awk" \
        "$1/$6.report" "$1/$6.loads" "$1/reference.$4.loads" "$1/$6.state" "$1/reference.$4.state"
}

# rung SCENE SETTING VALUE: runs and appends one row.  Defaults are law patch, 0.1 of the critical step, one thread,
# neighbour searches when the skin is used up, and the vector width of the machine.
rung()
{
    say "$@"
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
    matches "$s" "$wanted" || continue
    make_scene "$s"
    scenes="$scenes $s"
done
[ "$scenes" ] || fail "no scene matches $wanted"

# References, the longest first, on all cores.
laws_of()
{
    if matches "$1" "field-200 pair stack hard-cradle"; then echo patch core manual-si; else echo patch; fi
}
for s in $scenes; do
    for law in $(laws_of "$s"); do
        echo run "$s" "reference.$law" dem-solve -j 1 --set contact.law="$law" \
            --set run.dt="$(step "$s" "$law" "$(fractions "$s" | awk '{ print $NF }')")"
    done
done | awk '{ n = $2; sub(/.*-/, "", n); print (n + 0) "\t" $0 }' | sort -s -k 1,1nr | cut -f 2 >list
say references "" "$(grep -c . list)"
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
    matches "$s" "field-2000* pack-*" || for e in 5% 1% 0.1%; do rung "$s" error $e; done
    for law in $(laws_of "$s"); do
        [ "$law" = patch ] || for f in 0.2 0.1 0.05; do rung "$s" law "$law:$f"; done
    done
    matches "$s" "field-20 field-2000 pack-*" && for k in 1 10 100; do rung "$s" skin $k; done
    matches "$s" "field-* pack-*" && [ "$cores" -gt 1 ] && {
        j=1
        while [ $j -le "$cores" ]; do rung "$s" threads $j && j=$((2 * j)); done
    }
    matches "$s" "field-200 field-2000 stack" && for w in plain avx2; do
        [ -x "$build/bench/dem-solve-$w" ] && { [ $w = plain ] || grep -q avx2 /proc/cpuinfo; } &&
            rung "$s" width $w
    done
done

# --- tables and plots --------------------------------------------------------------------------------

{
    echo '#ladder 1'
    echo "#by $(dem-solve --version | head -n 1)"
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
    say plots "" "skipped, gnuplot is not installed"
fi
cat "$out/choice.txt"
