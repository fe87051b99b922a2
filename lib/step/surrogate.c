/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/wide.h"
#include "step/surrogate.h"

#define FIRST 0.3   /* reach of a contact that is new, over the root of the tolerance; */
#define SHORTER 0.2 /* by how much one look changes it */
#define LONGER 3.0
#define SAFE 0.5
#define WITHIN 0.01 /* so much of the tolerance is too little to learn from, */
#define BEYOND 10.0 /* and so much tells of something new: what was learnt is forgotten */
#define WIDER 2.0   /* the length grows with the contact by such steps */
#define NET 0.5     /* less than this of the pressures left as force: they oppose each other */

static const fl_vec3 NONE = {0, 0, 0};

static fl_vec3 low(const fl_six a) { return v3(a[0], a[1], a[2]); }
static fl_vec3 high(const fl_six a) { return v3(a[3], a[4], a[5]); }

static void put(fl_six a, fl_vec3 l, fl_vec3 h)
{
    a[0] = l.x, a[1] = l.y, a[2] = l.z;
    a[3] = h.x, a[4] = h.y, a[5] = h.z;
    a[6] = a[7] = 0.0;
}

static double dot(const fl_six a, const fl_six b)
{
    double sum = 0.0;
    for (int k = 0; k < 6; k++) sum += a[k] * b[k];
    return sum;
}

/* out = more + A x of a symmetric matrix. */
FL_WIDE_PART void product(fl_six out, const fl_six *A, const fl_six x, const fl_six more)
{
    fl_wide a = FL_FOUR(more), b = FL_FOUR(more + 4);
    FL_WIDE_UNROLL
    for (int k = 0; k < 6; k++) {
        a += x[k] * FL_FOUR(&A[k][0]);
        b += x[k] * FL_FOUR(&A[k][4]);
    }
    FL_FOUR_INTO(out) = a;
    FL_FOUR_INTO(out + 4) = b;
}

/* A += s (x y^T + y x^T) */
static void add(fl_six *A, double s, const fl_six x, const fl_six y)
{
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 6; c++) A[r][c] += s * (x[r] * y[c] + y[r] * x[c]);
}

/* z^(p - 2), the powers being quarters. */
static double root_of(double z, int32_t quarter)
{
    return quarter == 0 ? 1.0 : quarter == 1 ? sqrt(sqrt(z)) : sqrt(z);
}

static double power_of(const fl_surrogate *s) { return 2.0 + 0.25 * s->quarter; }

fl_surrogate_count fl_surrogate_sum(const fl_surrogate_count *count, int32_t threads)
{
    fl_surrogate_count all = {0};
    for (int32_t k = 0; k < threads; k++) {
        all.told += count[k].told, all.looked += count[k].looked, all.off += count[k].off;
        all.worst = count[k].worst > all.worst ? count[k].worst : all.worst;
    }
    return all;
}

FL_FOUR_VERSIONS void fl_surrogate_tell(const fl_surrogate *s, const fl_mat3 *M, fl_vec3 o, fl_told *t)
{
    const fl_mat3 *N = &s->M;
    double D[3][3], trace;
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
            D[k][l] = M->m[k][0] * N->m[l][0] + M->m[k][1] * N->m[l][1] + M->m[k][2] * N->m[l][2];
    trace = D[0][0] + D[1][1] + D[2][2];
    t->at = v3_add(o, m3_mul(*M, s->own));
    t->w = v3(0.5 * (D[2][1] - D[1][2]), 0.5 * (D[0][2] - D[2][0]), 0.5 * (D[1][0] - D[0][1]));
    const fl_vec3 u = v3_sub(t->at, s->at);
    put(t->q, u, v3_scale(s->arm, t->w));
    t->way = v3_norm(u) + s->arm * v3_norm(t->w);
    product(t->rise, s->H, t->q, s->g);
    t->z = 1.0 + 0.5 * (dot(s->g, t->q) + dot(t->rise, t->q));
    const double root = root_of(t->z, s->quarter), pull = -power_of(s) * s->energy * t->z * root;
    t->energy = s->energy * t->z * t->z * root;
    const fl_vec3 g = v3_scale(pull * s->arm, high(t->rise));
    t->gradient.f = v3_scale(pull, low(t->rise));
    t->gradient.m = v3(0.5 * (trace * g.x - (D[0][0] * g.x + D[1][0] * g.y + D[2][0] * g.z)),
                       0.5 * (trace * g.y - (D[0][1] * g.x + D[1][1] * g.y + D[2][1] * g.z)),
                       0.5 * (trace * g.z - (D[0][2] * g.x + D[1][2] * g.y + D[2][2] * g.z)));
    t->share = v3_norm(t->gradient.f) / s->force;
    t->slope = s->slope * t->share * t->share * s->energy / t->energy;
}

