/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/simd.h"
#include "patch/no_tension.h"
#include "patch/surrogate.h"

#define FIRST 0.3   /* reach of a contact that is new, over the root of the tolerance; */
#define SHORTER 0.2 /* by how much one look changes it */
#define LONGER 3.0
#define SAFE 0.15    /* so much of the tolerance is aimed at, */
#define RETURN 0.5   /* so much of it is given back with, at the most, */
#define ENDED 0.3    /* of the reach: shorter ways tell nothing of what will come, */
#define BEYOND 10.0  /* and so much tells of something new: what was learnt is forgotten */
#define NEAR 1e-5    /* of the overlap: looks that are nearer to one another tell rounding; */
#define FAR 50.0     /* and where one has so many times the energy of another neither tells of it */
#define STRAIGHT 0.9 /* cosine between two ways that are one line, */
#define EVEN 0.1     /* of which neither is shorter than that part of the other */
#define WIDER 2.0    /* the length grows with the contact by such steps */
#define SWEEP 0.03   /* of the radii: so near what does not press may come */
#define LEAST 1e-9   /* of the pressures: what is held back less is rounding */
#define NET 0.5      /* less than this of the pressures left as force: they oppose each other */

static const fl_vec3 NONE = {0, 0, 0};

static fl_vec3 low(const fl_vec6 a) { return v3(a[0], a[1], a[2]); }
static fl_vec3 high(const fl_vec6 a) { return v3(a[3], a[4], a[5]); }

static void put(fl_vec6 a, fl_vec3 l, fl_vec3 h)
{
    a[0] = l.x, a[1] = l.y, a[2] = l.z;
    a[3] = h.x, a[4] = h.y, a[5] = h.z;
    a[6] = a[7] = 0.0;
}

static double dot(const fl_vec6 a, const fl_vec6 b)
{
    double sum = 0.0;
    for (int k = 0; k < 6; k++) sum += a[k] * b[k];
    return sum;
}

/* out = more + A x of a symmetric matrix. */
FL_SIMD_INLINE void product(fl_vec6 out, const fl_vec6 *A, const fl_vec6 x, const fl_vec6 more)
{
    fl_simd a = FL_SIMD_LOAD(more), b = FL_SIMD_LOAD(more + 4);
    FL_SIMD_UNROLL
    for (int k = 0; k < 6; k++) {
        a += x[k] * FL_SIMD_LOAD(&A[k][0]);
        b += x[k] * FL_SIMD_LOAD(&A[k][4]);
    }
    FL_SIMD_STORE(out) = a;
    FL_SIMD_STORE(out + 4) = b;
}

/* A += s (x y^T + y x^T) */
FL_SIMD4_VERSIONS static void add(fl_vec6 *A, double s, const fl_vec6 x, const fl_vec6 y)
{
    const fl_simd x0 = FL_SIMD_LOAD(x), x4 = FL_SIMD_LOAD(x + 4), y0 = FL_SIMD_LOAD(y),
                  y4 = FL_SIMD_LOAD(y + 4);
    FL_SIMD_UNROLL
    for (int r = 0; r < 6; r++) {
        FL_SIMD_STORE(&A[r][0]) += s * (x[r] * y0 + y[r] * x0);
        FL_SIMD_STORE(&A[r][4]) += s * (x[r] * y4 + y[r] * x4);
    }
}

/* z^(p - 2), the powers being quarters. */
static inline double root_of(double z, double power)
{
    const double root = sqrt(z);
    return power == 2.0 ? 1.0 : power == 2.25 ? sqrt(root) : root;
}

fl_surrogate_count fl_surrogate_count_sum(const fl_surrogate_count *count, int32_t threads)
{
    fl_surrogate_count all = {0};
    for (int32_t k = 0; k < threads; k++) {
        all.hits += count[k].hits, all.checks += count[k].checks, all.misses += count[k].misses;
        all.worst_error = count[k].worst_error > all.worst_error ? count[k].worst_error : all.worst_error;
    }
    return all;
}

