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

/* Means over a triangle with s = a, b, c at its corners, by their complete symmetric sums h_k of degree k,
 * in which no number is subtracted:
 *     mean s^k = 2 k!/(k+2)! h_k(a, b, c),   mean s^k l_a = 2 k!/(k+3)! h_k(a, b, c, a),
 *     mean s^k l_a l_b = 2 k!/(k+4)! h_k(a, b, c, a, b),
 * where l_a is the share of the first corner, and so on; h_k(.., b) = h_k(..) + b h_(k-1)(.., b).  Of s^2,
 * s^3 and s^4; and 60 and 420 times those of s^3 with one share and with two. */
typedef struct {
    fl_wide s2, s3, s4, a, b, c, ab, ac, bc;
} powers;

FL_WIDE_PART void powers_of(const fl_wide *s0, const fl_wide *s1, const fl_wide *s2, powers *out)
{
    const fl_wide a = *s0, b = *s1, c = *s2, a2 = a * a;
    const fl_wide e1 = a + b, e2 = a2 + b * e1, e3 = a2 * a + b * e2, e4 = a2 * a2 + b * e3;
    const fl_wide h1 = e1 + c, h2 = e2 + c * h1, h3 = e3 + c * h2, h4 = e4 + c * h3;
    const fl_wide a1 = h1 + a, a_2 = h2 + a * a1, b1 = h1 + b, b_2 = h2 + b * b1;
    out->s2 = h2 * (1.0 / 6.0), out->s3 = h3 * 0.1, out->s4 = h4 * (1.0 / 15.0);
    out->a = h3 + a * a_2, out->b = h3 + b * b_2, out->c = h3 + c * (h2 + c * (h1 + c));
    out->ab = out->a + b * (a_2 + b * (a1 + b)), out->ac = out->a + c * (a_2 + c * (a1 + c));
    out->bc = out->b + c * (b_2 + c * (b1 + c));
}

/* Means of s^3 times x, y, xx, xy and yy. */
typedef struct {
    fl_wide x, y, xx, xy, yy;
} moments;

/* sum w_i x_i^2 - sum w_ij (x_i - x_j)^2, with w_i the sum of all w_ij. */
FL_WIDE_PART void moments_of(const powers *k, const fl_wide *p, const fl_wide *q, const fl_wide *r,
                             moments *out)
{
    const double one = 1.0 / 60.0, two = 1.0 / 420.0;
    const fl_wide ax = k->a * p[X], bx = k->b * q[X], cx = k->c * r[X], ay = k->a * p[Y], by = k->b * q[Y],
                  cy = k->c * r[Y];
    const fl_wide Dx = p[X] - q[X], Ex = p[X] - r[X], Fx = q[X] - r[X], Dy = p[Y] - q[Y], Ey = p[Y] - r[Y],
                  Fy = q[Y] - r[Y];
    const fl_wide abx = k->ab * Dx, acx = k->ac * Ex, bcx = k->bc * Fx;
    out->x = one * (ax + bx + cx), out->y = one * (ay + by + cy);
    out->xx = one * (ax * p[X] + bx * q[X] + cx * r[X]) - two * (abx * Dx + acx * Ex + bcx * Fx);
    out->xy = one * (ax * p[Y] + bx * q[Y] + cx * r[Y]) - two * (abx * Dy + acx * Ey + bcx * Fy);
    out->yy = one * (ay * p[Y] + by * q[Y] + cy * r[Y]) -
              two * (k->ab * Dy * Dy + k->ac * Ey * Ey + k->bc * Fy * Fy);
}

