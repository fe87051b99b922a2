/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/array.h"
#include "base/pi.h"
#include "ice/plan_outline.h"
#include "ice/waterplane_cut.h"

/* Generators of a cone; its discs are circumscribed polygons, so that nothing is cut off. */
enum { AROUND = 4 * FL_WATERPLANE_MAX_SIDES };

/* Extent of a group in each direction 2 pi k / FL_WATERPLANE_MAX_SIDES, which include those of fewer
 * sides. */
struct extent {
    double far[FL_WATERPLANE_MAX_SIDES], x0, x1, y0, y1;
    int any;
};

static void start_extent(struct extent *r)
{
    for (int k = 0; k < FL_WATERPLANE_MAX_SIDES; k++) r->far[k] = -INFINITY;
    r->x0 = r->y0 = INFINITY;
    r->x1 = r->y1 = -INFINITY;
    r->any = 0;
}

static fl_vec2 direction_of(int k)
{
    return (fl_vec2){cos(2.0 * PI * k / FL_WATERPLANE_MAX_SIDES),
                     sin(2.0 * PI * k / FL_WATERPLANE_MAX_SIDES)};
}

static void add_point(struct extent *r, double x, double y)
{
    for (int k = 0; k < FL_WATERPLANE_MAX_SIDES; k++) {
        const fl_vec2 u = direction_of(k);
        r->far[k] = fmax(r->far[k], u.x * x + u.y * y);
    }
    r->x0 = fmin(r->x0, x);
    r->x1 = fmax(r->x1, x);
    r->y0 = fmin(r->y0, y);
    r->y1 = fmax(r->y1, y);
    r->any = 1;
}

/* Add the part of an edge between the levels.  Corners of the plan view of a cut polyhedron are corners
 * and points of edges. */
static void add_edge(struct extent *r, fl_vec3 a, fl_vec3 b, double z0, double z1)
{
    double from = 0.0, to = 1.0;
    if ((a.z < z0 && b.z < z0) || (a.z > z1 && b.z > z1)) return;
    if (a.z < z0) from = (z0 - a.z) / (b.z - a.z);
    if (a.z > z1) from = (z1 - a.z) / (b.z - a.z);
    if (b.z < z0) to = (z0 - a.z) / (b.z - a.z);
    if (b.z > z1) to = (z1 - a.z) / (b.z - a.z);
    a = v3_lerp(a, b, from);
    add_point(r, a.x, a.y);
    if (to > from) {
        const fl_vec3 e = v3_lerp(a, b, (to - from) / (1.0 - from));
        add_point(r, e.x, e.y);
    }
}

static void add_cone(struct extent *r, const fl_cone *c, double z0, double z1)
{
    const fl_vec3 axis = v3_unit(v3_sub(c->p1, c->p0)), u = v3_normal_to(axis), w = v3_cross(axis, u);
    const double out = 1.0 / cos(PI / AROUND);
    fl_vec3 last[2] = {{0}};
    for (int k = 0; k <= AROUND; k++) {
        const double a = 2.0 * PI * k / AROUND;
        const fl_vec3 e = v3_add(v3_scale(out * cos(a), u), v3_scale(out * sin(a), w));
        const fl_vec3 now[2] = {v3_madd(c->p0, c->r0, e), v3_madd(c->p1, c->r1, e)};
        add_edge(r, now[0], now[1], z0, z1);
        if (k) add_edge(r, last[0], now[0], z0, z1);
        if (k) add_edge(r, last[1], now[1], z0, z1);
        last[0] = now[0];
        last[1] = now[1];
    }
}

/* Number of sides of a polygon that is within `coarse` of the group. */
static int count_sides(double size, double coarse)
{
    int n = FL_WATERPLANE_MIN_SIDES;
    while (n < FL_WATERPLANE_MAX_SIDES && size * (1.0 / cos(PI / n) - 1.0) > coarse) n *= 2;
    return n;
}

static int add_hole(fl_domain *d, const struct extent *r, double margin, double coarse, int32_t *kept,
                    fl_err *err)
{
    const int n = r->any ? count_sides(0.5 * hypot(r->x1 - r->x0, r->y1 - r->y0) + margin, coarse) : 0;
    fl_polygon_side side[FL_WATERPLANE_MAX_SIDES + 4];
    fl_vec2 v[FL_WATERPLANE_MAX_SIDES + 4];
    int32_t m = 4;
    if (!r->any) return 0;
    if (margin == 0.0 && !(r->x1 > r->x0 && r->y1 > r->y0))
        return fl_fail(err, FL_INPUT, "a part of the structure is a line in plan: a margin is needed");
    /* the four axis directions, which every polygon has, then the others */
    fl_polygon_rectangle((fl_vec2){r->x0 - margin, r->y0 - margin}, (fl_vec2){r->x1 + margin, r->y1 + margin},
                         v, side);
    for (int k = 0; k < n; k++) {
        const fl_vec2 u = direction_of(k * (FL_WATERPLANE_MAX_SIDES / n));
        if (4 * k % n == 0) continue;
        m = fl_polygon_cut(
            m, v, side, (fl_polygon_side){u.x, u.y, r->far[k * (FL_WATERPLANE_MAX_SIDES / n)] + margin, 0});
    }
    if (fl_domain_add(d, m, v, err)) return -1;
    (*kept)++;
    return 0;
}

