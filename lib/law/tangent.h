/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tangent.h -- friction of one contact: an elastic spring along it and one about its normal, which remember,
 * and Coulomb's limit for the two together. */
#ifndef FL_LAW_TANGENT_H
#define FL_LAW_TANGENT_H
#include <math.h>
#include "geom/sym3.h"
#include "law/damping.h"

/* What a contact remembers from step to step. */
typedef struct {
    fl_vec3 force; /* elastic part of the tangential force on A, world axes [N] */
    double k;      /* tangential stiffness it was built with              [N/m] */
    double moment; /* elastic part of the moment on A about the normal    [N m] */
    double k_turn; /* stiffness that was built with                   [N m/rad] */
} fl_friction_springs;

/* A contact as friction sees it. */
typedef struct {
    fl_vec3 n;              /* unit normal, from B to A */
    double k;               /* tangential stiffness now [N/m]; 0 gives no force */
    double g;               /* tangential damping [N s/m]      */
    double limit;           /* mu |F_n| >= 0 [N]               */
    double arm;             /* root mean square distance of the pressure from its centre [m]; 0 for a point */
    fl_sym3 compliance;     /* of its point, A against B [1/kg] */
    double turn_compliance; /* and of the turn about n for one about n            [1/kg m2] */
    double contact_count;   /* contacts that damp one body, fl_damping_end_speed() */
} fl_friction_contact;

/* How A moves against B at the contact: in the mean of the step, which the springs go by, and at its end, as
 * far as that is foreseen, which damping and sliding go by. */
typedef struct {
    fl_vec3 v, v_end;         /* velocities of its point; normal parts are dropped  [m/s] */
    double spin, spin_end;    /* angular velocities about n                       [rad/s] */
    double mean_spin;         /* mean of that of A and of B about n, in the mean of the step */
    fl_vec3 previous_damping; /* what damping did in the step before, and about n [N], [N m] */
    double previous_damping_moment;
    double half_step; /* half a step, which damping is held back for [s] */
    double at_start;  /* as in fl_damping_end_speed() */
} fl_friction_motion;

/* What a step of friction leaves, and what it does to A. */
typedef struct {
    fl_friction_springs springs;
    fl_vec3 force;
    double moment; /* about n */
} fl_friction_result;

/* A force and a moment over the arm: limited together, by their size. */
typedef struct {
    fl_vec3 f;
    double m;
} fl_friction_wrench;

FL_SIMD_INLINE double fl_friction_wrench_dot(fl_friction_wrench a, fl_friction_wrench b)
{
    return v3_dot(a.f, b.f) + a.m * b.m;
}
FL_SIMD_INLINE double fl_friction_wrench_norm(fl_friction_wrench a)
{
    return sqrt(fl_friction_wrench_dot(a, a));
}
FL_SIMD_INLINE fl_friction_wrench fl_friction_wrench_scale(double s, fl_friction_wrench a)
{
    return (fl_friction_wrench){v3_scale(s, a.f), s * a.m};
}
FL_SIMD_INLINE fl_friction_wrench fl_friction_wrench_madd(fl_friction_wrench a, double s,
                                                          fl_friction_wrench b)
{
    return (fl_friction_wrench){v3_madd(a.f, s, b.f), a.m + s * b.m};
}

/* Sliding: at the limit F = limit e, and e' = -(k/limit)(v - (v.e) e).
 *
 * Where a step takes e to from F0, of that size: |F0| is to be the mean of the limits before and now, and the
 * length of what is returned has no meaning.  s = -k v dt.  With r = F0.s/2F0^2 that is along F0 + (1 + r) s
 * to order 2 for |s| << |F0|, and along s for |s| >> |F0|; 1/(1 - r) for 1 + r where r < 0 keeps it from
 * turning about.  r = a/b; times all that would divide. */