/* --- what they tell ---------------------------------------------------------------------------- */

_Static_assert(FL_SURROGATE_ROWS % FL_SIMD_WIDTH == 0 && FL_SURROGATE_BATCH % FL_SIMD_WIDTH == 0,
               "taken by four");

_Static_assert(offsetof(fl_surrogate, learnt) % sizeof(double) ==
                       offsetof(fl_surrogate, g) % sizeof(double) &&
                   sizeof(fl_surrogate) >= offsetof(fl_surrogate, g) + FL_SURROGATE_ROWS * sizeof(double),
               "nothing but doubles in between, and as many");

FL_SIMD4_VERSIONS void fl_surrogate_pack(fl_surrogate_lanes *b, const fl_surrogate *const *s, int n)
{
    const double *of[FL_SURROGATE_BATCH];
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) of[k] = fl_lane_column(&s[k < n ? k : 0]->g);
    fl_lanes_load(b->s, of, FL_SURROGATE_ROWS);
}

#define OF(member) (b->s + FL_SURROGATE_ROW(member))

/* How A has moved since the look: q, and the turns' J^T. */
FL_SIMD_VERSIONS static void go(fl_surrogate_lanes *restrict b, fl_lane *restrict J)
{
    const fl_lane *M = OF(M);
#pragma omp simd
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) {
        const fl_vec3 x = fl_lane3(b->M, k), y = fl_lane3(b->M + 3, k), z = fl_lane3(b->M + 6, k);
        const fl_vec3 X = fl_lane3(M, k), Y = fl_lane3(M + 3, k), Z = fl_lane3(M + 6, k);
        const double xx = v3_dot(x, X), xy = v3_dot(x, Y), xz = v3_dot(x, Z);
        const double yx = v3_dot(y, X), yy = v3_dot(y, Y), yz = v3_dot(y, Z);
        const double zx = v3_dot(z, X), zy = v3_dot(z, Y), zz = v3_dot(z, Z);
        const double arm = OF(length)->a[k], half = 0.5 * (xx + yy + zz);
        const fl_vec3 own = fl_lane3(OF(point_a), k),
                      w = v3(0.5 * (zy - yz), 0.5 * (xz - zx), 0.5 * (yx - xy));
        const fl_vec3 at = v3_add(fl_lane3(b->o, k), v3(v3_dot(x, own), v3_dot(y, own), v3_dot(z, own)));
        const fl_vec3 by = v3_sub(at, fl_lane3(OF(point), k));
        const double slides = OF(in_plane)->a[k];
        const fl_vec3 u = v3(slides * by.x, slides * by.y, by.z);
        fl_lane3_set(b->point, k, at);
        fl_lane3_set(b->w, k, w);
        fl_lane3_set(b->q, k, u);
        fl_lane3_set(b->q + 3, k, v3_scale(arm, w));
        b->turn.a[k] = arm * v3_norm(w);
        b->path.a[k] = v3_norm(u) + FL_SURROGATE_TURN_WEIGHT * b->turn.a[k];
        fl_lane3_set(J, k, v3(half - 0.5 * xx, -0.5 * yx, -0.5 * zx));
        fl_lane3_set(J + 3, k, v3(-0.5 * xy, half - 0.5 * yy, -0.5 * zy));
        fl_lane3_set(J + 6, k, v3(-0.5 * xz, -0.5 * yz, half - 0.5 * zz));
    }
}

FL_SIMD_VERSIONS static void rise(fl_surrogate_lanes *restrict b)
{
    for (int r = 0; r < 6; r++) {
        const fl_lane *g = OF(g) + r, *H[6];
        for (int c = 0; c < 6; c++) H[c] = OF(H) + FL_UPPER[r][c];
#pragma omp simd
        for (int k = 0; k < FL_SURROGATE_BATCH; k++)
            b->slope_z[r].a[k] =
                g->a[k] +
                ((H[0]->a[k] * b->q[0].a[k] + H[1]->a[k] * b->q[1].a[k] + H[2]->a[k] * b->q[2].a[k]) +
                 (H[3]->a[k] * b->q[3].a[k] + H[4]->a[k] * b->q[4].a[k] + H[5]->a[k] * b->q[5].a[k]));
    }
}

