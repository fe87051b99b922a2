/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geom/raise_deck.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "geom/edges.h"
#include "geom/facet.h"

/* Rims of a part: rim k is vertex[first[k] .. first[k + 1]), in the direction of its triangles. */
typedef struct {
    int32_t *vertex, *first, rims, n, chains;
    int32_t first_cap;
} rim_list;

/* A rim seen from above. */
typedef struct {
    double area; /* positive counter-clockwise */
    int depth;   /* rims that hold it */
    int32_t parent;
} rim_place;

static void free_rims(rim_list *r)
{
    free(r->vertex);
    free(r->first);
    *r = (rim_list){0};
}

static double flat_tolerance(const fl_part *p, double *top)
{
    const fl_aabb box = fl_part_aabb(p);
    *top = box.hi.z;
    return FL_DECK_FLAT * v3_norm(v3_sub(box.hi, box.lo));
}

/* True for a triangle that lies in the waterline, z = 0, at the top. */
static int is_lid(const fl_part *p, int32_t t, double least)
{
    return least <= 0.0 && p->v[p->t[t].v[0]].z >= least && p->v[p->t[t].v[1]].z >= least &&
           p->v[p->t[t].v[2]].z >= least;
}

/* --- rims ----------------------------------------------------------------------------------------------- */

/* Successor of each vertex along open edges at the top; -1: none.  A vertex of two rims keeps one. */
static int32_t *link_rims(const fl_part *p, const char *lid, double least, int32_t *edges, fl_err *err)
{
    fl_edges e = {0};
    int32_t *next = fl_alloc(p->nv, sizeof *next, err);
    *edges = 0;
    if (!next || fl_edges_make(&e, p, err)) {
        free(next);
        return NULL;
    }
    for (int32_t v = 0; v < p->nv; v++) next[v] = -1;
    for (int32_t v = 0; v < p->nv; v++)
        for (int64_t i = e.first[v], j; i < e.first[v + 1]; i = j) {
            int32_t alone = 0;
            int64_t at = -1;
            j = fl_edge_end(&e, v, i);
            for (int64_t k = i; k < j; k++)
                if (!lid[e.side[k].t]) alone++, at = k;
            if (alone != 1 || p->v[v].z < least || p->v[e.side[at].hi].z < least) continue;
            const int32_t from = e.side[at].up ? v : e.side[at].hi, to = e.side[at].up ? e.side[at].hi : v;
            next[from] = to;
            (*edges)++;
        }
    fl_edges_free(&e);
    return next;
}

/* Closed walks along the links. */
static int walk_rims(const fl_part *p, const int32_t *next, rim_list *r, int32_t edges, fl_err *err)
{
    int32_t *walk = fl_alloc(p->nv, sizeof *walk, err); /* number of the walk that passed a vertex */
    r->vertex = fl_alloc(p->nv, sizeof *r->vertex, err);
    if (!walk || !r->vertex || fl_grow(&r->first, &r->first_cap, 1, sizeof *r->first, err)) {
        free(walk);
        return -1;
    }
    r->first[0] = 0;
    int rc = 0;
    for (int32_t v = 0; v < p->nv && rc == 0; v++) {
        int32_t at = v, from = r->n;
        while (next[at] >= 0 && walk[at] == 0) {
            walk[at] = v + 1;
            at = next[at];
        }
        if (next[at] < 0 || walk[at] != v + 1) continue;
        const int32_t start = at; /* the walk may lead into a cycle from a tail */
        do {
            r->vertex[r->n++] = at;
            at = next[at];
        } while (at != start);
        if (r->n - from < 3) {
            r->n = from;
            continue;
        }
        rc = fl_grow(&r->first, &r->first_cap, (int64_t)r->rims + 2, sizeof *r->first, err);
        if (rc == 0) r->first[++r->rims] = r->n;
    }
    r->chains = edges - r->n;
    free(walk);
    return rc;
}

/* The rims of a part; lid[t] is set for the triangles at the top that are left out. */
static int find_rims(const fl_part *p, char *lid, rim_list *r, fl_deck_counts *did, fl_err *err)
{
    const double tol = flat_tolerance(p, &did->top), least = did->top - tol;
    int32_t edges;
    for (int32_t t = 0; t < p->nt; t++) {
        lid[t] = (char)(did->top <= tol && is_lid(p, t, least));
        did->lids += lid[t];
    }
    int32_t *next = link_rims(p, lid, least, &edges, err);
    const int rc = next ? walk_rims(p, next, r, edges, err) : -1;
    free(next);
    did->rims = r->rims;
    did->edges = r->n;
    did->chains = r->chains;
    return rc;
}

/* --- which rim holds which ------------------------------------------------------------------------------ */

static int is_inside(const fl_part *p, const rim_list *r, int32_t k, fl_vec3 x)
{
    int inside = 0;
    for (int32_t i = r->first[k]; i < r->first[k + 1]; i++) {
        const fl_vec3 a = p->v[r->vertex[i]],
                      b = p->v[r->vertex[i + 1 < r->first[k + 1] ? i + 1 : r->first[k]]];
        if ((a.y > x.y) != (b.y > x.y) && x.x < a.x + (x.y - a.y) / (b.y - a.y) * (b.x - a.x))
            inside = !inside;
    }
    return inside;
}

