# SPDX-License-Identifier: GPL-3.0-or-later
# check.awk -- report and table of bonds of a run, in this order.  Status 1 if a check fails.
#   - The energy ledger closes, the impulses of contacts cancel, and overlaps stay small.
#   - Damage never decreases, and no face becomes whole again.
# Prints the fracture energy over the damaged area: sigma^2 l/2E is 75 to 165 J/m2 for cells of 0.6 to
# 1.3 m in tension, more in shear.
FNR == 1 { file++ }
file == 1 && /^energy residual/ { residual = $3 }
file == 1 && /^momentum residual/ { momentum = $3 }
file == 1 && /^largest overlap/ { overlap = $3 }
file == 1 && /^bonds/ { all = $9 + 0; taken = $(NF - 1) }
file == 2 && !/^#/ && $1 != "t[s]" {
    face = $2 " " $3
    if ($5 < damage[face] - 1e-12) fell++
    damage[face] = $5
    area[face] = $9
}
function check_row(what, off, bound) {
    printf "%-64s %.2g, at most %g  %s\n", what, off, bound, off <= bound ? "ok" : "FAIL"
    if (!(off <= bound)) failed = 1
}
END {
    for (face in area) { faces++; cracked += damage[face] * area[face] }
    check_row("residual of the ledger over the throughput", residual, 1e-4)
    check_row("residual of momentum over the impulses of contacts", momentum, 1e-12)
    check_row("largest overlap over the radii", overlap, 0.5)
    check_row("faces whose damage fell", fell + 0, 0)
    check_row("faces in the table less those of the report", faces > all ? faces - all : all - faces, 0)
    takes = cracked > 0 ? taken / cracked : 0
    printf "%-64s %.0f J/m2\n", "fracture energy over the area of damage", takes
    exit failed
}
