# SPDX-License-Identifier: GPL-3.0-or-later
# hard.awk -- one line per hard case, H01 to H40, from the output of the verification programs: how many rows it has,
# how many of them hold, and the row with the least room: error (or value, against a bound) over tolerance.
function room(    e, t)
{
    if ($(NF - 1) == "rel" || $(NF - 1) == "abs" || $(NF - 1) == "max") {
        e = $(NF - 3) + 0
        t = $(NF - 2) + 0
        return e <= 0 ? 0 : t > 0 ? e / t : 1e300
    }
    return $NF == "ok" ? 0 : 1e300
}
/^H[0-4][0-9] .* (ok|FAIL)$/ {
    rows[$1]++
    holds[$1] += $NF == "ok"
    r = $NF == "ok" ? room() : 1e301
    if (!($1 in least) || r > least[$1]) {
        least[$1] = r
        line[$1] = substr($0, 6)
        sub(/^ +/, "", line[$1])
    }
}
END {
    print "the hard cases: rows that hold, of how many, and the one with the least room"
    for (k = 1; k <= 40; k++) {
        h = sprintf("H%02d", k)
        if (h in rows) printf "%s %3d of %-3d %s\n", h, holds[h], rows[h], line[h]
        else printf "%s no row\n", h
    }
}
