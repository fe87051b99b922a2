#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# kernel.sh [BUILD [OUT]] -- cost beside error of the stages and modes of the contact kernel, and of libccd on the same
# pairs in the same run, from the tables of bench_gjk and bench_contact.
#   OUT/kernel.tsv   a row for each query; its head names the machine.  OUT is bench/results if not said
#   OUT/kernel.png   error against time (by gnuplot, where it is there)
# Errors of distances are in metres, pairs being some metres large; of contacts, what the force misses of the
# gradient of the energy over the force; of libccd, what its depth misses over the depth.
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
    # names stand in the first 36 columns there, in the first 21 here
    awk 'BEGIN { OFS = "\t" }
        /^[a-z]/ && NF == 1 { pairs = $1; next }
        pairs == "large" && NF == 5 && $1 ~ /^[0-9]+$/ { print $1 " vertices", "distance, warm", "floe", $2, $5 }
        pairs != "large" && /^  / {
            what = substr($0, 3, 34); sub(/ +$/, "", what)
            n = split(substr($0, 37), x, " ")
            ccd = sub(/^libccd /, "", what)
            print pairs, what, (ccd ? "libccd" : "floe"), x[1], (n > 1 ? x[2] : "-")
        }' "$scratch/gjk"
    awk 'BEGIN { OFS = "\t" }
        substr($0, 22) ~ /^(patch|core|manual-si) / {
            name = substr($0, 1, 20); sub(/ +$/, "", name)
            n = split(substr($0, 22), x, " ")
            print name, "force, " x[1], "floe", x[4], x[5]
            if (n > 9) print name, "force, surrogate", "floe", x[10], x[12]
            if (n > 5 && x[6] != "-") print name, "depth, MPR", "libccd", x[6], x[7]
            if (n > 7 && x[8] != "-") print name, "depth, EPA", "libccd", x[8], x[9]
        }' "$scratch/contact"
} >"$scratch/kernel.tsv"
cp "$scratch/kernel.tsv" "$out/kernel.tsv" || exit 4
command -v gnuplot >/dev/null || {
    echo "kernel.sh: no picture, there is no gnuplot" >&2
    exit 0
}
cd "$scratch" && gnuplot -e "out='$(cd "$out" && pwd)'" "$bench/kernel.gp"
