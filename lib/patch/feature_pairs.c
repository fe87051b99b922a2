/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "patch/feature_pairs.h"
#include "base/array.h"
#include "patch/face_integral.h"
#include "patch/edge_integral.h"
#include "patch/feature_filter.h"

/* Of the size: points on a plane may seem to be that far off it. */
#define ROUNDING 1e-12

#define INLINE static inline __attribute__((always_inline))

/* A plane of a core: of face f; or at right angles to it through the edge from vertex a to b, its left side
 * above; or, f = -1, at right angles to that edge in a, the side of b above.  g >= 0: the one through that
 * edge that halves the angle of f and g.  FORK_AT: the one that halves the angle of the edges from vertex f
 * to a and to b, the side of a above. */
enum { FORK_AT = -2 };
typedef struct {
    int32_t f, a, b; /* a = -1: the face itself */
    int32_t g;
} plane;

/* A match, and the table of one way, while they are listed. */
typedef struct {
    int32_t kind, way, own, other;
    int32_t v[2];     /* columns */
    int32_t first, n; /* sides; columns of corners follow */
    int32_t corners, height, factor, length;
} match;

enum feature { VERTEX, EDGE, FACE };

static enum feature own_of(const match *m)
{
    return m->kind <= FL_PAIR_VERTEX_VERTEX ? VERTEX : m->kind <= FL_PAIR_EDGE_VERTEX ? EDGE : FACE;
}

static enum feature other_of(const match *m)
{
    if (m->kind == FL_PAIR_VERTEX_VERTEX || m->kind == FL_PAIR_EDGE_VERTEX) return VERTEX;
    return m->kind == FL_PAIR_VERTEX_EDGE || m->kind == FL_PAIR_EDGE_EDGE ? EDGE : FACE;
}

typedef struct {
    int32_t *vertex;
    plane *plane;
    int32_t vertices, planes, vertex_cap, plane_cap;
} table;

/* The number that a vertex, a plane or an edge of one way has in list `list`; else nothing is in the slot. */
typedef struct {
    uint64_t what, ends; /* way, kind and f; a and b */
    int32_t list, number;
} slot;

enum { SLOTS = 256 };

typedef struct fl_feature_draft {
    match *c;
    int32_t *side, *used;
    double *known; /* the numbers of the list */
    uint8_t *mark;
    table table[2];
    fl_feature_filter within[2];
    slot *slot;
    int32_t n, cap, sides, side_cap, used_v, used_f, used_cap, numbers, known_cap, mark_cap, slots, filled,
        lists;
    int32_t asked[2]; /* the first feature of what has been asked of each way, or -1 */
} draft;

typedef struct {
    draft *l;
    int way;
    fl_feature_query of;
} search;

/* --- numbers of what is drafted -------------------------------------------------------------------- */

enum { COLUMN, ROW, FACTOR, LENGTH, HALF, FORK };

INLINE slot *slot_of(const draft *d, uint64_t what, uint64_t ends)
{
    const uint64_t mix = (what * 0x9E3779B97F4A7C15u ^ ends) * 0xC2B2AE3D27D4EB4Fu;
    for (uint64_t at = mix >> 40;; at++) {
        slot *t = &d->slot[at & (uint64_t)(d->slots - 1)];
        if (t->list != d->lists || (t->what == what && t->ends == ends)) return t;
    }
}

/* Twice as many slots: a power of two, at most half of which are full. */
static int more_slots(draft *d)
{
    const int32_t old = d->slots, many = old > 0 ? 2 * old : SLOTS;
    slot *const was = d->slot;
    fl_err lost = {0};
    if (many < 0 || !(d->slot = fl_alloc(many, sizeof *d->slot, &lost))) return d->slot = was, -1;
    d->slots = many;
    for (int32_t k = 0; k < old; k++)
        if (was[k].list == d->lists) *slot_of(d, was[k].what, was[k].ends) = was[k];
    free(was);
    return 0;
}

