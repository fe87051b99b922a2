/* SPDX-License-Identifier: GPL-3.0-or-later */
/* snapshot.h -- the state of a world as text, and back.  A world that continues from it makes the same
 * steps as the first one would have made, to the bit.
 *
 * A state holds what steps change: bodies; pairs with the memory of friction, damping and distance
 * queries; water; ledger; the loads of the present interval.  It does not hold what follows from scene,
 * ice and structure: the world that reads it has been built from the same ones.  Doubles are the
 * hexadecimal digits of their bits, without leading zeros.  Rows, by name:
 *     world     step, step of the last search, dt, t0, step0, time of the water, skin, critical steps and
 *               body, dt_safe; numbers of parts, things, floes in the water, pairs, sphere contacts
 *     books     start, residual, throughput and works of the ledger; imbalance; largest overlaps; counts
 *     told      hits, checks and misses of surrogates, with contact.surrogate
 *     part ...  impulse, moment and peak of the loads in the interval
 *     traffic   counts of outflow and inflow; next ... of each floe of the feed; place ... of each floe
 *     stage     with stages or run.relax: the next one, step of the last, whether it is at rest, damping;
 *               damped ... of each floe: force and torque of damping, with adaptive the other force
 *     body ...  x v L q w f t, work of constraints, work of the flow (with added mass), odometer now and
 *               at the last search
 *     nap ...   with run.sleep: phase, its steps, bounds, sums for the report
 *     mover ... hash of its track, x v L q w f t, work of constraints, springs and dampers
 *     bond ...  state, energies, radius factor, forces; unless intact damage, its bounds and slip of each
 *               point
 *     pressed   with panels or events: numbers of the rows panel, mark and event that follow
 *     current   hash of its table, if there is one
 *     sea ...   wetted area, buoyancy, energy, drag and wind works, with waves their work;
 *               with water.every in waves the last sample, fl_wave_sample
 *     pair ...  i j, image in a periodic cell, memory; of a touching pair the forces; with
 *               contact.surrogate the last evaluation and what was learnt
 *     ball ...  sphere contact: i j, image in a periodic cell, whether it touches, fl_sphere_contact */
#ifndef FL_SIM_SNAPSHOT_H
#define FL_SIM_SNAPSHOT_H
#include <stdio.h>
#include "base/text.h"
#include "world/world.h"

/* Write the state between two steps.  w is not changed; write errors stay in f. */
void fl_snapshot_write(FILE *f, fl_world *w);

/* Read it into a world that fl_world_make() built from the same scene, ice and structure; fl_step()
 * continues without fl_step_start().  -1 with FL_INPUT (w can then only be freed) or FL_SYSTEM. */
int fl_snapshot_read(fl_world *w, fl_text *in, fl_err *err);

#endif
