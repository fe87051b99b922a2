#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# late.sh [BUILD [OUT]] -- time per contact late in a jam, by both laws, without surrogates and with 1e-3: one more
# second after 41 s of share/examples/cylinder, in steps of 0.1 ms, with the programs of BUILD/bin.  One thread.
#   OUT/late.tsv   a row for each start, law and tolerance; its head names the machine.  OUT is bench/results
# bench/README.md explains the two starts and the columns.
#   WAYS='patch:0 patch:1e-3 quick:0 quick:1e-3'   laws and tolerances; the first is that of the later state
#   TURNS=3        number of runs of each way, in turn; the least time of each is kept
#   FLOE_QUICK=1   0.1 s after 8 s, once
set -u
LC_ALL=C
export LC_ALL
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
fail() { echo "late.sh: $*" >&2; exit 4; }

build=$(cd "${1:-$bench/../build}" && pwd) || exit 4
out=${2:-$bench/results}
mkdir -p "$out" "$build/late" || exit 4
out=$(cd "$out" && pwd)
PATH=$build/bin:$PATH
if [ "${FLOE_QUICK:-0}" = 0 ]; then
    after=41 more=1 turns=${TURNS:-3}
else
    after=8 more=0.1 turns=${TURNS:-1}
fi
ways=${WAYS:-patch:0 patch:1e-3 quick:0 quick:1e-3}
until=$(awk -v a=$after -v b=$more 'BEGIN { print a + b }')
here=$build/late/$$
mkdir -p "$here" && cd "$here" || exit 4
trap 'rm -rf "$here"' EXIT
trap 'exit 130' INT TERM HUP

# solve NAME OPTION...: one run; leaves NAME.report.
solve()
{
    name=$1
    shift
    dem-solve -q -j 1 --report "$name.report" "$@" 2>err || fail "$name: $(cat err)"
}

# begin NAME ICE LAW:TOLERANCE OPTION...: a run from the start; leaves NAME.loads and NAME.energy as well.
begin()
{
    name=$1 ice=$2 way=$3
    shift 3
    solve "$name" --ice "$ice" --structure g_struct.dat --set contact.law="${way%:*}" --set contact.surrogate="${way#*:}" \
        --set output.frames=none --set output.energy="$name.energy" -o "$name.loads" "$@" scene
}

# second START LAW:TOLERANCE: the measured second.
second()
{
    case $1 in
    checkpoint) # rows after the checkpoint are cut off, so the run can be repeated
        solve "$1-$2" --resume "$2.checkpoint" --set run.duration="$until" --set run.dt=0.0001 \
            --set output.checkpoint=none
        ;;
    state)
        begin "$1-$2" later.dat "$2" --set run.duration=$more --set run.dt=0.0001 --set output.state=none
        ;;
    esac
}

# Wall time per contact-step [ns].
cost() { awk '/ns per contact-step/ { print $5 }' "$1"; }

# row START LAW:TOLERANCE: time of the fastest run, and its results in the measured second.  The report of a resumed run
# covers the whole run, so the part before the checkpoint is subtracted.
row()
{
    before=/dev/null since=0
    [ "$1" = checkpoint ] && before=before-$2.report since=$after
    awk -v first="$1 ${2%:*} ${2#*:}" -v since="$since" '
        /^steps/ { done = steps; steps = $2 }
        /ns per contact-step/ { ns = $5; contacts = substr($9, 2); all += (steps - done) * contacts }
        /^surrogate share/ { earlier = hits; hits = $3 * all }
        /^processor/ { cpu = $2 }
        /^state hash/ { hash = $3 }
        FNR == 1 { split("", col) }
        /^#/ || FILENAME ~ /(report|best)$/ { next }
        !("t[s]" in col) { for (k = 1; k <= NF; k++) col[$k] = k; next }
        "part" in col { if ($1 > since + 1e-6) J += $col["fx[N]"] * ($1 - t); t = $1; next }
        {
            residual = $col["residual[J]"]; lost = $col["friction[J]"] + $col["damping[J]"]
            if ($1 < since + 1e-6) { residual0 = residual; lost0 = lost }
        }
        END {
            gsub(" ", "\t", first)
            off = residual - residual0
            n = (steps - done) * contacts
            printf "%s\t%s\t%.2f\t%.7g\t", first, contacts, (hits - earlier) / n, J / 1e3
            printf "%.2g\t", (off < 0 ? -off : off) / (lost - lost0)
            printf "%.4g\t%.4g\t%s\n", ns / 1e3, 1e6 * cpu / n, hash
        }' "$before" "$1-$2.best" "$1-$2.loads" "$1-$2.energy"
}

example=$bench/../share/examples/cylinder
make -s -C "$example" BIN="$build/bin" OUT="$here" "$here/g-polys.dat" "$here/g_struct.dat" >made 2>&1 ||
    fail "$(cat made)"
cp "$example/cylinder.scene" scene || exit 4
for way in $ways; do
    echo "$way: the first $after s" >&2
    begin "checkpoint-$way" g-polys.dat "$way" --set run.duration=$after --set output.state="$way.state" \
        --set output.state_every=$after --set output.checkpoint="$way.checkpoint" \
        --set output.checkpoint_every=$after
    mv "checkpoint-$way.report" "before-$way.report"
done
awk -f "$bench/later.awk" "${ways%% *}.state" g-polys.dat >later.dat || exit 4

turn=0
while [ $turn -lt "$turns" ]; do
    turn=$((turn + 1))
    echo "turn $turn: $more s of each" >&2
    for start in checkpoint state; do
        for way in $ways; do
            run=$start-$way
            second $start "$way"
            if [ ! -f "$run.best" ] || [ "$(cost "$run.report")" -lt "$(cost "$run.best")" ]; then
                mv "$run.report" "$run.best"
            fi
        done
    done
done
for start in checkpoint state; do
    for way in $ways; do row $start "$way"; done
done >rows
{
    echo '#late 1'
    echo "#by $(dem-solve --version | head -n 1)"
    echo "#processor $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1), $(uname -m)"
    load=$(uptime | sed 's/.*: //')
    echo "#load $load over 1, 5 and 15 minutes, the runs themselves being 1; least of $turns turns"
    echo "#seconds $more after $after"
    printf 'start\tlaw\ttolerance\tcontacts\tsurrogate_share\timpulse[kN.s]\town_impulse\tenergy\t'
    printf 'contact_step[us]\tprocessor[us]\tratio\thash\n'
    awk 'BEGIN { FS = OFS = "\t" }
        { own = "-" }
        !($1 in base) { base[$1] = $9 }
        $3 == 0 { J = $6 }
        $3 > 0 && $1 == "state" && J { own = sprintf("%.2g", ($6 > J ? $6 - J : J - $6) / J) }
        { print $1, $2, $3, $4, $5, $6, own, $7, $8, $9, sprintf("%.2f", $9 / base[$1]), $10 }' rows
} >late.tsv
cp late.tsv "$out" || exit 4
cut -f 1-11 late.tsv | grep -v '^#'
