/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/union_find.h"
#include "geom/outer_skin.h"

static fl_vec3 corner_of(const fl_part *p, int32_t t, int k) { return p->v[p->t[t].v[k]]; }

/* Twice the area of triangle t along its normal. */
static fl_vec3 twice_area_vector(const fl_part *p, int32_t t)
{
    const fl_vec3 a = corner_of(p, t, 0);
    return v3_cross(v3_sub(corner_of(p, t, 1), a), v3_sub(corner_of(p, t, 2), a));
}

/* --- cells ------------------------------------------------------------------------------------- */

/* A triangle at an edge.  turn measures the angle about the edge, 0 to 4 for a full turn.  Of triangles on
 * the same three corners the lowest comes first, seen in the direction of rising corners: the same one at
 * each edge. */
typedef struct {
    double turn;
    int32_t t, rank, third; /* third corner */
    int up;
} edge_side;

static int compare_turn(const void *x, const void *y)
{
    const edge_side *a = x, *b = y;
    if (a->turn != b->turn) return a->turn < b->turn ? -1 : 1;
    return (a->rank > b->rank) - (a->rank < b->rank);
}

static double angle_measure(double x, double y)
{
    const double far = y / (fabs(x) + fabs(y));
    if (!(far == far)) return 0.0;
    return x >= 0.0 ? far >= 0.0 ? far : 4.0 + far : 2.0 - far;
}

/* The front side of t is 2 t, its back side 2 t + 1. */
static int32_t side_ahead(const edge_side *l) { return 2 * l->t + !l->up; }
static int32_t side_behind(const edge_side *l) { return 2 * l->t + l->up; }

/* Triangles that coincide within rounding, but not on the same corners, have no order. */
static const double SAME_TURN = 1e-9;

/* Sorts the triangles by angle.  Returns 0 where they have no order.  Two triangles need no sorting. */
static int sort_about_edge(const fl_part *p, int32_t lo, const fl_half_edge *s, int64_t n, edge_side *fan)
{
    const fl_vec3 from = p->v[lo], along = v3_unit(v3_sub(p->v[s->hi], from)), x = v3_normal_to(along),
                  y = v3_cross(along, x);
    for (int64_t k = 0; k < n; k++) {
        const int32_t t = s[k].t, third = p->t[t].v[(s[k].k + 2) % 3];
        const fl_vec3 apex = v3_sub(p->v[third], from);
        fan[k].turn = angle_measure(v3_dot(apex, x), v3_dot(apex, y));
        fan[k].third = third;
        fan[k].rank = lo < third && third < s[k].hi ? -t : t;
    }
    qsort(fan, (size_t)n, sizeof *fan, compare_turn);
    for (int64_t k = 0; k < n; k++) {
        const edge_side *a = &fan[k], *b = &fan[(k + 1) % n];
        const double apart = fabs(b->turn - a->turn);
        if (a->third != b->third && fmin(apart, 4.0 - apart) < SAME_TURN) return 0;
    }
    return 1;
}

/* Joins the sides about the edge from vertex lo that face the same cell; "ahead" is the direction of growing
 * angle.  Returns 0 where the triangles have no order. */
static int join_cells_at_edge(const fl_part *p, int32_t lo, const fl_half_edge *s, int64_t n, edge_side *fan,
                              int32_t *cell)
{
    int ordered = 1;
    for (int64_t k = 0; k < n; k++) fan[k] = (edge_side){.t = s[k].t, .up = s[k].up};
    if (n > 2) ordered = sort_about_edge(p, lo, s, n, fan);
    for (int64_t k = 0; k < n; k++)
        fl_union_find_join(cell, side_ahead(&fan[k]), side_behind(&fan[(k + 1) % n]));
    return ordered;
}

/* cell: [2 nt] sides; component: [nt] connected triangles; kind: [nt] properties of their edges */
enum { HAS_ODD_EDGE = 1, UNORDERED = 2 };
static int find_cells(const fl_part *p, const fl_edges *e, int32_t *cell, int32_t *component, uint8_t *kind,
                      fl_err *err)
{
    int64_t most = 1;
    for (int32_t v = 0; v < p->nv; v++)
        if (e->first[v + 1] - e->first[v] > most) most = e->first[v + 1] - e->first[v];
    edge_side *fan = fl_alloc(most, sizeof *fan, err);
    if (!fan) return -1;
    for (int32_t v = 0; v < p->nv; v++)
        for (int64_t from = e->first[v], to; from < e->first[v + 1]; from = to) {
            to = fl_edge_end(e, v, from);
            if (!join_cells_at_edge(p, v, e->side + from, to - from, fan, cell))
                kind[e->side[from].t] |= UNORDERED;
            if ((to - from) % 2) kind[e->side[from].t] |= HAS_ODD_EDGE;
            for (int64_t k = from + 1; k < to; k++)
                fl_union_find_join(component, e->side[from].t, e->side[k].t);
        }
    free(fan);
    for (int32_t t = 0; t < p->nt; t++) kind[fl_union_find_root(component, t)] |= kind[t];
    return 0;
}

/* --- the unbounded cell ------------------------------------------------------------------------ */

