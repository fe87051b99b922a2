# SPDX-License-Identifier: GPL-3.0-or-later
# Sums of panels and of events against the loads: largest difference over the largest load.
BEGIN { FS = "\t" }
FNR == 1 { file++ }
/^#/ || $1 ~ /^t/ { next }
file == 1 { id[$2] = ++n; name[n] = $2; for (c = 3; c <= 5; c++) { x[$1, $2, c] = $c; a = $c < 0 ? -$c : $c; if (a > most) most = a } key[++keys] = $1 SUBSEP $2 }
file == 2 { sub(/\..*$/, "", $2); for (c = 3; c <= 5; c++) p[$1, $2, c] += $(c + 4); if ($7 || $8 || $9) loaded++ }
file == 3 { part = name[-$3]; for (c = 0; c < 3; c++) e[$1, part, c + 3] -= $14 * $(6 + c) + $(15 + c); rows++ }
END {
    for (k = 1; k <= keys; k++) for (c = 3; c <= 5; c++) {
        d = x[key[k], c] - p[key[k], c]; if (d < 0) d = -d; if (d > dp) dp = d
        d = x[key[k], c] - e[key[k], c]; if (d < 0) d = -d; if (d > de) de = d
    }
    printf "%d panel rows with load, %d events; panels %s, events %s\n", loaded, rows, dp < 1e-12 * most ? "sum up" : "off by " dp / most, de < 1e-12 * most ? "sum up" : "off by " de / most
}