FL_SIMD_INLINE fl_friction_wrench fl_tangent_slide(fl_friction_wrench from, double size, double limit,
                                                   fl_friction_wrench s)
{
    const double mean = 0.5 * (size + limit), a = 0.5 * fl_friction_wrench_dot(from, s), b = size * mean;
    const double over = a > 0.0 ? b : b - a, times = a > 0.0 ? b + a : b;
    return fl_friction_wrench_madd(fl_friction_wrench_scale(over * mean, from),
                                   size > 0.0 ? times * size : 1.0, s);
}

/* The s of that from those by v in the mean of the step and at its end.  For |s| << |F0| it is the former.
 * With the part rho/(2 + rho) of what the latter differs by, rho = |s|/|F0|, e lags behind a v that turns
 * evenly by limit/(k |v|), as it should, whatever the step. */
FL_SIMD_INLINE fl_friction_wrench fl_tangent_slide_path(double size, double limit, fl_friction_wrench s,
                                                        fl_friction_wrench next)
{
    const double way = fl_friction_wrench_norm(s), late = size > 0.0 ? way / (size + limit + way) : 1.0;
    return fl_friction_wrench_madd(s, late, fl_friction_wrench_madd(next, -1.0, s));
}

/* Damping of what moves by `moves`, as foreseen, as in fl_damping_end_speed(): the springs change by `way`, and
 * damping was `before` a step ago.  A contact that rubs rocks as well, which damps the same motion, and
 * counts for one more.  Across n that is an equation of two numbers, x + a P x = r, P = ease without its
 * parts along n: by Cramer's rule, 1 + a P having an eigenvalue of 1 along n. */
FL_SIMD_INLINE fl_friction_wrench fl_tangent_damping(fl_friction_contact c, fl_friction_wrench moves,
                                                     fl_friction_wrench way, fl_friction_wrench before,
                                                     double h, double begins)
{
    const double g = c.g;
    const fl_vec3 n = c.n, u = s3_mul(c.compliance, n);
    const double nn = v3_dot(n, u);
    const fl_sym3 P = {c.compliance.xx - 2.0 * n.x * u.x + nn * n.x * n.x,
                       c.compliance.xy - n.x * u.y - n.y * u.x + nn * n.x * n.y,
                       c.compliance.xz - n.x * u.z - n.z * u.x + nn * n.x * n.z,
                       c.compliance.yy - 2.0 * n.y * u.y + nn * n.y * n.y,
                       c.compliance.yz - n.y * u.z - n.z * u.y + nn * n.y * n.z,
                       c.compliance.zz - 2.0 * n.z * u.z + nn * n.z * n.z};
    const double mean = 0.5 * (P.xx + P.yy + P.zz),
                 a = (fl_damping_implicit_weight(h * g * mean, c.contact_count, 2.0 * c.contact_count) -
                      begins) *
                     h * g;
    const fl_vec3 r = v3_madd(s3_mul(P, v3_madd(v3_scale(-g * h, way.f), a, before.f)), -g, moves.f);
    const double xx = 1.0 + a * P.xx, yy = 1.0 + a * P.yy, zz = 1.0 + a * P.zz, xy = a * P.xy, xz = a * P.xz,
                 yz = a * P.yz;
    const fl_sym3 adjoint = {yy * zz - yz * yz, yz * xz - xy * zz, xy * yz - yy * xz,
                             xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy};
    const double each = 1.0 / (xx * adjoint.xx + xy * adjoint.xy + xz * adjoint.xz);
    const double turns = c.turn_compliance * c.arm * c.arm;
    return (fl_friction_wrench){v3_scale(each, s3_mul(adjoint, r)),
                                (-g * (moves.m + h * turns * way.m) + a * turns * before.m) /
                                    (1.0 + a * turns)};
}

/* What springs keep, and that with damping. */
typedef struct {
    fl_friction_wrench elastic, total;
} fl_friction_forces;

