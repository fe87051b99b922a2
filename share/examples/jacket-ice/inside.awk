# SPDX-License-Identifier: GPL-3.0-or-later
# How deep a floe of the frames is in a leg at most [m]: legs.dat, frames.dat.  Of the vertices of a core the first
# half is its lower face, which is looked at from above.
BEGIN { legs = 0 }
/^cone/ { x[legs] = $2; y[legs] = $3; R[legs++] = $5 }
/^shape/ { of = $2; r[of] = $3; n[of] = 0 }
/^v / { vx[of, n[of]] = $2; vy[of, n[of]] = $3; vz[of, n[of]++] = $4 }
/^frame/ { t = $2 }
/^body/ {
    i = $2; m = n[i]/2; w = $6; a = $7; b = $8; c = $9
    for (k = 0; k < m; k++) {
        px[k] = $3 + (1 - 2*(b*b + c*c))*vx[i, k] + 2*(a*b - w*c)*vy[i, k] + 2*(a*c + w*b)*vz[i, k]
        py[k] = $4 + 2*(a*b + w*c)*vx[i, k] + (1 - 2*(a*a + c*c))*vy[i, k] + 2*(b*c - w*a)*vz[i, k]
    }
    around = 0
    for (k = 0; k < m; k++) { e = (k + 1) % m; around += px[k]*py[e] - px[e]*py[k] }
    for (l = 0; l < legs; l++) {
        beyond = -1e9; near = 1e9
        for (k = 0; k < m; k++) {
            e = (k + 1) % m; ex = px[e] - px[k]; ey = py[e] - py[k]; L = sqrt(ex*ex + ey*ey)
            u = x[l] - px[k]; v = y[l] - py[k]
            d = (around > 0 ? 1 : -1)*(u*ey - v*ex)/L
            if (d > beyond) beyond = d
            f = (u*ex + v*ey)/(L*L); f = f < 0 ? 0 : f > 1 ? 1 : f
            d = sqrt((u - f*ex)^2 + (v - f*ey)^2)
            if (d < near) near = d
        }
        deep = R[l] + r[i] - (beyond > 0 ? near : beyond)
        if (deep > most) { most = deep; when = t; which = i; part = most/R[l] }
    }
}
END {
    ok = part < 0.1
    printf "%s deepest in a leg: %.4f m, %.3f of its radius, floe %d at %g s\n", ok ? "ok  " : "FAIL", most, part, which, when
    exit !ok
}
