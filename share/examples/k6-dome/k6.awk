# SPDX-License-Identifier: GPL-3.0-or-later
# A Kiewitt dome K6 of RINGS rings as a model of kind `members`: pipes 180 x 5 mm, rim pinned, load on the apex; m and kN.
#   awk -v RINGS=4 -v SPAN=30 -v RISE=2 -v PIECES=6 -v LOAD=100 -f k6.awk
function name(ring, sector, i)
{
    if (ring == 0) return "apex"
    if (i == ring) { i = 0; sector = sector + 1 }
    return "r" ring "." (sector % 6) * ring + i
}
function member(a, b) { printf "member %d %s %s pipe %d\n", ++members, a, b, PIECES }
BEGIN {
    R = (SPAN * SPAN / 4 + RISE * RISE) / (2 * RISE)
    rim = atan2(SPAN / 2, R - RISE)
    print "#members 1\nsection pipe pipe 0.18 0.005 210e6 85e6 7.85\npart dome\nnode apex 0 0 " RISE
    for (k = 1; k <= RINGS; k++)
        for (s = 0; s < 6; s++)
            for (i = 0; i < k; i++) {
                phi = rim * k / RINGS
                t = (s + i / k) * atan2(0, -1) / 3
                printf "node %s %.15g %.15g %.15g\n", name(k, s, i), R * sin(phi) * cos(t), R * sin(phi) * sin(t), R * cos(phi) - R + RISE
            }
    for (k = 1; k <= RINGS; k++)
        for (s = 0; s < 6; s++)
            for (i = 0; i < k; i++) {
                member(name(k, s, i), name(k - 1, s, i))
                if (i > 0) member(name(k, s, i), name(k - 1, s, i - 1))
                member(name(k, s, i), name(k, s, i + 1))
                if (k == RINGS) print "fix " name(k, s, i) " pinned"
            }
    print "load apex 0 0 " (-LOAD)
}
