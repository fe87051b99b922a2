# SPDX-License-Identifier: GPL-3.0-or-later
# hydro.awk -- hydrostatics of a mesh against the closed forms of the hull. Status 1 if one is missed.
#     awk -v L=30 -v B=5 -v T=2 -f hydro.awk hull-12.dat hull-24.dat hull-48.dat      (finer and finer)
#
# The divergence theorem turns integrals over the wet body into integrals over its surface, z <= 0 at still water; no
# triangle crosses the water line:
#     V = int z nz,   V zB = int z^2/2 nz,   A = -int nz,   Ix = -int y^2 nz,   Iy = -int x^2 nz
# and on a flat triangle the mean of a product is  (sum a_i b_i + sum a_i sum b_i) / 12  over its three corners.
#     V = 4/9 L B T,   KB = 5/8 T,   A = 2/3 L B,   BM = Ix/V = 3 B^2 / (35 T),   BML = Iy/V = 3 L^2 / (40 T)
function mean2(a, b, c) { return (a * a + b * b + c * c + (a + b + c) ^ 2) / 12 }
FNR == 1 { mesh++; corners = 0 }
$1 == "v" { x[corners] = $2; y[corners] = $3; z[corners++] = $4 }
$1 == "t" && z[$2] <= 0 && z[$3] <= 0 && z[$4] <= 0 {
    i = $2; j = $3; k = $4
    nz = ((x[j] - x[i]) * (y[k] - y[i]) - (x[k] - x[i]) * (y[j] - y[i])) / 2 # times the area
    volume[mesh] += nz * (z[i] + z[j] + z[k]) / 3
    moment[mesh] += nz * mean2(z[i], z[j], z[k]) / 2
    plane[mesh] -= nz
    across[mesh] -= nz * mean2(y[i], y[j], y[k])
    along[mesh] -= nz * mean2(x[i], x[j], x[k])
}
# Each mesh has sides half as long as the one before, so errors of second order are a quarter.
function check_row(what, exact, tol,    m, off, before, order, ok) {
    printf "%-34s %10.5g ", what, exact
    for (m = 1; m <= mesh; m++) {
        before = off
        off = value[m] / exact - 1
        printf " %9.1e", off
    }
    order = log(before / off) / log(2)
    ok = off * off < tol * tol && order > 1.7 && order < 2.3
    printf "  %5.2f  %s\n", order, ok ? "ok" : "FAIL"
    if (!ok) failed = 1
}
END {
    if (mesh < 2 || !(L > 0 && B > 0 && T > 0)) {
        print "hydro.awk: L, B, T and two or more meshes are expected" >"/dev/stderr"
        exit 3
    }
    printf "%-46s", "the hull, and by how much its meshes miss it"
    for (m = 1; m <= mesh; m++) printf " %9s", "mesh " m
    print "  order"
    for (m = 1; m <= mesh; m++) value[m] = volume[m]
    check_row("displaced volume 4/9 L B T [m3]", 4 / 9 * L * B * T, 5e-3)
    for (m = 1; m <= mesh; m++) value[m] = T + moment[m] / volume[m]
    check_row("centre of buoyancy KB 5/8 T [m]", 5 / 8 * T, 5e-3)
    for (m = 1; m <= mesh; m++) value[m] = plane[m]
    check_row("water plane 2/3 L B [m2]", 2 / 3 * L * B, 5e-3)
    for (m = 1; m <= mesh; m++) value[m] = across[m] / volume[m]
    check_row("metacentric BM 3/35 B^2/T [m]", 3 / 35 * B * B / T, 5e-3)
    for (m = 1; m <= mesh; m++) value[m] = along[m] / volume[m]
    check_row("metacentric, along 3/40 L^2/T [m]", 3 / 40 * L * L / T, 5e-3)
    exit failed
}
