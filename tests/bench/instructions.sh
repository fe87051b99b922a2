#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# instructions.sh [update] -- instructions of one contact, counted by callgrind: the figure that does not
# depend on how busy the machine is.  Beside it the one kept in instructions.txt, and how far it has risen;
# `update` keeps the new ones.  Counted on the width of vectors that valgrind knows.
#   BENCH  where bench_contact lies
set -e
cd "$(dirname "$0")"
BENCH=${BENCH:-../../build/tests/bench/bench_contact}
FEW=200 MANY=1200 CASES=11
kept=instructions.txt
fresh=$(mktemp)
trap 'rm -f "$fresh"' EXIT

count() { # case times
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$BENCH" "$1" "$2" 2>&1 |
        awk '/Collected/ { print $NF }'
}

k=0
while [ $k -lt $CASES ]; do
    echo "$k $(count $k $FEW) $(count $k $MANY)"
    k=$((k + 1))
done | awk -v n=$((MANY - FEW)) '{ printf "%d %.0f\n", $1, ($3 - $2) / n }' > "$fresh"

[ "$1" = update ] && cp "$fresh" $kept
awk 'NR == FNR { kept[$1] = $2; next }
     FNR == 1 { printf "%4s %12s %12s %7s\n", "case", "kept", "now", "ratio" }
     { printf "%4d %12d %12d %7.3f\n", $1, kept[$1], $2, kept[$1] ? $2 / kept[$1] : 0 }' $kept "$fresh"
