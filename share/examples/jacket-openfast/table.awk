# SPDX-License-Identifier: GPL-3.0-or-later
# Loads of the ice on each part, and the section forces at the foundation: the clamped ends of the model of members.
FILENAME ~ /members$/ && $1 == "fix" { held[$2] = 1 }
FILENAME ~ /members$/ && $1 == "member" { end[$2] = ($3 in held) ? "i" : ($4 in held) ? "j" : ""; order[++n] = $2
    from[$2] = $3; to[$2] = $4 }
FILENAME ~ /stats/ && !/^#/ && $1 != "part" {
    if (!head++) printf "%-18s %-3s %12s %12s\n", "ice on", "", "mean", "largest kN"
    printf "%-18s %-3s %12.2f %12.2f\n", $1, $2, $8 / 1e3, $13 / 1e3
}
FILENAME ~ /members.dat$/ && !/^#/ {
    if ($1 == "t[s]") { for (k = 1; k <= NF; k++) { sub(/\[.*/, "", $k); col[$k] = k } next }
    m = $col["member"]
    b = $col["my"]^2 + $col["mz"]^2
    a = $col["fx"] < 0 ? -$col["fx"] : $col["fx"]
    if (b > moment[m]) moment[m] = b
    if (a > axial[m]) axial[m] = a
}
END {
    print ""
    printf "%-18s %12s %16s\n", "foundation", "axial kN", "bending kN m"
    for (k = 1; k <= n; k++) {
        m = order[k]
        if ((from[m] in held) || (to[m] in held)) printf "%-18s %12.2f %16.2f\n", m, axial[m] / 1e3, sqrt(moment[m]) / 1e3
    }
}
