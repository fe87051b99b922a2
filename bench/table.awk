# SPDX-License-Identifier: GPL-3.0-or-later
# table.awk -- ROWS ROWS: the table of the ladder.  Read twice: what a row is held against may stand behind it.
#   ratio  of the cost to that of the base row of the scene, which is one thread, law patch, a tenth of the
#          critical step; of rows of threads, of the clock to that of one thread
#   bits   same where the state at the end is that of the base row, bit for bit
#   front  1 where no other step, given or found, has less cost and less error of the impulse
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
