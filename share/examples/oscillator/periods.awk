# SPDX-License-Identifier: GPL-3.0-or-later
# periods.awk -- one row of the target periods: stats of ux, and the response to the load at rest.
BEGIN { FS = "\t" }
FNR == 1 { file++ }
/^#/ { next }
$1 == "part" {
    for (k = 1; k <= NF; k++) { name = $k; sub(/\[.*/, "", name); at[name] = k }
    next
}
file == 1 { x = $at["max"] > -$at["min"] ? $at["max"] : -$at["min"] }
file == 2 { printf "%s\t%.1f\t%.1f\n", T, 1e3 * x, 1e3 * $at["x_max"] }
