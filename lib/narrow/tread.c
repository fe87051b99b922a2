/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/tread.h"
#include <math.h>
#include "narrow/roots.h"
#include "narrow/rules.h"

/* How far within side c and those after it, up to four. */
FL_WIDE_PART double *within(const fl_tread *g, int32_t c, int32_t v)
{
    return g->within + ((int64_t)(c / FL_LANES) * g->vertices + v) * FL_LANES + c % FL_LANES;
}

FL_WIDE_VERSIONS void fl_tread_survey(const fl_tread *g, const double *x)
{
    for (int32_t v = 0; v < g->vertices; v += FL_LANES) {
        const double *at = x + 3 * (int64_t)v;
        const fl_wide rx = *(const fl_wide *)at - g->o.x, ry = *(const fl_wide *)(at + FL_LANES) - g->o.y;
        const fl_wide rz = *(const fl_wide *)(at + 2 * FL_LANES) - g->o.z;
        const fl_wide X = g->x.x * rx + g->x.y * ry + g->x.z * rz,
                      Y = g->y.x * rx + g->y.y * ry + g->y.z * rz;
        fl_wide clear = INFINITY + 0.0 * X;
        for (int32_t c = 0; c < g->sides; c += FL_LANES) {
            fl_wide d[FL_LANES];
            FL_WIDE_UNROLL
            for (int l = 0; l < FL_LANES; l++) {
                const fl_tread_side s = g->side[c + l < g->sides ? c + l : c];
                d[l] = s.nx * (X - s.x) + s.ny * (Y - s.y);
                clear = FL_WIDE_CHOOSE(d[l] < clear, d[l], clear);
            }
            fl_wide_transpose(d);
            FL_WIDE_UNROLL
            for (int l = 0; l < FL_LANES; l++) FL_FOUR_INTO(within(g, c, v + l)) = d[l];
        }
        fl_wide all[FL_LANES] = {X, Y, g->n.x * rx + g->n.y * ry + g->n.z * rz, clear};
        fl_wide_transpose(all);
        FL_WIDE_UNROLL
        for (int l = 0; l < FL_LANES; l++) FL_FOUR_INTO(&g->vertex[v + l]) = all[l];
    }
}

/* Of a vertex, by lanes, or of four vertices. */
enum { X, Y, H, CLEAR };

/* Four vertices as they lie: what is known of each becomes a register. */
FL_WIDE_PART void look_up(const fl_tread *g, const int32_t v[FL_LANES], fl_wide out[FL_LANES])
{
    FL_WIDE_UNROLL
    for (int l = 0; l < FL_LANES; l++) out[l] = FL_FOUR(&g->vertex[v[l]]);
    fl_wide_transpose(out);
}

FL_WIDE_PART int any(const fl_wide_mask *m) { return ((*m)[0] | (*m)[1] | (*m)[2] | (*m)[3]) != 0; }

#define LARGER(a, b) FL_WIDE_CHOOSE((a) > (b), a, b)
#define SMALLER(a, b) FL_WIDE_CHOOSE((a) < (b), a, b)
#define SIZE(a) ((fl_wide)((fl_wide_mask)(a)&INT64_MAX))

/* The lanes that are before n. */
#define BEFORE(n) ((fl_wide_mask){0, 1, 2, 3} < (int64_t)(n))

/* --- what is where ---------------------------------------------------------------------------------------
 */

/* The sides of F that four faces, or what of F is above them, may be over. */
typedef struct {
    fl_wide_mask beyond,
        bad; /* one of them; more than two of them, or one that a corner is within a hair of */
    fl_wide_mask found, side[2];
} sides_over;

/*   at      their corners, by fours
 *   fx, fy  normals in the plane of F
 *   over    1/c */
