# SPDX-License-Identifier: GPL-3.0-or-later
# row.awk -- the figures of one run from REPORT LOADS REFERENCE-LOADS STATE REFERENCE-STATE:
#   bodies dt steps contacts  cost wall body_step contact_step  impulse peak motion energy overlap hash
# separated by tabs, - where there is none.  -v bodies=N status=S: the exit status of the run.
function abs(x) { return x < 0 ? -x : x }
function over(a, b) { return b > 0 ? sprintf("%.3g", a / b) : "-" }
FNR == 1 { file++; split("", col); t0 = 0 }
file == 1 {
    if (/^steps/) { steps = $2; dt = $4 }
    if (/simulated in/) { T = $2; wall += $6 }
    if (/steps in trials/) wall += $(NF - 1)
    if (/ns per body-step/) { for (k = 1; k < NF; k++) if (index($k, "(") == 1) contacts = substr($k, 2) }
    if (/^processor/) cpu = $2
    if (/^energy residual/) energy = $3
    if (/^largest overlap/) overlap = $3
    if (/^state hash/) hash = $3
    next
}
/^#/ { next }
!("t[s]" in col) { for (k = 1; k <= NF; k++) col[$k] = k; next }
file == 2 || file == 3 {
    p = $col["part"]
    if ($1 != now[file, p]) { h = $1 - now[file, p]; now[file, p] = $1 }
    for (k = 1; k <= 3; k++) J[file, p, k] += h * $(col["fx[N]"] + k - 1)
    if ($col["fpeak[N]"] > peak[file, p]) peak[file, p] = $col["fpeak[N]"]
    if (file == 3) parts[p] = 1
    next
}
file > 3 { # states at the start and at the end
    b = $col["body"]
    for (k = 0; k < 3; k++) {
        x = $(col["x[m]"] + k); v = $(col["vx[m/s]"] + k)
        if ($1 == 0) { x0[b, k] = x; v0[b, k] = v; continue }
        if (file == 4) end[b, k] = x
        else { off += (x - end[b, k])^2; way += (x - x0[b, k] - v0[b, k] * $1)^2 }
    }
}
END {
    if (status || !steps) { printf "%s%s\n", bodies, "\t-\t-\t-\t-\t-\t-\t-\t-\t-\t-\t-\t-\t-"; exit }
    for (p in parts) {
        d = r = 0
        for (k = 1; k <= 3; k++) { d += (J[2, p, k] - J[3, p, k])^2; r += J[3, p, k]^2 }
        dJ += sqrt(d); rJ += sqrt(r)
        d = abs(peak[2, p] - peak[3, p])
        if (d > dP) dP = d
        if (peak[3, p] > rP) rP = peak[3, p]
    }
    printf "%s\t%s\t%s\t%s\t%.4g\t%.4g", bodies, dt, steps, contacts == "" ? 0 : contacts, cpu / T, wall / T
    printf "\t%.4g\t%s\t%s\t%s\t%s\t%s\t%s\t%s\n",
        1e9 * cpu / steps / bodies, (contacts > 0) ? sprintf("%.4g", 1e9 * cpu / steps / contacts) : "-",
        over(dJ, rJ), over(dP, rP), over(sqrt(off), sqrt(way)), energy, overlap, hash
}
