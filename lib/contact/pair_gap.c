/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/simd.h"
#include "contact/pair_gap.h"
#include "contact/pair_geometry.h"
#include "contact/pair_law.h"
#include "contact/pair_store.h"
#include "world/access.h"

/* Of lengths: more than the rounding of all terms, and of the axis, to single precision. */
#define ROUNDING 0x1p-22

/* The axis of a pair, in world axes and in those of i. */
typedef struct {
    fl_vec3 n, k;
} pair_axis;

/* v rotated by q, without a matrix: v + 2 u x (w v + u x v), u the vector of q. */
FL_SIMD_INLINE fl_vec3 rotated(fl_quat q, fl_vec3 v)
{
    const fl_vec3 u = v3(q.x, q.y, q.z);
    return v3_madd(v, 2.0, v3_cross(u, v3_madd(v3_cross(u, v), q.w, v)));
}

FL_SIMD_INLINE pair_axis axis_of(const fl_world *w, const fl_neighbour_pair *q)
{
    const fl_vec3 axis = q->contact ? q->contact->axis
                                    : v3((double)q->axis[0], (double)q->axis[1], (double)q->axis[2]),
                  n = rotated(w->b.q[q->j], axis);
    return (pair_axis){n, rotated(q_conj(w->b.q[q->i]), n)};
}

void fl_pair_store_gap(const fl_world *w, fl_neighbour_pair *q)
{
    const fl_bodies *b = &w->b;
    const int32_t i = q->i, j = q->j;
    const double gap = q->free_travel - (b->odometer[i] + b->odometer[j]); /* exactly 0 without one */
    q->gap.k[0] = q->gap.k[1] = q->gap.k[2] = 0.0f;
    const int has_axis = q->contact ? q->contact->has_axis : q->has_axis;
    if (q->touching || j >= w->n || w->sleep.state || !(gap > 0.0) || !has_axis || b->core[i].nv == 1 ||
        b->core[j].nv == 1 || fl_pair_law_of(w, i, j)->law->points != FL_POINTS_PATCH)
        return;
    const pair_axis a = axis_of(w, q);
    const double level = b->radius[i] + b->radius[j] + gap + v3_dot(a.n, fl_separation(w, i, j, q->image));
    q->gap = (fl_known_gap){{(float)a.k.x, (float)a.k.y, (float)a.k.z}, (float)level};
}

int fl_pair_keeps_gap(fl_world *w, int32_t c)
{
    fl_neighbour_pair *const q = &w->pair[c];
    const fl_known_gap *const g = &q->gap;
    const fl_bodies *b = &w->b;
    const int32_t i = q->i, j = q->j;
    const pair_axis a = axis_of(w, q);
    const fl_vec3 y = fl_separation(w, i, j, q->image),
                  turn = v3_sub(a.k, v3((double)g->k[0], (double)g->k[1], (double)g->k[2]));
    const double rho = b->bounding_radius[i], level = (double)g->level, R = b->radius[i] + b->radius[j],
                 sizes = fabs(level) + fabs(y.x) + fabs(y.y) + fabs(y.z) + rho + b->bounding_radius[j],
                 slack = ROUNDING * sizes, distance = level - v3_dot(a.n, y) - rho * v3_norm(turn) - slack;
    if (!(distance > R)) return 0;
    fl_neighbour_pair_set_distance(w, q, distance);
    if (q->contact) fl_neighbour_pair_put_back(w, q, q->contact); /* forgotten where far enough apart */
    fl_set_next_check(w, c);
    return 1;
}
