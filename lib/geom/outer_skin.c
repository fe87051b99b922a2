/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/union_find.h"
#include "geom/outer_skin.h"

static fl_vec3 corner(const fl_part *p, int32_t t, int k) { return p->v[p->t[t].v[k]]; }

/* Twice its area, along its normal. */
static fl_vec3 cross_of(const fl_part *p, int32_t t)
{
    const fl_vec3 a = corner(p, t, 0);
    return v3_cross(v3_sub(corner(p, t, 1), a), v3_sub(corner(p, t, 2), a));
}

/* --- cells ------------------------------------------------------------------------------------- */

/* A side at an edge, by the turn of its triangle about it, 0 to 4 for a full one.  Of triangles on the same
 * three corners the first is the lowest, seen along the way on which the corners rise: at each edge the
 * same one. */
typedef struct {
    double turn;
    int32_t t, rank, third; /* corner */
    int up;
} leaf;

static int by_turn(const void *x, const void *y)
{
    const leaf *a = x, *b = y;
    if (a->turn != b->turn) return a->turn < b->turn ? -1 : 1;
    return (a->rank > b->rank) - (a->rank < b->rank);
}

static double turn_of(double x, double y)
{
    const double far = y / (fabs(x) + fabs(y));
    if (!(far == far)) return 0.0;
    return x >= 0.0 ? far >= 0.0 ? far : 4.0 + far : 2.0 - far;
}

/* The front of t is 2 t, its back 2 t + 1. */
static int32_t ahead(const leaf *l) { return 2 * l->t + !l->up; }
static int32_t behind(const leaf *l) { return 2 * l->t + l->up; }

/* Triangles that lie on one another but for rounding, and not on the same corners, have no order. */
static const double SAME_TURN = 1e-9;

/* In the order of their turns; 0 where they have none.  Of two each follows the other, whatever these are. */
static int order_about(const fl_part *p, int32_t lo, const fl_half_edge *s, int64_t n, leaf *fan)
{
    const fl_vec3 from = p->v[lo], along = v3_unit(v3_sub(p->v[s->hi], from)), x = v3_normal_to(along),
                  y = v3_cross(along, x);
    for (int64_t k = 0; k < n; k++) {
        const int32_t t = s[k].t, third = p->t[t].v[(s[k].k + 2) % 3];
        const fl_vec3 apex = v3_sub(p->v[third], from);
        fan[k].turn = turn_of(v3_dot(apex, x), v3_dot(apex, y));
        fan[k].third = third;
        fan[k].rank = lo < third && third < s[k].hi ? -t : t;
    }
    qsort(fan, (size_t)n, sizeof *fan, by_turn);
    for (int64_t k = 0; k < n; k++) {
        const leaf *a = &fan[k], *b = &fan[(k + 1) % n];
        const double apart = fabs(b->turn - a->turn);
        if (a->third != b->third && fmin(apart, 4.0 - apart) < SAME_TURN) return 0;
    }
    return 1;
}

/* Sides about the edge from vertex lo that look into the same cell: ahead is where turns grow.  0 where
 * they have no order. */
static int join_about(const fl_part *p, int32_t lo, const fl_half_edge *s, int64_t n, leaf *fan,
                      int32_t *cell)
{
    int ordered = 1;
    for (int64_t k = 0; k < n; k++) fan[k] = (leaf){.t = s[k].t, .up = s[k].up};
    if (n > 2) ordered = order_about(p, lo, s, n, fan);
    for (int64_t k = 0; k < n; k++) fl_union_find_join(cell, ahead(&fan[k]), behind(&fan[(k + 1) % n]));
    return ordered;
}

/* cell: [2 nt] sides; whole: [nt] triangles that hang together; kind: [nt] what is true of their edges */
enum { SINGLE = 1, DISORDERED = 2 };
static int find_cells(const fl_part *p, const fl_edges *e, int32_t *cell, int32_t *whole, uint8_t *kind,
                      fl_err *err)
{
    int64_t most = 1;
    for (int32_t v = 0; v < p->nv; v++)
        if (e->first[v + 1] - e->first[v] > most) most = e->first[v + 1] - e->first[v];
    leaf *fan = fl_alloc(most, sizeof *fan, err);
    if (!fan) return -1;
    for (int32_t v = 0; v < p->nv; v++)
        for (int64_t from = e->first[v], to; from < e->first[v + 1]; from = to) {
            to = fl_edge_end(e, v, from);
            if (!join_about(p, v, e->side + from, to - from, fan, cell)) kind[e->side[from].t] |= DISORDERED;
            if ((to - from) % 2) kind[e->side[from].t] |= SINGLE;
            for (int64_t k = from + 1; k < to; k++) fl_union_find_join(whole, e->side[from].t, e->side[k].t);
        }
    free(fan);
    for (int32_t t = 0; t < p->nt; t++) kind[fl_union_find_root(whole, t)] |= kind[t];
    return 0;
}

/* --- the one without bounds -------------------------------------------------------------------- */

/* Where the line x + s n, of unit n, goes through triangle t: 1 with s, 0 where it passes it by, -1 where
 * that is not sure. */