/* Steps 3 and 4 below: springs that held `from`, of that size, over the way s where they stick, by the way
 * `slide` where they slide; and what damping would do. */
FL_SIMD_INLINE fl_friction_forces fl_tangent_limit(fl_friction_wrench from, double size, fl_friction_wrench s,
                                                   fl_friction_wrench slide, double limit,
                                                   fl_friction_wrench damps)
{
    const fl_friction_wrench to = fl_friction_wrench_madd(from, 1.0, s),
                             flow = fl_tangent_slide(from, size, limit, slide);
    const double held = fl_friction_wrench_norm(to), turned = fl_friction_wrench_norm(flow),
                 keeps = turned > 0.0 ? limit / turned : 0.0;
    const int sticks = !(held > limit);
    const fl_friction_wrench slid = fl_friction_wrench_scale(keeps, flow);
    const fl_friction_wrench kept = {
        v3(sticks ? to.f.x : slid.f.x, sticks ? to.f.y : slid.f.y, sticks ? to.f.z : slid.f.z),
        sticks ? to.m : slid.m};
    const double wants = fl_friction_wrench_norm(damps), room = sticks ? limit - held : 0.0,
                 part = wants > room ? room / wants : 1.0;
    return (fl_friction_forces){kept, fl_friction_wrench_madd(kept, part, damps)};
}

/* A spring whose two ends yield alike in all directions, as friction of a point between spheres is. */
typedef struct {
    double k, g;          /* stiffness now [N/m] and damping [N s/m] */
    double limit;         /* of its force [N] */
    double inv_mass;      /* velocity at which the two part for an impulse [1/kg] */
    double contact_count; /* contacts that damp one body, fl_damping_end_speed() */
} fl_tangent_spring;

/* Steps 2 to 4 below for it: a force that was `kept` and has turned into `turned` since, which gets its
 * length, of a spring built with k = old; v in the mean of the step and as foreseen for its end; what damping
 * did in the step before; h: half a step, begins: as in fl_damping_end_speed(). */
FL_SIMD_INLINE fl_friction_forces fl_tangent_point_step(fl_vec3 kept, fl_vec3 turned, double old,
                                                        fl_tangent_spring c, fl_vec3 v, fl_vec3 next,
                                                        fl_vec3 was, double dt, double h, double begins)
{
    const double before = v3_norm(kept), after = v3_norm(turned), k = c.k;
    const double fell = before * (k < old ? k : 1.0), than = k < old ? old : 1.0,
                 share = fell / (than * (after > 0.0 ? after : 1.0));
    const double way = (k < old ? k : 0.5 * (k + old)) * dt;
    const fl_friction_wrench from = {v3_scale(share, turned), 0.0}, goes = {v3_scale(-way, v), 0.0},
                             ahead = {v3_scale(-way, next), 0.0};
    const double g = c.g, yields = c.inv_mass, many = c.contact_count,
                 holds = (fl_damping_implicit_weight(h * g * yields, many, 2.0 * many) - begins) * h * g,
                 each = 1.0 / (1.0 + holds * yields);
    const fl_vec3 damps = v3_madd(v3_scale(-g, next), yields, v3_madd(v3_scale(-g * h, goes.f), holds, was));
    const double size = share * after;
    return fl_tangent_limit(from, size, goes, fl_tangent_slide_path(size, c.limit, goes, ahead), c.limit,
                            (fl_friction_wrench){v3_scale(each, damps), 0.0});
}

