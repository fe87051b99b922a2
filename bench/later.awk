# SPDX-License-Identifier: GPL-3.0-or-later
# later.awk -- STATE ICE: the ice with the positions and velocities of the last time of a state table.
function cross(a, b, c,    k, l, m) {
    for (k = 0; k < 3; k++) { l = (k + 1) % 3; m = (k + 2) % 3; c[k] = a[l] * b[m] - a[m] * b[l] }
}
BEGIN { OFMT = CONVFMT = "%.17g" }
FNR == 1 { file++ }
file == 1 {
    if (/^#/) next
    if (!("t[s]" in col)) { for (k = 1; k <= NF; k++) col[$k] = k; next }
    id = $col["body"]
    if (!(id in first)) first[id] = $0
    last[id] = $0
    next
}
/^poly/ {
    split(first[$2], a)
    split(last[$2], b)
    w = b[col["qw"]]; vel = "vel"
    for (k = 0; k < 3; k++) {
        from[k] = a[col["x[m]"] + k]; to[k] = b[col["x[m]"] + k]; q[k] = b[col["qx"] + k]
    }
    for (k = 0; k < 6; k++) vel = vel " " b[col["vx[m/s]"] + k]
}
/^v / { # d + 2 q x (q x d + w d): the rotation since the start
    for (k = 0; k < 3; k++) d[k] = $(k + 2) - from[k]
    cross(q, d, c)
    for (k = 0; k < 3; k++) c[k] += w * d[k]
    cross(q, c, turn)
    $0 = "v"
    for (k = 0; k < 3; k++) $0 = $0 " " to[k] + d[k] + 2 * turn[k]
}
/^vel/ { $0 = vel }
{ print }
