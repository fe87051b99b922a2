/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/wide.h"
#include "body/integrate.h"
#include "step/frozen.h"
#include "step/plain.h"
#include "step/sleep.h"

int fl_plain_is(const fl_world *w, int32_t k)
{
    return w->balls.bodies && !fl_frozen_at(w, k) && !w->sea.n && !w->row.n &&
           w->inc_first[k] == w->inc_first[k + 1] && fl_body_plain(&w->b, k) && !fl_world_away(w, k) &&
           fl_sleep_kind(w, k) == FL_AWAKE;
}

/* What the loops below read and write, from the first body of the group on. */
typedef struct {
    const double *m, *invm;
    const fl_vec3 *I;
    const fl_ball_sum *sum, *was;
    fl_vec3 *f, *t, *v, *L, *w;
    double *damped, *rubbed;
} group;

/* The gains of either kick. */
typedef struct {
    double v0[3][FL_BALLS_GROUP], w0[3][FL_BALLS_GROUP], v1[3][FL_BALLS_GROUP], w1[3][FL_BALLS_GROUP];
} gains;

FL_WIDE_VERSIONS static void force(const group *restrict a, int32_t n, fl_vec3 g, double h, gains *restrict q)
{
    const double *m = a->m, *invm = a->invm;
    const fl_vec3 *I = a->I;
    const fl_ball_sum *s = a->sum;
    fl_vec3 *f = a->f, *t = a->t;
#pragma omp simd
    for (int32_t k = 0; k < n; k++) {
        const double s1 = h * invm[k], s2 = h / I[k].x;
        q->v0[0][k] = s1 * f[k].x;
        q->v0[1][k] = s1 * f[k].y;
        q->v0[2][k] = s1 * f[k].z;
        q->w0[0][k] = s2 * t[k].x;
        q->w0[1][k] = s2 * t[k].y;
        q->w0[2][k] = s2 * t[k].z;
        const double x = m[k] * g.x + (s[k].elastic.x + s[k].damping.x + s[k].friction.x),
                     y = m[k] * g.y + (s[k].elastic.y + s[k].damping.y + s[k].friction.y),
                     z = m[k] * g.z + (s[k].elastic.z + s[k].damping.z + s[k].friction.z);
        const double tx = 0.0 + s[k].torque.x, ty = 0.0 + s[k].torque.y, tz = 0.0 + s[k].torque.z;
        f[k].x = x;
        f[k].y = y;
        f[k].z = z;
        t[k].x = tx;
        t[k].y = ty;
        t[k].z = tz;
        q->v1[0][k] = s1 * x;
        q->v1[1][k] = s1 * y;
        q->v1[2][k] = s1 * z;
        q->w1[0][k] = s2 * tx;
        q->w1[1][k] = s2 * ty;
        q->w1[2][k] = s2 * tz;
    }
}

FL_WIDE_VERSIONS static void work(const group *restrict a, int32_t n, double dt, const gains *restrict q)
{
    const fl_ball_sum *s1 = a->sum, *s0 = a->was;
    const fl_vec3 *v = a->v, *w = a->w;
    const double sixth = dt / 6.0;
    double *damped = a->damped, *rubbed = a->rubbed;
#pragma omp simd
    for (int32_t k = 0; k < n; k++) {
        const double ax = q->v0[0][k], ay = q->v0[1][k], az = q->v0[2][k], bx = q->v1[0][k], by = q->v1[1][k],
                     bz = q->v1[2][k];
        const double dx = s1[k].damping.x, dy = s1[k].damping.y, dz = s1[k].damping.z;
        const double fx = s1[k].friction.x, fy = s1[k].friction.y, fz = s1[k].friction.z;
        const double tx = s1[k].torque.x, ty = s1[k].torque.y, tz = s1[k].torque.z;
        const double now = dx * v[k].x + dy * v[k].y + dz * v[k].z, before = dx * ax + dy * ay + dz * az;
        const double then = s0[k].damping.x * bx + s0[k].damping.y * by + s0[k].damping.z * bz;
        damped[k] = 0.0 - (dt * now + sixth * (before - then));
        const double rub =
            (fx * v[k].x + fy * v[k].y + fz * v[k].z) + (tx * w[k].x + ty * w[k].y + tz * w[k].z);
        const double rub0 =
            (fx * ax + fy * ay + fz * az) + (tx * q->w0[0][k] + ty * q->w0[1][k] + tz * q->w0[2][k]);
        const double rub1 =
            (s0[k].friction.x * bx + s0[k].friction.y * by + s0[k].friction.z * bz) +
            (s0[k].torque.x * q->w1[0][k] + s0[k].torque.y * q->w1[1][k] + s0[k].torque.z * q->w1[2][k]);
        rubbed[k] = 0.0 - (dt * rub + sixth * (rub0 - rub1));
    }
}

void fl_plain_end(fl_world *w, int32_t from, int32_t to, double h)
{
    fl_bodies *b = &w->b;
    const int32_t n = to - from;
    const group a = {b->m + from,         b->invm + from, b->I + from,      w->balls.sum + from,
                     w->balls.was + from, b->f + from,    b->t + from,      b->v + from,
                     b->L + from,         b->w + from,    w->damped + from, w->rubbed + from};
    gains q;
    force(&a, n, w->gravity, h, &q);
    fl_move_free(b, from, to, h, 0.0, NULL);
    work(&a, n, w->dt, &q);
}