static int pierces(const fl_part *p, int32_t t, fl_vec3 x, fl_vec3 n, double *s)
{
    static const double SURE = 1e-7, STEEP = 1e-4;
    const fl_vec3 cross = cross_of(p, t);
    const double twice = v3_norm(cross), across = v3_dot(cross, n);
    double least = INFINITY;
    *s = across != 0.0 ? v3_dot(cross, v3_sub(corner(p, t, 0), x)) / across : 0.0;
    for (int k = 0; k < 3; k++) {
        const fl_vec3 a = v3_sub(corner(p, t, k), x), b = v3_sub(corner(p, t, (k + 1) % 3), x);
        const double inside = v3_dot(n, v3_cross(a, b)) * (across < 0.0 ? -1.0 : 1.0);
        least = fmin(least, inside);
    }
    if (least < -SURE * twice) return 0;
    return least > SURE * twice && fabs(across) > STEEP * twice ? 1 : -1;
}

/* +1 where the corners rise in the order in which t runs through them, -1 against it. */
static int rises(const fl_tri *t)
{
    const int32_t *v = t->v;
    return (v[0] < v[1]) + (v[1] < v[2]) + (v[2] < v[0]) == 2 ? 1 : -1;
}

/* Which of the triangles of all[0 .. n) on the same corners as t is seen from where the normal points. */
static int32_t foremost(const fl_part *p, const int32_t *all, int32_t n, int32_t t, fl_vec3 normal)
{
    const int way = v3_dot(cross_of(p, t), normal) < 0.0 ? -rises(&p->t[t]) : rises(&p->t[t]);
    const int32_t *v = p->t[t].v;
    for (int32_t k = 0; k < n; k++) {
        const int32_t *u = p->t[all[k]].v;
        int same = 0;
        for (int i = 0; i < 3; i++) same += u[i] == v[0] || u[i] == v[1] || u[i] == v[2];
        if (same == 3 && way * all[k] > way * t) t = all[k];
    }
    return t;
}

/* The side of one of all[0 .. n) that is met first from far off on the way to triangle t, head on; sure: 0
 * where another one may have been. */
static int32_t side_met(const fl_part *p, const int32_t *all, int32_t n, int32_t t, int *sure)
{
    const fl_vec3 normal = v3_unit(cross_of(p, t)),
                  x = v3_scale(1.0 / 3.0, v3_add(corner(p, t, 0), v3_add(corner(p, t, 1), corner(p, t, 2))));
    double farthest = 0.0, doubtful = -INFINITY;
    int32_t met = t;
    for (int32_t k = 0; k < n; k++) {
        double s;
        const int through = all[k] != t ? pierces(p, all[k], x, normal, &s) : 0;
        if (through < 0) doubtful = fmax(doubtful, s);
        if (through <= 0 || s <= farthest) continue;
        farthest = s;
        met = all[k];
    }
    *sure = doubtful < farthest;
    met = foremost(p, all, n, met, normal);
    return 2 * met + (v3_dot(cross_of(p, met), normal) < 0.0);
}

/* The cell without bounds of all[0 .. n), by the largest triangle of each of a few lots, until it is sure. */
static int32_t outer_cell(const fl_part *p, const int32_t *all, int32_t n, int32_t *cell)
{
    enum { LOTS = 16 };
    int32_t found = -1;
    for (int64_t lot = 0; lot < LOTS; lot++) {
        double largest = 0.0;
        int32_t t = -1;
        int sure;
        for (int64_t k = lot * n / LOTS; k < (lot + 1) * n / LOTS; k++) {
            const double a = v3_norm2(cross_of(p, all[k]));
            if (a > largest) largest = a, t = all[k];
        }
        if (t < 0) continue;
        const int32_t met = fl_union_find_root(cell, side_met(p, all, n, t, &sure));
        if (sure) return met;
        if (found < 0) found = met;
    }
    return found;
}

int fl_part_outer_sides(const fl_part *p, const fl_edges *e, uint8_t *side, fl_err *err)
{
    int32_t *cell = fl_union_find_make(2 * (int64_t)p->nt, err),
            *whole = cell ? fl_union_find_make(p->nt, err) : NULL;
    int32_t *first = whole ? fl_alloc((int64_t)p->nt + 1, sizeof *first, err) : NULL;
    int32_t *all = first ? fl_alloc(p->nt, sizeof *all, err) : NULL;
    uint8_t *kind = all ? fl_alloc(p->nt, 1, err) : NULL;
    const int rc = kind ? find_cells(p, e, cell, whole, kind, err) : -1;
    if (rc) goto done;
    for (int32_t t = 0; t < p->nt; t++) first[fl_union_find_root(whole, t) + 1]++;
    for (int32_t t = 0; t < p->nt; t++) first[t + 1] += first[t];
    for (int32_t t = 0; t < p->nt; t++) all[first[fl_union_find_root(whole, t)]++] = t;
    for (int32_t from = 0, to; from < p->nt; from = to) { /* each ran on to where the next one starts */
        const int32_t root = fl_union_find_root(whole, all[from]);
        to = first[root];
        const int32_t outer = kind[root] == SINGLE ? outer_cell(p, all + from, to - from, cell) : -1;
        for (int32_t k = from; k < to; k++) {
            const int32_t t = all[k];
            side[t] = (uint8_t)((fl_union_find_root(cell, 2 * t) == outer ? FL_OUTER_FRONT : 0) |
                                (fl_union_find_root(cell, 2 * t + 1) == outer ? FL_OUTER_BACK : 0));
            if (outer < 0) side[t] = FL_OUTER_BOTH;
        }
    }
done:
    free(cell), free(whole), free(first), free(all), free(kind);
    return rc;
}