FL_WIDE_VERSIONS void fl_tread_whole(const fl_tread *g, const fl_tread_tile *tile, const int32_t *corner,
                                     const fl_vec3 *normal, const int32_t *list, int32_t count,
                                     fl_tread_sums *sum)
{
    const double R = g->R;
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
        powers p, r, both;
        moments t;
        powers_of(&s0, &s1, &s2, &p);
        powers_of(&z0, &z1, &z2, &r);
        both.a = k3 * p.a + k3_f * r.a, both.b = k3 * p.b + k3_f * r.b, both.c = k3 * p.c + k3_f * r.c;
        both.ab = k3 * p.ab + k3_f * r.ab, both.ac = k3 * p.ac + k3_f * r.ac;
        both.bc = k3 * p.bc + k3_f * r.bc;
        moments_of(&both, v0, v1, v2, &t);
        const fl_wide u = share * p.s4, v = share_f * r.s4, du = 4.0 * share * p.s3,
                      dv = 4.0 * share_f * r.s3;
        all.u += u + v, all.du += du + dv, all.ddu += 12.0 * (share * p.s2 + share_f * r.s2);
        all.f += k3 * p.s3 + k3_f * r.s3, all.s += 4.0 * (u + over * v);
        all.x += t.x, all.y += t.y, all.xx += t.xx, all.xy += t.xy, all.yy += t.yy;
        /* over m: (dm + m/c) u; (dm - 4 m/c) v + (m R/c) dv */
        const fl_wide part = dm / m, turn = (part + over) * u + (part - 4.0 * over) * v + R * over * dv;
        all.couple[0] += ax * turn, all.couple[1] += ay * turn;
    }
    *sum = all;
}

/* --- faces that are cut ----------------------------------------------------------------------------------
 */

/* A corner of a piece of a face: x, y, s and a number that tells what counts of it. */
typedef fl_wide spot;
enum { S = 2, D = 3 };

/* A triangle that waits for its sums, and what it is of: it counts whole; where D >= 0 in it, which is so at
 * the first corner only, IN, or at the two others, OUT; the same where a side of F ends it, which pulls;
 * between D = 0 and D = rim, both of which part the first corner from the others, as much as D/rim, which
 * pulls; all of it as much as D/rim. */
enum { ALL, IN, OUT, IN_END, OUT_END, STRIP, FADED, QUEUES };

/* What one triangle may add to a queue: below it two wet ones, three of each over one of two sides, and four
 * of each of those where they are cut at both ends of the rim; above it one of each.  Many triangles wait, so
 * that hardly a register is not full. */
enum { ONE = 2 * 3 * 4 + 2 * 3, ROOM = 14 * FL_LANES };

/* kind: share for the area seen from F, force over du, and what u and du have of the couple along (turn[0],
 * turn[1]); turn[2] and turn[3]: the inward normal of the side. */
typedef struct {
    spot corner[3], kind, turn;
} entry;

typedef struct {
    entry of[ROOM];
    int n;
} queue;

/* pushes: what has come since they were drained. */
typedef struct {
    queue of[QUEUES];
    int pushes;
} queues;

/* Of a pull, by lanes. */
typedef struct {
    fl_wide f[3], m[3];
} pulls;

/* Sums over triangles: of s^4, s^3 and s^2, of s^3 times x, y, xx, xy, yy; of s^4 times 1, x, y, s without
 * the share D/rim. */
typedef struct {
    fl_wide u, du, ddu, x, y, xx, xy, yy, p, px, py, ps;
} heap;

#define ADD_NODE(t, weight, S_, X_, Y_)                                                                      \
    do {                                                                                                     \
        const fl_wide p2_ = (weight) * ((S_) * (S_)), p3_ = p2_ * (S_), fx_ = p3_ * (X_), fy_ = p3_ * (Y_);  \
        (t)->ddu += p2_, (t)->du += p3_, (t)->u += p3_ * (S_);                                               \
        (t)->x += fx_, (t)->y += fy_;                                                                        \
        (t)->xx += fx_ * (X_), (t)->xy += fx_ * (Y_), (t)->yy += fy_ * (Y_);                                 \
    } while (0)

#define AREA(a, b, c) (0.5 * (((b)[X] - (a)[X]) * ((c)[Y] - (a)[Y]) - ((b)[Y] - (a)[Y]) * ((c)[X] - (a)[X])))

FL_WIDE_PART void add_plain(heap *t, const fl_wide *p, const fl_wide *q, const fl_wide *r)
{
    const fl_wide turned = AREA(p, q, r), area = SIZE(turned);
    powers k;
    moments m;
    powers_of(&p[S], &q[S], &r[S], &k);
    moments_of(&k, p, q, r, &m);
    t->ddu += area * k.s2, t->du += area * k.s3, t->u += area * k.s4;
    t->x += area * m.x, t->y += area * m.y, t->xx += area * m.xx, t->xy += area * m.xy, t->yy += area * m.yy;
}

