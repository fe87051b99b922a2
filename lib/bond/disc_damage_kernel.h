/* SPDX-License-Identifier: GPL-3.0-or-later */
/* disc_damage_kernel.h -- the step of one disc of disc.h, whole or damaged, by value: fl_disc_force() and
 * devices (gpu/step_kernel.h) get the same bits.  No call but sqrt and fabs. */
#ifndef FL_BOND_DISC_DAMAGE_KERNEL_H
#define FL_BOND_DISC_DAMAGE_KERNEL_H
#include "base/pi.h"
#include "bond/disc_kernel.h"
#include "bond/disc_types.h"

static inline double fl_disc_integrity_of(fl_disc_class c, double lambda)
{
    if (lambda >= 1.0 && lambda >= c.ductility) return 0.0;
    if (lambda <= 1.0) return 1.0;
    return (c.ductility - lambda) / ((c.ductility - 1.0) * lambda);
}

static inline double fl_disc_positive(double x) { return x > 0.0 ? x : 0.0; }

/* Load over strength at the rim. */
static inline double fl_disc_lambda(fl_disc_law law, fl_disc_class c, double scatter, fl_disc_motion q)
{
    const double R = c.radius, area = PI * R * R, s = scatter * c.weakening, beta = law.moment_factor;
    const double twist = v3_dot(q.M, q.e), bending = v3_norm(v3_madd(q.M, -twist, q.e));
    const double sigma = q.N / area + beta * 4.0 * bending / (area * R),
                 tau = v3_norm(q.S) / area + beta * 2.0 * fabs(twist) / (area * R),
                 pressure = fl_disc_positive(-q.N) / area;
    const double a = fl_disc_positive(sigma) / (s * law.tension),
                 b = tau / (s * law.cohesion + law.internal_friction * pressure);
    return sqrt(a * a + b * b);
}

/* Share of S that is carried with the remainder g: friction may hold more. */
static inline double fl_disc_shear_share(fl_disc_law law, double g, double N, fl_vec3 S)
{
    const double limit = law.friction * fl_disc_positive(-N), size = v3_norm(S);
    if (g >= 1.0 || !(size > 0.0)) return g;
    const double held = limit < size ? limit / size : 1.0;
    return held > g ? held : g;
}

/* a.b of two elastic states over their springs: twice the energy if they are the same. */
static inline double fl_disc_spring_product(fl_disc_class c, fl_vec3 e, double N0, fl_vec3 S0, fl_vec3 M0,
                                            double N1, fl_vec3 S1, fl_vec3 M1)
{
    const double ks = c.shear_ratio * c.kn, r2 = c.radius * c.radius, kb = 0.25 * r2 * c.kn,
                 kt = 0.5 * r2 * ks, t0 = v3_dot(M0, e), t1 = v3_dot(M1, e);
    return fl_disc_positive(N0) * fl_disc_positive(N1) / c.kn + v3_dot(S0, S1) / ks +
           v3_dot(v3_madd(M0, -t0, e), v3_madd(M1, -t1, e)) / kb + t0 * t1 / kt;
}

typedef struct {
    fl_disc_wrench force;
    fl_disc_memory memory;
} fl_disc_result;

/* fl_disc_force() by value: forces, and the memory after a step of dt. */
static inline fl_disc_result fl_disc_step(fl_disc_law law, fl_disc_class c, double scatter, fl_disc_pose at,
                                          double dt, fl_disc_memory m)
{
    const fl_disc_motion q = fl_disc_motion_of(at.d, at.vi, at.vj, at.wi, at.wj, m.S, m.M, c.length, c.kn,
                                               c.shear_ratio, c.radius, c.share, dt);
    const double lambda = fl_disc_lambda(law, c, scatter, q), before = fl_disc_integrity_of(c, m.lambda);
    const fl_vec3 then = v3_madd(at.d, -dt, v3_sub(at.vj, at.vi));
    const double N0 = c.kn * (v3_norm(then) - c.length);
    if (lambda > m.lambda) m.lambda = lambda;
    const double g = fl_disc_integrity_of(c, m.lambda);
    const double share0 = fl_disc_shear_share(law, before, N0, q.S0),
                 share = fl_disc_shear_share(law, g, q.N, q.S);
    if (g < before)
        m.dissipated += 0.5 * (before - g) * fl_disc_spring_product(c, q.e, N0, q.S0, q.M0, q.N, q.S, q.M);
    if (g < 1.0)
        m.friction_loss +=
            0.5 * dt * ((share0 - before) * v3_dot(q.S0, q.slip) + (share - g) * v3_dot(q.S, q.slip));
    const fl_vec3 drag = v3_scale(g, fl_disc_damping_force(q, c.kn, c.shear_ratio, c.damping)),
                  brake = v3_scale(g, fl_disc_damping_couple(q, c.kn, c.shear_ratio, c.radius, c.damping));
    m.damped += 0.5 * dt * fl_disc_power(q, v3_add(m.damping_force, drag), v3_add(m.damping_couple, brake));
    m.damping_force = drag, m.damping_couple = brake;
    m.S = q.S, m.M = q.M;
    const fl_vec3 F = v3_add(v3_madd(v3_scale(q.N > 0.0 ? g * q.N : q.N, q.e), share, q.S), drag),
                  M = v3_madd(brake, g, q.M), arm = v3_cross(q.e, F);
    fl_disc_result out;
    out.force.force = F;
    out.force.couple_i = v3_madd(M, c.share * q.r, arm);
    out.force.couple_j = v3_madd(v3_neg(M), (1.0 - c.share) * q.r, arm);
    out.memory = m;
    return out;
}

/* Stored energy at d [J]; fl_disc_energy(). */
static inline double fl_disc_stored(fl_disc_class c, fl_disc_memory m, fl_vec3 d)
{
    const double r = v3_norm(d), N = c.kn * (r - c.length), g = fl_disc_integrity_of(c, m.lambda),
                 press = fl_disc_positive(-N);
    return 0.5 * (press * press / c.kn +
                  g * fl_disc_spring_product(c, v3_scale(1.0 / r, d), N, m.S, m.M, N, m.S, m.M));
}

#endif
