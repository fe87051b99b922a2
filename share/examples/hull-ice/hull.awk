# SPDX-License-Identifier: GPL-3.0-or-later
# A hull with a wedge bow, as Lindqvist (1989) has it, in OFF: the stem rises at phi from the horizontal, the waterline opens
# at al to the axis, sides and stern are vertical.  The stem meets the water at the origin; the stern is at x = L.
#   awk -v L=80 -v B=18 -v T=6.5 -v phi=25 -v al=30 -v F=3 -f hull.awk
function tan(x) { return sin(x)/cos(x) }
BEGIN {
    deg = atan2(0, -1)/180; bow = B/2/tan(al*deg)
    print "OFF\n10 16 0"
    for (k = 0; k < 2; k++) {
        z = k ? F : -T; x = -z/tan(phi*deg)
        printf "%.9g %.9g %.9g\n%.9g %.9g %.9g\n%.9g 0 %.9g\n%.9g %.9g %.9g\n%.9g %.9g %.9g\n", L, B/2, z, x + bow, B/2, z, x, z, \
            x + bow, -B/2, z, L, -B/2, z
    }
    print "3 0 1 6\n3 0 6 5\n3 1 2 7\n3 1 7 6\n3 2 3 8\n3 2 8 7\n3 3 4 9\n3 3 9 8\n3 4 0 5\n3 4 5 9"
    print "3 0 2 1\n3 0 3 2\n3 0 4 3\n3 5 6 7\n3 5 7 8\n3 5 8 9"
}
