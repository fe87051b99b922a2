#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# setup.sh -- what the build and its tests need: compilers, make, CGAL, libccd, GSL, inih, zlib, cmocka, numdiff, gnuplot.
# On Debian and Ubuntu it installs what is missing, by apt-get, with sudo where the user is not root.  Elsewhere it names
# what is missing.  When nothing is missing it says nothing and takes no time.
# Status: 0 all there, 2 missing and not ours to install, 4 the installation failed.
set -u
LC_ALL=C
export LC_ALL
# package:program, or package alone for a library
needs="gcc:gcc g++:g++ make:make libcgal-dev libccd-dev libgsl-dev libinih-dev zlib1g-dev libcmocka-dev numdiff:numdiff
gnuplot-nox:gnuplot"
# Of ice-view: OpenGL without a window and a driver for it, the window, films.  Where they cannot be had, it is built
# without what needs them.
wanted="libepoxy-dev libegl-dev libgl1-mesa-dri libsdl2-dev ffmpeg:ffmpeg"
missing=

have() { command -v "$1" >/dev/null 2>&1; }
fail() # STATUS SENTENCE
{
    echo "setup: $2" >&2
    exit "$1"
}

missing_on_debian() # NEEDS
{
    missing=
    libraries=
    for need in $1; do
        package=${need%%:*}
        case $need in
        *:*) have "${need#*:}" || missing="$missing $package" ;; # a compiler from elsewhere is a compiler
        *) libraries="$libraries $package" ;;
        esac
    done
    # shellcheck disable=SC2086 # a list
    there=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' $libraries 2>/dev/null)
    for package in $libraries; do
        case "
$there
" in
        *"
$package installed
"*) ;;
        *) missing="$missing $package" ;;
        esac
    done
}

# shellcheck disable=SC2086 # lists of words, meant to be split
install_on_debian()
{
    missing_on_debian "$needs"
    required=$missing
    missing_on_debian "$wanted"
    optional=$missing
    missing=$required$optional
    [ -z "$missing" ] && return 0
    asroot=
    if [ "$(id -u)" -ne 0 ]; then
        have sudo || {
            [ -z "$required" ] && { leave_out; return 0; }
            fail 2 "missing:$required; neither root nor sudo is there to install them (apt-get install$missing)"
        }
        if [ -t 0 ]; then
            asroot=sudo
            sudo true
        else
            asroot="sudo -n" # nobody is there to type a password
            sudo -n true 2>/dev/null
        fi || {
            [ -z "$required" ] && { leave_out; return 0; }
            fail 2 "missing:$required; sudo is refused (as root: apt-get install$missing)"
        }
    fi
    echo "setup: installing$missing" >&2
    log=$(mktemp) || exit 4
    apt="env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3"
    # One archive of several may be out of reach; the packages decide.
    $asroot $apt update >"$log" 2>&1 </dev/null
    if [ -n "$required" ] && ! $asroot $apt install --no-install-recommends $required >>"$log" 2>&1 </dev/null; then
        tail -n 30 "$log" >&2
        rm -f "$log"
        fail 4 "apt-get could not install$required"
    fi
    [ -n "$optional" ] && $asroot $apt install --no-install-recommends $optional >>"$log" 2>&1 </dev/null
    rm -f "$log"
    missing_on_debian "$wanted"
    [ -z "$missing" ] || leave_out
    missing_on_debian "$needs"
    [ -z "$missing" ] || fail 4 "apt-get said it installed$missing, but it is not there"
}

leave_out() { echo "setup: left out of ice-view, missing:$missing" >&2; }

# Elsewhere: does the header compile, is the program on the PATH?
probe()
{
    for program in "${CC:-cc}" "${CXX:-c++}" make numdiff gnuplot; do
        have "$program" || missing="$missing $program"
    done
    have "${CXX:-c++}" || return 0
    for pair in CGAL:CGAL/version.h libccd:ccd/ccd.h GSL:gsl/gsl_version.h inih:ini.h zlib:zlib.h GMP:gmp.h MPFR:mpfr.h; do
        echo "#include <${pair#*:}>" | "${CXX:-c++}" -E -x c++ - >/dev/null 2>&1 ||
            missing="$missing ${pair%%:*}"
    done
    printf '#include <%s>\n' stdarg.h stddef.h stdint.h setjmp.h cmocka.h | "${CXX:-c++}" -E -x c++ - >/dev/null 2>&1 ||
        missing="$missing cmocka"
}

if have dpkg-query && have apt-get; then
    install_on_debian
else
    probe
    [ -z "$missing" ] || fail 2 "missing:$missing; install them with your package manager, headers included"
fi
