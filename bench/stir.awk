# SPDX-License-Identifier: GPL-3.0-or-later
# stir.awk -- adds the velocity of eddies of 6 m and 1 m/s to the floes of a field, so that they collide early.
/^poly/ { fresh = 1 }
/^v / && fresh { x = $2; y = $3; fresh = 0 }
/^vel/ {
    k = atan2(0, -1) / 6
    printf "vel %.17g %.17g 0 0 0 0\n", $2 + sin(k * x) * cos(k * y), $3 - cos(k * x) * sin(k * y)
    next
}
{ print }
