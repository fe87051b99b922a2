/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include "base/simd.h"
#include "water/facet_drag.h"

FL_SIMD_INLINE void take_square_roots(fl_simd *x)
{
    double a[FL_SIMD_WIDTH];
    FL_SIMD_STORE(a) = *x;
#pragma omp simd
    for (int l = 0; l < FL_SIMD_WIDTH; l++) a[l] = sqrt(a[l]);
    *x = FL_SIMD_LOAD(a);
}

#define DOT(a, v) (v.x * a[0] + v.y * a[1] + v.z * a[2])

/* Moments of s and of f over the pieces of four facets, and their moments with U. */
typedef struct {
    fl_simd s, sx, sy, srr, f, fx, fy, fxx, fxy, fyy;
    fl_simd se, sg, turn, fn, fnx, fny;
} moments;

/* u0: velocity at x = y = 0 of the facet; w: angular velocity; both along e, g and n. skin, form: times h. */
FL_SIMD_INLINE void sum_pieces(moments *to, const fl_facet_piece *row, const fl_facet_flow *flow,
                               int32_t rows, double skin, double form, const fl_simd u0[3],
                               const fl_simd w[3])
{
    const fl_simd zero = {0.0, 0.0, 0.0, 0.0};
    moments m = {zero, zero, zero, zero, zero, zero, zero, zero,
                 zero, zero, zero, zero, zero, zero, zero, zero};
    for (int32_t k = 0; k < rows; k++) {
        const fl_simd area = FL_SIMD_LOAD(row[k].area), x = FL_SIMD_LOAD(row[k].x),
                      y = FL_SIMD_LOAD(row[k].y);
        fl_simd ue = u0[0] - y * w[2], ug = u0[1] + x * w[2], un = u0[2] + (y * w[0] - x * w[1]);
        if (flow) {
            ue -= FL_SIMD_LOAD(flow[k].u[0]);
            ug -= FL_SIMD_LOAD(flow[k].u[1]);
            un -= FL_SIMD_LOAD(flow[k].u[2]);
        }
        fl_simd ut = ue * ue + ug * ug;
        take_square_roots(&ut);
        const fl_simd s = area * ut, f = area * FL_SIMD_MASKED(un > 0.0, un);
        const fl_simd sx = s * x, sy = s * y, fx = f * x, fy = f * y;
        m.s += s, m.sx += sx, m.sy += sy, m.srr += x * sx + y * sy;
        m.f += f, m.fx += fx, m.fy += fy;
        m.fxx += x * fx, m.fxy += x * fy, m.fyy += y * fy;
        if (flow) {
            const fl_simd Ue = FL_SIMD_LOAD(flow[k].u[0]), Ug = FL_SIMD_LOAD(flow[k].u[1]),
                          Un = FL_SIMD_LOAD(flow[k].u[2]);
            m.se += s * Ue, m.sg += s * Ug, m.turn += sx * Ug - sy * Ue;
            m.fn += f * Un, m.fnx += fx * Un, m.fny += fy * Un;
        }
    }
    to->s = skin * m.s, to->sx = skin * m.sx, to->sy = skin * m.sy, to->srr = skin * m.srr;
    to->f = form * m.f, to->fx = form * m.fx, to->fy = form * m.fy;
    to->fxx = form * m.fxx, to->fxy = form * m.fxy, to->fyy = form * m.fyy;
    if (!flow) return;
    to->se = skin * m.se, to->sg = skin * m.sg, to->turn = skin * m.turn;
    to->fn = form * m.fn, to->fnx = form * m.fnx, to->fny = form * m.fny;
}

/* First number of row i of the matrix. */
#define ROW(sum, i) ((sum) + FL_DRAG_MATRIX + (i) * ((i) + 1) / 2)

