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

/* --- Morton order and boxes ----------------------------------------------------------------------------- */

enum {
    LANES = 8, /* triangles of a leaf, leaves of a block, and so on */
    STEP = 3,  /* LANES = 2^STEP */
    LEVELS = 12,
    BITS = 21,          /* per coordinate of a Morton key */
    DIGIT = 11,         /* bits of a digit of the radix sort */
    SORT_PASSES = 4,    /* of the radix sort; the remaining low bits are sorted by comparison */
    SERIAL_LIMIT = 2048 /* up to so many triangles run on one thread: starting the others takes longer */
};

typedef struct {
    float lo[3], hi[3]; /* rounded outward */
} box;

typedef struct {
    uint64_t key;
    int32_t t;
} key_of_triangle;

/* Spread the low 21 bits so that two zeros separate neighbours. */
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

static int key_precedes(const key_of_triangle *a, const key_of_triangle *b)
{
    return a->key != b->key ? a->key < b->key : a->t < b->t;
}

static int by_key(const void *a, const void *b) { return key_precedes(b, a) - key_precedes(a, b); }

/* Sort keys with equal leading digits; runs are short except where triangles are crowded. */
static void sort_equal_digits(key_of_triangle *at, int32_t n)
{
    enum { FEW = 16 };
    if (n > FEW) {
        qsort(at, (size_t)n, sizeof *at, by_key);
        return;
    }
    for (int32_t i = 1; i < n; i++) {
        const key_of_triangle x = at[i];
        int32_t k = i;
        for (; k > 0 && key_precedes(&x, &at[k - 1]); k--) at[k] = at[k - 1];
        at[k] = x;
    }
}

/* Sort by key, then by triangle: a stable radix sort on the leading digits, then comparison within runs of
 * equal ones. */
static void sort_keys(key_of_triangle **at, key_of_triangle **other, int32_t n)
{
    enum { WORDS = 1 << DIGIT, REST = 3 * BITS - SORT_PASSES * DIGIT };
    for (int pass = 0; pass < SORT_PASSES; pass++) {
        const int shift = REST + pass * DIGIT;
        int32_t first[WORDS + 1] = {0};
        key_of_triangle *from = *at, *to = *other;
        for (int32_t k = 0; k < n; k++) first[(from[k].key >> shift & (WORDS - 1)) + 1]++;
        if (first[(from[0].key >> shift & (WORDS - 1)) + 1] == n) continue; /* all keys have the same digit */
        for (int w = 0; w < WORDS; w++) first[w + 1] += first[w];
        for (int32_t k = 0; k < n; k++) to[first[from[k].key >> shift & (WORDS - 1)]++] = from[k];
        *at = to;
        *other = from;
    }
    for (int32_t i = 0, j; i < n; i = j) {
        for (j = i + 1; j < n && (*at)[j].key >> REST == (*at)[i].key >> REST; j++) {}
        if (j > i + 1) sort_equal_digits(*at + i, j - i);
    }
}

/* Floats certainly below and above x.  x has been rounded once and is rounded here again, each time by at
 * most 2^-24 of it; the margin is 2^-22. */
static float float_below(double x)
{
    const float f = (float)x;
    return f - (fabsf(f) * 0x1p-22f + FLT_MIN);
}

static float float_above(double x)
{
    const float f = (float)x;
    return f + (fabsf(f) * 0x1p-22f + FLT_MIN);
}

static box box_of(const fl_part *p, int32_t t, fl_vec3 o)
{
    fl_aabb b = aabb_empty();
    for (int k = 0; k < 3; k++) b = aabb_add(b, v3_sub(p->v[p->t[t].v[k]], o));
    return (box){{float_below(b.lo.x), float_below(b.lo.y), float_below(b.lo.z)},
                 {float_above(b.hi.x), float_above(b.hi.y), float_above(b.hi.z)}};
}

static const box EMPTY = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void extend_box(box *a, const box *b)
{
    for (int k = 0; k < 3; k++) {
        a->lo[k] = a->lo[k] < b->lo[k] ? a->lo[k] : b->lo[k];
        a->hi[k] = a->hi[k] > b->hi[k] ? a->hi[k] : b->hi[k];
    }
}

/* Eight boxes in arrays for the vector units: of the triangles of a leaf, or of the eight children of a box.
 * Unused lanes are empty (lo > hi) and overlap nothing. */
typedef struct {
    float lo[3][LANES], hi[3][LANES];
} octet;

/* Vertices of eight triangles, by corner; NOT_SIMPLE stands for one that is not simple (vertex_fans.h). */
typedef struct {
    int32_t v[3][LANES];
} vertices_of_eight;
enum { NOT_SIMPLE = -1, NO_VERTEX = -2 };

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