FL_SIMD_INLINE double dot_of(const fl_lane *a, const fl_lane *b, int k)
{
    return v3_dot(fl_lane3(a, k), fl_lane3(b, k)) + v3_dot(fl_lane3(a + 3, k), fl_lane3(b + 3, k));
}

/* What dF/ds is more by than F^2/W tells. */
FL_SIMD_INLINE double steeper(double c, double s)
{
    const double by = 1.0 + c * s;
    return by > 0.5 ? by : 0.5;
}

FL_SIMD_VERSIONS static void pull(fl_surrogate_lanes *restrict b, const fl_lane *restrict J)
{
    const fl_lane *e = OF(path), *t = OF(third_order);
#pragma omp simd
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) {
        const fl_vec3 u = fl_lane3(b->q, k), w = fl_lane3(b->q + 3, k);
        fl_vec3 by = fl_lane3(b->slope_z, k), turn = fl_lane3(b->slope_z + 3, k);
        const double straight =
            1.0 + 0.5 * ((v3_dot(fl_lane3(OF(g), k), u) + v3_dot(fl_lane3(OF(g) + 3, k), w)) +
                         (v3_dot(by, u) + v3_dot(turn, w)));
        /* the third order: s^2/2 (t.q) - s^3/3 (e.t), s = e.q */
        const double s = dot_of(e, b->q, k), et = dot_of(e, t, k), tq = dot_of(t, b->q, k),
                     half = 0.5 * s * s, es = s * (tq - et * s),
                     z = straight + half * tq - (2.0 / 3.0) * half * s * et;
        by = v3_madd(v3_madd(by, es, fl_lane3(e, k)), half, fl_lane3(t, k));
        turn = v3_madd(v3_madd(turn, es, fl_lane3(e + 3, k)), half, fl_lane3(t + 3, k));
        fl_lane3_set(b->slope_z, k, by);
        fl_lane3_set(b->slope_z + 3, k, turn);
        const double p = OF(power)->a[k], W = OF(energy)->a[k], root = root_of(z, p),
                     each = -p * W * z * root;
        const double energy = W * z * z * root;
        const fl_vec3 f = v3_scale(each, by), g = v3_scale(each * OF(length)->a[k], turn);
        const double share = v3_norm(f) / OF(force)->a[k];
        b->z.a[k] = z;
        b->energy.a[k] = energy;
        b->force_ratio.a[k] = share;
        b->slope.a[k] = OF(slope)->a[k] * steeper(OF(slope_trend)->a[k], s) * share * share * W / energy;
        fl_lane3_set(b->f, k, f);
        fl_lane3_set(
            b->m, k,
            v3(v3_dot(fl_lane3(J, k), g), v3_dot(fl_lane3(J + 3, k), g), v3_dot(fl_lane3(J + 6, k), g)));
    }
}

void fl_surrogate_evaluate(fl_surrogate_lanes *b)
{
    _Alignas(64) fl_lane J[9]; /* of a turn the moment is -J^T of its slope, row by row */
    go(b, J);
    rise(b);
    pull(b, J);
}

fl_surrogate_value fl_surrogate_unpack(const fl_surrogate_lanes *b, int k)
{
    fl_surrogate_value t = {.path = b->path.a[k],
                            .turn = b->turn.a[k],
                            .z = b->z.a[k],
                            .point = fl_lane3(b->point, k),
                            .w = fl_lane3(b->w, k),
                            .gradient = {fl_lane3(b->f, k), fl_lane3(b->m, k)},
                            .energy = b->energy.a[k],
                            .force_ratio = b->force_ratio.a[k],
                            .slope = b->slope.a[k]};
    for (int r = 0; r < 6; r++) t.q[r] = b->q[r].a[k], t.slope_z[r] = b->slope_z[r].a[k];
    return t;
}

