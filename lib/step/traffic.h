/* SPDX-License-Identifier: GPL-3.0-or-later */
/* traffic.h -- floes that leave the domain, and floes that come in. */
#ifndef FL_STEP_TRAFFIC_H
#define FL_STEP_TRAFFIC_H
#include "step/world.h"

/* Between two steps: take out who is wholly beyond a free bound, let go of the guided floes that are wholly
 * inside, and give those that are due their place where it is free.  What is due stands as the sheet does; a
 * floe whose place is taken waits with its foremost point at the bound, and is given up when it is a pitch
 * late.  The energies of who leaves and who comes, with those of the contacts that end, go to
 * ledger.carried.  A function of the state alone.  Only where w->traffic.away is not NULL.
 * Returns 0, or -1 with FL_SYSTEM or FL_NUMERIC (no id is left). */
int fl_traffic_step(fl_world *w, fl_err *err);

/* Floes that are there. */
int32_t fl_traffic_there(const fl_world *w);

#endif
