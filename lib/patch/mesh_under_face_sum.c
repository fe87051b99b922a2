/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/mesh_under_face_sum.h"
#include <math.h>
#include "geom/quadrature_triangle.h"
#include "geom/quadrature_line.h"

FL_SIMD_VERSIONS void fl_under_face_project(const fl_under_face *g, const double *x)
{
    for (int32_t v = 0; v < g->vertices; v += FL_SIMD_WIDTH) {
        const double *at = x + 3 * (int64_t)v;
        const fl_simd rx = *(const fl_simd *)at - g->o.x,
                      ry = *(const fl_simd *)(at + FL_SIMD_WIDTH) - g->o.y;
        const fl_simd rz = *(const fl_simd *)(at + 2 * FL_SIMD_WIDTH) - g->o.z;
        const fl_simd X = g->x.x * rx + g->x.y * ry + g->x.z * rz,
                      Y = g->y.x * rx + g->y.y * ry + g->y.z * rz;
        fl_simd clear = INFINITY + 0.0 * X;
        for (int32_t c = 0; c < g->sides; c += FL_SIMD_WIDTH) {
            fl_simd d[FL_SIMD_WIDTH];
            FL_SIMD_UNROLL
            for (int l = 0; l < FL_SIMD_WIDTH; l++) {
                const fl_under_face_side s = g->side[c + l < g->sides ? c + l : c];
                d[l] = s.nx * (X - s.x) + s.ny * (Y - s.y);
                clear = FL_SIMD_SELECT(d[l] < clear, d[l], clear);
            }
            fl_simd_transpose(d);
            FL_SIMD_UNROLL
            for (int l = 0; l < FL_SIMD_WIDTH; l++) FL_SIMD_STORE(fl_under_face_inset(g, c, v + l)) = d[l];
        }
        fl_simd all[FL_SIMD_WIDTH] = {X, Y, g->n.x * rx + g->n.y * ry + g->n.z * rz, clear};
        fl_simd_transpose(all);
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) FL_SIMD_STORE(&g->vertex[v + l]) = all[l];
    }
}

/* Members of a vertex, by lanes; or of four vertices. */
enum { X, Y, H, CLEAR };

/* Loads four vertices and transposes them: each member becomes a register. */
FL_SIMD_INLINE void load_vertices(const fl_under_face *g, const int32_t v[FL_SIMD_WIDTH],
                                  fl_simd out[FL_SIMD_WIDTH])
{
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) out[l] = FL_SIMD_LOAD(&g->vertex[v[l]]);
    fl_simd_transpose(out);
}

/* --- sorting -------------------------------------------------------------------------------------------- */

/* The sides of F that four facets, or the parts of F above them, may lie over. */
typedef struct {
    /* entirely outside one side; over more than two sides, or with a corner within rounding of one */
    fl_simd_mask beyond, bad;
    fl_simd_mask found, side[2];
} side_search;

/* For four facets.
 *     at      their corners, by fours
 *     fx, fy  their normals in the plane of F
 *     over    1/c */
FL_SIMD_INLINE void find_sides(const fl_under_face *g, const int32_t *at, int32_t corners, const fl_simd *fx,
                               const fl_simd *fy, const fl_simd *c, const fl_simd *over, side_search *out)
{
    const fl_simd zero = {0};
    const double tol = FL_UNDER_FACE_TOL * g->rim;
    fl_simd sine = 1.0 - *c * *c;
    sine = FL_SIMD_MAX(sine, zero);
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) sine[l] = sqrt(sine[l]);
    const fl_simd slack = g->R * *over * sine, away = -slack - tol, near = g->rim + slack + tol;
    *out = (side_search){.found = {0}};
    for (int32_t i = 0; i < g->sides; i += FL_SIMD_WIDTH) {
        fl_simd slope[FL_SIMD_WIDTH], least[FL_SIMD_WIDTH], most[FL_SIMD_WIDTH], close[FL_SIMD_WIDTH];
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) {
            const fl_under_face_side m = g->side[i + l < g->sides ? i + l : i];
            slope[l] = (*fx * m.nx + *fy * m.ny) * *over;
            least[l] = close[l] = INFINITY + zero, most[l] = -least[l];
        }
        for (int32_t k = 0; k < corners; k++) {
            const int32_t *v = at + FL_SIMD_WIDTH * k;
            const fl_simd h = {g->vertex[v[0]].h, g->vertex[v[1]].h, g->vertex[v[2]].h, g->vertex[v[3]].h};
            fl_simd in[FL_SIMD_WIDTH];
            FL_SIMD_UNROLL
            for (int l = 0; l < FL_SIMD_WIDTH; l++) in[l] = FL_SIMD_LOAD(fl_under_face_inset(g, i, v[l]));
            fl_simd_transpose(in);
            FL_SIMD_UNROLL
            for (int l = 0; l < FL_SIMD_WIDTH; l++) {
                const fl_simd above = FL_SIMD_ABS(in[l] + slope[l] * h);
                least[l] = FL_SIMD_MIN(in[l], least[l]), most[l] = FL_SIMD_MAX(in[l], most[l]);
                close[l] = FL_SIMD_MIN(above, close[l]);
            }
        }
        for (int l = 0; l < FL_SIMD_WIDTH && i + l < g->sides; l++) {
            const fl_simd_mask over_side = least[l] <= near;
            out->beyond |= most[l] < away;
            if (!fl_simd_any(&over_side)) continue;
            out->bad |= over_side & ((close[l] < tol) | (out->found == 2));
            for (int64_t k = 0; k < 2; k++) {
                const fl_simd_mask here = over_side & (out->found == k);
                out->side[k] = (here & (int64_t)(i + l)) | (~here & out->side[k]);
            }
            out->found -= over_side;
        }
    }
}

