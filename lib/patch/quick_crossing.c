/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/simd.h"
#include "patch/quick_crossing.h"
#include "base/pi.h"
#include "patch/patch_law.h"

#define ROUNDING 1e-12 /* of R: lines that are nearer have no direction between them but that of their axes */

/* Four pairs of edges, in the frame of B. */
typedef struct {
    fl_simd p[3], a[3], la; /* of A: end, direction, length */
    fl_simd r[3], b[3], lb; /* of B */
    fl_simd weight;
} crossing_lanes;

FL_SIMD_INLINE void load_crossing(crossing_lanes *to, int k, const fl_quick_direction *d, int32_t ea,
                                  int32_t eb)
{
    const fl_quick_edge *e = &d->own->edge[ea], *f = &d->other->edge[eb];
    const fl_vec3 p = v3_add(m3_mul(d->M, e->a), d->o), a = m3_mul(d->M, e->d);
    to->p[0][k] = p.x, to->p[1][k] = p.y, to->p[2][k] = p.z;
    to->a[0][k] = a.x, to->a[1][k] = a.y, to->a[2][k] = a.z, to->la[k] = e->length;
    to->r[0][k] = f->a.x, to->r[1][k] = f->a.y, to->r[2][k] = f->a.z;
    to->b[0][k] = f->d.x, to->b[1][k] = f->d.y, to->b[2][k] = f->d.z, to->lb[k] = f->length;
    to->weight[k] = e->weight * f->weight;
}

#define DOT(a, b) ((a)[0] * (b)[0] + (a)[1] * (b)[1] + (a)[2] * (b)[2])

/* t(z) of a foot at x on an edge of length l, and its derivatives by x and by the cosine C of the edges,
 * S their sine. */
FL_SIMD_INLINE void taper_of(fl_simd *value, fl_simd *slope, fl_simd *by_C, const fl_simd *x,
                             const fl_simd *l, const fl_simd *S, const fl_simd *C, double width)
{
    const fl_simd zero = {0}, one = 1.0 + zero, rest = *l - *x, half = 0.5 * *l, wide = width / *S;
    const fl_simd_mask first = *x < rest, turns = wide < half;
    const fl_simd z = FL_SIMD_SELECT(first, *x, rest), most = FL_SIMD_SELECT(turns, wide, half);
    fl_simd t = z / most;
    t = FL_SIMD_MIN(FL_SIMD_MAX(t, zero), one);
    const fl_simd steep = FL_QUICK_SLOPE(t);
    *value = FL_QUICK_STEP(t);
    *slope = steep / FL_SIMD_SELECT(first, most, -most);
    *by_C = FL_SIMD_MASKED(turns, -steep * z * *C / (*S * width));
}

/* The term depends on s, on the feet t and u by the tapers, and on the cosine C of the edges.  With the
 * motion dx, turn of A about the origin of B, w0 = p - r and D = 1 - C^2,
 *     dt = [(wb + 2Ct) dC + C dwb - dwa]/D,   du = [dwb - C dwa - (wa - 2Cu) dC]/D,
 *     dC = turn.(a x b),   dwb = b.(dx + turn x p),   dwa = a.(dx + turn x r). */
