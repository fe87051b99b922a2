# SPDX-License-Identifier: GPL-3.0-or-later
# levels.awk -- the table levels of loadstats, aligned: return levels in kN, periods in minutes.
BEGIN { FS = "\t" }
/^#/ || $1 == "part" { next }
!n++ { printf "%-10s %6s %-10s %8s %9s %21s\n", "", "runs", "law", "period", "level", "95 % interval" }
function kilo(x) { return x == "-" ? "-" : sprintf("%.4g", x / 1000) }
{ printf "%-10s %6d %-10s %8g %9s %10s %10s\n", $1 " " $2, $6, $7, $8 / 60, kilo($9), kilo($12), kilo($13) }
END {
    if (!n) { print "levels.awk: no rows" >"/dev/stderr"; exit 3 }
    print "load in kN that is exceeded once in the period [min], by the laws of the largest load of a run"
}
