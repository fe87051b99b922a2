/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/member_dynamics.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "member/mechanism.h"

/* Of the stable step: forces of bent pieces exceed those of the linear bound by their rotation. */
static const double SUBSTEP_SHARE = 0.8;
/* Unbalanced force of the start over the loads, and over the largest EA, where rounding ends it; steps of the
 * iteration. */
static const double BALANCED = 1e-10, ROUNDING = 1e-13;
enum { BALANCE_STEPS = 60 };

/* --- making it --------------------------------------------------------------------------------- */

/* What bending and torsion add where an end has an arm. */
static double arms_omega2(const fl_member_contact *e, double half, double inertia)
{
    double sum = 0.0;
    const double l2 = e->length * e->length, bend = e->shear[0] + e->shear[1];
    if (e->kind == FL_MEMBER_BEAM) {
        sum = bend * (6.0 / half + l2 / inertia);
        for (int k = 0; k < 3; k++) sum += 4.0 * e->turn[k] / inertia;
    } else if (e->kind != FL_MEMBER_BAR) {
        sum = bend * (6.0 / (l2 * half) + 2.0 / inertia);
    }
    return sum;
}

/* omega2 of a contact between two balls that have but its own share of the masses; forms as in
 * member_stiffness.h, which are orthogonal in M^-1.  With arms they are not: their sum, each at three times
 * what it is at the balls, as an arm has (r x a)2 <= 2 a2 r2 of an inertia that holds a2. */
static double contact_omega2(const fl_member_contact *e, const fl_member_section *s)
{
    const double l = e->length, half = 0.5 * s->mass * l,
                 inertia = half * (l * l / 12.0 + 0.5 * (s->eiy + s->eiz) / s->ea);
    double most = 2.0 * e->axial / half;
    if (e->arms) return 3.0 * most + arms_omega2(e, half, inertia);
    const double bend = fmax(e->shear[0], e->shear[1]);
    if (e->kind == FL_MEMBER_BEAM) {
        most = fmax(most, bend * (2.0 / half + 0.5 * l * l / inertia));
        for (int k = 0; k < 3; k++) most = fmax(most, 2.0 * e->turn[k] / inertia);
    } else if (e->kind != FL_MEMBER_BAR) {
        most = fmax(most, bend * (2.0 / (l * l * half) + 1.0 / inertia));
    }
    return most;
}

static int set_masses(fl_member_dynamics *d, const fl_member_model *m, fl_err *err)
{
    fl_member_chain *c = &d->chain;
    double most = 0.0;
    if (fl_member_masses(c, m, d->mass, d->inertia, err)) return -1;
    for (int32_t b = 0; b < c->balls; b++) {
        fl_member_ball *a = &c->ball[b];
        const int held = (a->fixed & FL_MEMBER_TRANSLATIONS) == FL_MEMBER_TRANSLATIONS;
        a->over_m = held ? 0.0 : 1.0 / d->mass[b];
        a->over_i = a->over_i > 0.0 ? 1.0 / d->inertia[b] : 0.0;
    }
    for (int32_t k = 0; k < c->contacts; k++)
        most =
            fmax(most, contact_omega2(&c->contact[k], &m->section[m->member[c->contact[k].member].section]));
    d->largest_omega = sqrt(most);
    return 0;
}

static inline fl_member_resist unbalanced(const fl_member_chain *c, int32_t b)
{
    const fl_member_ball *a = &c->ball[b];
    fl_vec3 f = v3_neg(c->resist[b].f), m = v3_neg(c->resist[b].m);
    if (a->load >= 0) {
        f = v3_add(f, c->load[a->load].force);
        m = v3_add(m, c->load[a->load].moment);
    }
    return (fl_member_resist){fl_member_free_part(f, a->fixed & FL_MEMBER_TRANSLATIONS),
                              fl_member_free_part(m, a->fixed >> 3)};
}

