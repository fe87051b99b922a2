# SPDX-License-Identifier: GPL-3.0-or-later
# Impulse along x of the load table and of the history for OpenFAST, which is linear between its rows. Status 1 if they
# differ by more than one interval of the largest load.
/^#/ || /^t\[/ { next }
FILENAME ~ /loads/ {
    if ($1 != t) { step = $1 - t; t = $1 }
    own[t] += $3
    impulse += $3 * step
    next
}
{
    if (rows++) other += 0.5 * ($2 + before) * ($1 - at)
    at = $1; before = $2
    if ($2 > most) most = $2
    if (NF != 7) bad = 1
}
END {
    printf "impulse along x %.1f kN s of the loads, %.1f kN s as OpenFAST takes them, largest load %.1f kN\n", impulse / 1e3,
        other / 1e3, most / 1e3
    off = impulse - other
    if (off < 0) off = -off
    if (bad || !(impulse > 0) || off > most * step) { print "FAIL"; exit 1 }
    print "ok"
}
