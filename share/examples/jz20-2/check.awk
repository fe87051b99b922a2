# SPDX-License-Identifier: GPL-3.0-or-later
# Energy and momentum close, bonds break, no load is missing for more than 3 s, and pieces are pushed down.
function say(ok, what) { print (ok ? "ok   " : "FAIL ") what; bad += !ok }
/^energy residual/ { say($3 < 1e-3, "energy residual " $3 " of the throughput") }
/^momentum residual/ { say($3 < 1e-12, "momentum residual " $3) }
/^bonds/ { say($6 > 0, $6 " bonds broken") }
/^[0-9]/ { if ($3 > 1000) last = $1; if ($3 > 1000 && !started) started = $1; if (started && $1 - last > gap) gap = $1 - last; up += $5; x += $3 }
END {
    say(gap < 3, "longest time without load " gap " s")
    say(up/x < -0.3 && up/x > -0.8, "upward over along " up/x)
    exit bad > 0
}