static fl_wrench moved(const fl_wrench *a, fl_vec3 from)
{
    return (fl_wrench){a->f, v3_add(a->m, v3_cross(from, a->f))};
}

/* --- looks ------------------------------------------------------------------------------------- */

/* Sums of springs about one point, about another that it is `a` away from, turns times `arm`: t = r x n + a x
 * n = r x n + A n. */
static void about(fl_vec6 *out, const fl_spring_sums *s, double scale, fl_vec3 a, double arm)
{
    const double A[3][3] = {{0, -a.z, a.y}, {a.z, 0, -a.x}, {-a.y, a.x, 0}};
    double X[3][3]; /* sum of k t n^T */
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            X[r][c] = s->coupling[r][c];
            for (int k = 0; k < 3; k++) X[r][c] += A[r][k] * s->linear[k][c];
        }
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            double t = s->angular[r][c];
            for (int k = 0; k < 3; k++) t += A[r][k] * s->coupling[c][k] + X[r][k] * A[c][k];
            out[r][c] = scale * s->linear[r][c];
            out[3 + r][c] = out[c][3 + r] = scale / arm * X[r][c];
            out[3 + r][3 + c] = scale / (arm * arm) * t;
        }
    for (int r = 0; r < 6; r++) out[r][6] = out[r][7] = 0.0;
}

/* z of which the p-th power is that, by Newton's steps; 0 where it is too far from 1. */
static double depth(double p, double want)
{
    double z = want < 1.0 ? 0.5 * (1.0 + want) : want < 4.0 ? 1.0 + 0.4 * (want - 1.0) : sqrt(want);
    if (!(want > 1.0 / FAR && want < FAR)) return 0.0;
    for (int k = 0; k < 6; k++) {
        const double slope = z * root_of(z, p);
        z -= (z * slope - want) / (p * slope);
    }
    return z;
}

/* The slope in other coordinates, A being turned by w in these: J^-T to the first order. */
static void turned(fl_vec6 out, const fl_vec6 slope, fl_vec3 w)
{
    put(out, low(slope), v3_madd(high(slope), -0.5, v3_cross(w, high(slope))));
}

/* Is the third order of a way known? */
static int foresees(const fl_surrogate *s)
{
    double sum = 0.0;
    for (int k = 0; k < 6; k++) sum += s->path[k] * s->path[k];
    return sum > 0.0;
}

/* How much longer a way may be of which the error is that part of what it might be.  The error goes as the
 * third power of the way where the third order is known, as the second where it is not: the third root by
 * square ones, nearly. */
static double longer_by(const fl_surrogate *s, double part)
{
    const double root = sqrt(part);
    return foresees(s) ? sqrt(root * sqrt(root)) : root;
}

/* e.q */
static double gone(const fl_surrogate *s, const fl_surrogate_value *t)
{
    double sum = 0.0;
    for (int k = 0; k < 6; k++) sum += s->path[k] * t->q[k];
    return sum;
}

/* By how much s was off, and how far it may go from now on.  slope: now, about the same point. */
static double compare(fl_surrogate *s, const fl_surrogate_value *t, fl_surrogate_record *last,
                      const fl_vec6 slope, double force, double toward, double tolerance)
{
    const double most = toward * (force > s->force ? force : s->force), pull = s->power * t->energy / t->z;
    const double back = 2.0 * s->defect_return * gone(s, t); /* is no error */
    fl_vec6 far;
    turned(far, slope, t->w);
    for (int k = 0; k < 6; k++) far[k] -= pull * (t->slope_z[k] - back * s->path[k]);
    const double off = t->z > 0.0 ? sqrt(dot(far, far)) / most : 1.0,
                 past = t->path / (s->reach * s->overlap);
    double longer = off > 0.0 ? longer_by(s, SAFE * tolerance / off) * past : LONGER;
    if (off > BEYOND * tolerance) {
        memset(s->learnt, 0, sizeof s->learnt);
        /* unless it has only gone far past what it might, the looks that were are those of another contact */
        if (off > BEYOND * tolerance * (past > 1.0 ? past * past : 1.0))
            last->energy = s->previous.energy = 0.0;
    }
    longer = longer > LONGER ? LONGER : longer < SHORTER ? SHORTER : longer;
    s->reach = longer * s->reach < FL_SURROGATE_MAX_REACH ? longer * s->reach : FL_SURROGATE_MAX_REACH;
    return off;
}

