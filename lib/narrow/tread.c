/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/tread.h"
#include <math.h>
#include "narrow/rules.h"

FL_WIDE_VERSIONS void fl_tread_survey(const fl_tread *g, const double *x)
{
    for (int32_t v = 0; v < g->vertices; v += FL_LANES) {
        const double *at = x + 3 * (int64_t)v;
        const fl_wide rx = *(const fl_wide *)at - g->o.x, ry = *(const fl_wide *)(at + FL_LANES) - g->o.y;
        const fl_wide rz = *(const fl_wide *)(at + 2 * FL_LANES) - g->o.z;
        const fl_wide X = g->x.x * rx + g->x.y * ry + g->x.z * rz,
                      Y = g->y.x * rx + g->y.y * ry + g->y.z * rz;
        fl_wide clear = INFINITY + 0.0 * X;
        for (int32_t c = 0; c < g->sides; c++) {
            const fl_tread_side s = g->side[c];
            const fl_wide d = s.nx * (X - s.x) + s.ny * (Y - s.y);
            *(fl_wide *)(g->within + (int64_t)c * g->vertices + v) = d;
            clear = FL_WIDE_CHOOSE(d < clear, d, clear);
        }
        *(fl_wide *)(g->X + v) = X;
        *(fl_wide *)(g->Y + v) = Y;
        *(fl_wide *)(g->h + v) = g->n.x * rx + g->n.y * ry + g->n.z * rz;
        *(fl_wide *)(g->clear + v) = clear;
    }
}

/* Over triangles, for each of their area: of s^4, s^3, s^2, and of f = k s^3 times 1, x, y, xx, xy, yy. */
typedef struct {
    fl_wide u, du, ddu, f, x, y, xx, xy, yy;
} means;

/* The corners are c, the middle their sum over 3, and the nodes of a triple with share a of two corners and
 * 1 - 2 a of the third at a times the sum and 1 - 3 a times the third. */
#define TRIPLE(a, sum, c) ((a) * (sum) + (1.0 - 3.0 * (a)) * (c))

#define ADD_MEAN(t, weight, S, K, X, Y)                                                                      \
    do {                                                                                                     \
        const fl_wide p2_ = (weight) * ((S) * (S)), p3_ = p2_ * (S), f_ = (K)*p3_, fx_ = f_ * (X),           \
                      fy_ = f_ * (Y);                                                                        \
        (t).ddu += p2_, (t).du += p3_, (t).u += p3_ * (S);                                                   \
        (t).f += f_, (t).x += fx_, (t).y += fy_;                                                             \
        (t).xx += fx_ * (X), (t).xy += fx_ * (Y), (t).yy += fy_ * (Y);                                       \
    } while (0)

/* Both ways at once: means of each, f of their sum. */
#define ADD_BOTH(p, q, weight, S, Z, K, L, X, Y)                                                             \
    do {                                                                                                     \
        const fl_wide p2_ = (weight) * ((S) * (S)), p3_ = p2_ * (S), q2_ = (weight) * ((Z) * (Z)),           \
                      q3_ = q2_ * (Z), f_ = (K)*p3_ + (L)*q3_, fx_ = f_ * (X), fy_ = f_ * (Y);               \
        (p).ddu += p2_, (p).du += p3_, (p).u += p3_ * (S);                                                   \
        (q).ddu += q2_, (q).du += q3_, (q).u += q3_ * (Z);                                                   \
        (p).f += f_, (p).x += fx_, (p).y += fy_;                                                             \
        (p).xx += fx_ * (X), (p).xy += fx_ * (Y), (p).yy += fy_ * (Y);                                       \
    } while (0)

static const double TRIPLE_SHARE[2] = {FL_TRIANGLE_A, FL_TRIANGLE_B};

/* Numbers of four vertices: of corner c of each. */
#define FOUR_OF(a, v, c) ((fl_wide){(a)[(v)[0][c]], (a)[(v)[1][c]], (a)[(v)[2][c]], (a)[(v)[3][c]]})

#define LARGER(a, b) FL_WIDE_CHOOSE((a) > (b), a, b)

