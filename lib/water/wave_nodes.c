/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "water/wave_nodes.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"

/* Highest degree of a reduced rule, and its number of moments. Above 14 the moments of a narrow section are
 * badly conditioned; a section in two parts of a lower degree needs no more points. */
enum {
    MAX_DEGREE = 12,
    MAX_MOMENTS = (MAX_DEGREE + 1) * (MAX_DEGREE + 2) / 2,
    MAX_GAUSS = MAX_DEGREE / 2 + 2
};
/* rms of the degrees left out, over e and the square root of the number of points: what a rule of positive
 * weights integrates them to is like a mean of so many random numbers. On floes of 20 m at Tp 6 s it leaves
 * 0.3 e of the force along the waves. */
#define TAIL_SHARE 0.35
/* Most points of a body, as FL_HULL_PANELS_MAX. */
enum { MAX_POINTS = 1000000 };

/* --- the degree ---------------------------------------------------------------------------------- */

/* 2 sum_(m > p) J_m(x)^2 for p = 0 .. MAX_DEGREE, by recurrence downwards; J_0^2 + 2 sum J_m^2 = 1. */
static void bessel_tails(double x, double tail[MAX_DEGREE + 1])
{
    const int top = MAX_DEGREE + 20 + (int)(1.3 * x);
    double above = 0.0, here = 1e-140, sum = 0.0;
    for (int p = 0; p <= MAX_DEGREE; p++) tail[p] = 0.0;
    if (!(x > 1e-3)) return;
    for (int m = top; m >= 1; m--) {
        if (m <= MAX_DEGREE) tail[m] = sum; /* of all orders above m */
        sum += 2.0 * here * here;
        const double below = 2.0 * m / x * here - above;
        above = here, here = below;
        if (fabs(here) > 1e100) { /* the scale is free */
            here *= 1e-100, above *= 1e-100, sum *= 1e-200;
            for (int p = m; p <= MAX_DEGREE; p++) tail[p] *= 1e-200;
        }
    }
    tail[0] = sum;
    sum += here * here;
    for (int p = 0; p <= MAX_DEGREE; p++) tail[p] /= sum;
}

/* Rings of equal area. */
enum { RINGS = 4 };

int fl_wave_nodes_degree(const fl_waves *w, double R, double error, double parts)
{
    double all = 0.0, off[MAX_DEGREE + 1] = {0}, tail[MAX_DEGREE + 1];
    for (int32_t j = 0; j < w->n; j++) {
        const double a2 = w->train[j].a * w->train[j].a;
        all += a2;
        for (int ring = 0; ring < RINGS; ring++) {
            bessel_tails(w->train[j].k * R * sqrt((ring + 0.5) / RINGS), tail);
            for (int p = 0; p <= MAX_DEGREE; p++) off[p] += a2 / RINGS * tail[p];
        }
    }
    int p = 2;
    while (p <= MAX_DEGREE &&
           off[p] > 0.5 * (p + 1) * (p + 2) * parts * TAIL_SHARE * TAIL_SHARE * error * error * all)
        p++;
    return p;
}

/* --- rules over a polygon ------------------------------------------------------------------------ */

typedef struct {
    int32_t n, cap_x, cap_y, cap_w;
    double *x, *y, *w;
} flat_rule;

static void free_rule(flat_rule *r)
{
    free(r->x), free(r->y), free(r->w);
    *r = (flat_rule){0};
}

static int add_point(flat_rule *r, double x, double y, double w, fl_err *err)
{
    const int64_t want = (int64_t)r->n + 1;
    if (want > MAX_POINTS)
        return fl_fail(err, FL_INPUT,
                       "water.period: the waves are so short that a floe would need more than %d points",
                       MAX_POINTS);
    if (fl_grow(&r->x, &r->cap_x, want, sizeof *r->x, err) ||
        fl_grow(&r->y, &r->cap_y, want, sizeof *r->y, err) ||
        fl_grow(&r->w, &r->cap_w, want, sizeof *r->w, err))
        return -1;
    r->x[r->n] = x, r->y[r->n] = y, r->w[r->n++] = w;
    return 0;
}

