/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "contact/pair_response.h"

double fl_pair_mass(const fl_world *w, const fl_pair *p, const fl_pair_mobility *e, fl_vec3 f, fl_vec3 ti,
                    fl_vec3 tj)
{
    if (fl_pair_has_reduced_mass(w, p)) return p->mass;
    const double compliance = fl_mobility_along(&e->i, f, v3_scale(0.5, ti)) +
                              fl_mobility_along(&e->j, f, v3_scale(0.5, tj)),
                 mass = v3_norm2(f) / compliance;
    return isfinite(mass) ? mass : p->mass; /* nothing moves */
}

double fl_pair_compliance(const fl_pair_mobility *e, fl_vec3 f, fl_vec3 ti, fl_vec3 tj, double pressure)
{
    const double f2 = fmax(v3_norm2(f), 0.25 * pressure * pressure);
    return f2 > 0.0 ? (fl_mobility_along(&e->i, f, ti) + fl_mobility_along(&e->j, f, tj)) / f2 : 0.0;
}

/* Velocity of the point at `arm` from the centre per impulse there. */
static fl_sym3 point_compliance(const fl_mobility *e, fl_vec3 arm)
{
    const fl_vec3 x = {0, arm.z, -arm.y}, y = {-arm.z, 0, arm.x}, z = {arm.y, -arm.x, 0}; /* arm x axes */
    return s3_add(e->linear,
                  s3_products(x, y, z, s3_mul(e->angular, x), s3_mul(e->angular, y), s3_mul(e->angular, z)));
}

fl_sym3 fl_pair_compliance_matrix(const fl_pair_mobility *e, fl_vec3 ai, fl_vec3 aj)
{
    return s3_add(point_compliance(&e->i, ai), point_compliance(&e->j, aj));
}

double fl_pair_turn_compliance(const fl_pair_mobility *e, fl_vec3 n)
{
    return v3_dot(n, s3_mul(s3_add(e->i.angular, e->j.angular), n));
}
