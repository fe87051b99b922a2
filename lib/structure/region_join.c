/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "structure/region_join.h"
#include "base/array.h"

/* Rounds in which edges with two seams on the same two vertices are halved. */
enum { ROUNDS = 4 };

/* A triangle of the surface: vertices, and whether its back is a side as well. */
typedef struct {
    int32_t v[3], cone, two_sided;
} triangle;

typedef struct {
    const fl_region_surface *s;
    double tol;
    fl_vec3 *v;    /* [nv] corners, each once; then middles of polygons */
    int32_t *of;   /* [s->nv] their number */
    fl_vec3 *more; /* [n_more] middles of edges that are halved */
    triangle *t;   /* [nt] */
    int32_t *ring, *on;
    double *at;
    int32_t nv, v_cap, n_more, more_cap, nt, t_cap, ring_cap, on_cap, at_cap;
    fl_bvh tree; /* over the corners */
    fl_aabb *box;
} mesh_builder;

static void builder_free(mesh_builder *m)
{
    free(m->v), free(m->of), free(m->more), free(m->t), free(m->ring), free(m->on), free(m->at), free(m->box);
    fl_bvh_free(&m->tree);
}

static int find_near(mesh_builder *m, fl_aabb box, int32_t *n, fl_err *err)
{
    *n = fl_bvh_query(&m->tree, m->box, box, m->on, m->on_cap);
    if (*n <= m->on_cap) return 0;
    if (fl_grow(&m->on, &m->on_cap, *n, sizeof *m->on, err)) return -1;
    *n = fl_bvh_query(&m->tree, m->box, box, m->on, m->on_cap);
    return 0;
}

static int build_tree(mesh_builder *m, const fl_vec3 *v, int32_t n, fl_err *err)
{
    free(m->box);
    m->box = fl_alloc(n, sizeof *m->box, err);
    for (int32_t k = 0; m->box && k < n; k++) m->box[k] = (fl_aabb){v[k], v[k]};
    return m->box ? fl_bvh_build(&m->tree, m->box, n, err) : -1;
}

/* Merges corners within tol of an earlier one; the middles of halved edges come last. */
static int weld_corners(mesh_builder *m, fl_err *err)
{
    const fl_region_surface *s = m->s;
    const int32_t n = s->nv + m->n_more;
    fl_vec3 *all = fl_alloc(n, sizeof *all, err);
    int rc = -1;
    m->nv = 0;
    free(m->of);
    m->of = fl_alloc(n, sizeof *m->of, err);
    if (!all || !m->of || fl_grow(&m->v, &m->v_cap, n, sizeof *m->v, err)) goto done;
    for (int32_t k = 0; k < n; k++) all[k] = k < s->nv ? s->v[k] : m->more[k - s->nv], m->of[k] = -1;
    if (build_tree(m, all, n, err)) goto done;
    for (int32_t k = 0; k < n; k++) {
        int32_t near;
        if (m->of[k] >= 0) continue;
        if (find_near(m, aabb_grow(m->box[k], m->tol), &near, err)) goto done;
        for (int32_t c = 0; c < near; c++)
            if (m->of[m->on[c]] < 0 && v3_norm(v3_sub(all[m->on[c]], all[k])) <= m->tol)
                m->of[m->on[c]] = m->nv;
        m->v[m->nv++] = all[k];
    }
    rc = build_tree(m, m->v, m->nv, err);
done:
    free(all);
    return rc;
}

static int append(mesh_builder *m, int32_t v, int32_t *n, fl_err *err)
{
    if (*n > 0 && m->ring[*n - 1] == v) return 0;
    if (fl_grow(&m->ring, &m->ring_cap, (int64_t)*n + 1, sizeof *m->ring, err)) return -1;
    m->ring[(*n)++] = v;
    return 0;
}

