# SPDX-License-Identifier: GPL-3.0-or-later
# hull.awk -- a quarter of a barge with raked ends as a WAMIT geometric data file: panels of the wetted surface for
# x >= 0, y >= 0, wound so that normals point into the water. Written here, after no real ship: 40 m long, 10 m wide,
# 2.5 m draft, bow and stern raked at 45 degrees over the draft.
# -v L= -v B= -v T= [m]; -v N= panels along the quarter.
function corner(x, y, z) { printf "%.6f %.6f %.6f\n", x, y, z }
function panel(x1, y1, z1, x2, y2, z2, x3, y3, z3, x4, y4, z4) {
    corner(x1, y1, z1); corner(x2, y2, z2); corner(x3, y3, z3); corner(x4, y4, z4)
}
BEGIN {
    X = L / 2; Y = B / 2; M = 4; K = 3
    print "A raked barge, a quarter of it"
    print "1.0 9.80665   ULEN GRAV"
    print "1 1   ISX ISY"
    printf "%d   NPAN\n", N * K + N * M + K * M
    for (i = 0; i < N; i++) # side: its forward end leans with the rake
        for (k = 0; k < K; k++) {
            z1 = -T * k / K; z2 = -T * (k + 1) / K
            panel((X + z1) * (i + 1) / N, Y, z1, (X + z2) * (i + 1) / N, Y, z2, (X + z2) * i / N, Y, z2, (X + z1) * i / N, Y, z1)
        }
    for (i = 0; i < N; i++) # bottom
        for (j = 0; j < M; j++)
            panel((X - T) * i / N, Y * j / M, -T, (X - T) * i / N, Y * (j + 1) / M, -T,
                (X - T) * (i + 1) / N, Y * (j + 1) / M, -T, (X - T) * (i + 1) / N, Y * j / M, -T)
    for (k = 0; k < K; k++) # rake
        for (j = 0; j < M; j++) {
            z1 = -T * k / K; z2 = -T * (k + 1) / K
            panel(X + z1, Y * j / M, z1, X + z2, Y * j / M, z2, X + z2, Y * (j + 1) / M, z2, X + z1, Y * (j + 1) / M, z1)
        }
}