/* Equilibrium under the loads by the stiffness of the start, again and again (modified Newton). */
static int balance(fl_member_dynamics *d, const fl_member_stiffness *s, const char *file, fl_err *err)
{
    fl_member_chain *c = &d->chain;
    double *x = fl_alloc(s->n, sizeof *x, err), residual = 0.0;
    double stiffest = 0.0;
    int rc = x ? 1 : -1;
    for (int32_t k = 0; k < c->contacts; k++)
        stiffest = fmax(stiffest, c->contact[k].axial * c->contact[k].length);
    const double small = BALANCED * c->load_norm + ROUNDING * stiffest * sqrt(c->balls);
    for (int step = 0; step < BALANCE_STEPS && rc > 0; step++) {
        fl_member_chain_forces(c);
        residual = sqrt(fl_member_chain_state(c, 1.0).residual2);
        if (residual <= small) {
            rc = 0;
            break;
        }
        for (int32_t i = 0; i < s->n; i++) {
            const fl_member_resist r = unbalanced(c, s->dof[i] / 6);
            const int k = s->dof[i] % 6;
            x[i] = k < 3 ? v3_at(r.f, k) : v3_at(r.m, k - 3);
        }
        fl_member_stiffness_solve(s, x);
        for (int32_t b = 0; b < c->balls; b++) {
            double u[6] = {0};
            for (int k = 0; k < 6; k++)
                if (s->number[6 * b + k] >= 0) u[k] = x[s->number[6 * b + k]];
            fl_member_ball *a = &c->ball[b];
            a->d = v3_add(a->d, v3(u[0], u[1], u[2]));
            a->w = v3(u[3], u[4], u[5]);
            fl_member_ball_turn(a, 1.0);
            a->w = v3(0, 0, 0);
        }
    }
    free(x);
    if (rc <= 0) return rc;
    return fl_fail(err, FL_INPUT,
                   "%s: no equilibrium under its loads was found: they are near or above a limit load, which "
                   "arc-path finds; expected smaller loads",
                   file);
}

static int allocate(fl_member_dynamics *d, fl_err *err)
{
    const int32_t n = d->chain.balls;
    d->mass = fl_alloc(n, sizeof *d->mass, err);
    d->inertia = fl_alloc(n, sizeof *d->inertia, err);
    d->force = fl_alloc(n, sizeof *d->force, err);
    d->moment = fl_alloc(n, sizeof *d->moment, err);
    d->equilibrium = fl_alloc(n, sizeof *d->equilibrium, err);
    d->decay = fl_alloc(FL_MEMBER_DAMPED_MODES + 1, sizeof *d->decay, err);
    return err->code ? -1 : 0;
}

int fl_member_dynamics_make(fl_member_dynamics *d, const fl_member_model *m, double ratio, fl_err *err)
{
    fl_member_stiffness s = {0};
    *d = (fl_member_dynamics){.ratio = ratio};
    int rc =
        fl_member_check_mechanism(m, err) || fl_member_chain_make(&d->chain, m, 1.0, err) ||
                allocate(d, err) || set_masses(d, m, err) ||
                ((ratio > 0.0 || d->chain.loads > 0) && fl_member_stiffness_make(&s, &d->chain, m->file, err))
            ? -1
            : 0;
    for (int32_t k = 0; k < d->chain.moves && rc == 0; k++)
        rc =
            fl_fail(err, FL_INPUT,
                    "%s:%lld: node %s has an imposed displacement, which is for arc-path; expected a support",
                    m->file, (long long)m->node[d->chain.move[k].ball].line,
                    m->node_name.name[d->chain.move[k].ball]);
    if (rc == 0 && d->chain.loads > 0) rc = balance(d, &s, m->file, err);
    if (rc == 0) fl_member_chain_forces(&d->chain);
    if (rc == 0 && ratio > 0.0)
        rc = fl_member_modes_find(&d->modes, &s, d->chain.balls, d->mass, d->inertia, FL_MEMBER_DAMPED_MODES,
                                  err);
    fl_member_stiffness_free(&s);
    if (rc) {
        fl_member_dynamics_free(d);
        return -1;
    }
    d->ruptured = fl_member_chain_commit(&d->chain);
    for (int32_t b = 0; b < d->chain.balls; b++) d->equilibrium[b] = d->chain.ball[b].d;
    d->plastic_at_start = fl_member_chain_plastic(&d->chain);
    d->energy_at_start = fl_member_dynamics_energy(d);
    return 0;
}

void fl_member_dynamics_free(fl_member_dynamics *d)
{
    fl_member_chain_free(&d->chain);
    fl_member_modes_free(&d->modes);
    free(d->mass), free(d->inertia), free(d->force), free(d->moment), free(d->equilibrium), free(d->decay);
    *d = (fl_member_dynamics){0};
}

