#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
set -eu
export C_INCLUDE_PATH="$PREFIX/include" CPLUS_INCLUDE_PATH="$PREFIX/include" LIBRARY_PATH="$PREFIX/lib"
make -j"${CPU_COUNT:-2}" all CC="$CC" CXX="$CXX" LDFLAGS="-Wl,-rpath,$PREFIX/lib"
make install PREFIX="$PREFIX"
