/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sphere_sheet.h -- generator --lattice: an ice sheet of equal spheres in close packing. */
#ifndef VORONOI_ICE_SPHERE_SHEET_H
#define VORONOI_ICE_SPHERE_SHEET_H
#include "recipe.h"

int sphere_sheet_check(const char *kind, fl_err *err);
void sphere_sheet_history(const struct recipe *o, fl_history_line *by);
int sphere_sheet_make(struct recipe *o, fl_err *err);

#endif