/* Adds four facets to sums of four each. skin, form: times h. */
FL_SIMD_INLINE void add_group(const fl_facet_group *at, const fl_facet_piece *row, const fl_facet_flow *flow,
                              double skin, double form, fl_vec3 v, fl_vec3 w, fl_simd *sum)
{
    const fl_simd n[3] = {FL_SIMD_LOAD(at->n[0]), FL_SIMD_LOAD(at->n[1]), FL_SIMD_LOAD(at->n[2])},
                  e[3] = {FL_SIMD_LOAD(at->e[0]), FL_SIMD_LOAD(at->e[1]), FL_SIMD_LOAD(at->e[2])},
                  g[3] = {FL_SIMD_LOAD(at->g[0]), FL_SIMD_LOAD(at->g[1]), FL_SIMD_LOAD(at->g[2])},
                  c = FL_SIMD_LOAD(at->c);
    const fl_simd turn[3] = {DOT(e, w), DOT(g, w), DOT(n, w)};
    const fl_simd u[3] = {DOT(e, v) + c * turn[1], DOT(g, v) - c * turn[0], DOT(n, v)};
    moments m;
    sum_pieces(&m, row, flow, at->pieces, skin, form, u, turn);
    fl_simd *const vv[3] = {ROW(sum, 0), ROW(sum, 1), ROW(sum, 2)};
    fl_simd *const wv[3] = {ROW(sum, 3), ROW(sum, 4), ROW(sum, 5)};
    fl_simd *const ww[3] = {wv[0] + 3, wv[1] + 3, wv[2] + 3};
    const fl_simd cs = c * m.s, ccs = c * cs, more = m.f - m.s;
    /* p = f_y e - f_x g, q = s_y e - s_x g; ww is n t + t n + g b + b g and a diagonal, as e e is
     * 1 - g g - n n */
    const fl_simd round = ccs + m.fyy, half = 0.5 * (m.srr - round), apart = 0.5 * (m.fxx - m.fyy);
    fl_simd p[3], q[3], t[3], b[3];
    FL_SIMD_UNROLL for (int i = 0; i < 3; i++)
    {
        p[i] = m.fy * e[i] - m.fx * g[i];
        q[i] = m.sy * e[i] - m.sx * g[i];
        t[i] = half * n[i] - c * (m.sx * e[i] + m.sy * g[i]);
        b[i] = apart * g[i] - m.fxy * e[i];
    }
    FL_SIMD_UNROLL for (int i = 0; i < 3; i++)
    {
        const fl_simd mn = more * n[i];
        FL_SIMD_UNROLL for (int j = 0; j <= i; j++)
        {
            vv[i][j] += mn * n[j];
            ww[i][j] += (n[i] * t[j] + t[i] * n[j]) + (g[i] * b[j] + b[i] * g[j]);
        }
        FL_SIMD_UNROLL for (int j = 0; j < 3; j++) wv[i][j] += p[i] * n[j] - n[i] * q[j];
        vv[i][i] += m.s;
        ww[i][i] += round;
    }
    const fl_simd N[3] = {cs * n[0], cs * n[1], cs * n[2]};
    wv[0][1] -= N[2], wv[0][2] += N[1];
    wv[1][0] += N[2], wv[1][2] -= N[0];
    wv[2][0] -= N[1], wv[2][1] += N[0];
    if (!flow) return;
    const fl_simd re = m.fny - c * m.sg, rg = c * m.se - m.fnx;
    FL_SIMD_UNROLL for (int i = 0; i < 3; i++)
    {
        sum[i] += m.se * e[i] + m.sg * g[i] + m.fn * n[i];
        sum[3 + i] += re * e[i] + rg * g[i] + m.turn * n[i];
    }
}

