/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "law/tangent.h"

/* Scale force and moment onto the ellipse where they lie outside it; 1 when they did. */
static int limited(const fl_rubbing *c, fl_vec3 *f, double *m)
{
    const double arm = c->arm > 0.0 ? *m / c->arm : 0.0, size2 = v3_norm2(*f) + arm * arm;
    if (size2 <= c->limit * c->limit) return 0;
    const double share = c->limit / sqrt(size2);
    *f = v3_scale(share, *f);
    *m *= share;
    return 1;
}

fl_vec3 fl_tangent_force(fl_slip *s, const fl_rubbing *c, fl_vec3 v, double spin, double twist, double dt,
                         double *moment)
{
    const fl_vec3 n = c->n;
    const double before = v3_norm2(s->force), k = c->k, k_turn = k * c->arm * c->arm;
    fl_vec3 f = s->force;
    double m = s->moment;
    if (before > 0.0) {
        f = v3_madd(f, twist * dt, v3_cross(n, f));
        f = v3_madd(f, -v3_dot(f, n), n);
        const double after = v3_norm2(f);
        if (after > 0.0) f = v3_scale(sqrt(before / after), f);
        if (k < s->k) f = v3_scale(k / s->k, f);
    }
    if (k_turn < s->k_turn) m *= k_turn / s->k_turn;
    v = v3_madd(v, -v3_dot(v, n), n);
    f = v3_madd(f, -k * dt, v);
    m -= k_turn * dt * spin;
    s->k = k;
    s->k_turn = k_turn;
    const int slides = limited(c, &f, &m);
    s->force = f;
    s->moment = m;
    if (!slides) {
        f = v3_madd(f, -c->g, v);
        m -= c->g * c->arm * c->arm * spin;
        limited(c, &f, &m);
    }
    *moment = m;
    return f;
}
