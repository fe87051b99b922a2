#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# sleep.sh [BUILD [OUT]] -- time and error of run.sleep, without and with surrogates, with the programs of BUILD/bin.
#   OUT/sleep.tsv       a row for each scene, step, tolerance and sleep; its head names the machine.  OUT is bench/results
# bench/README.md explains scenes and columns.  One thread.
#   FLOE_QUICK=1        shorter runs, once each
#   SCENES='field-200'  patterns of the scenes to run
#   LAW=patch           contact law
#   TURNS=5             number of runs of each setting, in turn; the least time of each is kept
set -u
LC_ALL=C
export LC_ALL
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
fail() { echo "sleep.sh: $*" >&2; exit 4; }

# shellcheck source=/dev/null # in the same folder
. "$bench/rungs.sh"
build=$(cd "${1:-$bench/../build}" && pwd) || exit 4
out=${2:-$bench/results}
mkdir -p "$out" "$build/sleep" || exit 4
out=$(cd "$out" && pwd)
PATH=$build/bin:$PATH
quick=${FLOE_QUICK:-0} wanted=${SCENES:-*}
[ "$quick" = 0 ] && turns=${TURNS:-5} || turns=${TURNS:-1}
here=$build/sleep/$$
mkdir -p "$here" && cd "$here" || exit 4
trap 'rm -rf "$here"' EXIT
trap 'exit 130' INT TERM HUP

# Settings of the rows: tolerance of surrogates, tolerance of sleep.
settings='0,none 0,1e-6 0,1e-5 0,1e-4 1e-3,none 1e-3,1e-5 1e-2,none 1e-2,1e-5'

# solve SCENE NAME DT TOLERANCE SLEEP: one run.
solve()
{
    run "$1" "$2" dem-solve -j 1 --set contact.law="${LAW:-patch}" --set contact.surrogate="$4" --set run.sleep="$5" --set run.dt="$3"
    [ "$(cat "$1/$2.status")" = 0 ] || fail "$1: $2: $(cat "$1/$2.err")"
}

# errors SCENE NAME BASE: the columns of row.awk for that run, with errors against BASE.
errors()
{
    awk -v bodies="$(grep -c '^poly' "$1/ice.dat")" -v status=0 -f "$bench/row.awk" "$1/$2.report" "$1/$2.loads" \
        "$1/$3.loads" "$1/$2.state" "$1/$3.state"
}

# sleep_figures REPORT: fraction of body-steps skipped, steps per skip, largest error of a skip over the radius, and the
# largest sum for a floe.
sleep_figures()
{
    awk '/^sleeping/ { share = $2 / 100; sub(/.*without contact, /, ""); steps = $1 }
        /error of a skip at most/ { error = $7; sub(/.*run.sleep[^)]*\), /, ""); printf "%.3g\t%s\t%s\t%s", share, steps, error, $1 }' "$1"
}

# row SCENE TOLERANCE SLEEP: cost of the run, its sleep figures, and its errors.
row()
{
    name=$2-$3
    r=$1/$name.report
    slept=$(sleep_figures "$r")
    { errors "$1" "$name" reference && errors "$1" "$name" 0-none; } |
        awk -v at="$1	$2	$3" -v hits="$(number "$r" 'surrogate share')" -v slept="${slept:-0	-	-	-}" '
            BEGIN { FS = OFS = "\t" }
            NR == 1 { first = at OFS $2 OFS $4 OFS (hits == "" ? 0 : hits) OFS slept OFS $9 OFS $10 OFS $12
                      cost = $5 OFS $7 OFS $14 }
            NR == 2 { print first, $9, $10, cost }'
}

: >rows
for s in field-200 field-2000 cylinder; do
    matches "$s" "$wanted" || continue
    make_scene "$s"
    say "$s" reference ""
    solve "$s" reference "$(step "$s" patch 0.004)" 0 none
    dt=$(step "$s" patch 0.1)
    say "$s" "step 0.1" "$turns turns"
    turn=0
    while [ $turn -lt "$turns" ]; do
        turn=$((turn + 1))
        for both in $settings; do
            tol=${both%,*} sleep=${both#*,} name=${both%,*}-${both#*,}
            best "$s" "$name" solve "$s" "$name" "$dt" "$tol" "$sleep"
        done
    done
    for both in $settings; do row "$s" "${both%,*}" "${both#*,}" >>rows; done
done
[ -s rows ] || fail "no scene matches $wanted"

{
    echo '#sleep 1'
    echo "#by $(dem-solve --version | head -n 1)"
    echo "#processor $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1), $(uname -m)"
    echo "#load $(uptime | sed 's/.*: //') over 1, 5 and 15 minutes, the runs themselves being 1; least of $turns turns"
    printf 'scene\ttolerance\tsleep\tdt[s]\tcontacts\tsurrogate_share\tsleeping\tsteps_per_skip\tskip_error\t'
    printf 'skip_error_sum\timpulse\tpeak\tenergy\town_impulse\town_peak\t'
    printf 'cost[s/s]\tbody_step[ns]\thash\tratio\n'
    awk 'BEGIN { FS = OFS = "\t" } $2 == 0 && $3 == "none" { base = $17 } { print $0, sprintf("%.3g", $17 / base) }' rows
} >sleep.tsv
cp sleep.tsv "$out" || exit 4
cut -f 1-3,6-15,17,19 sleep.tsv | grep -v '^#'