static int within(const fl_surrogate *s, const fl_told *t, double reach)
{
    return t->way <= reach * s->overlap && t->z > 1.0 - s->less && t->z < 1.0 + s->less;
}

int fl_surrogate_holds(const fl_surrogate *s, const fl_told *t) { return within(s, t, s->reach); }
int fl_surrogate_nearly(const fl_surrogate *s, const fl_told *t) { return within(s, t, 2.0 * s->reach); }

static fl_wrench moved(const fl_wrench *a, fl_vec3 from)
{
    return (fl_wrench){a->f, v3_add(a->m, v3_cross(from, a->f))};
}

/* Where along the plane of the pressures a force acts, from the point that the wrench is about. */
static fl_vec3 centre(const fl_wrench *a) { return v3_scale(1.0 / v3_norm2(a->f), v3_cross(a->f, a->m)); }

int fl_surrogate_bear(const fl_surrogate *s, const fl_told *t, fl_vec3 v, fl_vec3 turn, double chi,
                      fl_bearing *q, double *scale)
{
    const fl_vec3 way = v3_add(low(t->q), v3_cross(t->w, v3_sub(s->first, s->at)));
    fl_vec3 at;
    fl_bearing_recall(&s->pads, way, t->w, v, turn, chi, q, &at);
    if (!(q->elastic > 0.0)) return 0;
    const double each = 1.0 / q->elastic;
    *scale = t->share * s->pressure * each;
    q->overlap = s->overlap * t->z;
    q->gradient = t->gradient;
    const fl_wrench told = moved(&t->gradient, v3_sub(t->at, s->first));
    if (!(*scale > 0.0)) return 0;
    if (q->normal < q->elastic) { /* damping must not leave what the force is off from the pressures by */
        const fl_vec3 pressed = v3_sub(q->direction, q->damping.f);
        const fl_vec3 beside = v3_madd(told.f, -t->share, s->beside);
        const fl_vec3 off = v3_sub(v3_scale(1.0 / *scale, beside), pressed);
        q->damping.f = v3_madd(q->damping.f, q->normal * each - 1.0, off);
    }
    /* the pressures move to where force and moment want them */
    const fl_vec3 by = v3_add(v3_madd(centre(&told), -each, at), s->off);
    q->spread += 2.0 * v3_dot(by, q->moment) + q->normal * v3_norm2(by);
    q->moment = v3_madd(q->moment, q->normal, by);
    q->damping.m = v3_add(q->damping.m, v3_cross(by, q->damping.f));
    return 1;
}

/* --- looks ------------------------------------------------------------------------------------- */

/* Sums of springs about one point, about another that it is `a` away from, turns times `arm`: t = r x n + a x
 * n = r x n + A n. */
static void about(fl_six *out, const fl_springs *s, double scale, fl_vec3 a, double arm)
{
    const double A[3][3] = {{0, -a.z, a.y}, {a.z, 0, -a.x}, {-a.y, a.x, 0}};
    double X[3][3]; /* sum of k t n^T */
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            X[r][c] = s->mixed[r][c];
            for (int k = 0; k < 3; k++) X[r][c] += A[r][k] * s->across[k][c];
        }
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            double t = s->turning[r][c];
            for (int k = 0; k < 3; k++) t += A[r][k] * s->mixed[c][k] + X[r][k] * A[c][k];
            out[r][c] = scale * s->across[r][c];
            out[3 + r][c] = out[c][3 + r] = scale / arm * X[r][c];
            out[3 + r][3 + c] = scale / (arm * arm) * t;
        }
    for (int r = 0; r < 6; r++) out[r][6] = out[r][7] = 0.0;
}

