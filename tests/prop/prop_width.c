/* SPDX-License-Identifier: GPL-3.0-or-later */
/* prop_width.c -- the bits of a machine without vectors are those of this machine. */
#define FEATURES 0
#include "support/width.h"
