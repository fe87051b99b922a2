/* SPDX-License-Identifier: GPL-3.0-or-later */
/* wave_path.h -- the predicted path of a body through a block of waves, and the load on it (wave_block.h).
 *
 * A block begins with the present state of the body. Its path is predicted by the forces of the block before:
 * buoyancy on the plane, D and G, which go on linearly beyond the last sample; weight and added mass;
 * contacts and drag are left out. For a mesh all forces but those of the water stay as they are. Two steps of
 * the velocity Verlet method lead from sample to sample. Samples in the past lie on the parabola through the
 * present. A first block, without one before, moves at constant velocity. A deviation d of the body from the
 * path leaves (k d)^2/2 of the force that G does not describe. */
#ifndef FL_WATER_WAVE_PATH_H
#define FL_WATER_WAVE_PATH_H
#include "body/body.h"
#include "water/wave_block.h"

/* Load on a body at a pose and time: that of still water up to the plane, and what the plane leaves out.
 *   v        out: values of the block;   wet: out, submerged part under the plane, body axes
 *   f, t     out: force, and moment about the centre, world axes [N], [N m] */
void fl_wave_block_load(const fl_wave_block *c, const fl_wave_water *sea, const fl_wave_body *body,
                        double time, fl_vec3 x, fl_quat q, fl_wave_values *v, fl_submerged *wet, fl_vec3 *f,
                        fl_vec3 *t);

/* Begins the block of body i that contains the time, and chooses its length. */
void fl_wave_block_begin(fl_wave_block *c, const fl_wave_water *sea, const fl_wave_body *body,
                         const fl_bodies *b, int32_t i, double time);

#endif
