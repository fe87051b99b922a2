# SPDX-License-Identifier: GPL-3.0-or-later
# check.awk -- checks that the force on the panels equals that on the leg.  Status 1 if it does not.
# contacts.dat, map.tsv and pressure-area.tsv in this order.  All contacts of the leg lie between the heights, so
# the panels together have its whole force; a window of 10 m2 covers the side that faces the ice.
BEGIN { FS = "\t"; PART = -1; ROUNDING = 1e-9 }
FNR == 1 { file++ }
/^#/ { next }
file == 1 && $1 != "t[s]" {
    if ($1 != now) { if (!times++) first = $1; now = $1; at = 0 }
    if ($3 == PART && $14 > 0) { sum += $14; at += $14; if (at > most) most = at }
}
file == 2 && $1 != "panel" { push += $9 * $10; if ($13 > 0) loaded++ }
file == 3 && $1 != "part" { window = $5 > window ? $5 : window }
function check_row(what, x, y,    off) {
    off = (x > y ? x - y : y - x) / y
    printf "%s %.6g N, %.6g N from the contacts: off by %.1e %s\n", what, x, y, off, off < ROUNDING ? "ok" : "FAIL"
    if (!(off < ROUNDING)) failed = 1
}
END {
    step = 0.02
    check_row("mean on the panels    ", push, sum / int((now - first) / step + 1.5))
    check_row("largest on the window ", window, most)
    exit failed
}
