# SPDX-License-Identifier: GPL-3.0-or-later
# check.awk -- checks the runs in ice against balances and symmetry. Status 1 if a check fails.
#     awk -f check.awk fixed.txt towed.txt free.txt fixed.tsv towed.tsv free.tsv        (reports, then loads)
#
# Fixed in a drift and towed through ice at rest are one case in two frames (Galileo): the loads agree but for
# rounding, which collisions amplify, so they are compared up to SAME.
# The free hull: the impulses of ice, moorings and dashpots equal its momentum,
#     sum F dt - int (k u + c v) dt = m v        along x and y, from rest.
BEGIN {
    SAME = 3
    m = 1025 * 4 / 9 * 30 * 5 * 2; k = 20e3; c["x"] = 5e3; c["y"] = 20e3 # as in free.scene
}
FNR == 1 { file++ }
file <= 3 && /^energy residual/ { energy[file] = $3 }
file <= 3 && /^momentum residual/ { momentum[file] = $3 }
file <= 3 && /^largest overlap/ { overlap[file] = $3 }
/^#/ || NF == 0 { next }
$1 == "t[s]" { for (f = 1; f <= NF; f++) column[file, $f] = f; before = 0; next }
function of(name) { return $column[file, name] }
file == 4 { fx[$1] = of("fx[N]"); fy[$1] = of("fy[N]"); if ($1 <= SAME && fx[$1] != 0) early++ }
file == 5 && $1 <= SAME {
    d = sqrt((of("fx[N]") - fx[$1]) ^ 2 + (of("fy[N]") - fy[$1]) ^ 2)
    f = sqrt(fx[$1] ^ 2 + fy[$1] ^ 2)
    if (d > apart) apart = d
    if (f > most) most = f
}
file == 4 || file == 5 { impulse[file] += of("fx[N]") * ($1 - before); before = $1 }
file == 6 {
    h = $1 - before; before = $1
    ix += of("fx[N]") * h; iy += of("fy[N]") * h
    sx -= h * (k * (of("ux[m]") + ux) + c["x"] * (of("vx[m/s]") + vx)) / 2
    sy -= h * (k * (of("uy[m]") + uy) + c["y"] * (of("vy[m/s]") + vy)) / 2
    ux = of("ux[m]"); uy = of("uy[m]"); vx = of("vx[m/s]"); vy = of("vy[m/s]")
    throughput += sqrt(of("fx[N]") ^ 2 + of("fy[N]") ^ 2) * h
}
function row(what, value, expected, ok) {
    printf "%-50s %10s   %-20s %s\n", what, value, expected, ok ? "ok" : "FAIL"
    if (!ok) failed = 1
}
function worst(a,    i, w) { for (i = 1; i <= 3; i++) if (a[i] + 0 > w) w = a[i] + 0; return w }
END {
    if (file != 6 || !early || !throughput || energy[3] == "") {
        print "check.awk: three reports and three tables of loads are expected, with hits in the first " SAME " s" \
            >"/dev/stderr"
        exit 3
    }
    print "in the ice                                              found   expected"
    row("fixed and towed: largest difference over load", sprintf("%.1e", apart / most), "< 1e-6, first " SAME " s",
        apart < 1e-6 * most)
    row("the ice pushes astern: impulse, fixed [kN s]", sprintf("%.4g", impulse[4] / 1e3), "< 0", impulse[4] < 0)
    row("  and towed [kN s]", sprintf("%.4g", impulse[5] / 1e3), "< 0", impulse[5] < 0)
    off = sqrt((ix + sx - m * vx) ^ 2 + (iy + sy - m * vy) ^ 2) / throughput
    row("free: impulses less momentum, over the ice's", sprintf("%.1e", off), "< 1e-3", off < 1e-3)
    row("energy residual over throughput, worst", worst(energy), "< 1e-4", worst(energy) < 1e-4)
    row("momentum residual over contact impulses, worst", worst(momentum), "< 1e-12", worst(momentum) < 1e-12)
    row("largest overlap over radius, worst", worst(overlap), "< 0.5", worst(overlap) < 0.5)
    exit failed
}