/* With shares at the corners that go from 0 to 1. */
FL_WIDE_PART void add_faded(heap *t, const fl_wide *a, const fl_wide *b, const fl_wide *c,
                            const fl_wide share[3])
{
    const fl_wide turned = AREA(a, b, c), area = SIZE(turned);
    for (int k = 0; k < FL_TRIANGLE_NODES; k++) {
        const double b0 = FL_TRIANGLE_NODE[k][0], b1 = FL_TRIANGLE_NODE[k][1], b2 = FL_TRIANGLE_NODE[k][2];
        const fl_wide x = b0 * a[X] + b1 * b[X] + b2 * c[X], y = b0 * a[Y] + b1 * b[Y] + b2 * c[Y];
        const fl_wide s = b0 * a[S] + b1 * b[S] + b2 * c[S], w = FL_TRIANGLE_WEIGHT[k] * area;
        const fl_wide v = w * (b0 * share[0] + b1 * share[1] + b2 * share[2]), all = w * ((s * s) * (s * s));
        ADD_NODE(t, v, s, x, y);
        t->p += all, t->px += all * x, t->py += all * y, t->ps += all * s;
    }
}

/* x, y and s at the share `at` of the way from a to b. */
FL_WIDE_PART void between(const fl_wide *a, const fl_wide *b, const fl_wide *at, fl_wide out[3])
{
    FL_WIDE_UNROLL
    for (int i = 0; i < 3; i++) out[i] = a[i] + *at * (b[i] - a[i]);
}

/* The side of F ends the part of F over f, along the line from a to b: s^4 for each length that it moves out
 * across n_f, where it is, n_f h/c from what is below it on f. */
FL_WIDE_PART void end(const fl_tread *g, const fl_wide *kind, const fl_wide *turn, const fl_wide *a,
                      const fl_wide *b, pulls *q)
{
    const fl_wide over = kind[1], nx = turn[1], ny = -turn[0], mx = turn[2], my = turn[3];
    const fl_wide slope = (nx * mx + ny * my) * over, gx = mx + slope * over * nx,
                  gy = my + slope * over * ny;
    const fl_wide dx = b[X] - a[X], dy = b[Y] - a[Y], s = a[S], z = b[S], s2 = s * s;
    fl_wide length = (dx * dx + dy * dy) / (gx * gx + gy * gy);
    FL_WIDE_UNROLL
    for (int l = 0; l < FL_LANES; l++) length[l] = sqrt(length[l]);
    const fl_wide all = kind[0] * length * (1.0 / 30.0);
    const fl_wide p = 6.0 * all * (s2 * s2 + z * (s2 * s + z * (s2 + z * (s + z)))),
                  far = all * (s2 * s2 + z * (2.0 * s2 * s + z * (3.0 * s2 + z * (4.0 * s + 5.0 * z))));
    const fl_wide x0 = a[X] + (g->R - s) * nx, y0 = a[Y] + (g->R - s) * ny;
    const fl_wide rx = p * x0 + far * (dx - (z - s) * nx), ry = p * y0 + far * (dy - (z - s) * ny);
    q->f[0] += p * mx, q->f[1] += p * my, q->f[2] += p * slope;
    q->m[0] += ry * slope, q->m[1] -= rx * slope, q->m[2] += rx * my - ry * mx;
}

/* *top: the largest s of all. */
#define RISE(top, a) (*(top) = LARGER((a)[S], *(top)))

/* Sum up four of a queue, from `at` on; what is beyond n counts for nothing.  The pull of a share d/rim is
 * s^4/rim for each of the area, at the height R - s. */
