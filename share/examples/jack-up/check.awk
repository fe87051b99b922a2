# SPDX-License-Identifier: GPL-3.0-or-later
# Energy and momentum close; lifts are small against loads along the drift, as on a vertical structure.
function say(ok, what) { print (ok ? "ok   " : "FAIL ") what; bad += !ok }
/^energy residual/ { say($3 < 1e-3, "energy residual " $3 " of the throughput") }
/^momentum residual/ { say($3 < 1e-12, "momentum residual " $3) }
/^bonds/ { say($6 > 0, $6 " bonds broken") }
/^[0-9]/ { x += $3; z += $5; if ($3 > most) most = $3; if ($5 > up) up = $5; if (-$5 > up) up = -$5 }
END {
    say(most > 0, "largest load along the drift " most/1e3 " kN")
    say(up < 0.3*most, "largest vertical load over it " up/most)
    exit bad > 0
}