FL_SIMD_VERSIONS int fl_under_face_sort(const fl_under_face *g, const fl_under_face_facet *facet,
                                        const fl_under_face_facet_four *four, const int32_t *corner,
                                        int32_t count, fl_under_face_sorted *out, uint8_t *status)
{
    enum { OVER = 2, WHOLE = 4 };
    const fl_simd zero = {0};
    const double R = g->R;
    fl_simd top = out->most + zero;
    int some_left = 0;
    for (int32_t from = 0; from < count; from += FL_SIMD_WIDTH, four++) {
        const int32_t *at = corner + four->first;
        fl_simd low = INFINITY + zero, high = zero, clear = low;
        for (int32_t k = 0; k < four->most; k++) {
            fl_simd r[FL_SIMD_WIDTH];
            load_vertices(g, at + FL_SIMD_WIDTH * k, r);
            low = FL_SIMD_MIN(r[H], low), high = FL_SIMD_MAX(r[H], high),
            clear = FL_SIMD_MIN(r[CLEAR], clear);
        }
        const fl_simd nx = FL_SIMD_LOAD(four->n[0]), ny = FL_SIMD_LOAD(four->n[1]),
                      nz = FL_SIMD_LOAD(four->n[2]);
        const fl_simd c = -(g->n.x * nx + g->n.y * ny + g->n.z * nz), in = clear - g->rim;
        const fl_simd_mask skip = low < 0.0;
        const fl_simd_mask over = ~skip & (low < R) & (c > 0.0) & (4.0 * c * c > 3.0);
        fl_simd_mask inside = (in > 0.0) & (c * c * in * in > (1.0 - c * c) * R * R);
        fl_simd_mask code = (skip & FL_UNDER_FACE_SKIPPED) | (over & OVER);
        const fl_simd_mask cut = over & ~inside;
        side_search s;
        if (fl_simd_any(&cut)) {
            const fl_simd fx = g->x.x * nx + g->x.y * ny + g->x.z * nz,
                          fy = g->y.x * nx + g->y.y * ny + g->y.z * nz, each = 1.0 / c;
            find_sides(g, at, four->most, &fx, &fy, &c, &each, &s);
            s.found &= cut; /* none where inside */
            code &= ~(cut & (s.beyond | s.bad));
            code |= cut & ~s.beyond & s.bad & FL_UNDER_FACE_SKIPPED;
        }
        inside &= over & (high < c * R);
        code |= inside & WHOLE;
        const fl_simd s_most = FL_SIMD_MASKED(inside, R - low);
        top = FL_SIMD_MAX(s_most, top);
        const int32_t lanes = count - from < FL_SIMD_WIDTH ? count - from : FL_SIMD_WIDTH;
        for (int l = 0; l < lanes; l++) {
            const int what = (int)code[l];
            status[from + l] = (uint8_t)(what & FL_UNDER_FACE_SKIPPED);
            some_left |= what & FL_UNDER_FACE_SKIPPED;
            if (!(what & OVER)) continue;
            if (what & WHOLE && facet[from + l].n == 3) out->whole[out->wholes++] = from + l;
            else {
                fl_under_face_cut *to = &out->cut[out->cuts++];
                to->facet = from + l, to->sides = 0;
                if (!cut[l]) continue;
                to->sides = (int32_t)s.found[l];
                to->side[0] = (int32_t)s.side[0][l], to->side[1] = (int32_t)s.side[1][l];
            }
        }
    }
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) out->most = top[l] > out->most ? top[l] : out->most;
    return some_left;
}

