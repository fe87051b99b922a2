# SPDX-License-Identifier: GPL-3.0-or-later
# plan.awk -- outlines in plan view of one frame of ANIMATION_3D.DAT.
#     awk -v frame=first -f plan.awk ANIMATION_3D.DAT >plan-start.dat        (or frame=last)
# First block (index 0 of gnuplot): the floes, each the hull of its vertices in their pose, grown by its
# dilation radius. Second block: the structure, its triangles and cones one by one.
BEGIN {
    if (frame != "first" && frame != "last") {
        print "plan.awk: -v frame=first or -v frame=last is expected" >"/dev/stderr"
        bad = 2
        exit bad
    }
    gone_x = gone_y = 0
}
/^#/ || NF == 0 { next }
$1 == "shape" { shape = $2; radius[shape] = $3; n[shape] = 0; in_part = 0; next }
$1 == "part" { in_part = ++parts; part[$2] = parts; nv[in_part] = 0; next }
$1 == "v" && !in_part { k = n[shape]++; vx[shape, k] = $2; vy[shape, k] = $3; vz[shape, k] = $4; next }
$1 == "v" { k = nv[in_part]++; px[in_part, k] = $2; py[in_part, k] = $3; pz[in_part, k] = $4; next }
$1 == "t" { k = ++triangles; of[k] = in_part; t1[k] = $2; t2[k] = $3; t3[k] = $4; next }
$1 == "cone" { k = ++cones; cone[k] = $0; cone_of[k] = in_part; next }
$1 == "frame" { if (++frames > 1 && frame == "first") exit; t = $2; fresh = 1; next }
$1 == "body" { # a frame lists all bodies present, or none: then those of the last frame remain
    if (fresh) bodies = fresh = 0
    pose[$2] = $0
    body[++bodies] = $2
    next
}
$1 == "structure" { gone_x = $2; gone_y = $3; next }
$1 == "moved" { moved[part[$2]] = $0; next }

# Plan position of x, y, z in the pose p, by the first two rows of the rotation matrix. Sets at_x and at_y.
function turn(x, y, z,    w, a, b, c) {
    w = p[6]; a = p[7]; b = p[8]; c = p[9]
    at_x = p[3] + (1 - 2 * (b * b + c * c)) * x + 2 * (a * b - w * c) * y + 2 * (a * c + w * b) * z
    at_y = p[4] + 2 * (a * b + w * c) * x + (1 - 2 * (a * a + c * c)) * y + 2 * (b * c - w * a) * z
}
# The same for a point of part q of the structure.
function ride(q, x, y, z) {
    split(q in moved ? moved[q] : "0 0 " gone_x " " gone_y " 0 1 0 0 0", p)
    turn(x, y, z)
}
function place(i, k) {
    turn(vx[i, k], vy[i, k], vz[i, k])
    hx[k] = at_x
    hy[k] = at_y
}
function sort(m,    a, b, x, y) {
    for (a = 1; a < m; a++) {
        x = hx[a]; y = hy[a]
        for (b = a - 1; b >= 0 && (hx[b] > x || (hx[b] == x && hy[b] > y)); b--) {
            hx[b + 1] = hx[b]; hy[b + 1] = hy[b]
        }
        hx[b + 1] = x; hy[b + 1] = y
    }
}
function left(a, b, k) { return (ox[b] - ox[a]) * (hy[k] - oy[a]) - (oy[b] - oy[a]) * (hx[k] - ox[a]) }
# Hull of the m corners, counter-clockwise (monotone chain); returns the number of corners in ox, oy.
function hull(m,    k, h, low) {
    sort(m)
    h = 0
    for (k = 0; k < m; k++) {
        while (h >= 2 && left(h - 2, h - 1, k) <= 0) h--
        ox[h] = hx[k]; oy[h++] = hy[k]
    }
    low = h + 1
    for (k = m - 2; k >= 0; k--) {
        while (h >= low && left(h - 2, h - 1, k) <= 0) h--
        ox[h] = hx[k]; oy[h++] = hy[k]
    }
    return h - 1
}
function ring(x, y, r,    k, a) {
    for (k = 0; k <= 48; k++) {
        a = k * 6.283185307179586 / 48
        printf "%.4f %.4f\n", x + r * cos(a), y + r * sin(a)
    }
    print ""
}
# The hull with each side moved outward by r; corners are straight between the moved ends.
function grown(h, r,    a, b, nx, ny, l, x0, y0) {
    for (a = 0; a < h; a++) {
        b = (a + 1) % h
        nx = oy[b] - oy[a]; ny = ox[a] - ox[b]; l = sqrt(nx * nx + ny * ny)
        if (l > 0) { nx *= r / l; ny *= r / l }
        if (a == 0) { x0 = ox[a] + nx; y0 = oy[a] + ny }
        printf "%.4f %.4f\n%.4f %.4f\n", ox[a] + nx, oy[a] + ny, ox[b] + nx, oy[b] + ny
    }
    printf "%.4f %.4f\n\n", x0, y0
}
END {
    if (bad) exit bad
    if (!frames || !bodies) { print "plan.awk: no frame with ice in it" >"/dev/stderr"; exit 3 }
    print "# ice\n# t = " t
    for (j = 1; j <= bodies; j++) {
        i = body[j]
        split(pose[i], p)
        for (k = 0; k < n[i]; k++) place(i, k)
        h = n[i] > 1 ? hull(n[i]) : 1
        if (h < 2) ring(hx[0], hy[0], radius[i])
        else grown(h, radius[i])
    }
    print "\n# structure"
    for (k = 1; k <= triangles; k++) {
        q = of[k]
        split(t1[k] " " t2[k] " " t3[k] " " t1[k], corner)
        for (c = 1; c <= 4; c++) {
            ride(q, px[q, corner[c]], py[q, corner[c]], pz[q, corner[c]])
            printf "%.4f %.4f\n", at_x, at_y
        }
        print ""
    }
    for (k = 1; k <= cones; k++) {
        split(cone[k], end)
        ride(cone_of[k], end[2], end[3], end[4])
        ring(at_x, at_y, end[5])
        ride(cone_of[k], end[6], end[7], end[8])
        ring(at_x, at_y, end[9])
    }
}
