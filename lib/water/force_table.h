/* SPDX-License-Identifier: GPL-3.0-or-later */
/* force_table.h -- the table of the forces of water and wind, and set-up, plan and energy balance by its
 * rows.
 *
 * To add a force: one file with its functions, and one row of the table in force_table.c. */
#ifndef FL_WATER_FORCE_TABLE_H
#define FL_WATER_FORCE_TABLE_H
#include "water/environment.h"
#include "water/water_force.h"

/* The rows, in the order of the plan. */
extern const fl_water_force fl_water_forces[];
extern const int32_t fl_water_force_count;

/* Sets up s for n bodies by the sections [water] and [wind] of the scene, which is borrowed; leaves s->n at 0
 * without either section.  b: the bodies, allocated.  The caller then sets and fits the hulls.
 *   threads   how many may call fl_environment_force() at once
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM. */
int fl_environment_set_up(fl_environment *s, fl_bodies *b, const fl_scene *scene, int32_t n, int threads,
                          fl_err *err);

/* Adds the energy of body i to the columns [J]; inside: 0 for a body that is not in the domain, which stores
 * none. */
void fl_environment_add_energy(const fl_environment *s, const fl_bodies *b, int32_t i, int inside,
                               double column[FL_FORCE_LEDGERS]);

#endif
