#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# lint.sh [floors] -- rules that hold for every file; `floors` runs only the part that reads text, in a few seconds.
#   floors    a library file includes from its own floor or those beneath, a program from the library or its own
#             folder; C++ in lib/shim only; base names, include guards, licence lines, width of lines, left-over marks
#   kernels   each *_kernel.h compiles alone, as C and as C++; a part of floors
#   cards     where nvcc is: the plug-in for cards compiles without spilled registers and joined products
#   warnings  every file under gcc, and under clang where there is one, with the warnings of config.mk as errors
#   headers   each header compiles alone, as C
#   format    clang-format agrees, where there is one
#   man       the manual pages parse without a complaint, where mandoc or man is there
#   shell     the scripts pass shellcheck, where there is one
# Prints each complaint, and "N passed, N failed" at the end.  Parts that need a missing program are skipped by name.
set -u
LC_ALL=C
export LC_ALL
cd "$(dirname "$0")/../.." || exit 4
passed=0 failed=0
scratch=$(mktemp -d "${TMPDIR:-/tmp}/floe-lint.XXXXXX") || exit 4
trap 'rm -rf "$scratch"' EXIT
trap 'exit 130' INT TERM HUP

verdict() # NAME STATUS
{
    if [ "$2" -eq 0 ]; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "lint: $1 failed"
    fi
}

floors()
{
    find Makefile config.mk .ci lib tools tests share bench -type f \( -name '*.[ch]' -o -name '*.cpp' -o -name '*.sh' \
        -o -name '*.mk' -o -name Makefile -o -name '*.[157]' -o -path '.ci/*' \) | sort >"$scratch/files"
    [ -s "$scratch/files" ] || return 1
    xargs awk -f tests/lint/floors.awk <"$scratch/files"
}

# Files named in ARCHITECTURE.md, CONTRIBUTING.md and tests/README.md exist; ARCHITECTURE.md has the floors of floors.awk.
architecture()
{
    wrong=0
    # shellcheck disable=SC2013 # names without blanks
    for f in $(grep -oE '[A-Za-z0-9_./-]+\.(c|h|cpp|awk|sh|txt|md)\b' ARCHITECTURE.md CONTRIBUTING.md tests/README.md -h | sort -u); do
        case $f in
        name.* | *NAME* | *MODULE*) continue ;; # to be filled in
        */*) [ -e "$f" ] && continue ;;
        *) [ -n "$(find . -path ./build -prune -o -name "$f" -print | head -n 1)" ] && continue ;;
        esac
        echo "ARCHITECTURE.md, CONTRIBUTING.md, tests/README.md: there is no $f"
        wrong=1
    done
    drawn=$(sed -n 's/^    \(base geom .*\)$/\1/p' ARCHITECTURE.md)
    held=$(sed -n 's/.*split("\(base geom [^"]*\)".*/\1/p' tests/lint/floors.awk)
    [ "$drawn" = "$held" ] || { echo "ARCHITECTURE.md draws other floors than tests/lint/floors.awk holds"; wrong=1; }
    return $wrong
}

# The arithmetic that devices share: every *_kernel.h is C++17 as well as C17, alone.
kernels()
{
    wrong=0
    # shellcheck disable=SC2086 # a compiler may be two words, "ccache gcc"
    for f in lib/*/*_kernel.h; do
        echo "#include \"${f#lib/}\"" >"$scratch/kernel.cpp"
        ${CXX:-g++} -std=c++17 -Wall -Wextra -Wno-missing-field-initializers -Werror -Ilib -fsyntax-only "$scratch/kernel.cpp" || wrong=1
        echo "#include \"${f#lib/}\"" >"$scratch/kernel.c"
        ${CC:-gcc} -std=c17 -Wall -Wextra -Werror -Ilib -fsyntax-only "$scratch/kernel.c" || wrong=1
    done
    return $wrong
}

# Where nvcc is: the plug-in compiles, no kernel spills registers, rows take at most 144, pairs with pieces 232 and all others 168, and
# no product is joined to a sum.
cards()
{
    nvcc=$(command -v nvcc || ls /usr/local/cuda/bin/nvcc 2>/dev/null) || { echo "lint: cards skipped: there is no nvcc"; return 0; }
    "$nvcc" -std=c++17 -O3 -fmad=false -Ilib -x cu -arch=sm_80 -Xptxas -v -cubin lib/gpu/cuda.cu -o "$scratch/cubin" \
        >"$scratch/ptxas" 2>&1 || { cat "$scratch/ptxas"; return 1; }
    awk '
        /Compiling entry/ { name = $0; sub(/.*run_/, "", name); sub(/1?1?fl_gpu_view.*/, "", name) }
        /spill stores/ && !/ 0 bytes spill stores, 0 bytes spill loads/ { print "cuda.cu: " name " spills: " $0; bad = 1 }
        / Used / {
            for (k = 1; k < NF; k++) if ($k == "Used") n = $(k + 1)
            most = name ~ /^ROWS/ ? 144 : name ~ /^PAIRS/ ? 232 : 168
            if (n > most) { print "cuda.cu: " name " takes " n " registers, " most " are the most"; bad = 1 }
        }
        END { exit bad }' "$scratch/ptxas" || return 1
    "$nvcc" -std=c++17 -O3 -fmad=false -Ilib -x cu -arch=compute_80 -ptx lib/gpu/cuda.cu -o "$scratch/ptx" || return 1
    if grep -E 'fma\.rn\.f64|mad\.rn\.f64' "$scratch/ptx"; then echo "cuda.cu: a product is joined to a sum"; return 1; fi
}

