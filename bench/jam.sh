#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# jam.sh [BUILD [OUT]] -- test for a bias of jams by contact.surrogate or by the law.  Runs share/examples/cylinder in
# pairs, in two ways, each pair with its own restitution and step, with the programs of BUILD/bin.
#   OUT/NAME.tsv   a row for each run; its head names the machine.  OUT is bench/results
# second_peaks is the mean of the largest forces along the drift in each second, median and tenth are what half and a
# tenth of them exceed.
# Prints means, standard errors, paired differences and two-sample tests by jam.awk.
#   WAYS='patch:0 patch:1e-3'   law and tolerance of the surrogates of the two runs of a pair
#   NAME=jam      name of the table
#   PAIRS=57      number of pairs, half a minute of processor time each
#   JOBS=2        pairs at a time, one thread each
#   FLOE_QUICK=1  3 pairs of 8 s, a few seconds in all
# Restitution is 0.28 to 0.32 and the step 0.38 to 0.57 ms.  Pair n takes the fractional parts of n/g and n/g^2 with
# g^3 = g + 1, which fill the square evenly for any number of pairs; fewer pairs are the first of 57.
set -u
LC_ALL=C
export LC_ALL
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
fail() { echo "jam.sh: $*" >&2; exit 4; }

# pair N SECONDS: runs both runs of that pair and writes their rows.
if [ "${1-}" = pair ]; then # called by xargs in the folder of the runs
    n=$2 seconds=$3
    # shellcheck disable=SC2046 # two numbers
    set -- $(awk -v n="$n" 'BEGIN {
        g = 1.32471795724474602596
        e = n / g; dt = n / (g * g)
        printf "%.4f %.4f", 0.28 + 0.04 * (e - int(e)), 0.38 + 0.19 * (dt - int(dt)) }')
    for way in $WAYS; do
        law=${way%:*} tol=${way#*:}
        name=$n-$way
        echo "pair $n, $law, tolerance $tol: restitution $1, $2 ms" >&2
        dem-solve -q -j 1 --ice g-polys.dat --structure g_struct.dat --set run.duration="$seconds" \
            --set run.dt="$2 ms" --set contact.restitution="$1" --set contact.law="$law" \
            --set contact.surrogate="$tol" \
            --set output.state=none --set output.frames=none \
            --set output.energy="$name.energy" --set output.energy_every="$seconds" \
            --report "$name.report" -o "$name.loads" scene 2>"$name.err" ||
            fail "pair $n, $way: $(cat "$name.err")"
        awk -v first="$n $law $tol $1" -v ms="$2" -v seconds="$seconds" '
            FNR == 1 { split("", col) }
            /^energy residual/ { residual = $3 }
            /^processor/ { cpu = $2 }
            /^state hash/ { hash = $3 }
            /^#/ || FILENAME ~ /report$/ { next }
            !("t[s]" in col) { for (k = 1; k <= NF; k++) col[$k] = k; next }
            "part" in col {
                f = $col["fx[N]"]
                J += f * ($1 - before)
                before = $1
                s = int($1)
                if (f > most[s]) most[s] = f
                if (f > peak) peak = f
                next
            }
            { friction = $col["friction[J]"]; damping = $col["damping[J]"] }
            function exceeded(share) { return sorted[int((1 - share) * (n - 1)) + 1] }
            END {
                gsub(" ", "\t", first)
                for (s = 0; s < seconds; s++) { # sorted by insertion
                    sum += most[s]
                    for (k = ++n; k > 1 && sorted[k - 1] > most[s]; k--) sorted[k] = sorted[k - 1]
                    sorted[k] = most[s] + 0
                }
                printf "%s\t%.7g\t%.6g\t%.6g\t%.6g\t", first, ms / 1e3, J / 1e3, peak / 1e3, sum / seconds / 1e3
                printf "%.6g\t%.6g\t", exceeded(0.5) / 1e3, exceeded(0.1) / 1e3
                printf "%.6g\t%.6g\t", friction / 1e3, damping / 1e3
                printf "%s\t%.4g\t%s\n", residual, cpu / seconds, hash
            }' "$name.report" "$name.loads" "$name.energy" >"$name.row"
        rm "$name.loads" "$name.energy"
    done
    exit 0
fi

build=$(cd "${1:-$bench/../build}" && pwd) || exit 4
out=${2:-$bench/results}
mkdir -p "$out" "$build/jam" || exit 4
out=$(cd "$out" && pwd)
PATH=$build/bin:$PATH
WAYS=${WAYS:-patch:0 patch:1e-3} NAME=${NAME:-jam}
export WAYS
if [ "${FLOE_QUICK:-0}" = 0 ]; then pairs=${PAIRS:-57} seconds=60; else pairs=${PAIRS:-3} seconds=8; fi
here=$build/jam/$$
mkdir -p "$here" && cd "$here" || exit 4
trap 'rm -rf "$here"' EXIT
trap 'exit 130' INT TERM HUP

example=$bench/../share/examples/cylinder
make -s -C "$example" BIN="$build/bin" OUT="$here" "$here/g-polys.dat" "$here/g_struct.dat" >made 2>&1 ||
    fail "$(cat made)"
cp "$example/cylinder.scene" scene || exit 4
awk -v n="$pairs" -v s="$seconds" 'BEGIN { for (k = 1; k <= n; k++) print "pair", k, s }' >list
xargs -L 1 -P "${JOBS:-2}" sh "$bench/jam.sh" <list || fail "not all pairs ran"
{
    echo '#jam 1'
    echo "#by $(dem-solve --version | head -n 1)"
    echo "#processor $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1), $(uname -m)"
    echo "#load $(uptime | sed 's/.*: //') over 1, 5 and 15 minutes, the runs themselves being ${JOBS:-2}"
    echo "#seconds $seconds"
    printf 'pair\tlaw\ttolerance\trestitution\tdt[s]\timpulse[kN.s]\tpeak[kN]\tsecond_peaks[kN]\t'
    printf 'median[kN]\ttenth[kN]\t'
    printf 'friction[kJ]\tdamping[kJ]\t'
    printf 'energy\tcost[s/s]\thash\n'
    while read -r _ n _; do for way in $WAYS; do cat "$n-$way.row"; done; done <list
} >"$NAME.tsv"
cp "$NAME.tsv" "$out" || exit 4
awk -f "$bench/jam.awk" "$NAME.tsv"
