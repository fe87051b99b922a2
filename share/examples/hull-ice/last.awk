# SPDX-License-Identifier: GPL-3.0-or-later
# Centres of the spheres in the last rows of a state table.
/^[0-9]/ { if ($1 != t) { t = $1; n = 0 } x[++n] = $3 " " $4 " " $5 }
END { for (i = 1; i <= n; i++) print x[i] }
