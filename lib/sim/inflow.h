/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inflow.h -- floes that leave the domain, and floes that come in. */
#ifndef FL_SIM_INFLOW_H
#define FL_SIM_INFLOW_H
#include "world/world.h"

/* What the scene says of who leaves and who comes, and places for those: w->n rises by them.  Nothing where
 * no bound is free.
 *   field, feed  the ice, and what comes in again and again; borrowed
 * -1 with FL_INPUT (an empty feed, or more floes than anybody means) or FL_SYSTEM. */
int fl_inflow_make(fl_world *w, const fl_ice_field *field, const fl_ice_field *feed, fl_err *err);
void fl_inflow_free(fl_inflow_state *t);

/* How far along the axis of t the outermost points of floe k of a field stand: the larger (end = 1) or the
 * smaller (end = -1) coordinate along it [m]. */
double fl_inflow_extent(const fl_inflow_state *t, const fl_ice_field *field, int32_t k, double end);

/* Between two steps: take out who is wholly beyond a free bound, let go of the guided floes that are wholly
 * inside, and give those that are due their place where it is free.  What is due stands as the sheet does; a
 * floe whose place is taken waits with its foremost point at the bound, and is given up when it is a pitch
 * late.  The energies of who leaves and who comes, with those of the contacts that end, go to
 * ledger.carried.  A function of the state alone.  Only where w->traffic.away is not NULL.
 * Returns 0, or -1 with FL_SYSTEM or FL_NUMERIC (no id is left). */
int fl_inflow_step(fl_world *w, fl_err *err);

/* Guide floe i: it is held in x, y and about z as well; or let go of it. */
void fl_inflow_set_guided(fl_world *w, int32_t i, int guided);

/* Floes that are there. */
int32_t fl_floes_in_domain(const fl_world *w);

#endif
