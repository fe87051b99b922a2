/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/mem.h"
#include "mesh/crossing.h"

/* A sum of products of differences, each formed with up to eight roundings of 2^-53: twice that of the sum of
 * their sizes is more than what they can lose. */
static const double BLUR = 16.0 * 0x1p-53;
/* Below this, products may have lost digits for want of smaller numbers. */
static const double TINY = 1e-280;

/* --- is there a plane between two triangles? ------------------------------------------------------------ */

typedef struct {
    int32_t t;
    int known; /* n and size, when they are asked for */
    const int32_t *v;
    fl_vec3 x[3];
    fl_vec3 n, size; /* (x1 - x0) x (x2 - x0), and the same of sizes, which bounds its rounding */
} corners;

static fl_vec3 sizes(fl_vec3 a) { return v3(fabs(a.x), fabs(a.y), fabs(a.z)); }

/* a x b with every product taken by its size */
static fl_vec3 cross_sizes(fl_vec3 a, fl_vec3 b)
{
    a = sizes(a);
    b = sizes(b);
    return v3(a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x);
}

static void corners_of(const fl_part *p, int32_t t, corners *c)
{
    c->t = t;
    c->known = 0;
    c->v = p->t[t].v;
    for (int k = 0; k < 3; k++) c->x[k] = p->v[c->v[k]];
}

static void raise_normal(corners *c)
{
    const fl_vec3 a = v3_sub(c->x[1], c->x[0]), b = v3_sub(c->x[2], c->x[0]);
    if (c->known) return;
    c->n = v3_cross(a, b);
    c->size = cross_sizes(a, b);
    c->known = 1;
}

/* On which side of the plane of c lies x: 1, -1, or 0 where rounding may decide. */
static int side(const corners *c, fl_vec3 x)
{
    const fl_vec3 d = v3_sub(x, c->x[0]);
    const double at = v3_dot(c->n, d), blur = BLUR * v3_dot(c->size, sizes(d)) + TINY;
    return at > blur ? 1 : at < -blur ? -1 : 0;
}

/* Do the corners of b but those with the index k and l lie on one side of the plane of a? */
static int beside(corners *a, const corners *b, int k, int l)
{
    int sum = 0, n = 0;
    raise_normal(a);
    for (int i = 0; i < 3; i++) {
        if (i == k || i == l) continue;
        sum += side(a, b->x[i]);
        n++;
    }
    return sum == n || sum == -n;
}

/* Lowest and highest value that g . (x - o) may have over the corners of c but k. */
static void reach(const corners *c, int k, fl_vec3 g, fl_vec3 o, double *lo, double *hi)
{
    const fl_vec3 size = sizes(g);
    *lo = INFINITY;
    *hi = -INFINITY;
    for (int i = 0; i < 3; i++) {
        if (i == k) continue;
        const fl_vec3 d = v3_sub(c->x[i], o);
        const double at = v3_dot(g, d), blur = BLUR * v3_dot(size, sizes(d)) + TINY;
        *lo = at - blur < *lo ? at - blur : *lo;
        *hi = at + blur > *hi ? at + blur : *hi;
    }
}

/* Without a corner in common: does a plane on an edge of a, upright on it, have b behind it?  The normal of a
 * is known from beside(). */
static int fenced(const corners *a, const corners *b)
{
    for (int i = 0; i < 3; i++) {
        const fl_vec3 o = a->x[i], g = v3_cross(v3_sub(a->x[(i + 1) % 3], o), a->n);
        double a_lo, a_hi, b_lo, b_hi;
        reach(a, i, g, o, &a_lo, &a_hi);
        reach(b, -1, g, o, &b_lo, &b_hi);
        if (b_lo > fmax(a_hi, 0.0) || b_hi < fmin(a_lo, 0.0)) return 1;
    }
    return 0;
}

