/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/mem.h"
#include "base/wide.h"
#include "narrow/areas.h"
#include "narrow/matches.h"
#include "narrow/strips.h"

/* Rows of heights, `columns` each, a multiple of FL_LANES, of points x, y, z.  What lies on a plane is taken
 * as a hair aside, for all who ask to the same side. */
FL_WIDE_VERSIONS static void heights(const fl_cut *cut, int32_t rows, const double *x, const double *y,
                                     const double *z, int32_t columns, double *h)
{
    for (int32_t k = 0; k < rows; k++) {
        const fl_cut p = cut[k];
        const double hair = 1e-300 * (0.5772156649 * p.g.x + 0.4342944819 * p.g.y + 0.6931471806 * p.g.z);
        for (int32_t v = 0; v < columns; v += FL_LANES) {
            const fl_wide X = *(const fl_wide *)(x + v), Y = *(const fl_wide *)(y + v);
            const fl_wide Z = *(const fl_wide *)(z + v);
            *(fl_wide *)(h + (int64_t)k * columns + v) = (p.g.x * X + p.g.y * Y + p.g.z * Z - p.c) + hair;
        }
    }
}

/* A table that is filled. */
typedef struct {
    const double *h;
    int32_t columns;
} filled;

/* way 0: vertices of A as they are, entered, over planes of B; 1: those of B, in the frame of A, over planes
 * of A. */
static int fill(fl_places *w, const fl_table *t, int way, const fl_vec3 *own, filled *out)
{
    fl_sheet *s = &w->sheet[way];
    const int32_t columns = (t->vertices + FL_LANES - 1) / FL_LANES * FL_LANES;
    fl_err lost = {0};
    if (fl_grow(&s->x, &s->x_cap, 3 * (int64_t)columns, sizeof *s->x, &lost) ||
        fl_grow(&s->h, &s->h_cap, (int64_t)t->cuts * columns, sizeof *s->h, &lost))
        return -1;
    double *x = s->x, *y = x + columns, *z = y + columns;
    for (int32_t k = 0; k < columns; k += FL_LANES) {
        fl_vec3 v[FL_LANES];
        for (int l = 0; l < FL_LANES; l++) {
            const fl_vec3 r = own[t->vertex[k + l < t->vertices ? k + l : k]];
            v[l] = way ? m3_tmul(w->M, v3_sub(r, w->o)) : r;
        }
        *(fl_wide *)(x + k) = (fl_wide){v[0].x, v[1].x, v[2].x, v[3].x};
        *(fl_wide *)(y + k) = (fl_wide){v[0].y, v[1].y, v[2].y, v[3].y};
        *(fl_wide *)(z + k) = (fl_wide){v[0].z, v[1].z, v[2].z, v[3].z};
    }
    heights(t->cut, t->cuts, x, y, z, columns, s->h);
    *out = (filled){s->h, columns};
    return 0;
}

/* Everything that a match needs. */
typedef struct {
    fl_places *w;
    const fl_matches *l;
    const fl_side *own, *other;
    const double *h; /* of this way */
    int32_t columns;
    double R, behind, rim;
} meeting;

/* A vertex lies beyond all the sides. */
static int beyond_all(const meeting *q, const fl_match *m)
{
    const int32_t *side = q->l->side + m->first;
    for (int32_t k = 0; k < m->n; k++) {
        const double h = q->h[(side[k] >> 1) * q->columns + m->v[0]];
        if (side[k] & 1 ? h > 0.0 : h < 0.0) return 0;
    }
    return 1;
}

/* Keep of an edge what lies beyond all the sides. */
static int keep_beyond(const meeting *q, const fl_match *m, fl_span *t)
{
    const int32_t *side = q->l->side + m->first;
    for (int32_t k = 0; k < m->n; k++) {
        const double *h = q->h + (side[k] >> 1) * q->columns;
        const double h0 = h[m->v[0]], h1 = h[m->v[1]];
        if (!(side[k] & 1 ? fl_span_keep(t, -h0, -h1) : fl_span_keep(t, h0, h1))) return 0;
    }
    return 1;
}

/* Vertex at r from the nearest point of an edge or a vertex. */
static int vertex_at(const meeting *q, const fl_match *m, fl_vec3 r)
{
    const double d = v3_norm(r);
    if (d >= q->R || d <= FL_SPAN_SAME * q->other->p->size) return 0;
    return fl_places_vertex(q->w, q->own, q->other->r, m->own, v3_scale(1.0 / d, r), q->R - d);
}

