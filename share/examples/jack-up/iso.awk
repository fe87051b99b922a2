# SPDX-License-Identifier: GPL-3.0-or-later
# A vertical pile in crushing ice: loads of a run beside ISO 19906 (2010), A.8.2.4.3,
#     p = C_R (h/1 m)^n (w/h)^-0.16,   n = -0.5 + h/5 below 1 m, -0.3 from there on,   F = p w h.
#   awk -v h=0.5 -v w=1.2 -v v=0.5 -f iso.awk loads.tsv
# The first contact, until the ice has drifted by half of the width of the pile, has a line of its own.  h, w: thickness,
# width [m]; v: speed [m/s]
function crushing(CR, h, w) { return CR*exp((h < 1 ? -0.5 + h/5 : -0.3)*log(h))*exp(-0.16*log(w/h)) }
/^[0-9]/ {
    if ($3 > first && !(touch && $1 - touch > 0.5*w/v)) first = $3
    if (!touch && $3 != 0) touch = $1
    if (!touch || $1 - touch < 0.5*w/v) next
    n++; x = $3; sum += x; sum2 += x*x; up += $5
    if (x > most) most = x
    line[n] = x; run += x; if (n > 100) run -= line[n - 100]
    if (n >= 100 && run/100 > second) second = run/100
}
END {
    printf "ISO 19906, C_R 1.8, 2.2, 2.8 MPa       %8.0f, %.0f, %.0f kN\n", crushing(1.8e6, h, w)*w*h/1e3, \
        crushing(2.2e6, h, w)*w*h/1e3, crushing(2.8e6, h, w)*w*h/1e3
    if (!n) exit
    m = sum/n
    printf "largest load at the first contact      %8.0f kN\n", first/1e3
    printf "largest load after it, means of 10 ms  %8.0f kN, over that of C_R 1.8 MPa %.2f\n", most/1e3, \
        most/(crushing(1.8e6, h, w)*w*h)
    printf "largest mean of 1 s                    %8.0f kN\n", second/1e3
    printf "mean over the largest                  %8.3f, of records of crushing 0.25 to 0.5\n", m/most
    printf "deviation over the mean                %8.2f\n", sqrt(sum2/n - m*m)/m
    printf "upward over along, of the means        %8.3f\n", up/sum
}
