/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tangent.h -- friction of one contact: an elastic spring of slip and spin with memory, damping, and
 * Coulomb's limit for force and moment together.
 *
 *   F, M   tangential force and moment about the normal n on body A         [N], [N m]
 *   v, w   tangential velocity and spin about n, A against B                [m/s], [rad/s]
 *   k      tangential stiffness                                             [N/m]
 *   L      limit of friction, mu |F_n|                                      [N]
 *   f      pressure at a point of the contact, sum N, centre x_c            [N]
 *   Theta  second moments sum f t t^T / N,  t = (x - x_c) x n               [m2]
 *   rho    root mean square distance of the pressure from its centre,
 *          rho^2 = tr Theta; 0 for a point                                  [m]
 *
 * Coulomb's law at every point, u = v + w n x (x - x_c), f_t = -mu f u/|u|, has the potential mu sum f |u|.
 * It is replaced by L P,
 *     P^2 = v2 + a w2 - h Q,   v2 = z_f.z_f,  w2 = z_m^2,  Q = z_f.D z_f,  h = w2/sqrt(v2^2 + (c w2)^2)
 *     a = 0.75 + 0.135 q,   c = a (2 - 0.6 q^2),   D y = (a - 1) y + Theta y/rho^2
 *     q = 2 (1 - Theta:Theta/rho^4)      1 for a round contact, 0 for a line
 * of z = (v, rho w).  It has the exact expansions of slow spin and of slow drift, and is convex.  At steady
 * sliding (F, M) = -L dP/d(v, w); the limit surface is the image of P = L.  Worst error of F over L and of M
 * over its largest value, with an even pressure: disc 1.2 %, square 2.3 %, 3 by 1 5.4 %, triangle 6.4 %.
 *
 * Spring.  The state is minus the elastic slip times k, z = -k (q_f, rho q_m) [N].  Its wrench is
 *     F = dE/dz_f,  M = rho dE/dz_m,   E = P^2/2,          stored energy P^2/2k,
 * and z is limited radially to P = L.  There the wrench is L dP/dz, whose normal is z: the radial return is
 * the associated flow, and a step dissipates (P(z') - L) L/k >= 0.
 * The stiffness is k for slip, a k rho^2 for spin, between 0 and 1.56 k (round), 1.97 k (line) for both.
 *
 * Theta/rho^2 = (1 - e^2)/2 (1 - n n^T) + e e^T is given by its elongation e, a vector across n with 0 <= |e|
 * <= 1 whose sign has no meaning: 0 for a round contact, a unit vector across a line.  Then q = 1 - e^4.
 *
 * A point has rho = 0 and z_m = 0: F = z_f, |F| <= L.
 *
 * Limits.  An even stress under partial slip is not resolved: a contact sticks as a whole up to the limit.
 *
 * Sources: Goyal, Ruina & Papadopoulos, Wear 143 (1991) 307 (limit surface, normality); Farkas, Bartels,
 * Unger & Wolf, Phys. Rev. Lett. 90 (2003) 248302 (disc).  The exact integrals are in
 * tests/support/exact_friction.h.
 *
 * A force and a moment over rho are handled together as one wrench. */
#ifndef FL_LAW_TANGENT_H
#define FL_LAW_TANGENT_H
#include <math.h>
#include "geom/sym3.h"
#include "law/damping.h"

/* State of the friction springs of a contact, kept from step to step. */
typedef struct {
    fl_vec3 force;         /* z_f, world axes                                          [N] */
    double k;              /* tangential stiffness at the last step                  [N/m] */
    double moment;         /* rho z_m                                                [N m] */
    double k_turn;         /* k rho^2 at the last step                           [N m/rad] */
    double energy;         /* P^2/2k                                                   [J] */
    fl_vec3 damping;       /* friction force of the last step without its spring       [N] */
    double damping_moment; /* and moment about the normal                            [N m] */
} fl_friction_springs;

/* Properties of the contact. */
typedef struct {
    fl_vec3 n;              /* unit normal, from B to A */
    double k;               /* tangential stiffness now [N/m]; 0 gives no force */
    double g;               /* tangential damping [N s/m]      */
    double limit;           /* mu |F_n| >= 0 [N]               */
    double arm;             /* rho [m] */
    fl_vec3 elongation;     /* e of Theta; its part along n is dropped */
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

/* P of a contact, but for the pressure: the coefficients of the limit. */
typedef struct {
    double a, c;
    double even; /* D y = even y + e (e.y) */
    fl_vec3 elongation;
} fl_friction_shape;

/* From e across n. */
FL_SIMD_INLINE fl_friction_shape fl_friction_shape_of(fl_vec3 elongation)
{
    const double p = v3_norm2(elongation), q = p < 1.0 ? 1.0 - p * p : 0.0, a = 0.75 + 0.135 * q;
    return (fl_friction_shape){a, a * (2.0 - 0.6 * q * q), a - 0.5 - 0.5 * p, elongation};
}

/* P^2 of z, and the numbers of its gradient; h, j and i v2 do not depend on the length of z. */
typedef struct {
    double p2, h, j, spin; /* spin: a - j v2 i */
} fl_friction_potential;

FL_SIMD_INLINE double fl_friction_quadratic(const fl_friction_shape *s, fl_vec3 f, double v2)
{
    const double along = v3_dot(s->elongation, f);
    return s->even * v2 + along * along;
}

FL_SIMD_INLINE fl_friction_potential fl_friction_potential_of(const fl_friction_shape *s,
                                                              fl_friction_wrench z)
{
    const double v2 = v3_norm2(z.f), w2 = z.m * z.m, Q = fl_friction_quadratic(s, z.f, v2), cw = s->c * w2,
                 size2 = v2 * v2 + cw * cw, i = size2 > 0.0 ? 1.0 / sqrt(size2) : 0.0, h = w2 * i,
                 vi = v2 * i, j = Q * i * vi;
    return (fl_friction_potential){v2 + s->a * w2 - h * Q, h, j, s->a - j * vi};
}

/* Wrench of z: the gradient of P^2/2. */
FL_SIMD_INLINE fl_friction_wrench fl_friction_wrench_of(const fl_friction_shape *s,
                                                        const fl_friction_potential *p, fl_friction_wrench z)
{
    const double along = v3_dot(s->elongation, z.f);
    const fl_vec3 D = v3_madd(v3_scale(s->even, z.f), along, s->elongation);
    return (fl_friction_wrench){v3_madd(v3_scale(1.0 + p->h * p->j, z.f), -p->h, D), z.m * p->spin};
}

/* Direction of z of a sliding contact after a step; the length of the result has no meaning.
 *
 * Sliding follows z = limit e, P(e) = 1, e' = s' - (dP.s') e/limit.  The step starts from z0 of the wrench
 * F0 and the given size P(z0), and the mean of size and limit stands for it in the step.  With s = -k v dt
 * and r = F0.s/2P^2 the direction is that of z0 + (1 + r) s to order 2 for |s| << P, and that of s for |s| >>
 * P. Where r < 0, 1/(1 - r) replaces 1 + r, which keeps the direction from reversing.  r is kept as a
 * quotient, and the result is multiplied by the denominators. */
FL_SIMD_INLINE fl_friction_wrench fl_tangent_slide(fl_friction_wrench from, fl_friction_wrench wrench,
                                                   double size, double limit, fl_friction_wrench s)
{
    const double mean = 0.5 * (size + limit), a = 0.5 * fl_friction_wrench_dot(wrench, s), b = size * mean;
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

/* Applies the limit to a point, steps 3 and 4 of fl_tangent_step().
 *   from     wrench of the springs before the step, of the norm size
 *   s        its change if the contact sticks
 *   slide    its change for fl_tangent_slide() if the contact slides
 *   damping  damping before the limit */
FL_SIMD_INLINE fl_friction_forces fl_tangent_limit(fl_friction_wrench from, double size, fl_friction_wrench s,
                                                   fl_friction_wrench slide, double limit,
                                                   fl_friction_wrench damping)
{
    const fl_friction_wrench to = fl_friction_wrench_madd(from, 1.0, s),
                             flow = fl_tangent_slide(from, from, size, limit, slide);
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

/* Most of |M|/(rho L) over that of pure spin: sqrt(a) >= sqrt(3)/2. */
#define FL_FRICTION_SPIN_SHARE 1.1547005383792517

/* State and wrench after the limit of a face. */
typedef struct {
    fl_friction_wrench z, elastic, total;
    double p2; /* P(z)^2 */
} fl_friction_face;

/* What a face does in a step. */
typedef struct {
    fl_friction_wrench from; /* z before the step */
    double size;             /* P(from) */
    fl_friction_potential old;
    fl_friction_wrench change,
        change_end;             /* of z if the contact sticks, by the mean motion and that of the end */
    fl_friction_wrench damping; /* before the limit */
    double limit;
} fl_friction_trial;

/* Applies the limit to a face, steps 3 and 4 of fl_tangent_step().  branches: 1 leaves out what a sticking
 * contact does not need; 0 for loops over lanes.  The bits are the same. */
FL_SIMD_INLINE fl_friction_face fl_tangent_face_limit(const fl_friction_shape *shape, fl_friction_trial t,
                                                      int branches)
{
    const double limit = t.limit;
    fl_friction_wrench z = fl_friction_wrench_madd(t.from, 1.0, t.change);
    fl_friction_potential now = fl_friction_potential_of(shape, z);
    const double stuck_size = sqrt(now.p2);
    const int sticks = !(stuck_size > limit);
    if (!branches || !sticks) {
        const fl_friction_wrench flow =
            fl_tangent_slide(t.from, fl_friction_wrench_of(shape, &t.old, t.from), t.size, limit,
                             fl_tangent_slide_path(t.size, limit, t.change, t.change_end));
        const fl_friction_potential slid = fl_friction_potential_of(shape, flow);
        const double flow_size = sqrt(slid.p2), scale = flow_size > 0.0 ? limit / flow_size : 0.0;
        z = (fl_friction_wrench){v3(sticks ? z.f.x : scale * flow.f.x, sticks ? z.f.y : scale * flow.f.y,
                                    sticks ? z.f.z : scale * flow.f.z),
                                 sticks ? z.m : scale * flow.m};
        now.h = sticks ? now.h : slid.h, now.j = sticks ? now.j : slid.j;
        now.spin = sticks ? now.spin : slid.spin;
        const double v2 = v3_norm2(z.f);
        now.p2 = v2 + shape->a * (z.m * z.m) - now.h * fl_friction_quadratic(shape, z.f, v2);
    }
    const fl_friction_wrench elastic = fl_friction_wrench_of(shape, &now, z);
    const double wanted = v3_norm(t.damping.f) + FL_FRICTION_SPIN_SHARE * fabs(t.damping.m),
                 room = sticks ? limit - stuck_size : 0.0, part = wanted > room ? room / wanted : 1.0;
    return (fl_friction_face){z, elastic, fl_friction_wrench_madd(elastic, part, t.damping), now.p2};
}

/* One step of friction over dt [s], which loops over lanes can call.
 *
 * 1. The remembered z_f is rotated about n by the mean spin of the pair, projected into the tangent plane and
 *    given its length again: it rolls with the contact.  Where the contact has changed its shape so that z
 *    would hold more energy than before, z is scaled back.
 * 2. z_f -= k v dt, z_m -= k rho w dt, with the mean of k before and now where k has risen.  Where k has
 *    fallen, z falls with it first (Thornton, J. Appl. Mech. 64 (1997) 363), since it would else hold more
 *    energy than was put in; then z/k -= v dt.  Both are of order 2.
 * 3. Where P(z) > L the contact slides: P becomes L and the direction that of fl_tangent_slide().
 * 4. Damping by fl_tangent_damping(), -g v and -g rho^2 w of the end of the step, is added to the wrench, up
 *    to the share (L - P)/(|d_f| + |d_m|/sqrt(a)), which stays within the limit surface.  A sliding contact
 *    has none, as Coulomb's law says (V04 of verify_spheres), and the force does not jump as sliding begins
 *    or ends. */
FL_SIMD_INLINE fl_friction_result fl_tangent_step_of(fl_friction_springs s, fl_friction_contact c,
                                                     fl_friction_motion by, double dt, int branches)
{
    const double before = v3_norm2(s.force), k = c.k, k_turn = k * c.arm * c.arm;
    const fl_vec3 rolled = v3_madd(s.force, by.mean_spin * dt, v3_cross(c.n, s.force));
    const fl_vec3 projected = v3_madd(rolled, -v3_dot(rolled, c.n), c.n);
    const double after = v3_norm2(projected), length = after > 0.0 ? sqrt(before / after) : 1.0;
    const double fall = k < s.k ? k / s.k : 1.0, fall_turn = k_turn < s.k_turn ? k_turn / s.k_turn : 1.0;
    const double mean_k = k < s.k ? k : 0.5 * (k + s.k),
                 mean_k_turn = k_turn < s.k_turn ? k_turn : 0.5 * (k_turn + s.k_turn);
    const double each = c.arm > 0.0 ? 1.0 / c.arm : 0.0;
    const fl_vec3 v = v3_madd(by.v, -v3_dot(by.v, c.n), c.n),
                  v_end = v3_madd(by.v_end, -v3_dot(by.v_end, c.n), c.n);
    const fl_friction_wrench held = {v3_scale(fall, v3_scale(length, projected)),
                                     each * (fall_turn * s.moment)},
                             change = {v3_scale(-mean_k * dt, v), each * (-mean_k_turn * dt * by.spin)},
                             change_end = {v3_scale(-mean_k * dt, v_end),
                                           each * (-mean_k_turn * dt * by.spin_end)},
                             motion = {v_end, c.arm * by.spin_end},
                             damped = {by.previous_damping, each * by.previous_damping_moment};
    const fl_friction_wrench damping =
        fl_tangent_damping(c, motion, change, damped, by.half_step, by.at_start);
    if (branches && !(c.arm > 0.0)) {
        const double length_now = fl_friction_wrench_norm(held);
        const fl_friction_forces point = fl_tangent_limit(
            held, length_now, change, fl_tangent_slide_path(length_now, c.limit, change, change_end), c.limit,
            damping);
        return (fl_friction_result){{.force = point.elastic.f,
                                     .k = k,
                                     .energy = k > 0.0 ? 0.5 * v3_norm2(point.elastic.f) / k : 0.0,
                                     .damping = v3_sub(point.total.f, point.elastic.f)},
                                    point.total.f,
                                    0.0};
    }
    const fl_friction_shape shape =
        fl_friction_shape_of(v3_madd(c.elongation, -v3_dot(c.elongation, c.n), c.n));
    const fl_friction_potential old = fl_friction_potential_of(&shape, held);
    const double most = 2.0 * k * s.energy,
                 reduced = old.p2 > most && c.arm > 0.0 ? sqrt(most / old.p2) : 1.0,
                 size = reduced * sqrt(old.p2);
    const fl_friction_wrench from = fl_friction_wrench_scale(reduced, held);
    const fl_friction_face now = fl_tangent_face_limit(
        &shape, (fl_friction_trial){from, size, old, change, change_end, damping, c.limit}, branches);
    return (fl_friction_result){{.force = now.z.f,
                                 .k = k,
                                 .moment = c.arm * now.z.m,
                                 .k_turn = k_turn,
                                 .energy = k > 0.0 ? 0.5 * now.p2 / k : 0.0,
                                 .damping = v3_sub(now.total.f, now.elastic.f),
                                 .damping_moment = c.arm * (now.total.m - now.elastic.m)},
                                now.total.f,
                                c.arm * now.total.m};
}
FL_SIMD_INLINE fl_friction_result fl_tangent_step(fl_friction_springs s, fl_friction_contact c,
                                                  fl_friction_motion by, double dt)
{
    return fl_tangent_step_of(s, c, by, dt, 0);
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
    s->energy *= by > 0.0 ? scale * scale / by : 0.0;
}

#endif
