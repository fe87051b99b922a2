/* SPDX-License-Identifier: GPL-3.0-or-later */
/* dd.h -- double-double numbers of 106 bits, the unevaluated sum of two doubles, and vectors of them, by
 * value.  For the few places where a difference of nearly equal products decides.  Requires IEEE doubles
 * rounded to nearest and no contraction.  Relative error of one operation below 2^-102 without overflow or
 * underflow.
 * Source: Dekker 1971; Joldes, Muller & Popescu, ACM TOMS 44 (2017). */
#ifndef FL_GEOM_DD_H
#define FL_GEOM_DD_H
#include "geom/vec3.h"

typedef struct {
    double h, l; /* value h + l, |l| <= ulp(h) / 2 */
} fl_dd;

typedef struct {
    fl_dd x, y, z;
} fl_ddv;

static inline fl_dd dd_of(double a) { return (fl_dd){a, 0.0}; }
/* a + b exactly, |a| >= |b| (Fast2Sum) */
static inline fl_dd dd_fast_two_sum(double a, double b)
{
    const double s = a + b;
    return (fl_dd){s, b - (s - a)};
}
/* a + b and a b exactly (2Sum, 2Prod) */
static inline fl_dd dd_two_sum(double a, double b)
{
    const double s = a + b, t = s - a;
    return (fl_dd){s, (a - (s - t)) + (b - t)};
}
static inline fl_dd dd_two_prod(double a, double b)
{
    const double p = a * b;
    return (fl_dd){p, fma(a, b, -p)};
}
static inline fl_dd dd_neg(fl_dd a) { return (fl_dd){-a.h, -a.l}; }
static inline fl_dd dd_add(fl_dd a, fl_dd b)
{
    const fl_dd s = dd_two_sum(a.h, b.h), t = dd_two_sum(a.l, b.l), u = dd_fast_two_sum(s.h, s.l + t.h);
    return dd_fast_two_sum(u.h, u.l + t.l);
}
static inline fl_dd dd_sub(fl_dd a, fl_dd b) { return dd_add(a, dd_neg(b)); }
static inline fl_dd dd_mul(fl_dd a, fl_dd b)
{
    const fl_dd p = dd_two_prod(a.h, b.h);
    return dd_fast_two_sum(p.h, p.l + (a.h * b.l + a.l * b.h));
}
static inline fl_dd dd_div(fl_dd a, fl_dd b)
{
    const double q = a.h / b.h;
    fl_dd r = dd_sub(a, dd_mul(dd_of(q), b));
    const double q2 = r.h / b.h;
    r = dd_sub(r, dd_mul(dd_of(q2), b));
    const fl_dd s = dd_fast_two_sum(q, q2);
    return dd_add(s, dd_of(r.h / b.h));
}
/* Has the sign of a - b. */
static inline double dd_cmp(fl_dd a, fl_dd b) { return dd_sub(a, b).h; }

/* a - b exactly */
static inline fl_ddv ddv_diff(fl_vec3 a, fl_vec3 b)
{
    return (fl_ddv){dd_two_sum(a.x, -b.x), dd_two_sum(a.y, -b.y), dd_two_sum(a.z, -b.z)};
}
static inline fl_ddv ddv_sub(fl_ddv a, fl_ddv b)
{
    return (fl_ddv){dd_sub(a.x, b.x), dd_sub(a.y, b.y), dd_sub(a.z, b.z)};
}
static inline fl_ddv ddv_scale(fl_dd s, fl_ddv a)
{
    return (fl_ddv){dd_mul(s, a.x), dd_mul(s, a.y), dd_mul(s, a.z)};
}
/* a + s b */
static inline fl_ddv ddv_madd(fl_ddv a, fl_dd s, fl_ddv b)
{
    return (fl_ddv){dd_add(a.x, dd_mul(s, b.x)), dd_add(a.y, dd_mul(s, b.y)), dd_add(a.z, dd_mul(s, b.z))};
}
static inline fl_dd ddv_dot(fl_ddv a, fl_ddv b)
{
    return dd_add(dd_add(dd_mul(a.x, b.x), dd_mul(a.y, b.y)), dd_mul(a.z, b.z));
}
static inline fl_ddv ddv_cross(fl_ddv a, fl_ddv b)
{
    return (fl_ddv){dd_sub(dd_mul(a.y, b.z), dd_mul(a.z, b.y)), dd_sub(dd_mul(a.z, b.x), dd_mul(a.x, b.z)),
                    dd_sub(dd_mul(a.x, b.y), dd_mul(a.y, b.x))};
}
static inline fl_vec3 ddv_round(fl_ddv a) { return v3(a.x.h, a.y.h, a.z.h); }

#endif