/* Points and weights of Gauss and Legendre on [0, 1]. */
static void gauss_rule(int n, double *x, double *w)
{
    for (int k = 0; k < n; k++) {
        double z = cos(PI * (k + 0.75) / (n + 0.5)), d = 1.0;
        for (int turn = 0; turn < 20; turn++) {
            double p = 1.0, before = 0.0;
            for (int m = 0; m < n; m++) {
                const double next = ((2 * m + 1) * z * p - m * before) / (m + 1);
                before = p, p = next;
            }
            d = n * (z * p - before) / (z * z - 1.0);
            z -= p / d;
        }
        x[k] = 0.5 * (1.0 - z), w[k] = 1.0 / ((1.0 - z * z) * d * d);
    }
}

/* Product of Gauss rules over the triangle 0, a, b, collapsed at 0: degree p. */
static int add_triangle(flat_rule *r, const double a[2], const double b[2], int p, fl_err *err)
{
    const int nu = (p + 1) / 2 + 1, nv = p / 2 + 1;
    const double area2 = a[0] * b[1] - a[1] * b[0];
    double u[MAX_GAUSS], wu[MAX_GAUSS], v[MAX_GAUSS], wv[MAX_GAUSS];
    gauss_rule(nu, u, wu), gauss_rule(nv, v, wv);
    for (int i = 0; i < nu; i++)
        for (int j = 0; j < nv; j++)
            if (add_point(r, u[i] * (a[0] + v[j] * (b[0] - a[0])), u[i] * (a[1] + v[j] * (b[1] - a[1])),
                          area2 * wu[i] * u[i] * wv[j], err))
                return -1;
    return 0;
}

/* --- fewer points -------------------------------------------------------------------------------- */

/* Products of Chebyshev polynomials up to degree p at a point of the unit square. */
static int moments_of(int p, double x, double y, double *m)
{
    double a[MAX_DEGREE + 1] = {1.0, x}, b[MAX_DEGREE + 1] = {1.0, y};
    int n = 0;
    for (int k = 2; k <= p; k++) a[k] = 2.0 * x * a[k - 1] - a[k - 2], b[k] = 2.0 * y * b[k - 1] - b[k - 2];
    for (int i = 0; i <= p; i++)
        for (int j = 0; i + j <= p; j++) m[n++] = a[i] * b[j];
    return n;
}

/* The pivots: basis[k] is the point of row k, -1 while it is the unit vector k, whose weight is 0; B its
 * inverse. */
typedef struct {
    int n;
    int32_t *basis;
    double *w, *B, *y;
} pivot_table;

/* Smallest pivot: y has elements of order 1. */
#define PIVOT_TOL 1e-9

static void exchange_row(pivot_table *t, int row)
{
    double *const B = t->B, *const base = B + (int64_t)row * t->n, per = 1.0 / t->y[row];
    for (int c = 0; c < t->n; c++) base[c] *= per;
    for (int r = 0; r < t->n; r++) {
        double *const other = B + (int64_t)r * t->n, f = t->y[r];
        if (r == row || f == 0.0) continue;
        for (int c = 0; c < t->n; c++) other[c] -= f * base[c];
    }
}

/* Takes in a point of weight w and moments m; it or a point of the basis is left without weight. */
static void pivot_point(pivot_table *t, int32_t point, double w, const double *m)
{
    int free_row = -1, row = -1;
    double most = PIVOT_TOL, least = w; /* how much of w goes to the basis */
    for (int r = 0; r < t->n; r++) {
        double sum = 0.0;
        for (int c = 0; c < t->n; c++) sum += t->B[(int64_t)r * t->n + c] * m[c];
        t->y[r] = sum;
        if (t->basis[r] < 0 && fabs(sum) > most) most = fabs(sum), free_row = r;
    }
    if (free_row >= 0) {
        t->basis[free_row] = point, t->w[free_row] = w;
        exchange_row(t, free_row);
        return;
    }
    for (int r = 0; r < t->n; r++)
        if (t->basis[r] >= 0 && t->y[r] < -PIVOT_TOL && t->w[r] < -t->y[r] * least)
            least = t->w[r] / -t->y[r], row = r;
    for (int r = 0; r < t->n; r++)
        if (t->basis[r] >= 0) t->w[r] = fmax(0.0, t->w[r] + least * t->y[r]);
    if (row < 0) return; /* all its weight has gone */
    t->basis[row] = point, t->w[row] = w - least;
    exchange_row(t, row);
}

/* Points are taken in steps of about this part of their number, so that the first basis lies all over the
 * section and is well conditioned. */
