# SPDX-License-Identifier: GPL-3.0-or-later
# Largest load, its time, and impulses along the drift; rows of 10 ms.
/^[0-9]/ { all += 0.01*$3; if ($1 <= 1) early += 0.01*$3; if ($3 > most) { most = $3; at = $1 } }
END { printf "%-20s %7.1f kN at %.2f s; impulse %6.1f kN s, of it in the first second %6.1f\n", of, most/1e3, at, all/1e3, early/1e3 }