FL_WIDE_PART void take(const queue *b, int at, int what, const fl_tread *g, fl_tread_sums *q, pulls *pull,
                       fl_wide *top)
{
    const fl_wide zero = {0}, one = 1.0 + zero;
    fl_wide c0[FL_LANES], c1[FL_LANES], c2[FL_LANES], kind[FL_LANES], turn[FL_LANES];
    heap t = {zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero};
    FL_WIDE_UNROLL
    for (int l = 0; l < FL_LANES; l++) {
        const entry *e = &b->of[at + l < b->n ? at + l : at];
        c0[l] = e->corner[0], c1[l] = e->corner[1], c2[l] = e->corner[2], kind[l] = e->kind,
        turn[l] = e->turn;
    }
    fl_wide_transpose(c0), fl_wide_transpose(c1), fl_wide_transpose(c2);
    fl_wide_transpose(kind), fl_wide_transpose(turn);
    kind[0] = FL_WIDE_WHERE(BEFORE(b->n - at), kind[0]);
    if (what == ALL || what == FADED) {
        RISE(top, c0), RISE(top, c1), RISE(top, c2);
        if (what == ALL) add_plain(&t, c0, c1, c2);
        else {
            const double each = 1.0 / g->rim;
            add_faded(&t, c0, c1, c2, (const fl_wide[3]){each * c0[D], each * c1[D], each * c2[D]});
        }
    } else {
        const fl_wide one1 = 1.0 / (c0[D] - c1[D]), one2 = 1.0 / (c0[D] - c2[D]);
        const fl_wide t1 = c0[D] * one1, t2 = c0[D] * one2;
        fl_wide p[3], r[3];
        between(c0, c1, &t1, p), between(c0, c2, &t2, r);
        RISE(top, p), RISE(top, r);
        if (what == STRIP) {
            const fl_wide in = c0[D] - g->rim, t3 = in * one1, t4 = in * one2;
            fl_wide v[3], w[3];
            between(c0, c1, &t3, v), between(c0, c2, &t4, w);
            RISE(top, v), RISE(top, w);
            add_faded(&t, p, v, w, (const fl_wide[3]){zero, one, one});
            add_faded(&t, p, w, r, (const fl_wide[3]){zero, one, zero});
        } else if (what == IN || what == IN_END) {
            RISE(top, c0);
            add_plain(&t, c0, p, r);
        } else {
            RISE(top, c1), RISE(top, c2);
            add_plain(&t, p, c1, c2);
            add_plain(&t, p, c2, r);
        }
        if (what == IN_END || what == OUT_END) end(g, kind, turn, p, r, pull);
    }
    const fl_wide share = kind[0], gain = kind[1], force = 4.0 * share * gain, u = share * t.u,
                  du = 4.0 * share * t.du;
    q->u += u, q->du += du, q->ddu += 12.0 * share * t.ddu;
    q->f += force * t.du, q->s += 4.0 * gain * u, q->x += force * t.x, q->y += force * t.y;
    q->xx += force * t.xx, q->xy += force * t.xy, q->yy += force * t.yy;
    const fl_wide couple = kind[2] * u + kind[3] * du;
    q->couple[0] += turn[0] * couple, q->couple[1] += turn[1] * couple;
    if (what != STRIP && what != FADED) return;
    const double each = 1.0 / g->rim;
    const fl_wide nx = each * share * turn[2], ny = each * share * turn[3], ph = g->R * t.p - t.ps;
    pull->f[0] += nx * t.p, pull->f[1] += ny * t.p;
    pull->m[0] -= ph * ny, pull->m[1] += ph * nx, pull->m[2] += t.px * ny - t.py * nx;
}

/* Sum up what waits, four by four, and at the last all of it. */
FL_WIDE_PART void drain(queue *b, int what, int last, const fl_tread *g, fl_tread_sums *q, pulls *pull,
                        fl_wide *top)
{
    int i = 0;
    for (; i + FL_LANES <= b->n || (last && i < b->n); i += FL_LANES) take(b, i, what, g, q, pull, top);
    if (i == 0) return;
    b->n = b->n > i ? b->n - i : 0;
    for (int l = 0; l < b->n; l++) b->of[l] = b->of[i + l];
}

/* A face f as it is seen from F: its normal there, and 1/c. */
typedef struct {
    spot kind[2], turn; /* F over f, f over F */
    double nx, ny, over;
} facet;

FL_WIDE_PART void push(queues *to, int what, const spot *c0, const spot *c1, const spot *c2, const spot *kind,
                       const spot *turn)
{
    queue *const b = &to->of[what];
    entry *e = &b->of[b->n++];
    to->pushes++;
    e->corner[0] = *c0, e->corner[1] = *c1, e->corner[2] = *c2, e->kind = *kind, e->turn = *turn;
}

