#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# cost.sh MODEL UNTIL LIMIT OUT -- points, steps, processor seconds and error of the limit for several predictors, a row each.
# The first rows are the predictor by load steps of Ye & Xu (2024) over eta (steps) and detP (load factor of a step).
set -eu
model=$1 until=$2 limit=$3 out=$4
printf 'predictor\teta\tdetP\tpoints\tsteps\tseconds\tfound\terror\n'
# clock: processor seconds of the programs so far, in $now; in this shell, for those of a subshell are others.
clock()
{
    times >"$out/clock"
    now=$(awk 'NR == 2 { split($1, a, "m"); print 60 * a[1] + a[2] }' "$out/clock")
}
row() # NAME ETA DETP OPTIONS...
{
    name=$1 eta=$2 detp=$3
    shift 3
    clock
    begun=$now
    arc-path -q "$@" --until "$until" -o "$out/cost.tsv" "$model" 2>"$out/cost.err" || :
    clock
    awk -v name="$name" -v eta="$eta" -v detp="$detp" -v exact="$limit" -v seconds="$now" -v begun="$begun" '
        /^#limit maximum/ && found == "" { split($3, a, "="); found = a[2] }
        /^[0-9]/ { points = $1; steps += $6 }
        END {
            if (found == "") printf "%s\t%s\t%s\t%d\t%d\t%.2f\t-\t-\n", name, eta, detp, points, steps, seconds - begun
            else printf "%s\t%s\t%s\t%d\t%d\t%.2f\t%.6f\t%.1e\n", name, eta, detp, points, steps, seconds - begun, found, (found > exact ? found - exact : exact - found) / exact
        }' "$out/cost.tsv"
}
for eta in 10 30 100; do
    for detp in 0.0004 0.002 0.01; do
        row load "$eta" "$detp" --predictor load --load-steps "$eta" --load-step "$detp" --points 2000
    done
done
for resolution in 0.1 0.03 0.01 0.003; do row chord - $resolution --resolution $resolution; done
for resolution in 0.1 0.03 0.01 0.003; do row adaptive - $resolution --damping adaptive --resolution $resolution; done
