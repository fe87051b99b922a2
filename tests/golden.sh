#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# golden.sh [--update] CASE BUILD -- run one golden case, or rewrite its expected files.
#
# CASE is a folder.  Its files are copied to a scratch folder, where `sh cmd` runs with BUILD/bin first on the PATH,
# FLOE_SHARE naming the share folder, and an empty stdin.  All files are inputs except these:
#   cmd      the shell lines
#   stdout   expected, compared by numdiff
#   stderr   expected, compared byte for byte; not compared where the file is absent
#   status   expected exit status, 0 where the file is absent
#   tol      options of numdiff, "-a 1e-9 -r 1e-9" where the file is absent: either tolerance suffices
#   files    names of files that cmd writes, one a line; expect/NAME is compared by numdiff
#   once     present: the case runs with one thread only
# Otherwise it runs with 1, 2, 3 and 8 threads, and their outputs are compared with each other byte for byte.
set -u
LC_ALL=C
export LC_ALL
update=0
if [ "${1-}" = --update ]; then
    update=1
    shift
fi
if [ $# -ne 2 ] || [ ! -f "$1/cmd" ]; then
    echo "usage: golden.sh [--update] CASE BUILD" >&2
    exit 2
fi
root=$(cd "$(dirname "$0")/.." && pwd)
case_dir=$(cd "$1" && pwd)
PATH=$(cd "$2" && pwd)/bin:$PATH
FLOE_SHARE=$root/share
export PATH FLOE_SHARE
scratch=$(mktemp -d "${TMPDIR:-/tmp}/floe-golden.XXXXXX") || exit 4
trap 'rm -rf "$scratch"' EXIT
trap 'exit 130' INT TERM HUP
bad=0
complain() { echo "$(basename "$case_dir"): $*"; bad=1; }

names=
[ -f "$case_dir/files" ] && names=$(cat "$case_dir/files")
threads="1 2 3 8"
[ -f "$case_dir/once" ] && threads=1
[ $update -eq 1 ] && threads=1

# run T: the case with T threads, in scratch/T; its streams beside it.
run()
{
    here=$scratch/$1
    cp -R "$case_dir" "$here" || exit 4
    for f in cmd stdout stderr status tol files once expect; do rm -rf "${here:?}/$f"; done
    (cd "$here" && OMP_NUM_THREADS=$1 sh "$case_dir/cmd" >"../$1.stdout" 2>"../$1.stderr" </dev/null)
    echo $? >"$scratch/$1.status"
}

for t in $threads; do run "$t"; done

if [ $update -eq 1 ]; then
    cp "$scratch/1.stdout" "$case_dir/stdout"
    [ -f "$case_dir/stderr" ] && cp "$scratch/1.stderr" "$case_dir/stderr"
    if [ "$(cat "$scratch/1.status")" -ne 0 ] || [ -f "$case_dir/status" ]; then
        cp "$scratch/1.status" "$case_dir/status"
    fi
    for f in $names; do
        mkdir -p "$(dirname "$case_dir/expect/$f")" && cp "$scratch/1/$f" "$case_dir/expect/$f" || exit 1
    done
    echo "golden/$(basename "$case_dir") rewritten: git diff shows what changed"
    exit 0
fi

# Between the thread counts: the same bytes.
for t in $threads; do
    [ "$t" = 1 ] && continue
    cmp -s "$scratch/1.status" "$scratch/$t.status" ||
        complain "status $(cat "$scratch/1.status") with 1 thread, $(cat "$scratch/$t.status") with $t"
    cmp "$scratch/1.stdout" "$scratch/$t.stdout" || complain "stdout differs between 1 and $t threads"
    if [ -f "$case_dir/stderr" ]; then
        cmp "$scratch/1.stderr" "$scratch/$t.stderr" || complain "stderr differs between 1 and $t threads"
    fi
    for f in $names; do
        cmp "$scratch/1/$f" "$scratch/$t/$f" || complain "$f differs between 1 and $t threads"
    done
done

# Against the expectation: numbers to their tolerance.
tol="-a 1e-9 -r 1e-9"
[ -f "$case_dir/tol" ] && tol=$(cat "$case_dir/tol")
near() # EXPECTED FOUND NAME
{
    if [ ! -f "$1" ]; then
        complain "no expected $3 (make golden-update CASE=$(basename "$case_dir") writes it)"
    elif [ ! -f "$2" ]; then
        complain "$3 was not written"
    else
        # shellcheck disable=SC2086 # tol is a list of options
        numdiff $tol "$1" "$2" >"$scratch/diff" 2>&1 || {
            complain "$3 differs from what is expected"
            head -n 40 "$scratch/diff"
        }
    fi
}
near "$case_dir/stdout" "$scratch/1.stdout" stdout
for f in $names; do near "$case_dir/expect/$f" "$scratch/1/$f" "$f"; done
if [ -f "$case_dir/stderr" ]; then
    diff "$case_dir/stderr" "$scratch/1.stderr" >"$scratch/diff" || {
        complain "stderr differs from what is expected"
        head -n 40 "$scratch/diff"
    }
fi
wanted=0
[ -f "$case_dir/status" ] && wanted=$(cat "$case_dir/status")
found=$(cat "$scratch/1.status")
if [ "$found" -ne "$wanted" ]; then
    complain "status $found, $wanted is expected"
    head -n 20 "$scratch/1.stderr"
fi

echo "$((1 - bad)) passed, $bad failed"
exit $bad
