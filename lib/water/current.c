/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "water/current.h"

fl_vec3 fl_current_at(const fl_current *c, fl_vec3 x, double depth, double t)
{
    (void)x; /* uniform and steady: place, depth and time do not matter */
    (void)depth;
    (void)t;
    return c->velocity;
}
