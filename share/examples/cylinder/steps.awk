# SPDX-License-Identifier: GPL-3.0-or-later
# steps.awk -- the same field at other stiffness factors and steps: the table of README.md, one row for each case.
#     awk -v from=13 -v filter=2 -f steps.awk 0.025-0.5.report 0.025-0.5.stats 0.025-0.5.loads ...
#
# The impulse is that of the whole record, the sum of force times interval; mean and largest load are those of
# the table stats, from [s] on, the latter below filter [Hz]. The first hit is the largest load until 1.6 s.
FNR == 1 {
    stem = what = FILENAME
    sub(/.*\//, "", stem)
    sub(/\.[a-z]*$/, "", stem)
    sub(/.*\./, "", what)
    if (what == "report") name[++cases] = stem
    split("", column)
    before = 0
}
what == "report" {
    if (/^steps/) steps[cases] = $2
    if (/^largest overlap/) overlap[cases] = $3
    if (/^energy residual/) energy[cases] = $3
    next
}
/^#/ { next }
!("part" in column) { for (k = 1; k <= NF; k++) column[$k] = k; next }
$column["part"] != "leg" { next }
what == "stats" {
    if ($column["view"] == "raw") mean[cases] = $column["mean"]
    else largest[cases] = $column["max"]
}
what == "loads" {
    f = $column["fx[N]"]
    impulse[cases] += f * ($1 - before)
    if ($1 < 1.6 && f > hit[cases]) hit[cases] = f
    before = $1
}
function kilo(x, format) { return sprintf(format, x / 1000) }
END {
    if (!cases) { print "steps.awk: reports, stats and loads are expected" >"/dev/stderr"; exit 3 }
    row = "| %9s | %7s | %7s | %7s | %8s | %14s | %18s | %13s | %8s |\n"
    printf row, "s_k", "step", "steps", "overlap", "impulse", "mean from " from " s",
        "largest below " filter " Hz", "first hit", "residual"
    print "|--:|--:|--:|--:|--:|--:|--:|--:|--:|"
    for (c = 1; c <= cases; c++) {
        split(name[c], of, "-")
        sub(/e-0/, "e-", energy[c])
        printf row, of[1], of[2] " ms", kilo(steps[c], "%.0f 000"), sprintf("%.2f R", overlap[c]),
            kilo(impulse[c], "%.0f kN s"), kilo(mean[c], "%.1f kN"), kilo(largest[c], "%.0f kN"),
            kilo(hit[c], "%.0f kN"), energy[c]
    }
}