/* Which of three numbers are not negative, and which one is then not as the two others. */
FL_WIDE_PART int signs(double a, double b, double c)
{
    return (a >= 0.0) | (b >= 0.0) << 1 | (c >= 0.0) << 2;
}
static const int8_t ODD[8] = {0, 0, 1, 2, 2, 1, 0, 0}, NEXT[5] = {0, 1, 2, 0, 1};
#define ONLY_ONE(which) ((which) == 1 || (which) == 2 || (which) == 4)

/* Part the triangle p where g is 0 at the line between: its parts with g >= 0 into in, and the others into
 * out where that is not NULL, each at most two triangles. */
FL_WIDE_PART void cut(const spot p[3], const double g[3], spot (*in)[3], int *inside, spot (*out)[3],
                      int *outside)
{
    const int which = signs(g[0], g[1], g[2]), i = ODD[which], j = NEXT[i + 1], k = NEXT[i + 2];
    *inside = *outside = 0;
    if (which == 0 || which == 7) {
        spot(*to)[3] = which ? in : out;
        if (to) to[0][0] = p[0], to[0][1] = p[1], to[0][2] = p[2];
        *(which ? inside : outside) = 1;
        return;
    }
    const spot a = p[i], b = p[j], c = p[k];
    const spot v = a + g[i] / (g[i] - g[j]) * (b - a), w = a + g[i] / (g[i] - g[k]) * (c - a);
    const int only = ONLY_ONE(which);
    spot(*one)[3] = only ? in : out, (*two)[3] = only ? out : in;
    *(only ? inside : outside) = 1, *(only ? outside : inside) = 2;
    if (one) one[0][0] = a, one[0][1] = v, one[0][2] = w;
    if (two) two[0][0] = v, two[0][1] = b, two[0][2] = c, two[1][0] = v, two[1][1] = c, two[1][2] = w;
}

/* A triangle of f, s >= 0, with a share of it where D, how far it is within a side, is below rim. */
FL_WIDE_PART void fade(const fl_tread *g, const spot p[3], const spot *kind, const spot *turn, queues *to)
{
    const double rim = g->rim, d[3] = {p[0][D], p[1][D], p[2][D]},
                 e[3] = {d[0] - rim, d[1] - rim, d[2] - rim};
    const int which = signs(d[0], d[1], d[2]), deep = signs(e[0], e[1], e[2]);
    if (which == 0) return;
    if (deep == 7) {
        push(to, ALL, &p[0], &p[1], &p[2], kind, turn);
        return;
    }
    if (which == deep) { /* both lines go between the same corners */
        const int i = ODD[which], j = NEXT[i + 1], k = NEXT[i + 2];
        const spot less = {0.0, 0.0, 0.0, rim}, a = p[i] - less, b = p[j] - less, c = p[k] - less;
        push(to, ONLY_ONE(which) ? IN : OUT, &a, &b, &c, kind, turn);
        push(to, STRIP, &p[i], &p[j], &p[k], kind, turn);
        return;
    }
    spot over[2][3], in[2][3], out[2][3];
    int n, none, inside, outside;
    cut(p, d, over, &n, NULL, &none);
    for (int m = 0; m < n; m++) {
        const spot *r = over[m];
        cut(r, (const double[3]){r[0][D] - rim, r[1][D] - rim, r[2][D] - rim}, in, &inside, out, &outside);
        for (int k = 0; k < inside; k++) push(to, ALL, &in[k][0], &in[k][1], &in[k][2], kind, turn);
        for (int k = 0; k < outside; k++) push(to, FADED, &out[k][0], &out[k][1], &out[k][2], kind, turn);
    }
}

/* What has D >= 0: of F over f it ends at the side, where that is what D tells. */
FL_WIDE_PART void put(const spot p[3], int is_side, const spot *kind, const spot *turn, queues *to)
{
    const int which = signs(p[0][D], p[1][D], p[2][D]), i = ODD[which], j = NEXT[i + 1], k = NEXT[i + 2];
    if (which == 0) return;
    push(to, which == 7 ? ALL : (ONLY_ONE(which) ? IN : OUT) + (is_side ? IN_END - IN : 0), &p[i], &p[j],
         &p[k], kind, turn);
}

