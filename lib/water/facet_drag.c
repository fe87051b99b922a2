/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/wide.h"
#include "water/facet_drag.h"

int32_t fl_skin_most(const fl_hull *h)
{
    const fl_poly *p = h->p;
    return p->nf ? 3 * (p->first[p->nf] + 2 * p->nf) : 0;
}

/* The corners of what is left of a face, one after another: the sum of its parts, or its pieces. */
typedef struct {
    fl_vec3 n, hub, last, head; /* head: the first corner */
    int corners;
    double area;    /* of the fan about hub      */
    fl_vec3 moment; /* int (x - hub) dA          */
    fl_skin_piece *out;
    int32_t pieces, spoke, first; /* the pieces towards the last corner and the first, -1: none yet */
} outline;

/* Add to the piece *at half way to x from the hub, a new one where that is -1. */
static void spoke(outline *o, int32_t *at, fl_vec3 x, double area)
{
    if (*at < 0) {
        *at = o->pieces++;
        o->out[*at] = (fl_skin_piece){.n = o->n, .r = v3_madd(o->hub, 0.5, x)};
    }
    o->out[*at].area += area;
}

static void side(outline *o, fl_vec3 a, fl_vec3 b, int closing)
{
    const fl_vec3 x = v3_sub(a, o->hub), y = v3_sub(b, o->hub);
    const double area = 0.5 * v3_dot(o->n, v3_cross(x, y));
    o->area += area;
    o->moment = v3_madd(o->moment, area / 3.0, v3_add(x, y));
    if (!o->out) return;
    if (!(area > 0.0)) {
        o->spoke = -1;
        if (o->first == -1) o->first = -2; /* then the last triangle has no neighbour there */
        return;
    }
    /* a third each to the middles of the two spokes, which neighbours share, and to that of the rim */
    spoke(o, &o->spoke, x, area / 3.0);
    if (o->first == -1) o->first = o->spoke;
    int32_t next = closing && o->first >= 0 ? o->first : -1;
    spoke(o, &next, y, area / 3.0);
    o->spoke = next;
    next = -1;
    spoke(o, &next, v3_add(x, y), area / 3.0);
}

static void corner(outline *o, fl_vec3 x)
{
    if (o->corners++) side(o, o->last, x, 0);
    else o->head = x;
    o->last = x;
}

/* Round face f; sign +1 keeps what is below the plane, -1 what is above it. */
static void walk(const fl_poly *p, int32_t f, fl_vec3 up, double level, double sign, outline *o)
{
    const int32_t *at = p->loop + p->first[f], m = p->first[f + 1] - p->first[f];
    fl_vec3 from = p->v[at[m - 1]];
    double s0 = sign * (v3_dot(up, from) - level);
    for (int32_t k = 0; k < m; k++) {
        const fl_vec3 to = p->v[at[k]];
        const double s1 = sign * (v3_dot(up, to) - level);
        if ((s0 <= 0.0) != (s1 <= 0.0)) corner(o, v3_lerp(from, to, s0 / (s0 - s1)));
        if (s1 <= 0.0) corner(o, to);
        from = to;
        s0 = s1;
    }
    if (o->corners > 2) side(o, o->last, o->head, 1);
}

int32_t fl_skin_pieces(const fl_hull *h, fl_vec3 up, double level, int dry, fl_skin_piece *out)
{
    const fl_poly *p = h->p;
    const double sign = dry ? -1.0 : 1.0;
    int32_t pieces = 0;
    for (int32_t f = 0; f < p->nf; f++) {
        outline whole = {.n = p->n[f], .hub = fl_hull_middles(h)[f]};
        walk(p, f, up, level, sign, &whole);
        if (whole.corners < 3 || !(whole.area > 0.0)) continue;
        outline fan = {.n = p->n[f],
                       .hub = v3_madd(whole.hub, 1.0 / whole.area, whole.moment),
                       .out = out + pieces,
                       .spoke = -1,
                       .first = -1};
        walk(p, f, up, level, sign, &fan);
        pieces += fan.pieces;
    }
    return pieces;
}