/* Intersects the line x + s n, |n| = 1, with triangle t.  Returns 1 with s, 0 for a miss, -1 if uncertain. */
static int line_hits_triangle(const fl_part *p, int32_t t, fl_vec3 x, fl_vec3 n, double *s)
{
    static const double SURE = 1e-7, STEEP = 1e-4;
    const fl_vec3 cross = twice_area_vector(p, t);
    const double twice = v3_norm(cross), across = v3_dot(cross, n);
    double least = INFINITY;
    *s = across != 0.0 ? v3_dot(cross, v3_sub(corner_of(p, t, 0), x)) / across : 0.0;
    for (int k = 0; k < 3; k++) {
        const fl_vec3 a = v3_sub(corner_of(p, t, k), x), b = v3_sub(corner_of(p, t, (k + 1) % 3), x);
        const double inside = v3_dot(n, v3_cross(a, b)) * (across < 0.0 ? -1.0 : 1.0);
        least = fmin(least, inside);
    }
    if (least < -SURE * twice) return 0;
    return least > SURE * twice && fabs(across) > STEEP * twice ? 1 : -1;
}

/* +1 if the corner indices of t rise in its order (cyclically), else -1. */
static int winding_sign(const fl_tri *t)
{
    const int32_t *v = t->v;
    return (v[0] < v[1]) + (v[1] < v[2]) + (v[2] < v[0]) == 2 ? 1 : -1;
}

/* Of the triangles of all[0 .. n) on the same corners as t, the one seen from the direction of the normal. */
static int32_t frontmost_triangle(const fl_part *p, const int32_t *all, int32_t n, int32_t t, fl_vec3 normal)
{
    const int way =
        v3_dot(twice_area_vector(p, t), normal) < 0.0 ? -winding_sign(&p->t[t]) : winding_sign(&p->t[t]);
    const int32_t *v = p->t[t].v;
    for (int32_t k = 0; k < n; k++) {
        const int32_t *u = p->t[all[k]].v;
        int same = 0;
        for (int i = 0; i < 3; i++) same += u[i] == v[0] || u[i] == v[1] || u[i] == v[2];
        if (same == 3 && way * all[k] > way * t) t = all[k];
    }
    return t;
}

/* The side hit first by a ray from far away that arrives at triangle t at right angles, among all[0 .. n).
 * *sure is 0 where another side may be first. */
static int32_t first_side_hit(const fl_part *p, const int32_t *all, int32_t n, int32_t t, int *sure)
{
    const fl_vec3 normal = v3_unit(twice_area_vector(p, t)),
                  x = v3_scale(1.0 / 3.0,
                               v3_add(corner_of(p, t, 0), v3_add(corner_of(p, t, 1), corner_of(p, t, 2))));
    double farthest = 0.0, doubtful = -INFINITY;
    int32_t met = t;
    for (int32_t k = 0; k < n; k++) {
        double s;
        const int through = all[k] != t ? line_hits_triangle(p, all[k], x, normal, &s) : 0;
        if (through < 0) doubtful = fmax(doubtful, s);
        if (through <= 0 || s <= farthest) continue;
        farthest = s;
        met = all[k];
    }
    *sure = doubtful < farthest;
    met = frontmost_triangle(p, all, n, met, normal);
    return 2 * met + (v3_dot(twice_area_vector(p, met), normal) < 0.0);
}

/* The unbounded cell of all[0 .. n).  Tries the largest triangle of each sample until the result is
 * certain. */
static int32_t find_outer_cell(const fl_part *p, const int32_t *all, int32_t n, int32_t *cell)
{
    enum { SAMPLES = 16 };
    int32_t found = -1;
    for (int64_t sample = 0; sample < SAMPLES; sample++) {
        double largest = 0.0;
        int32_t t = -1;
        int sure;
        for (int64_t k = sample * n / SAMPLES; k < (sample + 1) * n / SAMPLES; k++) {
            const double a = v3_norm2(twice_area_vector(p, all[k]));
            if (a > largest) largest = a, t = all[k];
        }
        if (t < 0) continue;
        const int32_t met = fl_union_find_root(cell, first_side_hit(p, all, n, t, &sure));
        if (sure) return met;
        if (found < 0) found = met;
    }
    return found;
}

int fl_part_outer_sides(const fl_part *p, const fl_edges *e, uint8_t *side, fl_err *err)
{
    int32_t *cell = fl_union_find_make(2 * (int64_t)p->nt, err),
            *component = cell ? fl_union_find_make(p->nt, err) : NULL;
    int32_t *first = component ? fl_alloc((int64_t)p->nt + 1, sizeof *first, err) : NULL;
    int32_t *all = first ? fl_alloc(p->nt, sizeof *all, err) : NULL;
    uint8_t *kind = all ? fl_alloc(p->nt, 1, err) : NULL;
    const int rc = kind ? find_cells(p, e, cell, component, kind, err) : -1;
    if (rc) goto done;
    for (int32_t t = 0; t < p->nt; t++) first[fl_union_find_root(component, t) + 1]++;
    for (int32_t t = 0; t < p->nt; t++) first[t + 1] += first[t];
    for (int32_t t = 0; t < p->nt; t++) all[first[fl_union_find_root(component, t)]++] = t;
    for (int32_t from = 0, to; from < p->nt; from = to) { /* each offset has advanced to the next group */
        const int32_t root = fl_union_find_root(component, all[from]);
        to = first[root];
        const int32_t outer =
            kind[root] == HAS_ODD_EDGE ? find_outer_cell(p, all + from, to - from, cell) : -1;
        for (int32_t k = from; k < to; k++) {
            const int32_t t = all[k];
            side[t] = (uint8_t)((fl_union_find_root(cell, 2 * t) == outer ? FL_OUTER_FRONT : 0) |
                                (fl_union_find_root(cell, 2 * t + 1) == outer ? FL_OUTER_BACK : 0));
            if (outer < 0) side[t] = FL_OUTER_BOTH;
        }
    }
done:
    free(cell), free(component), free(first), free(all), free(kind);
    return rc;
}
