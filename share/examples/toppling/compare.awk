# SPDX-License-Identifier: GPL-3.0-or-later
# The program beside Goodman and Bray; with -v check=1 the bounds.
function tan(x) { return sin(x) / cos(x) }
function say(ok, what) { printf "%s: %s\n", what, ok ? "ok" : "FAILED"; bad = bad || !ok }
BEGIN { pi = atan2(0, -1) }
FILENAME ~ /goodman/ && $1 == "angle" { angle = $2 }
FILENAME ~ /goodman/ && $1 == "P" { P[$2] = $3; mode[$2] = $4 }
FILENAME ~ /factor/ && $1 == "#factor" && NF == 4 { lo = atan2(1, $4) * 180 / pi; hi = atan2(1, $3) * 180 / pi }
FILENAME ~ /held/ && /^[0-9]/ && $NF == "side" { i = $2 < $3 ? $2 : $3; got[i] = -$6 / 1000 }
END {
    printf "friction angle at which the toe just holds: %.2f to %.2f degrees, Goodman and Bray %.3f\n", hi, lo, angle
    for (i = 1; P[i] != ""; i++) {
        printf "  block %d on %d: %6.1f kN/m, Goodman and Bray %6.1f\n", i + 1, i, got[i], P[i]
        off = (got[i] - P[i]) / (P[i] > 0 ? P[i] : 1e9)
        if (off < 0) off = -off
        if (off > worst) worst = off
        if (i >= 6 && off > worst_above) worst_above = off
    }
    if (!check) exit
    mid = (lo + hi) / 2
    say(mid > angle - 0.5 && mid < angle + 0.5, "angle within 0.5 degrees")
    say(got[1] > 0.95 * P[1] && got[1] < 1.05 * P[1], "force on the toe within 5 %")
    say(worst_above < 0.01, "forces from the crest upwards within 1 %")
    say(worst < 0.12, "all forces within 12 %")
    exit bad
}