/* The bits of all lanes.  (Written as a reduction of the loop, this compiles to eight dependent steps.) */
static inline unsigned combine_lanes(const int32_t bits[LANES])
{
    uint64_t two[LANES / 2], all;
    memcpy(two, bits, sizeof two);
    all = (two[0] | two[1]) | (two[2] | two[3]);
    return (unsigned)(all | all >> 32);
}

/* One bit for each of the eight boxes that b overlaps. */
static inline unsigned overlap_mask(const octet *o, const box *b)
{
    int32_t bits[LANES];
#pragma omp simd
    for (int k = 0; k < LANES; k++) {
        const int32_t hit = (o->lo[0][k] <= b->hi[0]) & (o->hi[0][k] >= b->lo[0]) &
                            (o->lo[1][k] <= b->hi[1]) & (o->hi[1][k] >= b->lo[1]) &
                            (o->lo[2][k] <= b->hi[2]) & (o->hi[2][k] >= b->lo[2]);
        bits[k] = -hit & BIT[k];
    }
    return combine_lanes(bits);
}

/* One bit for each of the eight triangles that has one of three vertices. */
static inline unsigned common_vertex_mask(const vertices_of_eight *o, const int32_t v[3])
{
    int32_t bits[LANES];
#pragma omp simd
    for (int k = 0; k < LANES; k++) {
        const int32_t hit = (o->v[0][k] == v[0]) | (o->v[1][k] == v[0]) | (o->v[2][k] == v[0]) |
                            (o->v[0][k] == v[1]) | (o->v[1][k] == v[1]) | (o->v[2][k] == v[1]) |
                            (o->v[0][k] == v[2]) | (o->v[1][k] == v[2]) | (o->v[2][k] == v[2]);
        bits[k] = -hit & BIT[k];
    }
    return combine_lanes(bits);
}

/* The tree: boxes of the triangles in Morton order; level by level boxes of eight triangles (a leaf), of
 * eight leaves (a block), and so on up to one octet. */
typedef struct {
    const fl_part *p;
    int32_t *order;          /* [p->nt] */
    vertices_of_eight *name; /* [n[0]] */
    int32_t *hub;         /* [n[1]] a simple vertex that all triangles of a block have, NOT_SIMPLE for none */
    octet *level[LEVELS]; /* [n[l]] */
    int32_t n[LEVELS];
    int levels; /* two or more */
} box_tree;

static void tree_free(box_tree *f)
{
    free(f->order);
    free(f->name);
    free(f->hub);
    free(f->level[0]);
    *f = (box_tree){0};
}

static int order_triangles(box_tree *f, fl_vec3 o, double side, fl_err *err)
{
    const int32_t n = f->p->nt;
    const double cells = side > 0.0 ? (1 << BITS) / side : 0.0;
    key_of_triangle *at = fl_alloc(n, sizeof *at, err), *other = at ? fl_alloc(n, sizeof *other, err) : NULL;
    if (other) {
#pragma omp parallel for schedule(static) if (n > SERIAL_LIMIT)
        for (int32_t t = 0; t < n; t++) {
            const int32_t *v = f->p->t[t].v;
            const fl_vec3 middle =
                v3_scale(1.0 / 3.0, v3_add(v3_sub(f->p->v[v[0]], o),
                                           v3_add(v3_sub(f->p->v[v[1]], o), v3_sub(f->p->v[v[2]], o))));
            at[t].t = t;
            at[t].key = spread(cell_of(middle.x, cells)) | spread(cell_of(middle.y, cells)) << 1 |
                        spread(cell_of(middle.z, cells)) << 2;
        }
        sort_keys(&at, &other, n);
        for (int32_t k = 0; k < n; k++) f->order[k] = at[k].t;
    }
    free(at);
    free(other);
    return other ? 0 : -1;
}

/* Store the vertices of the triangles, with NOT_SIMPLE for those that are not simple. */
static int tree_store_vertices(box_tree *f, fl_err *err)
{
    uint8_t *tame = fl_alloc(f->p->nv, 1, err);
    const int bad = !tame || fl_vertex_fans_simple(f->p, tame, err);
    if (!bad) {
#pragma omp parallel for schedule(static) if (f->p->nt > SERIAL_LIMIT)
        for (int32_t at = 0; at < f->p->nt; at++)
            for (int c = 0; c < 3; c++) {
                const int32_t v = f->p->t[f->order[at]].v[c];
                f->name[at / LANES].v[c][at % LANES] = tame[v] ? v : NOT_SIMPLE;
            }
    }
    free(tame);
    return bad ? -1 : 0;
}

