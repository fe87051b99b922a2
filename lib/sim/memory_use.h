/* SPDX-License-Identifier: GPL-3.0-or-later */
/* memory_use.h -- the memory of a world by kind of data [B]: arrays with their requested length, without the
 * overhead of the allocator and without the inputs (fields, scene). */
#ifndef FL_SIM_MEMORY_USE_H
#define FL_SIM_MEMORY_USE_H
#include "world/world.h"

typedef struct {
    double bodies;          /* state, forces and works of bodies */
    double shapes;          /* cores */
    double water;           /* outer shapes and hulls, data of water and wind */
    double search;          /* lists of near pairs per body and of touching pairs */
    double pairs;           /* near pairs and contacts, without: */
    double feature_pairs;   /* their lists of features that may touch */
    double sphere_contacts; /* pairs of spheres */
    double others;          /* structure, bonds, joints, sleep, panels, inflow, scratch of the threads */
    double search_peak;     /* during a neighbour search, boxes and their tree; in no sum */
} fl_memory_use;

fl_memory_use fl_memory_use_of(const fl_world *w);

/* Sum of all but search_peak. */
double fl_memory_use_sum(const fl_memory_use *b);

#endif
