# SPDX-License-Identifier: GPL-3.0-or-later
# box.awk -- one box of ice as g-polys(5): awk -v l=10 -v b=10 -v h=1 -v z=0.1 -v heel=5 -f box.awk
# Outer length, breadth and height [m], height of its centre over still water [m], heel about x [deg].
BEGIN {
    r = 0.02
    a = heel * atan2(0, -1) / 180
    print "#g-polys 1"
    print "poly 1 " r " 8 6 group=floe"
    for (k = 0; k < 8; k++) {
        x = (k % 2 ? 1 : -1) * (l / 2 - r)
        y = (int(k / 2) % 2 ? 1 : -1) * (b / 2 - r)
        w = (k >= 4 ? 1 : -1) * (h / 2 - r)
        printf "v %.17g %.17g %.17g\n", x, y * cos(a) - w * sin(a), z + y * sin(a) + w * cos(a)
    }
    print "f 4 0 2 3 1\nf 4 4 5 7 6\nf 4 0 1 5 4\nf 4 2 6 7 3\nf 4 0 4 6 2\nf 4 1 3 7 5"
}
