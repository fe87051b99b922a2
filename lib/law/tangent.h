/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tangent.h -- friction of one contact: an elastic spring in the tangent plane and one about the normal, with
 * memory, damping and Coulomb's limit for the two together.
 *
 *     dF = -k v dt,  dM = -k a^2 w dt,     (F/L)^2 + (M/(L a))^2 <= 1,  L = mu |F_n|
 *
 *   F, M  tangential force and moment about the normal on body A [N], [N m]
 *   v, w  tangential velocity and spin about the normal, A against B [m/s], [rad/s]
 *   k     tangential stiffness [N/m]
 *   a     root mean square distance of the pressure from its centre; 0 for a point [m]
 *   L     limit of friction [N]
 *
 * A force and a moment over a are handled together as one wrench with the norm sqrt(F^2 + (M/a)^2). */
#ifndef FL_LAW_TANGENT_H
#define FL_LAW_TANGENT_H
#include <math.h>
#include "geom/sym3.h"
#include "law/damping.h"

/* State of the friction springs of a contact, kept from step to step. */
typedef struct {
    fl_vec3 force; /* elastic part of the tangential force on A, world axes [N] */
    double k;      /* tangential stiffness at the last step               [N/m] */
    double moment; /* elastic part of the moment on A about the normal    [N m] */
    double k_turn; /* its stiffness at the last step                  [N m/rad] */
} fl_friction_springs;

/* Properties of the contact. */
typedef struct {
    fl_vec3 n;              /* unit normal, from B to A */
    double k;               /* tangential stiffness now [N/m]; 0 gives no force */
    double g;               /* tangential damping [N s/m]      */
    double limit;           /* mu |F_n| >= 0 [N]               */
    double arm;             /* a [m] */
    fl_sym3 compliance;     /* velocity of A against B at the point for an impulse there [1/kg] */
    double turn_compliance; /* spin about n for an impulse about n            [1/kg m2] */
    double contact_count;   /* contacts that damp one body, fl_damping_end_speed() */
} fl_friction_contact;

/* Motion of A against B at the contact: in the mean of the step, which loads the springs, and predicted for
 * its end, by which damping and sliding go. */
typedef struct {
    fl_vec3 v, v_end;         /* velocities of the point; normal parts are dropped  [m/s] */
    double spin, spin_end;    /* angular velocities about n                       [rad/s] */
    double mean_spin;         /* mean of the spins of A and B about n, in the mean of the step [rad/s] */
    fl_vec3 previous_damping; /* damping force of the step before [N] */
    double previous_damping_moment; /* and its moment about n [N m] */
    double half_step;               /* half a step, for the implicit damping [s] */
    double at_start;                /* as in fl_damping_end_speed() */
} fl_friction_motion;

/* Result of a step: the springs, and force and moment on A. */
typedef struct {
    fl_friction_springs springs;
    fl_vec3 force;
    double moment; /* about n */
} fl_friction_result;

/* A force and a moment over the arm. */
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

/* Direction of the friction of a sliding contact after a step; the length of the result has no meaning.
 *
 * Sliding follows F = limit e, e' = -(k/limit)(v - (v.e) e).  The step starts from F0 of the given size,
 * and |F0| is taken as the mean of the limits before and now.  With s = -k v dt and r = F0.s/2F0^2 the
 * direction is that of F0 + (1 + r) s to order 2 for |s| << |F0|, and that of s for |s| >> |F0|.  Where r <
 * 0, 1/(1 - r) replaces 1 + r, which keeps the direction from reversing.  r is kept as a quotient, and the
 * result is multiplied by the denominators. */
FL_SIMD_INLINE fl_friction_wrench fl_tangent_slide(fl_friction_wrench from, double size, double limit,
                                                   fl_friction_wrench s)
{
    const double mean = 0.5 * (size + limit), a = 0.5 * fl_friction_wrench_dot(from, s), b = size * mean;
    const double over = a > 0.0 ? b : b - a, times = a > 0.0 ? b + a : b;
    return fl_friction_wrench_madd(fl_friction_wrench_scale(over * mean, from),
                                   size > 0.0 ? times * size : 1.0, s);
}

/* The s of fl_tangent_slide(), from s by v in the mean of the step and `next` by v at its end.
 *
 * For |s| << |F0| it is s.  With the weight rho/(2 + rho) of the difference, rho = |s|/|F0|, e lags behind a
 * steadily turning v by limit/(k |v|), as it should, for every step size. */
FL_SIMD_INLINE fl_friction_wrench fl_tangent_slide_path(double size, double limit, fl_friction_wrench s,
                                                        fl_friction_wrench next)
{
    const double way = fl_friction_wrench_norm(s), late = size > 0.0 ? way / (size + limit + way) : 1.0;
    return fl_friction_wrench_madd(s, late, fl_friction_wrench_madd(next, -1.0, s));
}

