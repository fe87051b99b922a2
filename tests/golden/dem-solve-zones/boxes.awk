# Rows "id x0 y0 z0 x1 y1 z1 group" to boxes with a radius of 1 cm; other rows as they are.
function corner(x, y, z) { printf "v %.10g %.10g %.10g\n", x, y, z }
BEGIN { print "#g-polys 3" }
NF != 8 { print; next }
{
    R = 0.01
    printf "poly %d %g 8 6 group=%s\n", $1, R, $8
    x0 = $2 + R; y0 = $3 + R; z0 = $4 + R; x1 = $5 - R; y1 = $6 - R; z1 = $7 - R
    corner(x0, y0, z0); corner(x1, y0, z0); corner(x1, y1, z0); corner(x0, y1, z0)
    corner(x0, y0, z1); corner(x1, y0, z1); corner(x1, y1, z1); corner(x0, y1, z1)
    print "f 4 0 3 2 1\nf 4 4 5 6 7\nf 4 0 1 5 4\nf 4 1 2 6 5\nf 4 2 3 7 6\nf 4 3 0 4 7"
}
