/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "block/block_shape.h"
#include <float.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"

/* Corners closer than this, relative to the size, are one: four times the limit of fl_poly_make(). */
static const double WELD_TOL = 4e-10;

int fl_block_shape_alloc(fl_block_shape *s, int64_t nv, int64_t nf, int64_t loops, fl_err *err)
{
    const int64_t bytes = nv * (int64_t)sizeof(fl_vec3) + (2 * nf + 1 + loops) * (int64_t)sizeof(int32_t);
    char *at = fl_alloc(bytes, 1, err);
    *s = (fl_block_shape){.group = -1};
    if (!at) return -1;
    s->v = (fl_vec3 *)(void *)at;
    s->first = (int32_t *)(void *)(s->v + nv);
    s->tag = s->first + nf + 1;
    s->loop = s->tag + nf;
    return 0;
}

void fl_block_shape_free(fl_block_shape *s)
{
    free(s->v);
    *s = (fl_block_shape){0};
}

void fl_block_shape_bound(fl_block_shape *s)
{
    s->box = aabb_empty();
    for (int32_t k = 0; k < s->nv; k++) s->box = aabb_add(s->box, s->v[k]);
}

int fl_block_shape_box(fl_block_shape *s, fl_vec3 lo, fl_vec3 hi, fl_err *err)
{
    static const int32_t LOOP[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                       {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    if (fl_block_shape_alloc(s, 8, 6, 24, err)) return -1;
    s->nv = 8, s->nf = 6;
    for (int32_t k = 0; k < 8; k++)
        s->v[k] = v3(k % 4 == 1 || k % 4 == 2 ? hi.x : lo.x, k % 4 >= 2 ? hi.y : lo.y, k >= 4 ? hi.z : lo.z);
    for (int32_t f = 0; f <= 6; f++) s->first[f] = 4 * f;
    for (int32_t f = 0; f < 6; f++) s->tag[f] = -1;
    memcpy(s->loop, LOOP, sizeof LOOP);
    fl_block_shape_bound(s);
    return 0;
}

/* --- split -------------------------------------------------------------------------------------- */

static int is_before(fl_vec3 a, fl_vec3 b)
{
    if (a.x < b.x || a.x > b.x) return a.x < b.x;
    if (a.y < b.y || a.y > b.y) return a.y < b.y;
    return a.z < b.z;
}

/* The point of an edge on the plane; the same bits for either direction of the edge. */
static fl_vec3 cut_point(fl_vec3 a, double sa, fl_vec3 b, double sb)
{
    return is_before(a, b) ? v3_lerp(a, b, sa / (sa - sb)) : v3_lerp(b, a, sb / (sb - sa));
}

/* What both sides of a split share. */
typedef struct {
    const fl_block_shape *a;
    double *s;   /* [nv] distance from the plane, 0 on it */
    int32_t *of; /* [2 cuts] ends of the edges that are cut, below and above the plane */
    fl_vec3 *x;  /* [cuts] where */
    int32_t cuts;
    int32_t *next, *place; /* [nv + cuts] scratch of one side */
} split_scratch;

static int alloc_scratch(split_scratch *w, const fl_block_shape *a, fl_err *err)
{
    const int64_t nv = a->nv, nl = a->first[a->nf], most = nv + nl;
    char *at = fl_alloc(nl * (int64_t)sizeof(fl_vec3) + nv * (int64_t)sizeof(double) +
                            (2 * nl + 2 * most) * (int64_t)sizeof(int32_t),
                        1, err);
    if (!at) return -1;
    w->x = (fl_vec3 *)(void *)at;
    w->s = (double *)(void *)(w->x + nl);
    w->of = (int32_t *)(void *)(w->s + nv);
    w->next = w->of + 2 * nl;
    w->place = w->next + most;
    return 0;
}

static int32_t find_cut(const split_scratch *w, int32_t below, int32_t above)
{
    int32_t k = 0;
    while (k < w->cuts && (w->of[2 * k] != below || w->of[2 * k + 1] != above)) k++;
    return k;
}

static void find_cuts(split_scratch *w)
{
    const fl_block_shape *a = w->a;
    for (int32_t f = 0; f < a->nf; f++)
        for (int32_t k = a->first[f]; k < a->first[f + 1]; k++) {
            const int32_t i = a->loop[k], j = a->loop[k + 1 < a->first[f + 1] ? k + 1 : a->first[f]];
            /* each edge is met once in either direction */
            if (!(w->s[i] < 0.0 && w->s[j] > 0.0)) continue;
            w->of[2 * w->cuts] = i, w->of[2 * w->cuts + 1] = j;
            w->x[w->cuts++] = cut_point(a->v[i], w->s[i], a->v[j], w->s[j]);
        }
}

/* Copies the part of face f on one side into the loop of to, from position at; returns the position behind
 * it. */
static int32_t clip_face(const split_scratch *w, int32_t f, double side, int32_t *loop, int32_t at)
{
    const fl_block_shape *a = w->a;
    for (int32_t k = a->first[f]; k < a->first[f + 1]; k++) {
        const int32_t i = a->loop[k], j = a->loop[k + 1 < a->first[f + 1] ? k + 1 : a->first[f]];
        const double si = side * w->s[i], sj = side * w->s[j];
        if (si >= 0.0) loop[at++] = i;
        if ((si < 0.0 && sj > 0.0) || (si > 0.0 && sj < 0.0))
            loop[at++] = a->nv + (w->s[i] < 0.0 ? find_cut(w, i, j) : find_cut(w, j, i));
    }
    return at;
}

/* Follows the links of the cap; returns its length, or 0 if it does not close. */
static int32_t close_ring(const split_scratch *w, int32_t links, int32_t *loop)
{
    const int32_t most = w->a->nv + w->cuts;
    int32_t start = 0, n = 0;
    while (start < most && w->next[start] < 0) start++;
    if (start == most) return 0;
    int32_t k = start;
    do {
        loop[n++] = k;
        k = w->next[k];
    } while (k >= 0 && k != start && n < links);
    return k == start && n == links && n >= 3 ? n : 0;
}

/* Corners in use, old ones first. */
static void renumber_corners(split_scratch *w, fl_block_shape *to)
{
    const int32_t most = w->a->nv + w->cuts, nl = to->first[to->nf];
    int32_t n = 0;
    for (int32_t k = 0; k < most; k++) w->place[k] = 0;
    for (int32_t k = 0; k < nl; k++) w->place[to->loop[k]] = 1;
    for (int32_t k = 0; k < most; k++)
        if (w->place[k]) {
            to->v[n] = k < w->a->nv ? w->a->v[k] : w->x[k - w->a->nv];
            w->place[k] = n++;
        }
    for (int32_t k = 0; k < nl; k++) to->loop[k] = w->place[to->loop[k]];
    to->nv = n;
}

/* The part where side * s >= 0.  1, 0 if its cap does not close, -1. */
static int make_side(split_scratch *w, double side, int32_t tag, fl_block_shape *to, fl_err *err)
{
    const fl_block_shape *a = w->a;
    const int32_t most = a->nv + w->cuts;
    int32_t at = 0, links = 0;
    if (fl_block_shape_alloc(to, most, (int64_t)a->nf + 1, (int64_t)a->first[a->nf] + 4 * w->cuts + a->nv,
                             err))
        return -1;
    for (int32_t k = 0; k < most; k++) w->next[k] = -1;
    for (int32_t f = 0; f < a->nf; f++) {
        int some = 0;
        for (int32_t k = a->first[f]; k < a->first[f + 1]; k++) some |= side * w->s[a->loop[k]] > 0.0;
        if (!some) continue;
        const int32_t begin = at;
        at = clip_face(w, f, side, to->loop, at);
        for (int32_t k = begin; k < at; k++) {
            const int32_t u = to->loop[k], x = to->loop[k + 1 < at ? k + 1 : begin];
            if ((u < a->nv && w->s[u] != 0.0) || (x < a->nv && w->s[x] != 0.0)) continue;
            links += w->next[x] < 0;
            w->next[x] = u;
        }
        to->tag[to->nf++] = a->tag[f];
        to->first[to->nf] = at;
    }
    const int32_t cap = close_ring(w, links, to->loop + at);
    if (cap == 0) return 0;
    to->tag[to->nf++] = tag;
    to->first[to->nf] = at + cap;
    renumber_corners(w, to);
    to->group = a->group;
    to->key = a->key ^ fl_block_mix((uint64_t)tag + 1);
    fl_block_shape_bound(to);
    return 1;
}

int fl_block_shape_split(const fl_block_shape *a, fl_vec3 n, double c, int32_t plane, double tol,
                         fl_block_shape part[2], fl_err *err)
{
    split_scratch w = {.a = a};
    int32_t below = 0, above = 0;
    /* most blocks are far from a plane */
    const fl_vec3 mid = v3_scale(0.5, v3_add(a->box.lo, a->box.hi)), half = v3_sub(a->box.hi, mid);
    const double reach = fabs(n.x) * half.x + fabs(n.y) * half.y + fabs(n.z) * half.z;
    if (fabs(v3_dot(n, mid) - c) > reach + tol) return 0;
    if (alloc_scratch(&w, a, err)) return -1;
    for (int32_t k = 0; k < a->nv; k++) {
        w.s[k] = v3_dot(n, a->v[k]) - c;
        if (fabs(w.s[k]) <= tol) w.s[k] = 0.0;
        below += w.s[k] < 0.0;
        above += w.s[k] > 0.0;
    }
    int rc = below && above;
    if (rc) {
        find_cuts(&w);
        rc = make_side(&w, -1.0, 2 * plane, &part[0], err);
        if (rc == 1) {
            rc = make_side(&w, 1.0, 2 * plane + 1, &part[1], err);
            if (rc != 1) fl_block_shape_free(&part[1]);
        }
        if (rc != 1) fl_block_shape_free(&part[0]);
        if (rc == 0)
            rc = fl_fail(err, FL_NUMERIC,
                         "the cut of a block near (%.6g, %.6g, %.6g) does not close: it is too thin",
                         a->v[0].x, a->v[0].y, a->v[0].z);
    }
    free(w.x);
    return rc;
}

/* --- measures ----------------------------------------------------------------------------------- */

static fl_vec3 face_area_vector(const fl_block_shape *s, int32_t f)
{
    const int32_t *loop = s->loop + s->first[f], m = s->first[f + 1] - s->first[f];
    const fl_vec3 o = s->v[loop[0]];
    fl_vec3 sum = v3(0, 0, 0);
    for (int32_t k = 1; k + 1 < m; k++)
        sum = v3_add(sum, v3_cross(v3_sub(s->v[loop[k]], o), v3_sub(s->v[loop[k + 1]], o)));
    return v3_scale(0.5, sum);
}

fl_vec3 fl_block_face_normal(const fl_block_shape *s, int32_t f, double *c)
{
    const fl_vec3 n = v3_unit(face_area_vector(s, f));
    double most = -INFINITY;
    for (int32_t k = s->first[f]; k < s->first[f + 1]; k++) most = fmax(most, v3_dot(n, s->v[s->loop[k]]));
    *c = most;
    return n;
}

double fl_block_face_area(const fl_block_shape *s, int32_t f) { return v3_norm(face_area_vector(s, f)); }

double fl_block_shape_volume(const fl_block_shape *s, fl_vec3 *centre)
{
    const fl_vec3 o = s->v[0];
    fl_vec3 first = v3(0, 0, 0);
    double sum = 0.0;
    for (int32_t f = 0; f < s->nf; f++) {
        const int32_t *loop = s->loop + s->first[f], m = s->first[f + 1] - s->first[f];
        const fl_vec3 a = v3_sub(s->v[loop[0]], o);
        for (int32_t k = 1; k + 1 < m; k++) {
            const fl_vec3 b = v3_sub(s->v[loop[k]], o), c = v3_sub(s->v[loop[k + 1]], o);
            const double w = v3_dot(a, v3_cross(b, c)) / 6.0;
            sum += w;
            first = v3_madd(first, 0.25 * w, v3_add(a, v3_add(b, c)));
        }
    }
    if (centre) *centre = sum > 0.0 ? v3_add(o, v3_scale(1.0 / sum, first)) : o;
    return sum;
}

double fl_block_shape_width(const fl_block_shape *s)
{
    double least = INFINITY;
    for (int32_t f = 0; f < s->nf; f++) {
        double c, deep = 0.0;
        const fl_vec3 n = fl_block_face_normal(s, f, &c);
        for (int32_t k = 0; k < s->nv; k++) deep = fmax(deep, c - v3_dot(n, s->v[k]));
        least = fmin(least, deep);
    }
    return least;
}

/* --- polyhedron --------------------------------------------------------------------------------- */

static int32_t root_corner(int32_t *up, int32_t k)
{
    while (up[k] != k) k = up[k] = up[up[k]];
    return k;
}

/* The same with corners merged. */
static int make_welded(const fl_block_shape *s, fl_poly *out, int32_t *face, fl_err *err)
{
    const double tol = WELD_TOL * v3_norm(v3_sub(s->box.hi, s->box.lo)) + 32 * DBL_EPSILON * v3_norm(s->v[0]);
    int32_t *up = fl_alloc(2 * (int64_t)s->nv + s->nf + 1 + s->first[s->nf], sizeof *up, err);
    fl_vec3 *v = fl_alloc(s->nv, sizeof *v, err);
    fl_err why = {0};
    int32_t at = 0, nf = 0, nv = 0;
    int rc = -1;
    if (!up || !v) goto done;
    int32_t *place = up + s->nv, *first = place + s->nv, *loop = first + s->nf + 1;
    for (int32_t k = 0; k < s->nv; k++) up[k] = k, place[k] = -1;
    for (int32_t i = 0; i < s->nv; i++)
        for (int32_t j = 0; j < i; j++)
            if (v3_norm(v3_sub(s->v[i], s->v[j])) <= tol) up[root_corner(up, i)] = root_corner(up, j);
    for (int32_t f = 0; f < s->nf; f++) {
        const int32_t begin = at;
        for (int32_t k = s->first[f]; k < s->first[f + 1]; k++) {
            const int32_t c = root_corner(up, s->loop[k]);
            if (at == begin || loop[at - 1] != c) loop[at++] = c;
        }
        while (at > begin + 1 && loop[at - 1] == loop[begin]) at--;
        if (at - begin < 3) at = begin;
        if (face) face[f] = at > begin ? nf : -1;
        if (at > begin) first[++nf] = at;
    }
    for (int32_t k = 0; k < at; k++) {
        if (place[loop[k]] < 0) v[nv] = s->v[loop[k]], place[loop[k]] = nv++;
        loop[k] = place[loop[k]];
    }
    rc = 0;
    if (nf >= 4 && fl_poly_make(out, nv, v, nf, first, loop, &why) == 0) rc = 1;
    else if (why.code == FL_SYSTEM) rc = fl_fail(err, FL_SYSTEM, "%s", why.text);
done:
    free(up), free(v);
    return rc;
}

int fl_block_shape_poly(const fl_block_shape *s, fl_poly *out, int32_t *face, fl_err *err)
{
    fl_err why = {0};
    if (fl_poly_make(out, s->nv, s->v, s->nf, s->first, s->loop, &why) == 0) {
        for (int32_t f = 0; face && f < s->nf; f++) face[f] = f;
        return 1;
    }
    if (why.code == FL_SYSTEM) return fl_fail(err, FL_SYSTEM, "%s", why.text);
    return make_welded(s, out, face, err);
}
