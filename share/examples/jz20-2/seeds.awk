# SPDX-License-Identifier: GPL-3.0-or-later
# Mean, standard deviation, least and largest over seeds of each line of their tables.
{
    name = substr($0, 1, 38); x = substr($0, 39) + 0; unit = $NF ~ /^[a-z]/i ? $NF : ""
    if (!(name in n)) { order[++lines] = name; lo[name] = hi[name] = x }
    n[name]++; sum[name] += x; sum2[name] += x*x
    if (x < lo[name]) lo[name] = x
    if (x > hi[name]) hi[name] = x
}
END {
    printf "%-38s %9s %9s %9s %9s\n", "", "mean", "deviation", "least", "largest"
    for (k = 1; k <= lines; k++) {
        a = order[k]; m = sum[a]/n[a]; v = n[a] > 1 ? (sum2[a] - n[a]*m*m)/(n[a] - 1) : 0
        printf "%-38s %9.2f %9.2f %9.2f %9.2f\n", a, m, (v > 0 ? sqrt(v) : 0), lo[a], hi[a]
    }
}
