/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/simd.h"
#include "mesh/tri_separation.h"
#include "mesh/crossing.h"
#include "mesh/vertex_fans.h"

/* --- the order of triangles in space -------------------------------------------------------------------- */

enum {
    LANES = 8, /* triangles of a leaf, leaves of a box of the next level, and so on */
    STEP = 3,  /* its power of two */
    LEVELS = 12,
    BITS = 21,   /* of a coordinate along the curve */
    DIGIT = 11,  /* bits, of the sort */
    PASSES = 4,  /* of the sort: what differs below them is sorted by itself */
    ALONE = 2048 /* triangles for which one thread does: waking the others takes longer */
};

typedef struct {
    float lo[3], hi[3]; /* outward of the numbers they stand for */
} box;

typedef struct {
    uint64_t key;
    int32_t t;
} place;

/* The low 21 bits, two zeros between each and the next. */
static uint64_t spread(uint64_t x)
{
    x = (x | x << 32) & UINT64_C(0x1f00000000ffff);
    x = (x | x << 16) & UINT64_C(0x1f0000ff0000ff);
    x = (x | x << 8) & UINT64_C(0x100f00f00f00f00f);
    x = (x | x << 4) & UINT64_C(0x10c30c30c30c30c3);
    return (x | x << 2) & UINT64_C(0x1249249249249249);
}

static uint64_t cell_of(double x, double cells)
{
    const double most = (1 << BITS) - 1, c = x * cells;
    return (uint64_t)(c > 0.0 ? c < most ? c : most : 0.0);
}

static int comes_before(const place *a, const place *b)
{
    return a->key != b->key ? a->key < b->key : a->t < b->t;
}

static int by_key(const void *a, const void *b) { return comes_before(b, a) - comes_before(a, b); }

/* Places whose keys begin alike, in the order of their triangles: few, but where triangles are crowded. */
static void sort_alike(place *at, int32_t n)
{
    enum { FEW = 16 };
    if (n > FEW) {
        qsort(at, (size_t)n, sizeof *at, by_key);
        return;
    }
    for (int32_t i = 1; i < n; i++) {
        const place x = at[i];
        int32_t k = i;
        for (; k > 0 && comes_before(&x, &at[k - 1]); k--) at[k] = at[k - 1];
        at[k] = x;
    }
}

/* By key, the lower triangle first on a tie: the leading digits from the last of them on, each pass keeping
 * the order, and then what they leave open. */
static void sort_places(place **at, place **other, int32_t n)
{
    enum { WORDS = 1 << DIGIT, REST = 3 * BITS - PASSES * DIGIT };
    for (int pass = 0; pass < PASSES; pass++) {
        const int shift = REST + pass * DIGIT;
        int32_t first[WORDS + 1] = {0};
        place *from = *at, *to = *other;
        for (int32_t k = 0; k < n; k++) first[(from[k].key >> shift & (WORDS - 1)) + 1]++;
        if (first[(from[0].key >> shift & (WORDS - 1)) + 1] == n) continue; /* all the same */
        for (int w = 0; w < WORDS; w++) first[w + 1] += first[w];
        for (int32_t k = 0; k < n; k++) to[first[from[k].key >> shift & (WORDS - 1)]++] = from[k];
        *at = to;
        *other = from;
    }
    for (int32_t i = 0, j; i < n; i = j) {
        for (j = i + 1; j < n && (*at)[j].key >> REST == (*at)[i].key >> REST; j++) {}
        if (j > i + 1) sort_alike(*at + i, j - i);
    }
}

/* Floats that are not more, and not less: x may be rounded by half a unit of its last place, which is at most
 * 2^-23 of it, once before and once here. */
static float below(double x)
{
    const float f = (float)x;
    return f - (fabsf(f) * 0x1p-22f + FLT_MIN);
}

static float above(double x)
{
    const float f = (float)x;
    return f + (fabsf(f) * 0x1p-22f + FLT_MIN);
}

