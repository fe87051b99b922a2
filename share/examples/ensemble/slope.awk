# SPDX-License-Identifier: GPL-3.0-or-later
# slope.awk -- checks that the interval decreases as 1/sqrt(n).  Status 1 if it does not.
#
# The half-width by Student's law over his factor is s_n / sqrt(n), and s_n, the deviation between the first
# n runs, converges. A line through log(half-width / factor) against log(n), n >= 5, therefore has the slope -1/2, but
# for the scatter of s_n: its relative error is 1/sqrt(2 (n - 1)), 0.35 at n = 5, 0.1 at n = 50, for loads that are
# normal between runs, more for skew ones. The same scatter changes the slope; for the line from 5 to 50 the
# change is about twice (0.35 + 0.1) / log(50/5) = 0.4, the bound of the check. With few runs the line has no meaning.
BEGIN { FS = "\t"; FIRST = 5; ENOUGH = 20; BOUND = 0.4 }
/^#/ || $1 == "part" { next }
$4 < FIRST { next }
{ runs = $4; add($2 " mean", $8 / sqrt($4)); add($2 " maximum", $12 / sqrt($4)) }
function add(name, half,    x, y) {
    if (!(name in n)) order[++names] = name
    x = log($4); y = log(half)
    n[name]++; sx[name] += x; sy[name] += y; sxx[name] += x * x; sxy[name] += x * y
}
END {
    for (k = 1; k <= names; k++) {
        m = order[k]
        if (n[m] < 2) continue
        slope = (n[m] * sxy[m] - sx[m] * sy[m]) / (n[m] * sxx[m] - sx[m] ^ 2)
        ok = runs < ENOUGH || (slope + 0.5 < BOUND && slope + 0.5 > -BOUND)
        printf "interval of the %-12s ~ n^%.2f  for n from %d to %d, -0.5 is the law %s\n", m, slope, FIRST, runs,
            runs < ENOUGH ? "(too few runs to tell)" : ok ? "ok" : "FAIL"
        if (!ok) failed = 1
    }
    exit failed
}
