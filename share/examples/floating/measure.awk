# SPDX-License-Identifier: GPL-3.0-or-later
# measure.awk -- a number from a state table: awk -v what=period -v column=5 -v about=0.1 -f measure.awk state.dat
#   period     mean time between upward crossings of the level `about` by a column [s]
#   last       its last value;  mean  its mean
#   heel       about x, for a start at the given degrees, the smaller of the two angles of a square [deg]: a mean with
#              weights that decrease towards both ends, from and until
#   amplitude  at the angular frequency omega, with a free oscillation at omega0: least squares of five functions
BEGIN { FS = "\t"; PI = atan2(0, -1) }
/^#/ || /^t/ { next }
{
    y = what == "heel" ? start + 2 * atan2($7, $6) * 180 / PI : $column - about
    n++; sum += y
    if (what == "heel" && $1 > from) { w = 1 - cos(2 * PI * ($1 - from) / (until - from)); weight += w; heel += w * y }
    if (what == "period" && n > 1 && before < 0 && y >= 0) {
        t = then + ($1 - then) * before / (before - y)
        if (!seen++) first = t
        last = t
    }
    if (what == "amplitude") {
        f[0] = 1; f[1] = cos(omega * $1); f[2] = sin(omega * $1)
        f[3] = cos(omega0 * $1); f[4] = sin(omega0 * $1); f[5] = y
        for (i = 0; i < 5; i++) for (j = 0; j < 6; j++) a[i, j] += f[i] * f[j]
    }
    before = y; then = $1
}
END {
    if (what == "period") printf "%.9g\n", (last - first) / (seen - 1)
    else if (what == "mean") printf "%.9g\n", sum / n
    else if (what == "amplitude") {
        for (i = 0; i < 5; i++)
            for (r = 0; r < 5; r++) {
                if (r == i) continue
                s = a[r, i] / a[i, i]
                for (j = i; j < 6; j++) a[r, j] -= s * a[i, j]
            }
        x = a[1, 5] / a[1, 1]; y = a[2, 5] / a[2, 2]
        printf "%.9g\n", sqrt(x * x + y * y)
    } else if (what == "heel") {
        y = heel / weight; if (y < 0) y = -y
        printf "%.9g\n", y < 90 - y ? y : 90 - y
    } else printf "%.9g\n", y
}
