# SPDX-License-Identifier: GPL-3.0-or-later
# Results of arc-path beside reference.dat: each in its unit, with the difference.
function row(what, unit, x, is)
{
    d = x / is - 1
    if (d > 0.002 || d < -0.002) bad = 1
    printf "%-44s %10.4f %10.4f %s %+.3f %%\n", what, x, is, unit, 100 * d
}
BEGIN { printf "%-44s %10s %10s\n", "", "members", "beam" }
FNR == 1 { n = split(FILENAME, part, "/"); file = part[n]; sub(/\.tsv$/, "", file) }
file == "reference.dat" && /^[a-z]/ { for (k = 2; k <= NF; k++) want[$1, k - 1] = $k }
file == "modes" && /^[1-3]\t/ { row("frequency of mode " $1, "Hz", $2, want["modes", $1]) }
/^#/ { next }
file ~ /^push/ && !head[file]++ { for (k = 1; k <= NF; k++) column[file, $k] = k; next }
file ~ /^push/ { last[file] = $0 }
END {
    for (way = 0; way < 2; way++) {
        f = way ? "push-y" : "push-x"
        split(last[f], x)
        axis = way ? "y" : "x"
        for (c = 1; c <= 2; c++)
            row("corner 2" c ", 250 kN a corner along " axis, "mm", x[column[f, "2" c "." axis]] * 1e6, want[f, c])
    }
    exit bad
}
