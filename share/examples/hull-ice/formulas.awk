# SPDX-License-Identifier: GPL-3.0-or-later
# Resistance of a ship in level ice [N], by Lindqvist (POAC 1989) and by Riska et al. (Winter Navigation Research Board,
# report 52, 1997).  Lengths in m; phi: stem from the horizontal, al: waterline from the axis [rad]; s: flexural strength,
# E: modulus [Pa]; bow, parallel: lengths of the bow and of the parallel part.
function tan(x) { return sin(x)/cos(x) }
# part: 1 crushing at the stem, 2 bending, 3 submersion, each with its factor of speed; 0 their sum
function lindqvist(part, h, v, L, B, T, phi, al, mu, s, E,    g, rw, ri, psi, m, c, b, d) {
    g = 9.81; rw = 1025; ri = 900; psi = atan2(tan(phi), sin(al))
    m = mu*cos(phi)/cos(psi)
    c = 0.5*s*h*h*(tan(phi) + m)/(1 - mu*sin(phi)/cos(psi))*(1 + 1.4*v/sqrt(g*h))
    b = 27/64*s*B*h^1.5/sqrt(E/(12*0.91*g*rw))*(tan(psi) + m/sin(al))*(1 + 1/cos(psi))*(1 + 1.4*v/sqrt(g*h))
    d = (rw - ri)*g*h*B*(T*(B + T)/(B + 2*T) + mu*(0.7*L - T/tan(phi) - B/(4*tan(al)) + \
        T*cos(phi)*cos(psi)*sqrt(1/sin(phi)^2 + 1/tan(al)^2)))*(1 + 9.4*v/sqrt(g*L))
    return part == 1 ? c : part == 2 ? b : part == 3 ? d : c + b + d
}
function riska(h, v, L, B, T, phi, bow, parallel,    deg) {
    deg = phi*180/atan2(0, -1)
    return 1e3*(0.23*B*parallel*h/(2*T/B + 1) + (1 + 0.021*deg)*(4.58*B*h*h + 1.47*bow*h*h + 0.29*B*bow*h) + \
        v*((1 + 0.063*deg)*(18.9*h^1.5 + 0.67*B*h) + 1.55*h*(1 + 1.2*T/B)*B*B/sqrt(L)))
}