FL_WIDE_PART void sides_of(const fl_tread *g, const int32_t *at, int32_t corners, const fl_wide *fx,
                           const fl_wide *fy, const fl_wide *c, const fl_wide *over, sides_over *out)
{
    const fl_wide zero = {0};
    const double hair = FL_TREAD_HAIR * g->rim;
    fl_wide sine = 1.0 - *c * *c;
    sine = LARGER(sine, zero);
    FL_WIDE_UNROLL
    for (int l = 0; l < FL_LANES; l++) sine[l] = sqrt(sine[l]);
    const fl_wide slack = g->R * *over * sine, away = -slack - hair, near = g->rim + slack + hair;
    *out = (sides_over){.found = {0}};
    for (int32_t i = 0; i < g->sides; i += FL_LANES) {
        fl_wide slope[FL_LANES], least[FL_LANES], most[FL_LANES], close[FL_LANES];
        FL_WIDE_UNROLL
        for (int l = 0; l < FL_LANES; l++) {
            const fl_tread_side m = g->side[i + l < g->sides ? i + l : i];
            slope[l] = (*fx * m.nx + *fy * m.ny) * *over;
            least[l] = close[l] = INFINITY + zero, most[l] = -least[l];
        }
        for (int32_t k = 0; k < corners; k++) {
            const int32_t *v = at + FL_LANES * k;
            const fl_wide h = {g->vertex[v[0]].h, g->vertex[v[1]].h, g->vertex[v[2]].h, g->vertex[v[3]].h};
            fl_wide in[FL_LANES];
            FL_WIDE_UNROLL
            for (int l = 0; l < FL_LANES; l++) in[l] = FL_FOUR(within(g, i, v[l]));
            fl_wide_transpose(in);
            FL_WIDE_UNROLL
            for (int l = 0; l < FL_LANES; l++) {
                const fl_wide above = SIZE(in[l] + slope[l] * h);
                least[l] = SMALLER(in[l], least[l]), most[l] = LARGER(in[l], most[l]);
                close[l] = SMALLER(above, close[l]);
            }
        }
        for (int l = 0; l < FL_LANES && i + l < g->sides; l++) {
            const fl_wide_mask is = least[l] <= near;
            out->beyond |= most[l] < away;
            if (!any(&is)) continue;
            out->bad |= is & ((close[l] < hair) | (out->found == 2));
            for (int64_t k = 0; k < 2; k++) {
                const fl_wide_mask here = is & (out->found == k);
                out->side[k] = (here & (int64_t)(i + l)) | (~here & out->side[k]);
            }
            out->found -= is;
        }
    }
}

FL_WIDE_VERSIONS int fl_tread_sort(const fl_tread *g, const fl_tread_tile *tile, const fl_tread_four *four,
                                   const int32_t *corner, int32_t count, fl_tread_sorted *out, uint8_t *is)
{
    enum { OVER = 2, WHOLE = 4 };
    const fl_wide zero = {0};
    const double R = g->R;
    fl_wide top = out->most + zero;
    int some_left = 0;
    for (int32_t from = 0; from < count; from += FL_LANES, four++) {
        const int32_t *at = corner + four->first;
        fl_wide low = INFINITY + zero, high = zero, clear = low;
        for (int32_t k = 0; k < four->most; k++) {
            fl_wide r[FL_LANES];
            look_up(g, at + FL_LANES * k, r);
            low = SMALLER(r[H], low), high = LARGER(r[H], high), clear = SMALLER(r[CLEAR], clear);
        }
        const fl_wide nx = FL_FOUR(four->n[0]), ny = FL_FOUR(four->n[1]), nz = FL_FOUR(four->n[2]);
        const fl_wide c = -(g->n.x * nx + g->n.y * ny + g->n.z * nz), in = clear - g->rim;
        const fl_wide_mask leave = low < 0.0;
        const fl_wide_mask over = ~leave & (low < R) & (c > 0.0) & (4.0 * c * c > 3.0);
        fl_wide_mask inside = (in > 0.0) & (c * c * in * in > (1.0 - c * c) * R * R);
        fl_wide_mask code = (leave & FL_TREAD_LEFT) | (over & OVER);
        const fl_wide_mask cut = over & ~inside;
        sides_over s;
        if (any(&cut)) {
            const fl_wide fx = g->x.x * nx + g->x.y * ny + g->x.z * nz,
                          fy = g->y.x * nx + g->y.y * ny + g->y.z * nz, each = 1.0 / c;
            sides_of(g, at, four->most, &fx, &fy, &c, &each, &s);
            s.found &= cut; /* over no side, where inside */
            code &= ~(cut & (s.beyond | s.bad));
            code |= cut & ~s.beyond & s.bad & FL_TREAD_LEFT;
        }
        inside &= over & (high < c * R);
        code |= inside & WHOLE;
        const fl_wide s_most = FL_WIDE_WHERE(inside, R - low);
        top = LARGER(s_most, top);
        const int32_t lanes = count - from < FL_LANES ? count - from : FL_LANES;
        for (int l = 0; l < lanes; l++) {
            const int what = (int)code[l];
            is[from + l] = (uint8_t)(what & FL_TREAD_LEFT);
            some_left |= what & FL_TREAD_LEFT;
            if (!(what & OVER)) continue;
            if (what & WHOLE && tile[from + l].n == 3) out->whole[out->wholes++] = from + l;
            else {
                fl_tread_cut *to = &out->cut[out->cuts++];
                to->tile = from + l, to->sides = 0;
                if (!cut[l]) continue;
                to->sides = (int32_t)s.found[l];
                to->side[0] = (int32_t)s.side[0][l], to->side[1] = (int32_t)s.side[1][l];
            }
        }
    }
    FL_WIDE_UNROLL
    for (int l = 0; l < FL_LANES; l++) out->most = top[l] > out->most ? top[l] : out->most;
    return some_left;
}

