/* SPDX-License-Identifier: GPL-3.0-or-later */
/* energy_balance.h -- the energy ledger at one moment, its residual, its table, and the hash of the state.
 *
 * The works of contacts are booked step by step (energy_ledger.h); stores are summed here. */
#ifndef FL_SIM_ENERGY_BALANCE_H
#define FL_SIM_ENERGY_BALANCE_H
#include "out/tables.h"
#include "world/world.h"

/* A residual up to this share of the throughput leaves loads usable: dem-solve(1). */
#define FL_ENERGY_ERROR_USABLE 1e-2

/* Compute the stores, sinks, sources, residual and throughput of w->ledger now. */
void fl_energy_update(fl_world *w);

/* The same.  -1 with FL_NUMERIC if the residual is not a finite number; or if, after an overlap above
 * FL_DEEP_OVERLAP, energy is created: the residual is above FL_ENERGY_ERROR_USABLE of the throughput plus the
 * energy stored in contacts. */
int fl_energy_check(fl_world *w, fl_err *err);

/* |residual| over throughput, both as in w->ledger.  A value above FL_ENERGY_ERROR_USABLE becomes 0 if the
 * residual is no more than the rounding of the stored energy, as for floes at rest.  Not finite where the
 * energies are not, or where the throughput is 0. */
double fl_energy_error(const fl_world *w);

/* Sum of the magnitudes of all stores [J]. */
double fl_energy_stored(const fl_world *w);

/* 1 if energy was created or lost: more than FL_ENERGY_ERROR_USABLE of the throughput plus the energy
 * stored in contacts. */
int fl_energy_unbalanced(const fl_world *w);

/* The table energy(5); its rows are w->ledger.  The options say which columns the table of w has. */
extern const fl_table_format fl_energy_table;
unsigned fl_energy_table_options(const fl_world *w);

/* Hash of position, orientation, velocity and angular momentum of all floes and of all movers with free
 * directions. */
uint64_t fl_state_hash(const fl_world *w);

#endif