/* Slope of z at a look that was, A standing to now as w has it.  0 where W was too different. */
static int rise_at(const fl_surrogate *s, const fl_surrogate_record *b, fl_vec3 w, fl_vec6 out)
{
    const double z = depth(s->power, b->energy / s->energy), each = z / (s->power * b->energy);
    fl_vec6 slope;
    turned(slope, b->slope, w);
    for (int k = 0; k < 8; k++) out[k] = each * slope[k];
    return z > 0.0;
}

/* What between two looks bent the slope of z by more than H, over the way from the one to the other. */
FL_SIMD4_VERSIONS static double bent(fl_vec6 *H, const fl_vec6 from, const fl_vec6 to, const fl_vec6 way,
                                     fl_vec6 e, fl_vec6 r)
{
    const double h = sqrt(dot(way, way)), each = h > 0.0 ? 1.0 / h : 0.0;
    fl_vec6 by;
    for (int k = 0; k < 8; k++) e[k] = each * way[k];
    product(by, (const fl_vec6 *)H, e, (fl_vec6){0});
    for (int k = 0; k < 8; k++) r[k] = each * (to[k] - from[k]) - by[k];
    return h;
}

/* A += the smallest symmetric matrix that takes e, a unit vector, to r. */
static void teach(fl_vec6 *A, double each, const fl_vec6 r, const fl_vec6 e)
{
    add(A, each, r, e);
    add(A, -0.5 * each * dot(r, e), e, e);
}

/* A += each B */
static void with(fl_vec6 *A, double each, const fl_vec6 *B)
{
    for (int r = 0; r < 6; r++)
        for (int k = 0; k < 8; k++) A[r][k] += each * B[r][k];
}

/* What the last two looks tell of H, which is that of the springs and so much of what is learnt, and of what
 * comes after it. */
static void learn(fl_surrogate *s, fl_vec6 *springs, const fl_vec6 g, const fl_surrogate_record *last,
                  double much)
{
    const fl_surrogate_record *first = &s->previous;
    const fl_vec3 w = v3_scale(-1.0 / s->length, high(last->path)),
                  ww = v3_madd(w, -1.0 / s->length, high(first->path));
    fl_vec6 H[6], g1, g0, e, d, r, rd;
    if (!rise_at(s, last, w, g1)) return;
    memcpy(H, springs, sizeof H);
    with(H, much, (const fl_vec6 *)s->learnt);
    const double h = bent(H, g1, g, last->path, e, r);
    if (!(h > NEAR * s->overlap)) return;
    if (first->energy > 0.0 && rise_at(s, first, ww, g0)) {
        const double hd = bent(H, g0, g1, first->path, d, rd);
        if (dot(e, d) > STRAIGHT && hd > EVEN * h && h > EVEN * hd) {
            const double each = 2.0 / (h + hd);
            for (int k = 0; k < 6; k++) {
                s->third_order[k] = each * (r[k] - rd[k]), s->path[k] = e[k];
                r[k] += 0.5 * h * s->third_order[k];
            }
        }
    }
    teach(s->learnt, 1.0 / much, r, e);
}

/* A contact that is new: the point is the centre of what presses, and stays with A from now on.  Where bodies
 * part so fast that damping takes all of the pressures there are these as well. */
static void begin(fl_surrogate *s, const fl_exact_contact *seen, const fl_pressure_moments *q,
                  double tolerance)
{
    const fl_vec3 centre = v3_add(seen->points->point[0].p, q->centre);
    *s = (fl_surrogate){.reach = FIRST * sqrt(tolerance)};
    s->max_change = fl_surrogate_max_change(tolerance);
    s->length = q->radius > seen->radii ? q->radius : seen->radii;
    s->point_a = m3_tmul(*seen->M, v3_sub(centre, seen->o));
}

