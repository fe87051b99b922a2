# SPDX-License-Identifier: GPL-3.0-or-later
# A triangular truss leg as a table of members for a structure file: three chords at the corners of a triangle of side
# s, one of them upstream, horizontals at the nodes of each bay and one diagonal a face and bay; nothing inside chords,
# so that parts of one leg do not overlap by more than their own walls.
#   awk -v s=5 -v X=0 -v Y=0 -v id=0 -v turn=0 -f leg.awk
# s = 0: a single column of the radius of a chord.
# s: side [m]; X, Y: middle of the leg; turn: of the leg about its axis [deg]; chord, level, brace: radii [m]; bay [m]
BEGIN {
    if (!chord) chord = 0.4
    if (!level) level = 0.18
    if (!brace) brace = 0.15
    if (!bay) bay = 5
    if (!bays) bays = 3
    deg = 3.14159265358979/180
    top = bays*bay/2
    for (k = 0; k < 3; k++) {
        a = (180 + 120*k + turn)*deg
        x[k] = X + s/sqrt(3)*cos(a); y[k] = Y + s/sqrt(3)*sin(a)
    }
    print "part " id " leg" id + 1
    if (!s) { printf "cone %.6g %.6g %.6g %.6g  %.6g %.6g %.6g %.6g\n", X, Y, -top, chord, X, Y, top, chord; exit }
    for (k = 0; k < 3; k++) printf "cone %.6g %.6g %.6g %.6g  %.6g %.6g %.6g %.6g\n", x[k], y[k], -top - 2, chord, x[k], y[k], top + 2, chord
    for (k = 0; k < 3; k++) {
        j = (k + 1) % 3
        for (b = 0; b <= bays; b++) {
            z = b*bay - top
            printf "cone %.6g %.6g %.6g %.6g  %.6g %.6g %.6g %.6g\n", x[k], y[k], z, level, x[j], y[j], z, level
            if (b < bays) printf "cone %.6g %.6g %.6g %.6g  %.6g %.6g %.6g %.6g\n", x[k], y[k], z, brace, x[j], y[j], z + bay, brace
        }
    }
}