/* Solve the symmetric system a x = y of six, lower half of a given (Cholesky).  a is 1 and something that is
 * never negative, so no pivot is below 1, but for rounding where that something is 1e16 times larger. */
static void solve6(double a[6][6], double *x)
{
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < i; j++) {
            double s = a[i][j];
            for (int l = 0; l < j; l++) s -= a[i][l] * a[j][l];
            a[i][j] = s / a[j][j];
        }
        double s = a[i][i];
        for (int l = 0; l < i; l++) s -= a[i][l] * a[i][l];
        a[i][i] = sqrt(fmax(s, 1.0));
    }
    for (int i = 0; i < 6; i++) {
        for (int l = 0; l < i; l++) x[i] -= a[i][l] * x[l];
        x[i] /= a[i][i];
    }
    for (int i = 5; i >= 0; i--) {
        for (int l = i + 1; l < 6; l++) x[i] -= a[l][i] * x[l];
        x[i] /= a[i][i];
    }
}

/* What pieces add up to: h sum D U and h sum r x D U, then h K, its lower half row by row. */
enum { TURN = 3, MATRIX = 6, SUMS = MATRIX + 21 };

/* Of four pieces a number each. */
typedef struct {
    fl_wide area, n[3], r[3], U[3];
} pieces;

FL_WIDE_PART void take(pieces *p, const fl_skin_piece *at)
{
    fl_wide a[FL_LANES], b[FL_LANES], c[FL_LANES];
    FL_WIDE_UNROLL for (int l = 0; l < FL_LANES; l++)
    {
        a[l] = FL_FOUR(&at[l].area); /* and n */
        b[l] = FL_FOUR(&at[l].r);
        c[l] = FL_FOUR(&at[l].r.z); /* and flow */
    }
    fl_wide_transpose(a);
    fl_wide_transpose(b);
    fl_wide_transpose(c);
    p->area = a[0];
    FL_WIDE_UNROLL for (int k = 0; k < 3; k++) p->n[k] = a[k + 1], p->U[k] = c[k + 1];
    p->r[0] = b[0], p->r[1] = b[1], p->r[2] = c[0];
}

FL_WIDE_PART void to_roots(fl_wide *x)
{
    double a[FL_LANES];
    FL_FOUR_INTO(a) = *x;
#pragma omp simd
    for (int l = 0; l < FL_LANES; l++) a[l] = sqrt(a[l]);
    *x = FL_FOUR(a);
}

#define DOT(a, b) (a[0] * b[0] + a[1] * b[1] + a[2] * b[2])

