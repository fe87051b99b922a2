# SPDX-License-Identifier: GPL-3.0-or-later
# stats.awk -- one line for each run, from its loads: awk -f stats.awk fixed.tsv towed.tsv free.tsv
function close_run() {
    if (rows) printf "%-8s %9.2f %9.2f %9.1f %9.1f %9.3f %9.3f %8.2f %8.2f\n", run, ix / t / 1e3, iy / t / 1e3, peak / 1e3,
                     most / 1e3, surge, sway, roll, yaw
}
function size(x) { return x < 0 ? -x : x }
BEGIN {
    print "         mean of the load   largest load     largest displacement and rotation"
    print "run        fx[kN]    fy[kN]  20ms[kN] step[kN]  surge[m]   sway[m] roll[deg] yaw[deg]"
}
FNR == 1 {
    close_run()
    run = FILENAME; sub(/.*\//, "", run); sub(/\.tsv$/, "", run)
    ix = iy = peak = most = surge = sway = roll = yaw = rows = t = 0
}
/^#/ { next }
$1 == "t[s]" { split("", column); for (c = 1; c <= NF; c++) column[$c] = c; next }
{
    h = $1 - t; t = $1; rows++
    ix += $3 * h; iy += $4 * h
    f = sqrt($3 * $3 + $4 * $4)
    if (f > peak) peak = f
    if ($column["fpeak[N]"] > most) most = $column["fpeak[N]"]
    if (run != "free") next
    if (size($column["ux[m]"]) > surge) surge = size($column["ux[m]"])
    if (size($column["uy[m]"]) > sway) sway = size($column["uy[m]"])
    if (size($column["rx[deg]"]) > roll) roll = size($column["rx[deg]"])
    if (size($column["rz[deg]"]) > yaw) yaw = size($column["rz[deg]"])
}
END { close_run() }
