/* SPDX-License-Identifier: GPL-3.0-or-later */
/* free_cone.h -- how far the exact law of a cone, and not that of its polyhedron, holds near the ends of
 * an interval of its axis.
 *
 * With z the height of the centre of a body, e the half of its extent along the axis plus its reach, and
 *     t = distance of the end / e - 1,    S(t) = t^3 (10 - 15 t + 6 t^2)  between t = 0 and 1,
 * the weight of the cone is the product of S over the two ends: 0 where an end is nearer than e, 1 where
 * both are farther than 2 e, with two continuous derivatives. */
#ifndef FL_STRUCTURE_FREE_CONE_H
#define FL_STRUCTURE_FREE_CONE_H
#include "structure/structure.h"

typedef struct {
    double weight; /* of the cone; the rest is that of the polyhedron */
    double slope;  /* derivative by z [1/m] */
    double size;   /* derivative by e [1/m] */
} fl_cone_weight;

static inline fl_cone_weight fl_cone_weight_between(double from, double to, double z, double e)
{
    double share[2], along[2], by_size[2];
    for (int end = 0; end < 2; end++) {
        const double t = (end ? to - z : z - from) / e - 1.0, u = t <= 0.0 ? 0.0 : t >= 1.0 ? 1.0 : t;
        const double bend = 30.0 * u * u * (1.0 - u) * (1.0 - u) / e;
        share[end] = u * u * u * (10.0 + u * (6.0 * u - 15.0));
        along[end] = end ? -bend : bend;
        by_size[end] = -bend * (t + 1.0);
    }
    return (fl_cone_weight){share[0] * share[1], along[0] * share[1] + share[0] * along[1],
                            by_size[0] * share[1] + share[0] * by_size[1]};
}

/* The same of a cone in a joined piece: that of the free interval that z lies in, or 0. */
static inline fl_cone_weight fl_free_cone_weight(const fl_free_cone *c, double z, double e)
{
    for (int32_t k = 0; k < c->n; k++)
        if (z > c->free[k].from && z < c->free[k].to)
            return fl_cone_weight_between(c->free[k].from, c->free[k].to, z, e);
    return (fl_cone_weight){0};
}

#endif
