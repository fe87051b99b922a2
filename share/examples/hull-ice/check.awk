# SPDX-License-Identifier: GPL-3.0-or-later
# Energy and momentum close in each run; bonds break; the resistance rises with speed and thickness.
function say(ok, what) { print (ok ? "ok   " : "FAIL ") what; bad += !ok }
/^energy residual/ { say($3 < 1e-3, "energy residual " $3 " of the throughput") }
/^momentum residual/ { say($3 < 1e-12, "momentum residual " $3) }
/^bonds/ { say($6 > 0, $6 " bonds broken") }
/^[0-9]/ {
    if (h == $1 && $2 > v) say($3 > m, "h " $1 " m: " $3 " kN at " $2 " m/s, " m " kN at " v " m/s")
    if (($2) in thin) say($3 > thin[$2], $2 " m/s: " $3 " kN in " $1 " m, " thin[$2] " kN in thinner ice")
    h = $1; v = $2; m = $3; thin[$2] = $3
    say($7 > 0, "lifted by " $7 " of the resistance")
}
END { exit bad > 0 }
