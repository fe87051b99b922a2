/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inflow.h -- floes that leave the domain through free bounds, and floes that come in:
 * world/inflow_state.h. */
#ifndef FL_SIM_INFLOW_H
#define FL_SIM_INFLOW_H
#include "world/world.h"

/* Build w->inflow from the scene; w->n grows by the places for floes that come in.  Nothing without a
 * free bound.
 *   field, feed  ice of the start; field that comes in again and again; both borrowed
 * -1 with FL_INPUT (an empty feed, or too many floes) or FL_SYSTEM. */
int fl_inflow_make(fl_world *w, const fl_ice_field *field, const fl_ice_field *feed, fl_err *err);
void fl_inflow_free(fl_inflow_state *t);

/* Largest (end = 1) or smallest (end = -1) coordinate of floe k of a field along the axis of t [m]. */
double fl_inflow_extent(const fl_inflow_state *t, const fl_ice_field *field, int32_t k, double end);

/* Between two steps: remove the floes that are wholly beyond a free bound, release the guided floes that
 * are wholly inside, and place the floes that are due where there is room.  A floe whose place is taken
 * waits with its foremost point at the bound, and is dropped when it is a pitch late.  The energies of
 * floes that leave and come, with those of contacts that end, go to ledger.carried.  A function of the
 * state alone; only called where w->inflow.absent is not NULL.  0, or -1 with FL_SYSTEM or FL_NUMERIC (no
 * id is left). */
int fl_inflow_step(fl_world *w, fl_err *err);

/* Guide floe i, with x, y and the rotation about z fixed, or release it. */
void fl_inflow_set_guided(fl_world *w, int32_t i, int guided);

/* Number of floes in the domain. */
int32_t fl_floes_in_domain(const fl_world *w);

/* Takes the floes marked in gone[n] out of the domain, between two steps; there must be a free bound or a
 * stage that removes. -1 with FL_SYSTEM. */
int fl_inflow_remove(fl_world *w, const uint8_t *gone, fl_err *err);

#endif
