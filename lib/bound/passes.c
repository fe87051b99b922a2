/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/mem.h"
#include "bound/passes.h"

/* Of the size: so near to each other two tiles meet.  Tiles and straight runs of their sides are as flat and
 * as straight as half of that (structure.c). */
#define MEET 2e-6
/* So much two that meet may rise from one another and be one wall: of the distance it is half the square. */
#define FLAT 1e-6
/* And of the size so much is rounding, and half the square of the above. */
#define SAME 1e-12

enum { OUT = -1 }; /* a pass that is to go */

/* --- where tiles meet --------------------------------------------------------------------------- */

static int32_t sides_of(const fl_poly *p, int32_t f) { return p->first[f + 1] - p->first[f]; }
static const int32_t *loop_of(const fl_poly *p, int32_t f) { return p->loop + p->first[f]; }

/* Side c of tile f, from its corner to the next. */
static fl_vec3 along(const fl_poly *p, int32_t f, int32_t c)
{
    return v3_sub(p->v[p->loop[c + 1 < p->first[f + 1] ? c + 1 : p->first[f]]], p->v[p->loop[c]]);
}

/* Leave of the stretch from t[0] to t[1] of a line what is below: h0 and h1 are heights at 0 and 1. */
static int cut(double t[2], double h0, double h1)
{
    if (h0 > 0.0 && h1 > 0.0) return 0;
    if (h0 > 0.0) t[0] = fmax(t[0], h0 / (h0 - h1));
    if (h1 > 0.0) t[1] = fmin(t[1], h0 / (h0 - h1));
    return t[0] <= t[1];
}

/* The stretch of a b that lies within tol of tile f; 0 when there is none. */
static int stretch(const fl_poly *p, int32_t f, fl_vec3 a, fl_vec3 b, double tol, double t[2])
{
    const int32_t *v = loop_of(p, f), m = sides_of(p, f);
    const fl_vec3 n = p->n[f];
    const double ha = v3_dot(n, a) - p->c[f], hb = v3_dot(n, b) - p->c[f];
    t[0] = 0.0, t[1] = 1.0;
    if (!cut(t, ha - tol, hb - tol) || !cut(t, -ha - tol, -hb - tol)) return 0;
    for (int32_t c = 0, last = m - 1; c < m; last = c++) {
        const fl_vec3 from = p->v[v[last]], out = v3_unit(v3_cross(v3_sub(p->v[v[c]], from), n));
        if (!cut(t, v3_dot(out, v3_sub(a, from)) - tol, v3_dot(out, v3_sub(b, from)) - tol)) return 0;
    }
    return 1;
}

/* The stretches of sides of tile f on tile g, added to what has been met of each side; the longest, where it
 * is longer than *most, is put into *pass. */
static void stretches(const fl_poly *p, int32_t f, int32_t g, double tol, double *met, double *most,
                      fl_pass *pass)
{
    const int32_t *v = loop_of(p, f), m = sides_of(p, f);
    for (int32_t c = 0, last = m - 1; c < m; last = c++) {
        const fl_vec3 a = p->v[v[last]], way = v3_sub(p->v[v[c]], a);
        double t[2];
        if (!stretch(p, g, a, v3_add(a, way), tol, t)) continue;
        const double length = (t[1] - t[0]) * v3_norm(way);
        met[p->first[f] + last] += length;
        if (!(length > *most)) continue;
        *most = length;
        pass->a = v3_madd(a, t[0], way);
        pass->b = t[1] == 1.0 ? p->v[v[c]] : v3_madd(a, t[1], way);
    }
}

static fl_vec3 middle(const fl_poly *p, int32_t f)
{
    const int32_t *v = loop_of(p, f), m = sides_of(p, f);
    fl_vec3 sum = v3(0, 0, 0);
    for (int32_t c = 0; c < m; c++) sum = v3_add(sum, p->v[v[c]]);
    return v3_scale(1.0 / m, sum);
}

/* Tile g rises from the plane of f, where they meet at x. */
static int rises(const fl_poly *p, int32_t f, int32_t g, fl_vec3 x)
{
    const fl_vec3 way = v3_sub(middle(p, g), x);
    return v3_dot(p->n[f], way) > FLAT * v3_norm(way);
}

/* Both have that point, to the last digits. */
static int shared(const fl_poly *p, int32_t f, int32_t g, fl_vec3 x)
{
    return fl_nearest_rim(p, f, x).d <= SAME * p->size && fl_nearest_rim(p, g, x).d <= SAME * p->size;
}