static box box_of(const fl_part *p, int32_t t, fl_vec3 o)
{
    fl_aabb b = aabb_empty();
    for (int k = 0; k < 3; k++) b = aabb_add(b, v3_sub(p->v[p->t[t].v[k]], o));
    return (box){{below(b.lo.x), below(b.lo.y), below(b.lo.z)},
                 {above(b.hi.x), above(b.hi.y), above(b.hi.z)}};
}

static const box EMPTY = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void join(box *a, const box *b)
{
    for (int k = 0; k < 3; k++) {
        a->lo[k] = a->lo[k] < b->lo[k] ? a->lo[k] : b->lo[k];
        a->hi[k] = a->hi[k] > b->hi[k] ? a->hi[k] : b->hi[k];
    }
}

/* Eight boxes side by side for the vector units: of the triangles of a leaf, or of what lies beneath a box.
 * Places that are left over are empty (lo > hi) and meet nothing. */
typedef struct {
    float lo[3][LANES], hi[3][LANES];
} octet;

/* Their vertices, by corners; STRANGE for one that is not tame. */
typedef struct {
    int32_t v[3][LANES];
} names;
enum { STRANGE = -1, STRANGER = -2 };

static box box_in(const octet *o, int k)
{
    return (box){{o->lo[0][k], o->lo[1][k], o->lo[2][k]}, {o->hi[0][k], o->hi[1][k], o->hi[2][k]}};
}

static void put_box(octet *o, int k, const box *b)
{
    for (int c = 0; c < 3; c++) {
        o->lo[c][k] = b->lo[c];
        o->hi[c][k] = b->hi[c];
    }
}

static const int32_t BIT[LANES] = {1, 2, 4, 8, 16, 32, 64, 128};

/* The bits of all lanes.  (As a reduction of the loop before it this becomes eight steps one after the
 * other.)
 */
static inline unsigned together(const int32_t bits[LANES])
{
    uint64_t two[LANES / 2], all;
    memcpy(two, bits, sizeof two);
    all = (two[0] | two[1]) | (two[2] | two[3]);
    return (unsigned)(all | all >> 32);
}

/* A bit for each of the eight that a box meets. */
static inline unsigned meets_of(const octet *o, const box *b)
{
    int32_t bits[LANES];
#pragma omp simd
    for (int k = 0; k < LANES; k++) {
        const int32_t hit = (o->lo[0][k] <= b->hi[0]) & (o->hi[0][k] >= b->lo[0]) &
                            (o->lo[1][k] <= b->hi[1]) & (o->hi[1][k] >= b->lo[1]) &
                            (o->lo[2][k] <= b->hi[2]) & (o->hi[2][k] >= b->lo[2]);
        bits[k] = -hit & BIT[k];
    }
    return together(bits);
}

/* A bit for each of the eight that has one of three vertices. */
static inline unsigned shares_of(const names *o, const int32_t v[3])
{
    int32_t bits[LANES];
#pragma omp simd
    for (int k = 0; k < LANES; k++) {
        const int32_t hit = (o->v[0][k] == v[0]) | (o->v[1][k] == v[0]) | (o->v[2][k] == v[0]) |
                            (o->v[0][k] == v[1]) | (o->v[1][k] == v[1]) | (o->v[2][k] == v[1]) |
                            (o->v[0][k] == v[2]) | (o->v[1][k] == v[2]) | (o->v[2][k] == v[2]);
        bits[k] = -hit & BIT[k];
    }
    return together(bits);
}

/* Boxes of the triangles in their order, and level by level those of eight triangles (a leaf), of eight
 * leaves (a block), ... up to one octet. */
typedef struct {
    const fl_part *p;
    int32_t *order;       /* [p->nt] */
    names *name;          /* [n[0]] */
    int32_t *hub;         /* [n[1]] the tame vertex of all triangles of a block, STRANGE for none */
    octet *level[LEVELS]; /* [n[l]] */
    int32_t n[LEVELS];
    int levels; /* two or more */
} forest;

