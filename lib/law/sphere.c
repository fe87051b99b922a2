/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/wide.h"
#include "law/damping.h"
#include "law/sphere.h"
#include "law/tangent.h"

/* Registers are filled to the end: what stands behind the last contact is computed too, and not used. */
enum { FULL = 8 };
static int32_t filled(int32_t m) { return (m + FULL - 1) / FULL * FULL; }

/* No branches, so that the compiler puts several contacts side by side. */
#define SIDE_BY_SIDE _Pragma("omp simd")

FL_WIDE_VERSIONS static void stand(fl_spheres *restrict b, int32_t m)
{
    SIDE_BY_SIDE for (int32_t c = 0; c < m; c++)
    {
        const double x = b->d[0][c], y = b->d[1][c], z = b->d[2][c];
        const double d = sqrt(x * x + y * y + z * z), one = d > 0.0 ? 1.0 / d : 0.0;
        const double s = b->ri[c] + b->rj[c] - d, root = sqrt(s > 0.0 ? s : 0.0);
        b->n[0][c] = one * x;
        b->n[1][c] = one * y;
        b->n[2][c] = d > 0.0 ? one * z : 1.0;
        b->overlap[c] = s;
        b->elastic[c] = b->k[c] * (s * root);
        b->slope[c] = b->k[c] * (1.5 * root);
    }
}

/* How the surfaces go by each other across n where centres do by u; turn: a_i w_i + a_j w_j. */
FL_WIDE_PART fl_vec3 sliding(fl_vec3 u, fl_vec3 turn, fl_vec3 n)
{
    const fl_vec3 s = v3_sub(u, v3_cross(turn, n));
    return v3_madd(s, -v3_dot(s, n), n);
}

#define VECTOR(a) v3(b->a[0][c], b->a[1][c], b->a[2][c])

FL_WIDE_VERSIONS static void press(fl_spheres *restrict b, int32_t m, double dt, double h, double begins)
{
    SIDE_BY_SIDE for (int32_t c = 0; c < m; c++)
    {
        const fl_vec3 n = VECTOR(n), u = VECTOR(u);
        const double s = b->overlap[c], elastic = b->elastic[c], last = b->touch[c];
        const double came = -v3_dot(n, u), closing = came - v3_dot(n, VECTOR(du));
        const double now = closing > last ? closing : last, touch = now > 0.0 ? now : 0.0;
        const double stored2 = 2.0 * (0.4 * s * elastic) * b->invm[c], touch2 = touch * touch;
        const double speed = sqrt(stored2 > touch2 ? stored2 : touch2);
        const double chi = speed > 0.0 ? b->chi[c] / speed : 0.0;
        const double from = s - dt * came, had = from > 0.0 ? from : 0.0;
        const double goes = fl_damping_closing(closing, chi * elastic, h * b->yields[c], b->many[c],
                                               elastic - b->k[c] * (had * sqrt(had)), b->damped[c], begins);
        const double damping = elastic * (chi * goes);
        b->touch[c] = touch;
        b->scale[c] = chi;
        b->damped[c] = damping > -elastic ? damping : -elastic;
    }
}

FL_WIDE_VERSIONS static void rub(fl_spheres *restrict b, int32_t m, double dt, double h, double begins)
{
    SIDE_BY_SIDE for (int32_t c = 0; c < m; c++)
    {
        const fl_vec3 n = VECTOR(n), u = VECTOR(u), wi = VECTOR(wi), wj = VECTOR(wj);
        const double ri = b->ri[c], rj = b->rj[c], half = 0.5 * b->overlap[c], ai = ri - half, aj = rj - half,
                     part = (ai + aj) / (ri + rj);
        const fl_vec3 v = sliding(u, v3_madd(v3_scale(ai, wi), aj, wj), n),
                      next = v3_add(v, sliding(VECTOR(du), v3_scale(part, VECTOR(rdw)), n));
        const double twist = dt * (0.5 * v3_dot(v3_add(wi, wj), n));
        /* the remembered force turns about n, lies down in the tangent plane, and falls with the stiffness */
        const fl_vec3 p = VECTOR(slip), t = v3_madd(p, twist, v3_cross(n, p)),
                      q = v3_madd(t, -v3_dot(t, n), n), r = v3_sub(VECTOR(rub), p),
                      was = v3_madd(r, -v3_dot(r, n), n);
        const fl_tangent_spring spring = {.k = b->tangential[c] * b->slope[c],
                                          .g = b->tangential[c] * (b->scale[c] * b->elastic[c]),
                                          .limit = b->friction[c] * (b->elastic[c] + b->damped[c]),
                                          .yields = b->across[c] + part * part * b->turns[c],
                                          .many = b->many[c]};
        const fl_held rubs = fl_tangent_point(p, q, b->stiff[c], spring, v, next, was, dt, h, begins);
        const fl_vec3 e = rubs.kept.f, all = rubs.all.f;
        const int on = spring.limit > 0.0 && b->tangential[c] > 0.0;
        b->slip[0][c] = on ? e.x : 0.0;
        b->slip[1][c] = on ? e.y : 0.0;
        b->slip[2][c] = on ? e.z : 0.0;
        b->stiff[c] = on ? spring.k : 0.0;
        b->rub[0][c] = on ? all.x : 0.0;
        b->rub[1][c] = on ? all.y : 0.0;
        b->rub[2][c] = on ? all.z : 0.0;
    }
}