/* Leave of four edges what is within the sides of F: nothing, where lo is not less than hi.  unsure: a side
 * is too near an end to tell. */
FL_WIDE_PART void within_sides(const fl_tread *g, const int32_t *end, fl_wide *lo, fl_wide *hi,
                               fl_wide_mask *unsure)
{
    const double near = FL_TREAD_NEAR * g->rim;
    for (int32_t i = 0; i < g->sides; i += FL_LANES) {
        fl_wide d0[FL_LANES], d1[FL_LANES];
        FL_WIDE_UNROLL
        for (int l = 0; l < FL_LANES; l++)
            d0[l] = FL_FOUR(within(g, i, end[l])), d1[l] = FL_FOUR(within(g, i, end[FL_LANES + l]));
        fl_wide_transpose(d0);
        fl_wide_transpose(d1);
        FL_WIDE_UNROLL
        for (int l = 0; l < FL_LANES; l++) { /* what is behind the last is the same as another */
            const fl_wide a = d0[l], b = d1[l], at = a / (a - b);
            const fl_wide_mask in0 = a >= 0.0, in1 = b >= 0.0;
            *unsure |= (SIZE(a) < near) | (SIZE(b) < near);
            *lo = FL_WIDE_CHOOSE(~in0 & ~(at < *lo), at, *lo);
            *hi = FL_WIDE_CHOOSE(~in1 & ~(at > *hi), at, *hi);
            *hi = FL_WIDE_CHOOSE(in0 | in1, *hi, -1.0 + 0.0 * near * at);
        }
    }
}

FL_WIDE_VERSIONS int fl_tread_sort_edges(const fl_tread *g, const fl_tread_edge *edge, const int32_t *end,
                                         int32_t count, fl_tread_piece *out, int32_t *pieces, uint8_t *is)
{
    enum { PART = 2 };
    const fl_wide zero = {0}, one = 1.0 + zero;
    const double near = FL_TREAD_NEAR * g->rim, R = g->R;
    int some_left = 0;
    int32_t n = 0;
    for (int32_t from = 0; from < count; from += FL_LANES, end += 2 * FL_LANES) {
        fl_wide v0[FL_LANES], v1[FL_LANES];
        look_up(g, end, v0);
        look_up(g, end + FL_LANES, v1);
        const fl_wide s0 = R - v0[H], s1 = R - v1[H], zero_at = s0 / (s0 - s1);
        const fl_wide_mask wet0 = s0 > 0.0, wet1 = s1 > 0.0, over = (v0[H] >= 0.0) & (v1[H] >= 0.0);
        const fl_wide_mask some = over & (wet0 | wet1),
                           off = some & ~((v0[CLEAR] > near) & (v1[CLEAR] > near));
        fl_wide lo = FL_WIDE_WHERE(~wet0, zero_at), hi = FL_WIDE_CHOOSE(wet1, one, zero_at);
        fl_wide_mask unsure = {0};
        if (any(&off)) within_sides(g, end, &lo, &hi, &unsure);
        const fl_wide_mask code =
            ((~over | (some & unsure)) & FL_TREAD_LEFT) | (some & ~unsure & (lo < hi) & PART);
        const int32_t lanes = count - from < FL_LANES ? count - from : FL_LANES;
        for (int l = 0; l < lanes; l++) {
            const int what = (int)code[l];
            is[from + l] = (uint8_t)(what & FL_TREAD_LEFT);
            some_left |= what & FL_TREAD_LEFT;
            if (!(what & PART)) continue;
            out[n++] = (fl_tread_piece){{end[l], end[FL_LANES + l]}, edge[from + l].factor, lo[l], hi[l]};
        }
    }
    *pieces = n;
    return some_left;
}

