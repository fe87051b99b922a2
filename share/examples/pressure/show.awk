# SPDX-License-Identifier: GPL-3.0-or-later
# show.awk -- the tables pressure-area and line-load in kPa and kN/m, loaded rows only.
BEGIN { FS = "\t" }
/^#/ { next }
$1 == "part" { printf "%10s %12s %12s %10s %12s\n", "area [m2]", "max [kPa]", "mean [kPa]", "at [s]", "fit [kPa]"; next }
$1 == "from[m]" { printf "\n%10s %12s %12s %10s %12s\n", "along [m]", "max [kN/m]", "mean [kN/m]", "at [s]", "loaded"; line = 1; next }
line && $6 > 0 { printf "%10.3f %12.4g %12.4g %10.2f %11.1f%%\n", ($1 + $2) / 2, $6 / 1e3, $5 / 1e3, $7, 100 * $8 }
!line { printf "%10g %12.4g %12.4g %10.2f %12.4g\n", $2, $3 / 1e3, $4 / 1e3, $6, $11 / 1e3 }