FL_WIDE_VERSIONS void fl_tread_whole(const fl_tread *g, const fl_tread_tile *tile, const int32_t *corner,
                                     const fl_vec3 *normal, const int32_t *list, int32_t count,
                                     fl_tread_sums *sum)
{
    const double R = g->R;
    const fl_wide zero = {0};
    fl_tread_sums all = *sum;
    for (int32_t from = 0; from < count; from += FL_LANES) {
        const int32_t *at[FL_LANES];
        const fl_vec3 *n[FL_LANES];
        for (int l = 0; l < FL_LANES; l++) {
            const fl_tread_tile *t = &tile[list[from + l < count ? from + l : from]];
            at[l] = corner + t->first;
            n[l] = &normal[t->f];
        }
        const fl_wide x0 = FOUR_OF(g->X, at, 0), x1 = FOUR_OF(g->X, at, 1), x2 = FOUR_OF(g->X, at, 2);
        const fl_wide y0 = FOUR_OF(g->Y, at, 0), y1 = FOUR_OF(g->Y, at, 1), y2 = FOUR_OF(g->Y, at, 2);
        const fl_wide h0 = FOUR_OF(g->h, at, 0), h1 = FOUR_OF(g->h, at, 1), h2 = FOUR_OF(g->h, at, 2);
        const fl_wide nx = {n[0]->x, n[1]->x, n[2]->x, n[3]->x};
        const fl_wide ny = {n[0]->y, n[1]->y, n[2]->y, n[3]->y};
        const fl_wide nz = {n[0]->z, n[1]->z, n[2]->z, n[3]->z};
        const fl_wide c = -(g->n.x * nx + g->n.y * ny + g->n.z * nz), over = 1.0 / c;
        /* n_F x n_f along x and y */
        const fl_wide ax = -(g->y.x * nx + g->y.y * ny + g->y.z * nz),
                      ay = g->x.x * nx + g->x.y * ny + g->x.z * nz;
        const fl_wide root = 4.0 * c * c - 3.0, dm = 8.0 * c * root;
        fl_wide area = 0.5 * ((x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0));
        area = LARGER(area, -area);
        for (int l = 0; l < FL_LANES; l++)
            if (from + l >= count) area[l] = 0.0;
        const fl_wide m = 0.5 * root * root, share = area * m, share_f = share * over;
        const fl_wide k3 = 4.0 * share, k3_f = 4.0 * share_f * over;
        const fl_wide s0 = R - h0, s1 = R - h1, s2 = R - h2, z0 = R - over * h0, z1 = R - over * h1,
                      z2 = R - over * h2;
        const fl_wide sx = x0 + x1 + x2, sy = y0 + y1 + y2, ss = s0 + s1 + s2, sz = z0 + z1 + z2;
        const fl_wide mx = sx * (1.0 / 3.0), my = sy * (1.0 / 3.0), ms = ss * (1.0 / 3.0),
                      mz = sz * (1.0 / 3.0);
        means p = {zero, zero, zero, zero, zero, zero, zero, zero, zero}, r = p;
        ADD_BOTH(p, r, FL_TRIANGLE_WEIGHT[0], ms, mz, k3, k3_f, mx, my);
        for (int i = 0; i < 2; i++) {
            const double a = TRIPLE_SHARE[i], w = FL_TRIANGLE_WEIGHT[1 + 3 * i];
            ADD_BOTH(p, r, w, TRIPLE(a, ss, s0), TRIPLE(a, sz, z0), k3, k3_f, TRIPLE(a, sx, x0),
                     TRIPLE(a, sy, y0));
            ADD_BOTH(p, r, w, TRIPLE(a, ss, s1), TRIPLE(a, sz, z1), k3, k3_f, TRIPLE(a, sx, x1),
                     TRIPLE(a, sy, y1));
            ADD_BOTH(p, r, w, TRIPLE(a, ss, s2), TRIPLE(a, sz, z2), k3, k3_f, TRIPLE(a, sx, x2),
                     TRIPLE(a, sy, y2));
        }
        const fl_wide u = share * p.u, v = share_f * r.u, du = 4.0 * share * p.du, dv = 4.0 * share_f * r.du;
        all.u += u + v, all.du += du + dv, all.ddu += 12.0 * (share * p.ddu + share_f * r.ddu);
        all.f += p.f, all.s += 4.0 * (u + over * v);
        all.x += p.x, all.y += p.y, all.xx += p.xx, all.xy += p.xy, all.yy += p.yy;
        /* over m: (dm + m/c) u; (dm - 4 m/c) v + (m R/c) dv */
        const fl_wide part = dm / m, turn = (part + over) * u + (part - 4.0 * over) * v + R * over * dv;
        all.couple[0] += ax * turn, all.couple[1] += ay * turn;
    }
    *sum = all;
}

