/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gpu_lists.h -- the list of sphere contacts made on the device (gpu_list_kernel.h): keys, sort, counts,
 * offsets, rows, links.  The lists of walls and of all other pairs are the CPU's. */
#ifndef FL_GPU_GPU_LISTS_H
#define FL_GPU_GPU_LISTS_H
#include "gpu/gpu_memory.h"
#include "world/world.h"

/* 1 if the device can make the list of w: all bodies are spheres of laws for spheres, and a periodic cell
 * holds three cells of the search in each of its directions, and no structure. */
int fl_gpu_lists_apply(const fl_world *w);

/* Makes the list anew from the states on the device; rows that were listed before keep their memory. */
int fl_gpu_lists_make(struct fl_gpu_world *g, const fl_world *w, fl_err *err);

#endif
