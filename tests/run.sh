#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh check|verify|bench|update BUILD -- run the tests built under BUILD.
#   check    floors, man pages against --help, unit, prop, fuzz, golden, the quick part of verify, and each unchanged
#            corpus of fuzz under the sanitizers, where BUILD/san has the programs
#   verify   every verification program in full, with its table, and a line for each hard case
#   bench    every benchmark, one at a time, and the scripts of bench/ that renew bench/results: the kernel,
#            surrogates, sleep, late jams, threads, peers, blocks, sheets, packings, frames and the ladder
#   update   rewrite the expected files of the golden cases; CASE='name*' limits it to some of them
# Prints one line per program, the output of those that failed, the ten longest, and at the end "N passed, N failed".
# BUILD/durations.tsv has the seconds of all: of processor, which hardly depend on what else runs, and of the clock.
# Status 0, or 1 when something failed.  A program that crashes, hangs (FLOE_TIMEOUT seconds, else 600; 3600 for
# verify and bench) or prints no count has failed.  ONLY='unit/*' limits check and verify to some programs.
set -u
LC_ALL=C
export LC_ALL
# A case that calls make must not inherit the settings of the make that started the tests.
unset MAKEFLAGS MFLAGS MAKELEVEL MAKEOVERRIDES

# counts FILE STATUS: "passed failed skipped" from the summary lines of cmocka and from a line "N passed, N failed".
counts()
{
    awk -v status="$2" '
        /^\[ *(PASSED|FAILED|SKIPPED) *\] [0-9]+ test\(s\)/ {
            match($0, /\] [0-9]+/)
            n = substr($0, RSTART + 2, RLENGTH - 2) + 0
            if (/^\[ *PASSED/) passed += n
            else if (/^\[ *FAILED/) failed += n
            else skipped += n
        }
        /^[0-9]+ passed, [0-9]+ failed$/ { own_passed = $1; own_failed = $3 }
        END {
            passed += own_passed
            failed += own_failed
            if (failed == 0 && (status != 0 || passed + skipped == 0)) failed = 1
            print passed + 0, failed, skipped + 0
        }' "$1"
}

# job FOLDER K LIMIT: run the command in FOLDER/K.cmd; leaves K.out, and K.done with status and seconds.
if [ "${1-}" = job ]; then
    s=$2/$3
    mkdir "$s.tmp"
    start=$(date +%s)
    bound=
    command -v timeout >/dev/null && bound="timeout -k 10 $4"
    TMPDIR=$s.tmp $bound sh "$s.cmd" >"$s.out" 2>"$s.err" </dev/null &
    echo $! >"$s.pid"
    wait $!
    status=$?
    rm "$s.pid"
    cat "$s.err" >>"$s.out" # separate until here, so that their lines do not mix
    [ $status -eq 124 ] && echo "stopped after $4 s" >>"$s.out"
    rm -rf "$s.tmp"
    # Seconds of the clock, and of processor for all that ran in the job (times: shell, then children, "1m2.5s 0m0.1s").
    times >"$s.times" # not in a pipe: a subshell has no children yet
    cpu=$(awk 'NR == 2 { split($1 "m" $2, t, /[ms]+/); print t[1] * 60 + t[2] + t[3] * 60 + t[4] }' "$s.times")
    echo "$status $(($(date +%s) - start)) $cpu" >"$s.fin"
    mv "$s.fin" "$s.done"
    exit 0
fi

what=${1-} build=${2-}
case $what in
check | verify | bench | update) ;;
*)
    echo "usage: run.sh check|verify|bench|update BUILD" >&2
    exit 2
    ;;
esac
root=$(cd "$(dirname "$0")/.." && pwd) || exit 4
cd "$root" || exit 4
build=$(cd "$build" 2>/dev/null && pwd) || {
    echo "run.sh: ${2-}: no such folder, the one that make built into is expected" >&2
    exit 2
}

if [ "$what" = update ]; then
    for c in tests/golden/${CASE:-*}/cmd; do
        [ -f "$c" ] || continue
        sh tests/golden.sh --update "${c%/cmd}" "$build" || exit 1
    done
    exit 0
fi

scratch=$(mktemp -d "${TMPDIR:-/tmp}/floe-run.XXXXXX") || exit 4
crew=
trap 'rm -rf "$scratch"' EXIT
# xargs first, so that nothing new starts, then the running jobs; timeout passes the signal on.
trap 'kill $crew $(cat "$scratch"/*.pid) 2>/dev/null; exit 130' INT TERM HUP
# For a reader that trusts a count, malloc must return NULL and not end the program.
ASAN_OPTIONS=allocator_may_return_null=1:detect_stack_use_after_return=1${ASAN_OPTIONS:+:$ASAN_OPTIONS}
UBSAN_OPTIONS=print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}
export ASAN_OPTIONS UBSAN_OPTIONS

