/* SPDX-License-Identifier: GPL-3.0-or-later */
/* device_link.h -- the device that runs the spheres of a world, gpu/gpu_world.h. */
#ifndef FL_WORLD_DEVICE_LINK_H
#define FL_WORLD_DEVICE_LINK_H
#include <stdint.h>

/* gpu = NULL: the CPU runs all.  Else, with stale = 1, bodies, contacts and bonds of the world are older than
 * those of the device: fl_device_refresh() of sim/device_step.h brings them. */
typedef struct {
    struct fl_gpu_world *gpu; /* owned */
    int stale;
    int64_t hand_overs; /* times that all came down for the CPU to change it */
} fl_device_link;

#endif
