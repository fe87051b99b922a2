# SPDX-License-Identifier: GPL-3.0-or-later
# reports.awk -- checks the reports of all runs; status 1 if one is out of bounds.
FNR == 1 { runs++ }
/^energy residual/ && $3 > energy { energy = $3 }
/^momentum residual/ && $3 > momentum { momentum = $3 }
/^largest overlap/ && $3 > overlap { overlap = $3 }
/^step over critical/ && $4 > ratio { ratio = $4 }
function row(what, value, bound) {
    printf "%-44s %10.2g   < %-8g %s\n", what, value, bound, value < bound ? "ok" : "FAIL"
    if (!(value < bound)) failed = 1
}
END {
    if (!runs) { print "reports.awk: no reports" >"/dev/stderr"; exit 3 }
    print "worst of " runs " runs"
    row("energy residual over throughput", energy, 0.01)
    row("momentum residual over contact impulses", momentum, 1e-12)
    row("largest overlap over radius", overlap, 0.3)
    row("step over critical step", ratio, 0.5)
    exit failed
}