/* Where tiles f < g meet: 1, or 0 where they do not. */
static int meet(const fl_poly *p, int32_t f, int32_t g, double tol, double *met, fl_pass *pass)
{
    double length = -1.0;
    stretches(p, f, g, tol, met, &length, pass);
    stretches(p, g, f, tol, met, &length, pass);
    if (length < 0.0) return 0;
    if (length < 4.0 * tol) { /* corners alone, if exact */
        if (shared(p, f, g, pass->a)) pass->b = pass->a;
        else if (shared(p, f, g, pass->b)) pass->a = pass->b;
    }
    pass->j = g;
    pass->inward = rises(p, f, g, pass->a) || rises(p, g, f, pass->a) || v3_dot(p->n[f], p->n[g]) < -0.9 ||
                   !shared(p, f, g, pass->a) || !shared(p, f, g, pass->b);
    return 1;
}

static int ascending(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* Boxes that meet q, ascending; -1 when memory runs out. */
static int32_t query(fl_passes_work *k, const fl_bvh *tree, const fl_aabb *box, fl_aabb q)
{
    int32_t n = fl_bvh_query(tree, box, q, k->list, k->list_cap);
    if (n > k->list_cap) {
        if (fl_room(&k->list, &k->list_cap, n, sizeof *k->list)) return -1;
        n = fl_bvh_query(tree, box, q, k->list, k->list_cap);
    }
    if (n > 1) qsort(k->list, (size_t)n, sizeof *k->list, ascending);
    return n;
}

/* The passes of tile f to those behind it, and what has been met of all sides. */
static int passes_of(fl_passes *s, fl_passes_work *k, const fl_poly *p, const fl_bvh *tree,
                     const fl_aabb *box, int32_t f, double *met)
{
    const int32_t n = query(k, tree, box, aabb_grow(box[f], s->tol));
    if (n < 0) return -1;
    for (int32_t c = 0; c < n; c++) {
        const int32_t g = k->list[c];
        fl_pass pass;
        if (g <= f || !meet(p, f, g, s->tol, met, &pass)) continue;
        if (fl_room(&s->pass, &s->cap, (int64_t)s->n + 1, sizeof *s->pass)) return -1;
        s->pass[s->n++] = pass;
    }
    return 0;
}

/* --- what a ball meets -------------------------------------------------------------------------- */

/* The number in the scratch of a tile, -1 for none; tiles there are ascending. */
static int32_t find(const fl_passes_work *k, int32_t tile)
{
    int32_t low = 0, high = k->tiles;
    while (low < high) {
        const int32_t mid = low + (high - low) / 2;
        if (k->tile[mid].tile < tile) low = mid + 1;
        else high = mid;
    }
    return low < k->tiles && k->tile[low].tile == tile ? low : -1;
}

static int32_t root(fl_passes_work *k, int32_t i)
{
    while (k->tile[i].up != i) i = k->tile[i].up = k->tile[k->tile[i].up].up;
    return i;
}

/* Nearest point of a tile for who stands before it, of its rim for who stands behind it. */
static fl_nearest seen(const fl_poly *p, int32_t f, fl_vec3 x)
{
    return v3_dot(p->n[f], x) >= p->c[f] ? fl_nearest_face(p, f, x) : fl_nearest_rim(p, f, x);
}

/* Those of some tiles, ascending, that are nearer than `radius`; q, where there is one, is that of tile `of`,
 * and what stands behind a tile sees its rim.  -1 when memory runs out. */
static int tiles_in(fl_passes_work *k, const fl_poly *p, const fl_passes_near *some, fl_vec3 x, double radius,
                    const fl_nearest *q, int32_t of)
{
    k->tiles = 0;
    if (fl_room(&k->tile, &k->tile_cap, some->n, sizeof *k->tile)) return -1;
    for (int32_t c = 0; c < some->n; c++) {
        const int32_t f = some->tile[c];
        if (fabs(v3_dot(p->n[f], x) - p->c[f]) >= radius) continue;
        const fl_nearest at = !q ? fl_nearest_face(p, f, x) : f == of ? *q : seen(p, f, x);
        if (at.d < radius) k->tile[k->tiles] = (fl_passes_tile){f, k->tiles, at}, k->tiles++;
    }
    return 0;
}

/* A pass is never nearer than the tiles that it joins, and rounding makes no walls. */
static fl_nearest joined(const fl_passes *s, const fl_passes_work *k, const fl_passes_link *l, fl_vec3 x)
{
    fl_nearest q = fl_nearest_segment(s->pass[l->pass].a, s->pass[l->pass].b, x);
    if (k->tile[l->i].at.d > q.d) q = k->tile[l->i].at;
    if (k->tile[l->j].at.d > q.d) q = k->tile[l->j].at;
    q.d -= s->same;
    return q;
}

/* Links of the tiles in the scratch that a ball of that radius meets.  -1 when memory runs out. */
static int links_in(const fl_passes *s, fl_passes_work *k, fl_vec3 x, double radius)
{
    k->links = 0;
    for (int32_t i = 0; i < k->tiles; i++) {
        const int32_t f = k->tile[i].tile;
        for (int32_t at = s->begin[f]; at < s->begin[f + 1]; at++) {
            fl_passes_link l = {.i = i, .j = find(k, s->pass[at].j), .pass = at};
            if (l.j < 0) continue;
            l.d = joined(s, k, &l, x).d;
            if (!(l.d < radius)) continue;
            if (fl_room(&k->link, &k->link_cap, (int64_t)k->links + 1, sizeof *k->link)) return -1;
            k->link[k->links++] = l;
        }
    }
    return 0;
}

/* The surface ends on a side of tile f that is nearer than that. */
static int ends_in(const fl_passes *s, const fl_poly *p, int32_t f, fl_vec3 x, double radius)
{
    for (int32_t c = p->first[f]; c < p->first[f + 1]; c++) {
        const fl_vec3 a = p->v[p->loop[c]];
        if (s->rim[c] && fl_nearest_segment(a, v3_add(a, along(p, f, c)), x).d < radius) return 1;
    }
    return 0;
}

/* In a ball in which it does not end, nor bends inward, and hangs together, the surface is that of a convex
 * body (Tietze and Nakajima). */
int fl_passes_lone(const fl_passes *s, fl_passes_work *k, const fl_poly *p, const fl_passes_near *near,
                   fl_vec3 x, double r)
{
    if (tiles_in(k, p, near, x, r, NULL, -1) || links_in(s, k, x, r)) return -1;
    int32_t pieces = k->tiles;
    if (pieces < 2) return 1;
    for (int32_t i = 0; i < k->tiles; i++)
        if (ends_in(s, p, k->tile[i].tile, x, r)) return 0;
    for (int32_t c = 0; c < k->links; c++) {
        const int32_t i = root(k, k->link[c].i), j = root(k, k->link[c].j);
        if (s->pass[k->link[c].pass].inward) return 0;
        if (i != j) k->tile[i].up = j, pieces--;
    }
    return pieces == 1;
}

static int nearer_first(const void *a, const void *b)
{
    const fl_passes_link *x = a, *y = b;
    if (x->d != y->d) return x->d < y->d ? -1 : 1;
    return x->pass < y->pass ? -1 : x->pass > y->pass;
}

static int put(fl_places *w, fl_vec3 x, const fl_nearest *q, double radius, double times)
{
    if (fl_places_point(w, x, q->n, radius - q->d, radius)) return -1;
    w->place[w->n - 1].du = times;
    return 0;
}

int fl_passes_places(const fl_passes *s, fl_passes_work *k, fl_places *w, const fl_poly *p,
                     const fl_passes_near *near, fl_vec3 x, double radius, const fl_nearest *q, int32_t of)
{
    if (!(q->d < radius)) return 0;
    if (put(w, x, q, radius, 1.0)) return -1;
    if (tiles_in(k, p, near, x, radius, q, of)) return -1;
    if (k->tiles < 2) return 0;
    if (links_in(s, k, x, radius)) return -1;
    if (k->links > 1) qsort(k->link, (size_t)k->links, sizeof *k->link, nearer_first);
    const int32_t first = find(k, of);
    for (int32_t c = 0; c < k->links; c++) { /* roots are minima of their pieces */
        const fl_passes_link *const l = &k->link[c];
        int32_t old = root(k, l->i), young = root(k, l->j);
        if (old == young) continue;
        if (young == first || (old != first && k->tile[young].at.d < k->tile[old].at.d)) {
            const int32_t t = old;
            old = young, young = t;
        }
        k->tile[young].up = old;
        if (!(l->d > k->tile[young].at.d)) continue; /* no minimum of its own */
        const fl_nearest pass = joined(s, k, l, x);
        if (put(w, x, &k->tile[young].at, radius, 1.0) || put(w, x, &pass, radius, -1.0)) return -1;
    }
    for (int32_t i = 0; i < k->tiles; i++)
        if (k->tile[i].up == i && i != first && put(w, x, &k->tile[i].at, radius, 1.0)) return -1;
    return 0;
}

/* --- all of them ---------------------------------------------------------------------------------- */

/* Tiles that a walk round the corner joins need no pass at the corner: whether tiles of pass `at` are. */
static int joined_round(const fl_passes *s, fl_passes_work *k, const fl_poly *p, const fl_bvh *tree,
                        const fl_aabb *box, int32_t f, const fl_pass *at)
{
    const double near = 4.0 * s->tol;
    const int32_t n = query(k, tree, box, aabb_grow((fl_aabb){at->a, at->a}, near));
    if (n < 0 || tiles_in(k, p, &(fl_passes_near){k->list, n}, at->a, near, NULL, -1) ||
        links_in(s, k, at->a, near))
        return -1;
    for (int32_t c = 0; c < k->links; c++) {
        const fl_pass *const l = &s->pass[k->link[c].pass];
        if (v3_norm(v3_sub(l->b, l->a)) >= 4.0 * s->tol)
            k->tile[root(k, k->link[c].i)].up = root(k, k->link[c].j);
    }
    const int32_t i = find(k, f), j = find(k, at->j);
    return i >= 0 && j >= 0 && root(k, i) == root(k, j);
}

/* Leave out the passes that are corners, where they can be: once all have been looked at. */
static int leave_corners(fl_passes *s, fl_passes_work *k, const fl_poly *p, const fl_bvh *tree,
                         const fl_aabb *box)
{
    int32_t kept = 0;
    for (int32_t f = 0; f < p->nf; f++) {
        for (int32_t at = s->begin[f]; at < s->begin[f + 1]; at++) {
            fl_pass *const l = &s->pass[at];
            if (v3_norm(v3_sub(l->b, l->a)) >= 4.0 * s->tol) continue;
            const int out = joined_round(s, k, p, tree, box, f, l);
            if (out < 0) return -1;
            l->inward = out ? OUT : l->inward;
        }
    }
    for (int32_t f = 0, at = 0; f < p->nf; f++) {
        const int32_t end = s->begin[f + 1];
        s->begin[f] = kept;
        for (; at < end; at++)
            if (s->pass[at].inward != OUT) s->pass[kept++] = s->pass[at];
    }
    s->n = s->begin[p->nf] = kept;
    return 0;
}

int fl_passes_make(fl_passes *out, const fl_poly *p, const fl_bvh *tree, const fl_aabb *box, fl_err *err)
{
    fl_passes s = {.tol = MEET * p->size, .same = SAME * p->size};
    fl_passes_work k = {0};
    double *met = fl_alloc(p->first[p->nf], sizeof *met, err);
    int rc = -1;
    s.begin = fl_alloc((int64_t)p->nf + 1, sizeof *s.begin, err);
    s.rim = fl_alloc(p->first[p->nf], sizeof *s.rim, err);
    if (!met || !s.begin || !s.rim) goto done;
    for (int32_t f = 0; f < p->nf; f++) {
        s.begin[f] = s.n;
        if (passes_of(&s, &k, p, tree, box, f, met)) {
            fl_fail(err, FL_SYSTEM, "out of memory: where %d tiles meet", (int)p->nf);
            goto done;
        }
    }
    s.begin[p->nf] = s.n;
    if (leave_corners(&s, &k, p, tree, box)) {
        fl_fail(err, FL_SYSTEM, "out of memory: where %d tiles meet", (int)p->nf);
        goto done;
    }
    for (int32_t f = 0; f < p->nf; f++) {
        for (int32_t c = p->first[f]; c < p->first[f + 1]; c++) {
            const double side = v3_norm(along(p, f, c));
            s.rim[c] = (uint8_t) !(met[c] >= side * (1.0 - 1e-9) - s.same);
        }
    }
    rc = 0;
done:
    free(met);
    fl_passes_work_free(&k);
    if (rc) fl_passes_free(&s);
    else *out = s;
    return rc;
}

void fl_passes_free(fl_passes *s)
{
    free(s->begin), free(s->pass), free(s->rim);
    *s = (fl_passes){0};
}

void fl_passes_work_free(fl_passes_work *k)
{
    free(k->tile), free(k->link), free(k->list);
    *k = (fl_passes_work){0};
}