/* --- faces that are cut ----------------------------------------------------------------------------------
 */

/* A corner of a convex piece of a face: x, y, s and d, how far it is within a side of F. */
typedef fl_wide spot;
enum { S = 2, D = 3 };

/* A cut leaves as many corners as there are on its side and as there are crossings: of a triangle 4 at most,
 * and, were rounding to make it cross every side, 6, 9 and 13 of what is cut again: 11 triangles, both ways
 * and on two sides. */
enum { PIECE = 13, MOST = 4 * (PIECE - 2), STORE = 2 * MOST };

/* Triangles that wait for their sums.  kind: share for the area seen from F, force over du, and what u and du
 * have of the couple along (turn[0], turn[1]); turn[2] and turn[3]: the inward normal of the side to which
 * a share d/rim counts. */
typedef struct {
    spot corner[STORE][3], kind[STORE], turn[STORE];
    int n;
} store;

/* Of four of them, from `at` on; what is beyond n counts for nothing.  faded: with a share d/rim, and the
 * pull of that, which is s^4/rim for each of the area, at the height R - s. */
FL_WIDE_PART void take(store *b, int at, int faded, const fl_tread *g, fl_tread_sums *q, fl_tread_pull *pull)
{
    const fl_wide zero = {0};
    fl_wide a0[FL_LANES], a1[FL_LANES], a2[FL_LANES], kind[FL_LANES], turn[FL_LANES];
    for (int l = 0; l < FL_LANES; l++) {
        const int k = at + l < b->n ? at + l : at;
        a0[l] = b->corner[k][0], a1[l] = b->corner[k][1], a2[l] = b->corner[k][2];
        kind[l] = b->kind[k], turn[l] = b->turn[k];
    }
    fl_wide_transpose(a0), fl_wide_transpose(a1), fl_wide_transpose(a2);
    fl_wide_transpose(kind), fl_wide_transpose(turn);
    fl_wide area = 0.5 * ((a1[0] - a0[0]) * (a2[1] - a0[1]) - (a1[1] - a0[1]) * (a2[0] - a0[0]));
    area = LARGER(area, -area);
    for (int l = 0; l < FL_LANES; l++)
        if (at + l >= b->n) area[l] = 0.0;
    const fl_wide share = area * kind[0], gain = kind[1], k3 = 4.0 * share * gain;
    const fl_wide sx = a0[0] + a1[0] + a2[0], sy = a0[1] + a1[1] + a2[1], ss = a0[S] + a1[S] + a2[S];
    fl_wide u, du;
    if (!faded) {
        means t = {zero, zero, zero, zero, zero, zero, zero, zero, zero};
        const fl_wide mx = sx * (1.0 / 3.0), my = sy * (1.0 / 3.0), ms = ss * (1.0 / 3.0);
        ADD_MEAN(t, FL_TRIANGLE_WEIGHT[0], ms, k3, mx, my);
        for (int c = 0; c < 2; c++) {
            const double a = TRIPLE_SHARE[c], w = FL_TRIANGLE_WEIGHT[1 + 3 * c];
            ADD_MEAN(t, w, TRIPLE(a, ss, a0[S]), k3, TRIPLE(a, sx, a0[0]), TRIPLE(a, sy, a0[1]));
            ADD_MEAN(t, w, TRIPLE(a, ss, a1[S]), k3, TRIPLE(a, sx, a1[0]), TRIPLE(a, sy, a1[1]));
            ADD_MEAN(t, w, TRIPLE(a, ss, a2[S]), k3, TRIPLE(a, sx, a2[0]), TRIPLE(a, sy, a2[1]));
        }
        u = share * t.u, du = 4.0 * share * t.du;
        q->ddu += 12.0 * share * t.ddu;
        q->f += t.f, q->x += t.x, q->y += t.y, q->xx += t.xx, q->xy += t.xy, q->yy += t.yy;
    } else {
        const double each = 1.0 / g->rim;
        means t = {zero, zero, zero, zero, zero, zero, zero, zero, zero};
        fl_wide p = zero, px = zero, py = zero, ps = zero;

        for (int k = 0; k < FL_TRIANGLE_NODES; k++) {
            const double b0 = FL_TRIANGLE_NODE[k][0], b1 = FL_TRIANGLE_NODE[k][1],
                         b2 = FL_TRIANGLE_NODE[k][2];
            const fl_wide x = b0 * a0[0] + b1 * a1[0] + b2 * a2[0], y = b0 * a0[1] + b1 * a1[1] + b2 * a2[1];
            const fl_wide s = b0 * a0[S] + b1 * a1[S] + b2 * a2[S], d = b0 * a0[D] + b1 * a1[D] + b2 * a2[D];
            const fl_wide w = FL_TRIANGLE_WEIGHT[k] * each * d,
                          all = FL_TRIANGLE_WEIGHT[k] * ((s * s) * (s * s));
            ADD_MEAN(t, w, s, k3, x, y);
            p += all, px += all * x, py += all * y, ps += all * s;
        }
        u = share * t.u, du = 4.0 * share * t.du;
        q->ddu += 12.0 * share * t.ddu;
        q->f += t.f, q->x += t.x, q->y += t.y, q->xx += t.xx, q->xy += t.xy, q->yy += t.yy;
        const fl_wide nx = each * share * turn[2], ny = each * share * turn[3], ph = g->R * p - ps;
        const fl_wide fx = nx * p, fy = ny * p, tx = ph * ny, ty = ph * nx, tz = px * ny - py * nx;
        pull->f = v3_add(pull->f, v3(fl_wide_sum(&fx), fl_wide_sum(&fy), 0.0));
        pull->m = v3_add(pull->m, v3(-fl_wide_sum(&tx), fl_wide_sum(&ty), fl_wide_sum(&tz)));
    }
    q->u += u, q->du += du, q->s += 4.0 * gain * u;
    const fl_wide couple = kind[2] * u + kind[3] * du;
    q->couple[0] += turn[0] * couple, q->couple[1] += turn[1] * couple;
}

