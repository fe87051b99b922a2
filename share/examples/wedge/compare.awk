# SPDX-License-Identifier: GPL-3.0-or-later
# The program beside the closed form of a wedge without cohesion: l = nA x nB, W = T l + NA nA + NB nB,
# F = (NA tan phiA + NB tan phiB)/T.  Wyllie & Mah, Rock Slope Engineering (2004), ch. 7.
function tan(x) { return sin(x) / cos(x) }
function say(ok, what) { printf "%s: %s\n", what, ok ? "ok" : "FAILED"; bad = bad || !ok }
function rad(a) { return a * atan2(0, -1) / 180 }
function normal(p, dip, dd) { p[1] = sin(rad(dip)) * sin(rad(dd)); p[2] = sin(rad(dip)) * cos(rad(dd)); p[3] = cos(rad(dip)) }
FNR == 1 { file++ }
$1 == "#factor" && NF == 4 { lo[file] = $3; hi[file] = $4 }
file == 3 && $2 == 1 { v[sprintf("%.2f", $1)] = sqrt($10 ^ 2 + $11 ^ 2 + $12 ^ 2) }
END {
    normal(A, 45, 105); normal(B, 70, 235)
    l[1] = A[2] * B[3] - A[3] * B[2]; l[2] = A[3] * B[1] - A[1] * B[3]; l[3] = A[1] * B[2] - A[2] * B[1]
    s = sqrt(l[1] ^ 2 + l[2] ^ 2 + l[3] ^ 2); if (l[3] > 0) s = -s
    for (k = 1; k <= 3; k++) l[k] /= s
    T = -l[3] # of the weight
    # the rest of the upward reaction: NA nA + NB nB = (0, 0, 1) + T l
    for (k = 1; k <= 3; k++) r[k] = (k == 3) + T * l[k]
    ab = A[1] * B[1] + A[2] * B[2] + A[3] * B[3]
    ra = r[1] * A[1] + r[2] * A[2] + r[3] * A[3]; rb = r[1] * B[1] + r[2] * B[2] + r[3] * B[3]
    NA = (ra - ab * rb) / (1 - ab ^ 2); NB = (rb - ab * ra) / (1 - ab ^ 2)
    want[1] = (NA + NB) * tan(rad(30)) / T
    want[2] = (NA * tan(rad(20)) + NB * tan(rad(30))) / T
    a = T - (NA + NB) * tan(rad(20))
    got = (v["0.60"] - v["0.30"]) / 0.3 / 9.81
    printf "NA/W %.6f, NB/W %.6f, T/W %.6f\n", NA, NB, T
    printf "factor at 30 degrees: %.4f to %.4f, closed form %.5f\n", lo[1], hi[1], want[1]
    printf "factor at 20 and 30: %.4f to %.4f, closed form %.5f\n", lo[2], hi[2], want[2]
    printf "acceleration at 20 degrees: %.5f g, closed form %.6f\n", got, a
    if (!check) exit
    for (k = 1; k <= 2; k++) say(lo[k] * 0.998 < want[k] && want[k] < hi[k] * 1.002, "factor " k " in its interval")
    say(got > 0.97 * a && got < 1.03 * a, "acceleration within 3 %")
    exit bad
}