/* A contact that began at a corner may be one of faces now. */
static void widen(fl_surrogate *s, fl_surrogate_record *last, double spread)
{
    const double part = s->length / spread;
    if (!(spread > WIDER * s->length)) return;
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 6; c++) s->learnt[r][c] *= (r < 3 ? 1.0 : part) * (c < 3 ? 1.0 : part);
    for (int k = 3; k < 6; k++) {
        s->previous.slope[k] *= part, s->previous.path[k] /= part;
        last->slope[k] *= part, last->path[k] /= part;
    }
    s->length = spread;
}

/* H and p of the springs, of what was learnt, and of the slope of W.  last: the look before, to learn from,
 * or NULL. */
FL_SIMD4_VERSIONS static void bend(fl_surrogate *s, const fl_exact_contact *seen, const fl_vec6 slope,
                                   fl_vec3 from, const fl_surrogate_record *last)
{
    const double W = seen->energy, force = s->force;
    fl_vec6 H[6], g = {0};
    about(H, seen->springs, seen->scale, from, s->length);
    add(H, -0.5 / W, slope, slope); /* the root in W bends down, as in survey_patch() */
    fl_vec6 push, stiff;
    put(push, v3_scale(1.0 / force, low(slope)), NONE);
    product(stiff, (const fl_vec6 *)H, push, (fl_vec6){0});
    const double curve = W * dot(push, stiff) / (force * force);
    s->power = curve < 1.0 - 1.0 / 2.125 ? 2.0 : curve < 1.0 - 1.0 / 2.375 ? 2.25 : 2.5;
    const double p = s->power, each = 1.0 / (p * W);
    for (int r = 0; r < 6; r++) {
        s->g[r] = g[r] = each * slope[r];
        for (int l = 0; l < 6; l++) H[r][l] *= each;
    }
    add(H, -0.5 * (p - 1.0), g, g);
    if (last) {
        memset(s->path, 0, sizeof s->path), memset(s->third_order, 0, sizeof s->third_order);
        if (last->energy > 0.0) learn(s, H, g, last, each * force);
        if (!foresees(s)) s->slope_trend = 0.0;
        s->previous = *last;
    }
    with(H, each * force, (const fl_vec6 *)s->learnt);
    for (int r = 0; r < 6; r++)
        for (int c = r; c < 6; c++) s->H[FL_UPPER[r][c]] = H[r][c];
}

/* Slope of W over (u, a w) about the point; its size is that of the force. */
static double slope_of(const fl_surrogate *s, const fl_exact_contact *seen, fl_vec6 slope)
{
    const fl_vec3 at = v3_add(seen->o, m3_mul(*seen->M, s->point_a));
    const fl_force_sum *q = seen->sums;
    const fl_wrench first = {v3_scale(seen->scale, q->gradient.f), v3_scale(seen->scale, q->gradient.m)};
    const fl_wrench wrench = moved(&first, v3_sub(seen->points->point[0].p, at));
    put(slope, v3_neg(wrench.f), v3_scale(-1.0 / s->length, wrench.m));
    return v3_norm(wrench.f);
}

/* Those sums times dW/dU. */
static void press(fl_surrogate *s, const fl_pressure_moments *q, double scale)
{
    const fl_vec3 acts = fl_surrogate_force_centre(q->direction, q->torque);
    s->pressure = scale * q->pressure;
    s->direction = v3_scale(scale, q->direction), s->torque = v3_scale(scale, q->torque);
    s->centre_offset = v3_sub(q->centre, acts);
    for (int k = 0; k < FL_PRESSURE_MATRIX; k++) s->damping[k] = scale * q->damping[k];
    s->radius = q->radius;
}

/* Rows of the upper triangle times x. */
static void times(fl_vec6 out, const double *A, const fl_vec6 x)
{
    for (int r = 0; r < 6; r++) {
        out[r] = 0.0;
        for (int c = 0; c < 6; c++) out[r] += A[FL_UPPER[r][c]] * x[c];
    }
}

