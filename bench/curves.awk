# SPDX-License-Identifier: GPL-3.0-or-later
# curves.awk -- ladder.tsv as named blocks for gnuplot, curve.scene.  Each block begins with a point far outside of
# the plot, since gnuplot rejects empty blocks.
function open_block(b) { order[++blocks] = b; row[b, n[b] = 1] = "1e-9\t1e-9\n" }
function put(b, line) { row[b, ++n[b]] = line }
BEGIN { FS = "\t"; open_block("bodies"); open_block("spheres") }
/^#/ || $1 == "scene" { next }
!($1 in seen) {
    seen[$1] = 1
    split("step error core manual-si front threads", all, " ")
    for (k = 1; k <= 6; k++) open_block(all[k] "." $1)
}
$10 == "-" { next }
($2 == "step" || $2 == "error" || $2 == "law") && $14 != "-" {
    put(($2 == "law" ? $4 : $2) "." $1, $20 "\t" 100 * ($14 > 1e-7 ? $14 : 1e-7) "\t" $3)
    if ($22 == 1) put("front." $1, $20 "\t" 100 * ($14 > 1e-7 ? $14 : 1e-7))
}
$2 == "step" && $1 ~ /^(field|pack)/ && $3 == 0.2 { put($1 ~ /^field/ ? "bodies" : "spheres", $6 "\t" $12 "\t" $13) }
$2 == "threads" { put("threads." $1, $5 "\t" (1 / $20)) }
END {
    for (i = 1; i <= blocks; i++) {
        b = order[i]
        for (k = 3; k <= n[b]; k++) # the front is sorted by cost
            for (j = k; b ~ /^front/ && j > 2 && row[b, j] + 0 < row[b, j - 1] + 0; j--) {
                s = row[b, j]
                row[b, j] = row[b, j - 1]
                row[b, j - 1] = s
            }
        print "# " b ";" # so that no name is the beginning of another
        for (k = 1; k <= n[b]; k++) print row[b, k]
        printf "\n\n"
    }
}
