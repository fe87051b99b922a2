/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "patch/feature_pairs.h"
#include "base/array.h"
#include "patch/edge_integral.h"
#include "patch/face_integral.h"
#include "patch/feature_filter.h"

/* Fraction of the size of both cores: rounding of the distance of a point on a plane. */
#define PLANE_TOL 1e-12

#define INLINE static inline __attribute__((always_inline))

/* Which plane of a core.
 * - a = -1: the plane of face f.
 * - f >= 0: at right angles to face f through the edge from vertex a to b, the left side above.
 * - f = -1: at right angles to that edge in a, the side of b above.
 * - g >= 0: through that edge, bisecting the angle of faces f and g.
 * - g = EDGE_BISECTOR: bisecting the angle of the edges from vertex f to a and to b, the side of a above. */
enum { EDGE_BISECTOR = -2 };
typedef struct {
    int32_t f, a, b; /* a = -1: the face itself */
    int32_t g;
} plane_key;

/* A feature pair, and the table of one direction, while the list is built. */
typedef struct {
    int32_t kind, direction, own, other;
    int32_t v[2];     /* columns */
    int32_t first, n; /* sides; columns of corners follow */
    int32_t corners, height, factor, length;
} pair_row;

enum feature { VERTEX, EDGE, FACE };

static enum feature own_kind(const pair_row *m)
{
    return m->kind <= FL_PAIR_VERTEX_VERTEX ? VERTEX : m->kind <= FL_PAIR_EDGE_VERTEX ? EDGE : FACE;
}

static enum feature other_kind(const pair_row *m)
{
    if (m->kind == FL_PAIR_VERTEX_VERTEX || m->kind == FL_PAIR_EDGE_VERTEX) return VERTEX;
    return m->kind == FL_PAIR_VERTEX_EDGE || m->kind == FL_PAIR_EDGE_EDGE ? EDGE : FACE;
}

typedef struct {
    int32_t *vertex;
    plane_key *plane;
    int32_t vertices, planes, vertex_cap, plane_cap;
} row_table;

/* Hash table: the number that a vertex, a plane or an edge of one direction has in list `list`.  A slot of
 * another list is empty. */
typedef struct {
    uint64_t what, ends; /* direction, kind and f; a and b */
    int32_t list, number;
} hash_slot;

enum { SLOTS = 256 };

typedef struct fl_feature_draft {
    pair_row *c;
    int32_t *side, *used;
    double *value; /* numbers of the list */
    uint8_t *mark;
    row_table table[2];
    fl_feature_filter filter[2];
    hash_slot *slot;
    int32_t n, cap, sides, side_cap, used_v, used_f, used_cap, numbers, value_cap, mark_cap, slots, filled,
        lists;
    int32_t queried[2]; /* for each direction the first own feature of the last filter query, or -1 */
} list_draft;

typedef struct {
    list_draft *l;
    int direction;
    fl_feature_query of;
} pair_query;

/* --- numbers of vertices, planes and edges in the draft ------------------------------------------------- */

enum { VERTEX_COLUMN, PLANE_ROW, EDGE_FACTOR, EDGE_LENGTH, BISECTOR_OF_FACES, BISECTOR_OF_EDGES };

INLINE hash_slot *find_slot(const list_draft *d, uint64_t what, uint64_t ends)
{
    const uint64_t mix = (what * 0x9E3779B97F4A7C15u ^ ends) * 0xC2B2AE3D27D4EB4Fu;
    for (uint64_t at = mix >> 40;; at++) {
        hash_slot *t = &d->slot[at & (uint64_t)(d->slots - 1)];
        if (t->list != d->lists || (t->what == what && t->ends == ends)) return t;
    }
}

/* Doubles the slots: a power of two, at most half of them full. */
static int grow_slots(list_draft *d)
{
    const int32_t old = d->slots, many = old > 0 ? 2 * old : SLOTS;
    hash_slot *const was = d->slot;
    fl_err lost = {0};
    if (many < 0 || !(d->slot = fl_alloc(many, sizeof *d->slot, &lost))) return d->slot = was, -1;
    d->slots = many;
    for (int32_t k = 0; k < old; k++)
        if (was[k].list == d->lists) *find_slot(d, was[k].what, was[k].ends) = was[k];
    free(was);
    return 0;
}

