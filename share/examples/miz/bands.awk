# SPDX-License-Identifier: GPL-3.0-or-later
# Bands of 200 m from the edge of the ice: significant height of the waves by the law of the decay, four standard
# deviations of the heave of the floes, rms of their tilt, and collisions of a floe in a minute.
# usage: awk -v decay=1 -f bands.awk STATE CONTACTS
function spectrum(f, x, s, q) # JONSWAP of 1 m and 6 s, DNV-RP-C205
{
    x = f * Tp
    s = x <= 1 ? 0.07 : 0.09
    q = exp(-(x - 1) * (x - 1) / (2 * s * s))
    return 0.3125 * Hs * Hs * Tp / x ^ 5 * exp(-1.25 / x ^ 4) * exp(q * log(3.3)) * (1 - 0.287 * log(3.3))
}
function height(x, f, m, df)
{
    df = 0.0005
    for (f = 0.3 / Tp; f < 4 / Tp; f += df) m += spectrum(f) * df * exp(-2 * decay * 2.9 * 0.8 ^ 1.25 * f ^ 4.5 * x)
    return 4 * sqrt(m)
}
BEGIN { Hs = 1; Tp = 6; WIDTH = 200; START = 15 }
FNR == 1 { files++ }
/^#/ { next }
/^t/ { for (k = 1; k <= NF; k++) { name = $k; sub(/\[.*/, "", name); at[files, name] = k } next }
files == 1 {
    if ($1 == 0) {
        band[$at[1, "body"]] = b = int($at[1, "x"] / WIDTH + 1000) - 1000
        floes[b]++
        if (b > last) last = b
        if (b < first) first = b
    }
    if ($1 > end) end = $1
    if ($1 < START) next
    b = band[$at[1, "body"]]
    z = $at[1, "z"]
    n[b]++
    zz[b] += z * z
    sum[b] += z
    qx = $at[1, "qx"]; qy = $at[1, "qy"]
    tilt[b] += 4 * (qx * qx + qy * qy)
    next
}
$1 >= START {
    pair = $at[2, "i"] " " $at[2, "j"]
    if (!(pair in seen) || $1 - seen[pair] > 0.3) hits[band[$at[2, "i"]]]++
    seen[pair] = $1
}
END {
    OFS = "\t"
    print "x[m]", "floes", "Hs[m]", "heave[m]", "tilt[deg]", "collisions[1/min]"
    for (b = first; b <= last; b++) {
        if (!n[b]) continue
        x = (b + 0.5) * WIDTH
        m = sum[b] / n[b]
        printf "%g\t%d\t%.3f\t%.3f\t%.2f\t%.2f\n", x, floes[b], height(x > 0 ? x : 0), 4 * sqrt(zz[b] / n[b] - m * m),
            sqrt(tilt[b] / n[b]) * 57.29578, 2 * hits[b] / floes[b] / ((end - START) / 60)
    }
}
