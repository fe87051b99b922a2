/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "world/world.h"
#include <math.h>
#include <stdio.h>
#include "geom/quat.h"

static fl_vec3 normal_of(const fl_piece *wall) { return q_rotate(wall->q, v3(0, 0, 1)); }

const char *fl_wall_name(const fl_world *w, int32_t k, char name[64])
{
    const fl_piece *wall = &w->structure.piece[w->pieces + k];
    const fl_vec3 e = normal_of(wall);
    const char axis = fabs(e.x) > 0.5 ? 'x' : fabs(e.y) > 0.5 ? 'y' : 'z';
    snprintf(name, 64, "the wall at %c = %g m", axis,
             axis == 'x'   ? wall->x.x
             : axis == 'y' ? wall->x.y
                           : wall->x.z);
    return name;
}

int32_t fl_world_id(const fl_world *w, int32_t k)
{
    if (k < w->n) return w->id[k];
    const int32_t part = w->structure.piece[k - w->n].part;
    return part >= 0 ? -1 - part : -1 - w->parts - (k - w->n - w->pieces);
}
