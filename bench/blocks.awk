# SPDX-License-Identifier: GPL-3.0-or-later
# blocks.awk -- 216 blocks of 1 x 1 x 0.4 m with a dilation radius of 50 mm, for blocks.sh.
#     awk -v scene=gas|pack -v as=dem-solve|lmp|yade|rockable -v dt=.. -v until=.. -v windows=.. -f blocks.awk
# gas: blocks apart, with random orientation, velocity and spin.  pack: neighbours overlap by 0.5 mm.  In both the
# blocks also move towards the centre.
function uniform() { seed = seed * 16807 % 2147483647; return seed / 2147483647 } # the same in every awk
function gauss(    k, sum) { for (k = 0; k < 12; k++) sum += uniform(); return sum - 6 }

# a[1..3] turned by the quaternion of block n into X, Y, Z
function turn(n, a,    w, x, y, z, u, v, t) {
    w = q[n, 0]; x = q[n, 1]; y = q[n, 2]; z = q[n, 3]
    u = y * a[3] - z * a[2] + w * a[1]
    v = z * a[1] - x * a[3] + w * a[2]
    t = x * a[2] - y * a[1] + w * a[3]
    X = a[1] + 2 * (y * t - z * v); Y = a[2] + 2 * (z * u - x * t); Z = a[3] + 2 * (x * v - y * u)
}

# Corner k of a block of half sizes h, each reduced by `by`
function corner(k, by, a) {
    a[1] = (k % 2 ? 1 : -1) * (h[1] - by)
    a[2] = (int(k / 2) % 2 ? 1 : -1) * (h[2] - by)
    a[3] = (k > 3 ? 1 : -1) * (h[3] - by)
}

function place(    n, i, j, k, m, s) {
    for (n = 0; n < count[1] * count[2] * count[3]; n++) {
        i = n % count[1]; j = int(n / count[1]) % count[2]; k = int(n / (count[1] * count[2]))
        x[n, 1] = (i + 0.5) * pitch[1]; x[n, 2] = (j + 0.5) * pitch[2]; x[n, 3] = (k + 0.5) * pitch[3]
        q[n, 0] = scene == "gas" ? gauss() : 1000
        for (m = 1; m <= 3; m++) q[n, m] = gauss()
        s = sqrt(q[n, 0]^2 + q[n, 1]^2 + q[n, 2]^2 + q[n, 3]^2)
        for (m = 0; m <= 3; m++) q[n, m] /= s
        for (m = 1; m <= 6; m++) v[n, m] = scene == "gas" ? 0.5 * gauss() : 0
        for (m = 1; m <= 3; m++) v[n, m] -= (scene == "gas" ? 0.5 : 0.1) * (x[n, m] - count[m] * pitch[m] / 2)
    }
    return n
}

function three(a, n) { return a[n, 1] " " a[n, 2] " " a[n, 3] }
function four(n) { return q[n, 0] " " q[n, 1] " " q[n, 2] " " q[n, 3] }
function spin(n) { return v[n, 4] " " v[n, 5] " " v[n, 6] }

function dem_solve(    n, k, a) {
    print "#g-polys 1"
    for (n = 0; n < bodies; n++) {
        print "poly", n, r, 8, 6
        for (k = 0; k < 8; k++) {
            corner(k, r, a)
            turn(n, a)
            print "v", x[n, 1] + X, x[n, 2] + Y, x[n, 3] + Z
        }
        for (k = 1; k <= 6; k++) print "f 4", face[k]
        print "vel", three(v, n), spin(n)
    }
}

# Moments of inertia about the global axes; leaves the angular momentum in L
function inertia(n,    I, J, e, a, i, j, k) {
    for (k = 1; k <= 3; k++) {
        I[k] = mass / 3 * (h[1]^2 + h[2]^2 + h[3]^2 - h[k]^2)
        for (i = 1; i <= 3; i++) a[i] = i == k
        turn(n, a)
        e[k, 1] = X; e[k, 2] = Y; e[k, 3] = Z
    }
    for (i = 1; i <= 3; i++) {
        L[i] = 0
        for (j = 1; j <= 3; j++) {
            J[i, j] = 0
            for (k = 1; k <= 3; k++) J[i, j] += I[k] * e[k, i] * e[k, j]
            L[i] += J[i, j] * v[n, 3 + j]
        }
    }
    return J[1, 1] " " J[2, 2] " " J[3, 3] " " J[1, 2] " " J[1, 3] " " J[2, 3]
}