#define GOLDEN 0.3819660112501051

static int32_t greatest_divisor(int32_t a, int32_t b)
{
    while (b) {
        const int32_t c = a % b;
        a = b, b = c;
    }
    return a;
}

/* Makes the polynomials orthonormal over the rule, M[k] being their values at point k. Products of Chebyshev
 * polynomials alone are nearly dependent on a section that does not fill its square. */
static void orthonormalise(const flat_rule *r, int n, double *M)
{
    for (int c = 0; c < n; c++)
        for (int turn = 0; turn < 2; turn++) {
            double size = 0.0;
            for (int d = 0; d < c; d++) {
                double dot = 0.0;
                for (int32_t k = 0; k < r->n; k++) dot += r->w[k] * M[k * n + c] * M[k * n + d];
                for (int32_t k = 0; k < r->n; k++) M[k * n + c] -= dot * M[k * n + d];
            }
            for (int32_t k = 0; k < r->n; k++) size += r->w[k] * M[k * n + c] * M[k * n + c];
            for (int32_t k = 0; k < r->n; k++) M[k * n + c] /= sqrt(size);
        }
}

/* Weights again from all moments, by the inverse there is: takes the rounding of the pivots back. */
static void refine_weights(pivot_table *t, const flat_rule *r, const double *M)
{
    double off[MAX_MOMENTS] = {0};
    for (int32_t k = 0; k < r->n; k++)
        for (int c = 0; c < t->n; c++) off[c] += r->w[k] * M[k * t->n + c];
    for (int row = 0; row < t->n; row++)
        for (int c = 0; c < t->n && t->basis[row] >= 0; c++)
            off[c] -= t->w[row] * M[t->basis[row] * t->n + c];
    for (int row = 0; row < t->n; row++) {
        double sum = 0.0;
        for (int c = 0; c < t->n; c++) sum += t->B[row * t->n + c] * off[c];
        if (t->basis[row] >= 0) t->w[row] = fmax(0.0, t->w[row] + sum);
    }
}

/* Reduces a rule to at most (p + 1)(p + 2)/2 points. */
static int reduce_rule(flat_rule *r, int p, double R, fl_err *err)
{
    double first[MAX_MOMENTS];
    const int n = moments_of(p, 0.0, 0.0, first);
    int rc = -1;
    pivot_table t = {.n = n};
    if (r->n <= n) return 0;
    double *const M = fl_alloc((int64_t)r->n * n, sizeof *M, err);
    t.basis = fl_alloc(n, sizeof *t.basis, err);
    t.w = fl_alloc(n, sizeof *t.w, err);
    t.B = fl_alloc((int64_t)n * n, sizeof *t.B, err);
    t.y = fl_alloc(n, sizeof *t.y, err);
    if (!M || !t.basis || !t.w || !t.B || !t.y) goto done;
    for (int k = 0; k < n; k++) t.basis[k] = -1, t.B[k * n + k] = 1.0;
    for (int32_t k = 0; k < r->n; k++) moments_of(p, r->x[k] / R, r->y[k] / R, M + k * n);
    orthonormalise(r, n, M);
    int32_t step = (int32_t)(GOLDEN * r->n) + 1;
    while (greatest_divisor(step, r->n) != 1) step++;
    for (int32_t c = 0; c < r->n; c++) {
        const int32_t k = (int32_t)((int64_t)c * step % r->n);
        pivot_point(&t, k, r->w[k], M + k * n);
    }
    for (int turn = 0; turn < 2; turn++) refine_weights(&t, r, M);
    int32_t kept = 0;
    double *const w = t.y; /* in the order of the points, so that nothing is overwritten before it is read */
    for (int32_t k = 0; k < r->n; k++)
        for (int row = 0; row < n; row++)
            if (t.basis[row] == k && t.w[row] > 0.0) {
                r->x[kept] = r->x[k], r->y[kept] = r->y[k], w[kept++] = t.w[row];
                break;
            }
    memcpy(r->w, w, (size_t)kept * sizeof *w);
    r->n = kept;
    rc = 0;
done:
    free(M), free(t.basis), free(t.w), free(t.B), free(t.y);
    return rc;
}

/* --- bodies -------------------------------------------------------------------------------------- */

