#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# parallel.sh [RUNS] -- the runs by GNU parallel, as many at a time as there are processors; then `make` finds them
# made and adds them up.
set -eu
cd "$(dirname "$0")"
export OUT="${OUT:-out}"
make -s "$OUT/leg.dat" OUT="$OUT"
seq 1 "${1:-50}" | parallel sh one.sh '{}'
