# SPDX-License-Identifier: GPL-3.0-or-later
# floe.awk -- one rectangular floe, g-polys(5): x from X0 to X1, Y across, H thick, edges rounded by r, speed V.
BEGIN {
    r = 0.05; n = split("-1 -1 1 -1 1 1 -1 1", s, " ")
    printf "#g-polys 1\npoly 0 %g 8 6 group=drive\n", r
    for (k = 0; k < 8; k++) {
        sx = s[2 * (k % 4) + 1]; sy = s[2 * (k % 4) + 2]
        printf "v %.9g %.9g %.9g\n", sx < 0 ? X0 + r : X1 - r, sy * (Y / 2 - r), k < 4 ? r - 0.9 * H : 0.1 * H - r
    }
    print "f 4 3 2 1 0\nf 4 4 5 6 7"
    for (k = 0; k < 4; k++) print "f 4", k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k
    printf "vel %g 0 0 0 0 0\n", V
}