/* Damping of the predicted motion, held back as in fl_damping_end_speed().
 *
 *   motion    predicted velocity at the end of the step
 *   change    change of the springs' forces in the step
 *   before    damping of the step before
 *   h         half a step [s]
 *
 * A sliding contact also rocks, which damps the same motion, and counts for one contact more.  Across n
 * that is a system of two equations, x + a P x = r, with P = compliance without its parts along n.
 * Cramer's rule solves it; 1 + a P has the eigenvalue 1 along n. */
FL_SIMD_INLINE fl_friction_wrench fl_tangent_damping(fl_friction_contact c, fl_friction_wrench motion,
                                                     fl_friction_wrench change, fl_friction_wrench before,
                                                     double h, double at_start)
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
                      at_start) *
                     h * g;
    const fl_vec3 r = v3_madd(s3_mul(P, v3_madd(v3_scale(-g * h, change.f), a, before.f)), -g, motion.f);
    const double xx = 1.0 + a * P.xx, yy = 1.0 + a * P.yy, zz = 1.0 + a * P.zz, xy = a * P.xy, xz = a * P.xz,
                 yz = a * P.yz;
    const fl_sym3 adjoint = {yy * zz - yz * yz, yz * xz - xy * zz, xy * yz - yy * xz,
                             xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy};
    const double each = 1.0 / (xx * adjoint.xx + xy * adjoint.xy + xz * adjoint.xz);
    const double turns = c.turn_compliance * c.arm * c.arm;
    return (fl_friction_wrench){v3_scale(each, s3_mul(adjoint, r)),
                                (-g * (motion.m + h * turns * change.m) + a * turns * before.m) /
                                    (1.0 + a * turns)};
}

/* Elastic part and total. */
typedef struct {
    fl_friction_wrench elastic, total;
} fl_friction_forces;

/* Applies the limit, steps 3 and 4 of fl_tangent_step().
 *   from     wrench of the springs before the step, of the norm size
 *   s        its change if the contact sticks
 *   slide    its change for fl_tangent_slide() if the contact slides
 *   damping  damping before the limit */
FL_SIMD_INLINE fl_friction_forces fl_tangent_limit(fl_friction_wrench from, double size, fl_friction_wrench s,
                                                   fl_friction_wrench slide, double limit,
                                                   fl_friction_wrench damping)
{
    const fl_friction_wrench to = fl_friction_wrench_madd(from, 1.0, s),
                             flow = fl_tangent_slide(from, size, limit, slide);
    const double stuck_size = fl_friction_wrench_norm(to), flow_size = fl_friction_wrench_norm(flow),
                 scale = flow_size > 0.0 ? limit / flow_size : 0.0;
    const int sticks = !(stuck_size > limit);
    const fl_friction_wrench slid = fl_friction_wrench_scale(scale, flow);
    const fl_friction_wrench kept = {
        v3(sticks ? to.f.x : slid.f.x, sticks ? to.f.y : slid.f.y, sticks ? to.f.z : slid.f.z),
        sticks ? to.m : slid.m};
    const double wanted = fl_friction_wrench_norm(damping), room = sticks ? limit - stuck_size : 0.0,
                 part = wanted > room ? room / wanted : 1.0;
    return (fl_friction_forces){kept, fl_friction_wrench_madd(kept, part, damping)};
}

/* A spring with the same compliance in all directions, as friction at a point between spheres has. */
typedef struct {
    double k, g;          /* stiffness now [N/m] and damping [N s/m] */
    double limit;         /* of its force [N] */
    double inv_mass;      /* velocity at which the two part for an impulse [1/kg] */
    double contact_count; /* contacts that damp one body, fl_damping_end_speed() */
} fl_tangent_spring;

/* Steps 2 to 4 of fl_tangent_step() for such a spring; returns elastic and total force.
 *   kept, turned  its force before the step, and that force turned with the contact; the length is kept's [N]
 *   old           its stiffness at the last step [N/m]
 *   v, v_end      velocity in the mean of the step and predicted for its end [m/s]
 *   damped        damping force of the step before [N]
 *   h, at_start   half a step [s] and as in fl_damping_end_speed() */
FL_SIMD_INLINE fl_friction_forces fl_tangent_point_step(fl_vec3 kept, fl_vec3 turned, double old,
                                                        fl_tangent_spring c, fl_vec3 v, fl_vec3 v_end,
                                                        fl_vec3 damped, double dt, double h, double at_start)
{
    const double before = v3_norm(kept), after = v3_norm(turned), k = c.k;
    const double lowered = before * (k < old ? k : 1.0), divisor = k < old ? old : 1.0,
                 share = lowered / (divisor * (after > 0.0 ? after : 1.0));
    const double kdt = (k < old ? k : 0.5 * (k + old)) * dt;
    const fl_friction_wrench from = {v3_scale(share, turned), 0.0}, change = {v3_scale(-kdt, v), 0.0},
                             change_end = {v3_scale(-kdt, v_end), 0.0};
    const double g = c.g, inv_mass = c.inv_mass, count = c.contact_count,
                 weight =
                     (fl_damping_implicit_weight(h * g * inv_mass, count, 2.0 * count) - at_start) * h * g,
                 each = 1.0 / (1.0 + weight * inv_mass);
    const fl_vec3 damping =
        v3_madd(v3_scale(-g, v_end), inv_mass, v3_madd(v3_scale(-g * h, change.f), weight, damped));
    const double size = share * after;
    return fl_tangent_limit(from, size, change, fl_tangent_slide_path(size, c.limit, change, change_end),
                            c.limit, (fl_friction_wrench){v3_scale(each, damping), 0.0});
}

