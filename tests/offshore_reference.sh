#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# offshore_reference.sh [BUILD] FILE ... -- one row for each deck of members or file of panels: nodes, elements, length and
# volume of the round members, triangles, area, hull volume (integral of z n_z), patches, open edges and the range of z, to
# hold beside published numbers. `share/doc/offshore.md` has those of public files.
set -u
LC_ALL=C
export LC_ALL
build=build
if [ -d "${1-}" ]; then
    build=$1
    shift
fi
[ $# -gt 0 ] || { echo "usage: offshore_reference.sh [BUILD] FILE ..." >&2; exit 2; }
out=$(mktemp -d "${TMPDIR:-/tmp}/floe-offshore.XXXXXX") || exit 4
trap 'rm -rf "$out"' EXIT
for f; do
    printf '%s\n' "$(basename "$f")"
    "$build/bin/struct-import" --raw -o "$out/g" "$f" 2>"$out/report" || { sed 's/^/    /' "$out/report"; continue; }
    grep -E 'nodes; elements|panels|skipped|passed over' "$out/report" | sed 's/^struct-import: [^:]*: /    /' | cut -c 1-150
    awk 'BEGIN { pi = atan2(0, -1); lo = 1e99; hi = -1e99 }
        function z(v) { if (v < lo) lo = v; if (v > hi) hi = v }
        $1 == "part" { nv = 0 }
        $1 == "cone" { l = sqrt(($6 - $2)^2 + ($7 - $3)^2 + ($8 - $4)^2); length_ += l; cones++; z($4); z($8)
            volume += pi / 3 * l * ($5^2 + $5 * $9 + $9^2) }
        $1 == "v" { x[nv] = $2; y[nv] = $3; h[nv] = $4; nv++; z($4) }
        $1 == "t" { tris++; a = $2; b = $3; c = $4
            ux = x[b] - x[a]; uy = y[b] - y[a]; uz = h[b] - h[a]; vx = x[c] - x[a]; vy = y[c] - y[a]; vz = h[c] - h[a]
            nx = uy * vz - uz * vy; ny = uz * vx - ux * vz; nz = ux * vy - uy * vx
            area += 0.5 * sqrt(nx^2 + ny^2 + nz^2); hull += nz * (h[a] + h[b] + h[c]) / 6 }
        END { if (cones) printf "    %d cones, length %.9g, volume %.9g\n", cones, length_, volume
            if (tris) printf "    %d triangles, area %.9g, hull %.9g\n", tris, area, hull
            printf "    ends or corners from z = %.6g to %.6g\n", lo, hi }' "$out/g"
    awk '/^part.*patches/ { on = 1; next } on && NF > 8 && $7 > 0 && $1 != "total" { printf "    %s: %d patches, %d open edges\n", $1, $7, $8 } on && !NF { exit }' "$out/report"
done
