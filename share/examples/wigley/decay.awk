# SPDX-License-Identifier: GPL-3.0-or-later
# decay.awk -- periods and decrements of a free hull against closed forms. Status 1 if one is missed.
#     awk -v L=30 -v B=5 -v T=2 -v KG=1.8 -f decay.awk decay-12.tsv decay-24.tsv decay-48.tsv   (finer and finer)
#
# m = rho V,  V = 4/9 L B T,  w = rho g; C33 = w A, C44 = w V GM, C55 = w V GML with GM = KB + BM - KG;
#     period 2 pi sqrt(M/C) / sqrt(1 - D^2),   decrement 2 pi D / sqrt(1 - D^2),   D = c / (2 sqrt(M C))
# Between two crossings of zero lies half a period. The largest displacement between them decreases by the decrement in a period.
FNR == 1 { if (runs) close_run(); runs++; for (q = 1; q <= 3; q++) crossed[q] = swings[q] = 0 }
/^#/ { next }
$1 == "t[s]" { for (c = 1; c <= NF; c++) column[$c] = c; next }
$1 > 1 { # the ball is over the side
    follow(1, $column["uz[m]"])
    follow(2, $column["rx[deg]"])
    follow(3, $column["ry[deg]"])
}
function follow(q, y,    at) {
    if (t[q] && (y < 0) != (last[q] < 0)) {
        at = t[q] + ($1 - t[q]) * last[q] / (last[q] - y)
        if (crossed[q]++) peak[q, swings[q]++] = top[q]
        else first_at[q] = at
        last_at[q] = at
        top[q] = 0
    }
    if (y > top[q]) top[q] = y
    if (-y > top[q]) top[q] = -y
    last[q] = y
    t[q] = $1
}
function close_run(    q) {
    for (q = 1; q <= 3; q++) {
        period[q, runs] = crossed[q] > 2 ? 2 * (last_at[q] - first_at[q]) / (crossed[q] - 1) : 0
        decrement[q, runs] = swings[q] > 1 ? 2 * log(peak[q, 0] / peak[q, swings[q] - 1]) / (swings[q] - 1) : 0
        t[q] = top[q] = 0
    }
}
function row(what, q, M, C, c,    D, exact, r, off, before, ok, known) {
    D = c / (2 * sqrt(M * C))
    exact = 2 * PI * sqrt(M / C) / sqrt(1 - D * D)
    printf "%-34s %10.5g ", what " period [s]", exact
    for (r = 1; r <= runs; r++) {
        before = off
        off = period[q, r] / exact - 1
        printf " %9.1e", off
    }
    ok = off * off < 3e-3 ^ 2 && (runs < 2 || off * off < before * before)
    if (runs > 1) printf "  %5.2f", log(before / off) / log(2)
    else printf "       "
    print "  " (ok ? "ok" : "FAIL")
    if (!ok) failed = 1
    known = 2 * PI * D / sqrt(1 - D * D)
    printf "%-34s %10.5g ", "  its decrement", known
    for (r = 1; r <= runs; r++) {
        off = decrement[q, r] / known - 1
        printf " %9.1e", off
    }
    ok = off * off < 1e-2 ^ 2
    print "         " (ok ? "ok" : "FAIL")
    if (!ok) failed = 1
}
END {
    if (!runs) { print "decay.awk: the loads of a free hull are expected" >"/dev/stderr"; exit 3 }
    close_run()
    PI = atan2(0, -1)
    V = 4 / 9 * L * B * T; m = 1025 * V; w = 1025 * 9.81
    KB = 5 / 8 * T
    printf "%-46s", "free oscillations, and by how much"
    for (r = 1; r <= runs; r++) printf " %9s", "mesh " r
    print "  order"
    row("heave", 1, m, w * 2 / 3 * L * B, 20e3)
    row("roll", 2, m * (0.35 * B) ^ 2, w * V * (KB + 3 / 35 * B * B / T - KG), 30e3)
    row("pitch", 3, m * (L / 4) ^ 2, w * V * (KB + 3 / 40 * L * L / T - KG), 1000e3)
    exit failed
}
