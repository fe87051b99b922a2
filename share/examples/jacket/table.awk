# SPDX-License-Identifier: GPL-3.0-or-later
# Mean, deviation and extremes of each signal, in kN, mm and m/s2.
BEGIN { FS = "\t"; printf "%-8s %-4s %12s %12s %12s %12s\n", "part", "", "mean", "deviation", "least", "largest" }
/^#/ || $1 == "part" { next }
{
    scale = $3 == "N" ? 1e-3 : $3 == "m" ? 1e3 : 1
    unit = $3 == "N" ? "kN" : $3 == "m" ? "mm" : $3
    printf "%-8s %-4s %12.4f %12.4f %12.4f %12.4f %s\n", $1, $2, scale * $8, scale * $9, scale * $12, scale * $13, unit
}
