/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rubble.h -- generator --rubble: a rectangular field filled with ice blocks from bottom to top. */
#ifndef VORONOI_ICE_RUBBLE_H
#define VORONOI_ICE_RUBBLE_H
#include "recipe.h"

void rubble_history(const struct recipe *o, fl_history_line *by);
int rubble_make(struct recipe *o, fl_err *err);

#endif
