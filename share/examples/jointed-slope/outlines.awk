# SPDX-License-Identifier: GPL-3.0-or-later
# outlines.awk POLYS STATE: the faces of blocks at least y, as polygons of x and z: at the start; then, behind two blank
# lines, as they are in the last rows of STATE.
FNR == 1 { file++ }
file == 1 && $1 == "poly" { id = $2; n[id] = 0; faces[id] = 0; ids[++blocks] = id }
file == 1 && $1 == "v" { x[id, n[id]] = $2; y[id, n[id]] = $3; z[id, n[id]] = $4; n[id]++ }
file == 1 && $1 == "f" { face[id, faces[id]++] = $0 }
file == 2 && /^[0-9]/ {
    if (!($2 in X0)) { X0[$2] = $3; Z0[$2] = $5 }
    X[$2] = $3; Z[$2] = $5; turn[$2] = 2 * $8
}
function draw(moved, b, f, k, m, part, low, ok, dx, dz, c, s, id)
{
    for (b = 1; b <= blocks; b++) {
        id = ids[b]
        low = 1e9
        for (k = 0; k < n[id]; k++) if (y[id, k] < low) low = y[id, k]
        for (f = 0; f < faces[id]; f++) {
            m = split(face[id, f], part)
            ok = 1
            for (k = 3; k <= m; k++) if (y[id, part[k]] > low + 1e-6) ok = 0
            if (!ok) continue
            c = moved ? cos(turn[id]) : 1; s = moved ? sin(turn[id]) : 0
            for (k = 3; k <= m + 1; k++) {
                dx = x[id, part[k > m ? 3 : k]] - X0[id]; dz = z[id, part[k > m ? 3 : k]] - Z0[id]
                printf "%.5f %.5f\n", (moved ? X[id] : X0[id]) + c * dx + s * dz, (moved ? Z[id] : Z0[id]) - s * dx + c * dz
            }
            print ""
        }
    }
}
END { draw(0); print ""; draw(1) }
