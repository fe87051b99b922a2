# SPDX-License-Identifier: GPL-3.0-or-later
# A row of the table [kN]: mean resistance between `from` and `to` metres of way and in both halves of that part, the
# largest mean of 1 s, the lift over the mean; Lindqvist's crushing, bending, submersion and sum, Riska's sum; the mean over
# that of both sums.
function pascal(x) { return x*(x ~ /GPa/ ? 1e9 : x ~ /MPa/ ? 1e6 : x ~ /kPa/ ? 1e3 : 1) }
/^[0-9]/ {
    t = $1; if (t*v < from || t*v > to) next
    n++; x[n] = $3; z += $5; sum += $3; run += $3
    if (n > 50) run -= x[n - 50]
    if (n >= 50 && run/50 > most) most = run/50
}
END {
    if (head) {
        print "h[m]\tv[m/s]\tmean[kN]\tfirst_half\tsecond_half\tmost_1s\tlift/mean\tRc\tRb\tRs\tLindqvist\tRiska\tmean/both"
        exit
    }
    deg = atan2(0, -1)/180; phi *= deg; al *= deg; s = pascal(flexural); E = pascal(young)
    for (k = 1; k <= int(n/2); k++) half += x[k]
    bow = B/2/tan(al)
    for (k = 0; k < 4; k++) R[k] = lindqvist(k, h, v, L, B, T, phi, al, mu, s, E)/1e3
    S = riska(h, v, L, B, T, phi, bow, L - bow)/1e3
    m = sum/n/1e3
    printf "%g\t%g\t%.0f\t%.0f\t%.0f\t%.0f\t%.2f\t%.0f\t%.0f\t%.0f\t%.0f\t%.0f\t%.2f\n", h, v, m, half/int(n/2)/1e3, \
        (sum - half)/(n - int(n/2))/1e3, most/1e3, z/sum, R[1], R[2], R[3], R[0], S, m/(0.5*(R[0] + S))
}