/* Sum up what waits, four by four, once there may be no room for the next face, and all of it at the last. */
FL_WIDE_PART void drain(store *b, int is_faded, int last, const fl_tread *g, fl_tread_sums *q,
                        fl_tread_pull *pull)
{
    int i = 0;
    if (!last && b->n <= STORE - MOST) return;
    for (; i < b->n && (last || i + FL_LANES <= b->n); i += FL_LANES) take(b, i, is_faded, g, q, pull);
    b->n = b->n > i ? b->n - i : 0;
    for (int l = 0; l < b->n; l++) {
        for (int c = 0; c < 3; c++) b->corner[l][c] = b->corner[i + l][c];
        b->kind[l] = b->kind[i + l], b->turn[l] = b->turn[i + l];
    }
}

/* What has a number of its corners, axis, at least level, into in, and the rest into out where that is not
 * NULL; *cut: where in `in` the cut begins, -1: there is none. */
FL_WIDE_PART int keep(const spot *p, int n, int axis, double level, spot *in, spot *out, int *left, int *cut)
{
    int m = 0, l = 0;
    double a = p[0][axis] - level;
    *cut = -1;
    for (int k = 0; k < n; k++) {
        const int next = k + 1 < n ? k + 1 : 0;
        const double b = p[next][axis] - level;
        if (a >= 0.0) in[m++] = p[k];
        else if (out) out[l++] = p[k];
        if ((a >= 0.0) != (b >= 0.0)) {
            const double t = a / (a - b);
            spot at = p[k] + t * (p[next] - p[k]);
            at[axis] = level;
            if (a >= 0.0) *cut = m;
            in[m++] = at;
            if (out) out[l++] = at;
        }
        a = b;
    }
    *left = l;
    return m;
}

/* Put a piece into store; *most, where that is not NULL: of all its numbers. */
FL_WIDE_PART void put(store *b, const spot *p, int n, const spot *kind, const spot *turn, spot *most)
{
    for (int k = 0; k < n && most; k++) *most = LARGER(p[k], *most);
    for (int k = 2; k < n; k++) {
        const int i = b->n++;
        b->corner[i][0] = p[0], b->corner[i][1] = p[k - 1], b->corner[i][2] = p[k];
        b->kind[i] = *kind, b->turn[i] = *turn;
    }
}

/* A face f as it is seen from F: its normal there, and the slope of what of F is above it. */
typedef struct {
    double nx, ny, over;
    spot kind[2], turn; /* F over f, f over F */
} facet;

/* The side of F ends the part of F over f, along the line from a to b: s^4 for each length that it moves out
 * across n_f, where it is, (nx, ny) h/c from what is below it on f. */
