# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f measure.awk BODIES STATE: what the discs did since the first row of the state.
# Prints a row: seconds, discs, those that left, largest speed in the first 0.3 s and at the end [m/s], part that rose by
# more than 0.1 d and that moved by more than 2 d [%], largest rise over d, height of the crest and of the toe lost [m].
FNR == 1 { file++ }
file == 1 && $1 == "poly" { r[$2] = $3 }
file == 2 && $1 ~ /^[0-9]/ {
    if (start == "") start = $1
    last = $1
    v = sqrt($10 * $10 + $11 * $11)
    if (!($2 in x0)) { x0[$2] = $3; y0[$2] = $4; n++ }
    x[$2] = $3; y[$2] = $4; speed[$2] = v; seen[$2] = $1
    if ($1 - start <= 0.3 && v > early) early = v
    rise = ($4 - y0[$2]) / (2 * r[$2])
    if (rise > risen[$2]) risen[$2] = rise
}
END {
    for (b in x0) {
        left += seen[b] < last || x[b] < 0 || x[b] > 60
        if (speed[b] > late) late = speed[b]
        rose += risen[b] > 0.1
        if (risen[b] > most) most = risen[b]
        moved += (x[b] - x0[b]) ^ 2 + (y[b] - y0[b]) ^ 2 > 16 * r[b] * r[b]
        if (x0[b] > 46 && y0[b] + r[b] > c0) c0 = y0[b] + r[b]
        if (x0[b] > 46 && y[b] + r[b] > c1) c1 = y[b] + r[b]
        if (x0[b] < 3.8 && y0[b] + r[b] > t0) t0 = y0[b] + r[b]
        if (x0[b] < 3.8 && y[b] + r[b] > t1) t1 = y[b] + r[b]
    }
    printf "%.3g\t%d\t%d\t%.3g\t%.3g\t%.3g\t%.3g\t%.3g\t%.3g\t%.3g\n", last - start, n, left, early, late, 100 * rose / n, 100 * moved / n, most, c0 - c1, t0 - t1
}
