# SPDX-License-Identifier: GPL-3.0-or-later
# table.awk -- ROWS ROWS: the table of the ladder.  The rows are read twice, since the base row may come later.
#   ratio  cost over that of the base row of the scene: one thread, law patch, 0.1 of the critical step; for rows
#          of threads, wall time over that of one thread
#   bits   same if the state at the end equals that of the base row bit for bit
#   front  1 if no other step, given or found, has less cost and less error of the impulse
BEGIN {
    FS = OFS = "\t"
    print "scene", "setting", "value", "law", "threads", "bodies", "dt[s]", "steps", "contacts",
        "cost[s/s]", "wall[s/s]", "body_step[ns]", "contact_step[ns]", "impulse", "peak", "motion", "energy",
        "overlap", "hash", "ratio", "bits", "front"
}
NR == FNR {
    if ($2 == "step" && $3 == 0.1) { cost[$1] = $10; hash[$1] = $19 }
    if ($2 == "threads" && $3 == 1) wall[$1] = $11
    if (($2 == "step" || $2 == "error") && $14 != "-") { n[$1]++; c[$1, n[$1]] = $10; e[$1, n[$1]] = $14 }
    next
}
{
    ratio = bits = front = "-"
    if ($10 != "-") {
        ratio = $2 == "threads" ? sprintf("%.3g", $11 / wall[$1]) : sprintf("%.3g", $10 / cost[$1])
        if ($2 == "threads" || $2 == "skin" || $2 == "width") bits = $19 == hash[$1] ? "same" : "other"
        if (($2 == "step" || $2 == "error") && $14 != "-") {
            front = 1
            for (k = 1; k <= n[$1]; k++)
                if (c[$1, k] <= $10 && e[$1, k] <= $14 && (c[$1, k] < $10 || e[$1, k] < $14)) front = 0
        }
    }
    print $0, ratio, bits, front
}