static int32_t cap_face(const fl_poly *p, fl_vec3 e)
{
    int32_t best = 0;
    for (int32_t f = 1; f < p->nf; f++)
        if (v3_dot(p->n[f], e) > v3_dot(p->n[best], e)) best = f;
    return best;
}

static int alloc_nodes(fl_wave_nodes *a, int32_t n, int faces, fl_err *err)
{
    a->n = n;
    a->x = fl_alloc(n, sizeof *a->x, err);
    if (faces) a->area = fl_alloc(n, sizeof *a->area, err);
    else a->w = fl_alloc(n, sizeof *a->w, err), a->half = fl_alloc(n, sizeof *a->half, err);
    return a->x && (faces ? a->area != NULL : a->w && a->half) ? 0 : -1;
}

/* A convex section, counter-clockwise. */
typedef struct {
    int32_t n;
    double (*v)[2];
} section_outline;

/* The part of an outline on the left of the line through c along d, counter-clockwise; NULL without memory.
 * */
static int cut_outline(section_outline *to, const section_outline *p, const double c[2], const double d[2],
                       double side, fl_err *err)
{
    to->n = 0;
    to->v = fl_alloc((int64_t)p->n + 2, sizeof *to->v, err);
    if (!to->v) return -1;
    for (int32_t k = 0; k < p->n; k++) {
        const double *a = p->v[k], *b = p->v[(k + 1) % p->n],
                     ha = side * (d[0] * (a[1] - c[1]) - d[1] * (a[0] - c[0])),
                     hb = side * (d[0] * (b[1] - c[1]) - d[1] * (b[0] - c[0]));
        if (ha >= 0.0) memcpy(to->v[to->n++], a, sizeof *to->v);
        if ((ha > 0.0 && hb < 0.0) || (ha < 0.0 && hb > 0.0))
            for (int e = 0; e < 2; e++) to->v[to->n][e] = a[e] + ha / (ha - hb) * (b[e] - a[e]);
        else continue;
        to->n++;
    }
    return 0;
}

/* Area and centroid; the farthest vertex from it, and its direction. */
static double measure_outline(const section_outline *p, double c[2], double *R, double d[2])
{
    double area = 0.0;
    c[0] = c[1] = *R = 0.0;
    for (int32_t k = 1; k + 1 < p->n; k++) {
        const double *o = p->v[0], *a = p->v[k], *b = p->v[k + 1],
                     part = 0.5 * ((a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]));
        area += part;
        for (int e = 0; e < 2; e++) c[e] += part * (o[e] + a[e] + b[e]) / 3.0;
    }
    if (!(area > 0.0)) return 0.0;
    c[0] /= area, c[1] /= area;
    for (int32_t k = 0; k < p->n; k++) {
        const double x = p->v[k][0] - c[0], y = p->v[k][1] - c[1], far = hypot(x, y);
        if (far <= *R) continue;
        *R = far, d[0] = -y / far, d[1] = x / far;
    }
    return area;
}

/* Adds the rule of a section, halved across its longest direction until the degree is low enough. */
static int add_section(flat_rule *all, const section_outline *p, const fl_waves *w, double error,
                       double parts, fl_err *err)
{
    double c[2], d[2] = {0}, R;
    if (!(measure_outline(p, c, &R, d) > 0.0)) return 0;
    const int degree = fl_wave_nodes_degree(w, R, error, parts);
    int rc = 0;
    if (degree > MAX_DEGREE) {
        for (int side = -1; side <= 1 && rc == 0; side += 2) {
            section_outline half = {0};
            rc = cut_outline(&half, p, c, d, side, err) || add_section(all, &half, w, error, 2.0 * parts, err)
                     ? -1
                     : 0;
            free(half.v);
        }
        return rc;
    }
    flat_rule r = {0};
    for (int32_t k = 0; k < p->n && rc == 0; k++) {
        const double *u = p->v[k], *v = p->v[(k + 1) % p->n], a[2] = {u[0] - c[0], u[1] - c[1]},
                     b[2] = {v[0] - c[0], v[1] - c[1]};
        rc = add_triangle(&r, a, b, degree, err);
    }
    if (rc == 0) rc = reduce_rule(&r, degree, R, err);
    for (int32_t k = 0; k < r.n && rc == 0; k++)
        rc = add_point(all, r.x[k] + c[0], r.y[k] + c[1], r.w[k], err);
    free_rule(&r);
    return rc;
}

