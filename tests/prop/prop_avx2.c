/* SPDX-License-Identifier: GPL-3.0-or-later */
/* prop_avx2.c -- and so are those of a machine that has AVX2 and nothing beyond. */
#define FEATURES (1u << 10)
#include "support/width.h"
