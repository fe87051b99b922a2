/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/mem.h"
#include "body/integrate.h"
#include "bound/mover.h"

enum { TURNS = FL_HOLD_RX | FL_HOLD_RY | FL_HOLD_RZ, ALL = 63 };

int32_t fl_movers_add(fl_movers *v, fl_motion *m, fl_err *err)
{
    if (fl_grow(&v->motion, &v->cap, (int64_t)v->n + 1, sizeof *v->motion, err)) return -1;
    v->motion[v->n] = *m;
    *m = (fl_motion){0};
    return v->n++;
}

/* What is told at time t: way and turn, their rates and second derivatives. */
static void told(const fl_motion *m, double t, fl_pose6 *x, fl_pose6 *rate, fl_pose6 *second)
{
    if (m->track.n) {
        fl_track_look(&m->track, t, x, rate, second);
        return;
    }
    *x = (fl_pose6){v3_scale(t, m->velocity), v3_scale(t, m->spin)};
    *rate = (fl_pose6){m->velocity, m->spin};
    *second = (fl_pose6){0};
}

/* Below this |r|^2 the series of the two quotients is exact to rounding: r^8 is left out. */
#define SMALL_TURN 1e-4

/* Angular velocity of exp(r(t)):  w = r' + (1 - cos a)/a^2 r x r' + (a - sin a)/a^3 r x (r x r'), a = |r|.
 * Cosine and sine come from the quaternion of the turn. */
static fl_vec3 turning(fl_vec3 r, fl_vec3 rate)
{
    const double a2 = v3_norm2(r);
    const fl_vec3 across = v3_cross(r, rate);
    double one = 0.5 - a2 * (1.0 / 24 - a2 * (1.0 / 720 - a2 / 40320)),
           two = 1.0 / 6 - a2 * (1.0 / 120 - a2 * (1.0 / 5040 - a2 / 362880));
    if (!v3_some(across)) return rate;
    if (a2 > SMALL_TURN) {
        const fl_quat q = q_of_vector(r);
        const double s2 = q.x * q.x + q.y * q.y + q.z * q.z, a = sqrt(a2);
        const double sine = 2.0 * q.w * v3_dot(v3(q.x, q.y, q.z), r) / a;
        one = 2.0 * s2 / a2;
        two = (a - sine) / (a * a2);
    }
    return v3_add(v3_madd(rate, one, across), v3_scale(two, v3_cross(r, across)));
}

static void set_component(fl_vec3 *a, int k, double x)
{
    if (k == 0) a->x = x;
    else if (k == 1) a->y = x;
    else a->z = x;
}

/* The told components of a free mover's velocity become v; what holds them works at the mean. */
static void lead(fl_movers *m, int32_t k, fl_vec3 v)
{
    fl_bodies *b = &m->b;
    for (int c = 0; c < 3; c++) {
        const double old = v3_at(b->v[k], c), now = v3_at(v, c);
        if (!(b->hold[k] & (unsigned)(FL_HOLD_X << c)) || old == now) continue;
        m->given[k] += b->m[k] * (now - old) * 0.5 * (now + old);
        set_component(&b->v[k], c, now);
    }
}

int fl_movers_start(fl_movers *v, double t, fl_err *err)
{
    const int32_t n = v->n;
    fl_bodies *b = &v->b;
    if (fl_bodies_alloc(b, n, n, err)) return -1;
    v->anchor = fl_alloc(n, sizeof *v->anchor, err);
    v->pull = fl_alloc(n, sizeof *v->pull, err);
    v->spring = fl_alloc(n, sizeof *v->spring, err);
    v->twist = fl_alloc(n, sizeof *v->twist, err);
    v->stored = fl_alloc(n, sizeof *v->stored, err);
    v->damped = fl_alloc(n, sizeof *v->damped, err);
    v->given = fl_alloc(n, sizeof *v->given, err);
    v->fade = fl_alloc(n, sizeof *v->fade, err);
    v->fade_turn = fl_alloc(n, sizeof *v->fade_turn, err);
    if (err->code) return -1;
    for (int32_t k = 0; k < n; k++) {
        const fl_motion *m = &v->motion[k];
        fl_pose6 x, rate, second;
        told(m, t, &x, &rate, &second);
        if (m->free) {
            b->m[k] = m->mass > 0.0 ? m->mass : 1.0;
            b->invm[k] = 1.0 / b->m[k];
            b->hold[k] = (uint8_t)(ALL & ~m->free);
            fl_body_inertia(b, k,
                            v3(m->inertia.x > 0.0 ? m->inertia.x : 1.0,
                               m->inertia.y > 0.0 ? m->inertia.y : 1.0,
                               m->inertia.z > 0.0 ? m->inertia.z : 1.0));
        }
        b->x[k] = v3_add(m->reference, x.x);
        b->q[k] = q_of_vector(x.r);
        b->v[k] = v->pull[k] = rate.x;
        b->w[k] = turning(x.r, rate.r);
        v->anchor[k] = x.x;
    }
    return 0;
}