/* Where the number of something of this list is kept, -1 until it has one; NULL when memory runs out. */
INLINE int32_t *number_of(const search *s, int what, int32_t f, int32_t a, int32_t b)
{
    draft *d = s->l;
    if (2 * d->filled >= d->slots && more_slots(d)) return NULL;
    const uint64_t key = (uint64_t)(uint32_t)f << 32 | (uint32_t)(2 * what + s->way),
                   ends = (uint64_t)(uint32_t)a << 32 | (uint32_t)b;
    slot *t = slot_of(d, key, ends);
    if (t->list != d->lists) *t = (slot){key, ends, d->lists, -1}, d->filled++;
    return &t->number;
}

/* The column of a vertex; -1 when memory runs out. */
static int32_t column(const search *s, int32_t v)
{
    table *t = &s->l->table[s->way];
    int32_t *k = number_of(s, COLUMN, v, 0, 0);
    if (!k || *k >= 0) return k ? *k : -1;
    if (fl_reserve(&t->vertex, &t->vertex_cap, (int64_t)t->vertices + 1, sizeof *t->vertex)) return -1;
    t->vertex[t->vertices] = v;
    return *k = t->vertices++;
}

INLINE fl_core_plane cut_of(const fl_poly *p, const plane *q)
{
    if (q->g == FORK_AT) { /* as far from the edges to a and to b */
        const fl_vec3 o = p->v[q->f], to_a = v3_unit(v3_sub(p->v[q->a], o)),
                      to_b = v3_unit(v3_sub(p->v[q->b], o));
        const fl_vec3 d = v3_sub(to_a, to_b);
        return (fl_core_plane){d, v3_dot(d, o)};
    }
    const fl_vec3 from = p->v[q->a < 0 ? p->loop[p->first[q->f]] : q->a];
    fl_vec3 g;
    if (q->a < 0) {
        g = p->n[q->f];
    } else {
        const fl_vec3 u = v3_sub(p->v[q->b], from);
        g = q->f < 0 ? u : q->g < 0 ? v3_cross(p->n[q->f], u) : v3_cross(v3_add(p->n[q->f], p->n[q->g]), u);
    }
    return (fl_core_plane){g, v3_dot(g, from)};
}

static int32_t row_between(const search *s, int32_t f, int32_t g, int32_t a, int32_t b)
{
    table *t = &s->l->table[s->way];
    int32_t *k = number_of(s, g == FORK_AT ? FORK : g < 0 ? ROW : HALF, f, a, b);
    if (!k || *k >= 0) return k ? *k : -1;
    if (fl_reserve(&t->plane, &t->plane_cap, (int64_t)t->planes + 1, sizeof *t->plane)) return -1;
    t->plane[t->planes] = (plane){f, a, b, g};
    return *k = t->planes++;
}

static int32_t row(const search *s, int32_t f, int32_t a, int32_t b) { return row_between(s, f, -1, a, b); }

/* Which of the numbers is the factor of an own edge, or the length of one of the other. */
static int32_t number(const search *s, int32_t edge, int length)
{
    draft *l = s->l;
    int32_t *k = number_of(s, length ? LENGTH : FACTOR, edge, 0, 0);
    if (!k || *k >= 0) return k ? *k : -1;
    if (fl_reserve(&l->known, &l->known_cap, (int64_t)l->numbers + 1, sizeof *l->known)) return -1;
    const fl_poly *p = s->of.other->p;
    l->known[l->numbers] = length
                               /* the same bits in any pose */
                               ? v3_norm(v3_sub(p->v[p->edge[edge].b], p->v[p->edge[edge].a]))
                               : fl_edge_integral_factor(s->of.own, edge, s->of.other->r);
    return *k = l->numbers++;
}

static int push(draft *l, int32_t side)
{
    if (fl_reserve(&l->side, &l->side_cap, (int64_t)l->sides + 1, sizeof *l->side)) return -1;
    l->side[l->sides++] = side;
    return 0;
}

/* It must be above a plane, or below.  The two sides of an edge ask the same row: all ask with the same
 * number, so that nothing falls between two and nothing counts twice. */
static int beyond(const search *s, match *m, int32_t f, int32_t a, int32_t b, int below)
{
    const int turned = f >= 0 && a > b;
    const int32_t r = turned ? row(s, f, b, a) : row(s, f, a, b);
    m->n++;
    return r < 0 ? -1 : push(s->l, 2 * r + (below != turned));
}