static int make_columns(fl_wave_nodes *a, const fl_hull *h, const fl_waves *w, double error, fl_err *err)
{
    const fl_prism *q = &h->prism;
    const fl_poly *p = h->shape;
    const int32_t f = cap_face(p, q->e), first = p->first[f], m = p->first[f + 1] - first;
    const fl_vec3 b = v3_cross(q->e, q->a);
    section_outline outline = {.n = m, .v = fl_alloc(m, sizeof *outline.v, err)};
    flat_rule r = {0};
    int rc = -1;
    for (int32_t k = 0; k < m && outline.v; k++) {
        const fl_vec3 u = v3_sub(p->v[p->loop[first + k]], q->o);
        outline.v[k][0] = v3_dot(q->a, u), outline.v[k][1] = v3_dot(b, u);
    }
    if (!outline.v || add_section(&r, &outline, w, error, 1.0, err) || alloc_nodes(a, r.n, 0, err)) goto done;
    for (int32_t k = 0; k < r.n; k++) {
        a->x[k] = v3_madd(v3_madd(v3_madd(q->o, r.x[k], q->a), r.y[k], b), q->z0, q->e);
        a->w[k] = r.w[k], a->half[k] = 0.5 * sqrt(r.w[k]);
    }
    a->along = q->e;
    a->length = q->z1 - q->z0;
    a->section = q->area;
    rc = 0;
done:
    free_rule(&r);
    free(outline.v);
    return rc;
}

/* A part of a face; parts with the same key are merged. */
typedef struct {
    int32_t key[5];
    fl_vec3 x, area;
    fl_mat3 spread; /* of a mesh, else 0 */
} face_part;

typedef struct {
    int32_t n, cap;
    face_part *part;
    double longest, cell;
    int spread; /* 1: of a mesh */
} face_list;

/* Steps of the tangent of a normal within a merged part, 10 degrees, and within one of a mesh. */
#define NORMAL_STEP 0.17
#define MESH_NORMAL_STEP 0.35

/* Distance from a plane between cells, over their width, that is rounding. */
#define ON_PLANE 1e-9
/* The same for the normal of a part, over its step: that of a narrow piece has lost digits. */
#define SAME_NORMAL 1e-5

/* Adds w times (x - y)(x - y)^T. */
static void add_square(fl_mat3 *s, double w, fl_vec3 x, fl_vec3 y)
{
    const double d[3] = {x.x - y.x, x.y - y.y, x.z - y.z};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) s->m[i][j] += w * d[i] * d[j];
}

/* Mean over a triangle of centroid x. */
static fl_mat3 triangle_spread(const fl_vec3 v[3], fl_vec3 x)
{
    fl_mat3 s = {0};
    for (int k = 0; k < 3; k++) add_square(&s, 1.0 / 12.0, v[k], x);
    return s;
}

/* Of a mesh, what lies on the limit between two but for rounding is in the upper one. */
static int32_t cell_of(const face_list *l, double x, double width, double rounding)
{
    return (int32_t)floor(x / width + (l->spread ? rounding : 0.0));
}

static int store_part(face_list *l, const fl_vec3 v[3], fl_err *err)
{
    if (l->n == MAX_POINTS)
        return fl_fail(err, FL_INPUT,
                       "water.period: the waves are so short that a body would need more than %d points",
                       MAX_POINTS);
    if (fl_grow(&l->part, &l->cap, (int64_t)l->n + 1, sizeof *l->part, err)) return -1;
    face_part *p = &l->part[l->n++];
    p->area = v3_scale(0.5, v3_cross(v3_sub(v[1], v[0]), v3_sub(v[2], v[0])));
    p->x = v3_scale(1.0 / 3.0, v3_add(v3_add(v[0], v[1]), v[2]));
    if (l->spread) p->spread = triangle_spread(v, p->x);
    const double size = v3_norm(p->area), n[3] = {p->area.x, p->area.y, p->area.z};
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(n[k]) > fabs(n[axis])) axis = k;
    const double in[3] = {p->x.x, p->x.y, p->x.z};
    for (int k = 0; k < 3; k++) p->key[k] = cell_of(l, in[k], l->cell, ON_PLANE);
    p->key[3] = axis + (n[axis] < 0.0 ? 3 : 0);
    const double step = l->spread ? MESH_NORMAL_STEP : NORMAL_STEP;
    p->key[4] = size > 0.0 ? 64 * cell_of(l, n[(axis + 1) % 3] / size, step, SAME_NORMAL) +
                                 cell_of(l, n[(axis + 2) % 3] / size, step, SAME_NORMAL)
                           : 0;
    return 0;
}

