/* SPDX-License-Identifier: GPL-3.0-or-later */
/* state.h -- for fuzz targets: the state inside a checkpoint, behind its hash. */
#ifndef FL_TESTS_STATE_H
#define FL_TESTS_STATE_H
#include <stddef.h>
#include "support/small_world.h"

/* Reads the bytes into a new world of a lab whose scene has been checked; a fuzz_fn (fuzz.h). */
int state_fuzz(const lab *of, const unsigned char *data, size_t n);

#endif
