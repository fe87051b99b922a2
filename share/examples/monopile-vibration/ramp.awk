# SPDX-License-Identifier: GPL-3.0-or-later
# ramp.awk -- displacement of ice whose speed rises from v0 to v1 in T seconds and falls back: a track(5).
BEGIN {
    print "#track 1\nt[s]\tx[m]"
    for (t = 0; t <= 2 * T; t += 5) {
        u = t < T ? t : 2 * T - t
        x = v0 * u + (v1 - v0) * u * u / (2 * T)
        printf "%g\t%.9g\n", t, t < T ? x : (v0 + v1) * T - x
    }
}
