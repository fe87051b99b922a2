# SPDX-License-Identifier: GPL-3.0-or-later
# The load on the cone by Croasdale's formula, ISO 19906 A.8.2.4.4, for three frictions; and what was measured and
# published.  h 0.23 m, D 2.85 m, 60 degrees, rubble one layer of 40 degrees, porosity 0.3.
function tan(x) { return sin(x)/cos(x) }
function croasdale(mu, s,    pi, a, h, D, E, rw, ri, g, hr, p, t, ph, mi, xi, Lc, lc, HB, k, HP, HL, P, HR, HT) {
    pi = 3.14159265358979; a = pi/3; h = 0.23; D = 2.85; E = 1e9; rw = 1035; ri = 900; g = 9.80665
    hr = h; p = 0.3; t = tan(40*pi/180); ph = pi/4; mi = 0.05
    xi = (sin(a) + mu*cos(a))/(cos(a) - mu*sin(a)); Lc = (E*h^3/(12*rw*g*0.91))^0.25; lc = D + pi*pi*Lc/4
    HB = 0.68*xi*s*(rw*g*h^5/E)^0.25*lc; k = 1 - t/tan(a)
    HP = D*hr*hr*mi*ri*g*(1 - p)*k*k/(2*t)
    HL = D*hr*xi*k*(0.5*hr*ri*g*(1 - p)*(1/t - 1/tan(a) + tan(ph)*k))
    P = 0.5*mi*(mi + mu)*ri*g*(1 - p)*hr*hr*sin(a)*(1/t - 1/tan(a))*k \
        + 0.5*(mi + mu)*ri*g*(1 - p)*hr*hr*cos(a)/tan(a)*k + hr*h*ri*g*(sin(a) + mu*cos(a))/sin(a)
    HR = D*P/(cos(a) - mu*sin(a)); HT = 1.5*D*h*h*ri*g*cos(a)/(sin(a) - mu*cos(a))
    return (HB + HP + HR + HL + HT)/(1 - HB/(s*lc*h))
}
BEGIN {
    s = flexural + 0; if (flexural ~ /MPa/) s *= 1e6; else if (flexural ~ /kPa/) s *= 1e3
    printf "\nmeasured at the platform               %7.1f kN, period 1.7 s, breaking length 0.73 m\n", 117
    printf "computed in the paper                  %7.1f kN, period 1.9 s\n", 124
    printf "Croasdale, friction 0.05, 0.10, 0.15   %7.1f, %.1f, %.1f kN\n\n", croasdale(0.05, s)/1e3,
        croasdale(0.10, s)/1e3, croasdale(0.15, s)/1e3
}