/* Clips four edges to the inside of F; nothing is left where lo >= hi.  unsure: an end is too near to a side.
 */
FL_SIMD_INLINE void clip_to_sides(const fl_under_face *g, const int32_t *end, fl_simd *lo, fl_simd *hi,
                                  fl_simd_mask *unsure)
{
    const double near = FL_UNDER_FACE_EDGE_TOL * g->rim;
    for (int32_t i = 0; i < g->sides; i += FL_SIMD_WIDTH) {
        fl_simd d0[FL_SIMD_WIDTH], d1[FL_SIMD_WIDTH];
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++)
            d0[l] = FL_SIMD_LOAD(fl_under_face_inset(g, i, end[l])),
            d1[l] = FL_SIMD_LOAD(fl_under_face_inset(g, i, end[FL_SIMD_WIDTH + l]));
        fl_simd_transpose(d0);
        fl_simd_transpose(d1);
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) { /* sides behind the last repeat another */
            const fl_simd a = d0[l], b = d1[l], at = a / (a - b);
            const fl_simd_mask in0 = a >= 0.0, in1 = b >= 0.0;
            *unsure |= (FL_SIMD_ABS(a) < near) | (FL_SIMD_ABS(b) < near);
            *lo = FL_SIMD_SELECT(~in0 & ~(at < *lo), at, *lo);
            *hi = FL_SIMD_SELECT(~in1 & ~(at > *hi), at, *hi);
            *hi = FL_SIMD_SELECT(in0 | in1, *hi, -1.0 + 0.0 * near * at);
        }
    }
}

FL_SIMD_VERSIONS int fl_under_face_sort_edges(const fl_under_face *g, const fl_under_face_edge *edge,
                                              const int32_t *end, int32_t count, fl_under_face_edge_part *out,
                                              int32_t *parts, uint8_t *status)
{
    enum { PART = 2 };
    const fl_simd zero = {0}, one = 1.0 + zero;
    const double near = FL_UNDER_FACE_EDGE_TOL * g->rim, R = g->R;
    int some_left = 0;
    int32_t n = 0;
    for (int32_t from = 0; from < count; from += FL_SIMD_WIDTH, end += 2 * FL_SIMD_WIDTH) {
        fl_simd v0[FL_SIMD_WIDTH], v1[FL_SIMD_WIDTH];
        load_vertices(g, end, v0);
        load_vertices(g, end + FL_SIMD_WIDTH, v1);
        const fl_simd s0 = R - v0[H], s1 = R - v1[H], zero_at = s0 / (s0 - s1);
        const fl_simd_mask in_reach0 = s0 > 0.0, in_reach1 = s1 > 0.0, over = (v0[H] >= 0.0) & (v1[H] >= 0.0);
        const fl_simd_mask some = over & (in_reach0 | in_reach1),
                           off = some & ~((v0[CLEAR] > near) & (v1[CLEAR] > near));
        fl_simd lo = FL_SIMD_MASKED(~in_reach0, zero_at), hi = FL_SIMD_SELECT(in_reach1, one, zero_at);
        fl_simd_mask unsure = {0};
        if (fl_simd_any(&off)) clip_to_sides(g, end, &lo, &hi, &unsure);
        const fl_simd_mask code =
            ((~over | (some & unsure)) & FL_UNDER_FACE_SKIPPED) | (some & ~unsure & (lo < hi) & PART);
        const int32_t lanes = count - from < FL_SIMD_WIDTH ? count - from : FL_SIMD_WIDTH;
        for (int l = 0; l < lanes; l++) {
            const int what = (int)code[l];
            status[from + l] = (uint8_t)(what & FL_UNDER_FACE_SKIPPED);
            some_left |= what & FL_UNDER_FACE_SKIPPED;
            if (!(what & PART)) continue;
            out[n++] = (fl_under_face_edge_part){
                {end[l], end[FL_SIMD_WIDTH + l]}, edge[from + l].factor, lo[l], hi[l]};
        }
    }
    *parts = n;
    return some_left;
}

/* --- whole triangles ----------------------------------------------------------------------------------- */

