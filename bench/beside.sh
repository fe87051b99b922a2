#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# beside.sh -- functions that blocks.sh and peers.sh share: programs to compare with, scratch folder, head of the table.
# The scripts source it; the variable bench must hold the folder of this file.
# shellcheck disable=SC2154 # bench

fail() { echo "$table.sh: $*" >&2; exit 4; } # begin sets table

# begin TABLE BUILD OUT PROGRAM...: sets peers to the installed programs and exits if there are none; sets build and
# out; changes to a scratch folder.
begin()
{
    table=$1
    build=$(cd "${2:-$bench/../build}" && pwd) || exit 4
    out=${3:-$bench/results}
    mkdir -p "$out" || exit 4
    out=$(cd "$out" && pwd)
    shift 3
    peers=
    for p; do
        if command -v "$p" >/dev/null; then
            peers="$peers $p"
        else
            echo "$table.sh: $p is not installed, its rows are left out" >&2
        fi
    done
    [ "$peers" ] || exit 0
    here=$(mktemp -d "${TMPDIR:-/tmp}/floe-$table.XXXXXX") && cd "$here" || exit 4
    trap 'rm -rf "$here"' EXIT
    trap 'exit 130' INT TERM HUP
    TMPDIR=$here # MPI leaves files there
    export TMPDIR
}

# version PROGRAM: the version that it prints, - if it prints none
version()
{
    case $1 in
    dem-solve*) "$build/bin/dem-solve" --version | sed -n '1s/^[^ ]* //p' ;;
    lmp) lmp -h | sed -n 's/^Large-scale.*Simulator - //p' ;;
    liggghts) liggghts -h | sed -n 's/.*LIGGGHTS-PUBLIC \([^,]*\),.*/\1/p' ;;
    yade) yade --version 2>&1 | sed -n 's/^Yade version: *\([^, ]*\).*/\1/p' ;;
    *) echo - ;;
    esac 2>/dev/null | head -n 1
}

# heading WHAT: the first lines of a table
heading()
{
    echo "#$table 1"
    echo "#processor $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1), $(uname -m)"
    echo "#load $(uptime | sed 's/.*: //') over 1, 5 and 15 minutes, the programs being 1; $1"
}

# keep: copies the finished table to OUT and prints it
keep()
{
    cp "$table.tsv" "$out/$table.tsv" || exit 4
    cat "$table.tsv"
}