/* One way of a triangle p of f; D: how far it is within the first of the sides. */
FL_WIDE_PART void one_way(const fl_tread *g, const facet *f, int below, const fl_tread_side *const m[2],
                          int sides, const spot p[3], queues *to)
{
    const spot *kind = &f->kind[below];
    spot wet[2][3];
    int n, none;
    cut(p, (const double[3]){p[0][S], p[1][S], p[2][S]}, wet, &n, NULL, &none);
    for (int i = 0; i < n; i++) {
        if (sides == 1) {
            spot turn = f->turn;
            turn[2] = m[0]->nx, turn[3] = m[0]->ny;
            if (below) fade(g, wet[i], kind, &turn, to);
            else put(wet[i], 1, kind, &turn, to);
            continue;
        }
        /* over two sides it is parted where they are equally far, seen this way, and each part is over one */
        spot part[2][2][3];
        int parts[2];
        double e[3], far[3];
        for (int k = 0; k < 3; k++) {
            const spot x = wet[i][k];
            far[k] = m[1]->nx * (x[X] - m[1]->x) + m[1]->ny * (x[Y] - m[1]->y);
            if (!below) far[k] += (f->nx * m[1]->nx + f->ny * m[1]->ny) * (g->R - x[S]);
            e[k] = far[k] - x[D];
        }
        cut(wet[i], e, part[0], &parts[0], part[1], &parts[1]);
        for (int side = 0; side < 2; side++) {
            spot turn = f->turn;
            turn[2] = m[side]->nx, turn[3] = m[side]->ny;
            for (int k = 0; k < parts[side]; k++) {
                spot *const r = part[side][k];
                for (int v = 0; v < 3 && side; v++) {
                    r[v][D] = m[1]->nx * (r[v][X] - m[1]->x) + m[1]->ny * (r[v][Y] - m[1]->y);
                    if (!below) r[v][D] += (f->nx * m[1]->nx + f->ny * m[1]->ny) * (g->R - r[v][S]);
                }
                if (below) fade(g, r, kind, &turn, to);
                else put(r, 1, kind, &turn, to);
            }
        }
    }
}

/* Both ways. */
FL_WIDE_PART void both_ways(const fl_tread *g, const facet *f, const fl_tread_cut *c, const int32_t v[3],
                            queues *to)
{
    const fl_tread_side *const m[2] = {&g->side[c->sides ? c->side[0] : 0],
                                       &g->side[c->sides == 2 ? c->side[1] : 0]};
    const spot below = {1.0, 1.0, -1.0, 0.0}, above = {1.0, 1.0, -f->over, 0.0};
    spot p[3], q[3];
    if (c->sides == 0) { /* all that counts is s */
        const spot up = {0.0, 0.0, g->R, g->R};
        FL_WIDE_UNROLL
        for (int i = 0; i < 3; i++) {
            const spot a = FL_FOUR(&g->vertex[v[i]]), x = __builtin_shufflevector(a, a, X, Y, H, H);
            p[i] = x * __builtin_shufflevector(below, below, X, Y, H, H) + up;
            q[i] = x * __builtin_shufflevector(above, above, X, Y, H, H) + up;
        }
        put(p, 0, &f->kind[1], &f->turn, to);
        put(q, 0, &f->kind[0], &f->turn, to);
        return;
    }
    const double *const d = within(g, c->side[0], 0);
    const double slope = (f->nx * m[0]->nx + f->ny * m[0]->ny) * f->over;
    FL_WIDE_UNROLL
    for (int i = 0; i < 3; i++) {
        const spot a = FL_FOUR(&g->vertex[v[i]]);
        const double in = d[FL_LANES * v[i]];
        p[i] = a * below + (spot){0.0, 0.0, g->R, in};
        q[i] = a * above + (spot){0.0, 0.0, g->R, in + slope * g->vertex[v[i]].h};
    }
    one_way(g, f, 1, m, c->sides, p, to);
    one_way(g, f, 0, m, c->sides, q, to);
}