static void forest_free(forest *f)
{
    free(f->order);
    free(f->name);
    free(f->hub);
    free(f->level[0]);
    *f = (forest){0};
}

static int order_triangles(forest *f, fl_vec3 o, double side, fl_err *err)
{
    const int32_t n = f->p->nt;
    const double cells = side > 0.0 ? (1 << BITS) / side : 0.0;
    place *at = fl_alloc(n, sizeof *at, err), *other = at ? fl_alloc(n, sizeof *other, err) : NULL;
    if (other) {
#pragma omp parallel for schedule(static) if (n > ALONE)
        for (int32_t t = 0; t < n; t++) {
            const int32_t *v = f->p->t[t].v;
            const fl_vec3 middle =
                v3_scale(1.0 / 3.0, v3_add(v3_sub(f->p->v[v[0]], o),
                                           v3_add(v3_sub(f->p->v[v[1]], o), v3_sub(f->p->v[v[2]], o))));
            at[t].t = t;
            at[t].key = spread(cell_of(middle.x, cells)) | spread(cell_of(middle.y, cells)) << 1 |
                        spread(cell_of(middle.z, cells)) << 2;
        }
        sort_places(&at, &other, n);
        for (int32_t k = 0; k < n; k++) f->order[k] = at[k].t;
    }
    free(at);
    free(other);
    return other ? 0 : -1;
}

/* The vertices of the triangles, once it is known which of them are tame. */
static int forest_name(forest *f, fl_err *err)
{
    uint8_t *tame = fl_alloc(f->p->nv, 1, err);
    const int bad = !tame || fl_vertex_fans_simple(f->p, tame, err);
    if (!bad) {
#pragma omp parallel for schedule(static) if (f->p->nt > ALONE)
        for (int32_t at = 0; at < f->p->nt; at++)
            for (int c = 0; c < 3; c++) {
                const int32_t v = f->p->t[f->order[at]].v[c];
                f->name[at / LANES].v[c][at % LANES] = tame[v] ? v : STRANGE;
            }
    }
    free(tame);
    return bad ? -1 : 0;
}

/* A vertex that is tame and belongs to all triangles of block i, STRANGE for none. */
static int32_t hub_of(const forest *f, int32_t i)
{
    enum { MOST = LANES * LANES };
    const int32_t from = MOST * i, to = f->p->nt - from < MOST ? f->p->nt : from + MOST;
    for (int c = 0; c < 3; c++) {
        const int32_t v = f->name[from / LANES].v[c][0];
        int32_t at = v == STRANGE ? to + 1 : from + 1;
        for (; at < to; at++) {
            const names *o = &f->name[at / LANES];
            const int k = at % LANES;
            if (o->v[0][k] != v && o->v[1][k] != v && o->v[2][k] != v) break;
        }
        if (at == to) return v;
    }
    return STRANGE;
}

