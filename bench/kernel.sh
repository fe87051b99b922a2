#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# kernel.sh [BUILD [OUT]] -- time and error of the stages and contact types of the contact kernel, and of libccd on
# the same pairs in the same run, from the tables of bench_gjk and bench_contact.
#   OUT/kernel.tsv   a row for each query; its head names the machine.  The default of OUT is bench/results
#   OUT/kernel.png   error against time, if gnuplot is installed
# Errors of distances are in metres, for pairs of some metres.  The error of a contact force is its difference from
# the gradient of the energy, relative to the force.  The error of libccd is the relative error of its depth.
set -u
LC_ALL=C
export LC_ALL
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
build=$(cd "${1:-$bench/../build}" && pwd) || exit 4
out=${2:-$bench/results}
mkdir -p "$out" || exit 4
scratch=$(mktemp -d) || exit 4
trap 'rm -rf "$scratch"' EXIT
"$build/tests/bench/bench_gjk" >"$scratch/gjk" || exit 1
"$build/tests/bench/bench_contact" >"$scratch/contact" || exit 1
{
    echo '#kernel 1'
    echo "#processor $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1), $(uname -m)"
    echo "#load $(uptime | sed 's/.*: //') over 1, 5 and 15 minutes, the programs themselves being 1"
    printf 'pairs\tquery\tby\tns\terror\n'
    # names take the first 36 columns in bench_gjk, the first 21 in bench_contact
    awk 'BEGIN { OFS = "\t" }
        /^[a-z]/ && NF == 1 { pairs = $1; next }
        pairs == "large" && NF == 5 && $1 ~ /^[0-9]+$/ { print $1 " vertices", "distance, warm", "dem-solve", $2, $5 }
        pairs != "large" && /^  / {
            what = substr($0, 3, 34); sub(/ +$/, "", what)
            n = split(substr($0, 37), x, " ")
            ccd = sub(/^libccd /, "", what)
            print pairs, what, (ccd ? "libccd" : "dem-solve"), x[1], (n > 1 ? x[2] : "-")
        }' "$scratch/gjk"
    awk 'BEGIN { OFS = "\t" }
        substr($0, 22) ~ /^(patch|quick|core|manual-si) / {
            name = substr($0, 1, 20); sub(/ +$/, "", name)
            n = split(substr($0, 22), x, " ")
            print name, "force, " x[1], "dem-solve", x[4], x[5]
            if (n > 9) print name, "force, surrogate", "dem-solve", x[10], x[12]
            if (n > 5 && x[6] != "-") print name, "depth, MPR", "libccd", x[6], x[7]
            if (n > 7 && x[8] != "-") print name, "depth, EPA", "libccd", x[8], x[9]
        }' "$scratch/contact"
} >"$scratch/kernel.tsv"
cp "$scratch/kernel.tsv" "$out/kernel.tsv" || exit 4
command -v gnuplot >/dev/null || {
    echo "kernel.sh: gnuplot is not installed, no picture" >&2
    exit 0
}
cd "$scratch" && gnuplot -e "out='$(cd "$out" && pwd)'" "$bench/kernel.gp"
