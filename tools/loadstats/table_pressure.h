/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_pressure.h -- rows of the tables pressure-area, line-load and map. */
#ifndef LOADSTATS_TABLE_PRESSURE_H
#define LOADSTATS_TABLE_PRESSURE_H
#include <stdio.h>
#include "load_map.h"

void pressure_rows(FILE *f, const struct load_map *p);
void line_rows(FILE *f, const struct load_map *p);
void map_rows(FILE *f, const struct load_map *p);

#endif