static int forest_make(forest *f, const fl_part *p, fl_err *err)
{
    const fl_aabb all = fl_part_aabb(p);
    const fl_vec3 wide = v3_sub(all.hi, all.lo);
    int64_t octets = 0;
    *f = (forest){.p = p};
    for (int64_t n = p->nt; f->levels < 2 || n > 1;) {
        n = (n + LANES - 1) / LANES;
        f->n[f->levels++] = (int32_t)n;
        octets += n;
    }
    if (!(f->order = fl_alloc(p->nt, sizeof *f->order, err)) ||
        order_triangles(f, all.lo, fmax(wide.x, fmax(wide.y, wide.z)), err) ||
        !(f->name = fl_alloc(f->n[0], sizeof *f->name, err)) || forest_name(f, err) ||
        !(f->hub = fl_alloc(f->n[1], sizeof *f->hub, err)) ||
        !(f->level[0] = fl_alloc(octets, sizeof *f->level[0], err))) {
        forest_free(f);
        return -1;
    }
#pragma omp parallel for schedule(static) if (p->nt > ALONE)
    for (int32_t i = 0; i < f->n[1]; i++) f->hub[i] = hub_of(f, i);
    for (int l = 0; l < f->levels; l++) {
        const int32_t under = l ? f->n[l - 1] : p->nt;
        if (l) f->level[l] = f->level[l - 1] + f->n[l - 1];
#pragma omp parallel for schedule(static) if (p->nt > ALONE)
        for (int32_t i = 0; i < f->n[l]; i++)
            for (int k = 0; k < LANES; k++) {
                const int32_t at = LANES * i + k;
                box b = EMPTY;
                if (l == 0 && at < under) b = box_of(p, f->order[at], all.lo);
                for (int m = 0; l > 0 && at < under && m < LANES; m++) {
                    const box one = box_in(&f->level[l - 1][at], m);
                    join(&b, &one);
                }
                put_box(&f->level[l][i], k, &b);
            }
    }
    return 0;
}

/* --- the search ----------------------------------------------------------------------------------------- */

typedef struct {
    int64_t crossings, touching;
    int failed;
    fl_err err;
} tally;

/* One pair.  Its verdict is the same whichever comes first. */
static void meet(fl_tri_data *a, fl_tri_data *b, tally *sum)
{
    double x[2][9];
    int how;
    if (fl_tri_separated(a, b)) return;
    for (int k = 0; k < 3; k++) {
        memcpy(x[a->t > b->t] + 3 * (ptrdiff_t)k, &a->x[k].x, sizeof a->x[k]);
        memcpy(x[a->t < b->t] + 3 * (ptrdiff_t)k, &b->x[k].x, sizeof b->x[k]);
    }
    how = fl_cgal_classify_triangles(x[0], x[1], &sum->err);
    sum->crossings += how == FL_CROSSES;
    sum->touching += how == FL_TOUCHES;
    sum->failed |= how < 0;
}

/* Of triangle k of leaf i with those of leaf j that it may meet. */
static void one_by_one(const forest *f, int32_t i, int k, int32_t j, unsigned hit, tally *sum)
{
    fl_tri_data own, other;
    fl_tri_load(f->p, f->order[LANES * i + k], &own);
    for (; hit; hit &= hit - 1) {
        fl_tri_load(f->p, f->order[LANES * j + __builtin_ctz(hit)], &other);
        meet(&own, &other, sum);
    }
}

/* Looked at together is what has half of its pairs left, or more: neighbours in a sheet have fewer. */
enum { MANY = LANES * LANES / 2 };

/* Is there a plane between bundles i and j of `many` triangles? */
static int bundles_apart(const forest *f, int32_t many, int32_t i, int32_t j)
{
    const int32_t n = f->p->nt, ni = n - many * i, nj = n - many * j;
    return i != j && fl_tri_groups_separated(f->p, f->order + many * i, ni < many ? ni : many,
                                             f->order + many * j, nj < many ? nj : many);
}

/* The triangles of leaf i against those of leaf j >= i.  Two that have a tame vertex in common do not cross.
 */
__attribute__((always_inline)) static inline void leaves(const forest *f, int32_t i, int32_t j, tally *sum)
{
    const octet *own = &f->level[0][i], *there = &f->level[0][j];
    const box all = box_in(&f->level[1][j / LANES], j % LANES);
    unsigned hits[LANES];
    int32_t who[LANES];
    int n = 0, pairs = 0;
    for (unsigned mine = meets_of(own, &all); mine; mine &= mine - 1) {
        const int k = __builtin_ctz(mine);
        const box b = box_in(own, k);
        unsigned hit = meets_of(there, &b);
        int32_t v[3];
        if (i == j) hit &= ~0u << k << 1;
        if (!hit) continue;
        for (int c = 0; c < 3; c++) {
            v[c] = f->name[i].v[c][k];
            if (v[c] == STRANGE) v[c] = STRANGER; /* which is nobody's name */
        }
        hit &= ~shares_of(&f->name[j], v);
        if (!hit) continue;
        hits[n] = hit;
        who[n++] = k;
        pairs += __builtin_popcount(hit);
    }
    if (pairs >= MANY && bundles_apart(f, LANES, i, j)) return;
    for (int k = 0; k < n; k++) one_by_one(f, i, who[k], j, hits[k], sum);
}

