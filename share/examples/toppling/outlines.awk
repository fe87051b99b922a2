# SPDX-License-Identifier: GPL-3.0-or-later
# Outlines of the blocks, turned back by the dip of 25 degrees: at the start, and at the times of the state.
function turn(x, z) { c = cos(a); s = sin(a); return sprintf("%.5g %.5g", c * x - s * z, s * x + c * z) }
function put(id, X, Z, sn, cn,    k, q, dx, dz)
{
    for (k = 0; k <= 4; k++) {
        q = k % 4
        dx = (q == 0 || q == 3 ? x0[id] : x1[id]) - mx[id]; dz = (q < 2 ? z0[id] : z1[id]) - mz[id]
        print turn(X + cn * dx + sn * dz, Z - sn * dx + cn * dz)
    }
    print ""
}
BEGIN { a = 25 * atan2(0, -1) / 180 }
FILENAME ~ /polys/ && $1 == "poly" { id = $2; base[id] = /base/; x0[id] = z0[id] = 1e9; x1[id] = z1[id] = -1e9 }
FILENAME ~ /polys/ && $1 == "v" {
    if ($2 < x0[id]) x0[id] = $2; if ($2 > x1[id]) x1[id] = $2
    if ($4 < z0[id]) z0[id] = $4; if ($4 > z1[id]) z1[id] = $4
}
FILENAME ~ /state/ && /^[0-9]/ { t[NR] = $1; row[NR] = $0; last = $1 }
END {
    for (id in x0) { x0[id] -= 0.002; x1[id] += 0.002; z0[id] -= 0.002; z1[id] += 0.002
        mx[id] = (x0[id] + x1[id]) / 2; mz[id] = (z0[id] + z1[id]) / 2 }
    for (id in x0) if (base[id]) put(id, mx[id], mz[id], 0, 1)
    for (k = 0; k < 2; k++) {
        print "\n"
        for (r in row) {
            n = split(row[r], f)
            if (f[1] != (k ? last : 0) || base[f[2]]) continue
            put(f[2], f[3], f[5], 2 * f[8] * f[6], 1 - 2 * f[8] ^ 2)
        }
    }
}
