/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/tread.h"
#include <math.h>
#include "narrow/powers.h"
#include "narrow/roots.h"

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
            for (int l = 0; l < FL_LANES; l++) FL_FOUR_INTO(fl_tread_within(g, c, v + l)) = d[l];
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
    sine = FL_WIDE_LARGER(sine, zero);
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
            for (int l = 0; l < FL_LANES; l++) in[l] = FL_FOUR(fl_tread_within(g, i, v[l]));
            fl_wide_transpose(in);
            FL_WIDE_UNROLL
            for (int l = 0; l < FL_LANES; l++) {
                const fl_wide above = FL_WIDE_SIZE(in[l] + slope[l] * h);
                least[l] = FL_WIDE_SMALLER(in[l], least[l]), most[l] = FL_WIDE_LARGER(in[l], most[l]);
                close[l] = FL_WIDE_SMALLER(above, close[l]);
            }
        }
        for (int l = 0; l < FL_LANES && i + l < g->sides; l++) {
            const fl_wide_mask is = least[l] <= near;
            out->beyond |= most[l] < away;
            if (!fl_wide_any(&is)) continue;
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
            low = FL_WIDE_SMALLER(r[H], low), high = FL_WIDE_LARGER(r[H], high),
            clear = FL_WIDE_SMALLER(r[CLEAR], clear);
        }
        const fl_wide nx = FL_FOUR(four->n[0]), ny = FL_FOUR(four->n[1]), nz = FL_FOUR(four->n[2]);
        const fl_wide c = -(g->n.x * nx + g->n.y * ny + g->n.z * nz), in = clear - g->rim;
        const fl_wide_mask leave = low < 0.0;
        const fl_wide_mask over = ~leave & (low < R) & (c > 0.0) & (4.0 * c * c > 3.0);
        fl_wide_mask inside = (in > 0.0) & (c * c * in * in > (1.0 - c * c) * R * R);
        fl_wide_mask code = (leave & FL_TREAD_LEFT) | (over & OVER);
        const fl_wide_mask cut = over & ~inside;
        sides_over s;
        if (fl_wide_any(&cut)) {
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
        top = FL_WIDE_LARGER(s_most, top);
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
            d0[l] = FL_FOUR(fl_tread_within(g, i, end[l])),
            d1[l] = FL_FOUR(fl_tread_within(g, i, end[FL_LANES + l]));
        fl_wide_transpose(d0);
        fl_wide_transpose(d1);
        FL_WIDE_UNROLL
        for (int l = 0; l < FL_LANES; l++) { /* what is behind the last is the same as another */
            const fl_wide a = d0[l], b = d1[l], at = a / (a - b);
            const fl_wide_mask in0 = a >= 0.0, in1 = b >= 0.0;
            *unsure |= (FL_WIDE_SIZE(a) < near) | (FL_WIDE_SIZE(b) < near);
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
        if (fl_wide_any(&off)) within_sides(g, end, &lo, &hi, &unsure);
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
        area = FL_WIDE_WHERE(FL_WIDE_BEFORE(count - from), FL_WIDE_SIZE(area));
        const fl_wide m = 0.5 * root * root, share = area * m, share_f = share * over;
        const fl_wide k3 = 4.0 * share, k3_f = 4.0 * share_f * over;
        const fl_wide s0 = R - h0, s1 = R - h1, s2 = R - h2, z0 = R - over * h0, z1 = R - over * h1,
                      z2 = R - over * h2;
        fl_powers p, r, both;
        fl_powers_mean t;
        fl_powers_of(&s0, &s1, &s2, &p);
        fl_powers_of(&z0, &z1, &z2, &r);
        both.a = k3 * p.a + k3_f * r.a, both.b = k3 * p.b + k3_f * r.b, both.c = k3 * p.c + k3_f * r.c;
        both.ab = k3 * p.ab + k3_f * r.ab, both.ac = k3 * p.ac + k3_f * r.ac;
        both.bc = k3 * p.bc + k3_f * r.bc;
        fl_powers_moments(&both, v0, v1, v2, &t);
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
        const fl_wide factor = FL_WIDE_WHERE(FL_WIDE_BEFORE(count - from), it[1]), lo = it[2], hi = it[3];
        const fl_wide h = v0[H], dh = v1[H] - h, s0 = R - (h + lo * dh), s1 = R - (h + hi * dh);
        fl_wide p = FL_WIDE_LARGER(s0, zero), q = FL_WIDE_LARGER(s1, zero);
        top = FL_WIDE_LARGER(FL_WIDE_LARGER(p, q), top);
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
        const fl_wide factor = FL_WIDE_WHERE(FL_WIDE_BEFORE(count - from), each);
        const fl_wide s = g->R - v[H], s3 = factor * (s * s * s), f = 5.0 * s3 * s;
        const fl_wide fx = f * v[X], fy = f * v[Y];
        top = FL_WIDE_LARGER(s, top);
        all.u += s3 * s * s, all.du += f, all.ddu += 20.0 * s3;
        all.f += f, all.s += f * s, all.x += fx, all.y += fy;
        all.xx += fx * v[X], all.xy += fx * v[Y], all.yy += fy * v[Y];
    }
    *sum = all;
    for (int l = 0; l < FL_LANES; l++) *most = top[l] > *most ? top[l] : *most;
}