/* What held pressures back from pulling, in the numbers that tell it of the mean and the variance. */
static void hold_back(fl_surrogate *s, const fl_exact_contact *seen, const fl_pressure_moments *of)
{
    const fl_force_sum *q = seen->sums;
    const double E = of->pressure, chi = seen->impact_damping;
    fl_vec6 V, still, moving, damped;
    s->half_width = FL_UNIFORM_HALF_WIDTH, s->skewness = 1.0;
    put(V, seen->v, seen->spin);
    put(still, of->direction, of->torque);
    put(damped, q->damping.f, q->damping.m);
    times(moving, of->damping, V);
    const double closing = -dot(still, V) / E, mean = 1.0 + chi * (closing + seen->speed_offset),
                 var = chi * chi * (dot(moving, V) / E - closing * closing),
                 p = q->damped_pressure / E - mean;
    for (int k = 0; k < 6; k++) moving[k] -= seen->speed_offset * still[k];
    if (!(var > LEAST)) return;
    if (!(p > LEAST && mean + p > LEAST)) { /* none or all of it: an even spread, but no wider than that */
        const double most = fabs(mean) / sqrt(var);
        if (s->half_width > most) s->half_width = most;
        return;
    }
    s->half_width = fl_no_tension_half_width(mean, p) / sqrt(var);
    const fl_no_tension even = fl_no_tension_of(mean, var, s->half_width * sqrt(var), 1.0);
    double more = 0.0, size2 = 0.0;
    for (int k = 0; k < 6; k++) {
        const double x = -chi * moving[k] - (mean - 1.0) * still[k],
                     g = damped[k] + chi * moving[k] - p * still[k],
                     by = k < 3 ? 1.0 : 1.0 / (s->length * s->length);
        more += by * x * g, size2 += by * x * x;
    }
    if (even.q < 0.0 && size2 > 0.0) s->skewness = more / size2 / even.q;
    if (!(s->skewness > 0.0)) s->skewness = 0.0;
}

/* How far A may go that no point of it moves by more than seen->room, and what does not press by no more than
 * a part of the radii as it turns.  As convex bodies slide no place is deeper than the straight line of the
 * overlap foretells; where walls lean over each other one may be, at once. */
static void bound(fl_surrogate *s, const fl_exact_contact *seen)
{
    const double farthest = v3_norm(v3_sub(s->point, s->o)) + seen->radius_a,
                 part = farthest > s->length ? s->length / farthest : 1.0;
    s->free_path = part * seen->free_path;
    s->free_turn = part * SWEEP * seen->radii;
}

static void fill(fl_surrogate *s, const fl_exact_contact *seen, const fl_pressure_moments *pressing,
                 const fl_surrogate_record *last)
{
    const fl_force_sum *q = seen->sums;
    fl_vec6 slope;
    s->valid = s->used = 0;
    s->force = slope_of(s, seen, slope);
    if (!(s->force > 0.0 && seen->slope > 0.0 && pressing->pressure > 0.0)) return;
    s->M = *seen->M, s->o = seen->o, s->point = v3_add(s->o, m3_mul(s->M, s->point_a));
    s->first_point = seen->points->point[0].p;
    s->in_plane = seen->b_is_plane ? 0.0 : 1.0;
    s->overlap = q->overlap, s->energy = seen->energy, s->slope = seen->slope, s->inv_mass = seen->inv_mass,
    s->compliance = seen->compliance, s->turn_compliance = seen->turn_compliance;
    bound(s, seen);
    bend(s, seen, slope, v3_sub(s->first_point, s->point), last);
    press(s, pressing, seen->scale);
    s->other_force = v3_sub(v3_scale(seen->scale, q->gradient.f), s->direction);
    s->centre = fl_surrogate_force_centre(q->gradient.f, q->gradient.m);
    s->valid = s->force > NET * s->pressure && v3_norm2(s->direction) > 0.0;
}