jobs=0 only=${ONLY:-*}
: >"$scratch/list"
add() # LABEL COMMAND
{
    # shellcheck disable=SC2254 # a pattern
    case $1 in
    $only) ;;
    *) return ;;
    esac
    jobs=$((jobs + 1))
    k=$(printf %04d $jobs)
    printf '%s\n' "$2" >"$scratch/$k.cmd"
    printf '%s %s\n' "$k" "$1" >>"$scratch/list"
}
programs() # KIND
{
    for source in tests/"$1"/*.c; do
        [ -f "$source" ] || continue
        name=$(basename "$source" .c)
        add "$1/$name" "exec '$build/tests/$1/$name'"
    done
}

under_quick() # NAME...: the verification programs NAME under the law quick
{
    for name in "$@"; do
        add "verify/quick_$name" "FLOE_LAW=quick exec '$build/tests/verify/verify_$name'"
    done
}

# The hard cases once more with surrogates.
all_verify()
{
    programs verify
    add verify/verify_hard_surrogate "FLOE_SURROGATE=1e-3 exec '$build/tests/verify/verify_hard_cases'"
    under_quick rigid energy friction contact many_contacts
}

# The memory map of the sanitizers may collide with randomised addresses.
straight=
setarch -R true 2>/dev/null && straight="setarch -R"
crews=$(getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)
limit=${FLOE_TIMEOUT:-3600}
case $what in
check)
    FLOE_QUICK=1
    export FLOE_QUICK
    limit=${FLOE_TIMEOUT:-600}
    add lint/floors "exec sh tests/lint/lint.sh floors"
    add lint/options "exec sh tests/lint/options.sh '$build'"
    programs unit
    programs prop
    programs fuzz
    for reader in "$build"/san/tests/fuzz/fuzz_*.o; do
        [ -x "${reader%.o}" ] || continue
        name=$(basename "$reader" .o)
        [ -f "tests/fuzz/$name.c" ] && add "corpus/${name#fuzz_}" "FLOE_FUZZ=0 exec $straight '${reader%.o}'"
    done
    add view/pictures "exec sh tests/view/pictures.sh '$build'"
    add python/floe "exec sh tests/python.sh '$build'"
    add view/window "exec sh tests/view/window.sh '$build'"
    for c in tests/golden/*/cmd; do
        [ -f "$c" ] && add "golden/$(basename "${c%/cmd}")" "exec sh tests/golden.sh '${c%/cmd}' '$build'"
    done
    all_verify
    ;;
verify)
    unset FLOE_QUICK
    all_verify
    under_quick smooth step hard_cases
    add verify/quick_hard_surrogate "FLOE_LAW=quick FLOE_SURROGATE=1e-3 exec '$build/tests/verify/verify_hard_cases'"
    add verify/ice_scenes "exec sh tests/ice_scenes.sh '$build'"
    add view/page "exec sh tests/view/page.sh '$build'"
    add view/paraview "exec sh tests/view/paraview.sh '$build'"
    ;;
bench)
    unset FLOE_QUICK
    crews=1
    programs bench
    add bench/kernel "exec sh bench/kernel.sh '$build'"
    add bench/surrogate "exec sh bench/surrogate.sh '$build'"
    add bench/sleep "exec sh bench/sleep.sh '$build'"
    add bench/late "exec sh bench/late.sh '$build'"
    add bench/threads "exec sh bench/threads.sh '$build'"
    add bench/peers "exec sh bench/peers.sh '$build'"
    add bench/blocks_cut "exec sh bench/blocks-cut.sh '$build'"
    add bench/blocks "exec sh bench/blocks.sh '$build'"
    add bench/sheet "exec sh bench/sheet.sh '$build'"
    add bench/pack "exec sh bench/pack.sh '$build'"
    add bench/view "exec sh bench/view.sh '$build'"
    add bench/ladder "exec sh bench/ladder.sh '$build'"
    ;;
esac

# Programs that take longest start first, so that no core waits for one of them at the end.
early='verify_(stable_step_packed|boundary|spheres|budget|granular)$'
{
    grep -E "$early" "$scratch/list"
    grep -vE "$early" "$scratch/list"
} | cut -d ' ' -f 1 | xargs -P "$crews" -I '{}' sh tests/run.sh job "$scratch" '{}' "$limit" 2>/dev/null &
crew=$!

passed=0 failed=0
while read -r k label; do
    while [ ! -f "$scratch/$k.done" ]; do
        kill -0 $crew 2>/dev/null || [ -f "$scratch/$k.done" ] || {
            echo "run.sh: could not start $label" >&2
            exit 4
        }
        sleep 0.1
    done
    read -r status seconds cpu <"$scratch/$k.done"
    if [ "$what" = bench ]; then # a benchmark passes if it completes
        grep -q '^[0-9]* passed, [0-9]* failed$' "$scratch/$k.out" ||
            [ "$status" -ne 0 ] || echo "1 passed, 0 failed" >>"$scratch/$k.out"
    fi
    # shellcheck disable=SC2046 # three numbers
    set -- $(counts "$scratch/$k.out" "$status")
    passed=$((passed + $1)) failed=$((failed + $2))
    note=
    [ "$3" -gt 0 ] && note="$note, $3 skipped"
    [ "$status" -gt 128 ] && note="$note, ended by signal $((status - 128))"
    [ "$seconds" -gt 1 ] && note="$note, $seconds s"
    if [ "$what" != check ]; then
        grep -v '^[0-9]* passed, [0-9]* failed$' "$scratch/$k.out"
    elif [ "$2" -gt 0 ]; then
        echo "--- $label ---"
        tail -n 60 "$scratch/$k.out"
    fi
    printf '%-32s %d passed, %d failed%s\n' "$label" "$1" "$2" "$note"
    printf '%s\t%s\t%s\n' "$cpu" "$seconds" "$label" >>"$scratch/durations"
done <"$scratch/list"
wait $crew
# All durations to BUILD/durations.tsv, their sum and the ten longest to stdout.
if [ -f "$scratch/durations" ]; then
    sort -k1,1nr -k3 "$scratch/durations" >"$build/durations.tsv"
    printf 'seconds of processor:'
    awk -F '\t' '{ sum += $1 } NR <= 10 && $1 > 1 { line = line sprintf("%s %s %.0f", (NR > 1 ? "," : ""), $3, $1) }
        END { printf " %.0f in all, of which%s\n", sum, line }' "$build/durations.tsv"
fi
[ "$what" = verify ] && cat "$scratch"/*.out | awk -f tests/hard.awk
echo "$passed passed, $failed failed"
[ $failed -eq 0 ] && [ $passed -gt 0 ]