/* Appends the corners on the edge from a to b, without its ends. */
static int append_on_edge(mesh_builder *m, int32_t a, int32_t b, int32_t *n, fl_err *err)
{
    const int32_t low = a < b ? a : b, high = a < b ? b : a;
    const fl_vec3 o = m->v[low], u = v3_sub(m->v[high], o);
    int32_t near, found = 0;
    if (find_near(m, aabb_grow(aabb_add((fl_aabb){o, o}, m->v[high]), m->tol), &near, err) ||
        fl_grow(&m->at, &m->at_cap, near, sizeof *m->at, err))
        return -1;
    for (int32_t k = 0; k < near; k++) {
        const int32_t v = m->on[k];
        const fl_vec3 r = v3_sub(m->v[v], o);
        const double t = v3_dot(r, u) / v3_norm2(u);
        if (v == a || v == b || !(t > 0.0 && t < 1.0) || v3_norm(v3_madd(r, -t, u)) > m->tol) continue;
        int32_t c = found++; /* sorted along the edge */
        for (; c > 0 && m->at[c - 1] > t; c--) m->at[c] = m->at[c - 1], m->on[c] = m->on[c - 1];
        m->at[c] = t, m->on[c] = v;
    }
    for (int32_t k = 0; k < found; k++)
        if (append(m, m->on[a < b ? k : found - 1 - k], n, err)) return -1;
    return 0;
}

static int add_triangle(mesh_builder *m, int32_t a, int32_t b, int32_t c, const fl_region_polygon *p,
                        fl_err *err)
{
    if (fl_grow(&m->t, &m->t_cap, (int64_t)m->nt + 1, sizeof *m->t, err)) return -1;
    m->t[m->nt++] = (triangle){{a, b, c}, p->on_cone ? p->body : -1, p->two_sided};
    return 0;
}

/* True if the ring has a corner of nearly 180 degrees. */
static int has_straight_corner(const mesh_builder *m, int32_t n)
{
    for (int32_t k = 0; k < n; k++) {
        const fl_vec3 a = m->v[m->ring[k]], b = m->v[m->ring[(k + 1) % n]], c = m->v[m->ring[(k + 2) % n]],
                      u = v3_sub(c, a);
        if (v3_norm(v3_cross(v3_sub(b, a), u)) <= 10.0 * m->tol * v3_norm(u)) return 1;
    }
    return 0;
}

/* Triangulates polygon p, with all corners on its sides.  A two-sided polygon is divided from its middle, so
 * that no edge inside it joins two corners of its rim. */
static int triangulate(mesh_builder *m, const fl_region_polygon *p, fl_err *err)
{
    int32_t n = 0;
    for (int32_t k = 0; k < p->n; k++) {
        const int32_t a = m->of[p->first + k], b = m->of[p->first + (k + 1 < p->n ? k + 1 : 0)];
        if (a == b) continue;
        if (append(m, a, &n, err) || append_on_edge(m, a, b, &n, err)) return -1;
    }
    while (n > 1 && m->ring[n - 1] == m->ring[0]) n--;
    if (n < 3) return 0;
    if (n == 3 && !p->two_sided) return add_triangle(m, m->ring[0], m->ring[1], m->ring[2], p, err);
    if (!p->two_sided && !has_straight_corner(m, n)) {
        for (int32_t k = 2; k < n; k++)
            if (add_triangle(m, m->ring[0], m->ring[k - 1], m->ring[k], p, err)) return -1;
        return 0;
    }
    fl_vec3 middle = v3(0, 0, 0);
    const fl_vec3 o = m->v[m->ring[0]];
    for (int32_t k = 0; k < n; k++) middle = v3_madd(middle, 1.0 / n, v3_sub(m->v[m->ring[k]], o));
    if (fl_grow(&m->v, &m->v_cap, (int64_t)m->nv + 1, sizeof *m->v, err)) return -1;
    m->v[m->nv++] = v3_add(o, middle);
    for (int32_t k = 0; k < n; k++)
        if (add_triangle(m, m->ring[k], m->ring[(k + 1) % n], m->nv - 1, p, err)) return -1;
    return 0;
}

/* --- sides -------------------------------------------------------------------------------------- */

/* A triangle at an edge a < b. */
typedef struct {
    int32_t a, b, t, c; /* c: its third corner, 0 to 2 */
    int forward;        /* it runs from a to b: its front faces growing angles */
    double angle;
} edge_sheet;

static int compare_sheets(const void *x, const void *y)
{
    const edge_sheet *p = x, *q = y;
    if (p->a != q->a) return p->a < q->a ? -1 : 1;
    if (p->b != q->b) return p->b < q->b ? -1 : 1;
    if (p->angle != q->angle) return p->angle < q->angle ? -1 : 1;
    return (p->t > q->t) - (p->t < q->t);
}

