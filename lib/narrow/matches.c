/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "narrow/matches.h"
#include "base/mem.h"
#include "geom/aabb.h"
#include "narrow/areas.h"
#include "narrow/footing.h"
#include "narrow/strips.h"

/* Of the size: points on a plane may seem to be that far off it. */
#define ROUNDING 1e-12

/* So far back are rows and columns looked for. */
enum { LATEST = 128 };

/* Some points of `own`, the ends of a feature, and the box around them and all that they may move to; of an
 * edge the part that is beyond all that was asked so far. */
typedef struct {
    const fl_vec3 *v;
    const int32_t *at;
    int32_t n;
    fl_aabb box;
    fl_span left;
} ends;

/* A plane of a core: of face f; or at right angles to it through the edge from vertex a to b, its left side
 * above; or, f = -1, at right angles to that edge in a, the side of b above. */
typedef struct {
    int32_t f, a, b; /* a = -1: the face itself */
} plane;

/* A match, and the table of one way, while they are listed. */
typedef struct {
    int32_t kind, way, own, other;
    int32_t v[2];     /* columns */
    int32_t first, n; /* sides; columns of corners follow */
    int32_t corners, height, factor, length;
} match;

typedef struct {
    int32_t *vertex;
    plane *plane;
    int32_t vertices, planes, vertex_cap, plane_cap;
} table;

/* A number, and of which feature it is. */
typedef struct {
    double number;
    int32_t edge;
    int16_t way, length; /* the length of an edge of the other; else the factor of an own one */
} known;

typedef struct fl_draft {
    match *c;
    int32_t *side, *used;
    known *known;
    uint8_t *mark;
    table table[2];
    int32_t n, cap, sides, side_cap, used_v, used_f, used_cap, numbers, known_cap, mark_cap;
} draft;

typedef struct {
    draft *l;
    int way;
    const fl_side *own, *other;
    double R, behind, margin, turn;
} search;

/* Number of a column of the table; -1 when memory runs out.  What is not found among the latest is listed
 * again. */
static int32_t column(const search *s, int32_t v)
{
    table *t = &s->l->table[s->way];
    fl_err lost = {0};
    for (int32_t k = t->vertices; k-- > 0 && k > t->vertices - LATEST;)
        if (t->vertex[k] == v) return k;
    if (fl_grow(&t->vertex, &t->vertex_cap, (int64_t)t->vertices + 1, sizeof *t->vertex, &lost)) return -1;
    t->vertex[t->vertices] = v;
    return t->vertices++;
}

static fl_cut cut_of(const fl_poly *p, const plane *q)
{
    const fl_vec3 from = q->a < 0 ? p->v[p->loop[p->first[q->f]]] : p->v[q->a];
    const fl_vec3 u = q->a < 0 ? v3(0, 0, 0) : v3_sub(p->v[q->b], from);
    const fl_vec3 g = q->a < 0 ? p->n[q->f] : q->f < 0 ? u : v3_cross(p->n[q->f], u);
    return (fl_cut){g, v3_dot(g, from)};
}

static int32_t row(const search *s, int32_t f, int32_t a, int32_t b)
{
    table *t = &s->l->table[s->way];
    fl_err lost = {0};
    for (int32_t k = t->planes; k-- > 0 && k > t->planes - LATEST;)
        if (t->plane[k].f == f && t->plane[k].a == a && t->plane[k].b == b) return k;
    if (fl_grow(&t->plane, &t->plane_cap, (int64_t)t->planes + 1, sizeof *t->plane, &lost)) return -1;
    t->plane[t->planes] = (plane){f, a, b};
    return t->planes++;
}

/* Which of the numbers is the factor of an own edge, or the length of one of the other. */
static int32_t number(const search *s, int32_t edge, int length)
{
    draft *l = s->l;
    fl_err lost = {0};
    for (int32_t k = l->numbers; k-- > 0 && k > l->numbers - LATEST;)
        if (l->known[k].edge == edge && l->known[k].way == s->way && l->known[k].length == length) return k;
    if (fl_grow(&l->known, &l->known_cap, (int64_t)l->numbers + 1, sizeof *l->known, &lost)) return -1;
    const fl_poly *p = s->other->p;
    const double x = length
                         /* the same bits in any pose */
                         ? v3_norm(v3_sub(p->v[p->edge[edge].b], p->v[p->edge[edge].a]))
                         : fl_strips_factor(s->own, edge, s->other->r);
    l->known[l->numbers] = (known){x, edge, (int16_t)s->way, (int16_t)length};
    return l->numbers++;
}

