/* SPDX-License-Identifier: GPL-3.0-or-later */
/* memory_use.h -- what a world takes of memory, by kind: arrays and blocks as long as they were asked for,
 * without what the allocator adds and without what was read (fields, scene). */
#ifndef FL_SIM_MEMORY_USE_H
#define FL_SIM_MEMORY_USE_H
#include "world/world.h"

typedef struct {
    double bodies;        /* state, forces, works and books of bodies                                   [B] */
    double shapes;        /* cores                                                                         */
    double water;         /* outer shapes and hulls, what water and wind keep                              */
    double search;        /* lists of who is near and who touches                                          */
    double pairs;         /* near pairs, but for                                                           */
    double feature_pairs; /* which of their features may touch                                             */
    double
        sphere_contacts; /* pairs of spheres                                                              */
    double others;       /* structure, bonds, sleep, panels, traffic, scratch of the threads              */
    double search_peak;  /* while neighbours are searched: boxes and their tree; in no sum                */
} fl_memory_use;

fl_memory_use fl_memory_use_of(const fl_world *w);

/* Of all that lasts. */
double fl_memory_use_sum(const fl_memory_use *b);

#endif