floors
verdict floors $?
kernels
verdict kernels $?
architecture
verdict architecture $?
if [ "${1-}" = floors ]; then
    echo "$passed passed, $failed failed"
    [ $failed -eq 0 ]
    exit
fi
cards
verdict cards $?

# The builder's flags, as make sees them.
# shellcheck disable=SC2016 # for make, not for the shell
flags() { printf 'include config.mk\nshow:\n\t@echo $(%s)\n' "$1" | make -s -f - show; }
cwarn=$(flags CWARN) warn=$(flags WARN) float=$(flags FLOAT)
c_flags="-std=c17 -D_POSIX_C_SOURCE=200809L $cwarn $float -fopenmp -Ilib -Itests -Werror"
cxx_flags="-std=c++17 $warn $float -fopenmp -Ilib -Werror"
# Some warnings of gcc (truncation, use of unset variables) come from the optimiser only.
whole="-O1 -c -o /dev/null"

skip() { echo "lint: $1 skipped: $2"; }

# compile NAME KIND COMPILER FLAGS: every file of that kind, on every core; complaints and a verdict.
compile()
{
    find lib tools tests -name "*.$2" | sort >"$scratch/sources"
    # shellcheck disable=SC2086 # flags are a list
    xargs -r -n 1 -P "$(getconf _NPROCESSORS_ONLN)" $3 $4 <"$scratch/sources"
    verdict "$1" $?
}

# C under both compilers; what no compiler is needed for twice (headers alone, C++) under one of them.
headers="" shims=""
for cc in gcc clang; do
    if ! command -v $cc >/dev/null; then
        skip "warnings of $cc" "no $cc"
        continue
    fi
    more="" how=$whole
    if [ $cc = clang ]; then # where it has no OpenMP header of its own, that of gcc says the same
        more="-idirafter $(dirname "$(gcc -print-file-name=include/omp.h)")"
        how=-fsyntax-only
    fi
    compile "warnings of $cc" c $cc "$c_flags $more $how"
    headers=${headers:-$cc} shims="$cc $more"
done
[ -z "$headers" ] || compile "headers alone" h "$headers" "$c_flags -fsyntax-only -x c /dev/null -include"
# The optimiser takes minutes for CGAL; its warnings, and those of g++, appear in the build.
case $shims in
clang*) compile "warnings of clang++" cpp clang++ "$cxx_flags ${shims#clang} -fsyntax-only" ;;
gcc*) compile "warnings of g++" cpp g++ "$cxx_flags -fsyntax-only" ;;
esac

if command -v clang-format >/dev/null; then
    find lib tools tests -name '*.[ch]' -o -name '*.cpp' | sort |
        xargs -n 20 -P "$(getconf _NPROCESSORS_ONLN)" clang-format --dry-run -Werror
    verdict format $?
else
    skip format "no clang-format"
fi

pages=$(find share tools -name '*.[157]' | sort)
if command -v mandoc >/dev/null; then
    # shellcheck disable=SC2086
    [ -z "$pages" ] || mandoc -T lint -W warning $pages
    verdict "manual pages" $?
elif command -v man >/dev/null && command -v groff >/dev/null; then
    bad=0
    for p in $pages; do
        LC_ALL=C.UTF-8 man --warnings -E UTF-8 -l "$p" 2>"$scratch/man" >/dev/null </dev/null
        [ -s "$scratch/man" ] && { sed "s|^|$p: |" "$scratch/man"; bad=1; }
    done
    verdict "manual pages" $bad
else
    skip "manual pages" "neither mandoc nor man with groff"
fi

if command -v shellcheck >/dev/null; then
    find share tests bench -name '*.sh' -exec shellcheck -s sh {} +
    verdict shell $?
else
    skip shell "no shellcheck"
fi

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
