# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f float.awk KEEL.TSV STATE LOADS: the keel before and after it floated up, and the load on the cylinder.
FNR == 1 { file++ }
file == 1 && $1 == "bodies" { n = $4 }
file == 1 && $1 == "solid-part" { solid = $4 }
file == 2 && $1 ~ /^[0-9]/ {
    if (start == "") start = $1
    if ($1 != t) { low = 0; sum = 0; k = 0 }
    t = $1
    if ($5 < low) low = $5
    sum += $5; k++
    if ($1 == start) { low0 = low; mean0 = sum / k }
}
file == 3 && $1 ~ /^[0-9]/ && $2 == "leg" { if (-$3 > most) most = -$3; if (first == "" && $3 != 0) first = $1 }
END {
    printf "blocks in the keel mesh            %d, solid part %.3f\n", n, solid
    printf "lowest centre [m]                  %.2f, at the end %.2f\n", low0, low
    printf "mean depth of centres [m]          %.2f, at the end %.2f\n", -mean0, -sum / k
    printf "load on the cylinder begins [s]    %s, largest of a row %.3g kN\n", first == "" ? "-" : first, most / 1000
}
