# SPDX-License-Identifier: GPL-3.0-or-later
# Loads of each leg: largest values, means over the record, and means since the ice first touched it [kN].
/^[0-9]/ {
    p = $2
    if (!(p in n)) name[++legs] = p
    n[p]++
    for (k = 0; k < 3; k++) {
        f = $(3 + k); a = f < 0 ? -f : f
        if (a > most[p, k]) most[p, k] = a
        sum[p, k] += f
    }
    if (!(p in since) && ($3 != 0 || $4 != 0 || $5 != 0)) { since[p] = $1; before[p] = n[p] - 1 }
}
END {
    print "leg\tfirst touch [s]\tmax Fx\tmax Fy\tmax Fz\tmean Fx\tmean Fy\tmean Fz\tFx since touch"
    for (k = 1; k <= legs; k++) {
        p = name[k]
        if (!(p in since)) { printf "%s\tnever\n", p; continue }
        printf "%s\t%.2f\t%.1f\t%.1f\t%.1f\t%.2f\t%.2f\t%.2f\t%.2f\n", p, since[p], most[p, 0]/1e3, most[p, 1]/1e3, \
            most[p, 2]/1e3, sum[p, 0]/n[p]/1e3, sum[p, 1]/n[p]/1e3, sum[p, 2]/n[p]/1e3, sum[p, 0]/(n[p] - before[p])/1e3
    }
    print "\npaper, leg 1, 2, 3: max Fx 1475, 1001, 1050; Fy 1261, 738, 503; Fz 162, 103, 131; mean Fx 79, 44, 36; Fy 28, 33, -12; Fz 1.1, -4.1, -2.5"
}
