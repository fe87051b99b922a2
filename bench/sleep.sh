#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# sleep.sh [BUILD [OUT]] -- what run.sleep saves and costs, without and with surrogates, with the programs of BUILD/bin.
#   OUT/sleep.tsv       a row for each scene, step, tolerance and sleep; its head names the machine.  OUT is bench/results
# What a run is and what the columns are: bench/README.md.  One thread.
#   FLOE_QUICK=1        shorter runs, once each
#   SCENES='field-200'  patterns of the scenes that are wanted
#   TURNS=5             how often the runs of a scene are made, one after the other; the least of each counts
set -u
LC_ALL=C
export LC_ALL
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
fail() { echo "sleep.sh: $*" >&2; exit 4; }

# shellcheck source=/dev/null # it lies beside this file
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

# The settings of a row: tolerance of surrogates, and of sleep.
settings='0,none 0,1e-6 0,1e-5 0,1e-4 1e-3,none 1e-3,1e-5 1e-2,none 1e-2,1e-5'

# go SCENE NAME DT TOLERANCE SLEEP: one run.
go()
{
    run "$1" "$2" dem-solve -j 1 --set contact.law=patch --set contact.surrogate="$4" --set run.sleep="$5" --set run.dt="$3"
    [ "$(cat "$1/$2.status")" = 0 ] || fail "$1: $2: $(cat "$1/$2.err")"
}

# errors SCENE NAME BASE: the columns of row.awk for that run, its errors being against BASE.
errors()
{
    awk -v bodies="$(grep -c '^poly' "$1/ice.dat")" -v status=0 -f "$bench/row.awk" "$1/$2.report" "$1/$2.loads" \
        "$1/$3.loads" "$1/$2.state" "$1/$3.state"
}

# skipped REPORT: share of the body-steps skipped, steps per skip, largest error over the radius, and its largest sum.
skipped()
{
    sed -n '
        s/^sleeping *\([^ ]*\) % of body-steps skipped without contact, \([^ ]*\) steps per skip.*/\1 \2/p
        s/^ *error of a skip at most \([^ ]*\) of the radius.*, \([^ ]*\) in sum.*/\1 \2/p' "$1" |
        awk 'NR == 1 { share = $1 / 100; span = $2 } NR == 2 { print share "\t" span "\t" $1 "\t" $2 }'
}

# row SCENE TOLERANCE SLEEP: what the run took, what slept, and how far it is off.
row()
{
    name=$2-$3
    r=$1/$name.report
    slept=$(skipped "$r")
    { errors "$1" "$name" reference && errors "$1" "$name" 0-none; } |
        awk -v at="$1	$2	$3" -v told="$(number "$r" "surrogate share")" -v slept="${slept:-0	-	-	-}" '
            BEGIN { FS = OFS = "\t" }
            NR == 1 { first = at OFS $2 OFS $4 OFS (told == "" ? 0 : told) OFS slept OFS $9 OFS $10 OFS $12
                      cost = $5 OFS $7 OFS $14 }
            NR == 2 { print first, $9, $10, cost }'
}

: >rows
for s in field-200 field-2000 cylinder; do
    is "$s" "$wanted" || continue
    make_scene "$s"
    told "$s" reference ""
    go "$s" reference "$(step "$s" patch 0.004)" 0 none
    dt=$(step "$s" patch 0.1)
    told "$s" "step 0.1" "$turns turns"
    turn=0
    while [ $turn -lt "$turns" ]; do
        turn=$((turn + 1))
        for both in $settings; do
            tol=${both%,*} sleep=${both#*,} name=${both%,*}-${both#*,}
            best "$s" "$name" go "$s" "$name" "$dt" "$tol" "$sleep"
        done
    done
    for both in $settings; do row "$s" "${both%,*}" "${both#*,}" >>rows; done
done
[ -s rows ] || fail "no scene is like $wanted"

{
    echo '#sleep 1'
    echo "#by $(dem-solve --version)"
    echo "#processor $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1), $(uname -m)"
    echo "#load $(uptime | sed 's/.*: //') over 1, 5 and 15 minutes, the runs themselves being 1; least of $turns turns"
    printf 'scene\ttolerance\tsleep\tdt[s]\tcontacts\ttold\tasleep\tspan\toff\tsummed\timpulse\tpeak\tenergy\town_impulse\town_peak\t'
    printf 'cost[s/s]\tbody_step[ns]\thash\tratio\n'
    awk 'BEGIN { FS = OFS = "\t" } $2 == 0 && $3 == "none" { base = $17 } { print $0, sprintf("%.3g", $17 / base) }' rows
} >sleep.tsv
cp sleep.tsv "$out" || exit 4
cut -f 1-3,6-15,17,19 sleep.tsv | grep -v '^#'
