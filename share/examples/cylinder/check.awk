# SPDX-License-Identifier: GPL-3.0-or-later
# check.awk -- checks a run against balances and closed forms. Status 1 if a check fails.
#     dem-solve --echo SCENE | awk -f check.awk - report.txt g-polys.dat state.dat loads.tsv
#
# Momentum along x: the loss of the ice plus the input of the current equals the impulse on the structure, since the
# walls have no friction. Mass and wetted area of a floe follow from its corners, since floes are upright
# prisms here:
#     A = A_core + P_core r + r^2 sum tan(turn/2),   m = rho A h,
#     P = P_core + 2 r sum tan(turn/2),              W = A + P draft
# and the drag of all floes, sum 1/2 C rho_w W |u - v| (u - v), is summed over the rows of the state table.
FNR == 1 { kind = /^#/ ? substr($1, 2) : "report" }
kind == "scene" && /^\[/ { section = $0 }
kind == "scene" && $2 == "=" { of[section " " $1] = $3 }
kind == "report" && /^step over critical/ { ratio = $4 }
kind == "report" && /^energy residual/ { energy = $3 }
kind == "report" && /^momentum residual/ { imbalance = $3 }
kind == "report" && /^largest overlap/ { overlap = $3 }
kind == "g-polys" && $1 == "poly" { floe(); id = $2; r = $3; nv = 0 }
kind == "g-polys" && $1 == "v" { x[nv] = $2; y[nv] = $3; z[nv] = $4; nv++ }
kind != "g-polys" && nv { floe(); nv = 0 }
(kind == "state" || kind == "loads") && !/^#/ && $1 !~ /^t/ {
    if (kind == "state") state()
    else { ix += $3 * ($1 - before); iy += $4 * ($1 - before); before = $1; rows++ }
}

# Mass and wetted area of the floe read last; its corners are those of the bottom, then of the top.
function floe(    n, k, a, b, c, area, rim, turn, dx, dy, ex, ey) {
    if (!nv) return
    n = nv / 2
    area = rim = turn = 0
    for (k = 0; k < n; k++) {
        a = (k + 1) % n; b = (k + 2) % n
        dx = x[a] - x[k]; dy = y[a] - y[k]; ex = x[b] - x[a]; ey = y[b] - y[a]
        area += (x[k] * y[a] - x[a] * y[k]) / 2
        rim += sqrt(dx * dx + dy * dy)
        c = atan2(dx * ey - dy * ex, dx * ex + dy * ey) / 2
        turn += sin(c) / cos(c)
    }
    area += rim * r + r * r * turn
    rim += 2 * r * turn
    m[id] = of["[material ice] density"] * area * (z[n] - z[0] + 2 * r)
    wet[id] = area + rim * (of["[water] level"] - z[0] + r)
    total_wet += wet[id]
    if (z[n] - z[0] + 2 * r > thick) thick = z[n] - z[0] + 2 * r
    floes++
}
function state(    u, w) {
    if ($1 != t) { block(); t = $1; p = force = n_row = 0 }
    u = of["[water] current"] - $10
    w = -$11
    p += m[$2] * $10
    force += of["[water] drag_force_coef"] * of["[water] density"] / 2 * wet[$2] * sqrt(u * u + w * w) * u
    n_row++
    if ($5 > highest || $5 < -highest) highest = $5 < 0 ? -$5 : $5
}
# The rows of one time are complete: trapezoidal rule.
function block() {
    if (!n_row) return
    if (!blocks++) start = p
    else drag += (force + force_before) / 2 * (t - t_before)
    force_before = force
    t_before = t
}
function row(what, value, expected, ok) {
    printf "%-44s %12s   %-22s %s\n", what, value, expected, ok ? "ok" : "FAIL"
    if (!ok) failed++
}
function kilo(a) { return sprintf("%.5g", a / 1000) }
END {
    block()
    if (!floes || !rows || blocks < 2 || energy == "") {
        print "check.awk: scene, report, ice, state and loads are expected, in this order" >"/dev/stderr"
        exit 3
    }
    still = of["[water] drag_force_coef"] * of["[water] density"] / 2 * total_wet
    still *= of["[water] current"] ^ 2 * t
    print "check                                               found   expected"
    row("floes at the end", n_row, floes, n_row == floes)
    row("farthest centre from the water line [m]", sprintf("%.2g", highest), "< " thick ", the thickness",
        highest < thick)
    row("impulse on the structure along x [kN s]", kilo(ix), "> 0", ix > 0)
    row("  if all of the ice were stopped [kN s]", kilo(ix), "< " kilo(start + still), ix < start + still)
    lost = start - p + drag
    row("  what ice and current lost [kN s]", kilo(lost), "= " kilo(ix) " within 1 %",
        (lost - ix) ^ 2 < (0.01 * ix) ^ 2)
    row("energy residual over throughput", energy, "< 0.01", energy < 0.01)
    row("momentum residual over contact impulses", imbalance, "< 1e-12", imbalance < 1e-12)
    row("largest overlap over radius", overlap, "< 0.3", overlap < 0.3)
    row("step over critical step", ratio, "< 0.5", ratio + 0 < 0.5)
    exit failed > 0
}