/* On the own side of the plane that halves the angle of two faces that lean towards each other. */
static int before(const search *s, match *m, int32_t f, int32_t g, int32_t a, int32_t b)
{
    const int turned = a > b;
    const int32_t r = row_between(s, f < g ? f : g, f < g ? g : f, turned ? b : a, turned ? a : b);
    m->n++;
    return r < 0 ? -1 : push(s->l, 2 * r + turned);
}

/* What is as far from two faces that lean towards each other counts over one of them: a point or an edge that
 * came out of the prism over a face while it is nearer than R would be lost all at once.  Areas go over both:
 * what is lost of them where they cross a seam is nothing. */
static int sides_of_face(const search *s, match *m, uint32_t hit)
{
    const fl_poly *p = s->of.other->p;
    const int32_t from = p->first[m->other], n = p->first[m->other + 1] - from, *loop = p->loop + from;
    m->height = row(s, m->other, -1, -1);
    for (int32_t c = 0, last = n - 1; c < n; last = c++) {
        const int32_t g = p->concave_face && m->kind != FL_PAIR_FACE_FACE ? p->concave_face[from + last] : -1;
        if (g < 0 ? !fl_feature_side_redundant(hit, c) && beyond(s, m, m->other, loop[last], loop[c], 0)
                  : before(s, m, m->other, g, loop[last], loop[c]))
            return -1;
    }
    return m->height < 0 ? -1 : 0;
}

/* Where edges that bend outward meet in a corner that is not convex their wedges overlap: each has what is
 * nearer to it. */
static int forks_of_edge(const search *s, match *m, int32_t v, int32_t to)
{
    const fl_poly *p = s->of.other->p;
    for (int32_t k = p->neighbour_first[v]; p->saddle && k < p->neighbour_first[v + 1]; k++) {
        const int32_t other = p->neighbour[k], turned = other < to;
        if (!p->saddle[k] || other == to) continue;
        const int32_t r = row_between(s, v, FORK_AT, turned ? other : to, turned ? to : other);
        m->n++;
        if (r < 0 || push(s->l, 2 * r + turned)) return -1;
    }
    return 0;
}

static int sides_of_edge(const search *s, match *m, uint32_t hit)
{
    const fl_edge g = s->of.other->p->edge[m->other];
    const int left = 2, right = 2 + (g.left >= 0);
    m->length = number(s, m->other, 1);
    if (forks_of_edge(s, m, g.a, g.b) || forks_of_edge(s, m, g.b, g.a)) return -1;
    return m->length < 0 || (!fl_feature_side_redundant(hit, 0) && beyond(s, m, -1, g.a, g.b, 0)) ||
                   (!fl_feature_side_redundant(hit, 1) && beyond(s, m, -1, g.b, g.a, 0)) ||
                   (g.left >= 0 && !fl_feature_side_redundant(hit, left) &&
                    beyond(s, m, g.left, g.a, g.b, 1)) ||
                   (g.right >= 0 && !fl_feature_side_redundant(hit, right) &&
                    beyond(s, m, g.right, g.b, g.a, 1))
               ? -1
               : 0;
}

static int sides_of_vertex(const search *s, match *m, uint32_t hit)
{
    const fl_poly *p = s->of.other->p;
    const int32_t from = p->neighbour_first[m->other], n = p->neighbour_first[m->other + 1] - from;
    for (int32_t k = 0; k < n; k++)
        if (!fl_feature_side_redundant(hit, k) && beyond(s, m, -1, m->other, p->neighbour[from + k], 1))
            return -1;
    return 0;
}

