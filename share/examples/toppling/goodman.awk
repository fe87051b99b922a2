# SPDX-License-Identifier: GPL-3.0-or-later
# Limit equilibrium of toppling blocks: Goodman and Bray, ASCE Rock Eng. for Foundations and Slopes 2 (1976) 201.
# Finds the friction angle at which the toe just holds, and the forces P(i) on block i from block i + 1 there [kN/m].
function tan(x) { return sin(x) / cos(x) }
function toe(phi,    i, y, M, L, W, top, slide, f)
{
    f = tan(phi); P[n] = 0
    for (i = n; i >= 1; i--) {
        y = h[i]
        M = i < crest ? y : y - a2
        L = i <= crest ? y - a1 : y
        W = gamma * y * dx
        slide = P[i] + W * (sin(al) - f * cos(al)) / (1 - f * f)
        top = L > 0 ? (P[i] * (M - dx * f) + W / 2 * (y * sin(al) - dx * cos(al))) / L : -1
        P[i - 1] = top > slide ? top : slide
        mode[i] = top > slide ? "topples" : "slides"
        if (P[i - 1] < 0) { P[i - 1] = 0; mode[i] = "stable" }
    }
    return P[0]
}
BEGIN {
    pi = atan2(0, -1); al = alpha * pi / 180
    for (i = 1; i <= n; i++) h[i] = i <= crest ? i * (a1 - b) : h[i - 1] - (a2 + b)
    lo = al + 0.01; hi = 44.9 * pi / 180
    for (k = 0; k < 60; k++) { mid = (lo + hi) / 2; if (toe(mid) > 0) lo = mid; else hi = mid }
    printf "angle\t%.4f\n", hi * 180 / pi
    toe(hi)
    for (i = 1; i < n; i++) printf "P\t%d\t%.1f\t%s\n", i, P[i], mode[i]
}
