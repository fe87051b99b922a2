# SPDX-License-Identifier: GPL-3.0-or-later
# Of each leg: bearing from the middle of the rig against the drift (0 in front, 180 behind), turn, largest and mean load
# along the drift [kN], and that mean over the mean of all three.  A leg's record starts when the front of the sheet, as
# if nothing had held it, reaches the leg, and is as long for all three: to `end` for the last one.
#   r: distance of the legs from the middle, ahead: way of the sheet to the first leg [m]; v: speed of the ice
function bearing(k,    a) { a = turn + (k == 1 ? 0 : k == 2 ? 120 : -120); a = a < 0 ? -a : a; return a > 180 ? 360 - a : a }
BEGIN {
    for (k = 1; k <= 3; k++) { x[k] = -r*cos(bearing(k)*atan2(0, -1)/180); if (k == 1 || x[k] < first) first = x[k] }
    for (k = 1; k <= 3; k++) { from[k] = (x[k] - first + ahead)/v; if (from[k] > latest) latest = from[k] }
    window = end - latest
}
/^[0-9]/ { k = substr($2, 4); if ($1 < from[k] || $1 > from[k] + window) next; n[k]++; sum[k] += $3; if ($3 > most[k]) most[k] = $3 }
END {
    for (k = 1; k <= 3; k++) if (n[k]) all += sum[k]/n[k]/3
    for (k = 1; k <= 3; k++)
        if (n[k]) printf "%g\t%g\tleg%d\t%.1f\t%.2f\t%.2f\n", bearing(k), turn, k, most[k]/1e3, sum[k]/n[k]/1e3, sum[k]/n[k]/all
}