static int32_t root_of(int32_t *up, int32_t v)
{
    while (up[v] != v) v = up[v] = up[up[v]];
    return v;
}

/* Triangles that are connected by vertices form a group, numbered by its lowest vertex. */
struct groups {
    int32_t n;
    int32_t *place; /* [nv] of a vertex */
    int32_t *first; /* [n + 1] in tri */
    int32_t *tri;   /* [nt] triangles by group */
};

static void groups_free(struct groups *g)
{
    free(g->place);
    free(g->first);
    free(g->tri);
}

static int find_groups(struct groups *g, const fl_part *p, fl_err *err)
{
    int32_t *up = fl_alloc(p->nv, sizeof *up, err);
    *g = (struct groups){.place = fl_alloc(p->nv, sizeof *g->place, err),
                         .tri = fl_alloc(p->nt, sizeof *g->tri, err)};
    if (!up || !g->place || !g->tri) goto fail;
    for (int32_t v = 0; v < p->nv; v++) up[v] = v;
    for (int32_t t = 0; t < p->nt; t++)
        for (int k = 1; k < 3; k++) {
            const int32_t a = root_of(up, p->t[t].v[0]), b = root_of(up, p->t[t].v[k]);
            up[a > b ? a : b] = a < b ? a : b;
        }
    for (int32_t v = 0; v < p->nv; v++) {
        const int32_t root = root_of(up, v);
        g->place[v] = root == v ? g->n++ : g->place[root];
    }
    g->first = fl_alloc((int64_t)g->n + 2, sizeof *g->first, err);
    if (!g->first) goto fail;
    for (int32_t t = 0; t < p->nt; t++) g->first[g->place[p->t[t].v[0]] + 2]++;
    for (int32_t k = 0; k < g->n; k++) g->first[k + 2] += g->first[k + 1];
    for (int32_t t = 0; t < p->nt; t++) g->tri[g->first[g->place[p->t[t].v[0]] + 1]++] = t;
    free(up);
    return 0;
fail:
    free(up);
    groups_free(g);
    return -1;
}

static int add_group_hole(fl_domain *d, const fl_part *p, int32_t n, const int32_t *tri, double z0, double z1,
                          double margin, double coarse, int32_t *kept, fl_err *err)
{
    struct extent r;
    int made;
    if (fl_plan_outline_add(d, p, n, tri, z0, z1, margin, coarse, &made, err)) return -1;
    *kept += made;
    if (made) return 0;
    start_extent(&r);
    for (int32_t t = 0; t < n; t++)
        for (int k = 0; k < 3; k++)
            add_edge(&r, p->v[p->t[tri[t]].v[k]], p->v[p->t[tri[t]].v[(k + 1) % 3]], z0, z1);
    return add_hole(d, &r, margin, coarse, kept, err);
}

static int add_part_holes(fl_domain *d, const fl_part *p, double z0, double z1, double margin, double coarse,
                          int32_t *kept, fl_err *err)
{
    struct groups g;
    struct extent r;
    int rc = 0;
    if (find_groups(&g, p, err)) return -1;
    for (int32_t k = 0; k < g.n && rc == 0; k++)
        rc = add_group_hole(d, p, g.first[k + 1] - g.first[k], g.tri + g.first[k], z0, z1, margin, coarse,
                            kept, err);
    groups_free(&g);
    for (int32_t k = 0; k < p->nc && rc == 0; k++) {
        start_extent(&r);
        add_cone(&r, &p->cone[k], z0, z1);
        rc = add_hole(d, &r, margin, coarse, kept, err);
    }
    return rc;
}

int fl_waterplane_keep_out(fl_domain *d, const fl_surface *s, double z0, double z1, double margin,
                           double coarse, int32_t *kept, fl_err *err)
{
    *kept = 0;
    for (int32_t k = 0; k < s->n; k++)
        if (add_part_holes(d, &s->part[k], z0, z1, margin, coarse, kept, err)) return -1;
    return 0;
}
