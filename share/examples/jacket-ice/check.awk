# SPDX-License-Identifier: GPL-3.0-or-later
# Energy and momentum close, floes crush and break, and no leg bears more than ice of its width can: 2 MPa on 0.5 m x 1.5 m.
function say(ok, what) { print (ok ? "ok   " : "FAIL ") what; bad += !ok }
/^energy residual/ { say($3 < 1e-3, "energy residual " $3 " of the throughput") }
/^momentum residual/ { say($3 < 1e-12, "momentum residual " $3) }
/^crushing/ { say($2 > 0, $2 " m3 of ice crushed") }
/^broken floes/ { say($3 + $5 > 0, $3 " bent, " $5 " split") }
/^[0-9]/ { if ($9 > most) most = $9 }
END {
    say(most > 0 && most < 1.15 * 2e6 * 0.75^0.9, "largest load on a leg " most/1e3 " kN")
    exit bad > 0
}
