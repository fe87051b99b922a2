# SPDX-License-Identifier: GPL-3.0-or-later
# row.awk -- the load of a run, and what pushed: awk -f row.awk -v of=NAME STATS LOADS
BEGIN { FS = "\t" }
FNR == NR && /^#/ { next }
FNR == NR && !col { for (k = 1; k <= NF; k++) at[$k] = k; col = 1; next }
FNR == NR { mean = $at["mean"] / 1e6; largest = $at["largest"] / 1e6; next }
/^#report pushed by/ { sub(/^#report pushed by */, ""); push = $0 }
END {
    sub(/.*\//, "", of)
    printf "%-14s mean %5.2f MN, largest %5.2f MN; %s\n", of, mean, largest, push
}
