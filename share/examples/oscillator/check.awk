# SPDX-License-Identifier: GPL-3.0-or-later
# check.awk -- checks the sway against the load.  Status 1 if a check fails.
# moving.tsv (loads), motion.tsv (the response to that load by loadstats), moving.txt (the report) in this order.
#   - The momentum: m v + c u + k int u dt is the impulse of the ice, at the end, along x and y.
#   - loadstats solves the oscillator by another method from the load table alone: the same displacement, but for the
#     averaging over 10 ms.
#   - The energy ledger closes.
BEGIN {
    FS = "\t"
    split(sway, s, ",")
    pi = 4 * atan2(1, 1)
    w = 2 * pi * s[1]; m = s[3] + 0; k = m * w * w; c = 2 * s[2] * m * w
}
FNR == 1 { file++ }
/^#/ { next }
file == 1 && $1 != "t[s]" {
    h = $1 - t
    for (i = 1; i <= 2; i++) {
        F[i] += $(2 + i) * h                               # the exact impulse
        x = $(10 + i); v = $(13 + i)
        S[i] += h * (x0[i] + x) / 2 - h * h * (v - v0[i]) / 12 # of fourth order
        size[i] += h * ($(2 + i) < 0 ? -$(2 + i) : $(2 + i))
        x0[i] = x; v0[i] = v
    }
    t = $1
    ux[$1] = $11
    rows++
}
file == 2 && $1 != "part" { d = $10 - ux[$7]; dd += d * d; uu += ux[$7] * ux[$7]; n++ }
file == 3 && /^energy residual/ { split($0, word, " "); residual = word[3] }
function check_row(what, off, bound) {
    printf "%-64s %.2g, at most %g  %s\n", what, off, bound, off <= bound ? "ok" : "FAIL"
    if (!(off <= bound)) failed = 1
}
END {
    name[1] = "x"; name[2] = "y"
    for (i = 1; i <= 2; i++) {
        off = m * v0[i] + c * x0[i] + k * S[i] - F[i]
        check_row("impulse of the ice along " name[i] " less momentum, over all of it", (off < 0 ? -off : off) / size[i], 1e-3)
    }
    check_row("sway along x less that of the load by loadstats, over it", n == rows ? sqrt(dd / uu) : 1, 0.01)
    check_row("residual of the ledger over the throughput", residual, 1e-3)
    exit failed
}