static int add(const search *s, int kind, int32_t own, int32_t other, uint32_t hit)
{
    draft *l = s->l;
    const fl_poly *p = s->of.own->p;
    match m = {.kind = kind, .way = s->way, .own = own, .other = other, .first = l->sides};
    if (fl_reserve(&l->c, &l->cap, (int64_t)l->n + 1, sizeof *l->c)) return -1;
    const int face = kind == FL_PAIR_VERTEX_FACE || kind == FL_PAIR_EDGE_FACE || kind == FL_PAIR_FACE_FACE;
    const int edge = kind == FL_PAIR_VERTEX_EDGE || kind == FL_PAIR_EDGE_EDGE;
    if (face ? sides_of_face(s, &m, hit) : edge ? sides_of_edge(s, &m, hit) : sides_of_vertex(s, &m, hit))
        return -1;
    if (kind == FL_PAIR_FACE_FACE) {
        m.corners = p->first[own + 1] - p->first[own];
        for (int32_t k = p->first[own]; k < p->first[own + 1]; k++) {
            const int32_t v = column(s, p->loop[k]);
            if (v < 0 || push(l, v)) return -1;
        }
    } else if (kind >= FL_PAIR_EDGE_FACE) {
        m.v[0] = column(s, p->edge[own].a);
        m.v[1] = column(s, p->edge[own].b);
        m.factor = number(s, own, 0);
    } else {
        m.v[0] = m.v[1] = column(s, own);
    }
    l->c[l->n++] = m;
    return m.v[0] < 0 || m.v[1] < 0 || m.factor < 0 ? -1 : 0;
}

/* So many questions whether a feature comes over another are asked together. */
#define TOGETHER (1 << 20)

/* The features numbered from `begin` to `end`, vertices first, then edges, then faces. */
static fl_feature_set part_of(const fl_feature_set *r, int32_t begin, int32_t end)
{
    const int32_t n[3] = {r->vertices, r->edges, r->faces};
    int32_t at[3], many[3], before = 0;
    for (int k = 0; k < 3; before += n[k++]) {
        const int32_t from = begin - before, to = end - before;
        at[k] = from < 0 ? 0 : from > n[k] ? n[k] : from;
        many[k] = (to < 0 ? 0 : to > n[k] ? n[k] : to) - at[k];
    }
    return (fl_feature_set){.vertex = r->vertex + at[0],
                            .edge = r->edge + at[1],
                            .face = r->face + at[2],
                            .vertices = many[0],
                            .edges = many[1],
                            .faces = many[2]};
}

/* Whether own feature o comes over each of the others; NULL when memory runs out. */
static const uint32_t *hits_of(const search *s, const fl_feature_set *mine, int32_t o,
                               const fl_feature_set *near)
{
    const int32_t owns = mine->vertices + mine->edges + mine->faces,
                  many = TOGETHER / (near->faces + near->edges + near->vertices + 1) + 1,
                  begin = o - o % many, end = owns - begin < many ? owns : begin + many;
    fl_feature_filter *t = &s->l->within[s->way];
    if (s->l->asked[s->way] != begin) {
        const fl_feature_set part = part_of(mine, begin, end);
        if (fl_feature_filter_find(t, &s->of, &part, near)) return NULL;
        s->l->asked[s->way] = begin;
    }
    return t->hit + (int64_t)(o - begin) * t->others;
}

/* Own features from `begin` to `end`, numbered like that, over all of the others. */
static int some_over(const search *s, const fl_feature_set *mine, int32_t begin, int32_t end,
                     const fl_feature_set *near)
{
    const int32_t edges = mine->vertices, faces = edges + mine->edges;
    for (int32_t o = begin; o < end; o++) {
        const int kind = o < edges ? FL_PAIR_VERTEX_FACE : o < faces ? FL_PAIR_EDGE_FACE : FL_PAIR_FACE_FACE;
        const int32_t own = o < edges   ? mine->vertex[o]
                            : o < faces ? mine->edge[o - edges]
                                        : mine->face[o - faces];
        const uint32_t *hit = hits_of(s, mine, o, near);
        if (!hit) return -1;
        if (kind == FL_PAIR_EDGE_FACE && !(fl_edge_integral_factor(s->of.own, own, s->of.other->r) > 0.0))
            continue;
        for (int32_t k = 0; k < near->faces; k++, hit++)
            if (*hit && add(s, kind, own, near->face[k], *hit)) return -1;
        for (int32_t k = 0; k < near->edges; k++, hit++)
            if (*hit && add(s, kind + 1, own, near->edge[k], *hit)) return -1;
        for (int32_t k = 0; k < near->vertices; k++, hit++)
            if (*hit && add(s, kind + 2, own, near->vertex[k], *hit)) return -1;
    }
    return 0;
}

