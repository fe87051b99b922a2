/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/patch_law.h"
#include "base/pi.h"

int fl_patch_points_add_vertex(fl_patch_points *w, const fl_patch_core *own, double other, int32_t v,
                               fl_vec3 n, double overlap)
{
    const double weight = fl_poly_corner_angle(own->p, v) * FL_PATCH_CORNER_WEIGHT, s2 = overlap * overlap;
    const double k = (weight < 1.0 ? weight : 1.0) * FL_PATCH_ROUND_FACTOR * (0.4 * PI) *
                     fl_patch_feature_radius(own->r, other);
    if (!(k > 0.0)) return 0;
    fl_patch_point *const to = fl_patch_points_next(w);
    if (!to) return -1;
    const fl_vec3 normal = v3_scale(own->side, n);
    *to = (fl_patch_point){.overlap = overlap,
                           .u = k * s2 * s2 * overlap,
                           .du = 5.0 * k * s2 * s2,
                           .ddu = 20.0 * k * s2 * overlap,
                           .n = normal,
                           .unit_normal = normal,
                           .p = v3_madd(own->v[v], 0.5 * overlap - own->r, n)};
    return 0;
}
