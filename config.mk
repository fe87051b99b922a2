# SPDX-License-Identifier: GPL-3.0-or-later
# Builder's settings: override on the command line or edit here.
CC  ?= gcc
CXX ?= g++
PREFIX  ?= /usr/local
DESTDIR ?=
OPT ?= -O2
# -ffp-contract=off: the same bits whether or not the machine has fused multiply-add.
# -fno-math-errno, -fno-trapping-math: let sqrt and selects inline; values are unchanged.
FLOAT = -ffp-contract=off -fno-math-errno -fno-trapping-math
WARN  = -Wall -Wextra -Wpedantic -Wshadow -Wconversion
CWARN = $(WARN) -Wmissing-prototypes -Wstrict-prototypes