/* One step of friction, without a branch or a pointer, so that it goes into loops over lanes.
 *
 * 1. The remembered force is turned about n by the mean spin of the pair, laid into the tangent plane and
 *    given back its length: it rolls with the contact.
 * 2. F -= k v dt, M -= k arm^2 w dt, with the mean of k before and now where that has risen.  Where it has
 *    fallen force and moment fall with it first (Thornton, J. Appl. Mech. 64 (1997) 363): kept, they would
 *    hold more energy than was put in; F/k -= v dt.  Both are of order 2.
 * 3. The two are limited together, (F/limit)^2 + (M/(limit arm))^2 <= 1: beyond, it slides, and they keep
 *    the limit and turn as fl_tangent_slide() has it.  Source of the ellipse: Goyal, Ruina & Papadopoulos,
 *    Wear 143 (1991) 307.
 * 4. Damping is added as fl_tangent_damping() foresees it, -g v and -g arm^2 w of the end of the step, but no
 *    more of it than the limit leaves beside the springs: none where it slides, as Coulomb has it (V04 of
 *    verify_spheres), and the force does not jump as that begins or ends.
 *
 *   dt      [s] */
FL_SIMD_INLINE fl_friction_result fl_tangent_step(fl_friction_springs s, fl_friction_contact c,
                                                  fl_friction_motion by, double dt)
{
    const double before = v3_norm2(s.force), k = c.k, turning = k * c.arm * c.arm;
    const fl_vec3 rolled = v3_madd(s.force, by.mean_spin * dt, v3_cross(c.n, s.force));
    const fl_vec3 laid = v3_madd(rolled, -v3_dot(rolled, c.n), c.n);
    const double after = v3_norm2(laid), length = after > 0.0 ? sqrt(before / after) : 1.0;
    const double fall = k < s.k ? k / s.k : 1.0, fall_turn = turning < s.k_turn ? turning / s.k_turn : 1.0;
    const double stiff = k < s.k ? k : 0.5 * (k + s.k),
                 stiff_turn = turning < s.k_turn ? turning : 0.5 * (turning + s.k_turn);
    const double each = c.arm > 0.0 ? 1.0 / c.arm : 0.0;
    const fl_vec3 v = v3_madd(by.v, -v3_dot(by.v, c.n), c.n),
                  next = v3_madd(by.v_end, -v3_dot(by.v_end, c.n), c.n);
    const fl_friction_wrench from = {v3_scale(fall, v3_scale(length, laid)), each * (fall_turn * s.moment)},
                             way = {v3_scale(-stiff * dt, v), each * (-stiff_turn * dt * by.spin)},
                             way_next = {v3_scale(-stiff * dt, next),
                                         each * (-stiff_turn * dt * by.spin_end)},
                             moves = {next, c.arm * by.spin_end},
                             damped = {by.previous_damping, each * by.previous_damping_moment};
    const double size = fl_friction_wrench_norm(from);
    const fl_friction_wrench damps = fl_tangent_damping(c, moves, way, damped, by.half_step, by.at_start);
    const fl_friction_forces now = fl_tangent_limit(
        from, size, way, fl_tangent_slide_path(size, c.limit, way, way_next), c.limit, damps);
    return (fl_friction_result){
        {now.elastic.f, k, c.arm * now.elastic.m, turning}, now.total.f, c.arm * now.total.m};
}

/* The stiffness was taken for another all the time, and is `by` times as large.  Where it has fallen
 * meanwhile force and moment have fallen with what it was taken for, and now with what it is.  Where it has
 * risen the springs have not been unloaded: they keep their forces where they are stiffer; where they are
 * softer that would make energy, and they keep what they hold. */
static inline void fl_tangent_rescale(fl_friction_springs *s, double by, int fell)
{
    const double left = fell ? by : by < 1.0 ? sqrt(by) : 1.0;
    s->k *= by;
    s->k_turn *= by;
    s->force = v3_scale(left, s->force);
    s->moment *= left;
}

/* Energy held by the springs, F^2 / 2k + M^2 / 2 k_turn [J]. */
FL_SIMD_INLINE double fl_tangent_energy(fl_friction_springs s)
{
    return (s.k > 0.0 ? 0.5 * v3_norm2(s.force) / s.k : 0.0) +
           (s.k_turn > 0.0 ? 0.5 * s.moment * s.moment / s.k_turn : 0.0);
}

#endif
