#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# options.sh BUILD -- the long options of each program's --help and of its manual page are the same.
# An option of --help stands at the start of its line ("  -o, --output FILE  text"); an entry of the page is the head of
# an item: a line .It, .IP or .OP, or the line after .TP or .TQ.  Prints "N passed, N failed", a program being one.
set -u
LC_ALL=C
export LC_ALL
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:?usage: options.sh BUILD}
scratch=$(mktemp -d "${TMPDIR:-/tmp}/floe-options.XXXXXX") || exit 4
trap 'rm -rf "$scratch"' EXIT
passed=0 failed=0

long() { grep -oE -e '--[a-z][a-z0-9-]*' | sort -u; }

one() # PROGRAM PAGE
{
    if ! "$build/bin/$1" --help >"$scratch/text" </dev/null; then
        echo "$1 --help failed"
        return 1
    fi
    # The head of the line ends at two blanks; the text after it may name options of other programs.
    sed -n 's/^ *\(-.*\)$/\1/p' "$scratch/text" | sed 's/   *.*//' | long >"$scratch/help"
    if [ ! -f "$2" ]; then
        echo "$1 has no manual page"
        return 1
    fi
    # "Fl -seed" of mdoc and "\-\-seed" of man are both --seed.
    sed -e 's/\\f[BIRP]//g' -e 's/\\-/-/g' -e 's/Fl Fl /Fl -/g' -e 's/Fl -/--/g' "$2" |
        awk '/^\.(It|IP|OP)/ || tagged { print } { tagged = /^\.T[PQ]/ }' | long >"$scratch/page"
    if [ ! -s "$scratch/help" ]; then
        echo "$1 --help names no long option"
        return 1
    fi
    cmp -s "$scratch/help" "$scratch/page" && return 0
    comm -23 "$scratch/help" "$scratch/page" | sed "s|^|$1: only in --help: |"
    comm -13 "$scratch/help" "$scratch/page" | sed "s|^|$1: only in the manual page: |"
    return 1
}

for folder in "$root"/tools/*/; do
    name=$(basename "$folder")
    if one "$name" "$folder$name.1"; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
done
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