FL_WIDE_PART void end(const fl_tread *g, const facet *f, const fl_tread_side *m, const spot *from,
                      const spot *to, fl_tread_pull *pull)
{
    spot a = *from, b = *to;
    const double slope = (f->nx * m->nx + f->ny * m->ny) * f->over;
    const double gx = m->nx + slope * f->over * f->nx, gy = m->ny + slope * f->over * f->ny;
    if (!(a[S] > 0.0 || b[S] > 0.0)) return;
    if (a[S] < 0.0) a = a + a[S] / (a[S] - b[S]) * (b - a), a[S] = 0.0;
    if (b[S] < 0.0) b = b + b[S] / (b[S] - a[S]) * (a - b), b[S] = 0.0;
    const double dx = b[0] - a[0], dy = b[1] - a[1], s = a[S], z = b[S], s2 = s * s;
    const double all = f->kind[0][0] * sqrt((dx * dx + dy * dy) / (gx * gx + gy * gy)) * (1.0 / 30.0);
    const double p = 6.0 * all * (s2 * s2 + z * (s2 * s + z * (s2 + z * (s + z)))),
                 far = all * (s2 * s2 + z * (2.0 * s2 * s + z * (3.0 * s2 + z * (4.0 * s + 5.0 * z))));
    const double x0 = a[0] + (g->R - s) * f->nx, y0 = a[1] + (g->R - s) * f->ny;
    const double rx = p * x0 + far * (dx - (z - s) * f->nx), ry = p * y0 + far * (dy - (z - s) * f->ny);
    pull->f = v3_add(pull->f, v3(p * m->nx, p * m->ny, p * slope));
    pull->m = v3_add(pull->m, v3(ry * slope, -rx * slope, rx * m->ny - ry * m->nx));
}

/* One way of the piece p of f, s = R - h > 0, over no side of F or one, d being how far it is within. */
FL_WIDE_PART void over_one(const fl_tread *g, const facet *f, int below, const fl_tread_side *m, spot *p,
                           int n, store *plain, store *faded, spot *most, fl_tread_pull *pull)
{
    spot in[PIECE], out[PIECE], rest[PIECE];
    int cut, left;
    if (below) {
        if (m) {
            n = keep(p, n, D, 0.0, in, NULL, &left, &cut);
            if (n < 3) return;
            n = keep(in, n, D, g->rim, rest, out, &left, &cut);
            spot normal = f->turn;
            normal[2] = m->nx, normal[3] = m->ny;
            put(faded, out, left, &f->kind[1], &normal, most);
            p = rest;
        }
        put(plain, p, n, &f->kind[1], &f->turn, most);
        return;
    }
    /* of what of F is above it */
    const double slope = m ? (f->nx * m->nx + f->ny * m->ny) * f->over : 0.0;
    double least = 0.0;
    for (int k = 0; k < n; k++) {
        const double h = g->R - p[k][S], s = g->R - h * f->over;
        p[k][D] += slope * h, p[k][S] = s;
        least = s < least ? s : least;
    }
    if (m) {
        n = keep(p, n, D, 0.0, in, NULL, &left, &cut);
        if (n < 3) return;
        if (cut >= 0) end(g, f, m, &in[cut], &in[cut + 1 < n ? cut + 1 : 0], pull);
        p = in;
    }
    if (least < 0.0) {
        n = keep(p, n, S, 0.0, rest, NULL, &left, &cut);
        p = rest;
    }
    put(plain, p, n, &f->kind[0], &f->turn, most);
}

/* Over two sides: where they are equally far, seen this way, it is parted, and each part is over one.  d: of
 * the first. */
FL_WIDE_PART void over_two(const fl_tread *g, const facet *f, int below, const fl_tread_side *const m[2],
                           const spot *p, int n, store *plain, store *faded, spot *most, fl_tread_pull *pull)
{
    spot all[PIECE], part[2][PIECE];
    double slope[2] = {0.0, 0.0};
    int count[2], cut;
    for (int k = 0; k < 2 && !below; k++) slope[k] = (f->nx * m[k]->nx + f->ny * m[k]->ny) * f->over;
    for (int k = 0; k < n; k++) {
        const double d = m[1]->nx * (p[k][0] - m[1]->x) + m[1]->ny * (p[k][1] - m[1]->y);
        all[k] = p[k];
        all[k][D] = d - p[k][D] + (slope[1] - slope[0]) * (g->R - p[k][S]);
    }
    count[0] = keep(all, n, D, 0.0, part[0], part[1], &count[1], &cut);
    for (int i = 0; i < 2; i++) {
        if (count[i] < 3) continue;
        for (int k = 0; k < count[i]; k++)
            part[i][k][D] = m[i]->nx * (part[i][k][0] - m[i]->x) + m[i]->ny * (part[i][k][1] - m[i]->y);
        over_one(g, f, below, m[i], part[i], count[i], plain, faded, most, pull);
    }
}

