/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bond/disc.h"
#include "base/pi.h"
#include "bond/disc_kernel.h"

double fl_disc_integrity(const fl_disc_class *c, double lambda)
{
    if (fl_disc_is_broken(c, lambda)) return 0.0;
    if (lambda <= 1.0) return 1.0;
    return (c->ductility - lambda) / ((c->ductility - 1.0) * lambda);
}

static double positive_part(double x) { return x > 0.0 ? x : 0.0; }

/* M along e, and the size of the rest. */
static double split_moment(fl_vec3 M, fl_vec3 e, double *bending)
{
    const double twist = v3_dot(M, e);
    *bending = v3_norm(v3_madd(M, -twist, e));
    return twist;
}

static double lambda_of(const fl_disc_law *law, const fl_disc_class *c, double scatter,
                        const fl_disc_motion *q)
{
    const double R = c->radius, area = PI * R * R, s = scatter * c->weakening, beta = law->moment_factor;
    double bending;
    const double twist = split_moment(q->M, q->e, &bending);
    const double sigma = q->N / area + beta * 4.0 * bending / (area * R),
                 tau = v3_norm(q->S) / area + beta * 2.0 * fabs(twist) / (area * R),
                 pressure = positive_part(-q->N) / area;
    const double a = positive_part(sigma) / (s * law->tension),
                 b = tau / (s * law->cohesion + law->internal_friction * pressure);
    return sqrt(a * a + b * b);
}

/* Share of S that is carried with the remainder g: friction may hold more. */
static double shear_share(const fl_disc_law *law, double g, double N, fl_vec3 S)
{
    const double limit = law->friction * positive_part(-N), size = v3_norm(S);
    if (g >= 1.0 || !(size > 0.0)) return g;
    const double held = limit < size ? limit / size : 1.0;
    return held > g ? held : g;
}

/* a.b of two elastic states over their springs: twice the energy if they are the same. */
static double spring_product(const fl_disc_class *c, fl_vec3 e, double N0, fl_vec3 S0, fl_vec3 M0, double N1,
                             fl_vec3 S1, fl_vec3 M1)
{
    const double ks = c->shear_ratio * c->kn, r2 = c->radius * c->radius, kb = 0.25 * r2 * c->kn,
                 kt = 0.5 * r2 * ks, t0 = v3_dot(M0, e), t1 = v3_dot(M1, e);
    return positive_part(N0) * positive_part(N1) / c->kn + v3_dot(S0, S1) / ks +
           v3_dot(v3_madd(M0, -t0, e), v3_madd(M1, -t1, e)) / kb + t0 * t1 / kt;
}

fl_disc_wrench fl_disc_force(const fl_disc_law *law, const fl_disc_class *c, double scatter,
                             const fl_disc_pose *at, double dt, fl_disc_memory *m)
{
    const fl_disc_motion q = fl_disc_motion_of(at->d, at->vi, at->vj, at->wi, at->wj, m->S, m->M, c->length,
                                               c->kn, c->shear_ratio, c->radius, c->share, dt);
    const double lambda = lambda_of(law, c, scatter, &q), before = fl_disc_integrity(c, m->lambda);
    const fl_vec3 then = v3_madd(at->d, -dt, v3_sub(at->vj, at->vi));
    const double N0 = c->kn * (v3_norm(then) - c->length);
    if (lambda > m->lambda) m->lambda = lambda;
    const double g = fl_disc_integrity(c, m->lambda);
    const double share0 = shear_share(law, before, N0, q.S0), share = shear_share(law, g, q.N, q.S);
    if (g < before)
        m->dissipated += 0.5 * (before - g) * spring_product(c, q.e, N0, q.S0, q.M0, q.N, q.S, q.M);
    if (g < 1.0)
        m->friction_loss +=
            0.5 * dt * ((share0 - before) * v3_dot(q.S0, q.slip) + (share - g) * v3_dot(q.S, q.slip));
    const fl_vec3 drag = v3_scale(g, fl_disc_damping_force(q, c->kn, c->shear_ratio, c->damping)),
                  brake =
                      v3_scale(g, fl_disc_damping_couple(q, c->kn, c->shear_ratio, c->radius, c->damping));
    m->damped +=
        0.5 * dt * fl_disc_power(q, v3_add(m->damping_force, drag), v3_add(m->damping_couple, brake));
    m->damping_force = drag, m->damping_couple = brake;
    m->S = q.S, m->M = q.M;
    const fl_vec3 F = v3_add(v3_madd(v3_scale(q.N > 0.0 ? g * q.N : q.N, q.e), share, q.S), drag),
                  M = v3_madd(brake, g, q.M), arm = v3_cross(q.e, F);
    return (fl_disc_wrench){F, v3_madd(M, c->share * q.r, arm),
                            v3_madd(v3_neg(M), (1.0 - c->share) * q.r, arm)};
}

double fl_disc_energy(const fl_disc_class *c, const fl_disc_memory *m, fl_vec3 d)
{
    const double r = v3_norm(d), N = c->kn * (r - c->length), g = fl_disc_integrity(c, m->lambda),
                 press = positive_part(-N);
    return 0.5 * (press * press / c->kn +
                  g * spring_product(c, v3_scale(1.0 / r, d), N, m->S, m->M, N, m->S, m->M));
}

fl_disc_load fl_disc_section_load(const fl_disc_law *law, const fl_disc_class *c, const fl_disc_memory *m,
                                  fl_vec3 d)
{
    const double N = c->kn * (v3_norm(d) - c->length), g = fl_disc_integrity(c, m->lambda);
    return (fl_disc_load){.tension = N > 0.0 ? g * N : N,
                          .shear = shear_share(law, g, N, m->S) * v3_norm(m->S),
                          .moment = g * v3_norm(m->M),
                          .x = v3_scale(c->share, d)};
}
