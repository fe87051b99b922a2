# SPDX-License-Identifier: GPL-3.0-or-later
# bonds.awk -- for bonds.sh.  The first file is a plate of spheres.
#   -v speed=V             prints it with the speeds of a twist: V xy/(ab) upward, with slopes and spins of a thin plate
#   -v steps=S ours=1      then state and energy of dem-solve: prints t, kinetic and elastic energy, projection of the
#                          velocities on those of the start
#   -v row=1               a table of such rows: prints drift of the energy and frequency
FNR == 1 { file++ }
row {
    if (FNR == 1) { start = $2 + $3 } # of the first row, which is near the start
    drift = $2 + $3 > start ? ($2 + $3)/start - 1 : 1 - ($2 + $3)/start
    if (drift > most) most = drift
    if (FNR > 1 && p*$4 < 0) { at = t + ($1 - t)*p/(p - $4); if (!n++) first = at; last = at }
    t = $1; p = $4
    next
}
/^#/ && !speed { next }
file == 1 && $1 == "v" { n++; for (c = 1; c <= 3; c++) s[c] += $(c + 1); if ($2 > far) far = $2 }
file == 1 && $1 == "vel" { w[m++] = $4; all += $4*$4 }
file == 1 { next }
speed && FNR == 1 { for (c = 1; c <= 3; c++) s[c] /= n; k = speed/((far - s[1])^2) }
speed && $1 == "v" { x = $2 - s[1]; y = $3 - s[2]; z = $4 - s[3] }
speed && $1 == "vel" { printf "vel %.17g %.17g %.17g %.17g %.17g 0\n", -k*z*y, -k*z*x, k*x*y, k*x, -k*y; next }
speed { print; next }
$1 == "t[s]" { for (c = 1; c <= NF; c++) at_column[$c] = c; next }
file == 2 { q[$1] += $(at_column["vz[m/s]"])*w[$2]/all; next }
{ printf "%.9g %.9g %.9g %.9g\n", $1, $(at_column["kinetic[J]"]), $(at_column["bond[J]"]), q[$1] }
END { if (row) printf "%.2g\t%s\n", most, (n > 1) ? sprintf("%.6g", 0.5*(n - 1)/(last - first)) : "-" }