/* Adds four sides of a prism along the last axis: n = (a, b, 0), e = (-b, a, 0), g = (0, 0, 1). */
FL_SIMD_INLINE void add_prism_sides(const fl_simd *a, const fl_simd *b, const fl_facet_group *at,
                                    const fl_facet_piece *row, const fl_facet_flow *flow, double skin,
                                    double form, fl_vec3 v, fl_vec3 w, fl_simd *sum)
{
    const fl_simd n1 = *a, n2 = *b, c = FL_SIMD_LOAD(at->c), zero = {0.0, 0.0, 0.0, 0.0};
    const fl_simd turn[3] = {w.y * n1 - w.x * n2, zero + w.z, w.x * n1 + w.y * n2};
    const fl_simd u[3] = {(v.y * n1 - v.x * n2) + c * turn[1], v.z - c * turn[0], v.x * n1 + v.y * n2};
    moments m;
    sum_pieces(&m, row, flow, at->pieces, skin, form, u, turn);
    fl_simd *const vv[3] = {ROW(sum, 0), ROW(sum, 1), ROW(sum, 2)};
    fl_simd *const wv[3] = {ROW(sum, 3), ROW(sum, 4), ROW(sum, 5)};
    fl_simd *const ww[3] = {wv[0] + 3, wv[1] + 3, wv[2] + 3};
    const fl_simd n11 = n1 * n1, n12 = n1 * n2, n22 = n2 * n2;
    const fl_simd cs = c * m.s, csx = c * m.sx, csy = c * m.sy, more = m.f - m.s, off = (m.sy - m.fy) * n12;
    const fl_simd round = c * cs + m.fyy, both = 2.0 * csx * n12;
    vv[0][0] += more * n11 + m.s, vv[1][0] += more * n12, vv[1][1] += more * n22 + m.s, vv[2][2] += m.s;
    wv[0][0] += off, wv[0][1] -= m.fy * n22 + m.sy * n11, wv[0][2] += m.sx * n1 + cs * n2;
    wv[1][0] += m.fy * n11 + m.sy * n22, wv[1][1] -= off, wv[1][2] += m.sx * n2 - cs * n1;
    wv[2][0] -= m.fx * n1 + cs * n2, wv[2][1] += cs * n1 - m.fx * n2;
    ww[0][0] += (round * n22 + m.srr * n11) + both;
    ww[1][0] += (m.srr - round) * n12 - csx * (n11 - n22);
    ww[1][1] += (round * n11 + m.srr * n22) - both;
    ww[2][0] += m.fxy * n2 - csy * n1, ww[2][1] -= m.fxy * n1 + csy * n2;
    ww[2][2] += c * cs + m.fxx;
    if (!flow) return;
    const fl_simd re = m.fny - c * m.sg;
    sum[0] += m.fn * n1 - m.se * n2, sum[1] += m.fn * n2 + m.se * n1, sum[2] += m.sg;
    sum[3] += m.turn * n1 - re * n2, sum[4] += m.turn * n2 + re * n1, sum[5] += c * m.se - m.fnx;
}

/* Adds its cap: n = (0, 0, z), e = (1, 0, 0), g = (0, z, 0), z = 1 or -1. */
FL_SIMD_INLINE void add_prism_cap(double z, const fl_facet_group *at, const fl_facet_piece *row,
                                  const fl_facet_flow *flow, double skin, double form, fl_vec3 v, fl_vec3 w,
                                  fl_simd *sum)
{
    const fl_simd zero = {0.0, 0.0, 0.0, 0.0};
    const double c = at->c[0];
    const fl_simd turn[3] = {zero + w.x, zero + z * w.y, zero + z * w.z};
    const fl_simd u[3] = {zero + (v.x + c * (z * w.y)), zero + (z * v.y - c * w.x), zero + z * v.z};
    moments m;
    sum_pieces(&m, row, flow, at->pieces, skin, form, u, turn);
    fl_simd *const vv[3] = {ROW(sum, 0), ROW(sum, 1), ROW(sum, 2)};
    fl_simd *const wv[3] = {ROW(sum, 3), ROW(sum, 4), ROW(sum, 5)};
    fl_simd *const ww[3] = {wv[0] + 3, wv[1] + 3, wv[2] + 3};
    const fl_simd cs = c * m.s, ccs = c * cs, zcs = z * cs;
    vv[0][0] += m.s, vv[1][1] += m.s, vv[2][2] += m.f;
    wv[0][1] -= zcs, wv[0][2] += z * m.fy, wv[1][0] += zcs, wv[1][2] -= m.fx;
    wv[2][0] -= z * m.sy, wv[2][1] += m.sx;
    ww[0][0] += ccs + m.fyy, ww[1][0] -= z * m.fxy, ww[1][1] += ccs + m.fxx;
    ww[2][0] -= z * c * m.sx, ww[2][1] -= c * m.sy, ww[2][2] += m.srr;
    if (!flow) return;
    sum[0] += m.se, sum[1] += z * m.sg, sum[2] += z * m.fn;
    sum[3] += m.fny - c * m.sg, sum[4] += z * (c * m.se - m.fnx), sum[5] += z * m.turn;
}

/* Where the sums along the axes k + 1, k + 2 and k are stored, in doubles from the first one; the last is no
 * sum. */
