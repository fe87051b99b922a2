# SPDX-License-Identifier: GPL-3.0-or-later
# jam.awk -- means +- standard errors of jam.tsv of the first and of the second run of each pair, and of the difference
# within a pair.  t is the difference over its standard error; deviations are those of single runs.
BEGIN { FS = "\t" }
/^#seconds/ { split($0, word, " "); seconds = word[2] }
/^#/ { next }
!("pair" in col) { for (k = 1; k <= NF; k++) { col[$k] = k; name[k] = $k }; next }
{
    which = runs++ % 2
    if (!which) n++
    way[which] = ("law" in col ? $col["law"] " " : "") $col["tolerance"]
    for (k = col["impulse[kN.s]"]; k <= col["damping[kJ]"]; k++) x[$col["pair"], which, k] = $k
    if ($col["energy"] > worst) worst = $col["energy"]
    cost[which] += $col["cost[s/s]"]
    pair[n] = $col["pair"]
}
# Mean, deviation and standard error of the runs, or of the differences in pairs (which = 2).
function sums(k, which,    i, p, v, s, ss) {
    for (i = 1; i <= n; i++) {
        p = pair[i]
        v[i] = which < 2 ? x[p, which, k] : x[p, 1, k] - x[p, 0, k]
        s += v[i]
    }
    mean = s / n
    for (i = 1; i <= n; i++) ss += (v[i] - mean) ^ 2
    deviation = n > 1 ? sqrt(ss / (n - 1)) : 0
    error = deviation / sqrt(n)
}
function cell(k, which) { sums(k, which); return sprintf("%.2f +- %.2f", mean, error) }
END {
    if (!n || runs != 2 * n) { print "jam.awk: two runs a pair are expected" >"/dev/stderr"; exit 3 }
    printf "%d pairs of %s s\n%-16s %18s %18s %18s %8s %18s\n", n, seconds, "", way[0], way[1],
        "difference", "t", "deviations"
    for (k = col["impulse[kN.s]"]; k <= col["damping[kJ]"]; k++) {
        without = cell(k, 0); of = sprintf("%.2f", deviation)
        with = cell(k, 1); of = of sprintf(", %.2f", deviation)
        between = cell(k, 2)
        t = error > 0 ? sprintf("%.1f", mean / error) : "-"
        printf "%-16s %18s %18s %18s %8s %18s\n", name[k], without, with, between, t, of
    }
    printf "%-16s %18.3g %18.3g %18s\n", "cost[s/s]", cost[0] / n, cost[1] / n,
        sprintf("ratio %.2f", cost[1] / cost[0])
    printf "%-16s %.1e of the throughput\n", "energy, worst", worst
}