/* Halves the longest side until none is too long. */
static int add_part(face_list *l, const fl_vec3 v[3], fl_err *err)
{
    double most = 0.0;
    int at = 0;
    for (int k = 0; k < 3; k++) {
        const double len = v3_norm(v3_sub(v[(k + 1) % 3], v[k]));
        if (len > most) most = len, at = k;
    }
    if (most > l->longest) {
        const fl_vec3 x = v[at], y = v[(at + 1) % 3], z = v[(at + 2) % 3], m = v3_lerp(x, y, 0.5);
        return add_part(l, (fl_vec3[3]){x, m, z}, err) || add_part(l, (fl_vec3[3]){m, y, z}, err) ? -1 : 0;
    }
    return store_part(l, v, err);
}

/* Cuts a triangle at the planes between cells across `axis` and those after it: then a part of an upright
 * face has the same width at each height, which its wet share supposes. */
static int add_cut_part(face_list *l, const fl_vec3 v[3], int axis, fl_err *err)
{
    double d[3], lo = INFINITY, hi = -INFINITY;
    if (axis == 3) return store_part(l, v, err);
    for (int k = 0; k < 3; k++) {
        d[k] = v3_at(v[k], axis) / l->cell;
        lo = fmin(lo, d[k]), hi = fmax(hi, d[k]);
    }
    const double first = floor(lo + ON_PLANE), last = ceil(hi - ON_PLANE),
                 plane = first + floor(0.5 * (last - first));
    if (last - first < 2.0) return add_cut_part(l, v, axis + 1, err);
    for (int k = 0; k < 3; k++) d[k] = fabs(d[k] - plane) > ON_PLANE ? d[k] - plane : 0.0;
    for (double side = -1.0; side < 2.0; side += 2.0) {
        fl_vec3 w[4];
        int m = 0;
        for (int k = 0; k < 3; k++) {
            const int j = (k + 1) % 3;
            if (side * d[k] >= 0.0) w[m++] = v[k];
            if (d[k] * d[j] < 0.0) w[m++] = v3_lerp(v[k], v[j], d[k] / (d[k] - d[j]));
        }
        for (int k = 1; k + 1 < m; k++)
            if (add_cut_part(l, (fl_vec3[3]){w[0], w[k], w[k + 1]}, axis, err)) return -1;
    }
    return 0;
}

static int compare_parts(const void *a, const void *b)
{
    const face_part *p = a, *q = b;
    for (int k = 0; k < 5; k++)
        if (p->key[k] != q->key[k]) return p->key[k] < q->key[k] ? -1 : 1;
    const double x[3] = {p->x.x, p->x.y, p->x.z}, y[3] = {q->x.x, q->x.y, q->x.z};
    for (int k = 0; k < 3; k++) /* so that the order does not depend on the sort */
        if (x[k] != y[k]) return x[k] < y[k] ? -1 : 1;
    return 0;
}

/* Triangles of the faces have no side longer than 1.5/k95, nor than an eighth of the body. */
#define FACE_SIDE 1.5
#define FACE_PARTS 8.0
/* Merged parts are within this part of the wavelength of k95. */
#define CELLS_PER_LENGTH 12.0

/* Spread of the parts first .. last - 1 about their centroid x, to part n <= first. */
static void merge_spread(face_list *l, int32_t first, int32_t last, fl_vec3 x, double per, int32_t n)
{
    fl_mat3 s = {0};
    for (int32_t c = first; c < last; c++) {
        const face_part *p = &l->part[c];
        const double w = per * v3_norm(p->area);
        add_square(&s, w, p->x, x);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) s.m[i][j] += w * p->spread.m[i][j];
    }
    l->part[n].spread = s;
}