/* Once each: mark[0 .. nv) for the vertices, mark[nv .. nv + nf) for the faces. */
static int use(draft *l, int32_t at, int32_t number)
{
    if (l->mark[at]) return 0;
    l->mark[at] = 1;
    const int32_t n = l->used_v + l->used_f;
    if (fl_reserve(&l->used, &l->used_cap, (int64_t)n + 1, sizeof *l->used)) return -1;
    l->used[n] = number;
    return 0;
}

/* Vertices of A that the list speaks of, then faces. */
static int list_used(draft *l, const fl_poly *p)
{
    if (fl_reserve(&l->mark, &l->mark_cap, (int64_t)p->nv + p->nf, sizeof *l->mark)) return -1;
    memset(l->mark, 0, (size_t)p->nv + (size_t)p->nf);
    l->used_v = l->used_f = 0;
    for (int faces = 0; faces < 2; faces++) {
        for (int32_t k = 0; k < l->n; k++) {
            const match *m = &l->c[k];
            const enum feature of = m->way ? other_of(m) : own_of(m);
            const int32_t i = m->way ? m->other : m->own;
            const int32_t edge[2] = {of == EDGE ? p->edge[i].a : i, of == EDGE ? p->edge[i].b : i};
            const int32_t *at = of == FACE ? p->loop + p->first[i] : edge;
            const int32_t n = of == FACE ? p->first[i + 1] - p->first[i] : 2;
            for (int32_t c = 0; c < n && !faces; c++) {
                const int fresh = !l->mark[at[c]];
                if (use(l, at[c], at[c])) return -1;
                l->used_v += fresh;
            }
            if (faces && of == FACE) {
                const int fresh = !l->mark[p->nv + i];
                if (use(l, p->nv + i, i)) return -1;
                l->used_f += fresh;
            }
        }
    }
    return 0;
}

/* --- the block --------------------------------------------------------------------------------- */

/* Whole numbers on their way into a block, as wide as in the list; COUNT: they are counted only, and the
 * largest is found. */
enum { COUNT = -1 };
typedef struct {
    void *at;
    int64_t n;
    int32_t most;
} whole;

INLINE void put(whole *to, int wide, int32_t x)
{
    if (wide == COUNT) to->most = x > to->most ? x : to->most;
    else if (wide == 0) ((uint8_t *)to->at)[to->n] = (uint8_t)x;
    else if (wide == 1) ((uint16_t *)to->at)[to->n] = (uint16_t)x;
    else ((int32_t *)to->at)[to->n] = x;
    to->n++;
}

INLINE void put_match(whole *to, int wide, const draft *d, const match *m)
{
    const int edge = m->kind >= FL_PAIR_EDGE_FACE && m->kind <= FL_PAIR_EDGE_VERTEX;
    const enum feature over = other_of(m);
    const int32_t *side = d->side + m->first;
    put(to, wide, m->kind | m->way << 3 | m->n << 4);
    put(to, wide, m->own);
    put(to, wide, m->other);
    put(to, wide, m->kind == FL_PAIR_FACE_FACE ? m->corners : m->v[0]);
    if (edge) put(to, wide, m->v[1]), put(to, wide, m->factor);
    if (over != VERTEX) put(to, wide, over == FACE ? m->height : m->length);
    for (int32_t k = 0; k < m->n + m->corners; k++) put(to, wide, side[k]);
}

/* Numbers of planes may be -1 and FORK_AT. */
enum { TOLD = -FORK_AT };

INLINE void put_plane(whole *to, int wide, const plane *q)
{
    put(to, wide, q->f + TOLD), put(to, wide, q->a + TOLD), put(to, wide, q->b + TOLD),
        put(to, wide, q->g + TOLD);
}

INLINE void put_all(whole *to, int wide, const draft *d, int keeps)
{
    for (int way = 0; way < 2 && !keeps; way++)
        for (int32_t k = 0; k < d->table[way].planes; k++) put_plane(to, wide, &d->table[way].plane[k]);
    for (int way = 0; way < 2; way++)
        for (int32_t k = 0; k < d->table[way].vertices; k++) put(to, wide, d->table[way].vertex[k]);
    for (int32_t k = 0; k < d->used_v + d->used_f; k++) put(to, wide, d->used[k]);
    for (int32_t k = 0; k < d->n; k++) put_match(to, wide, d, &d->c[k]);
}

