/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gpu_outflow.h -- bodies that leave the domain between two steps, while the others stay on the device. */
#ifndef FL_GPU_GPU_OUTFLOW_H
#define FL_GPU_GPU_OUTFLOW_H
#include "gpu/gpu_world.h"
#include "sphere/leaving.h"

/* Finds the device's own bodies that are outside, their contacts and bonds, and brings them and their
 * partners down.  1; 0 if one of them is near the structure or a wall, or touches a body that is or that the
 * CPU moves: all have to come down; -1 with FL_SYSTEM. */
int fl_gpu_world_find_leaving(fl_gpu_world *g, fl_world *w, fl_leaving *l, fl_err *err);

/* Empties their places, after they have been taken out of the world; sums and forces of their partners are
 * new there and here. */
int fl_gpu_world_drop(fl_gpu_world *g, fl_world *w, const fl_leaving *l, fl_err *err);

#endif
