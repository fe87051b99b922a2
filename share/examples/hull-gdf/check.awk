# SPDX-License-Identifier: GPL-3.0-or-later
# The volume of the hull with its deck against its closed form, and the sign of the resistance.
FILENAME ~ /import/ && $1 == "hull" && !volume { volume = $4 }
FILENAME ~ /loads/ && !/^#/ && !/^t\[/ { sum += $3; n++ }
END {
    L = 40; B = 10; T = 2.5; H = 2
    is = B * (L * T - T * T) + L * B * H
    printf "volume %.6g m3, %.6g in closed form; mean resistance %.2f kN\n", volume, is, -sum / n / 1e3
    off = volume - is
    if (off * off > 1e-12 * is * is || !(sum < 0)) { print "FAIL"; exit 1 }
    print "ok"
}