FL_SIMD_VERSIONS static void add_four(const crossing_lanes *c, double reach, double R, double factor,
                                      double middle, fl_vec3 axis, fl_quick_total *to, double *overlap)
{
    const fl_simd zero = {0}, one = 1.0 + zero;
    const fl_simd w[3] = {c->p[0] - c->r[0], c->p[1] - c->r[1], c->p[2] - c->r[2]};
    const fl_simd C = DOT(c->a, c->b), D = 1.0 - C * C, wa = DOT(w, c->a), wb = DOT(w, c->b);
    fl_simd_mask on = (D > FL_QUICK_ALONG * FL_QUICK_ALONG) & (c->la > 0.0);
    const fl_simd i = 1.0 / FL_SIMD_SELECT(on, D, one), t = (C * wb - wa) * i, u = (wb - C * wa) * i;
    on &= (t > 0.0) & (t < c->la) & (u > 0.0) & (u < c->lb);
    if (!fl_simd_any(&on)) return;
    fl_simd n[3], x[3];
    FL_SIMD_UNROLL
    for (int k = 0; k < 3; k++) n[k] = w[k] + t * c->a[k] - u * c->b[k], x[k] = c->p[k] + t * c->a[k];
    const fl_simd d2 = DOT(n, n);
    on &= d2 < reach * reach;
    if (!fl_simd_any(&on)) return;
    const fl_simd turn[3] = {c->a[1] * c->b[2] - c->a[2] * c->b[1], c->a[2] * c->b[0] - c->a[0] * c->b[2],
                             c->a[0] * c->b[1] - c->a[1] * c->b[0]};
    fl_simd d, S;
    for (int k = 0; k < FL_SIMD_WIDTH; k++) d[k] = sqrt(d2[k]), S[k] = on[k] ? sqrt(D[k]) : 1.0;
    const fl_simd_mask near = d < ROUNDING * R; /* the cores touch: n along the common normal */
    const fl_simd along = turn[0] * axis.x + turn[1] * axis.y + turn[2] * axis.z,
                  each = FL_SIMD_SELECT(along < 0.0, -one, one) / S, per = 1.0 / FL_SIMD_SELECT(near, one, d);
    FL_SIMD_UNROLL
    for (int k = 0; k < 3; k++) n[k] = FL_SIMD_SELECT(near, each * turn[k], per * n[k]);
    const fl_simd s = FL_SIMD_MASKED(on, reach - d), s2 = s * s;
    fl_simd et, dt, eu, du, et_C, eu_C;
    taper_of(&et, &dt, &et_C, &t, &c->la, &S, &C, FL_QUICK_TAPER * R);
    taper_of(&eu, &du, &eu_C, &u, &c->lb, &S, &C, FL_QUICK_TAPER * R);
    const fl_simd past = (D - FL_QUICK_ALONG * FL_QUICK_ALONG) * (1.0 / FL_QUICK_PARALLEL),
                  z = FL_SIMD_MIN(FL_SIMD_MAX(past, zero), one), gS = FL_QUICK_STEP(z) / S,
                  dg = (FL_QUICK_SLOPE(z) * (1.0 / FL_QUICK_PARALLEL) / S - 0.5 * gS * i) * (-2.0 * C);
    const fl_simd k4 = factor * c->weight * s2 * s2, k5 = k4 * s, all = gS * et * eu;
    const fl_simd kt = gS * dt * eu * k5, ku = gS * et * du * k5,
                  kC = (dg * et * eu + gS * (et_C * eu + et * eu_C)) * k5;
    const fl_simd by_b = i * (C * kt + ku), by_a = -i * (kt + C * ku),
                  by_C = kC + i * (kt * (wb + 2.0 * C * t) - ku * (wa - 2.0 * C * u));
    fl_quick_lanes row;
    fl_simd at[3];
    const fl_simd down = 0.5 * s - middle;
    FL_SIMD_UNROLL
    for (int k = 0; k < 3; k++) at[k] = x[k] + down * n[k];
    FL_QUICK_SET_POINT(&row, FL_SIMD_MASKED(on, all * k5), FL_SIMD_MASKED(on, 5.0 * all * k4),
                       FL_SIMD_MASKED(on, 20.0 * all * k4 / FL_SIMD_SELECT(s > 0.0, s, one)), n, at);
    FL_SIMD_UNROLL
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        const fl_simd f = by_b * c->b[k] + by_a * c->a[k];
        const fl_simd m = by_b * (c->p[a] * c->b[b] - c->p[b] * c->b[a]) +
                          by_a * (c->r[a] * c->a[b] - c->r[b] * c->a[a]) + by_C * turn[k];
        row.a[FL_QUICK_F + k] -= FL_SIMD_MASKED(on, f), row.a[FL_QUICK_M + k] -= FL_SIMD_MASKED(on, m);
    }
    fl_quick_add_lanes(to, &row);
    for (int k = 0; k < FL_SIMD_WIDTH; k++)
        if (all[k] > 0.0 && s[k] > *overlap) *overlap = s[k];
}

FL_SIMD_VERSIONS void fl_quick_add_crossings(const fl_quick_direction *d, double rho_b, fl_vec3 axis,
                                             fl_quick_total *to, double *overlap)
{
    const double factor = FL_PATCH_ROUND_FACTOR * (0.4 * PI) * sqrt(d->rho * rho_b);
    int32_t n;
    const int32_t *at = fl_quick_section_of(d->l, FL_QUICK_CROSSING, &n);
    for (int32_t k = 0; k < n; k += 2 * FL_SIMD_WIDTH) {
        crossing_lanes c;
        for (int32_t i = 0; i < FL_SIMD_WIDTH; i++) { /* the last is repeated without length */
            const int32_t from = k + 2 * i < n ? k + 2 * i : n - 2;
            load_crossing(&c, (int)i, d, at[from], at[from + 1]);
            if (k + 2 * i >= n) c.la[i] = 0.0;
        }
        add_four(&c, d->reach, d->R, factor, d->r, axis, to, overlap);
    }
}