void fl_movers_ready(fl_movers *v, double dt)
{
    for (int32_t k = 0; k < v->n; k++) {
        const fl_motion *m = &v->motion[k];
        const double h = 0.5 * dt, c[] = {m->c.x, m->c.y, m->c.z, m->ct.x, m->ct.y, m->ct.z};
        for (int i = 0; i < 3 && m->free; i++) {
            set_component(&v->fade[k], i, exp(-c[i] * h / v->b.m[k]));
            set_component(&v->fade_turn[k], i, exp(-c[3 + i] * h / v3_at(v->b.I[k], i)));
        }
    }
}

void fl_mover_damp(fl_movers *v, int32_t k)
{
    fl_bodies *b = &v->b;
    const fl_motion *m = &v->motion[k];
    if (m->free && v3_some(m->c)) {
        const fl_vec3 pull = v->pull[k], old = v3_sub(b->v[k], pull), f = v->fade[k];
        const unsigned hold = b->hold[k];
        const fl_vec3 now = v3(hold & FL_HOLD_X ? old.x : f.x * old.x, hold & FL_HOLD_Y ? old.y : f.y * old.y,
                               hold & FL_HOLD_Z ? old.z : f.z * old.z);
        v->damped[k] += 0.5 * b->m[k] * (v3_norm2(old) - v3_norm2(now));
        v->given[k] += b->m[k] * v3_dot(pull, v3_sub(now, old));
        b->v[k] = v3_add(pull, now);
    }
    if (m->free & TURNS && v3_some(m->ct)) {
        const double before = v3_dot(b->w[k], b->L[k]);
        const fl_mat3 R = fl_body_axes(b, k);
        const fl_vec3 own = m3_tmul(R, b->L[k]), f = v->fade_turn[k], w = b->w[k];
        b->L[k] = m3_mul(R, v3(f.x * own.x, f.y * own.y, f.z * own.z));
        b->w[k] = fl_body_turn(b, k, b->L[k]);
        if (b->hold[k] & TURNS) fl_hold(b, k, b->v[k], w);
        v->damped[k] += 0.5 * (before - v3_dot(b->w[k], b->L[k]));
    }
}

static void kick(fl_movers *v, int32_t k, double h)
{
    fl_kick(&v->b, k, h);
    v->given[k] += h * v3_dot(v->spring[k], v->pull[k]);
}

/* Rounding aside, x follows the told way in the held directions by itself. */
static void follow(fl_movers *v, int32_t k)
{
    fl_bodies *b = &v->b;
    const fl_vec3 x = v3_add(v->motion[k].reference, v->anchor[k]);
    for (int c = 0; c < 3; c++)
        if (b->hold[k] & (unsigned)(FL_HOLD_X << c)) set_component(&b->x[k], c, v3_at(x, c));
}

void fl_mover_out(fl_movers *v, int32_t k, double t, double dt)
{
    fl_bodies *b = &v->b;
    const fl_motion *m = &v->motion[k];
    fl_pose6 x, rate, second;
    told(m, t + dt, &x, &rate, &second);
    v->pull[k] = m->track.n ? v3_scale(1.0 / dt, v3_sub(x.x, v->anchor[k])) : m->velocity;
    v->anchor[k] = x.x;
    if (m->free) {
        lead(v, k, v->pull[k]);
        fl_mover_damp(v, k);
        kick(v, k, 0.5 * dt);
        fl_drift(b, k, dt);
        follow(v, k);
        return;
    }
    fl_pose6 middle;
    told(m, t + 0.5 * dt, &middle, &rate, &second);
    b->x[k] = v3_add(m->reference, x.x);
    b->v[k] = v->pull[k];
    b->w[k] = turning(middle.r, rate.r);
    if (!v3_some(x.r) && !v3_some(b->w[k])) return;
    b->q[k] = q_of_vector(x.r);
}