FL_SIMD_VERSIONS void fl_under_face_sum_whole(const fl_under_face *g, const fl_under_face_facet *facet,
                                              const int32_t *corner, const fl_vec3 *normal,
                                              const int32_t *list, int32_t count, fl_under_face_sums *sum)
{
    const double R = g->R;
    fl_under_face_sums all = *sum;
    for (int32_t from = 0; from < count; from += FL_SIMD_WIDTH) {
        const int32_t *at[FL_SIMD_WIDTH];
        const fl_vec3 *n[FL_SIMD_WIDTH];
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) {
            const fl_under_face_facet *t = &facet[list[from + l < count ? from + l : from]];
            at[l] = corner + t->first;
            n[l] = &normal[t->f];
        }
        fl_simd v0[FL_SIMD_WIDTH], v1[FL_SIMD_WIDTH], v2[FL_SIMD_WIDTH];
        load_vertices(g, (const int32_t[]){at[0][0], at[1][0], at[2][0], at[3][0]}, v0);
        load_vertices(g, (const int32_t[]){at[0][1], at[1][1], at[2][1], at[3][1]}, v1);
        load_vertices(g, (const int32_t[]){at[0][2], at[1][2], at[2][2], at[3][2]}, v2);
        const fl_simd x0 = v0[X], x1 = v1[X], x2 = v2[X], y0 = v0[Y], y1 = v1[Y], y2 = v2[Y];
        const fl_simd h0 = v0[H], h1 = v1[H], h2 = v2[H];
        const fl_simd nx = {n[0]->x, n[1]->x, n[2]->x, n[3]->x};
        const fl_simd ny = {n[0]->y, n[1]->y, n[2]->y, n[3]->y};
        const fl_simd nz = {n[0]->z, n[1]->z, n[2]->z, n[3]->z};
        const fl_simd c = -(g->n.x * nx + g->n.y * ny + g->n.z * nz), over = 1.0 / c;
        /* n_F x n_f along x and y */
        const fl_simd ax = -(g->y.x * nx + g->y.y * ny + g->y.z * nz),
                      ay = g->x.x * nx + g->x.y * ny + g->x.z * nz;
        const fl_simd root = 4.0 * c * c - 3.0, dm = 8.0 * c * root;
        fl_simd area = 0.5 * ((x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0));
        area = FL_SIMD_MASKED(FL_SIMD_MASK_BELOW(count - from), FL_SIMD_ABS(area));
        const fl_simd m = 0.5 * root * root, share = area * m, share_f = share * over;
        const fl_simd k3 = 4.0 * share, k3_f = 4.0 * share_f * over;
        const fl_simd s0 = R - h0, s1 = R - h1, s2 = R - h2, z0 = R - over * h0, z1 = R - over * h1,
                      z2 = R - over * h2;
        fl_triangle_means p, r, both;
        fl_triangle_moments t;
        fl_triangle_means_of(&s0, &s1, &s2, &p);
        fl_triangle_means_of(&z0, &z1, &z2, &r);
        both.a = k3 * p.a + k3_f * r.a, both.b = k3 * p.b + k3_f * r.b, both.c = k3 * p.c + k3_f * r.c;
        both.ab = k3 * p.ab + k3_f * r.ab, both.ac = k3 * p.ac + k3_f * r.ac;
        both.bc = k3 * p.bc + k3_f * r.bc;
        fl_triangle_moments_of(&both, v0, v1, v2, &t);
        const fl_simd u = share * p.s4, v = share_f * r.s4, du = 4.0 * share * p.s3,
                      dv = 4.0 * share_f * r.s3;
        all.u += u + v, all.du += du + dv, all.ddu += 12.0 * (share * p.s2 + share_f * r.s2);
        all.f += k3 * p.s3 + k3_f * r.s3, all.s += 4.0 * (u + over * v);
        all.x += t.x, all.y += t.y, all.xx += t.xx, all.xy += t.xy, all.yy += t.yy;
        /* divided by m: (dm + m/c) u; (dm - 4 m/c) v + (m R/c) dv */
        const fl_simd part = dm / m, turn = (part + over) * u + (part - 4.0 * over) * v + R * over * dv;
        all.couple[0] += ax * turn, all.couple[1] += ay * turn;
    }
    *sum = all;
}

/* --- edges and corners ---------------------------------------------------------------------------------- */