/* Is g . d above zero for certain? */
static int ahead(fl_vec3 g, fl_vec3 size, fl_vec3 d)
{
    return v3_dot(g, d) > BLUR * v3_dot(size, sizes(d)) + TINY;
}

/* Does the plane through a common corner at right angles to g have b1 and b2 before it and a1 and a2 behind?
 */
static int parts(fl_vec3 g, fl_vec3 a1, fl_vec3 a2, fl_vec3 b1, fl_vec3 b2)
{
    const fl_vec3 size = sizes(g), back = v3_neg(g);
    return ahead(g, size, b1) && ahead(g, size, b2) && ahead(back, size, a1) && ahead(back, size, a2);
}

static const int NEXT[3] = {1, 2, 0};

/* With corner i of a and j of b in common: is there a plane through it between the two?  Tried are those
 * across the way from the middle of the one to that of the other, and from its direction to that. */
static int parted(const corners *a, int i, const corners *b, int j)
{
    const fl_vec3 o = a->x[i];
    const fl_vec3 a1 = v3_sub(a->x[NEXT[i]], o), a2 = v3_sub(a->x[NEXT[NEXT[i]]], o);
    const fl_vec3 b1 = v3_sub(b->x[NEXT[j]], o), b2 = v3_sub(b->x[NEXT[NEXT[j]]], o);
    if (parts(v3_sub(v3_add(b1, b2), v3_add(a1, a2)), a1, a2, b1, b2)) return 1;
    const fl_vec3 to_a = v3_unit(v3_add(v3_unit(a1), v3_unit(a2)));
    const fl_vec3 to_b = v3_unit(v3_add(v3_unit(b1), v3_unit(b2)));
    return parts(v3_sub(to_b, to_a), a1, a2, b1, b2);
}

/* With all but corner i of a and j of b in common: do they bend by less than a right angle? */
static int gentle(const corners *a, int i, const corners *b, int j)
{
    const fl_vec3 o = a->x[(i + 1) % 3], e = v3_sub(a->x[(i + 2) % 3], o);
    const fl_vec3 p = v3_sub(a->x[i], o), q = v3_sub(b->x[j], o);
    const double at = v3_dot(v3_cross(e, p), v3_cross(e, q));
    return at < -(2.0 * BLUR * v3_dot(cross_sizes(e, p), cross_sizes(e, q)) + TINY);
}

/* Are the two apart, but for the corners and edges they have in common, for certain? */
static int apart(corners *a, corners *b)
{
    int i[3] = {0}, j[3] = {0}, n = 0;
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) {
            if (a->v[k] != b->v[l]) continue;
            if (n == 3) return 0; /* a corner that comes twice */
            i[n] = k;
            j[n++] = l;
        }
    if (n == 2 && (i[0] == i[1] || j[0] == j[1])) return 0;
    switch (n) {
    case 0: return beside(a, b, -1, -1) || beside(b, a, -1, -1) || fenced(a, b) || fenced(b, a);
    case 1: return parted(a, i[0], b, j[0]) || beside(a, b, j[0], -1) || beside(b, a, i[0], -1);
    case 2: return gentle(a, 3 - i[0] - i[1], b, 3 - j[0] - j[1]) || beside(a, b, j[0], j[1]);
    default: return 0;
    }
}

/* --- the order of triangles in space -------------------------------------------------------------------- */