/* A simple vertex that all triangles of block i have, NOT_SIMPLE for none. */
static int32_t hub_of(const box_tree *f, int32_t i)
{
    enum { MOST = LANES * LANES };
    const int32_t from = MOST * i, to = f->p->nt - from < MOST ? f->p->nt : from + MOST;
    for (int c = 0; c < 3; c++) {
        const int32_t v = f->name[from / LANES].v[c][0];
        int32_t at = v == NOT_SIMPLE ? to + 1 : from + 1;
        for (; at < to; at++) {
            const vertices_of_eight *o = &f->name[at / LANES];
            const int k = at % LANES;
            if (o->v[0][k] != v && o->v[1][k] != v && o->v[2][k] != v) break;
        }
        if (at == to) return v;
    }
    return NOT_SIMPLE;
}

static int tree_build(box_tree *f, const fl_part *p, fl_err *err)
{
    const fl_aabb all = fl_part_aabb(p);
    const fl_vec3 wide = v3_sub(all.hi, all.lo);
    int64_t octets = 0;
    *f = (box_tree){.p = p};
    for (int64_t n = p->nt; f->levels < 2 || n > 1;) {
        n = (n + LANES - 1) / LANES;
        f->n[f->levels++] = (int32_t)n;
        octets += n;
    }
    if (!(f->order = fl_alloc(p->nt, sizeof *f->order, err)) ||
        order_triangles(f, all.lo, fmax(wide.x, fmax(wide.y, wide.z)), err) ||
        !(f->name = fl_alloc(f->n[0], sizeof *f->name, err)) || tree_store_vertices(f, err) ||
        !(f->hub = fl_alloc(f->n[1], sizeof *f->hub, err)) ||
        !(f->level[0] = fl_alloc(octets, sizeof *f->level[0], err))) {
        tree_free(f);
        return -1;
    }
#pragma omp parallel for schedule(static) if (p->nt > SERIAL_LIMIT)
    for (int32_t i = 0; i < f->n[1]; i++) f->hub[i] = hub_of(f, i);
    for (int l = 0; l < f->levels; l++) {
        const int32_t under = l ? f->n[l - 1] : p->nt;
        if (l) f->level[l] = f->level[l - 1] + f->n[l - 1];
#pragma omp parallel for schedule(static) if (p->nt > SERIAL_LIMIT)
        for (int32_t i = 0; i < f->n[l]; i++)
            for (int k = 0; k < LANES; k++) {
                const int32_t at = LANES * i + k;
                box b = EMPTY;
                if (l == 0 && at < under) b = box_of(p, f->order[at], all.lo);
                for (int m = 0; l > 0 && at < under && m < LANES; m++) {
                    const box one = box_in(&f->level[l - 1][at], m);
                    extend_box(&b, &one);
                }
                put_box(&f->level[l][i], k, &b);
            }
    }
    return 0;
}

/* --- search --------------------------------------------------------------------------------------------- */

typedef struct {
    int64_t crossings, touching;
    int failed;
    fl_err err;
} pair_counts;

/* Test one pair.  The result does not depend on the order of the two. */
static void test_pair(fl_tri_data *a, fl_tri_data *b, pair_counts *sum)
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

/* Test triangle k of leaf i against the triangles of leaf j in the bit mask hit. */
static void test_triangles(const box_tree *f, int32_t i, int k, int32_t j, unsigned hit, pair_counts *sum)
{
    fl_tri_data own, other;
    fl_tri_load(f->p, f->order[LANES * i + k], &own);
    for (; hit; hit &= hit - 1) {
        fl_tri_load(f->p, f->order[LANES * j + __builtin_ctz(hit)], &other);
        test_pair(&own, &other, sum);
    }
}

/* Minimum number of candidate pairs for a test of two whole groups.  Neighbours in a flat sheet have fewer.
 */
enum { GROUP_TEST_MIN = LANES * LANES / 2 };

/* True if a plane separates groups i and j of `many` triangles each. */
static int groups_separated(const box_tree *f, int32_t many, int32_t i, int32_t j)
{
    const int32_t n = f->p->nt, ni = n - many * i, nj = n - many * j;
    return i != j && fl_tri_groups_separated(f->p, f->order + many * i, ni < many ? ni : many,
                                             f->order + many * j, nj < many ? nj : many);
}

/* Test the triangles of leaf i against those of leaf j >= i.  Two with a common simple vertex do not cross.
 */
