# SPDX-License-Identifier: GPL-3.0-or-later
# Block, force of Goodman and Bray, of the program with a toe that gives way and with a stiff one [kN/m].
$1 == "P" { P[$2] = $3 }
/^[0-9]/ && $NF == "side" { i = $2 < $3 ? $2 : $3; got[FILENAME ~ /held/, i] = -$6 / 1000 }
END { for (i = 1; P[i] != ""; i++) print i, P[i], got[0, i] + 0, got[1, i] + 0 }
