# SPDX-License-Identifier: GPL-3.0-or-later
# Two load tables of one direction, with failures and without: angle, then for each the largest load on a leg, the
# largest and the mean on all legs along the drift [kN].
FNR == 1 { file++ }
/^#/ || /^t\[/ { next }
{
    leg = sqrt($3*$3 + $4*$4)
    if ($9 + 0 > leg) leg = $9 + 0 # the peak of the interval
    if (leg > most[file]) most[file] = leg
    if ($1 != t[file]) {
        if (sum[file] > all[file]) all[file] = sum[file]
        rows[file]++
        sum[file] = 0
        t[file] = $1
    }
    sum[file] += $3
    mean[file] += $3
}
END {
    printf "%g", angle
    for (k = 1; k <= 2; k++) printf "\t%.4g\t%.4g\t%.4g", most[k]/1e3, all[k]/1e3, mean[k]/rows[k]/1e3
    printf "\n"
}