/* --- a step ------------------------------------------------------------------------------------ */

/* Rate of damping of mode k, or of the rest. */
static double rate_of(const fl_member_dynamics *d, int32_t k)
{
    return 2.0 * d->ratio * d->modes.omega[k < d->modes.n ? k : d->modes.n - 1];
}

void fl_member_dynamics_set_step(fl_member_dynamics *d, double dt)
{
    d->dt = dt;
    d->substeps = (int)ceil(dt * d->largest_omega / (2.0 * SUBSTEP_SHARE));
    if (d->substeps < 1) d->substeps = 1;
    d->chain.dt = dt / d->substeps;
    for (int32_t k = 0; k <= d->modes.n && d->modes.n; k++) d->decay[k] = expm1(-0.5 * dt * rate_of(d, k));
}

void fl_member_dynamics_kick(fl_member_dynamics *d, double h)
{
    for (int32_t b = 0; b < d->chain.balls; b++) {
        fl_member_ball *a = &d->chain.ball[b];
        if (a->over_m > 0.0)
            a->v = v3_madd(a->v, h * a->over_m,
                           fl_member_free_part(d->force[b], a->fixed & FL_MEMBER_TRANSLATIONS));
        if (a->over_i > 0.0)
            a->w = v3_madd(a->w, h * a->over_i, fl_member_free_part(d->moment[b], a->fixed >> 3));
    }
}

/* s.M v of mode k. */
static double along_mode(const fl_member_dynamics *d, int32_t k)
{
    const double *s = d->modes.shape + 6 * (int64_t)d->chain.balls * k;
    double sum = 0.0;
    for (int32_t b = 0; b < d->chain.balls; b++, s += 6) {
        const fl_member_ball *a = &d->chain.ball[b];
        sum += d->mass[b] * (s[0] * a->v.x + s[1] * a->v.y + s[2] * a->v.z) +
               d->inertia[b] * (s[3] * a->w.x + s[4] * a->w.y + s[5] * a->w.z);
    }
    return sum;
}

double fl_member_dynamics_kinetic(const fl_member_dynamics *d)
{
    double sum = 0.0;
    for (int32_t b = 0; b < d->chain.balls; b++) {
        const fl_member_ball *a = &d->chain.ball[b];
        sum += d->mass[b] * v3_norm2(a->v) + d->inertia[b] * v3_norm2(a->w);
    }
    return 0.5 * sum;
}

void fl_member_dynamics_damp(fl_member_dynamics *d)
{
    const int32_t n = d->modes.n, balls = d->chain.balls;
    double part[FL_MEMBER_DAMPED_MODES];
    if (n == 0) return;
    const double before = fl_member_dynamics_kinetic(d), rest = d->decay[n];
    for (int32_t k = 0; k < n; k++) part[k] = (d->decay[k] - rest) * along_mode(d, k);
    for (int32_t b = 0; b < balls; b++) {
        fl_member_ball *a = &d->chain.ball[b];
        a->v = v3_scale(1.0 + rest, a->v);
        a->w = v3_scale(1.0 + rest, a->w);
        for (int32_t k = 0; k < n; k++) {
            const double *s = d->modes.shape + 6 * ((int64_t)balls * k + b);
            a->v = v3_madd(a->v, part[k], v3(s[0], s[1], s[2]));
            a->w = v3_madd(a->w, part[k], v3(s[3], s[4], s[5]));
        }
    }
    d->damped += before - fl_member_dynamics_kinetic(d);
}

/* Half-substep kick by the internal forces and the loads; with drift, the drift of a substep follows. */
static void kick_by_internal_forces(fl_member_chain *c, int drift)
{
    const double h = 0.5 * c->dt;
    for (int32_t b = 0; b < c->balls; b++) {
        fl_member_ball *a = &c->ball[b];
        if (a->over_m == 0.0 && a->over_i == 0.0) continue;
        const fl_member_resist r = unbalanced(c, b);
        a->v = v3_madd(a->v, h * a->over_m, r.f);
        a->w = v3_madd(a->w, h * a->over_i, r.m);
        if (!drift) continue;
        a->d = v3_madd(a->d, c->dt, a->v);
        if (a->over_i > 0.0) fl_member_ball_turn(a, c->dt);
    }
}

