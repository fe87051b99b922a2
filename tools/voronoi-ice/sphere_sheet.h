/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sphere_sheet.h -- --lattice: a sheet of spheres in place of floes. */
#ifndef VORONOI_ICE_SPHERE_SHEET_H
#define VORONOI_ICE_SPHERE_SHEET_H
#include "base/err.h"
#include "options.h"

/* Make the sheet, write it and its certificate.  0, or -1 with err. */
int sheet_run(struct options *o, fl_err *err);

#endif
