/* SPDX-License-Identifier: GPL-3.0-or-later */
/* footprint.h -- what a world takes of memory, by kind: arrays and blocks as long as they were asked for,
 * without what the allocator adds and without what was read (fields, scene). */
#ifndef FL_STEP_FOOTPRINT_H
#define FL_STEP_FOOTPRINT_H
#include "world/world.h"

typedef struct {
    double bodies;  /* state, forces, works and books of bodies                                   [B] */
    double shapes;  /* cores                                                                         */
    double water;   /* outer shapes and hulls, what water and wind keep                              */
    double search;  /* lists of who is near and who touches                                          */
    double pairs;   /* near pairs, but for                                                           */
    double lists;   /* which of their features may touch                                             */
    double balls;   /* pairs of spheres                                                              */
    double others;  /* structure, bonds, sleep, panels, traffic, scratch of the threads              */
    double passing; /* while neighbours are searched: boxes and their tree; in no sum                */
} fl_footprint;

fl_footprint fl_footprint_of(const fl_world *w);

/* Of all that lasts. */
double fl_footprint_sum(const fl_footprint *b);

#endif