static_assert(FL_BODY_BATCH == 16, "position_of[] counts in rows of 16");
static const uint16_t position_of[3][FL_DRAG_SUMS + 1] = {
    {16,  32,  0,   64,  80,  48,  128, 160, 176, 112, 144, 96,  272, 288,
     256, 320, 352, 368, 336, 400, 416, 208, 224, 192, 304, 384, 240, 432},
    {32,  0,   16,  80,  48,  64,  176, 144, 96,  160, 112, 128, 368, 336,
     352, 416, 224, 192, 208, 384, 240, 288, 256, 272, 400, 304, 320, 432},
    {0,   16,  32,  48,  64,  80,  96,  112, 128, 144, 160, 176, 192, 208,
     224, 240, 256, 272, 288, 304, 320, 336, 352, 368, 384, 400, 416, 432}};

/* Reduces four sums of four lanes and stores them at n positions of a body. */
FL_SIMD_INLINE void store_four(fl_facet_drag_batch *to, int32_t i, fl_simd *sum, const uint16_t *place, int n)
{
    fl_simd_transpose(sum);
    const fl_simd all = (sum[0] + sum[2]) + (sum[1] + sum[3]);
    FL_SIMD_UNROLL for (int l = 0; l < n; l++)(&to->sum[0][i])[place[l]] = all[l];
}

FL_SIMD_INLINE void store_sums(fl_facet_drag_batch *to, int32_t i, fl_simd *sum, const uint16_t *place,
                               int flows)
{
    FL_SIMD_UNROLL for (int c = 0; c < FL_DRAG_MATRIX && !flows; c++) to->sum[c][i] = 0.0;
    if (flows) store_four(to, i, sum, place, 4);
    FL_SIMD_UNROLL for (int c = 4; c + 4 <= FL_DRAG_SUMS; c += 4) store_four(to, i, sum + c, place + c, 4);
    store_four(to, i, sum + FL_DRAG_SUMS - 3, place + FL_DRAG_SUMS - 3, 3);
}

FL_SIMD_INLINE void add_facets(fl_facet_drag_batch *to, int32_t i, const fl_facet_cut *s, double skin,
                               double form, int flows)
{
    const fl_vec3 v = FL_BODY_BATCH_VEC(to->y, i), w = FL_BODY_BATCH_VEC(to->y + 3, i);
    fl_simd sum[FL_DRAG_SUMS + 1] = {{0.0}};
    int32_t row = 0;
    for (int32_t k = 0; k < s->groups; row += s->group[k++].pieces)
        add_group(&s->group[k], &s->piece[row], flows ? &s->flow[row] : NULL, skin, form, v, w, sum);
    store_sums(to, i, sum, position_of[2], flows);
}

/* Adds a prism along a body axis. */
FL_SIMD_INLINE void add_prism(fl_facet_drag_batch *to, int32_t i, const fl_facet_cut *s, double skin,
                              double form, int flows)
{
    const int32_t k3 = s->cap_axis, k1 = k3 < 2 ? k3 + 1 : 0, k2 = k1 < 2 ? k1 + 1 : 0;
    double(*y)[FL_BODY_BATCH] = to->y;
    const fl_vec3 v = v3(y[k1][i], y[k2][i], y[k3][i]), w = v3(y[3 + k1][i], y[3 + k2][i], y[3 + k3][i]);
    const fl_facet_group *at = s->group, *const cap = at + s->groups - 1;
    fl_simd sum[FL_DRAG_SUMS + 1] = {{0.0}};
    int32_t row = 0;
    for (; at < cap; row += at++->pieces) {
        const fl_simd a = FL_SIMD_LOAD(at->n[k1]), b = FL_SIMD_LOAD(at->n[k2]);
        add_prism_sides(&a, &b, at, &s->piece[row], flows ? &s->flow[row] : NULL, skin, form, v, w, sum);
    }
    add_prism_cap(at->n[k3][0], at, &s->piece[row], flows ? &s->flow[row] : NULL, skin, form, v, w, sum);
    store_sums(to, i, sum, position_of[k3], flows);
}

FL_SIMD4_VERSIONS static void sum_facets_still(fl_facet_drag_batch *to, int32_t i, const fl_facet_cut *s,
                                               double skin, double form)
{
    add_facets(to, i, s, skin, form, 0);
}