/* Number of an item of this list, -1 until it is assigned; NULL when memory runs out. */
INLINE int32_t *find_number(const pair_query *s, int what, int32_t f, int32_t a, int32_t b)
{
    list_draft *d = s->l;
    if (2 * d->filled >= d->slots && grow_slots(d)) return NULL;
    const uint64_t key = (uint64_t)(uint32_t)f << 32 | (uint32_t)(2 * what + s->direction),
                   ends = (uint64_t)(uint32_t)a << 32 | (uint32_t)b;
    hash_slot *t = find_slot(d, key, ends);
    if (t->list != d->lists) *t = (hash_slot){key, ends, d->lists, -1}, d->filled++;
    return &t->number;
}

/* Column of a vertex; -1 when memory runs out. */
static int32_t column_of_vertex(const pair_query *s, int32_t v)
{
    row_table *t = &s->l->table[s->direction];
    int32_t *k = find_number(s, VERTEX_COLUMN, v, 0, 0);
    if (!k || *k >= 0) return k ? *k : -1;
    if (fl_reserve(&t->vertex, &t->vertex_cap, (int64_t)t->vertices + 1, sizeof *t->vertex)) return -1;
    t->vertex[t->vertices] = v;
    return *k = t->vertices++;
}

INLINE fl_core_plane plane_of(const fl_poly *p, const plane_key *q)
{
    if (q->g == EDGE_BISECTOR) { /* at equal angles to the edges to a and to b */
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

static int32_t row_of_plane(const pair_query *s, int32_t f, int32_t g, int32_t a, int32_t b)
{
    row_table *t = &s->l->table[s->direction];
    int32_t *k = find_number(s,
                             g == EDGE_BISECTOR ? BISECTOR_OF_EDGES
                             : g < 0            ? PLANE_ROW
                                                : BISECTOR_OF_FACES,
                             f, a, b);
    if (!k || *k >= 0) return k ? *k : -1;
    if (fl_reserve(&t->plane, &t->plane_cap, (int64_t)t->planes + 1, sizeof *t->plane)) return -1;
    t->plane[t->planes] = (plane_key){f, a, b, g};
    return *k = t->planes++;
}

static int32_t row_of_edge_plane(const pair_query *s, int32_t f, int32_t a, int32_t b)
{
    return row_of_plane(s, f, -1, a, b);
}

/* Index of the factor of an own edge, or of the length of an edge of the other core. */
static int32_t number_index(const pair_query *s, int32_t edge, int length)
{
    list_draft *l = s->l;
    int32_t *k = find_number(s, length ? EDGE_LENGTH : EDGE_FACTOR, edge, 0, 0);
    if (!k || *k >= 0) return k ? *k : -1;
    if (fl_reserve(&l->value, &l->value_cap, (int64_t)l->numbers + 1, sizeof *l->value)) return -1;
    const fl_poly *p = s->of.other->p;
    l->value[l->numbers] = length
                               /* in the core's own frame: the same bits in any pose */
                               ? v3_norm(v3_sub(p->v[p->edge[edge].b], p->v[p->edge[edge].a]))
                               : fl_edge_integral_factor(s->of.own, edge, s->of.other->r);
    return *k = l->numbers++;
}

static int append_side(list_draft *l, int32_t side)
{
    if (fl_reserve(&l->side, &l->side_cap, (int64_t)l->sides + 1, sizeof *l->side)) return -1;
    l->side[l->sides++] = side;
    return 0;
}

/* The feature must lie above the plane, or below.  Both sides of an edge use the same row, so a point is on
 * exactly one side: nothing is lost between two regions and nothing counts twice. */
static int add_side_plane(const pair_query *s, pair_row *m, int32_t f, int32_t a, int32_t b, int below)
{
    const int turned = f >= 0 && a > b;
    const int32_t r = turned ? row_of_edge_plane(s, f, b, a) : row_of_edge_plane(s, f, a, b);
    m->n++;
    return r < 0 ? -1 : append_side(s->l, 2 * r + (below != turned));
}

/* The feature must lie on its own side of the bisector of two faces that meet in a concave edge. */
static int add_bisector_plane(const pair_query *s, pair_row *m, int32_t f, int32_t g, int32_t a, int32_t b)
{
    const int turned = a > b;
    const int32_t r = row_of_plane(s, f < g ? f : g, f < g ? g : f, turned ? b : a, turned ? a : b);
    m->n++;
    return r < 0 ? -1 : append_side(s->l, 2 * r + turned);
}

/* At a concave edge a point or an edge belongs to the nearer of the two faces.  Otherwise it would be lost at
 * once when it leaves the prism over a face while nearer than R.  Faces count over both: the part lost where
 * they cross a seam vanishes. */
static int add_sides_of_face(const pair_query *s, pair_row *m, uint32_t hit)
{
    const fl_poly *p = s->of.other->p;
    const int32_t from = p->first[m->other], n = p->first[m->other + 1] - from, *loop = p->loop + from;
    m->height = row_of_edge_plane(s, m->other, -1, -1);
    for (int32_t c = 0, last = n - 1; c < n; last = c++) {
        const int32_t g = p->concave_face && m->kind != FL_PAIR_FACE_FACE ? p->concave_face[from + last] : -1;
        if (g < 0
                ? !fl_feature_side_redundant(hit, c) && add_side_plane(s, m, m->other, loop[last], loop[c], 0)
                : add_bisector_plane(s, m, m->other, g, loop[last], loop[c]))
            return -1;
    }
    return m->height < 0 ? -1 : 0;
}

/* Where convex edges meet in a corner that is not convex their wedges overlap: each edge takes the nearer
 * part. */
static int add_edge_bisectors(const pair_query *s, pair_row *m, int32_t v, int32_t to)
{
    const fl_poly *p = s->of.other->p;
    for (int32_t k = p->neighbour_first[v]; p->saddle && k < p->neighbour_first[v + 1]; k++) {
        const int32_t other = p->neighbour[k], turned = other < to;
        if (!p->saddle[k] || other == to) continue;
        const int32_t r = row_of_plane(s, v, EDGE_BISECTOR, turned ? other : to, turned ? to : other);
        m->n++;
        if (r < 0 || append_side(s->l, 2 * r + turned)) return -1;
    }
    return 0;
}

static int add_sides_of_edge(const pair_query *s, pair_row *m, uint32_t hit)
{
    const fl_edge g = s->of.other->p->edge[m->other];
    const int left = 2, right = 2 + (g.left >= 0);
    m->length = number_index(s, m->other, 1);
    if (add_edge_bisectors(s, m, g.a, g.b) || add_edge_bisectors(s, m, g.b, g.a)) return -1;
    return m->length < 0 || (!fl_feature_side_redundant(hit, 0) && add_side_plane(s, m, -1, g.a, g.b, 0)) ||
                   (!fl_feature_side_redundant(hit, 1) && add_side_plane(s, m, -1, g.b, g.a, 0)) ||
                   (g.left >= 0 && !fl_feature_side_redundant(hit, left) &&
                    add_side_plane(s, m, g.left, g.a, g.b, 1)) ||
                   (g.right >= 0 && !fl_feature_side_redundant(hit, right) &&
                    add_side_plane(s, m, g.right, g.b, g.a, 1))
               ? -1
               : 0;
}

static int add_sides_of_vertex(const pair_query *s, pair_row *m, uint32_t hit)
{
    const fl_poly *p = s->of.other->p;
    const int32_t from = p->neighbour_first[m->other], n = p->neighbour_first[m->other + 1] - from;
    for (int32_t k = 0; k < n; k++)
        if (!fl_feature_side_redundant(hit, k) &&
            add_side_plane(s, m, -1, m->other, p->neighbour[from + k], 1))
            return -1;
    return 0;
}

static int append_pair(const pair_query *s, int kind, int32_t own, int32_t other, uint32_t hit)
{
    list_draft *l = s->l;
    const fl_poly *p = s->of.own->p;
    pair_row m = {.kind = kind, .direction = s->direction, .own = own, .other = other, .first = l->sides};
    if (fl_reserve(&l->c, &l->cap, (int64_t)l->n + 1, sizeof *l->c)) return -1;
    const int face = kind == FL_PAIR_VERTEX_FACE || kind == FL_PAIR_EDGE_FACE || kind == FL_PAIR_FACE_FACE;
    const int edge = kind == FL_PAIR_VERTEX_EDGE || kind == FL_PAIR_EDGE_EDGE;
    if (face   ? add_sides_of_face(s, &m, hit)
        : edge ? add_sides_of_edge(s, &m, hit)
               : add_sides_of_vertex(s, &m, hit))
        return -1;
    if (kind == FL_PAIR_FACE_FACE) {
        m.corners = p->first[own + 1] - p->first[own];
        for (int32_t k = p->first[own]; k < p->first[own + 1]; k++) {
            const int32_t v = column_of_vertex(s, p->loop[k]);
            if (v < 0 || append_side(l, v)) return -1;
        }
    } else if (kind >= FL_PAIR_EDGE_FACE) {
        m.v[0] = column_of_vertex(s, p->edge[own].a);
        m.v[1] = column_of_vertex(s, p->edge[own].b);
        m.factor = number_index(s, own, 0);
    } else {
        m.v[0] = m.v[1] = column_of_vertex(s, own);
    }
    l->c[l->n++] = m;
    return m.v[0] < 0 || m.v[1] < 0 || m.factor < 0 ? -1 : 0;
}

/* Number of feature combinations that are filtered in one query. */
#define QUERIES_AT_ONCE (1 << 20)

/* Subset of the features numbered from `begin` to `end`: vertices first, then edges, then faces. */
static fl_feature_set subset_of(const fl_feature_set *r, int32_t begin, int32_t end)
{
    const int32_t n[3] = {r->vertices, r->edges, r->faces};
    int32_t at[3], many[3], add_bisector_plane = 0;
    for (int k = 0; k < 3; add_bisector_plane += n[k++]) {
        const int32_t from = begin - add_bisector_plane, to = end - add_bisector_plane;
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

/* Filter results of own feature o against all features of `near`; NULL when memory runs out. */
static const uint32_t *hits_of_feature(const pair_query *s, const fl_feature_set *mine, int32_t o,
                                       const fl_feature_set *near)
{
    const int32_t owns = mine->vertices + mine->edges + mine->faces,
                  many = QUERIES_AT_ONCE / (near->faces + near->edges + near->vertices + 1) + 1,
                  begin = o - o % many, end = owns - begin < many ? owns : begin + many;
    fl_feature_filter *t = &s->l->filter[s->direction];
    if (s->l->queried[s->direction] != begin) {
        const fl_feature_set part = subset_of(mine, begin, end);
        if (fl_feature_filter_find(t, &s->of, &part, near)) return NULL;
        s->l->queried[s->direction] = begin;
    }
    return t->hit + (int64_t)(o - begin) * t->others;
}

/* Appends the pairs of own features `begin` to `end` with all features of `near`. */
static int append_pairs(const pair_query *s, const fl_feature_set *mine, int32_t begin, int32_t end,
                        const fl_feature_set *near)
{
    const int32_t edges = mine->vertices, faces = edges + mine->edges;
    for (int32_t o = begin; o < end; o++) {
        const int kind = o < edges ? FL_PAIR_VERTEX_FACE : o < faces ? FL_PAIR_EDGE_FACE : FL_PAIR_FACE_FACE;
        const int32_t own = o < edges   ? mine->vertex[o]
                            : o < faces ? mine->edge[o - edges]
                                        : mine->face[o - faces];
        const uint32_t *hit = hits_of_feature(s, mine, o, near);
        if (!hit) return -1;
        if (kind == FL_PAIR_EDGE_FACE && !(fl_edge_integral_factor(s->of.own, own, s->of.other->r) > 0.0))
            continue;
        for (int32_t k = 0; k < near->faces; k++, hit++)
            if (*hit && append_pair(s, kind, own, near->face[k], *hit)) return -1;
        for (int32_t k = 0; k < near->edges; k++, hit++)
            if (*hit && append_pair(s, kind + 1, own, near->edge[k], *hit)) return -1;
        for (int32_t k = 0; k < near->vertices; k++, hit++)
            if (*hit && append_pair(s, kind + 2, own, near->vertex[k], *hit)) return -1;
    }
    return 0;
}

/* Marks each once: mark[0 .. nv) for vertices, mark[nv .. nv + nf) for faces. */
static int mark_used(list_draft *l, int32_t at, int32_t number)
{
    if (l->mark[at]) return 0;
    l->mark[at] = 1;
    const int32_t n = l->used_v + l->used_f;
    if (fl_reserve(&l->used, &l->used_cap, (int64_t)n + 1, sizeof *l->used)) return -1;
    l->used[n] = number;
    return 0;
}

/* Vertices of A that the list uses, then faces. */
static int list_used_features(list_draft *l, const fl_poly *p)
{
    if (fl_reserve(&l->mark, &l->mark_cap, (int64_t)p->nv + p->nf, sizeof *l->mark)) return -1;
    memset(l->mark, 0, (size_t)p->nv + (size_t)p->nf);
    l->used_v = l->used_f = 0;
    for (int faces = 0; faces < 2; faces++) {
        for (int32_t k = 0; k < l->n; k++) {
            const pair_row *m = &l->c[k];
            const enum feature of = m->direction ? other_kind(m) : own_kind(m);
            const int32_t i = m->direction ? m->other : m->own;
            const int32_t edge[2] = {of == EDGE ? p->edge[i].a : i, of == EDGE ? p->edge[i].b : i};
            const int32_t *at = of == FACE ? p->loop + p->first[i] : edge;
            const int32_t n = of == FACE ? p->first[i + 1] - p->first[i] : 2;
            for (int32_t c = 0; c < n && !faces; c++) {
                const int fresh = !l->mark[at[c]];
                if (mark_used(l, at[c], at[c])) return -1;
                l->used_v += fresh;
            }
            if (faces && of == FACE) {
                const int fresh = !l->mark[p->nv + i];
                if (mark_used(l, p->nv + i, i)) return -1;
                l->used_f += fresh;
            }
        }
    }
    return 0;
}

/* --- the block ------------------------------------------------------------------------------------------ */

/* Writes integers into a block; width as in the list.  COUNT_ONLY: counts them and finds the largest. */
enum { COUNT_ONLY = -1 };
typedef struct {
    void *at;
    int64_t n;
    int32_t most;
} integer_writer;

INLINE void write_integer(integer_writer *to, int wide, int32_t x)
{
    if (wide == COUNT_ONLY) to->most = x > to->most ? x : to->most;
    else if (wide == 0) ((uint8_t *)to->at)[to->n] = (uint8_t)x;
    else if (wide == 1) ((uint16_t *)to->at)[to->n] = (uint16_t)x;
    else ((int32_t *)to->at)[to->n] = x;
    to->n++;
}

INLINE void write_pair(integer_writer *to, int wide, const list_draft *d, const pair_row *m)
{
    const int edge = m->kind >= FL_PAIR_EDGE_FACE && m->kind <= FL_PAIR_EDGE_VERTEX;
    const enum feature over = other_kind(m);
    const int32_t *side = d->side + m->first;
    write_integer(to, wide, m->kind | m->direction << 3 | m->n << 4);
    write_integer(to, wide, m->own);
    write_integer(to, wide, m->other);
    write_integer(to, wide, m->kind == FL_PAIR_FACE_FACE ? m->corners : m->v[0]);
    if (edge) write_integer(to, wide, m->v[1]), write_integer(to, wide, m->factor);
    if (over != VERTEX) write_integer(to, wide, over == FACE ? m->height : m->length);
    for (int32_t k = 0; k < m->n + m->corners; k++) write_integer(to, wide, side[k]);
}

/* Indices of planes may be -1 and EDGE_BISECTOR; this offset makes them >= 0. */
enum { INDEX_OFFSET = -EDGE_BISECTOR };

INLINE void write_plane(integer_writer *to, int wide, const plane_key *q)
{
    write_integer(to, wide, q->f + INDEX_OFFSET), write_integer(to, wide, q->a + INDEX_OFFSET),
        write_integer(to, wide, q->b + INDEX_OFFSET), write_integer(to, wide, q->g + INDEX_OFFSET);
}

INLINE void write_all(integer_writer *to, int wide, const list_draft *d, int keeps)
{
    for (int direction = 0; direction < 2 && !keeps; direction++)
        for (int32_t k = 0; k < d->table[direction].planes; k++)
            write_plane(to, wide, &d->table[direction].plane[k]);
    for (int direction = 0; direction < 2; direction++)
        for (int32_t k = 0; k < d->table[direction].vertices; k++)
            write_integer(to, wide, d->table[direction].vertex[k]);
    for (int32_t k = 0; k < d->used_v + d->used_f; k++) write_integer(to, wide, d->used[k]);
    for (int32_t k = 0; k < d->n; k++) write_pair(to, wide, d, &d->c[k]);
}

static void write_block(void *at, int wide, const list_draft *d, int keeps)
{
    integer_writer to = {.at = at};
    if (wide == 0) write_all(&to, 0, d, keeps);
    else if (wide == 1) write_all(&to, 1, d, keeps);
    else write_all(&to, 2, d, keeps);
}

/* Packs the draft into a block of just the size it needs. */
static int pack_list(fl_feature_pairs *l, const list_draft *d, const fl_poly *a, const fl_poly *b)
{
    integer_writer count = {0};
    for (int direction = 0; direction < 2; direction++) { /* indices of distances are 32-bit integers */
        const row_table *t = &d->table[direction];
        if (t->planes > INT32_MAX / 2 / (t->vertices + FL_SIMD_WIDTH)) return -1;
    }
    write_all(&count, COUNT_ONLY, d, l->stores_planes);
    const int wide = count.most <= UINT8_MAX ? 0 : count.most <= UINT16_MAX ? 1 : 2;
    const int64_t planes = (int64_t)d->table[0].planes + d->table[1].planes,
                  bytes = (l->stores_planes ? planes * (int64_t)sizeof(fl_core_plane) : 0) +
                          d->numbers * (int64_t)sizeof(double) + (count.n << wide);
    /* a list lives long: no memory is kept in reserve */
    if (l->size < bytes || l->size > bytes + bytes / 4) {
        free(l->block);
        l->block = NULL;
        l->size = 0;
        if (fl_reserve(&l->block, &l->size, bytes, 1)) return -1;
    }
    fl_core_plane *cut = l->block;
    for (int direction = 0; direction < 2; direction++) {
        const row_table *t = &d->table[direction];
        for (int32_t k = 0; k < t->planes && l->stores_planes; k++)
            *cut++ = plane_of(direction ? a : b, &t->plane[k]);
        l->planes[direction] = t->planes;
        l->vertices[direction] = t->vertices;
    }
    double *number_index = (double *)(void *)cut;
    for (int32_t k = 0; k < d->numbers; k++) *number_index++ = d->value[k];
    l->numbers = d->numbers;
    l->used_vertices = d->used_v, l->used_faces = d->used_f;
    l->n = d->n;
    l->width = (int16_t)wide;
    write_block(number_index, wide, d, l->stores_planes);
    return 0;
}

INLINE void make_planes(const fl_feature_pairs *l, int wide, int direction, const fl_poly *p,
                        fl_core_plane *out)
{
    const void *indices = fl_feature_pairs_plane_indices(l);
    int64_t at = direction ? 4 * (int64_t)l->planes[0] : 0;
    for (int32_t k = 0; k < l->planes[direction]; k++, at += 4) {
        const plane_key q = {.f = fl_feature_integer(indices, wide, at) - INDEX_OFFSET,
                             .a = fl_feature_integer(indices, wide, at + 1) - INDEX_OFFSET,
                             .b = fl_feature_integer(indices, wide, at + 2) - INDEX_OFFSET,
                             .g = fl_feature_integer(indices, wide, at + 3) - INDEX_OFFSET};
        out[k] = plane_of(p, &q);
    }
}

void fl_feature_pairs_make_planes(const fl_feature_pairs *l, int direction, const fl_poly *p,
                                  fl_core_plane *out)
{
    if (l->width == 0) make_planes(l, 0, direction, p, out);
    else make_planes(l, l->width, direction, p, out);
}

/* --- the list ------------------------------------------------------------------------------------------- */

/* Margins over R: the first, before the path per evaluation is known, and bounds of the later ones.
 * BUILD_COST: cost of a list over the additional cost of an evaluation for a margin of R, by instruction
 * counts. */
#define FIRST_MARGIN 0.05
#define MIN_MARGIN 0.01
#define MAX_MARGIN 0.3
#define BUILD_COST 6.0

double fl_feature_pairs_margin(const fl_feature_pairs *l, double R)
{
    if (!(l->margin > 0.0)) return FIRST_MARGIN * R;
    const double best = sqrt(BUILD_COST * R * l->margin / (double)l->uses);
    return best < MIN_MARGIN * R ? MIN_MARGIN * R : best > MAX_MARGIN * R ? MAX_MARGIN * R : best;
}

/* Clears the draft.  No list has number 0, which empty slots have. */
static int clear_draft(list_draft *d)
{
    if (d->lists == INT32_MAX || d->slots == 0) {
        free(d->slot);
        d->slot = NULL;
        d->slots = d->lists = 0;
        if (grow_slots(d)) return -1;
    }
    d->lists++;
    d->filled = d->n = d->sides = d->numbers = 0;
    for (int k = 0; k < 2; k++) d->table[k].vertices = d->table[k].planes = 0, d->queried[k] = -1;
    return 0;
}

int fl_feature_pairs_build(fl_feature_pairs *l, fl_patch_points *w, const fl_patch_core *A,
                           const fl_feature_set *a, const fl_patch_core *B, const fl_feature_set *b, double R,
                           double prism_depth, double margin)
{
    double far = 0.0;
    l->max_shift2 = 0.0; /* invalid until complete */
    l->n = l->separated = 0;
    if (!w->draft) {
        fl_err lost = {0};
        if (!(w->draft = fl_alloc(1, sizeof *w->draft, &lost))) return -1;
    }
    for (int32_t v = 0; v < A->p->nv; v++) far = fmax(far, v3_norm2(A->p->v[v]));
    far = sqrt(far) + R + margin;
    const double half = 0.5 * margin, turn = half / far; /* half of it for the shift, half for the turn */
    const double wide = margin + PLANE_TOL * (A->p->size + B->p->size);
    list_draft *d = w->draft;
    const fl_vec3 o = w->o;
    const double room = l->stores_planes ? -1.0 : wide + PLANE_TOL * (fabs(o.x) + fabs(o.y) + fabs(o.z));
    const pair_query of_a = {d, 0, {A, B, R, prism_depth, wide, turn - FL_FACE_PAIR_COSINE, room, far, o}},
                     of_b = {d, 1, {B, A, R, prism_depth, wide, turn - FL_FACE_PAIR_COSINE, room, far, o}};
    const int32_t last_a = a->vertices + a->edges + a->faces, last_b = b->vertices + b->edges + b->faces;
    if (clear_draft(d)) return -1;
    if (append_pairs(&of_a, a, 0, a->vertices, b) || append_pairs(&of_b, b, 0, b->vertices, a) ||
        append_pairs(&of_a, a, a->vertices, last_a, b) || append_pairs(&of_b, b, b->vertices, last_b, a) ||
        list_used_features(d, A->p) || pack_list(l, d, A->p, B->p))
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
    const void *integers = fl_feature_pairs_integers(l);
    const int32_t from = l->vertices[0] + l->vertices[1];
    for (int32_t k = from; k < from + l->used_vertices; k++) {
        const int32_t v = fl_feature_integer(integers, l->width, k);
        w->va[v] = v3_add(m3_mul(M, a->v[v]), o);
    }
    for (int32_t k = from + l->used_vertices; k < from + l->used_vertices + l->used_faces; k++) {
        const int32_t f = fl_feature_integer(integers, l->width, k);
        w->na[f] = m3_mul(M, a->n[f]);
    }
    return 0;
}

void fl_feature_draft_free(list_draft *d)
{
    if (!d) return;
    for (int k = 0; k < 2; k++) free(d->table[k].vertex), free(d->table[k].plane);
    free(d->c), free(d->side), free(d->used), free(d->value), free(d->mark), free(d->slot);
    fl_feature_filter_free(&d->filter[0]), fl_feature_filter_free(&d->filter[1]);
    free(d);
}

void fl_feature_pairs_forget(fl_feature_pairs *l)
{
    l->max_shift2 = 0.0;
    for (int32_t k = 0; k < l->parts; k++) l->part[k].max_shift2 = 0.0;
}

void fl_feature_pairs_free(fl_feature_pairs *l)
{
    free(l->block), free(l->candidate), free(l->part);
    *l = (fl_feature_pairs){0};
}

double fl_feature_pairs_bytes(const fl_feature_pairs *l)
{
    double sum = (double)(sizeof *l + (size_t)l->size + (size_t)l->candidate_cap * sizeof(int32_t));
    for (int32_t k = 0; k < l->parts; k++) sum += fl_feature_pairs_bytes(&l->part[k]);
    return sum;
}
