#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# surrogate.sh [BUILD [OUT]] -- time and error of contact.surrogate, with the programs of BUILD/bin.
#   OUT/surrogate.tsv   a row for each scene, step and tolerance; its head names the machine.  OUT is bench/results
#   OUT/surrogate.png   error against time, if gnuplot is installed
# bench/README.md explains scenes and columns.  One thread.
#   FLOE_QUICK=1        shorter runs, once each
#   SCENES='stack'      patterns of the scenes to run
#   TURNS=5             number of runs of each tolerance of a step, in turn; the least time of each is kept;
#                       four times as many for the scene pair
set -u
LC_ALL=C
export LC_ALL
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
fail() { echo "surrogate.sh: $*" >&2; exit 4; }

# shellcheck source=/dev/null # in the same folder
. "$bench/rungs.sh"
build=$(cd "${1:-$bench/../build}" && pwd) || exit 4
out=${2:-$bench/results}
mkdir -p "$out" "$build/surrogate" || exit 4
out=$(cd "$out" && pwd)
PATH=$build/bin:$PATH
quick=${FLOE_QUICK:-0} wanted=${SCENES:-*}
[ "$quick" = 0 ] && turns=${TURNS:-5} || turns=${TURNS:-1}
here=$build/surrogate/$$
mkdir -p "$here" && cd "$here" || exit 4
trap 'rm -rf "$here"' EXIT
trap 'exit 130' INT TERM HUP
tolerances='0 1e-4 1e-3 1e-2'

# solve SCENE NAME FRACTION TOLERANCE: one run.
solve()
{
    run "$1" "$2" dem-solve -j 1 --set contact.law=patch --set contact.surrogate="$4" --set run.dt="$(step "$1" patch "$3")"
    [ "$(cat "$1/$2.status")" = 0 ] || fail "$1: step $3, tolerance $4: $(cat "$1/$2.err")"
}

# errors SCENE NAME BASE: the columns of row.awk for that run, with errors against BASE.
errors()
{
    awk -v bodies="$(grep -c '^poly' "$1/ice.dat")" -v status=0 -f "$bench/row.awk" "$1/$2.report" "$1/$2.loads" \
        "$1/$3.loads" "$1/$2.state" "$1/$3.state"
}

# row SCENE FRACTION TOLERANCE: cost of the run, its surrogate figures, and its errors.
row()
{
    name=$2-$3
    r=$1/$name.report
    printf '%s\t%s\t%s\t' "$1" "$2" "$3"
    { errors "$1" "$name" reference && errors "$1" "$name" "$2-0"; } |
        awk -v seen="$(number "$r" 'step over critical')" -v hits="$(number "$r" 'surrogate share')" \
            -v missed="$(number "$r" 'contact-steps;')" -v worst="$(number "$r" 'at most by')" '
            BEGIN { FS = OFS = "\t" }
            function given(x, other) { return x == "" ? other : x }
            NR == 1 { run = $2 OFS seen OFS $4 OFS given(hits, 0) OFS given(missed, "-") OFS given(worst, "-")
                      error = $9 OFS $10 OFS $11 OFS $12; cost = $5 OFS $7 OFS $8 OFS $14 }
            NR == 2 { print run, error, (hits == "" ? "-\t-" : $9 OFS $10), cost }'
}

: >rows
for s in field-200 cylinder pair stack; do
    matches "$s" "$wanted" || continue
    make_scene "$s"
    say "$s" reference ""
    solve "$s" reference 0.004 0
    for f in 0.1 0.02; do
        turn=0
        [ "$s" = pair ] && all=$((4 * turns)) || all=$turns # the shortest runs
        say "$s" "step $f" "$all turns"
        while [ $turn -lt "$all" ]; do
            turn=$((turn + 1))
            for tol in $tolerances; do
                name=$f-$tol
                best "$s" "$name" solve "$s" "$name" "$f" "$tol"
            done
        done
        for tol in $tolerances; do row "$s" "$f" "$tol" >>rows; done
    done
done
[ -s rows ] || fail "no scene matches $wanted"

{
    echo '#surrogate 1'
    echo "#by $(dem-solve --version | head -n 1)"
    echo "#processor $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1), $(uname -m)"
    echo "#load $(uptime | sed 's/.*: //') over 1, 5 and 15 minutes, the runs themselves being 1; least of $turns turns"
    printf 'scene\tstep\ttolerance\tdt[s]\tstep_over_critical\tcontacts\tsurrogate_share\tmissed\tworst\timpulse\tpeak\t'
    printf 'motion\tenergy\town_impulse\town_peak\t'
    printf 'cost[s/s]\tbody_step[ns]\tcontact_step[ns]\thash\tratio\n'
    awk 'BEGIN { FS = OFS = "\t" } $3 == 0 { base = $17 } { print $0, sprintf("%.3g", $17 / base) }' rows
} >surrogate.tsv
cp surrogate.tsv "$out" || exit 4
if command -v gnuplot >/dev/null; then
    gnuplot -e "out='$out'; scenes='$(cut -f 1 rows | uniq | tr '\n' ' ')'" "$bench/surrogate.gp" || fail "gnuplot failed"
else
    say picture "" "skipped, gnuplot is not installed"
fi
cut -f 1-3,7-15,17,20 surrogate.tsv | grep -v '^#'