/* Nodes of merged parts. */
static int merge_parts(fl_wave_nodes *a, face_list *l, fl_err *err)
{
    fl_vec3 shadow = v3(0, 0, 0);
    qsort(l->part, (size_t)l->n, sizeof *l->part, compare_parts);
    int32_t n = 0;
    for (int32_t k = 0, end; k < l->n; k = end) {
        double size = 0.0;
        fl_vec3 x = v3(0, 0, 0), area = x;
        for (end = k; end < l->n && memcmp(l->part[end].key, l->part[k].key, sizeof l->part[k].key) == 0;
             end++) {
            const double s = v3_norm(l->part[end].area);
            size += s;
            x = v3_madd(x, s, l->part[end].x);
            area = v3_add(area, l->part[end].area);
        }
        if (!(size > 0.0)) continue;
        x = v3_scale(1.0 / size, x);
        if (l->spread) merge_spread(l, k, end, x, 1.0 / size, n);
        l->part[n].x = x, l->part[n++].area = area;
    }
    if (alloc_nodes(a, n, 1, err)) return -1;
    if (l->spread && !(a->spread = fl_alloc(n, sizeof *a->spread, err))) return -1;
    for (int32_t k = 0; k < n; k++) {
        const fl_vec3 s = a->area[k] = l->part[k].area;
        a->x[k] = l->part[k].x;
        if (l->spread) a->spread[k] = l->part[k].spread;
        shadow = v3_add(shadow, v3(0.5 * fabs(s.x), 0.5 * fabs(s.y), 0.5 * fabs(s.z)));
    }
    a->section = fmax(shadow.x, fmax(shadow.y, shadow.z));
    return 0;
}

static int make_faces(fl_wave_nodes *a, const fl_poly *p, const fl_waves *w, fl_err *err)
{
    face_list l = {.longest = fmin(FACE_SIDE / w->k95, p->size / FACE_PARTS),
                   .cell = fmin(2.0 * PI / w->k95 / CELLS_PER_LENGTH, p->size / FACE_PARTS)};
    int rc = 0;
    for (int32_t f = 0; f < p->nf; f++)
        for (int32_t k = p->first[f] + 1; k + 1 < p->first[f + 1] && rc == 0; k++) {
            const fl_vec3 v[3] = {p->v[p->loop[p->first[f]]], p->v[p->loop[k]], p->v[p->loop[k + 1]]};
            rc = add_part(&l, v, err);
        }
    if (rc == 0) rc = merge_parts(a, &l, err);
    free(l.part);
    return rc;
}

/* Parts of a mesh: of the wavelength of k95 at the standard error, and bounds of their size over that. Larger
 * ones at a larger error miss the moment of waves of k95, in which a hull of 60 m pitches. */
#define MESH_ERROR 0.003
#define MESH_PARTS 4.0
#define MESH_FINEST 0.4
#define MESH_COARSEST 1.0

int fl_wave_nodes_make_mesh(fl_wave_nodes *a, const fl_vec3 *v, int32_t n, double size, const fl_waves *w,
                            double error, fl_err *err)
{
    const double scale = fmin(fmax(sqrt(error / MESH_ERROR), MESH_FINEST), MESH_COARSEST),
                 part = fmin(scale * 2.0 * PI / w->k95 / MESH_PARTS, size / FACE_PARTS);
    face_list l = {.longest = part, .cell = part, .spread = 1};
    int rc = 0;
    fl_wave_nodes_free(a);
    a->kind = FL_WAVE_MESH;
    for (int32_t k = 0; k < n && rc == 0; k++) rc = add_cut_part(&l, v + 3 * (int64_t)k, 0, err);
    if (rc == 0) rc = merge_parts(a, &l, err);
    free(l.part);
    return rc;
}

int fl_wave_nodes_make(fl_wave_nodes *a, const fl_hull *hull, const fl_waves *w, double error, fl_err *err)
{
    fl_wave_nodes_free(a);
    a->kind = hull->shape->nf == 0 ? FL_WAVE_ROUND : hull->prism.area > 0.0 ? FL_WAVE_COLUMNS : FL_WAVE_FACES;
    if (a->kind == FL_WAVE_ROUND) {
        a->section = PI * hull->radius * hull->radius;
        return 0;
    }
    return a->kind == FL_WAVE_COLUMNS ? make_columns(a, hull, w, error, err)
                                      : make_faces(a, hull->shape, w, err);
}

void fl_wave_nodes_free(fl_wave_nodes *a)
{
    free(a->x), free(a->w), free(a->half), free(a->area), free(a->spread);
    *a = (fl_wave_nodes){0};
}