FL_WIDE_VERSIONS void fl_tread_parts(const fl_tread *g, const fl_tread_tile *tile, const int32_t *corner,
                                     const fl_vec3 *normal, const fl_tread_cut *list, int32_t count,
                                     fl_tread_sums *sum, fl_tread_pull *pull, double *most)
{
    store plain, faded;
    const spot zero = {0};
    fl_tread_sums all = *sum;
    fl_tread_pull pulls = *pull;
    spot top = zero;
    top[S] = *most;
    plain.n = faded.n = 0;
    for (int32_t k = 0; k <= count; k++) {
        const int last = k == count, more = last ? 0 : tile[list[k].tile].n;
        facet f = {0};
        const int32_t *at = NULL;
        if (!last) {
            const fl_tread_tile *t = &tile[list[k].tile];
            const fl_vec3 nf = normal[t->f];
            const double c = -v3_dot(g->n, nf), root = 4.0 * c * c - 3.0, over = 1.0 / c;
            const double m = 0.5 * root * root, part_m = 16.0 * c / root;
            at = corner + t->first;
            f.nx = v3_dot(nf, g->x), f.ny = v3_dot(nf, g->y), f.over = over;
            f.kind[0] = (spot){m * over, over, part_m - 4.0 * over, g->R * over};
            f.kind[1] = (spot){m, 1.0, part_m + over, 0.0};
            f.turn = (spot){-f.ny, f.nx, 0.0, 0.0}; /* n_F x n_f */
        }
        for (int32_t e = 2; e < (last ? 3 : more); e++) {
            if (!last) {
                spot p[PIECE], dry[PIECE];
                const int32_t v[3] = {at[0], at[e - 1], at[e]};
                int n = 3, left, cut, wet = 1;
                const double *const d =
                    list[k].sides ? g->within + (int64_t)list[k].side[0] * g->vertices : NULL;
                spot *rise = NULL; /* where it may have the largest s of all */
                for (int i = 0; i < 3; i++) {
                    const double s = g->R - g->h[v[i]];
                    p[i] = (spot){g->X[v[i]], g->Y[v[i]], s, d ? d[v[i]] : 0.0};
                    wet &= s > 0.0;
                    if (s > top[S]) rise = &top;
                }
                if (!wet) n = keep(p, 3, S, 0.0, dry, NULL, &left, &cut);
                if (n < 3) continue;
                spot *const r = wet ? p : dry;
                if (list[k].sides == 2) {
                    const fl_tread_side *const m[2] = {&g->side[list[k].side[0]], &g->side[list[k].side[1]]};
                    for (int below = 1; below >= 0; below--)
                        over_two(g, &f, below, m, r, n, &plain, &faded, rise, &pulls);
                } else {
                    const fl_tread_side *const m = list[k].sides ? &g->side[list[k].side[0]] : NULL;
                    for (int below = 1; below >= 0; below--)
                        over_one(g, &f, below, m, r, n, &plain, &faded, rise, &pulls);
                }
            }
            drain(&plain, 0, last, g, &all, &pulls);
            drain(&faded, 1, last, g, &all, &pulls);
        }
    }
    *sum = all;
    *pull = pulls;
    *most = top[S];
}

/* --- edges -----------------------------------------------------------------------------------------------
 */

/* Of four edges from (x, y) by (dx, dy), where the root of s goes from p to q: node z has the root r = p + (q
 * - p) z at z (r + p)/(q + p) of the length, as in strips.c. */
