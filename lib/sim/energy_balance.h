/* SPDX-License-Identifier: GPL-3.0-or-later */
/* energy_balance.h -- the energy ledger at one moment, its residual, and the hash of the state. */
#ifndef FL_SIM_ENERGY_BALANCE_H
#define FL_SIM_ENERGY_BALANCE_H
#include "world/world.h"

/* Stores, sinks and residual now, into w->ledger. */
void fl_energy_update(fl_world *w);

/* The same; -1 with FL_NUMERIC where the residual is not a number, or, once an overlap was past half of the
 * radii, tells that energy is being made. */
int fl_energy_check(fl_world *w, fl_err *err);

/* The residual over the throughput, both as in w->ledger.  Where that is more than FL_ENERGY_ERROR_USABLE, up to
 * which dem-solve(1) calls loads usable, but no more than the rounding of what is stored, as of floes at
 * rest, 0.  Infinite or no number where the energies are, or where nothing has gone through yet. */
#define FL_ENERGY_ERROR_USABLE 1e-2

double fl_energy_error(const fl_world *w);

/* What is stored, of any sign [J]. */
double fl_energy_stored(const fl_world *w);

/* Whether energy was made or lost: more than FL_ENERGY_ERROR_USABLE of the throughput and of what contacts store. */
int fl_energy_unbalanced(const fl_world *w);

/* Hash of positions, orientations, velocities and angular momenta of all floes, and of what of the structure
 * moves by itself. */
uint64_t fl_state_hash(const fl_world *w);

#endif
