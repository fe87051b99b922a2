# SPDX-License-Identifier: GPL-3.0-or-later
# jam.awk -- means +- standard errors of jam.tsv without and with surrogates, and of the difference within a pair.
# t is the difference over its standard error; deviations are those of single runs, without and with.
BEGIN { FS = "\t" }
/^#seconds/ { split($0, word, " "); seconds = word[2] }
/^#/ { next }
!("pair" in col) { for (k = 1; k <= NF; k++) { col[$k] = k; name[k] = $k }; next }
{
    with_surrogate = $col["tolerance"] > 0
    if (with_surrogate) tol = $col["tolerance"]
    else n++
    runs++
    for (k = col["impulse[kN.s]"]; k <= col["damping[kJ]"]; k++) x[$col["pair"], with_surrogate, k] = $k
    if ($col["energy"] > worst) worst = $col["energy"]
    cost[with_surrogate] += $col["cost[s/s]"]
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
    printf "%d pairs of %s s\n%-14s %18s %18s %18s %8s %18s\n", n, seconds, "", "tolerance 0", tol,
        "difference", "t", "deviations"
    for (k = col["impulse[kN.s]"]; k <= col["damping[kJ]"]; k++) {
        without = cell(k, 0); of = sprintf("%.2f", deviation)
        with = cell(k, 1); of = of sprintf(", %.2f", deviation)
        between = cell(k, 2)
        t = error > 0 ? sprintf("%.1f", mean / error) : "-"
        printf "%-14s %18s %18s %18s %8s %18s\n", name[k], without, with, between, t, of
    }
    printf "%-14s %18.3g %18.3g %18s\n", "cost[s/s]", cost[0] / n, cost[1] / n,
        sprintf("ratio %.2f", cost[1] / cost[0])
    printf "%-14s %.1e of the throughput\n", "energy, worst", worst
}
