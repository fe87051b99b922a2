#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# check.sh TABLE -- what voronoi-ice promises beside what the samples gave.
while read -r test lattice layers rows _ _ peak _ young; do
    case $test in bend) key=flexural ;; press) key=compressive ;; *) continue ;; esac
    voronoi-ice --gaps even --lattice "$lattice" --layers "$layers" --thickness 0.23 --size 2x2 --rows "$rows" --bonded \
        "--$key" 1MPa --young 1GPa --scene "$1.scene" -q -o /dev/null
    awk -v test="$test" -v lattice="$lattice" -v layers="$layers" -v rows="$rows" -v peak="$peak" -v young="$young" '
        $1 == "normal_strength" { c = 1e6/$3 }
        /^\[/ { section = $1 }
        section == "[bond]" && $1 == "young" { e = 1e9/$3 }
        END {
            off = c/peak - 1; if (off < 0) off = -off
            soft = e/young - 1; if (soft < 0) soft = -soft
            print (off < 0.15 && (test != "bend" || soft < 0.15) ? "ok" : "off"), test, lattice, layers, rows, \
                "strength " c " for " peak (test == "bend" ? ", modulus " e " for " young : "")
        }' "$1.scene"
done <"$1"
