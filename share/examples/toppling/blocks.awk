# SPDX-License-Identifier: GPL-3.0-or-later
# The slope of Goodman and Bray in the axes of its blocks: x up the slope along their bases, z along their height.
#   awk -v n=10 -v crest=6 -v dx=4 -v a1=3.2 -v a2=2.1 -v b=0.6 -f blocks.awk >slope.polys
function corner(x, y, z) { printf "v %.10g %.10g %.10g\n", x, y, z }
function block(id, x0, x1, z0, z1, group) # with the faces moved in by the radius R
{
    printf "poly %d %g 8 6 group=%s\n", id, R, group
    x0 += R; x1 -= R; z0 += R; z1 -= R
    corner(x0, R, z0); corner(x1, R, z0); corner(x1, 1 - R, z0); corner(x0, 1 - R, z0)
    corner(x0, R, z1); corner(x1, R, z1); corner(x1, 1 - R, z1); corner(x0, 1 - R, z1)
    print "f 4 0 3 2 1\nf 4 4 5 6 7\nf 4 0 1 5 4\nf 4 1 2 6 5\nf 4 2 3 7 6\nf 4 3 0 4 7"
}
BEGIN {
    R = 0.002
    print "#g-polys 3"
    for (i = 1; i <= n; i++) {
        y = i <= crest ? i * (a1 - b) : y - (a2 + b)
        block(i, (i - 1) * dx, i * dx, (i - 1) * b, (i - 1) * b + y, "block")
        block(100 + i, (i - 1) * dx, i * dx, (i - 1) * b - 2, (i - 1) * b, "base")
    }
    for (i = 1; i <= n; i++) {
        printf "joint %d %d 1 0 %s\n", 100 + i, i, i == 1 ? "toe" : "base"
        if (i < n) printf "joint %d %d 3 5 side\n", i, i + 1
    }
}
