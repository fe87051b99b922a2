/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "law/tangent.h"

static fl_vec3 limited(fl_vec3 f, double limit)
{
    const double f2 = v3_norm2(f);
    return f2 > limit * limit ? v3_scale(limit / sqrt(f2), f) : f;
}

fl_vec3 fl_tangent_force(fl_slip *s, fl_vec3 n, fl_vec3 v, double twist, double dt, double k, double g,
                         double limit)
{
    fl_vec3 f = s->force;
    const double before = v3_norm2(f);
    if (before > 0.0) {
        f = v3_madd(f, twist * dt, v3_cross(n, f));
        f = v3_madd(f, -v3_dot(f, n), n);
        const double after = v3_norm2(f);
        if (after > 0.0) f = v3_scale(sqrt(before / after), f);
        if (k < s->k) f = v3_scale(k / s->k, f);
    }
    v = v3_madd(v, -v3_dot(v, n), n);
    f = v3_madd(f, -k * dt, v);
    s->k = k;
    const double f2 = v3_norm2(f);
    if (f2 > limit * limit) return s->force = limited(f, limit);
    s->force = f;
    return limited(v3_madd(f, -g, v), limit);
}