/* z of which the p-th power is W over that of the look, by Newton's steps. */
static double depth(const fl_surrogate *s, double W)
{
    const double p = power_of(s), want = W / s->energy;
    double z = want < 1.0 ? 0.5 * (1.0 + want) : want < 4.0 ? 1.0 + 0.4 * (want - 1.0) : sqrt(want);
    for (int k = 0; k < 4; k++) {
        const double slope = z * root_of(z, s->quarter);
        z -= (z * slope - want) / (p * slope);
        if (!(z > 0.0)) return 0.0;
    }
    return z;
}

/* The smallest symmetric change of H by which the slope of z would not have been r off after q. */
static void learn(fl_surrogate *s, const fl_six q, const fl_six r, double each)
{
    const double size = dot(q, q);
    if (!(size > 0.0)) return;
    add(s->learnt, each / size, r, q);
    add(s->learnt, -0.5 * each / size * dot(r, q) / size, q, q);
}

/* By how much s was off, and what that teaches.  slope, W: now, about the same point. */
static double compare(fl_surrogate *s, const fl_told *t, const fl_six slope, double force, double W,
                      double toward, double tolerance)
{
    const fl_vec3 turn = v3_scale(0.5, v3_cross(t->w, high(slope)));
    const double p = power_of(s), z = depth(s, W), most = toward * (force > s->force ? force : s->force);
    fl_six now, r, far;
    put(now, low(slope), v3_sub(high(slope), turn)); /* J^-T to the first order */
    const double pull = p * t->energy / t->z;
    for (int k = 0; k < 6; k++)
        far[k] = now[k] - pull * t->rise[k], r[k] = now[k] * (z / (p * W)) - t->rise[k];
    far[6] = far[7] = 0.0;
    const double off = t->z > 0.0 ? sqrt(dot(far, far)) / most : 1.0;
    double longer = off > 0.0 ? SAFE * sqrt(tolerance / off) * t->way / (s->reach * s->overlap) : LONGER;
    longer = longer > LONGER ? LONGER : longer < SHORTER ? SHORTER : longer;
    s->reach = longer * s->reach < FL_SURROGATE_MOST ? longer * s->reach : FL_SURROGATE_MOST;
    if (off > BEYOND * tolerance) memset(s->learnt, 0, sizeof s->learnt);
    else if (z > 0.0 && off > WITHIN * tolerance) learn(s, t->q, r, p * W / (z * force));
    return off;
}

/* How far the pressures lie from their centre, in the mean. */
static double spread_of(const fl_bearing *q)
{
    const double all = q->spread / q->normal - v3_norm2(q->moment) / (q->normal * q->normal);
    return all > 0.0 ? sqrt(all) : 0.0;
}

/* A contact that is new: the point is the centre of the pressure, and stays with A from now on. */
static void begin(fl_surrogate *s, const fl_seen *seen, double tolerance)
{
    const fl_bearing *q = seen->q;
    const double spread = spread_of(q);
    const fl_vec3 centre = v3_madd(seen->places->place[0].p, 1.0 / q->normal, q->moment);
    const fl_pads pads = s->pads;
    *s = (fl_surrogate){.pads = pads, .reach = FIRST * sqrt(tolerance)};
    s->less = fl_surrogate_less(tolerance);
    s->arm = spread > seen->radii ? spread : seen->radii;
    s->own = m3_tmul(*seen->M, v3_sub(centre, seen->o));
}

/* A contact that began at a corner may be one of faces now. */
static void widen(fl_surrogate *s, const fl_bearing *q)
{
    const double spread = q->normal > 0.0 ? spread_of(q) : 0.0, part = s->arm / spread;
    if (!(spread > WIDER * s->arm)) return;
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 6; c++) s->learnt[r][c] *= (r < 3 ? 1.0 : part) * (c < 3 ? 1.0 : part);
    s->arm = spread;
}

