#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# parallel.sh [RUNS] -- makes the runs by GNU parallel, one per processor at a time; `make` then uses them and
# adds them up.
set -eu
cd "$(dirname "$0")"
export OUT="${OUT:-out}"
make -s "$OUT/leg.dat" OUT="$OUT"
seq 1 "${1:-50}" | parallel sh one.sh '{}'