/* x and y are linear along the edge, so three sums have the moments; that of s^5 is the one of u. */
FL_SIMD_VERSIONS void fl_under_face_sum_edges(const fl_under_face *g, const fl_under_face_edge_part *part,
                                              int32_t count, fl_under_face_sums *sum, double *most)
{
    const fl_simd zero = {0};
    const double R = g->R;
    fl_under_face_sums all = *sum;
    fl_simd top = *most + zero;
    for (int32_t from = 0; from < count; from += FL_SIMD_WIDTH) {
        const fl_under_face_edge_part *e[FL_SIMD_WIDTH];
        fl_simd v0[FL_SIMD_WIDTH], v1[FL_SIMD_WIDTH], it[FL_SIMD_WIDTH];
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) {
            e[l] = &part[from + l < count ? from + l : from];
            v0[l] = FL_SIMD_LOAD(&g->vertex[e[l]->v[0]]), v1[l] = FL_SIMD_LOAD(&g->vertex[e[l]->v[1]]);
            it[l] = FL_SIMD_LOAD(e[l]);
        }
        fl_simd_transpose(v0), fl_simd_transpose(v1), fl_simd_transpose(it);
        const fl_simd factor = FL_SIMD_MASKED(FL_SIMD_MASK_BELOW(count - from), it[1]), lo = it[2],
                      hi = it[3];
        const fl_simd h = v0[H], dh = v1[H] - h, s0 = R - (h + lo * dh), s1 = R - (h + hi * dh);
        fl_simd p = FL_SIMD_MAX(s0, zero), q = FL_SIMD_MAX(s1, zero);
        top = FL_SIMD_MAX(FL_SIMD_MAX(p, q), top);
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) p[l] = sqrt(p[l]);
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) q[l] = sqrt(q[l]);
        const fl_simd_mask some = p + q > 0.0;
        const fl_simd over = FL_SIMD_MASKED(some, 1.0 / (p + q)), length = hi - lo,
                      share = 2.0 * factor * length * over;
        fl_line_integrals r;
        fl_line_integrate(&p, &q, &r);
        const fl_simd force = 4.5 * share, f = force * r.du, Dx = v1[X] - v0[X], Dy = v1[Y] - v0[Y];
        const fl_simd x = v0[X] + lo * Dx, y = v0[Y] + lo * Dy;
        const fl_simd dx = over * length * Dx, dy = over * length * Dy;
        const fl_simd f1 = force * r.first, f2 = force * r.second, fx = f * x + f1 * dx, fy = f * y + f1 * dy;
        /* of the force times the position along the edge, times x and y */
        const fl_simd gx = f1 * x + f2 * dx, gy = f1 * y + f2 * dy;
        all.u += share * r.u, all.du += f, all.ddu += 15.75 * share * r.ddu;
        all.f += f, all.s += force * r.u, all.x += fx, all.y += fy;
        all.xx += fx * x + gx * dx, all.xy += fx * y + gx * dy, all.yy += fy * y + gy * dy;
    }
    *sum = all;
    for (int l = 0; l < FL_SIMD_WIDTH; l++) *most = top[l] > *most ? top[l] : *most;
}

FL_SIMD_VERSIONS void fl_under_face_sum_corners(const fl_under_face *g, const fl_under_face_corner *corner,
                                                const int32_t *list, int32_t count, fl_under_face_sums *sum,
                                                double *most)
{
    fl_under_face_sums all = *sum;
    fl_simd top = *most + (fl_simd){0};
    for (int32_t from = 0; from < count; from += FL_SIMD_WIDTH) {
        const fl_under_face_corner *c[FL_SIMD_WIDTH];
        fl_simd v[FL_SIMD_WIDTH];
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) {
            c[l] = &corner[list[from + l < count ? from + l : from]];
            v[l] = FL_SIMD_LOAD(&g->vertex[c[l]->v]);
        }
        fl_simd_transpose(v);
        const fl_simd each = {c[0]->factor, c[1]->factor, c[2]->factor, c[3]->factor};
        const fl_simd factor = FL_SIMD_MASKED(FL_SIMD_MASK_BELOW(count - from), each);
        const fl_simd s = g->R - v[H], s3 = factor * (s * s * s), f = 5.0 * s3 * s;
        const fl_simd fx = f * v[X], fy = f * v[Y];
        top = FL_SIMD_MAX(s, top);
        all.u += s3 * s * s, all.du += f, all.ddu += 20.0 * s3;
        all.f += f, all.s += f * s, all.x += fx, all.y += fy;
        all.xx += fx * v[X], all.xy += fx * v[Y], all.yy += fy * v[Y];
    }
    *sum = all;
    for (int l = 0; l < FL_SIMD_WIDTH; l++) *most = top[l] > *most ? top[l] : *most;
}
