# SPDX-License-Identifier: GPL-3.0-or-later
# pack.awk -- number, porosity, distance of the grading by mass from a uniform one, and the largest overlap over the smaller
# radius, of spheres "radius x y z" in a box of variable `side`; sizes lo to hi times the mean scale.
NF == 4 && $1 + 0 > 0 { n++; r[n] = $1; x[n] = $2; y[n] = $3; z[n] = $4; if ($1 > most) most = $1; v += $1 ^ 3 }
function wall(d, R) { if (R - d > deep * R) deep = (R - d) / R; if (side - d < R && R - side + d > deep * R) deep = (R - side + d) / R }
function cell(a) { return int(a / (2 * most)) }
END {
    for (i = 1; i <= n; i++) {
        wall(x[i], r[i]); wall(y[i], r[i]); wall(z[i], r[i])
        k = cell(x[i]) " " cell(y[i]) " " cell(z[i])
        next_of[i] = head[k]; head[k] = i
    }
    for (i = 1; i <= n; i++)
        for (a = -1; a <= 1; a++) for (b = -1; b <= 1; b++) for (c = -1; c <= 1; c++)
            for (j = head[cell(x[i]) + a " " cell(y[i]) + b " " cell(z[i]) + c]; j > i; j = next_of[j]) {
                R = r[i] + r[j]; d2 = (x[i] - x[j]) ^ 2 + (y[i] - y[j]) ^ 2 + (z[i] - z[j]) ^ 2
                if (d2 < R * R) { o = (R - sqrt(d2)) / (r[i] < r[j] ? r[i] : r[j]); if (o > deep) deep = o }
            }
    # the curve by mass at sixty sizes
    for (k = 0; k <= 60; k++) {
        d = lo + (hi - lo) * k / 60; below = 0
        for (i = 1; i <= n; i++) if (2 * r[i] <= d * (1 + 1e-9)) below += r[i] ^ 3
        gap = below / v - k / 60; if (gap < 0) gap = -gap; if (gap > off) off = gap
    }
    printf "%d %.5f %.3f %.2g\n", n, 1 - 4.18879020478639 * v / side ^ 3, off, deep
}