/* The leaves of block i against those of block j >= i.  In a fan of very many triangles most blocks have one
 * hub. */
__attribute__((always_inline)) static inline void blocks(const forest *f, int32_t i, int32_t j, tally *sum)
{
    const octet *own = &f->level[1][i], *there = &f->level[1][j];
    unsigned hits[LANES] = {0}, mine = ~(~0u << LANES);
    int pairs = 0;
    if (f->hub[i] != STRANGE && f->hub[i] == f->hub[j]) return;
    if (i != j) {
        const box all = box_in(&f->level[2][j / LANES], j % LANES);
        mine = meets_of(own, &all);
    }
    for (unsigned left = mine; left; left &= left - 1) {
        const int k = __builtin_ctz(left);
        const box b = box_in(own, k);
        hits[k] = meets_of(there, &b);
        if (i == j) hits[k] &= ~0u << k;
        pairs += __builtin_popcount(hits[k]);
    }
    if (pairs >= MANY && bundles_apart(f, LANES * LANES, i, j)) return;
    for (; mine; mine &= mine - 1) {
        const int k = __builtin_ctz(mine);
        for (unsigned hit = hits[k]; hit; hit &= hit - 1)
            leaves(f, LANES * i + k, LANES * j + __builtin_ctz(hit), sum);
    }
}

/* Of block i all pairs with itself and with blocks behind it. */
FL_SIMD_VERSIONS static void around(const forest *f, int32_t i, tally *sum)
{
    struct {
        int32_t k;
        int level;
    } stack[LEVELS * LANES];
    box b;
    int top = 0;
    if (f->levels == 2) {
        blocks(f, 0, 0, sum);
        return;
    }
    b = box_in(&f->level[2][i / LANES], i % LANES);
    stack[top].k = 0;
    stack[top++].level = f->levels - 1;
    while (top > 0) {
        const int32_t k = stack[--top].k;
        const int l = stack[top].level;
        const int32_t first = i >> STEP * (l - 2); /* of the level beneath, that block i lies in */
        unsigned hit = meets_of(&f->level[l][k], &b);
        if (first > LANES * k) hit &= ~0u << (first - LANES * k);
        for (; hit; hit &= hit - 1) {
            const int32_t c = LANES * k + __builtin_ctz(hit);
            if (l == 2) {
                blocks(f, i, c, sum);
            } else {
                stack[top].k = c;
                stack[top++].level = l - 1;
            }
        }
    }
}

static int32_t capped(int64_t n) { return n < INT32_MAX ? (int32_t)n : INT32_MAX; }

int fl_part_crossings(const fl_part *p, fl_crossing *c, fl_err *err)
{
    forest f;
    int64_t crossings = 0, touching = 0;
    int failed = 0;
    *c = (fl_crossing){0, 0};
    if (p->nt == 0) return 0;
    if (forest_make(&f, p, err)) return -1;
#pragma omp parallel for schedule(dynamic, 32) reduction(+ : crossings, touching) if (p->nt > ALONE)
    for (int32_t i = 0; i < f.n[1]; i++) {
        tally sum = {0};
        around(&f, i, &sum);
        crossings += sum.crossings;
        touching += sum.touching;
        if (sum.failed)
#pragma omp critical(fl_crossing_failed)
        {
            if (!failed) *err = sum.err;
            failed = 1;
        }
    }
    forest_free(&f);
    if (failed) return -1;
    *c = (fl_crossing){capped(crossings), capped(touching)};
    return 0;
}
