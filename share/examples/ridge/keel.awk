# SPDX-License-Identifier: GPL-3.0-or-later
# awk -v depth=D -v width=W -v len=L -v x=X -f keel.awk: a keel as a closed mesh (OBJ): a triangular prism along y, its
# base at the water line z = 0, its edge at z = -D, centred on x = X, y = 0.
BEGIN {
    for (k = 0; k < 2; k++) {
        y = (k - 0.5) * len
        printf "v %.9g %.9g 0\nv %.9g %.9g 0\nv %.9g %.9g %.9g\n", x - width / 2, y, x + width / 2, y, x, y, -depth
    }
    print "f 1 2 3\nf 4 6 5\nf 1 4 5\nf 1 5 2\nf 2 5 6\nf 2 6 3\nf 3 6 4\nf 3 4 1"
}
