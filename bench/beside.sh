#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# beside.sh -- what blocks.sh and peers.sh share: beside which programs they run, where, and how a table tells of both.
# They read it by `.`; it needs bench, the folder it lies in.
# shellcheck disable=SC2154 # that

fail() { echo "$table.sh: $*" >&2; exit 4; } # table: of begin

# begin TABLE BUILD OUT PROGRAM...: leaves in peers those that are there, and ends where none is; build and out,
# and a folder of its own to be in.
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
            echo "$table.sh: there is no $p, its rows are left out" >&2
        fi
    done
    [ "$peers" ] || exit 0
    here=$(mktemp -d "${TMPDIR:-/tmp}/floe-$table.XXXXXX") && cd "$here" || exit 4
    trap 'rm -rf "$here"' EXIT
    trap 'exit 130' INT TERM HUP
    TMPDIR=$here # MPI leaves things there
    export TMPDIR
}

# version PROGRAM: as it tells it, - where it does not
version()
{
    case $1 in
    floe*) "$build/bin/dem-solve" --version | sed 's/^[^ ]* //' ;;
    lmp) lmp -h | sed -n 's/^Large-scale.*Simulator - //p' ;;
    liggghts) liggghts -h | sed -n 's/.*LIGGGHTS-PUBLIC \([^,]*\),.*/\1/p' ;;
    yade) yade --version 2>&1 | sed -n 's/^Yade version: *\([^,]*\).*/\1/p' ;;
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

# keep: the table as it is in the folder, to where it belongs
keep()
{
    cp "$table.tsv" "$out/$table.tsv" || exit 4
    cat "$table.tsv"
}
