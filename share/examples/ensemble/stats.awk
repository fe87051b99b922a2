# SPDX-License-Identifier: GPL-3.0-or-later
# stats.awk -- rows of the table stats for all runs together, forces in kN.
BEGIN { FS = "\t" }
/^#/ { next }
$1 == "part" { for (k = 1; k <= NF; k++) col[$k] = k; next }
{
    printf "all runs, %s: %d rows, mean %.4g, std %.4g, skew %.3g, 99 %% of the time below %.4g, largest %.4g kN\n", $2,
        $col["rows"], $col["mean"] / 1000, $col["std"] / 1000, $col["skew"], $col["q0.99"] / 1000, $col["max"] / 1000
}