FL_WIDE_VERSIONS static void tell(fl_spheres *restrict b, int32_t m)
{
    SIDE_BY_SIDE for (int32_t c = 0; c < m; c++)
    {
        const double nx = b->n[0][c], ny = b->n[1][c], nz = b->n[2][c];
        const double x = b->rub[0][c], y = b->rub[1][c], z = b->rub[2][c];
        const double tx = nz * y - ny * z, ty = nx * z - nz * x, tz = ny * x - nx * y; /* F_t x n */
        const double half = 0.5 * b->overlap[c], ai = b->ri[c] - half, aj = b->rj[c] - half;
        const double elastic = b->elastic[c], damping = b->damped[c], f = elastic + damping;
        b->push[0][c] = elastic * nx;
        b->push[1][c] = elastic * ny;
        b->push[2][c] = elastic * nz;
        b->damping[0][c] = damping * nx;
        b->damping[1][c] = damping * ny;
        b->damping[2][c] = damping * nz;
        b->ti[0][c] = ai * tx;
        b->ti[1][c] = ai * ty;
        b->ti[2][c] = ai * tz;
        b->tj[0][c] = aj * tx;
        b->tj[1][c] = aj * ty;
        b->tj[2][c] = aj * tz;
        b->size[c] = sqrt(f * f + (x * x + y * y + z * z));
    }
}

FL_WIDE_VERSIONS static void roll(const fl_spheres *restrict b, fl_spheres_rolls *restrict r, int32_t m,
                                  double dt, double h, double begins)
{
    SIDE_BY_SIDE for (int32_t c = 0; c < m; c++)
    {
        const fl_vec3 wi = VECTOR(wi), wj = VECTOR(wj);
        const double mu = r->rolling[c], part = fl_rolling_part(mu), arm = r->arm[c];
        const fl_tangent_spring spring = {.k = part * b->slope[c],
                                          .g = part * (b->scale[c] * b->elastic[c]),
                                          .limit = mu * (b->elastic[c] + b->damped[c]),
                                          .yields = r->yields[c],
                                          .many = b->many[c]};
        const fl_vec3 turns = v3_scale(arm, v3_sub(wi, wj));
        const fl_turning by = {turns, v3_madd(turns, arm, v3(r->dw[0][c], r->dw[1][c], r->dw[2][c])),
                               v3_scale(0.5, v3_add(wi, wj))};
        const fl_roll was = {v3(r->kept[0][c], r->kept[1][c], r->kept[2][c]), r->stiff[c],
                             v3(r->all[0][c], r->all[1][c], r->all[2][c]), arm};
        const fl_roll now = fl_rolling(was, spring, by, dt, h, begins);
        const int on = spring.limit > 0.0;
        r->kept[0][c] = on ? now.kept.x : 0.0;
        r->kept[1][c] = on ? now.kept.y : 0.0;
        r->kept[2][c] = on ? now.kept.z : 0.0;
        r->stiff[c] = on ? now.k : 0.0;
        r->all[0][c] = on ? now.all.x : 0.0;
        r->all[1][c] = on ? now.all.y : 0.0;
        r->all[2][c] = on ? now.all.z : 0.0;
    }
}

void fl_spheres_roll_on(fl_spheres *b, const fl_spheres_rolls *r, int32_t m)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int32_t c = 0; c < m; c++) {
            b->ti[axis][c] += r->arm[c] * r->all[axis][c];
            b->tj[axis][c] -= r->arm[c] * r->all[axis][c];
        }
    }
}

void fl_spheres_roll(fl_spheres *b, fl_spheres_rolls *r, int32_t m, double dt, double half)
{
    roll(b, r, filled(m), dt, half, dt > 0.0 ? 0.0 : 1.0);
    fl_spheres_roll_on(b, r, m);
}

void fl_spheres_meet(fl_spheres *b, int32_t m, double dt, double half)
{
    const int32_t full = filled(m);
    const double begins = dt > 0.0 ? 0.0 : 1.0;
    stand(b, full);
    press(b, full, dt, half, begins);
    rub(b, full, dt, half, begins);
    tell(b, full);
}

void fl_spheres_place(fl_spheres *b, int32_t m)
{
    const int32_t full = filled(m);
    stand(b, full);
    tell(b, full);
}
