#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# sheet.sh [BUILD [OUT]] -- cost of floating sheets of bonded spheres, by bench_sheet on one thread: a bond in lanes and
# alone, a whole step, memory, and the error of the energy.
#   OUT/sheet.tsv   a row for each sheet; its head names the machine.  OUT is bench/results
#   FLOE_QUICK=1    the smallest sheet alone
set -u
LC_ALL=C OMP_NUM_THREADS=1
export LC_ALL OMP_NUM_THREADS
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
build=$(cd "${1:-$bench/../build}" && pwd) || exit 4
out=${2:-$bench/results}
mkdir -p "$out" || exit 4
# shellcheck source=/dev/null # in the same folder
. "$bench/beside.sh"
table=$(mktemp "${TMPDIR:-/tmp}/floe-sheet.XXXXXX") || exit 4
trap 'rm -f "$table"' EXIT
{
    heading "sheets of three layers, 0.094 m" | sed "s|^#$table|#sheet|"
    printf 'spheres\tbonds\tlanes[ns]\talone[ns]\tbond-step[ns]\tbody-step[ns]\tmemory[KiB]\tenergy-error\n'
    if [ "${FLOE_QUICK:-0}" = 0 ]; then "$build/tests/bench/bench_sheet"
    else "$build/tests/bench/bench_sheet" 1000 2000; fi |
        awk '$1 ~ /^[0-9]+$/ && NF == 8 { $1 = $1; gsub(" ", "\t"); print }'
} >"$table"
cp "$table" "$out/sheet.tsv" && cat "$table"
