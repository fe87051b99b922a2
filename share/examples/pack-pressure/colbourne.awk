# SPDX-License-Identifier: GPL-3.0-or-later
# colbourne.awk -- R = 0.5 C_p rho B h v^2 C^n, C_p = k Fp^b, Fp = v/sqrt(g h C): Colbourne (2000), blunt bow.
BEGIN {
    B = 70; h = 1; v = 0.3; rho = 900
    for (C = 0.6; C < 0.95; C += 0.1)
        printf "Colbourne, blunt, C %.1f   %.2f MN\n", C, 0.5 * 16.1 * (v / sqrt(9.81 * h * C)) ^ -1.7937 * rho * B * h * v * v * C ^ 3 / 1e6
}
