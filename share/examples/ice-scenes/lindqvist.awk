# SPDX-License-Identifier: GPL-3.0-or-later
# Resistance of the hull in level ice by Lindqvist (1989): crushing, bending and submersion [kN] at the speed v,
# beside mean and peak of the load table from `from` on, and the work of crushing in the report over the way.
function tan(x) { return sin(x)/cos(x) }
BEGIN {
    pi = atan2(0, -1); g = 9.81; rho_w = 1025; rho_i = 900; nu = 0.3; E = 2e9; sf = 0.5e6; mu = 0.1; h = 0.5
    L = 75; B = 17.2; T = 8; phi = atan2(12, 16); al = atan2(8.6, 20)
    psi = atan2(tan(phi), sin(al))
    Rc = 0.5*sf*h*h*(tan(phi) + mu*cos(phi)/cos(psi))/(1 - mu*sin(phi)/cos(psi))
    Rb = 27/64*sf*B*h^1.5/sqrt(E/(12*(1 - nu*nu)*g*rho_w))*(tan(psi) + mu*cos(phi)/(cos(psi)*sin(al)))*(1 + 1/cos(psi))
    Rs = (rho_w - rho_i)*g*h*B*(T*(B + T)/(B + 2*T) + mu*(0.7*L - T/tan(phi) - B/(4*tan(al)) + \
         T*cos(phi)*cos(psi)*sqrt(1/sin(phi)^2 + 1/tan(al)^2)))
    Rc *= 1 + 1.4*v/sqrt(g*h); Rb *= 1 + 1.4*v/sqrt(g*h); Rs *= 1 + 9.4*v/sqrt(g*L)
}
FILENAME ~ /txt$/ { if (/^crushing/) work = $7; if (/^broken/) { bent = $3; split_ = $5 } next }
/^[0-9]/ && $1 >= from { n++; s -= $3; t = $1; if (-$3 > p) p = -$3 }
END {
    printf "%g\t%.1f\t%.0f\t%.2f\t%d\t%d\t%.1f\t%.1f\t%.1f\n", v, s/n/1e3, p/1e3, work/(v*(t - from))/1e3, bent, split_, \
        Rc/1e3, Rb/1e3, Rs/1e3
}