__attribute__((always_inline)) static inline void test_leaves(const box_tree *f, int32_t i, int32_t j,
                                                              pair_counts *sum)
{
    const octet *own = &f->level[0][i], *there = &f->level[0][j];
    const box all = box_in(&f->level[1][j / LANES], j % LANES);
    unsigned hits[LANES];
    int32_t lane[LANES];
    int n = 0, pairs = 0;
    for (unsigned mine = overlap_mask(own, &all); mine; mine &= mine - 1) {
        const int k = __builtin_ctz(mine);
        const box b = box_in(own, k);
        unsigned hit = overlap_mask(there, &b);
        int32_t v[3];
        if (i == j) hit &= ~0u << k << 1;
        if (!hit) continue;
        for (int c = 0; c < 3; c++) {
            v[c] = f->name[i].v[c][k];
            if (v[c] == NOT_SIMPLE) v[c] = NO_VERTEX; /* equals no stored vertex */
        }
        hit &= ~common_vertex_mask(&f->name[j], v);
        if (!hit) continue;
        hits[n] = hit;
        lane[n++] = k;
        pairs += __builtin_popcount(hit);
    }
    if (pairs >= GROUP_TEST_MIN && groups_separated(f, LANES, i, j)) return;
    for (int k = 0; k < n; k++) test_triangles(f, i, lane[k], j, hits[k], sum);
}

/* Test the leaves of block i against those of block j >= i.  In a fan of very many triangles most blocks
 * share one hub. */
__attribute__((always_inline)) static inline void test_blocks(const box_tree *f, int32_t i, int32_t j,
                                                              pair_counts *sum)
{
    const octet *own = &f->level[1][i], *there = &f->level[1][j];
    unsigned hits[LANES] = {0}, mine = ~(~0u << LANES);
    int pairs = 0;
    if (f->hub[i] != NOT_SIMPLE && f->hub[i] == f->hub[j]) return;
    if (i != j) {
        const box all = box_in(&f->level[2][j / LANES], j % LANES);
        mine = overlap_mask(own, &all);
    }
    for (unsigned left = mine; left; left &= left - 1) {
        const int k = __builtin_ctz(left);
        const box b = box_in(own, k);
        hits[k] = overlap_mask(there, &b);
        if (i == j) hits[k] &= ~0u << k;
        pairs += __builtin_popcount(hits[k]);
    }
    if (pairs >= GROUP_TEST_MIN && groups_separated(f, LANES * LANES, i, j)) return;
    for (; mine; mine &= mine - 1) {
        const int k = __builtin_ctz(mine);
        for (unsigned hit = hits[k]; hit; hit &= hit - 1)
            test_leaves(f, LANES * i + k, LANES * j + __builtin_ctz(hit), sum);
    }
}

/* Test block i against itself and all later blocks. */
FL_SIMD_VERSIONS static void test_from_block(const box_tree *f, int32_t i, pair_counts *sum)
{
    struct {
        int32_t k;
        int level;
    } stack[LEVELS * LANES];
    box b;
    int top = 0;
    if (f->levels == 2) {
        test_blocks(f, 0, 0, sum);
        return;
    }
    b = box_in(&f->level[2][i / LANES], i % LANES);
    stack[top].k = 0;
    stack[top++].level = f->levels - 1;
    while (top > 0) {
        const int32_t k = stack[--top].k;
        const int l = stack[top].level;
        const int32_t first = i >> STEP * (l - 2); /* ancestor of block i one level down */
        unsigned hit = overlap_mask(&f->level[l][k], &b);
        if (first > LANES * k) hit &= ~0u << (first - LANES * k);
        for (; hit; hit &= hit - 1) {
            const int32_t c = LANES * k + __builtin_ctz(hit);
            if (l == 2) {
                test_blocks(f, i, c, sum);
            } else {
                stack[top].k = c;
                stack[top++].level = l - 1;
            }
        }
    }
}

static int32_t saturate(int64_t n) { return n < INT32_MAX ? (int32_t)n : INT32_MAX; }

int fl_part_crossings(const fl_part *p, fl_crossing *c, fl_err *err)
{
    box_tree f;
    int64_t crossings = 0, touching = 0;
    int failed = 0;
    *c = (fl_crossing){0, 0};
    if (p->nt == 0) return 0;
    if (tree_build(&f, p, err)) return -1;
#pragma omp parallel for schedule(dynamic, 32) reduction(+ : crossings, touching) if (p->nt > SERIAL_LIMIT)
    for (int32_t i = 0; i < f.n[1]; i++) {
        pair_counts sum = {0};
        test_from_block(&f, i, &sum);
        crossings += sum.crossings;
        touching += sum.touching;
        if (sum.failed)
#pragma omp critical(fl_crossing_failed)
        {
            if (!failed) *err = sum.err;
            failed = 1;
        }
    }
    tree_free(&f);
    if (failed) return -1;
    *c = (fl_crossing){saturate(crossings), saturate(touching)};
    return 0;
}
