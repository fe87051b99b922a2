# SPDX-License-Identifier: GPL-3.0-or-later
# hull.awk -- a Wigley hull as an OFF file: y = (B/2) (1 - (2x/L)^2) (1 - (z/T)^2) below the water, z from -T to 0,
# straight sides from there up to a flat deck at F.
#     awk -v L=30 -v B=5 -v T=2 -v F=1 -v NX=24 -v NZ=8 -f hull.awk
# NX stations and NZ water lines; bow at +L/2. The corners lie on the hull, so errors of the flat triangles are
# of second order.
function half(i, j,    x, z) {
    x = 2 * i / NX - 1
    z = j < NZ ? j / NZ - 1 : 0
    return B / 2 * (1 - x * x) * (1 - z * z)
}
# The corner at station i, level j (NZ is the water, NZ + 1 the deck), side 1 or -1; both sides share keel and stems.
function corner(i, j, side,    key) {
    if (i == 0 || i == NX || j == 0) side = 1
    key = i " " j " " side
    if (!(key in number)) {
        number[key] = corners
        place[corners++] = sprintf("%.17g %.17g %.17g", L * (i / NX - 0.5), side * half(i, j),
                                   j > NZ ? F : T * (j / NZ - 1))
    }
    return number[key]
}
function face(a, b, c, side) { row[faces++] = side > 0 ? "3 " a " " b " " c : "3 " a " " c " " b }
# The diagonal leaves the corner of the hull where keel and stem meet, since both its sides would coincide otherwise.
function quad(i, j, side,    a, b, c, d) {
    a = corner(i, j, side); b = corner(i + 1, j, side); c = corner(i + 1, j + 1, side); d = corner(i, j + 1, side)
    if (i < NX / 2) { face(a, c, b, side); face(a, d, c, side) }
    else { face(a, d, b, side); face(b, d, c, side) }
}
BEGIN {
    if (!(L > 0 && B > 0 && T > 0 && F > 0 && NX >= 4 && NX % 2 == 0 && NZ >= 2)) {
        print "hull.awk: L, B, T, F above 0, NX even and at least 4, NZ at least 2 are expected" >"/dev/stderr"
        exit 2
    }
    corners = faces = 0
    for (side = 1; side >= -1; side -= 2)
        for (i = 0; i < NX; i++)
            for (j = 0; j <= NZ; j++) quad(i, j, side)
    for (i = 0; i < NX; i++) { # the deck; at the stems the two sides meet
        if (i < NX - 1) face(corner(i, NZ + 1, -1), corner(i + 1, NZ + 1, -1), corner(i + 1, NZ + 1, 1), 1)
        else face(corner(i, NZ + 1, -1), corner(i + 1, NZ + 1, 1), corner(i, NZ + 1, 1), 1)
        if (i > 0 && i < NX - 1) face(corner(i, NZ + 1, -1), corner(i + 1, NZ + 1, 1), corner(i, NZ + 1, 1), 1)
    }
    print "OFF"
    print corners, faces, 0
    for (k = 0; k < corners; k++) print place[k]
    for (k = 0; k < faces; k++) print row[k]
}
