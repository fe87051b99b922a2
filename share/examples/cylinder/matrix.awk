# SPDX-License-Identifier: GPL-3.0-or-later
# matrix.awk -- one row for each case of the matrix. Status 1 if a mean side load differs from 0 by more than its
# confidence interval, or if energy or overlap of a run are out of bounds.
#     awk -f matrix.awk 0.5-0.4.report 0.5-0.4.means 0.5-0.4.stats ...
#
# Means over blocks of drift much longer than a floe are nearly independent, so the error of their mean is
# t s / sqrt(n), t of Student's law: 95 % for the rows, 99.9 % for the test of all cases together.
FNR == 1 {
    what = FILENAME
    sub(/.*\//, "", what)
    if (what ~ /report$/) { cases++; name[cases] = substr(what, 1, length(what) - 7); delete column }
    kind = what ~ /report$/ ? "report" : what ~ /means$/ ? "means" : "stats"
    heading = 0
}
kind == "report" && /^energy residual/ { energy[cases] = $3 }
kind == "report" && /^largest overlap/ { overlap[cases] = $3 }
kind == "report" && /^floes in +[0-9]/ { came[cases] = $3 }
kind == "report" && /^floes in +[0-9]/ && /dropped/ { lost[cases] = 1 }
kind != "report" && !/^#/ {
    if (!heading) { heading = 1; for (k = 1; k <= NF; k++) column[$k] = k; next }
    key = cases " " $column["signal"]
    if (kind == "means") {
        mean[key] = $column["mean"]; n[key] = $column["rows"]
        half[key] = $column["std"] / sqrt($column["rows"])
    }
    if (kind == "stats") {
        if ($column["view"] == "raw") most[key] = $column["max"]
        else smooth[key] = $column["max"]
    }
}
# Quantile of Student's law by Hill's expansion of the normal one z, good to 1e-3 for n > 6.
function student(z, n) {
    return z + (z ^ 3 + z) / (4 * n) + (5 * z ^ 5 + 16 * z ^ 3 + 3 * z) / (96 * n ^ 2)
}
END {
    printf "%-14s %6s %22s %22s %10s %10s %8s %8s\n", "concentration", "floes", "mean fx", "mean fy", "largest",
        "< 2 Hz", "overlap", "energy"
    printf "%-14s %6s %22s %22s %10s %10s %8s %8s\n", "and speed", "came", "kN, 95 %", "kN, 95 %", "kN", "kN",
        "R", "residual"
    for (c = 1; c <= cases; c++) {
        x = c " fx"; y = c " fy"
        split(name[c], part, "-")
        t = student(1.96, n[y] - 1)
        printf "%-5s %4s m/s %7d %12.2f +- %-7.2f %12.2f +- %-7.2f %9.3g %10.3g %8s %8s\n", part[1], part[2],
            came[c], mean[x] / 1e3, t * half[x] / 1e3, mean[y] / 1e3, t * half[y] / 1e3, most[x] / 1e3,
            smooth[x] / 1e3, overlap[c], energy[c]
        off = mean[y] / half[y] / student(3.29, n[y] - 1)
        if (off > 1 || off < -1) { print "  FAIL: the mean side load is not 0"; failed++ }
        if (energy[c] > 0.01 || overlap[c] > 0.3) { print "  FAIL: energy or overlap"; failed++ }
        if (lost[c]) print "  note: the ice was held up to the bound where it comes in"
    }
    exit failed > 0
}