static int push(draft *l, int32_t side)
{
    fl_err lost = {0};
    if (fl_grow(&l->side, &l->side_cap, (int64_t)l->sides + 1, sizeof *l->side, &lost)) return -1;
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

static int sides_of_face(const search *s, match *m)
{
    const fl_poly *p = s->other->p;
    const int32_t *loop = p->loop + p->first[m->other], n = p->first[m->other + 1] - p->first[m->other];
    m->height = row(s, m->other, -1, -1);
    for (int32_t c = 0, a = loop[n - 1]; c < n; a = loop[c++])
        if (beyond(s, m, m->other, a, loop[c], 0)) return -1;
    return m->height < 0 ? -1 : 0;
}

static int sides_of_edge(const search *s, match *m)
{
    const fl_edge g = s->other->p->edge[m->other];
    m->length = number(s, m->other, 1);
    return m->length < 0 || beyond(s, m, -1, g.a, g.b, 0) || beyond(s, m, -1, g.b, g.a, 0) ||
                   (g.left >= 0 && beyond(s, m, g.left, g.a, g.b, 1)) ||
                   (g.right >= 0 && beyond(s, m, g.right, g.b, g.a, 1))
               ? -1
               : 0;
}

static int sides_of_vertex(const search *s, match *m)
{
    const fl_poly *p = s->other->p;
    for (int32_t k = p->begin[m->other]; k < p->begin[m->other + 1]; k++)
        if (beyond(s, m, -1, m->other, p->beside[k], 1)) return -1;
    return 0;
}

static int add(const search *s, int kind, int32_t own, int32_t other)
{
    draft *l = s->l;
    const fl_poly *p = s->own->p;
    match m = {.kind = kind, .way = s->way, .own = own, .other = other, .first = l->sides};
    fl_err lost = {0};
    if (fl_grow(&l->c, &l->cap, (int64_t)l->n + 1, sizeof *l->c, &lost)) return -1;
    const int face = kind == FL_MATCH_VERTEX_FACE || kind == FL_MATCH_EDGE_FACE || kind == FL_MATCH_FACE_FACE;
    const int edge = kind == FL_MATCH_VERTEX_EDGE || kind == FL_MATCH_EDGE_EDGE;
    if (face ? sides_of_face(s, &m) : edge ? sides_of_edge(s, &m) : sides_of_vertex(s, &m)) return -1;
    if (kind == FL_MATCH_FACE_FACE) {
        m.corners = p->first[own + 1] - p->first[own];
        for (int32_t k = p->first[own]; k < p->first[own + 1]; k++) {
            const int32_t v = column(s, p->loop[k]);
            if (v < 0 || push(l, v)) return -1;
        }
    } else if (kind >= FL_MATCH_EDGE_FACE) {
        m.v[0] = column(s, p->edge[own].a);
        m.v[1] = column(s, p->edge[own].b);
        m.factor = number(s, own, 0);
    } else {
        m.v[0] = m.v[1] = column(s, own);
    }
    l->c[l->n++] = m;
    return m.v[0] < 0 || m.v[1] < 0 || m.factor < 0 ? -1 : 0;
}

static ends ends_of(const search *s, const int32_t *at, int32_t n)
{
    ends e = {s->own->v, at, n, aabb_empty(), {0.0, 1.0}};
    for (int32_t k = 0; k < n; k++) e.box = aabb_add(e.box, s->own->v[at[k]]);
    e.box = aabb_grow(e.box, s->R + s->margin);
    return e;
}

/* Some point is beyond the plane through `from` with normal g, or may come there; of an edge one that was
 * beyond all before.  The margin has room for the rounding of where the edge is cut. */
static int reaches(const search *s, ends *e, fl_vec3 from, fl_vec3 g)
{
    const double enough = -s->margin * v3_norm(g);
    if (e->n == 2)
        return fl_span_keep(&e->left, v3_dot(g, v3_sub(e->v[e->at[0]], from)) - enough,
                            v3_dot(g, v3_sub(e->v[e->at[1]], from)) - enough);
    for (int32_t k = 0; k < e->n; k++)
        if (v3_dot(g, v3_sub(e->v[e->at[k]], from)) >= enough) return 1;
    return 0;
}

/* What is left of an edge, or a vertex, comes within R of the point c, or of the line through it along u, or
 * may. */
static int nears(const search *s, const ends *e, fl_vec3 c, fl_vec3 u)
{
    const fl_vec3 x = e->v[e->at[0]], way = v3_sub(e->v[e->at[e->n - 1]], x);
    const double uu = v3_norm2(u), each = uu > 0.0 ? 1.0 / uu : 0.0, far = s->R + s->margin;
    const fl_vec3 r = v3_sub(x, c), q = v3_madd(r, -each * v3_dot(r, u), u),
                  w = v3_madd(way, -each * v3_dot(way, u), u);
    const double ww = v3_norm2(w), t = ww > 0.0 ? -v3_dot(q, w) / ww : 0.0;
    const double at = t < e->left.lo ? e->left.lo : t > e->left.hi ? e->left.hi : t;
    return v3_norm2(v3_madd(q, at, w)) < far * far;
}

static fl_vec3 leftward(const fl_side *q, int32_t f, int32_t a, int32_t b)
{
    return v3_cross(q->n[f], v3_sub(q->v[b], q->v[a]));
}

static int over_face(const search *s, const ends *own, int32_t f)
{
    ends part = *own, *const e = &part;
    const fl_poly *p = s->other->p;
    const fl_vec3 *v = s->other->v, n = s->other->n[f];
    const int32_t *loop = p->loop + p->first[f], sides = p->first[f + 1] - p->first[f];
    if (!reaches(s, e, v3_madd(v[loop[0]], s->R, n), v3_neg(n))) return 0;
    if (!reaches(s, e, v3_madd(v[loop[0]], -s->behind, n), n)) return 0;
    for (int32_t c = 0, a = loop[sides - 1]; c < sides; a = loop[c++])
        if (!reaches(s, e, v[a], leftward(s->other, f, a, loop[c]))) return 0;
    return 1;
}

static int over_edge(const search *s, const ends *own, int32_t k)
{
    ends part = *own, *const e = &part;
    const fl_edge g = s->other->p->edge[k];
    const fl_vec3 a = s->other->v[g.a], b = s->other->v[g.b], u = v3_sub(b, a);
    if (!(s->other->p->bend[k] > 0.0)) return 0;
    if (!aabb_meet(e->box, aabb_add((fl_aabb){a, a}, b))) return 0;
    if (!reaches(s, e, a, u) || !reaches(s, e, b, v3_neg(u))) return 0;
    if (g.left >= 0 && !reaches(s, e, a, v3_neg(leftward(s->other, g.left, g.a, g.b)))) return 0;
    if (g.right >= 0 && !reaches(s, e, a, leftward(s->other, g.right, g.a, g.b))) return 0;
    return nears(s, e, a, u);
}

static int over_vertex(const search *s, const ends *own, int32_t v)
{
    ends part = *own, *const e = &part;
    const fl_poly *p = s->other->p;
    const fl_vec3 c = s->other->v[v];
    if (!(p->defect[v] > 0.0) || !aabb_meet(e->box, (fl_aabb){c, c})) return 0;
    for (int32_t m = p->begin[v]; m < p->begin[v + 1]; m++)
        if (!reaches(s, e, c, v3_sub(c, s->other->v[p->beside[m]]))) return 0;
    return nears(s, e, c, v3(0, 0, 0));
}

/* Feature `own` over all of the others. */
static int over_all(const search *s, int kind, int32_t own, const ends *e, const fl_reach *near)
{
    for (int32_t k = 0; k < near->faces; k++)
        if (over_face(s, e, near->face[k]) && add(s, kind, own, near->face[k])) return -1;
    for (int32_t k = 0; k < near->edges; k++)
        if (over_edge(s, e, near->edge[k]) && add(s, kind + 1, own, near->edge[k])) return -1;
    for (int32_t k = 0; k < near->vertices; k++)
        if (over_vertex(s, e, near->vertex[k]) && add(s, kind + 2, own, near->vertex[k])) return -1;
    return 0;
}

static int vertices(const search *s, const fl_reach *mine, const fl_reach *near)
{
    for (int32_t k = 0; k < mine->vertices; k++) {
        const ends e = ends_of(s, &mine->vertex[k], 1);
        if (over_all(s, FL_MATCH_VERTEX_FACE, mine->vertex[k], &e, near)) return -1;
    }
    return 0;
}

static int edges_and_faces(const search *s, const fl_reach *mine, const fl_reach *near)
{
    const fl_poly *p = s->own->p;
    for (int32_t k = 0; k < mine->edges; k++) {
        const int32_t at[2] = {p->edge[mine->edge[k]].a, p->edge[mine->edge[k]].b};
        if (!(fl_strips_factor(s->own, mine->edge[k], s->other->r) > 0.0)) continue;
        const ends e = ends_of(s, at, 2);
        if (over_all(s, FL_MATCH_EDGE_FACE, mine->edge[k], &e, near)) return -1;
    }
    for (int32_t k = 0; k < mine->faces; k++) {
        const int32_t F = mine->face[k];
        const ends e = ends_of(s, p->loop + p->first[F], p->first[F + 1] - p->first[F]);
        for (int32_t m = 0; m < near->faces; m++) {
            const int32_t f = near->face[m];
            if (v3_dot(s->own->n[F], s->other->n[f]) > s->turn - FL_AREAS_COS || !over_face(s, &e, f))
                continue;
            if (add(s, FL_MATCH_FACE_FACE, F, f)) return -1;
        }
    }
    return 0;
}

/* Once each: mark[0 .. nv) for the vertices, mark[nv .. nv + nf) for the faces. */
static int use(draft *l, int32_t at, int32_t number)
{
    fl_err lost = {0};
    if (l->mark[at]) return 0;
    l->mark[at] = 1;
    const int32_t n = l->used_v + l->used_f;
    if (fl_grow(&l->used, &l->used_cap, (int64_t)n + 1, sizeof *l->used, &lost)) return -1;
    l->used[n] = number;
    return 0;
}

enum feature { VERTEX, EDGE, FACE };

static enum feature own_of(const match *m)
{
    return m->kind <= FL_MATCH_VERTEX_VERTEX ? VERTEX : m->kind <= FL_MATCH_EDGE_VERTEX ? EDGE : FACE;
}

static enum feature other_of(const match *m)
{
    if (m->kind == FL_MATCH_VERTEX_VERTEX || m->kind == FL_MATCH_EDGE_VERTEX) return VERTEX;
    return m->kind == FL_MATCH_VERTEX_EDGE || m->kind == FL_MATCH_EDGE_EDGE ? EDGE : FACE;
}

/* Vertices of A that the list speaks of, then faces. */
static int list_used(draft *l, const fl_poly *p)
{
    fl_err lost = {0};
    if (fl_grow(&l->mark, &l->mark_cap, (int64_t)p->nv + p->nf, sizeof *l->mark, &lost)) return -1;
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

/* Whole numbers on their way into a block; without one they are counted, and the largest is found. */
typedef struct {
    uint16_t *narrow;
    int32_t *wide;
    int64_t n;
    int32_t most;
} whole;

static void put(whole *to, int32_t x)
{
    if (to->narrow) to->narrow[to->n] = (uint16_t)x;
    if (to->wide) to->wide[to->n] = x;
    if (x > to->most) to->most = x;
    to->n++;
}

static void put_match(whole *to, const draft *d, const match *m)
{
    const int edge = m->kind >= FL_MATCH_EDGE_FACE && m->kind <= FL_MATCH_EDGE_VERTEX;
    const enum feature over = other_of(m);
    const int32_t *side = d->side + m->first, columns = fl_matches_columns(d->table[m->way].vertices);
    put(to, m->kind | m->way << 3 | m->n << 4);
    put(to, m->own);
    put(to, m->other);
    put(to, m->kind == FL_MATCH_FACE_FACE ? m->corners : m->v[0]);
    if (edge) put(to, m->v[1]), put(to, m->factor);
    if (over != VERTEX) put(to, over == FACE ? columns * m->height : m->length);
    for (int32_t k = 0; k < m->n; k++) put(to, columns * (side[k] & ~1) | (side[k] & 1));
    for (int32_t k = 0; k < m->corners; k++) put(to, side[m->n + k]);
}

static void put_all(whole *to, const draft *d)
{
    for (int way = 0; way < 2; way++)
        for (int32_t k = 0; k < d->table[way].vertices; k++) put(to, d->table[way].vertex[k]);
    for (int32_t k = 0; k < d->used_v + d->used_f; k++) put(to, d->used[k]);
    for (int32_t k = 0; k < d->n; k++) put_match(to, d, &d->c[k]);
}

/* What has been drafted, in a block as long as it must be. */
static int pack(fl_matches *l, const draft *d, const fl_poly *a, const fl_poly *b)
{
    whole count = {0};
    fl_err lost = {0};
    for (int way = 0; way < 2; way++) { /* heights are told by numbers of 32 bits, times two */
        const table *t = &d->table[way];
        if (t->planes > INT32_MAX / 2 / (t->vertices + FL_LANES)) return -1;
    }
    put_all(&count, d);
    const int wide = count.most > UINT16_MAX;
    const int64_t planes = (int64_t)d->table[0].planes + d->table[1].planes,
                  bytes = planes * (int64_t)sizeof(fl_cut) + d->numbers * (int64_t)sizeof(double) +
                          count.n * (int64_t)(wide ? sizeof(int32_t) : sizeof(uint16_t));
    if (l->size < bytes || l->size > bytes + bytes / 4) { /* a list lasts: nothing is kept in vain */
        free(l->block);
        l->block = NULL;
        l->size = 0;
        if (fl_grow(&l->block, &l->size, bytes, 1, &lost)) return -1;
    }
    fl_cut *cut = l->block;
    for (int way = 0; way < 2; way++) {
        const table *t = &d->table[way];
        for (int32_t k = 0; k < t->planes; k++) *cut++ = cut_of(way ? a : b, &t->plane[k]);
        l->cuts[way] = t->planes;
        l->vertices[way] = t->vertices;
    }
    double *number = (double *)(void *)cut;
    for (int32_t k = 0; k < d->numbers; k++) *number++ = d->known[k].number;
    l->numbers = d->numbers;
    l->used_v = d->used_v, l->used_f = d->used_f;
    l->n = d->n;
    l->wide = (int16_t)wide;
    put_all(&(whole){.narrow = wide ? NULL : (void *)number, .wide = wide ? (void *)number : NULL}, d);
    return 0;
}

/* --- the list ---------------------------------------------------------------------------------- */

/* Margins over R: the first, before the way from look to look is known, and bounds of those after.  PRICE:
 * of a list, over what a look costs more for a margin of R; by counts of instructions, side on side. */
#define FIRST 0.05
#define LEAST 0.01
#define MOST 0.3
#define PRICE 4.0

double fl_matches_margin(const fl_matches *l, double R)
{
    if (!(l->margin > 0.0)) return FIRST * R;
    const double best = sqrt(PRICE * R * l->margin / (double)l->uses);
    return best < LEAST * R ? LEAST * R : best > MOST * R ? MOST * R : best;
}

int fl_matches_list(fl_matches *l, fl_places *w, const fl_side *A, const fl_reach *a, const fl_side *B,
                    const fl_reach *b, double R, double behind, double margin)
{
    double far = 0.0;
    fl_err lost = {0};
    l->shift2 = 0.0; /* half a list */
    l->n = l->clear = 0;
    if (!w->draft && !(w->draft = fl_alloc(1, sizeof *w->draft, &lost))) return -1;
    for (int32_t v = 0; v < A->p->nv; v++) far = fmax(far, v3_norm2(A->p->v[v]));
    far = sqrt(far) + R + margin;
    const double half = 0.5 * margin, turn = half / far; /* half of it for the shift, half for the turn */
    const double wide = margin + ROUNDING * (A->p->size + B->p->size);
    draft *d = w->draft;
    const search of_a = {d, 0, A, B, R, behind, wide, turn}, of_b = {d, 1, B, A, R, behind, wide, turn};
    d->n = d->sides = d->numbers = 0;
    for (int k = 0; k < 2; k++) d->table[k].vertices = d->table[k].planes = 0;
    if (vertices(&of_a, a, b) || vertices(&of_b, b, a) || edges_and_faces(&of_a, a, b) ||
        edges_and_faces(&of_b, b, a) || list_used(d, A->p) || pack(l, d, A->p, B->p))
        return -1;
    l->M = w->M, l->o = w->o;
    l->shift2 = half * half, l->turn2 = turn * turn;
    l->margin = margin, l->uses = 1;
    return 0;
}

void fl_draft_free(draft *d)
{
    if (!d) return;
    for (int k = 0; k < 2; k++) free(d->table[k].vertex), free(d->table[k].plane);
    free(d->c), free(d->side), free(d->used), free(d->known), free(d->mark);
    free(d);
}

void fl_matches_free(fl_matches *l)
{
    free(l->block), free(l->wall);
    fl_footing_free(l->footing);
    *l = (fl_matches){0};
}

double fl_matches_bytes(const fl_matches *l)
{
    return (double)(sizeof *l + (size_t)l->size + (size_t)l->wall_cap * sizeof(int32_t));
}
