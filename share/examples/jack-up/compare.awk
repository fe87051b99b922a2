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
    print "\npaper, leg 1, 2, 3: max Fx 1475, 1001, 1050; Fy 1261, 738, 503; Fz 162, 103, 131"
    print "mean Fx 79, 44, 36; Fy 28, 33, -12; Fz 1.1, -4.1, -2.5"
    # order, ratios and signs: leg 1 in front, legs 2 (y < 0) and 3 (y > 0) behind
    if (legs < 3 || !((name[2]) in since) || !((name[3]) in since)) exit
    a = name[1]; b = name[2]; c = name[3]
    printf "\nlargest Fx of leg 1 over legs 2, 3      %.2f, %.2f   paper 1.47, 1.40\n", most[a, 0]/most[b, 0], most[a, 0]/most[c, 0]
    printf "mean Fx of leg 1 over legs 2, 3         %.2f, %.2f   paper 1.79, 2.18\n", sum[a, 0]/sum[b, 0], sum[a, 0]/sum[c, 0]
    printf "the same, each since its first touch    %.2f, %.2f\n", sum[a, 0]/(n[a] - before[a])/(sum[b, 0]/(n[b] - before[b])), \
        sum[a, 0]/(n[a] - before[a])/(sum[c, 0]/(n[c] - before[c]))
    printf "mean Fy of legs 2, 3 [kN]               %.2f, %.2f   paper 33, -12: inward\n", sum[b, 1]/n[b]/1e3, sum[c, 1]/n[c]/1e3
    printf "leg 1: largest Fy, Fz over largest Fx   %.2f, %.2f   paper 0.85, 0.11\n", most[a, 1]/most[a, 0], most[a, 2]/most[a, 0]
    printf "leg 1: mean Fz over mean Fx             %.3f        paper 0.014\n", sum[a, 2]/sum[a, 0]
}
