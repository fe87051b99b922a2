# SPDX-License-Identifier: GPL-3.0-or-later
# faces.awk -- a table of bonds(5): the faces at its last time: x, y, damage, and whether they are open;
# with -v cracks=1 the area of crack, damage times area, against time.
BEGIN { FS = "\t" }
/^#/ || $1 == "t[s]" { next }
$1 != t { if (cracks && t != "") print t, sum; t = $1; n = 0; sum = 0 }
{ line[++n] = $10 " " $11 " " $5 " " ($4 == "ended"); sum += $5 * $9 }
END {
    if (cracks) print t, sum
    for (k = 1; k <= n && !cracks; k++) print line[k]
}
