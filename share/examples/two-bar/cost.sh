#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# cost.sh MODEL UNTIL LIMIT OUT -- points, steps and error of the limit for several predictors, a row each.
# The first rows are the predictor by load steps of Ye & Xu (2024) over eta (steps) and detP (load factor of a step).
set -eu
model=$1 until=$2 limit=$3 out=$4
printf 'predictor\teta\tdetP\tpoints\tsteps\tfound\terror\n'
row() # NAME ETA DETP OPTIONS...
{
    name=$1 eta=$2 detp=$3
    shift 3
    arc-path -q "$@" --until "$until" -o "$out/cost.tsv" "$model" 2>"$out/cost.err" || :
    awk -v name="$name" -v eta="$eta" -v detp="$detp" -v exact="$limit" '
        /^#limit maximum/ && found == "" { split($3, a, "="); found = a[2] }
        /^[0-9]/ { points = $1; steps += $6 }
        END {
            if (found == "") printf "%s\t%s\t%s\t%d\t%d\t-\t-\n", name, eta, detp, points, steps
            else printf "%s\t%s\t%s\t%d\t%d\t%.6f\t%.1e\n", name, eta, detp, points, steps, found, (found > exact ? found - exact : exact - found) / exact
        }' "$out/cost.tsv"
}
for eta in 10 30 100; do
    for detp in 0.0004 0.002 0.01; do
        row load "$eta" "$detp" --predictor load --load-steps "$eta" --load-step "$detp" --points 2000
    done
done
for resolution in 0.1 0.03 0.01 0.003; do row chord - $resolution --resolution $resolution; done
for resolution in 0.1 0.03 0.01 0.003; do row adaptive - $resolution --damping adaptive --resolution $resolution; done
