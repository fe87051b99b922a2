# SPDX-License-Identifier: GPL-3.0-or-later
# The program beside Goodman and Bray; with -v check=1 the bounds.
function tan(x) { return sin(x) / cos(x) }
function say(ok, what) { printf "%s: %s\n", what, ok ? "ok" : "FAILED"; bad = bad || !ok }
BEGIN { pi = atan2(0, -1) }
FILENAME ~ /goodman/ && $1 == "angle" { angle = $2 }
FILENAME ~ /goodman/ && $1 == "P" { P[$2] = $3; mode[$2] = $4 }
FILENAME ~ /factor/ && $1 == "#factor" && NF == 4 { lo = atan2(1, $4) * 180 / pi; hi = atan2(1, $3) * 180 / pi }
/^[0-9]/ && $NF == "side" { i = $2 < $3 ? $2 : $3; got[FILENAME ~ /held/, i] = -$6 / 1000 }
function off(stiff, i) { return P[i] > 0 ? (got[stiff, i] > P[i] ? got[stiff, i] - P[i] : P[i] - got[stiff, i]) / P[i] : 0 }
END {
    printf "friction angle at which the toe just holds: %.2f to %.2f degrees, Goodman and Bray %.3f\n", lo, hi, angle
    for (i = 1; P[i] != ""; i++) {
        printf "  block %d on %d: %6.1f kN/m, Goodman and Bray %6.1f, with a stiff toe %6.1f\n", i + 1, i, got[0, i], P[i], got[1, i]
        if (off(0, i) > worst) worst = off(0, i)
        if (off(1, i) > worst_stiff) worst_stiff = off(1, i)
    }
    printf "forces within %.2f %%, with a stiff toe within %.1f %%\n", 100 * worst, 100 * worst_stiff
    if (!check) exit
    mid = (lo + hi) / 2
    say(mid > angle - 0.5 && mid < angle + 0.5, "angle within 0.5 degrees")
    say(worst < 0.01, "forces within 1 %")
    say(off(1, 1) < 0.05, "force on a stiff toe within 5 %")
    say(worst_stiff < 0.12, "forces with a stiff toe within 12 %")
    exit bad
}
