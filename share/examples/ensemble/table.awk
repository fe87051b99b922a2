# SPDX-License-Identifier: GPL-3.0-or-later
# table.awk -- the table ensemble of loadstats, aligned: some numbers of runs, forces in kN.
BEGIN { FS = "\t" }
/^#/ || $1 == "part" { next }
{ line[++n] = $0; last[$1 " " $2] = $4 }
function kilo(x) { return x == "-" ? "-" : sprintf("%.4g", x / 1000) }
END {
    if (!n) { print "table.awk: no rows" >"/dev/stderr"; exit 3 }
    printf "%-10s %5s %10s %21s %10s %21s %10s\n", "", "runs", "mean", "95 % interval", "maximum", "95 % interval", "largest"
    for (k = 1; k <= n; k++) {
        split(line[k], c, "\t")
        if (c[4] !~ /^(2|5|10|20|50|100|200|500)$/ && c[4] != last[c[1] " " c[2]]) continue
        printf "%-10s %5d %10s %10s %10s %10s %10s %10s %10s\n", c[1] " " c[2], c[4], kilo(c[5]), kilo(c[6]),
            kilo(c[7]), kilo(c[9]), kilo(c[10]), kilo(c[11]), kilo(c[13])
    }
    print "forces in kN; mean of the means of the runs, and of their largest loads (each over 20 ms)"
}