/* One step of friction over dt [s], without a branch or a pointer, so that loops over lanes can call it.
 *
 * 1. The remembered force is rotated about n by the mean spin of the pair, projected into the tangent plane
 *    and given its length again: it rolls with the contact.
 * 2. F -= k v dt, M -= k arm^2 w dt, with the mean of k before and now where k has risen.  Where k has
 *    fallen, force and moment fall with it first (Thornton, J. Appl. Mech. 64 (1997) 363), since they would
 *    else hold more energy than was put in; then F/k -= v dt.  Both are of order 2.
 * 3. The two are limited together, (F/limit)^2 + (M/(limit arm))^2 <= 1.  Beyond it the contact slides: the
 *    norm is the limit and the direction that of fl_tangent_slide().  Source of the ellipse: Goyal, Ruina &
 *    Papadopoulos, Wear 143 (1991) 307.
 * 4. Damping by fl_tangent_damping(), -g v and -g arm^2 w of the end of the step, is added up to what the
 *    limit leaves beside the springs.  A sliding contact has none, as Coulomb's law says (V04 of
 *    verify_spheres), and the force does not jump as sliding begins or ends. */
FL_SIMD_INLINE fl_friction_result fl_tangent_step(fl_friction_springs s, fl_friction_contact c,
                                                  fl_friction_motion by, double dt)
{
    const double before = v3_norm2(s.force), k = c.k, k_turn = k * c.arm * c.arm;
    const fl_vec3 rolled = v3_madd(s.force, by.mean_spin * dt, v3_cross(c.n, s.force));
    const fl_vec3 laid = v3_madd(rolled, -v3_dot(rolled, c.n), c.n);
    const double after = v3_norm2(laid), length = after > 0.0 ? sqrt(before / after) : 1.0;
    const double fall = k < s.k ? k / s.k : 1.0, fall_turn = k_turn < s.k_turn ? k_turn / s.k_turn : 1.0;
    const double mean_k = k < s.k ? k : 0.5 * (k + s.k),
                 mean_k_turn = k_turn < s.k_turn ? k_turn : 0.5 * (k_turn + s.k_turn);
    const double each = c.arm > 0.0 ? 1.0 / c.arm : 0.0;
    const fl_vec3 v = v3_madd(by.v, -v3_dot(by.v, c.n), c.n),
                  v_end = v3_madd(by.v_end, -v3_dot(by.v_end, c.n), c.n);
    const fl_friction_wrench from = {v3_scale(fall, v3_scale(length, laid)), each * (fall_turn * s.moment)},
                             change = {v3_scale(-mean_k * dt, v), each * (-mean_k_turn * dt * by.spin)},
                             change_end = {v3_scale(-mean_k * dt, v_end),
                                           each * (-mean_k_turn * dt * by.spin_end)},
                             motion = {v_end, c.arm * by.spin_end},
                             damped = {by.previous_damping, each * by.previous_damping_moment};
    const double size = fl_friction_wrench_norm(from);
    const fl_friction_wrench damping =
        fl_tangent_damping(c, motion, change, damped, by.half_step, by.at_start);
    const fl_friction_forces now = fl_tangent_limit(
        from, size, change, fl_tangent_slide_path(size, c.limit, change, change_end), c.limit, damping);
    return (fl_friction_result){
        {now.elastic.f, k, c.arm * now.elastic.m, k_turn}, now.total.f, c.arm * now.total.m};
}

/* Rescales the springs after the exact stiffness turned out to be `by` times the predicted one.
 *
 * Where the stiffness has fallen since (fell), force and moment have fallen with the predicted stiffness
 * and now fall with the exact one.  Where it has risen the springs have not been unloaded: they keep their
 * forces if they are stiffer.  If they are softer that would create energy, and they keep their energy. */
static inline void fl_tangent_rescale(fl_friction_springs *s, double by, int fell)
{
    const double scale = fell ? by : by < 1.0 ? sqrt(by) : 1.0;
    s->k *= by;
    s->k_turn *= by;
    s->force = v3_scale(scale, s->force);
    s->moment *= scale;
}

/* Energy held by the springs, F^2 / 2k + M^2 / 2 k_turn [J]. */
FL_SIMD_INLINE double fl_tangent_energy(fl_friction_springs s)
{
    return (s.k > 0.0 ? 0.5 * v3_norm2(s.force) / s.k : 0.0) +
           (s.k_turn > 0.0 ? 0.5 * s.moment * s.moment / s.k_turn : 0.0);
}

#endif
