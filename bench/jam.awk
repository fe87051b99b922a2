# SPDX-License-Identifier: GPL-3.0-or-later
# jam.awk -- means +- standard errors of jam.tsv of the first and of the second run of each pair, and of the difference
# within a pair.  t is the difference over its standard error; deviations are those of single runs.  D is the largest
# difference of the two distributions of single runs, p how often equal ones differ by that much (Kolmogorov, Smirnov).
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
# Two samples of n: D, and p by Kolmogorov's series with the correction of Stephens.
function compare(k,    i, j, v, d, l, sign) {
    D = 0
    for (i = 1; i <= n; i++)
        for (j = 0; j < 2; j++) {
            v = x[pair[i], j, k]
            d = share_up_to(k, 0, v) - share_up_to(k, 1, v)
            D = d > D ? d : -d > D ? -d : D
        }
    l = (sqrt(n / 2) + 0.12 + 0.11 / sqrt(n / 2)) * D
    p_equal = 0
    for (i = 1; i <= 100; i++) { sign = i % 2 ? 1 : -1; p_equal += 2 * sign * exp(-2 * i * i * l * l) }
    p_equal = l < 0.2 || p_equal > 1 ? 1 : p_equal
}
function share_up_to(k, which, v,    i, m) {
    for (i = 1; i <= n; i++) m += x[pair[i], which, k] <= v
    return m / n
}
function cell(k, which) { sums(k, which); return sprintf("%.2f +- %.2f", mean, error) }
END {
    if (!n || runs != 2 * n) { print "jam.awk: two runs a pair are expected" >"/dev/stderr"; exit 3 }
    printf "%d pairs of %s s\n%-16s %18s %18s %18s %8s %18s %12s\n", n, seconds, "", way[0], way[1],
        "difference", "t", "deviations", "D, p"
    for (k = col["impulse[kN.s]"]; k <= col["damping[kJ]"]; k++) {
        without = cell(k, 0); of = sprintf("%.2f", deviation)
        with = cell(k, 1); of = of sprintf(", %.2f", deviation)
        between = cell(k, 2)
        t = error > 0 ? sprintf("%.1f", mean / error) : "-"
        compare(k)
        printf "%-16s %18s %18s %18s %8s %18s %12s\n", name[k], without, with, between, t, of,
            sprintf("%.2f, %.2f", D, p_equal)
    }
    printf "%-16s %18.3g %18.3g %18s\n", "cost[s/s]", cost[0] / n, cost[1] / n,
        sprintf("ratio %.2f", cost[1] / cost[0])
    printf "%-16s %.1e of the throughput\n", "energy, worst", worst
}
