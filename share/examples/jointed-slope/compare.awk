# SPDX-License-Identifier: GPL-3.0-or-later
# The program beside limit equilibrium: a mass on one plane, F = tan 40/tan 35, whatever its blocks are.
function tan(x) { return sin(x) / cos(x) }
function say(ok, what) { printf "%s: %s\n", what, ok ? "ok" : "FAILED"; bad = bad || !ok }
FNR == 1 { file++ }
$1 == "#factor" && NF == 4 { lo[file] = $3; hi[file] = $4 }
END {
    pi = atan2(0, -1)
    F = tan(40 * pi / 180) / tan(35 * pi / 180)
    printf "plane failure: factor %.4f\n", F
    printf "rigid blocks: %.4f to %.4f\n", lo[1], hi[1]
    printf "slender rigid blocks, which topple: %.4f to %.4f\n", lo[2], hi[2]
    printf "blocks that deform: %.4f to %.4f\n", lo[3], hi[3]
    if (!check) exit
    say(lo[1] > 0.995 * F && hi[1] < 1.005 * F, "rigid within 0.5 %")
    say(hi[2] < 0.95 * F, "slender blocks fail earlier")
    say(lo[3] > 0.98 * F && hi[3] < 1.02 * F, "deformable within 2 %")
    exit bad
}