/* A number that grows with the angle of (x, y) from 0 to 4. */
static double turn_of(double x, double y)
{
    const double sum = fabs(x) + fabs(y), f = sum > 0.0 ? y / sum : 0.0;
    return x < 0.0 ? 2.0 - f : f < 0.0 ? 4.0 + f : f;
}

/* A seam of two sides, or a rim, by its two vertices. */
typedef struct {
    int32_t low, high, edge;
} seam_ends;

static int compare_ends(const void *x, const void *y)
{
    const seam_ends *p = x, *q = y;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    return (p->edge > q->edge) - (p->edge < q->edge);
}

/* Corner c of a side of a triangle: 6 triangle + 3 back + c.  A forest joins those that are one vertex. */
typedef struct {
    int32_t *parent;   /* [6 nt] */
    edge_sheet *sheet; /* [3 nt] sorted by edge and angle */
    seam_ends *seam;   /* of joined sides: two of their corners */
    int32_t seams, rims;
} side_joiner;

static void joiner_free(side_joiner *j) { free(j->parent), free(j->sheet), free(j->seam); }

static int32_t root_of(int32_t *parent, int32_t k)
{
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
}

static void unite(int32_t *parent, int32_t a, int32_t b)
{
    const int32_t x = root_of(parent, a), y = root_of(parent, b);
    if (x < y) parent[y] = x;
    else parent[x] = y;
}

static int32_t corner_index(const triangle *t, int32_t v) { return t->v[0] == v ? 0 : t->v[1] == v ? 1 : 2; }

/* Sorts the triangles about every edge. */
static int sort_sheets(side_joiner *j, const mesh_builder *m, fl_err *err)
{
    j->parent = fl_alloc(6 * (int64_t)m->nt, sizeof *j->parent, err);
    j->sheet = fl_alloc(3 * (int64_t)m->nt, sizeof *j->sheet, err);
    j->seam = fl_alloc(3 * (int64_t)m->nt, sizeof *j->seam, err);
    if (!j->parent || !j->sheet || !j->seam) return -1;
    for (int32_t k = 0; k < 6 * m->nt; k++) j->parent[k] = k;
    for (int32_t k = 0; k < 3 * m->nt; k++) {
        const triangle *t = &m->t[k / 3];
        const int32_t a = t->v[k % 3], b = t->v[(k + 1) % 3];
        edge_sheet *e = &j->sheet[k];
        *e = (edge_sheet){a < b ? a : b, a < b ? b : a, k / 3, (k + 2) % 3, a < b, 0.0};
        const fl_vec3 axis = v3_unit(v3_sub(m->v[e->b], m->v[e->a])), x = v3_normal_to(axis),
                      y = v3_cross(axis, x), d = v3_sub(m->v[t->v[e->c]], m->v[e->a]);
        e->angle = turn_of(v3_dot(d, x), v3_dot(d, y));
    }
    qsort(j->sheet, 3 * (size_t)m->nt, sizeof *j->sheet, compare_sheets);
    return 0;
}

/* Joins the side of sheet e that faces growing angles with the side of f that faces falling ones; a side that
 * the surface does not have ends the other one. */
static void join_facing(side_joiner *j, const mesh_builder *m, const edge_sheet *e, const edge_sheet *f)
{
    const triangle *t = &m->t[e->t], *u = &m->t[f->t];
    const int back_e = !e->forward, back_f = f->forward, has_e = !back_e || t->two_sided,
              has_f = !back_f || u->two_sided;
    const int32_t from = 6 * e->t + 3 * back_e, to = 6 * f->t + 3 * back_f;
    j->rims += has_e != has_f;
    if (!has_e || !has_f) return;
    unite(j->parent, from + corner_index(t, e->a), to + corner_index(u, e->a));
    unite(j->parent, from + corner_index(t, e->b), to + corner_index(u, e->b));
    j->seam[j->seams++] =
        (seam_ends){from + corner_index(t, e->a), from + corner_index(t, e->b), (int32_t)(e - j->sheet)};
}

