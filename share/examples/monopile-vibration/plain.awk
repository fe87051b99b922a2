# SPDX-License-Identifier: GPL-3.0-or-later
# plain.awk -- columns closing[m/s], the speed of the ice of ramp.awk, and breaks, 1, to loads of the plain law.
/^#/ { print; next }
$1 == "t[s]" { print $0 "\tclosing[m/s]\tbreaks"; next }
{ u = $1 < T ? $1 : 2 * T - $1; printf "%s\t%.6g\t1\n", $0, v0 + (v1 - v0) * u / T }