void fl_mover_pull(fl_movers *v, int32_t k)
{
    fl_bodies *b = &v->b;
    const fl_motion *m = &v->motion[k];
    if (!m->free) return;
    const fl_vec3 u = v3_sub(v3_sub(b->x[k], m->reference), v->anchor[k]),
                  q = v3(b->q[k].x, b->q[k].y, b->q[k].z);
    const double y[6] = {u.x, u.y, u.z, 2.0 * q.x, 2.0 * q.y, 2.0 * q.z};
    double g[6], W = 0.0;
    for (int r = 0; r < 6; r++) {
        g[r] = 0.0;
        for (int c = 0; c < 6; c++) g[r] += m->K[r][c] * y[c];
        W += 0.5 * y[r] * g[r];
    }
    const fl_vec3 turn = v3(g[3], g[4], g[5]);
    v->stored[k] = W;
    v->spring[k] = v3(-g[0], -g[1], -g[2]);
    v->twist[k] = v3_neg(v3_madd(v3_cross(q, turn), b->q[k].w, turn));
    b->f[k] = v3_add(b->f[k], v->spring[k]);
    b->t[k] = v3_add(b->t[k], v->twist[k]);
}

void fl_mover_back(fl_movers *v, int32_t k, double t, double h)
{
    fl_pose6 x, rate, second;
    if (v->motion[k].free) {
        kick(v, k, h);
        return;
    }
    told(&v->motion[k], t, &x, &rate, &second);
    v->b.v[k] = rate.x;
    v->b.w[k] = turning(x.r, rate.r);
}

double fl_mover_kinetic(const fl_movers *v, int32_t k)
{
    return v->motion[k].free ? fl_body_kinetic(&v->b, k) : 0.0;
}

void fl_mover_acceleration(const fl_movers *v, int32_t k, double t, fl_vec3 *a, fl_vec3 *turn)
{
    const fl_bodies *b = &v->b;
    const fl_motion *m = &v->motion[k];
    fl_pose6 x, rate, second;
    told(m, t, &x, &rate, &second);
    *a = second.x;
    if (!m->free) { /* how w changes with r'' at once, and with r along r': the difference over a short way */
        const double h = 1e-4 / (1.0 + v3_norm(rate.r));
        const fl_vec3 late = turning(v3_madd(x.r, h, rate.r), rate.r),
                      early = turning(v3_madd(x.r, -h, rate.r), rate.r);
        *turn = v3_madd(turning(x.r, second.r), 0.5 / h, v3_sub(late, early));
        return;
    }
    const fl_mat3 R = fl_body_axes(b, k);
    const fl_vec3 slip = v3_sub(b->v[k], v->pull[k]), own = m3_tmul(R, b->w[k]);
    const fl_vec3 drag = m3_mul(R, v3(m->ct.x * own.x, m->ct.y * own.y, m->ct.z * own.z));
    const fl_vec3 torque = v3_sub(v3_sub(b->t[k], drag), v3_cross(b->w[k], b->L[k]));
    *turn = m->free & TURNS ? fl_body_turn(b, k, torque) : v3(0, 0, 0);
    for (int c = 0; c < 3; c++) {
        const double force = v3_at(b->f[k], c) - v3_at(m->c, c) * v3_at(slip, c);
        if (m->free >> c & 1u) set_component(a, c, force * b->invm[k]);
        if (!(m->free >> (3 + c) & 1u)) set_component(turn, c, 0.0);
    }
}

static double inert(const fl_motion *m, int k)
{
    return k < 3 ? m->mass : k == 3 ? m->inertia.x : k == 4 ? m->inertia.y : m->inertia.z;
}

double fl_motion_stiff(const fl_motion *m)
{
    double most = 0.0;
    for (int r = 0; r < 6; r++) {
        double row = 0.0;
        for (int c = 0; c < 6; c++)
            if (m->free >> r & m->free >> c & 1u) row += fabs(m->K[r][c]) / sqrt(inert(m, r) * inert(m, c));
        most = row > most ? row : most;
    }
    return most;
}

double fl_motion_soft(const fl_motion *m, double arm)
{
    double turn = 0.0;
    for (int k = 3; k < 6; k++)
        if (m->free >> k & 1u && 1.0 / inert(m, k) > turn) turn = 1.0 / inert(m, k);
    return (m->free & 7u ? 1.0 / m->mass : 0.0) + arm * arm * turn;
}

void fl_movers_free(fl_movers *v)
{
    for (int32_t k = 0; k < v->n; k++) fl_track_free(&v->motion[k].track);
    free(v->motion), free(v->anchor), free(v->pull), free(v->spring), free(v->twist), free(v->stored);
    free(v->damped), free(v->given), free(v->fade), free(v->fade_turn);
    fl_bodies_free(&v->b);
    *v = (fl_movers){0};
}