/* --- whole triangles -------------------------------------------------------------------------------------
 */

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
        FL_WIDE_UNROLL
        for (int l = 0; l < FL_LANES; l++) {
            const fl_tread_tile *t = &tile[list[from + l < count ? from + l : from]];
            at[l] = corner + t->first;
            n[l] = &normal[t->f];
        }
        fl_wide v0[FL_LANES], v1[FL_LANES], v2[FL_LANES];
        look_up(g, (const int32_t[]){at[0][0], at[1][0], at[2][0], at[3][0]}, v0);
        look_up(g, (const int32_t[]){at[0][1], at[1][1], at[2][1], at[3][1]}, v1);
        look_up(g, (const int32_t[]){at[0][2], at[1][2], at[2][2], at[3][2]}, v2);
        const fl_wide x0 = v0[X], x1 = v1[X], x2 = v2[X], y0 = v0[Y], y1 = v1[Y], y2 = v2[Y];
        const fl_wide h0 = v0[H], h1 = v1[H], h2 = v2[H];
        const fl_wide nx = {n[0]->x, n[1]->x, n[2]->x, n[3]->x};
        const fl_wide ny = {n[0]->y, n[1]->y, n[2]->y, n[3]->y};
        const fl_wide nz = {n[0]->z, n[1]->z, n[2]->z, n[3]->z};
        const fl_wide c = -(g->n.x * nx + g->n.y * ny + g->n.z * nz), over = 1.0 / c;
        /* n_F x n_f along x and y */
        const fl_wide ax = -(g->y.x * nx + g->y.y * ny + g->y.z * nz),
                      ay = g->x.x * nx + g->x.y * ny + g->x.z * nz;
        const fl_wide root = 4.0 * c * c - 3.0, dm = 8.0 * c * root;
        fl_wide area = 0.5 * ((x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0));
        area = FL_WIDE_WHERE(BEFORE(count - from), SIZE(area));
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
    FL_WIDE_UNROLL
    for (int l = 0; l < FL_LANES; l++) {
        const int k = at + l < b->n ? at + l : at;
        a0[l] = b->corner[k][0], a1[l] = b->corner[k][1], a2[l] = b->corner[k][2];
        kind[l] = b->kind[k], turn[l] = b->turn[k];
    }
    fl_wide_transpose(a0), fl_wide_transpose(a1), fl_wide_transpose(a2);
    fl_wide_transpose(kind), fl_wide_transpose(turn);
    fl_wide area = 0.5 * ((a1[0] - a0[0]) * (a2[1] - a0[1]) - (a1[1] - a0[1]) * (a2[0] - a0[0]));
    area = FL_WIDE_WHERE(BEFORE(b->n - at), SIZE(area));
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
                const double *const d = list[k].sides ? within(g, list[k].side[0], 0) : NULL;
                spot *rise = NULL; /* where it may have the largest s of all */
                for (int i = 0; i < 3; i++) {
                    const fl_tread_vertex *a = &g->vertex[v[i]];
                    const double s = g->R - a->h;
                    p[i] = (spot){a->x, a->y, s, d ? d[FL_LANES * v[i]] : 0.0};
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

/* --- edges and corners -----------------------------------------------------------------------------------
 */

/* The place along the edge is linear in that along the length, so that three sums have the moments; that of
 * s^5 is the one of u. */
FL_WIDE_VERSIONS void fl_tread_pieces(const fl_tread *g, const fl_tread_piece *piece, int32_t count,
                                      fl_tread_sums *sum)
{
    const fl_wide zero = {0};
    const double R = g->R;
    fl_tread_sums all = *sum;
    for (int32_t from = 0; from < count; from += FL_LANES) {
        const fl_tread_piece *e[FL_LANES];
        fl_wide v0[FL_LANES], v1[FL_LANES], it[FL_LANES];
        FL_WIDE_UNROLL
        for (int l = 0; l < FL_LANES; l++) {
            e[l] = &piece[from + l < count ? from + l : from];
            v0[l] = FL_FOUR(&g->vertex[e[l]->v[0]]), v1[l] = FL_FOUR(&g->vertex[e[l]->v[1]]);
            it[l] = FL_FOUR(e[l]);
        }
        fl_wide_transpose(v0), fl_wide_transpose(v1), fl_wide_transpose(it);
        const fl_wide factor = FL_WIDE_WHERE(BEFORE(count - from), it[1]), lo = it[2], hi = it[3];
        const fl_wide h = v0[H], dh = v1[H] - h, s0 = R - (h + lo * dh), s1 = R - (h + hi * dh);
        fl_wide p = LARGER(s0, zero), q = LARGER(s1, zero);
        FL_WIDE_UNROLL
        for (int l = 0; l < FL_LANES; l++) p[l] = sqrt(p[l]);
        FL_WIDE_UNROLL
        for (int l = 0; l < FL_LANES; l++) q[l] = sqrt(q[l]);
        const fl_wide_mask some = p + q > 0.0;
        const fl_wide over = FL_WIDE_WHERE(some, 1.0 / (p + q)), part = hi - lo,
                      share = 2.0 * factor * part * over;
        fl_roots r;
        fl_roots_sum(&p, &q, &r);
        const fl_wide force = 4.5 * share, f = force * r.du, Dx = v1[X] - v0[X], Dy = v1[Y] - v0[Y];
        const fl_wide x = v0[X] + lo * Dx, y = v0[Y] + lo * Dy, dx = over * part * Dx, dy = over * part * Dy;
        const fl_wide f1 = force * r.first, f2 = force * r.second, fx = f * x + f1 * dx, fy = f * y + f1 * dy;
        const fl_wide gx = f1 * x + f2 * dx, gy = f1 * y + f2 * dy; /* of the force times far, x and far, y */
        all.u += share * r.u, all.du += f, all.ddu += 15.75 * share * r.ddu;
        all.f += f, all.s += force * r.u, all.x += fx, all.y += fy;
        all.xx += fx * x + gx * dx, all.xy += fx * y + gx * dy, all.yy += fy * y + gy * dy;
    }
    *sum = all;
}

FL_WIDE_VERSIONS void fl_tread_corners(const fl_tread *g, const fl_tread_corner *corner, const int32_t *list,
                                       int32_t count, fl_tread_sums *sum)
{
    fl_tread_sums all = *sum;
    for (int32_t from = 0; from < count; from += FL_LANES) {
        const fl_tread_corner *c[FL_LANES];
        fl_wide v[FL_LANES];
        FL_WIDE_UNROLL
        for (int l = 0; l < FL_LANES; l++) {
            c[l] = &corner[list[from + l < count ? from + l : from]];
            v[l] = FL_FOUR(&g->vertex[c[l]->v]);
        }
        fl_wide_transpose(v);
        const fl_wide each = {c[0]->factor, c[1]->factor, c[2]->factor, c[3]->factor};
        const fl_wide factor = FL_WIDE_WHERE(BEFORE(count - from), each);
        const fl_wide s = g->R - v[H], s3 = factor * (s * s * s), f = 5.0 * s3 * s;
        const fl_wide fx = f * v[X], fy = f * v[Y];
        all.u += s3 * s * s, all.du += f, all.ddu += 20.0 * s3;
        all.f += f, all.s += f * s, all.x += fx, all.y += fy;
        all.xx += fx * v[X], all.xy += fx * v[Y], all.yy += fy * v[Y];
    }
    *sum = all;
}
