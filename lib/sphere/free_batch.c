/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include <string.h>
#include "base/simd.h"
#include "body/integrate.h"
#include "sphere/free_batch.h"
#include "world/access.h"

int fl_is_free_sphere(const fl_world *w, int32_t k)
{
    return w->spheres.bodies && !w->sea.n && !w->driven_floes.n && !w->discs.n &&
           w->first_pair_of_body[k] == w->first_pair_of_body[k + 1] && !fl_sums_before(w, k)->contacts &&
           fl_body_is_free_isotropic(&w->b, k) && !fl_body_absent(w, k);
}

/* Arrays of the loop below, from the first body on. */
typedef struct {
    const double *m, *invm;
    const fl_vec3 *invI, *x;
    const fl_sphere_sum *sum, *before;
    fl_vec3 *f, *t, *v, *L, *w;
    double *damping_work, *friction_work;
} body_arrays;

/* The twelve numbers of four sums, one register each. */
typedef struct {
    fl_simd elastic[3], damping[3], friction[3], torque[3];
} sums;
static_assert(sizeof(sums) == 12 * sizeof(fl_simd) && sizeof(fl_sphere_sum) == 12 * sizeof(double),
              "same layout");

FL_SIMD_INLINE void load_sums(sums *q, const fl_sphere_sum *s)
{
    fl_simd *to = &q->elastic[0];
    FL_SIMD_UNROLL for (int part = 0; part < 3; part++)
    {
        fl_simd r[FL_SIMD_WIDTH];
        FL_SIMD_UNROLL for (int l = 0; l < FL_SIMD_WIDTH; l++) r[l] =
            FL_SIMD_LOAD((const double *)&s[l] + FL_SIMD_WIDTH * part);
        fl_simd_transpose(r);
        FL_SIMD_UNROLL for (int l = 0; l < FL_SIMD_WIDTH; l++) to[FL_SIMD_WIDTH * part + l] = r[l];
    }
}

#define DOT(a, b) (a[0] * b[0] + a[1] * b[1] + a[2] * b[2])

/* Ends the step of n bodies, a multiple of the SIMD width; returns 0, or NaN if a number is not finite. */
FL_SIMD4_VERSIONS static double end_step_of(const body_arrays *restrict a, int32_t n, fl_vec3 gravity,
                                            double dt, double h)
{
    const double g[3] = {gravity.x, gravity.y, gravity.z}, sixth = dt / 6.0;
    fl_simd zero = {0.0, 0.0, 0.0, 0.0};
    for (int32_t k = 0; k < n; k += FL_SIMD_WIDTH) {
        const fl_simd m = FL_SIMD_LOAD(&a->m[k]), invm = FL_SIMD_LOAD(&a->invm[k]);
        const double *x = (const double *)&a->x[k];
        fl_simd inverse_I[3], f[3], t[3], v[3], L[3], w[3];
        sums s1, s0;
        fl_simd_from_triples(inverse_I, &a->invI[k]);
        fl_simd_from_triples(f, &a->f[k]);
        fl_simd_from_triples(t, &a->t[k]);
        fl_simd_from_triples(v, &a->v[k]);
        fl_simd_from_triples(L, &a->L[k]);
        load_sums(&s1, &a->sum[k]);
        load_sums(&s0, &a->before[k]);
        const fl_simd by = h * invm, turn = h * inverse_I[0];
        fl_simd v0[3], w0[3], v1[3], w1[3]; /* velocity changes of the two kicks */
        FL_SIMD_UNROLL for (int c = 0; c < 3; c++)
        {
            v0[c] = by * f[c];
            w0[c] = turn * t[c];
            f[c] = m * g[c] + (s1.elastic[c] + s1.damping[c] + s1.friction[c]);
            t[c] = 0.0 + s1.torque[c];
        }
        FL_SIMD_UNROLL for (int c = 0; c < 3; c++)
        {
            v1[c] = by * f[c];
            w1[c] = turn * t[c];
            v[c] += v1[c];
            L[c] += h * t[c];
            w[c] = inverse_I[0] * L[c];
        }
        fl_simd_to_triples(&a->f[k], f);
        fl_simd_to_triples(&a->t[k], t);
        fl_simd_to_triples(&a->v[k], v);
        fl_simd_to_triples(&a->L[k], L);
        fl_simd_to_triples(&a->w[k], w);
        FL_SIMD_STORE(&a->damping_work[k]) =
            0.0 - (dt * DOT(s1.damping, v) + sixth * (DOT(s1.damping, v0) - DOT(s0.damping, v1)));
        FL_SIMD_STORE(&a->friction_work[k]) = 0.0 - (dt * (DOT(s1.friction, v) + DOT(s1.torque, w)) +
                                                     sixth * ((DOT(s1.friction, v0) + DOT(s1.torque, w0)) -
                                                              (DOT(s0.friction, v1) + DOT(s0.torque, w1))));
        zero += 0.0 * (FL_SIMD_LOAD(x) + FL_SIMD_LOAD(x + 4) + FL_SIMD_LOAD(x + 8)) +
                0.0 * (f[0] + f[1] + f[2]) + 0.0 * (t[0] + t[1] + t[2]) + 0.0 * (v[0] + v[1] + v[2]);
    }
    return fl_simd_sum(&zero);
}