/* H gets b s^2. */
static void give_back(fl_surrogate *s)
{
    for (int r = 0; r < 6; r++)
        for (int c = r; c < 6; c++) s->H[FL_UPPER[r][c]] += 2.0 * s->defect_return * s->path[r] * s->path[c];
}

void fl_surrogate_set(fl_surrogate *s, const fl_exact_contact *seen)
{
    fl_pressure_moments pressing;
    fl_force_sum_pressure(seen->points, &pressing);
    fill(s, seen, &pressing, NULL);
    give_back(s);
}

/* How much dF/ds was told too low; */
static double too_low(const fl_surrogate *s, const fl_surrogate_value *t, double slope)
{
    const double more = steeper(s->slope_trend, gone(s, t)) * slope / t->slope - 1.0;
    return fabs(more) < 0.5 ? more : 0.0;
}

/* for the way, which is measured by the length that turns are taken times now. */
static void learn_slope(fl_surrogate *s, const fl_surrogate_record *last, double more)
{
    const double way = sqrt(dot(last->path, last->path));
    s->slope_trend = way > NEAR * s->overlap ? more / way : 0.0;
}

/* The look that was the last one until now, and the way since. */
static fl_surrogate_record look_of(const fl_surrogate *s, const fl_surrogate_value *t)
{
    fl_surrogate_record b = {.energy = s->energy};
    for (int k = 0; k < 6; k++) b.slope[k] = s->power * s->energy * s->g[k], b.path[k] = t->q[k];
    return b;
}

/* How much z was told too low at the end of a way, but for what was given back, over the fourth power of that
 * in overlaps: what is left out is of that order.  Short ways, which something else ended, tell nothing. */
static double ran_off(const fl_surrogate *s, const fl_surrogate_value *t, double energy)
{
    const double g = gone(s, t), way = t->path / s->overlap, w2 = way * way,
                 pull = s->power * t->energy / t->z;
    return foresees(s) && way > ENDED * s->reach && way > NEAR && t->z > 0.0
               ? ((energy - t->energy) / pull + s->defect_return * g * g) / (w2 * w2)
               : 0.0;
}

/* What is owed, over the way to come, and what will be by then, as the last way ran off; part: of the force,
 * at its end at most. */
static void owe(fl_surrogate *s, double runs, double part)
{
    const double pull = s->power * s->energy, way = s->reach * s->overlap, r2 = s->reach * s->reach,
                 b = (s->energy_defect / pull + runs * r2 * r2) / (way * way),
                 most = 0.5 * part * s->force / (pull * way);
    s->defect_return = !s->valid || !foresees(s) ? 0.0 : b > most ? most : b < -most ? -most : b;
}

double fl_surrogate_update(fl_surrogate *s, const fl_surrogate_value *t, const fl_exact_contact *seen,
                           double tolerance)
{
    fl_vec6 slope;
    fl_surrogate_record last = {0};
    fl_pressure_moments pressing;
    double off = 0.0, runs = 0.0;
    fl_force_sum_pressure(seen->points, &pressing);
    if (t) {
        const double force = slope_of(s, seen, slope);
        last = look_of(s, t);
        if (s->used && t->z > 0.0) s->energy_defect += seen->energy - t->energy;
        runs = ran_off(s, t, seen->energy);
        if (force > 0.0) off = compare(s, t, &last, slope, force, seen->motion_force, tolerance);
        const double more = too_low(s, t, seen->slope);
        widen(s, &last, pressing.radius);
        learn_slope(s, &last, more);
    } else {
        begin(s, seen, &pressing, tolerance);
    }
    fill(s, seen, &pressing, &last);
    if (s->valid) hold_back(s, seen, &pressing);
    owe(s, runs, RETURN * tolerance);
    give_back(s);
    if (s->valid && (seen->stiffness_i > 0.0 || seen->stiffness_j > 0.0))
        s->stiffness_i = seen->stiffness_i / s->slope, s->stiffness_j = seen->stiffness_j / s->slope;
    return off;
}