static int vertex(const meeting *q, const fl_match *m)
{
    const fl_poly *p = q->other->p;
    if (m->kind == FL_MATCH_VERTEX_FACE) {
        const double h = q->h[m->height * q->columns + m->v[0]];
        if (h >= q->R || h < -FL_SPAN_SAME * p->size || !beyond_all(q, m)) return 0;
        return fl_places_vertex(q->w, q->own, q->other->r, m->own, q->other->n[m->other], q->R - h);
    }
    if (!beyond_all(q, m)) return 0;
    if (m->kind == FL_MATCH_VERTEX_VERTEX)
        return vertex_at(q, m, v3_sub(q->own->v[m->own], q->other->v[m->other]));
    const fl_edge g = p->edge[m->other];
    const fl_vec3 a = q->other->v[g.a], e = v3_scale(1.0 / m->length, v3_sub(q->other->v[g.b], a));
    const fl_vec3 r = v3_sub(q->own->v[m->own], a);
    return vertex_at(q, m, v3_madd(r, -v3_dot(r, e), e));
}

static int edge(const meeting *q, const fl_match *m)
{
    const fl_poly *p = q->other->p;
    const fl_edge g = q->own->p->edge[m->own];
    const fl_vec3 x0 = q->own->v[g.a], u = v3_sub(q->own->v[g.b], x0);
    const double small = FL_SPAN_SAME * p->size;
    const fl_line line = {q->w, q->own, x0, u, m->factor, q->R};
    fl_span t = {0.0, 1.0};
    if (m->kind == FL_MATCH_EDGE_FACE) {
        const double *h = q->h + m->height * q->columns, h0 = h[m->v[0]], h1 = h[m->v[1]];
        const double below = q->behind + small;
        if ((h0 >= q->R && h1 >= q->R) || !fl_span_keep(&t, h0 + below, h1 + below)) return 0;
        return keep_beyond(q, m, &t) ? fl_strips_over_face(&line, t, h0, h1, q->other->n[m->other]) : 0;
    }
    if (!keep_beyond(q, m, &t)) return 0;
    if (m->kind == FL_MATCH_EDGE_VERTEX)
        return fl_strips_over_point(&line, t, q->other->v[m->other], NULL, small);
    const fl_edge o = p->edge[m->other];
    const fl_vec3 a = q->other->v[o.a], e = v3_scale(1.0 / m->length, v3_sub(q->other->v[o.b], a));
    return fl_strips_over_point(&line, t, a, &e, small);
}

/* A face none of whose corners is within reach and above the other, or all of whose corners are beyond one of
 * its sides, has no area there. */
static int face(const meeting *q, const fl_match *m)
{
    const fl_poly *p = q->own->p;
    const int32_t n = p->first[m->own + 1] - p->first[m->own];
    const int32_t *side = q->l->side + m->first, *corner = side + m->n;
    const double *h = q->h + m->height * q->columns;
    int near = 0;
    for (int32_t c = 0; c < n; c++) near |= h[corner[c]] < q->R;
    if (!near) return 0;
    for (int32_t k = 0; k < m->n; k++) {
        const double *g = q->h + (side[k] >> 1) * q->columns, sign = side[k] & 1 ? -1.0 : 1.0;
        int in = 0;
        for (int32_t c = 0; c < n; c++) in |= sign * g[corner[c]] > 0.0;
        if (!in) return 0;
    }
    return fl_areas_face(q->w, q->own, m->own, q->other, m->other, q->R, q->behind, q->rim);
}

int fl_matches_enter(fl_places *w, const fl_matches *l, const fl_poly *a, fl_mat3 M, fl_vec3 o)
{
    if (fl_places_size(w, a)) return -1;
    w->M = M, w->o = o;
    for (int32_t k = 0; k < l->used_v; k++) {
        const int32_t v = l->used[k];
        w->va[v] = v3_add(m3_mul(M, a->v[v]), o);
    }
    for (int32_t k = l->used_v; k < l->used_v + l->used_f; k++)
        w->na[l->used[k]] = m3_mul(M, a->n[l->used[k]]);
    return 0;
}

int fl_matches_places(fl_places *w, const fl_matches *l, const fl_side *A, const fl_side *B, double R,
                      double behind, double rim_a, double rim_b)
{
    filled f[2];
    if (fill(w, &l->table[0], 0, A->v, &f[0]) || fill(w, &l->table[1], 1, B->v, &f[1])) return -1;
    const meeting way[2] = {{w, l, A, B, f[0].h, f[0].columns, R, behind, rim_b},
                            {w, l, B, A, f[1].h, f[1].columns, R, behind, rim_a}};
    for (int32_t k = 0; k < l->n; k++) {
        const fl_match *m = &l->c[k];
        const meeting *q = &way[m->way];
        if (m->kind <= FL_MATCH_VERTEX_VERTEX ? vertex(q, m)
            : m->kind <= FL_MATCH_EDGE_VERTEX ? edge(q, m)
                                              : face(q, m))
            return -1;
    }
    return 0;
}