/* The last bodies, fewer than the SIMD width, padded with copies of the last one. */
typedef struct {
    double m[FL_SIMD_WIDTH], invm[FL_SIMD_WIDTH], damping_work[FL_SIMD_WIDTH], friction_work[FL_SIMD_WIDTH];
    fl_vec3 invI[FL_SIMD_WIDTH], x[FL_SIMD_WIDTH], f[FL_SIMD_WIDTH], t[FL_SIMD_WIDTH], v[FL_SIMD_WIDTH],
        L[FL_SIMD_WIDTH], w[FL_SIMD_WIDTH];
    fl_sphere_sum sum[FL_SIMD_WIDTH], before[FL_SIMD_WIDTH];
} padded_bodies;

static double end_step_of_rest(const body_arrays *a, int32_t from, int32_t n, fl_vec3 gravity, double dt,
                               double h)
{
    padded_bodies r;
    const body_arrays of = {r.m, r.invm, r.invI, r.x, r.sum,          r.before,       r.f,
                            r.t, r.v,    r.L,    r.w, r.damping_work, r.friction_work};
    for (int32_t l = 0; l < FL_SIMD_WIDTH; l++) {
        const int32_t k = from + (l < n ? l : n - 1);
        r.m[l] = a->m[k], r.invm[l] = a->invm[k];
        r.invI[l] = a->invI[k], r.x[l] = a->x[k], r.f[l] = a->f[k], r.t[l] = a->t[k], r.v[l] = a->v[k],
        r.L[l] = a->L[k];
        r.sum[l] = a->sum[k], r.before[l] = a->before[k];
    }
    const double zero = end_step_of(&of, FL_SIMD_WIDTH, gravity, dt, h);
    for (int32_t l = 0; l < n; l++) {
        const int32_t k = from + l;
        a->f[k] = r.f[l], a->t[k] = r.t[l], a->v[k] = r.v[l], a->L[k] = r.L[l], a->w[k] = r.w[l];
        a->damping_work[k] = r.damping_work[l], a->friction_work[k] = r.friction_work[l];
    }
    return zero;
}

int fl_free_batch_end_step(fl_world *w, int32_t from, int32_t to, double h, fl_free_batch_work *works)
{
    fl_bodies *b = &w->b;
    const body_arrays a = {b->m + from,    b->invm + from,        b->invI + from,
                           b->x + from,    w->spheres.sum + from, w->spheres.previous_sum + from,
                           b->f + from,    b->t + from,           b->v + from,
                           b->L + from,    b->w + from,           works->damping,
                           works->friction};
    const int32_t n = to - from, left = n % FL_SIMD_WIDTH;
    double zero = end_step_of(&a, n - left, w->gravity, w->dt, h);
    if (left) zero += end_step_of_rest(&a, n - left, left, w->gravity, w->dt, h);
    return zero == 0.0; /* 0 x is 0 only for a finite x */
}