FL_WIDE_VERSIONS void fl_tread_parts(const fl_tread *g, const fl_tread_tile *tile, const int32_t *corner,
                                     const fl_vec3 *normal, const fl_tread_cut *list, int32_t count,
                                     fl_tread_sums *sum, fl_tread_pull *pull, double *most)
{
    queues to;
    const fl_wide zero = {0};
    fl_tread_sums all = *sum;
    pulls q = {{zero, zero, zero}, {zero, zero, zero}};
    fl_wide top = *most + zero;
    for (int k = 0; k < QUEUES; k++) to.of[k].n = 0;
    to.pushes = 0;
    for (int32_t k = 0; k <= count; k++) {
        const int last = k == count;
        const fl_tread_tile *t = &tile[list[last ? 0 : k].tile];
        const int32_t *at = corner + t->first, n = last ? 3 : t->n;
        facet f = {.over = 1.0};
        if (!last) {
            const fl_vec3 nf = normal[t->f];
            const double c = -v3_dot(g->n, nf), root = 4.0 * c * c - 3.0, over = 1.0 / c;
            const double m = 0.5 * root * root, part_m = 16.0 * c / root;
            f.nx = v3_dot(nf, g->x), f.ny = v3_dot(nf, g->y), f.over = over;
            f.kind[0] = (spot){m * over, over, part_m - 4.0 * over, g->R * over};
            f.kind[1] = (spot){m, 1.0, part_m + over, 0.0};
            f.turn = (spot){-f.ny, f.nx, 0.0, 0.0}; /* n_F x n_f */
        }
        for (int32_t e = 2; e < n; e++) {
            if (!last) both_ways(g, &f, &list[k], (const int32_t[3]){at[0], at[e - 1], at[e]}, &to);
            if (!last && to.pushes <= ROOM - FL_LANES - ONE) continue;
            to.pushes = 0;
            drain(&to.of[ALL], ALL, last, g, &all, &q, &top);
            drain(&to.of[IN], IN, last, g, &all, &q, &top);
            drain(&to.of[OUT], OUT, last, g, &all, &q, &top);
            drain(&to.of[IN_END], IN_END, last, g, &all, &q, &top);
            drain(&to.of[OUT_END], OUT_END, last, g, &all, &q, &top);
            drain(&to.of[STRIP], STRIP, last, g, &all, &q, &top);
            drain(&to.of[FADED], FADED, last, g, &all, &q, &top);
        }
    }
    *sum = all;
    pull->f = v3_add(pull->f, v3(fl_wide_sum(&q.f[0]), fl_wide_sum(&q.f[1]), fl_wide_sum(&q.f[2])));
    pull->m = v3_add(pull->m, v3(fl_wide_sum(&q.m[0]), fl_wide_sum(&q.m[1]), fl_wide_sum(&q.m[2])));
    for (int l = 0; l < FL_LANES; l++) *most = top[l] > *most ? top[l] : *most;
}

/* --- edges and corners -----------------------------------------------------------------------------------
 */

/* The place along the edge is linear in that along the length, so that three sums have the moments; that of
 * s^5 is the one of u. */
FL_WIDE_VERSIONS void fl_tread_pieces(const fl_tread *g, const fl_tread_piece *piece, int32_t count,
                                      fl_tread_sums *sum, double *most)
{
    const fl_wide zero = {0};
    const double R = g->R;
    fl_tread_sums all = *sum;
    fl_wide top = *most + zero;
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
        top = LARGER(LARGER(p, q), top);
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
    for (int l = 0; l < FL_LANES; l++) *most = top[l] > *most ? top[l] : *most;
}

FL_WIDE_VERSIONS void fl_tread_corners(const fl_tread *g, const fl_tread_corner *corner, const int32_t *list,
                                       int32_t count, fl_tread_sums *sum, double *most)
{
    fl_tread_sums all = *sum;
    fl_wide top = *most + (fl_wide){0};
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
        top = LARGER(s, top);
        all.u += s3 * s * s, all.du += f, all.ddu += 20.0 * s3;
        all.f += f, all.s += f * s, all.x += fx, all.y += fy;
        all.xx += fx * v[X], all.xy += fx * v[Y], all.yy += fy * v[Y];
    }
    *sum = all;
    for (int l = 0; l < FL_LANES; l++) *most = top[l] > *most ? top[l] : *most;
}
