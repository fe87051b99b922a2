/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floe_field.h -- the default generator: floes inside Voronoi or power cells, in one layer or several. */
#ifndef VORONOI_ICE_FLOE_FIELD_H
#define VORONOI_ICE_FLOE_FIELD_H
#include "recipe.h"

void floe_field_history(const struct recipe *o, fl_history_line *by);
int floe_field_make(struct recipe *o, fl_err *err);

#endif
