# SPDX-License-Identifier: GPL-3.0-or-later
# table.awk -- the stats table of loadstats, aligned, forces in kN, five digits.
BEGIN { FS = "\t" }
/^#/ { next }
!columns { columns = NF; for (k = 1; k <= NF; k++) name[k] = $k; next }
{ rows++; for (k = 1; k <= NF; k++) cell[rows, k] = $k }
function unit(r) { return cell[r, 3] == "N" ? "kN" : cell[r, 3] == "N.m" ? "kNm" : cell[r, 3] }
function show(r, k,    x) {
    x = cell[r, k]
    if (x == "-" || k <= 4) return x
    if (name[k] ~ /^(min|max|mean|std|q[0-9.]+|peak_.*)$/ && cell[r, 3] ~ /^N/) x /= 1000
    return sprintf("%.5g", x)
}
END {
    if (!rows) { print "table.awk: no rows" >"/dev/stderr"; exit 3 }
    printf "%-14s", "load on " cell[1, 1]
    for (r = 1; r <= rows; r++) printf "%15s", cell[r, 2] " " cell[r, 4]
    printf "\n%-14s", "unit"
    for (r = 1; r <= rows; r++) printf "%15s", unit(r)
    for (k = 5; k <= columns; k++) {
        printf "\n%-14s", name[k]
        for (r = 1; r <= rows; r++) printf "%15s", show(r, k)
    }
    print ""
}