static void place_rims(const fl_part *p, const rim_list *r, rim_place *place)
{
    for (int32_t k = 0; k < r->rims; k++) {
        const fl_vec3 o = p->v[r->vertex[r->first[k]]];
        place[k] = (rim_place){.parent = -1};
        for (int32_t i = r->first[k]; i < r->first[k + 1]; i++) {
            const fl_vec3 a = v3_sub(p->v[r->vertex[i]], o),
                          b = v3_sub(p->v[r->vertex[i + 1 < r->first[k + 1] ? i + 1 : r->first[k]]], o);
            place[k].area += 0.5 * (a.x * b.y - a.y * b.x);
        }
    }
    for (int32_t k = 0; k < r->rims; k++)
        for (int32_t j = 0; j < r->rims; j++) {
            if (j == k || fabs(place[j].area) <= fabs(place[k].area)) continue;
            if (!is_inside(p, r, j, p->v[r->vertex[r->first[k]]])) continue;
            place[k].depth++;
            if (place[k].parent < 0 || fabs(place[j].area) < fabs(place[place[k].parent].area))
                place[k].parent = j;
        }
}

/* --- the deck ------------------------------------------------------------------------------------------- */

static double turn_of(fl_vec3 a, fl_vec3 b, fl_vec3 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static int is_in_triangle(fl_vec3 a, fl_vec3 b, fl_vec3 c, fl_vec3 x)
{
    const double s = turn_of(a, b, x), t = turn_of(b, c, x), u = turn_of(c, a, x);
    return (s >= 0.0 && t >= 0.0 && u >= 0.0) || (s <= 0.0 && t <= 0.0 && u <= 0.0);
}

/* True if the point m lies on the inner side of corner i of a counter-clockwise loop. */
static int corner_faces(const fl_part *p, const int32_t *loop, int32_t n, int32_t i, fl_vec3 m)
{
    const fl_vec3 a = p->v[loop[i ? i - 1 : n - 1]], b = p->v[loop[i]], c = p->v[loop[i + 1 < n ? i + 1 : 0]];
    const int left = turn_of(a, b, m) > 0.0, right = turn_of(b, c, m) > 0.0;
    return turn_of(a, b, c) > 0.0 ? left && right : left || right;
}

/* Corner of a counter-clockwise loop that the point m sees toward +x; -1 if nothing lies there. */
static int32_t visible_corner(const fl_part *p, const int32_t *loop, int32_t n, fl_vec3 m)
{
    double best = INFINITY;
    int32_t corner = -1;
    fl_vec3 hit = m;
    for (int32_t i = 0; i < n; i++) {
        const fl_vec3 a = p->v[loop[i]], b = p->v[loop[i + 1 < n ? i + 1 : 0]];
        if ((a.y > m.y) == (b.y > m.y)) continue;
        const double x = a.x + (m.y - a.y) / (b.y - a.y) * (b.x - a.x);
        if (x < m.x || x >= best) continue;
        best = x;
        hit = v3(x, m.y, m.z);
        corner = a.x > b.x ? i : i + 1 < n ? i + 1 : 0;
    }
    if (corner < 0) return -1;
    /* a concave corner within the triangle of m, the hit and that corner would hide it: the one of least
     * angle */
    const fl_vec3 far = p->v[loop[corner]];
    double angle = INFINITY;
    int32_t hiding = corner;
    for (int32_t i = 0; i < n; i++) {
        const fl_vec3 x = p->v[loop[i]];
        if ((x.x == far.x && x.y == far.y) || !(x.x > m.x) || !is_in_triangle(m, hit, far, x)) continue;
        const double slope = fabs(x.y - m.y) / (x.x - m.x);
        if (slope < angle || (slope == angle && x.x < p->v[loop[hiding]].x)) {
            angle = slope;
            hiding = i;
        }
    }
    /* an earlier cut repeats corners: the copy that looks at m */
    for (int32_t i = 0; i < n; i++)
        if (loop[i] == loop[hiding] && corner_faces(p, loop, n, i, m)) return i;
    return hiding;
}

/* Copies of the vertices of a rim, in the order given: top[] holds the raised vertex of each. */
static int32_t copy_loop(const rim_list *r, int32_t k, int backward, const int32_t *top, int32_t *to)
{
    const int32_t n = r->first[k + 1] - r->first[k];
    for (int32_t i = 0; i < n; i++) to[i] = top[r->first[k] + (backward ? n - 1 - i : i)];
    return n;
}

/* Puts a clockwise hole into a counter-clockwise loop, by a cut there and back. */
static int32_t cut_hole(const fl_part *p, int32_t *loop, int32_t n, const int32_t *hole, int32_t m)
{
    int32_t right = 0;
    for (int32_t i = 1; i < m; i++)
        if (p->v[hole[i]].x > p->v[hole[right]].x) right = i;
    const int32_t at = visible_corner(p, loop, n, p->v[hole[right]]);
    if (at < 0) return n;
    memmove(loop + at + m + 2, loop + at, (size_t)(n - at) * sizeof *loop);
    for (int32_t i = 0; i <= m; i++) loop[at + 1 + i] = hole[(right + i) % m];
    return n + m + 2;
}

typedef struct {
    double x;
    int32_t rim;
} hole_order;

static int compare_holes(const void *pa, const void *pb)
{
    const hole_order *a = pa, *b = pb;
    if (a->x != b->x) return a->x > b->x ? -1 : 1;
    return a->rim < b->rim ? -1 : a->rim > b->rim;
}

/* The deck of rim k: its loop, and the holes in it from the right to the left. */
static int cap_rim(fl_part *p, const rim_list *r, const rim_place *place, int32_t k, const int32_t *top,
                   fl_err *err)
{
    int32_t *loop = fl_alloc(2 * (int64_t)r->n + 2 * (int64_t)r->rims, sizeof *loop, err);
    int32_t *hole = loop ? fl_alloc(r->n, sizeof *hole, err) : NULL;
    hole_order *order = hole ? fl_alloc(r->rims, sizeof *order, err) : NULL;
    int32_t n, holes = 0;
    int rc = -1;
    if (!order) goto done;
    n = copy_loop(r, k, place[k].area < 0.0, top, loop);
    for (int32_t j = 0; j < r->rims; j++) {
        if (place[j].parent != k || place[j].depth != place[k].depth + 1) continue;
        order[holes] = (hole_order){-INFINITY, j};
        for (int32_t i = r->first[j]; i < r->first[j + 1]; i++)
            order[holes].x = fmax(order[holes].x, p->v[r->vertex[i]].x);
        holes++;
    }
    qsort(order, (size_t)holes, sizeof *order, compare_holes);
    for (int32_t i = 0; i < holes; i++) {
        const int32_t j = order[i].rim;
        n = cut_hole(p, loop, n, hole, copy_loop(r, j, place[j].area > 0.0, top, hole));
    }
    const int32_t before = p->nt;
    rc = fl_facet_polygon(p, n, loop, err);
    /* the deck runs against its walls: where the rim of an outward hull runs clockwise, it looks up */
    for (int32_t t = before; t < p->nt && place[k].area > 0.0; t++) {
        const int32_t keep = p->t[t].v[1];
        p->t[t].v[1] = p->t[t].v[2];
        p->t[t].v[2] = keep;
    }
done:
    free(loop);
    free(hole);
    free(order);
    return rc;
}

static int add_walls(fl_part *p, const rim_list *r, const int32_t *top, fl_err *err)
{
    for (int32_t k = 0; k < r->rims; k++)
        for (int32_t i = r->first[k]; i < r->first[k + 1]; i++) {
            const int32_t j = i + 1 < r->first[k + 1] ? i + 1 : r->first[k];
            const int32_t wall[4] = {r->vertex[j], r->vertex[i], top[i], top[j]};
            if (fl_facet_polygon(p, 4, wall, err)) return -1;
        }
    return 0;
}

int fl_part_rims(const fl_part *p, fl_deck_counts *did, fl_err *err)
{
    rim_list r = {0};
    *did = (fl_deck_counts){0};
    char *lid = fl_alloc(p->nt, 1, err);
    const int rc = lid ? find_rims(p, lid, &r, did, err) : -1;
    free(lid);
    free_rims(&r);
    return rc;
}

int fl_part_raise_deck(fl_part *p, double height, fl_deck_counts *did, fl_err *err)
{
    rim_list r = {0};
    rim_place *place = NULL;
    int32_t *top = NULL, kept = 0;
    int rc = -1;
    *did = (fl_deck_counts){0};
    char *lid = fl_alloc(p->nt, 1, err);
    if (!lid || find_rims(p, lid, &r, did, err)) goto done;
    if (r.rims == 0) {
        rc = 0;
        goto done;
    }
    place = fl_alloc(r.rims, sizeof *place, err);
    top = fl_alloc(r.n, sizeof *top, err);
    if (!place || !top) goto done;
    place_rims(p, &r, place);
    for (int32_t t = 0; t < p->nt; t++)
        if (!lid[t]) p->t[kept++] = p->t[t];
    p->nt = kept;
    for (int32_t i = 0; i < r.n; i++) {
        const fl_vec3 x = p->v[r.vertex[i]];
        top[i] = p->nv;
        if (fl_surface_vertex(p, v3(x.x, x.y, did->top + height), err)) goto done;
    }
    if (add_walls(p, &r, top, err)) goto done;
    for (int32_t k = 0; k < r.rims; k++) {
        did->holes += place[k].depth % 2;
        if (place[k].depth % 2 == 0 && cap_rim(p, &r, place, k, top, err)) goto done;
    }
    rc = 0;
done:
    free(lid);
    free(place);
    free(top);
    free_rims(&r);
    return rc;
}