FL_SIMD4_VERSIONS static void sum_facets_flowing(fl_facet_drag_batch *to, int32_t i, const fl_facet_cut *s,
                                                 double skin, double form)
{
    add_facets(to, i, s, skin, form, 1);
}

FL_SIMD4_VERSIONS static void sum_prism_still(fl_facet_drag_batch *to, int32_t i, const fl_facet_cut *s,
                                              double skin, double form)
{
    add_prism(to, i, s, skin, form, 0);
}

FL_SIMD4_VERSIONS static void sum_prism_flowing(fl_facet_drag_batch *to, int32_t i, const fl_facet_cut *s,
                                                double skin, double form)
{
    add_prism(to, i, s, skin, form, 1);
}

void fl_facet_drag_sum(fl_facet_drag_batch *a, int32_t i, const fl_facet_cut *s, fl_facet_drag_law law,
                       double h)
{
    const double skin = h * law.skin, form = h * law.form;
    if (s->cap_axis < 0) (s->flow ? sum_facets_flowing : sum_facets_still)(a, i, s, skin, form);
    else (s->flow ? sum_prism_flowing : sum_prism_still)(a, i, s, skin, form);
}

/* Solves (M + h K) y' = M y + ... of four bodies by L d L^T. The pivots are at least M but for rounding,
 * which counts where h K is 1e16 times M. */
FL_SIMD_INLINE void solve_four_bodies(fl_facet_drag_batch *of, int32_t at)
{
    fl_simd l[6][6], x[6], per[6];
    double(*row)[FL_BODY_BATCH] = of->sum + FL_DRAG_MATRIX;
    FL_SIMD_UNROLL for (int i = 0; i < 6; row += ++i)
    {
        const fl_simd M = FL_SIMD_LOAD(&of->mass[i][at]);
        fl_simd scaled[6], d = FL_SIMD_LOAD(&row[i][at]) + M; /* scaled: l d */
        x[i] = M * FL_SIMD_LOAD(&of->y[i][at]) + FL_SIMD_LOAD(&of->sum[i][at]);
        FL_SIMD_UNROLL for (int j = 0; j < i; j++)
        {
            scaled[j] = FL_SIMD_LOAD(&row[j][at]);
            FL_SIMD_UNROLL for (int k = 0; k < j; k++) scaled[j] -= scaled[k] * l[j][k];
            l[i][j] = scaled[j] * per[j];
            d -= scaled[j] * l[i][j];
            x[i] -= l[i][j] * x[j];
        }
        per[i] = 1.0 / FL_SIMD_MAX(d, M);
    }
    FL_SIMD_UNROLL for (int i = 5; i >= 0; i--)
    {
        x[i] *= per[i];
        FL_SIMD_UNROLL for (int k = i + 1; k < 6; k++) x[i] -= l[k][i] * x[k];
        FL_SIMD_STORE(&of->y[i][at]) = x[i];
    }
}

FL_SIMD4_VERSIONS void fl_facet_drag_step(fl_facet_drag_batch *a, int32_t lanes)
{
    for (int32_t k = 0; k < lanes; k += FL_SIMD_WIDTH) solve_four_bodies(a, k);
}

void fl_facet_drag(const fl_facet_cut *s, fl_facet_drag_law law, fl_vec3 mass, fl_vec3 inertia, double h,
                   fl_vec3 *v, fl_vec3 *w)
{
    fl_facet_drag_batch a;
    for (int32_t i = 0; i < FL_SIMD_WIDTH; i++) {
        fl_body_batch_set_vec(a.mass, i, mass), fl_body_batch_set_vec(a.mass + 3, i, inertia);
        fl_body_batch_set_vec(a.y, i, *v), fl_body_batch_set_vec(a.y + 3, i, *w);
    }
    fl_facet_drag_sum(&a, 0, s, law, h);
    for (int c = 0; c < FL_DRAG_SUMS; c++)
        for (int32_t i = 1; i < FL_SIMD_WIDTH; i++) a.sum[c][i] = a.sum[c][0];
    fl_facet_drag_step(&a, FL_SIMD_WIDTH);
    *v = FL_BODY_BATCH_VEC(a.y, 0), *w = FL_BODY_BATCH_VEC(a.y + 3, 0);
}