FL_WIDE_PART void along(const fl_wide at[2], const fl_wide by[2], const fl_wide root[2],
                        const fl_wide *factor, fl_tread_sums *sum)
{
    const fl_wide x = at[0], y = at[1], dx = by[0], dy = by[1], p = root[0], q = root[1];
    const fl_wide way = q - p, over = 1.0 / (p + q), share = 2.0 * *factor * over;
    for (int k = 0; k < FL_LINE_NODES; k++) {
        const double z = FL_LINE_NODE[k];
        const fl_wide r = p + way * z, far = z * (r + p) * over, s = r * r;
        const fl_wide c = FL_LINE_WEIGHT[k] * share * s * s * s, f = 4.5 * c * s, X = x + far * dx,
                      Y = y + far * dy, fx = f * X, fy = f * Y;
        sum->u += c * s * s, sum->du += f, sum->ddu += 15.75 * c;
        sum->f += f, sum->s += f * s, sum->x += fx, sum->y += fy;
        sum->xx += fx * X, sum->xy += fx * Y, sum->yy += fy * Y;
    }
}

FL_WIDE_VERSIONS void fl_tread_edges(const fl_tread *g, const fl_tread_edge *edge, const int32_t *list,
                                     int32_t count, fl_tread_sums *sum)
{
    fl_tread_sums all = *sum;
    for (int32_t from = 0; from < count; from += FL_LANES) {
        const fl_tread_edge *e[FL_LANES];
        const int32_t *at[FL_LANES];
        for (int l = 0; l < FL_LANES; l++) {
            e[l] = &edge[list[from + l < count ? from + l : from]];
            at[l] = e[l]->v;
        }
        const fl_wide x0 = FOUR_OF(g->X, at, 0), x1 = FOUR_OF(g->X, at, 1);
        const fl_wide y0 = FOUR_OF(g->Y, at, 0), y1 = FOUR_OF(g->Y, at, 1);
        const fl_wide h0 = FOUR_OF(g->h, at, 0), h1 = FOUR_OF(g->h, at, 1);
        fl_wide factor = {e[0]->factor, e[1]->factor, e[2]->factor, e[3]->factor}, p = g->R - h0,
                q = g->R - h1;
        for (int l = 0; l < FL_LANES; l++)
            if (from + l >= count) factor[l] = 0.0;
        for (int l = 0; l < FL_LANES; l++) p[l] = sqrt(p[l]);
        for (int l = 0; l < FL_LANES; l++) q[l] = sqrt(q[l]);
        along((const fl_wide[2]){x0, y0}, (const fl_wide[2]){x1 - x0, y1 - y0}, (const fl_wide[2]){p, q},
              &factor, &all);
    }
    *sum = all;
}

FL_WIDE_VERSIONS void fl_tread_pieces(const fl_tread *g, const fl_tread_edge *edge, const int32_t *list,
                                      const double *span, int32_t count, fl_tread_sums *sum)
{
    fl_tread_sums all = *sum;
    for (int32_t from = 0; from < count; from += FL_LANES) {
        const fl_tread_edge *e[FL_LANES];
        const int32_t *at[FL_LANES];
        fl_wide lo, hi;
        for (int l = 0; l < FL_LANES; l++) {
            const int32_t k = from + l < count ? from + l : from;
            e[l] = &edge[list[k]];
            at[l] = e[l]->v;
            lo[l] = span[2 * k], hi[l] = span[2 * k + 1];
        }
        const fl_wide x0 = FOUR_OF(g->X, at, 0), x1 = FOUR_OF(g->X, at, 1);
        const fl_wide y0 = FOUR_OF(g->Y, at, 0), y1 = FOUR_OF(g->Y, at, 1);
        const fl_wide h0 = FOUR_OF(g->h, at, 0), h1 = FOUR_OF(g->h, at, 1), dh = h1 - h0, zero = {0};
        fl_wide factor = {e[0]->factor, e[1]->factor, e[2]->factor, e[3]->factor};
        for (int l = 0; l < FL_LANES; l++)
            if (from + l >= count) factor[l] = 0.0;
        fl_wide p = LARGER(g->R - (h0 + lo * dh), zero), q = LARGER(g->R - (h0 + hi * dh), zero);
        for (int l = 0; l < FL_LANES; l++) p[l] = sqrt(p[l]);
        for (int l = 0; l < FL_LANES; l++) q[l] = sqrt(q[l]);
        const fl_wide dx = x1 - x0, dy = y1 - y0, part = hi - lo;
        const fl_wide all_of = factor * part;
        along((const fl_wide[2]){x0 + lo * dx, y0 + lo * dy}, (const fl_wide[2]){part * dx, part * dy},
              (const fl_wide[2]){p, q}, &all_of, &all);
    }
    *sum = all;
}
