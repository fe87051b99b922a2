#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# guided_fuzz.sh READER [SECONDS [SEED ...]] -- inputs that libFuzzer makes towards new branches of a reader, under the
# sanitizers: READER is a program of tests/fuzz without fuzz_, SECONDS 600 unless given, and SEED are files of its corpus, all
# unless given.  Builds with clang in build/guided; GUIDED_ROOMS and GUIDED_SUPPORT build only some folders of lib and files of
# tests/support. What breaks the reader is left in build/guided/READER/. Prints one line:
# the reader, inputs, branches found, seconds, findings.
set -u
reader=${1:?"usage: guided_fuzz.sh READER [SECONDS [SEED ...]]"} seconds=${2:-600}
shift; [ $# -gt 0 ] && shift
into=build/guided
[ -f "tests/fuzz/fuzz_$reader.c" ] || { echo "guided_fuzz.sh: tests/fuzz/fuzz_$reader.c is not there" >&2; exit 2; }
flags='-fsanitize=address,undefined,fuzzer-no-link -fno-omit-frame-pointer -fno-sanitize-recover=all'
objects=
for room in ${GUIDED_ROOMS:-$(cd lib && echo *)}; do
    for file in lib/"$room"/*.c; do [ -f "$file" ] && objects="$objects $into/${file%.c}.o"; done
done
for file in ${GUIDED_SUPPORT:-tests/support/*.c}; do objects="$objects $into/${file%.c}.o"; done
# shellcheck disable=SC2086 # words
make -s B=$into CC="${GUIDED_CC:-clang}" CWARN=-w OPT="-O1 $flags" SHIM=build/libfloe-shim.a build/libfloe-shim.a $objects >&2 &&
    rm -f $into/all.a && ar rcs $into/all.a $objects || exit 4
# shellcheck disable=SC2086 # words
clang -w -std=c17 -D_POSIX_C_SOURCE=200809L -O1 -g $flags -Ilib -Itests -Dmain=fuzz_program -c "tests/fuzz/fuzz_$reader.c" \
    -o "$into/fuzz_$reader.o" &&
    clang -fsanitize=address,undefined,fuzzer -fopenmp -Wl,--start-group "$into/fuzz_$reader.o" $into/all.a \
        build/libfloe-shim.a -Wl,--end-group -Wl,--as-needed -lcmocka -lccd -lgsl -lgslcblas -linih -lz -lm \
        -ldl -lstdc++ -lgmp -lmpfr -o "$into/guided_$reader" || exit 4
mkdir -p "$into/$reader/seeds" "$into/$reader/found"
if [ $# -gt 0 ]; then cp "$@" "$into/$reader/seeds"; else cp tests/fuzz/"$reader"/* "$into/$reader/seeds"; fi
OMP_NUM_THREADS=1 ASAN_OPTIONS=allocator_may_return_null=1:detect_leaks=1 "$into/guided_$reader" -max_total_time="$seconds" \
    -timeout=30 -rss_limit_mb=3000 -malloc_limit_mb=2500 -max_len=65536 -print_final_stats=1 \
    -artifact_prefix="$into/$reader/" "$into/$reader/found" "$into/$reader/seeds" >"$into/$reader/log" 2>&1
rc=$?
awk -v reader="$reader" -v rc="$rc" '/ cov: / { for (i = 1; i < NF; i++) if ($i == "cov:") cov = $(i + 1) }
    /^Done/ { runs = $2; seconds = $5 } /number_of_executed_units/ { runs = $2 }
    END { printf "%s: %d inputs, %d branches, %d s, %s\n", reader, runs, cov, seconds, rc ? "BROKEN, see build/guided/" reader : "nothing found" }' \
    "$into/$reader/log"
exit $rc
