/* SPDX-License-Identifier: GPL-3.0-or-later */
/* generator_table.h -- all generators of ice fields. */
#ifndef VORONOI_ICE_GENERATOR_TABLE_H
#define VORONOI_ICE_GENERATOR_TABLE_H
#include "generator.h"

/* The last row is the default. */
extern const struct generator generator_table[];
extern const int generator_count;

/* 1 if the generator reads the long option. */
int generator_reads(const struct generator *g, const char *option);

#endif
