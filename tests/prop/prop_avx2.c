/* SPDX-License-Identifier: GPL-3.0-or-later */
/* prop_avx2.c -- the bits of a machine with AVX2 and no wider vectors are those of this machine. */
#define FEATURES (1u << 10)
#include "support/width.h"