void fl_member_dynamics_drift(fl_member_dynamics *d)
{
    fl_member_chain *c = &d->chain;
    for (int s = 0; s < d->substeps; s++) {
        kick_by_internal_forces(c, 1);
        fl_member_chain_forces(c);
        kick_by_internal_forces(c, 0);
        if (c->yielding) d->ruptured += fl_member_chain_commit(c);
        if (!(c->largest_rotation2 <= FL_MEMBER_ROTATION_MAX * FL_MEMBER_ROTATION_MAX)) d->over_rotated = 1;
    }
}

double fl_member_dynamics_energy(const fl_member_dynamics *d)
{
    const fl_member_chain *c = &d->chain;
    double sum = -d->energy_at_start;
    for (int32_t k = 0; k < c->contacts; k++) {
        const fl_member_contact *e = &c->contact[k];
        const fl_member_ball *i = &c->ball[e->i], *j = &c->ball[e->j];
        const fl_vec3 dx = v3_sub(v3_add(j->x0, j->d), v3_add(i->x0, i->d));
        double energy, rotation2;
        fl_member_contact_force(e, dx, i->q, j->q, &energy, &rotation2);
        sum += energy;
    }
    for (int32_t k = 0; k < c->loads; k++) {
        const fl_quat q = c->ball[c->load[k].ball].q;
        /* Work of a moment by the rotation vector, to third order: loads of a run turn little. */
        const double sign = q.w < 0.0 ? -2.0 : 2.0;
        sum -= v3_dot(c->ball[c->load[k].ball].d, c->load[k].force) +
               v3_dot(v3_scale(sign, v3(q.x, q.y, q.z)), c->load[k].moment);
    }
    return sum;
}

/* Rounding would let fibres that are about to yield do so a little. */
void fl_member_dynamics_refresh(fl_member_dynamics *d)
{
    fl_member_chain *c = &d->chain;
    for (int32_t k = 0; k < c->yielding; k++) c->fibres[k].frozen = 1;
    fl_member_chain_forces(c);
    for (int32_t k = 0; k < c->yielding; k++) c->fibres[k].frozen = c->fibres[k].changed = 0;
}

fl_vec3 fl_member_dynamics_acceleration(const fl_member_dynamics *d, int32_t ball)
{
    const fl_member_ball *a = &d->chain.ball[ball];
    const fl_member_resist own = unbalanced(&d->chain, ball);
    fl_vec3 f = v3_add(own.f, fl_member_free_part(d->force[ball], a->fixed & FL_MEMBER_TRANSLATIONS));
    fl_vec3 g = v3_scale(a->over_m, f);
    const int32_t n = d->modes.n;
    if (n == 0) return g;
    const double rest = rate_of(d, n);
    g = v3_madd(g, -rest, a->v);
    for (int32_t k = 0; k < n; k++) {
        const double *s = d->modes.shape + 6 * ((int64_t)d->chain.balls * k + ball);
        g = v3_madd(g, (rest - rate_of(d, k)) * along_mode(d, k), v3(s[0], s[1], s[2]));
    }
    return g;
}

void fl_member_section_forces(const fl_member_chain *c, int32_t contact, fl_vec3 *force, fl_vec3 *moment)
{
    const fl_member_contact *e = &c->contact[contact];
    const fl_member_ball *i = &c->ball[e->i], *j = &c->ball[e->j];
    double rotation2;
    const fl_vec3 dx = v3_sub(fl_member_contact_end(c, e, 1), fl_member_contact_end(c, e, 0));
    const fl_member_force r = fl_member_end_force(e, dx, i->q, j->q, NULL, &rotation2);
    const int turned_j = e->kind == FL_MEMBER_HINGE_I;
    /* Axes: along the line of centres, those across from the rotation of an end that transmits moments. */
    fl_vec3 a[3];
    fl_member_axes(q_mul(turned_j ? j->q : i->q, e->e0), a);
    const fl_vec3 e1 = v3_unit(dx), e2 = v3_unit(v3_cross(a[2], e1)), e3 = v3_cross(e1, e2);
    /* On i act f and mi; half way on, the far part exerts f and mi less what f has as its arm. */
    const fl_vec3 m = v3_scale(0.5, v3_sub(r.mi, r.mj));
    *force = v3(v3_dot(r.f, e1), v3_dot(r.f, e2), v3_dot(r.f, e3));
    *moment = v3(v3_dot(m, e1), v3_dot(m, e2), v3_dot(m, e3));
}
