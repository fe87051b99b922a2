/* SPDX-License-Identifier: GPL-3.0-or-later */
/* final_ice.h -- the ice at the end of a run as g-polys(5): output.final_ice. */
#ifndef FL_DEM_SOLVE_FINAL_ICE_H
#define FL_DEM_SOLVE_FINAL_ICE_H
#include "run_context.h"

/* Writes the floes in the domain, fragments included, in their poses and with their velocities, without bonds
 * and groups.  -1 with FL_SYSTEM. */
int write_final_ice(const struct run *r, fl_err *err);

#endif
