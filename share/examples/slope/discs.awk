# SPDX-License-Identifier: GPL-3.0-or-later
# awk -v t=T -f discs.awk BODIES STATE: x, y, radius, height at the start of the discs at the first row from time T on.
FNR == 1 { file++ }
file == 1 && $1 == "poly" { r[$2] = $3 }
file == 2 && $1 ~ /^[0-9]/ {
    if (!($2 in y0)) y0[$2] = $4
    if ($1 >= t - 1e-9 && !(at != "" && $1 != at)) { at = $1; print $3, $4, r[$2], y0[$2] }
}
