# SPDX-License-Identifier: GPL-3.0-or-later
# floes.awk -- writes a g-polys file from rows of boxes and balls:
#   box  x y z  a b c  r  rx ry rz  vx vy vz  wx wy wz    half sizes with dilation radius r, rotation [deg]
#   ball x y z  r  vx vy vz  wx wy wz
function row(x, y, z,    rx, ry, rz) { # rotated about x, then y, then z
    rx = y * cx - z * sx; z = y * sx + z * cx; y = rx
    ry = x * cy + z * sy; z = z * cy - x * sy; x = ry
    rz = x * cz - y * sz; y = x * sz + y * cz; x = rz
    printf "v %.17g %.17g %.17g\n", $2 + x, $3 + y, $4 + z
}
BEGIN { print "#g-polys 1"; print "#by floes.awk"; deg = atan2(0, -1) / 180 }
/^box/ {
    a = $5 - $8; b = $6 - $8; c = $7 - $8
    cx = cos(deg * $9); cy = cos(deg * $10); cz = cos(deg * $11)
    sx = sin(deg * $9); sy = sin(deg * $10); sz = sin(deg * $11)
    print "poly", n++, $8, 8, 6
    for (k = 0; k < 8; k++) row(k % 2 ? a : -a, int(k / 2) % 2 ? b : -b, k > 3 ? c : -c)
    print "f 4 0 2 3 1\nf 4 4 5 7 6\nf 4 0 1 5 4\nf 4 2 6 7 3\nf 4 0 4 6 2\nf 4 1 3 7 5"
    print "vel", $12, $13, $14, $15, $16, $17
}
/^ball/ { print "poly", n++, $5, 1, 0; print "v", $2, $3, $4; print "vel", $6, $7, $8, $9, $10, $11 }