/* H and p of the springs, of what was learnt, and of the slope of W. */
FL_FOUR_VERSIONS static void bend(fl_surrogate *s, const fl_seen *seen, const fl_six slope, fl_vec3 from)
{
    const double W = seen->energy, force = s->force;
    about(s->H, seen->springs, seen->scale, from, s->arm);
    add(s->H, -0.5 / W, slope, slope); /* the root in W bends down, as in survey_patch() */
    fl_six along, bent;
    put(along, v3_scale(1.0 / force, low(slope)), NONE);
    product(bent, (const fl_six *)s->H, along, (fl_six){0});
    const double curve = W * dot(along, bent) / (force * force);
    s->quarter = curve < 1.0 - 1.0 / 2.125 ? 0 : curve < 1.0 - 1.0 / 2.375 ? 1 : 2;
    const double p = power_of(s), each = 1.0 / (p * W);
    for (int r = 0; r < 6; r++) {
        s->g[r] = each * slope[r];
        for (int l = 0; l < 6; l++) s->H[r][l] = each * (s->H[r][l] + force * s->learnt[r][l]);
    }
    s->g[6] = s->g[7] = 0.0;
    add(s->H, -0.5 * (p - 1.0), s->g, s->g);
}

/* Slope of W over (u, a w) about the point; its size is that of the force. */
static double slope_of(const fl_surrogate *s, const fl_seen *seen, fl_six slope)
{
    const fl_vec3 at = v3_add(seen->o, m3_mul(*seen->M, s->own));
    const fl_bearing *q = seen->q;
    const fl_wrench first = {v3_scale(seen->scale, q->gradient.f), v3_scale(seen->scale, q->gradient.m)};
    const fl_wrench wrench = moved(&first, v3_sub(seen->places->place[0].p, at));
    put(slope, v3_neg(wrench.f), v3_scale(-1.0 / s->arm, wrench.m));
    return v3_norm(wrench.f);
}

int fl_surrogate_fill(fl_surrogate *s, const fl_seen *seen)
{
    const fl_bearing *q = seen->q;
    const fl_wrench gradient = {q->gradient.f, q->gradient.m};
    fl_bearing still;
    fl_vec3 mean;
    fl_six slope;
    s->live = 0;
    s->force = slope_of(s, seen, slope);
    if (!(s->force > 0.0 && seen->slope > 0.0)) return 0;
    if (fl_bearing_keep(seen->places, &s->pads)) return -1;
    s->M = *seen->M, s->o = seen->o, s->at = v3_add(s->o, m3_mul(s->M, s->own));
    s->first = seen->places->place[0].p;
    s->overlap = q->overlap, s->energy = seen->energy, s->slope = seen->slope;
    bend(s, seen, slope, v3_sub(s->first, s->at));
    fl_bearing_recall(&s->pads, NONE, NONE, NONE, NONE, 0.0, &still, &mean);
    if (!(still.elastic > 0.0)) return 0;
    s->beside = v3_scale(seen->scale, v3_sub(gradient.f, still.direction));
    s->pressure = seen->scale * still.elastic;
    if (!(s->force > NET * s->pressure)) return 0;
    s->off = v3_madd(v3_neg(centre(&gradient)), 1.0 / still.elastic, mean);
    s->live = 1;
    return 0;
}

double fl_surrogate_look(fl_surrogate *s, const fl_told *t, const fl_seen *seen, double tolerance)
{
    fl_six slope;
    double off = 0.0;
    if (t) {
        const double force = slope_of(s, seen, slope);
        if (force > 0.0) off = compare(s, t, slope, force, seen->energy, seen->toward, tolerance);
        widen(s, seen->q);
    } else {
        s->live = 0;
        if (!(seen->q->normal > 0.0)) return 0.0;
        begin(s, seen, tolerance);
    }
    if (fl_surrogate_fill(s, seen)) return -1.0;
    if (s->live && (seen->stiff_i > 0.0 || seen->stiff_j > 0.0))
        s->stiff_i = seen->stiff_i / s->slope, s->stiff_j = seen->stiff_j / s->slope;
    return off;
}

void fl_surrogate_free(fl_surrogate *s)
{
    if (s) free(s->pads.pad);
}