enum {
    LEAF = 8,   /* triangles of a box of the lowest level */
    BRANCH = 4, /* boxes of one level in a box of the next */
    LEVELS = 16,
    BITS = 21, /* of a coordinate along the curve */
    DIGIT = 11 /* bits, of the sort */
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

/* By key, the lower triangle first on a tie: digits from the last one on, each pass keeping the order. */
static void sort_places(place **at, place **other, int32_t n)
{
    enum { WORDS = 1 << DIGIT };
    static const int PASSES = (3 * BITS + DIGIT - 1) / DIGIT;
    for (int pass = 0; pass < PASSES; pass++) {
        int32_t first[WORDS + 1] = {0};
        place *from = *at, *to = *other;
        for (int32_t k = 0; k < n; k++) first[(from[k].key >> pass * DIGIT & (WORDS - 1)) + 1]++;
        if (first[(from[0].key >> pass * DIGIT & (WORDS - 1)) + 1] == n) continue; /* all the same */
        for (int w = 0; w < WORDS; w++) first[w + 1] += first[w];
        for (int32_t k = 0; k < n; k++) to[first[from[k].key >> pass * DIGIT & (WORDS - 1)]++] = from[k];
        *at = to;
        *other = from;
    }
}

/* The nearest floats that are not more, and not less; x was rounded once before. */
static float below(double x) { return nextafterf((float)x, -INFINITY); }
static float above(double x) { return nextafterf((float)x, INFINITY); }

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

static int boxes_meet(const box *a, const box *b)
{
    return (a->lo[0] <= b->hi[0]) & (b->lo[0] <= a->hi[0]) & (a->lo[1] <= b->hi[1]) & (b->lo[1] <= a->hi[1]) &
           (a->lo[2] <= b->hi[2]) & (b->lo[2] <= a->hi[2]);
}

/* Those of the triangles of a leaf, side by side for the vector units; places that are left over are empty
 * (lo > hi) and meet nothing. */
typedef struct {
    float lo[3][LEAF], hi[3][LEAF];
} octet;

static box box_in(const octet *o, int k)
{
    return (box){{o->lo[0][k], o->lo[1][k], o->lo[2][k]}, {o->hi[0][k], o->hi[1][k], o->hi[2][k]}};
}

/* A bit for each of the eight that a box meets. */
static unsigned meets_of(const octet *o, const box *b)
{
    int32_t hit[LEAF];
    unsigned bits = 0;
#pragma omp simd
    for (int k = 0; k < LEAF; k++)
        hit[k] = (o->lo[0][k] <= b->hi[0]) & (o->hi[0][k] >= b->lo[0]) & (o->lo[1][k] <= b->hi[1]) &
                 (o->hi[1][k] >= b->lo[1]) & (o->lo[2][k] <= b->hi[2]) & (o->hi[2][k] >= b->lo[2]);
    for (int k = 0; k < LEAF; k++) bits |= (unsigned)hit[k] << k;
    return bits;
}

/* Boxes of the triangles in their order, and level by level those of eight triangles, of four boxes, ... up
 * to one. */
typedef struct {
    const fl_part *p;
    int32_t *order;     /* [p->nt] */
    octet *own;         /* [n[0]] */
    box *level[LEVELS]; /* [n[l]] */
    int32_t n[LEVELS];
    int levels;
} forest;

static void forest_free(forest *f)
{
    free(f->order);
    free(f->own);
    free(f->level[0]);
    *f = (forest){0};
}

static int order_triangles(forest *f, fl_vec3 o, double side, fl_err *err)
{
    const int32_t n = f->p->nt;
    const double cells = side > 0.0 ? (1 << BITS) / side : 0.0;
    place *at = fl_alloc(n, sizeof *at, err), *other = at ? fl_alloc(n, sizeof *other, err) : NULL;
    if (other) {
#pragma omp parallel for schedule(static)
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

static int forest_make(forest *f, const fl_part *p, fl_err *err)
{
    const fl_aabb all = fl_part_aabb(p);
    const fl_vec3 wide = v3_sub(all.hi, all.lo);
    int64_t boxes = 0;
    *f = (forest){.p = p};
    for (int64_t n = p->nt, per = LEAF;; per = BRANCH) {
        n = (n + per - 1) / per;
        f->n[f->levels++] = (int32_t)n;
        boxes += n;
        if (n == 1) break;
    }
    if (!(f->order = fl_alloc(p->nt, sizeof *f->order, err)) ||
        order_triangles(f, all.lo, fmax(wide.x, fmax(wide.y, wide.z)), err) ||
        !(f->own = fl_alloc(f->n[0], sizeof *f->own, err)) ||
        !(f->level[0] = fl_alloc(boxes, sizeof *f->level[0], err))) {
        forest_free(f);
        return -1;
    }
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < f->n[0]; i++) {
        f->level[0][i] = EMPTY;
        for (int k = 0; k < LEAF; k++) {
            const int32_t at = LEAF * i + k;
            const box b = at < p->nt ? box_of(p, f->order[at], all.lo) : EMPTY;
            for (int c = 0; c < 3; c++) {
                f->own[i].lo[c][k] = b.lo[c];
                f->own[i].hi[c][k] = b.hi[c];
            }
            join(&f->level[0][i], &b);
        }
    }
    for (int l = 1; l < f->levels; l++) {
        f->level[l] = f->level[l - 1] + f->n[l - 1];
#pragma omp parallel for schedule(static)
        for (int32_t k = 0; k < f->n[l]; k++) {
            f->level[l][k] = EMPTY;
            for (int32_t i = BRANCH * k; i < f->n[l - 1] && i < BRANCH * (k + 1); i++)
                join(&f->level[l][k], &f->level[l - 1][i]);
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
static void meet(corners *a, corners *b, tally *sum)
{
    double x[2][9];
    int how;
    if (apart(a, b)) return;
    for (int k = 0; k < 3; k++) {
        memcpy(x[a->t > b->t] + 3 * (ptrdiff_t)k, &a->x[k].x, sizeof a->x[k]);
        memcpy(x[a->t < b->t] + 3 * (ptrdiff_t)k, &b->x[k].x, sizeof b->x[k]);
    }
    how = fl_cgal_meet(x[0], x[1], &sum->err);
    sum->crossings += how == FL_CROSSES;
    sum->touching += how == FL_TOUCHES;
    sum->failed |= how < 0;
}

/* The triangles of leaf i against those of leaf j >= i. */
static void leaves(const forest *f, corners *own, int32_t i, int32_t j, tally *sum)
{
    corners there[LEAF];
    unsigned known = 0, hit;
    for (int k = 0; k < LEAF; k++) {
        const box b = box_in(&f->own[i], k);
        if (i != j && !boxes_meet(&b, &f->level[0][j])) continue;
        hit = meets_of(&f->own[j], &b);
        if (i == j) hit &= ~0u << k << 1;
        for (int l = 0; hit; l++, hit >>= 1) {
            if (!(hit & 1u)) continue;
            if (!(known >> l & 1u)) corners_of(f->p, f->order[LEAF * j + l], &there[l]);
            known |= 1u << l;
            meet(&own[k], &there[l], sum);
        }
    }
}

/* Of leaf i all pairs with itself and with leaves behind it. */
static void around(const forest *f, int32_t i, tally *sum)
{
    struct {
        int32_t k;
        int level;
    } stack[LEVELS * BRANCH];
    corners own[LEAF];
    int top = 0;
    for (int32_t k = LEAF * i, n = 0; n < LEAF && k < f->p->nt; k++) corners_of(f->p, f->order[k], &own[n++]);
    stack[top].k = 0;
    stack[top++].level = f->levels - 1;
    while (top > 0) {
        const int32_t k = stack[--top].k;
        const int l = stack[top].level;
        if (l == 0) {
            leaves(f, own, i, k, sum);
            continue;
        }
        for (int32_t c = BRANCH * k; c < f->n[l - 1] && c < BRANCH * (k + 1); c++) {
            int64_t last = (int64_t)c + 1; /* leaves beneath it end here */
            for (int d = 1; d < l; d++) last *= BRANCH;
            if (last <= i || !boxes_meet(&f->level[l - 1][c], &f->level[0][i])) continue;
            stack[top].k = c;
            stack[top++].level = l - 1;
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
#pragma omp parallel for schedule(dynamic, 256) reduction(+ : crossings, touching)
    for (int32_t i = 0; i < f.n[0]; i++) {
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