static void put_into(void *at, int wide, const draft *d, int keeps)
{
    whole to = {.at = at};
    if (wide == 0) put_all(&to, 0, d, keeps);
    else if (wide == 1) put_all(&to, 1, d, keeps);
    else put_all(&to, 2, d, keeps);
}

/* What has been drafted, in a block as long as it must be. */
static int pack(fl_feature_pairs *l, const draft *d, const fl_poly *a, const fl_poly *b)
{
    whole count = {0};
    for (int way = 0; way < 2; way++) { /* heights are told by numbers of 32 bits */
        const table *t = &d->table[way];
        if (t->planes > INT32_MAX / 2 / (t->vertices + FL_SIMD_WIDTH)) return -1;
    }
    put_all(&count, COUNT, d, l->stores_planes);
    const int wide = count.most <= UINT8_MAX ? 0 : count.most <= UINT16_MAX ? 1 : 2;
    const int64_t planes = (int64_t)d->table[0].planes + d->table[1].planes,
                  bytes = (l->stores_planes ? planes * (int64_t)sizeof(fl_core_plane) : 0) +
                          d->numbers * (int64_t)sizeof(double) + (count.n << wide);
    if (l->size < bytes || l->size > bytes + bytes / 4) { /* a list lasts: nothing is kept in vain */
        free(l->block);
        l->block = NULL;
        l->size = 0;
        if (fl_reserve(&l->block, &l->size, bytes, 1)) return -1;
    }
    fl_core_plane *cut = l->block;
    for (int way = 0; way < 2; way++) {
        const table *t = &d->table[way];
        for (int32_t k = 0; k < t->planes && l->stores_planes; k++)
            *cut++ = cut_of(way ? a : b, &t->plane[k]);
        l->planes[way] = t->planes;
        l->vertices[way] = t->vertices;
    }
    double *number = (double *)(void *)cut;
    for (int32_t k = 0; k < d->numbers; k++) *number++ = d->known[k];
    l->numbers = d->numbers;
    l->used_vertices = d->used_v, l->used_faces = d->used_f;
    l->n = d->n;
    l->width = (int16_t)wide;
    put_into(number, wide, d, l->stores_planes);
    return 0;
}

INLINE void make_cuts(const fl_feature_pairs *l, int wide, int way, const fl_poly *p, fl_core_plane *out)
{
    const void *told = fl_feature_pairs_plane_indices(l);
    int64_t at = way ? 4 * (int64_t)l->planes[0] : 0;
    for (int32_t k = 0; k < l->planes[way]; k++, at += 4) {
        const plane q = {.f = fl_feature_integer(told, wide, at) - TOLD,
                         .a = fl_feature_integer(told, wide, at + 1) - TOLD,
                         .b = fl_feature_integer(told, wide, at + 2) - TOLD,
                         .g = fl_feature_integer(told, wide, at + 3) - TOLD};
        out[k] = cut_of(p, &q);
    }
}

void fl_feature_pairs_make_planes(const fl_feature_pairs *l, int way, const fl_poly *p, fl_core_plane *out)
{
    if (l->width == 0) make_cuts(l, 0, way, p, out);
    else make_cuts(l, l->width, way, p, out);
}

/* --- the list ---------------------------------------------------------------------------------- */

/* Margins over R: the first, before the way from look to look is known, and bounds of those after.  PRICE:
 * of a list, over what a look costs more for a margin of R; by counts of instructions, side on side. */
#define FIRST 0.05
#define LEAST 0.01
#define MOST 0.3
#define PRICE 6.0

double fl_feature_pairs_margin(const fl_feature_pairs *l, double R)
{
    if (!(l->margin > 0.0)) return FIRST * R;
    const double best = sqrt(PRICE * R * l->margin / (double)l->uses);
    return best < LEAST * R ? LEAST * R : best > MOST * R ? MOST * R : best;
}

