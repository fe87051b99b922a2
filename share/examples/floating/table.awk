# SPDX-License-Identifier: GPL-3.0-or-later
# table.awk -- measured values beside closed forms; with check=1 status 1 if one is out of tolerance.
BEGIN {
    FS = "\t"
    PI = atan2(0, -1); g = 9.81; d = 900 / 1025
    printf "%-44s %12s %12s %9s\n", "", "measured", "closed form", "off"
}
{ of[$1] = $2 }
# Errors are relative; those of angles in degrees are absolute.
function row(name, what, want, tolerance, absolute,    off) {
    off = of[name] - want
    if (off < 0) off = -off
    if (!absolute) off /= want
    printf "%-44s %12.6g %12.6g %9.1e%s\n", what, of[name], want, off, check ? (off <= tolerance ? " ok" : " FAIL") : ""
    if (!(name in of) || !(off <= tolerance)) failed = 1
}
END {
    row("draft", "draft of 10 x 10 x 1 m [m]", d, 1e-5)
    row("heave", "period of heave [s]", 2 * PI * sqrt(d / g), 1e-3)
    row("heavier", "  with added mass 0.5 [s]", 2 * PI * sqrt(1.5 * d / g), 1e-3)
    # GM = I/V - BG, the moment of inertia m (b^2 + h^2)/12
    gm = 100 / (12 * d) - (1 - d) / 2
    row("roll", "period of roll [s]", 2 * PI * sqrt(101 / 12 / (g * gm)), 2e-3)
    split("1 2 5 10 20 45", heel, " ")
    split("0.02544167 0.05089983 0.11783579 0.15758834 0.17548414 0.14731391", arm, " ")
    for (k = 1; k <= 6; k++) row("GZ-" heel[k], "righting arm of 4 x 1 m at " heel[k] " deg [m]", arm[k], 1e-3)
    row("prism-0.25", "heel of a square prism, density 0.25 [deg]", atan2(1, 2) * 180 / PI, 0.05, 1)
    row("prism-0.5", "  0.5", 45, 0.1, 1)
    row("prism-0.75", "  0.75", atan2(1, 2) * 180 / PI, 0.05, 1)
    kappa = 0.5 * 0.005 * 1025 * (100 + 40 * d) / 90000
    u = 0.5 * kappa * 1000
    row("drift-v", "speed after 1000 s in 0.5 m/s [m/s]", 0.5 * u / (1 + u), 1e-5)
    row("drift-x", "  way [m]", 500 - log(1 + u) / kappa, 1e-5)
    n = split("20 30 50 70 100 150 200 400", L, " ")
    for (i = 1; i <= n; i++) {
        k = 2 * PI / L[i]; x = 5 * k
        row("wave-" L[i], "heave over a wave of " L[i] " m", sin(x) / x * exp(-k * d) / (1 - k * d) * (sin(x) < 0 ? -1 : 1), 2e-3)
    }
    exit check && failed
}
