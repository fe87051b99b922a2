#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# threads.sh [BUILD [OUT]] -- speedup by threads, compared with the capacity of the machine: a run by one thread, T
# such runs side by side, and one run by T threads, in turns, with the programs of BUILD/bin.
#   OUT/threads.tsv   a row for each scene and number of threads; its head names the machine.  OUT is bench/results
# bench/README.md explains scenes and columns.
#   SCENES='field-5000'  the scenes, each field-N or pack-N
#   TURNS=9              number of turns; the table has medians of ratios within a turn
#   CORES=16             largest number of threads, if not all processors are to be used
#   FLOE_QUICK=1         two small scenes, three turns
set -u
LC_ALL=C
export LC_ALL
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
fail() { echo "threads.sh: $*" >&2; exit 4; }

# shellcheck source=/dev/null # in the same folder
. "$bench/rungs.sh"
build=$(cd "${1:-$bench/../build}" && pwd) || exit 4
out=${2:-$bench/results}
mkdir -p "$out" "$build/threads" || exit 4
out=$(cd "$out" && pwd)
PATH=$build/bin:$PATH
quick=${FLOE_QUICK:-0}
if [ "$quick" = 0 ]; then
    scenes=${SCENES:-field-200 field-2000 field-5000 field-20000} turns=${TURNS:-9}
else
    scenes=${SCENES:-field-200 field-2000} turns=${TURNS:-3}
fi
cores=${CORES:-$(getconf _NPROCESSORS_ONLN)}
[ "$cores" -gt 1 ] || fail "at least two processors expected"
here=$build/threads/$$ # so that two can run at a time
mkdir -p "$here" && cd "$here" || exit 4
trap 'rm -rf "$here"' EXIT
trap 'exit 130' INT TERM HUP

# solve SCENE NAME THREADS: one run of a few seconds.
solve()
{
    run "$1" "$2" dem-solve -j "$3" --set run.dt="$(step "$1" patch 0.1)" \
        --set run.duration="$(awk -v n="${1#*-}" 'BEGIN { print n < 2500 ? 0.8 : 2000 / n }')"
}

# spent SCENE NAME: wall time of the run [s].
spent()
{
    [ "$(cat "$1/$2.status")" = 0 ] || fail "$1: $(cat "$1/$2.err")"
    number "$1/$2.report" 'simulated in'
}

# turn SCENE THREADS: seconds of one run alone, mean of the runs side by side, and of the run by THREADS threads.
turn()
{
    solve "$1" alone 1
    k=0
    while [ $k -lt "$2" ]; do
        solve "$1" "beside-$k" 1 &
        k=$((k + 1))
    done
    wait
    solve "$1" team "$2"
    [ "$(hash_of "$1" alone)" = "$(hash_of "$1" team)" ] || fail "$1: $2 threads give other bits than one"
    printf '%s\t' "$(spent "$1" alone)"
    k=0
    while [ $k -lt "$2" ]; do
        spent "$1" "beside-$k"
        k=$((k + 1))
    done | awk '{ s += $1 } END { printf "%.17g\t", s / NR }'
    spent "$1" team
}
hash_of() { awk '/^state hash/ { print $3 }' "$1/$2.report"; }

# Median of the numbers on standard input.
median() { sort -g | awk '{ v[NR] = $1 } END { print (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2 }'; }

for scene in $scenes; do
    make_scene "$scene"
    t=2
    while [ "$t" -le "$cores" ]; do
        say "$scene" "$t threads" "$turns turns"
        : >turns
        done=0
        while [ $done -lt "$turns" ]; do
            turn "$scene" "$t" >>turns || exit 4
            done=$((done + 1))
        done
        printf '%s\t%s\t%s\t' "$scene" "$t" "$(grep -c '^poly' "$scene/ice.dat")"
        awk '/contacts at a time/ { sub(/ contacts at a time.*/, ""); sub(/.*\(/, ""); printf "%s\t", $0 }' "$scene/alone.report"
        steps=$(awk '/^steps / { print $2 }' "$scene/alone.report")
        cut -f 1 turns | median | awk -v n="$steps" '{ printf "%.1f\t", 1e6 * $1 / n }'
        awk '{ print $1 / $3 }' turns | median | awk '{ printf "%.2f\t", $1 }'
        awk -v t="$t" '{ print t * $1 / $2 }' turns | median | awk '{ printf "%.2f\t", $1 }'
        awk -v t="$t" '{ print $2 / (t * $3) }' turns | median | awk '{ printf "%.2f\t", $1 }'
        printf '%s\n' "$(hash_of "$scene" team)"
        t=$((2 * t))
    done
done >rows

{
    echo '#threads 1'
    echo "#by $(dem-solve --version | head -n 1)"
    model=$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1)
    echo "#processor ${model:-unknown}, $(uname -m), $cores cores"
    echo "#load $(uptime | sed 's/.*: //') over 1, 5 and 15 minutes; medians of $turns turns"
    printf 'scene\tthreads\tbodies\tcontacts\tstep[us]\tspeedup\tattainable\tefficiency\thash\n'
    cat rows
} >threads.tsv
cp threads.tsv "$out" || exit 4
cat threads.tsv