function lmp(    n, k, a) {
    print "blocks\n\n" bodies " atoms\n" bodies " bodies\n1 atom types"
    for (k = 1; k <= 3; k++) print -20, 40, substr("xyz", k, 1) "lo", substr("xyz", k, 1) "hi"
    print "\nAtoms\n"
    for (n = 0; n < bodies; n++) print n + 1, 1, 1, mass, three(x, n)
    print "\nVelocities\n"
    for (n = 0; n < bodies; n++) { inertia(n); print n + 1, three(v, n), L[1], L[2], L[3] }
    print "\nBodies\n"
    for (n = 0; n < bodies; n++) {
        print n + 1 " 3 79\n8 12 6\n" inertia(n)
        for (k = 0; k < 8; k++) { corner(k, r, a); turn(n, a); print X, Y, Z }
        for (k = 1; k <= 12; k++) print edge[k]
        for (k = 1; k <= 6; k++) print face[k]
        print 2 * r
    }
}

# One row per block, with the outer corners: the polyhedra of YADE have no dilation radius
function yade(    n, k, a, row) {
    for (n = 0; n < bodies; n++) {
        row = three(v, n) " " spin(n)
        for (k = 0; k < 8; k++) {
            corner(k, 0, a)
            turn(n, a)
            row = row " " x[n, 1] + X " " x[n, 2] + Y " " x[n, 3] + Z
        }
        print row
    }
}

# The input file, and after the line `shape` the shape file
function rockable(    n, k, a, elastic) {
    elastic = scene == "gas"
    print "Rockable 21-08-2022\nt 0\ntmax " until "\ndt " dt
    print "interVerlet 0.005\ninterConf " until / windows
    print "DVerlet 0.1\ndVerlet 0.1\ndensity 0 917\ngravity 0 0 0\nforceLaw Default\nknContact 0 0 " stiffness
    print "en2Contact 0 0 " (elastic ? 1 : 0.09) "\nktContact 0 0 " stiffness
    print "muContact 0 0 " (elastic ? 0 : 0.3)
    print "krContact 0 0 0\nmurContact 0 0 0\niconf 0\nnDriven 0\nshapeFile ./block.shp\nprecision 16"
    print "Particles " bodies
    for (n = 0; n < bodies; n++)
        print "BLOCK 0 0 1", three(x, n), three(v, n), "0 0 0", four(n), spin(n), "0 0 0"
    print "shape\n<\nname BLOCK\nradius " r "\npreCompDone y\nnv 8"
    for (k = 0; k < 8; k++) { corner(k, r, a); print a[1], a[2], a[3] }
    print "ne 12"
    for (k = 1; k <= 12; k++) print edge[k]
    print "nf 6"
    for (k = 1; k <= 6; k++) print 4, face[k]
    print "obb.extent", h[1], h[2], h[3] "\nobb.e1 1 0 0\nobb.e2 0 1 0\nobb.e3 0 0 1\nobb.center 0 0 0"
    print "volume", mass / 917
    print "I/m", (h[2]^2 + h[3]^2) / 3, (h[1]^2 + h[3]^2) / 3, (h[1]^2 + h[2]^2) / 3 "\n>"
}

BEGIN {
    OFMT = CONVFMT = "%.17g"
    seed = 7
    h[1] = h[2] = 0.5; h[3] = 0.2; r = 0.05; mass = 358; stiffness = 7e7
    split(scene == "gas" ? "6 6 6" : "6 4 9", count)
    for (k = 1; k <= 3; k++) pitch[k] = scene == "gas" ? 1.5 : 2 * h[k] - 0.0005
    split("0 1,2 3,4 5,6 7,0 2,1 3,4 6,5 7,0 4,1 5,2 6,3 7", edge, ",")
    split("0 2 3 1,4 5 7 6,0 1 5 4,2 6 7 3,0 4 6 2,1 3 7 5", face, ",")
    bodies = place()
    if (as == "dem-solve") dem_solve()
    else if (as == "lmp") lmp()
    else if (as == "yade") yade()
    else if (as == "rockable") rockable()
}