/* Four pieces, into sums of four each.  skin, form: times h. */
FL_WIDE_PART void add_four(const fl_skin_piece *at, double skin, double form, fl_vec3 v, fl_vec3 w,
                           fl_wide *sum)
{
    pieces p;
    take(&p, at);
    const fl_wide *m = p.n, *r = p.r, *U = p.U;
    const fl_wide u[3] = {v.x + (w.y * r[2] - w.z * r[1]) - U[0], v.y + (w.z * r[0] - w.x * r[2]) - U[1],
                          v.z + (w.x * r[1] - w.y * r[0]) - U[2]};
    const fl_wide un = DOT(u, m), t[3] = {u[0] - un * m[0], u[1] - un * m[1], u[2] - un * m[2]};
    fl_wide ut = DOT(t, t);
    to_roots(&ut);
    const fl_wide s = skin * p.area * ut, b = form * p.area * FL_WIDE_WHERE(un > 0.0, un) - s,
                  bU = b * DOT(m, U);
    const fl_wide q[3] = {r[1] * m[2] - r[2] * m[1], r[2] * m[0] - r[0] * m[2], r[0] * m[1] - r[1] * m[0]};
    const fl_wide d[3] = {s * U[0] + bU * m[0], s * U[1] + bU * m[1], s * U[2] + bU * m[2]};
    const fl_wide g[6] = {m[0], m[1], m[2], q[0], q[1], q[2]}, sr[3] = {s * r[0], s * r[1], s * r[2]};
    FL_WIDE_UNROLL for (int i = 0; i < 3; i++) sum[i] += d[i];
    sum[TURN] += r[1] * d[2] - r[2] * d[1];
    sum[TURN + 1] += r[2] * d[0] - r[0] * d[2];
    sum[TURN + 2] += r[0] * d[1] - r[1] * d[0];
    fl_wide *row = sum + MATRIX;
#pragma GCC unroll 6
    for (int i = 0; i < 6; row += ++i) {
        const fl_wide bg = b * g[i];
#pragma GCC unroll 6
        for (int j = 0; j <= i; j++) row[j] += bg * g[j];
    }
    fl_wide *a0 = sum + MATRIX, *a1 = a0 + 1, *a2 = a1 + 2, *a3 = a2 + 3, *a4 = a3 + 4, *a5 = a4 + 5;
    a0[0] += s, a1[1] += s, a2[2] += s;
    a3[1] -= sr[2], a3[2] += sr[1]; /* (e_i x r).e_j */
    a4[0] += sr[2], a4[2] -= sr[0];
    a5[0] -= sr[1], a5[1] += sr[0];
    a3[3] += sr[1] * r[1] + sr[2] * r[2]; /* r.r - r r^T */
    a4[3] -= sr[1] * r[0], a4[4] += sr[0] * r[0] + sr[2] * r[2];
    a5[3] -= sr[2] * r[0], a5[4] -= sr[2] * r[1], a5[5] += sr[0] * r[0] + sr[1] * r[1];
}

FL_FOUR_VERSIONS static void add_up(int32_t n, const fl_skin_piece *piece, double skin, double form,
                                    fl_vec3 v, fl_vec3 w, double out[SUMS])
{
    const fl_wide zero = {0.0, 0.0, 0.0, 0.0};
    fl_wide sum[SUMS];
    fl_skin_piece rest[FL_LANES] = {{0}};
    int32_t k = 0;
    for (int c = 0; c < SUMS; c++) sum[c] = zero;
    for (; k + FL_LANES <= n; k += FL_LANES) add_four(&piece[k], skin, form, v, w, sum);
    for (int32_t l = 0; k + l < n; l++) rest[l] = piece[k + l];
    if (k < n) add_four(rest, skin, form, v, w, sum);
    for (int c = 0; c < SUMS; c++) out[c] = fl_wide_sum(&sum[c]);
}

/* Each speed over the root of its mass: then the matrix is 1 + what drag adds, and the root in solve6() is of
 * numbers of at least 1, whatever the units and however strong the drag. */
void fl_facet_drag(int32_t n, const fl_skin_piece *piece, double skin, double form, fl_vec3 mass,
                   fl_vec3 inertia, double h, fl_vec3 *v, fl_vec3 *w)
{
    const double M[6] = {mass.x, mass.y, mass.z, inertia.x, inertia.y, inertia.z},
                 y[6] = {v->x, v->y, v->z, w->x, w->y, w->z};
    double a[6][6], x[6], root[6], sum[SUMS];
    const double *row = sum + MATRIX;
    add_up(n, piece, h * skin, h * form, *v, *w, sum);
    for (int i = 0; i < 6; row += ++i) {
        root[i] = sqrt(M[i]);
        x[i] = (M[i] * y[i] + sum[i]) / root[i];
        for (int j = 0; j <= i; j++) a[i][j] = row[j] / (root[i] * root[j]);
        a[i][i] += 1.0;
    }
    solve6(a, x);
    *v = v3(x[0] / root[0], x[1] / root[1], x[2] / root[2]);
    *w = v3(x[3] / root[3], x[4] / root[4], x[5] / root[5]);
}