static void join_sides(side_joiner *j, const mesh_builder *m)
{
    const int32_t all = 3 * m->nt;
    for (int32_t k = 0, end; k < all; k = end) {
        for (end = k + 1; end < all && j->sheet[end].a == j->sheet[k].a && j->sheet[end].b == j->sheet[k].b;
             end++) {}
        for (int32_t i = k; i < end; i++) join_facing(j, m, &j->sheet[i], &j->sheet[i + 1 < end ? i + 1 : k]);
    }
}

/* Adds the middles of edges that have two seams on the same two vertices.  Returns how many, -1 with
 * FL_SYSTEM. */
static int32_t halve_double_seams(side_joiner *j, mesh_builder *m, fl_err *err)
{
    int32_t found = 0;
    for (int32_t k = 0; k < j->seams; k++) {
        seam_ends *e = &j->seam[k];
        const int32_t a = root_of(j->parent, e->low), b = root_of(j->parent, e->high);
        e->low = a < b ? a : b, e->high = a < b ? b : a;
    }
    if (j->seams > 1) qsort(j->seam, (size_t)j->seams, sizeof *j->seam, compare_ends);
    for (int32_t k = 1; k < j->seams; k++) {
        const seam_ends *e = &j->seam[k], *d = &j->seam[k - 1];
        if (e->low != d->low || e->high != d->high) continue;
        if (k > 1 && j->seam[k - 2].low == d->low && j->seam[k - 2].high == d->high) continue;
        const edge_sheet *at = &j->sheet[e->edge];
        if (fl_grow(&m->more, &m->more_cap, (int64_t)m->n_more + 1, sizeof *m->more, err)) return -1;
        m->more[m->n_more++] = v3_lerp(m->v[at->a], m->v[at->b], 0.5);
        found++;
    }
    return found;
}

/* Writes both sides of the triangles. */
static int write_part(fl_part *out, fl_joined_triangle **of, const side_joiner *j, const mesh_builder *m,
                      fl_err *err)
{
    int32_t *number = fl_alloc(6 * (int64_t)m->nt, sizeof *number, err);
    int rc = -1;
    *of = fl_alloc(2 * (int64_t)m->nt, sizeof **of, err);
    if (!number || !*of) goto done;
    for (int32_t k = 0; k < 6 * m->nt; k++) number[k] = -1;
    for (int32_t h = 0; h < 2 * m->nt; h++) {
        const triangle *t = &m->t[h / 2];
        const int back = h % 2;
        int32_t v[3];
        if (back && !t->two_sided) continue;
        for (int c = 0; c < 3; c++) {
            const int32_t root = root_of(j->parent, 3 * h + c);
            if (number[root] < 0) {
                number[root] = out->nv;
                if (fl_surface_vertex(out, v3_add(m->s->origin, m->v[t->v[c]]), err)) goto done;
            }
            v[c] = number[root];
        }
        (*of)[out->nt] = (fl_joined_triangle){t->cone, t->two_sided != 0};
        if (fl_surface_triangle(out, v[0], v[back ? 2 : 1], v[back ? 1 : 2], err)) goto done;
    }
    rc = 0;
done:
    free(number);
    return rc;
}

int fl_region_join(fl_part *out, fl_joined_triangle **of, int32_t *rims, const fl_region_surface *s,
                   fl_err *err)
{
    mesh_builder m = {.s = s, .tol = s->tol};
    int rc = -1;
    *of = NULL;
    for (int round = 0; round < ROUNDS; round++) {
        side_joiner j = {0};
        int32_t halved = -1;
        m.nt = 0;
        if (weld_corners(&m, err)) break;
        int failed = 0;
        for (int32_t p = 0; p < s->n && !failed; p++) failed = triangulate(&m, &s->polygon[p], err) != 0;
        if (!failed && sort_sheets(&j, &m, err) == 0) {
            join_sides(&j, &m);
            halved = halve_double_seams(&j, &m, err);
        }
        if (halved == 0 || (halved > 0 && round + 1 == ROUNDS)) {
            rc = write_part(out, of, &j, &m, err);
            *rims = j.rims;
            joiner_free(&j);
            break;
        }
        joiner_free(&j);
        if (halved < 0) break;
    }
    builder_free(&m);
    if (rc) free(*of), *of = NULL;
    return rc;
}
