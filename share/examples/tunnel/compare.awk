# SPDX-License-Identifier: GPL-3.0-or-later
# The program beside closed forms: a prism of half angle 30 degrees and base 4 m, W = 169.914 kN/m.
function say(ok, what) { printf "%s: %s\n", what, ok ? "ok" : "FAILED"; bad = bad || !ok }
FNR == 1 { file++ }
file == 1 && $1 == "poly" && /group=key/ { key = $2 }
file == 2 && $1 == "#factor" && NF == 4 { lo = $3; hi = $4 }
file == 3 && $NF == "steel" { n = $2 < $3 ? $2 " " $3 : $3 " " $2; N[n] = $6; S[n] = $7; z[n] = $12 }
file == 4 && $2 == key { at[sprintf("%.1f", $1)] = $5 }
END {
    W = 2500 * 9.81 * 0.5 * 4 * 3.464101615 / 1000
    # the two lower cuts of the bolt carry it: their normals have 60 degrees to the vertical
    for (k in N) if (low == "" || z[k] < low) low = z[k]
    for (k in N) if (z[k] < low + 1e-6) hang += (0.5 * N[k] + 0.8660254038 * S[k]) / 1000
    drop = at["0.0"] - at["0.5"]
    printf "factor under 168.5 kPa: %.4f to %.4f, closed form 1\n", lo, hi
    printf "bolt: %.2f kN, weight %.2f kN\n", hang, W
    printf "falls in 0.5 s: %.4f m, closed form %.4f m\n", drop, 9.81 * 0.125
    if (!check) exit
    say(lo > 0.985 && hi < 1.015, "factor within 1.5 %")
    say(hang > 0.99 * W && hang < 1.01 * W, "the bolt carries the weight within 1 %")
    say(drop > 0.99 * 1.22625 && drop < 1.01 * 1.22625, "falls with g within 1 %")
    exit bad
}