/* Nothing yet; no list has number 0, which new slots have. */
static int begin_draft(draft *d)
{
    if (d->lists == INT32_MAX || d->slots == 0) {
        free(d->slot);
        d->slot = NULL;
        d->slots = d->lists = 0;
        if (more_slots(d)) return -1;
    }
    d->lists++;
    d->filled = d->n = d->sides = d->numbers = 0;
    for (int k = 0; k < 2; k++) d->table[k].vertices = d->table[k].planes = 0, d->asked[k] = -1;
    return 0;
}

int fl_feature_pairs_build(fl_feature_pairs *l, fl_patch_points *w, const fl_patch_core *A,
                           const fl_feature_set *a, const fl_patch_core *B, const fl_feature_set *b, double R,
                           double behind, double margin)
{
    double far = 0.0;
    l->max_shift2 = 0.0; /* half a list */
    l->n = l->separated = 0;
    if (!w->draft) {
        fl_err lost = {0};
        if (!(w->draft = fl_alloc(1, sizeof *w->draft, &lost))) return -1;
    }
    for (int32_t v = 0; v < A->p->nv; v++) far = fmax(far, v3_norm2(A->p->v[v]));
    far = sqrt(far) + R + margin;
    const double half = 0.5 * margin, turn = half / far; /* half of it for the shift, half for the turn */
    const double wide = margin + ROUNDING * (A->p->size + B->p->size);
    draft *d = w->draft;
    const fl_vec3 o = w->o;
    const double room = l->stores_planes ? -1.0 : wide + ROUNDING * (fabs(o.x) + fabs(o.y) + fabs(o.z));
    const search of_a = {d, 0, {A, B, R, behind, wide, turn - FL_FACE_PAIR_COSINE, room, far, o}},
                 of_b = {d, 1, {B, A, R, behind, wide, turn - FL_FACE_PAIR_COSINE, room, far, o}};
    const int32_t last_a = a->vertices + a->edges + a->faces, last_b = b->vertices + b->edges + b->faces;
    if (begin_draft(d)) return -1;
    if (some_over(&of_a, a, 0, a->vertices, b) || some_over(&of_b, b, 0, b->vertices, a) ||
        some_over(&of_a, a, a->vertices, last_a, b) || some_over(&of_b, b, b->vertices, last_b, a) ||
        list_used(d, A->p) || pack(l, d, A->p, B->p))
        return -1;
    l->M = w->M, l->o = w->o;
    l->max_shift2 = half * half, l->max_turn2 = turn * turn;
    l->margin = margin, l->uses = 1;
    return 0;
}

int fl_feature_pairs_transform(fl_patch_points *w, const fl_feature_pairs *l, const fl_poly *a, fl_mat3 M,
                               fl_vec3 o)
{
    if (fl_patch_points_reserve_core(w, a)) return -1;
    w->M = M, w->o = o;
    const void *whole = fl_feature_pairs_integers(l);
    const int32_t from = l->vertices[0] + l->vertices[1];
    for (int32_t k = from; k < from + l->used_vertices; k++) {
        const int32_t v = fl_feature_integer(whole, l->width, k);
        w->va[v] = v3_add(m3_mul(M, a->v[v]), o);
    }
    for (int32_t k = from + l->used_vertices; k < from + l->used_vertices + l->used_faces; k++) {
        const int32_t f = fl_feature_integer(whole, l->width, k);
        w->na[f] = m3_mul(M, a->n[f]);
    }
    return 0;
}

void fl_feature_draft_free(draft *d)
{
    if (!d) return;
    for (int k = 0; k < 2; k++) free(d->table[k].vertex), free(d->table[k].plane);
    free(d->c), free(d->side), free(d->used), free(d->known), free(d->mark), free(d->slot);
    fl_feature_filter_free(&d->within[0]), fl_feature_filter_free(&d->within[1]);
    free(d);
}

void fl_feature_pairs_free(fl_feature_pairs *l)
{
    free(l->block), free(l->candidate);
    *l = (fl_feature_pairs){0};
}

double fl_feature_pairs_bytes(const fl_feature_pairs *l)
{
    return (double)(sizeof *l + (size_t)l->size + (size_t)l->candidate_cap * sizeof(int32_t));
}
