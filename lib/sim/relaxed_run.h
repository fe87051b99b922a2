/* SPDX-License-Identifier: GPL-3.0-or-later */
/* relaxed_run.h -- runs that come to rest: damping of run.relax, and the ratio of forces that tells the end.
 *
 * local     each component of the force on a body that points along its velocity is reduced to 0.2 of itself,
 *           each that points against it is raised to 1.8: F - 0.8 |F| sign v, torques likewise. Nothing is
 *           damped that does not move, and forces in a state of rest are the true ones. Source: Cundall, in
 *           Analytical and Computational Methods in Engineering Rock Mechanics (1987).
 * kinetic   all free bodies stop when the kinetic energy falls.
 * adaptive  a force - c m v with c of the frequency that the motion has (body/relaxation.h).
 *
 * Nodes of deformable blocks are damped as bodies are, with their inertia for m; energies and frequency are
 * those of all bodies and nodes together.
 * Their work is in the column damping of energy(5). Bodies with a fixed direction are damped in the others.
 *
 * Ratio: largest force that is not balanced, of the free directions of a body, over the mean force of the
 * joints and contacts that bear one. */
#ifndef FL_SIM_RELAXED_RUN_H
#define FL_SIM_RELAXED_RUN_H
#include "world/world.h"

/* The ratio is looked at every so many steps of a stage. */
enum { FL_RELAX_EVERY = 50 };

/* Sets up the damping of the scene. -1 with FL_SYSTEM. */
int fl_relaxed_run_make(fl_world *w, fl_err *err);
void fl_relaxed_run_free(fl_relax_state *s);

/* Adds the damping force on body k, whose other forces are complete, to its force and to its contact sum. */
void fl_relaxed_run_damp(fl_world *w, int32_t k, fl_contact_sum *sum);

/* Adds the damping force of the last step to the contact sum of body k. */
void fl_relaxed_run_add_sum(const fl_world *w, int32_t k, fl_contact_sum *sum);

/* At the end of a step: kinetic damping, the rate of the next step, and whether the run has settled. */
void fl_relaxed_run_end_step(fl_world *w);

/* The ratio of forces; INFINITY without a force in a joint or contact. */
double fl_relaxed_run_ratio(const fl_world *w);

#endif
