/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "structure/coplanar_regions.h"
#include <math.h>
#include "base/array.h"

/* Largest distance of a vertex from the plane of its region, relative to the diagonal of the part:
 * coordinates that went through 32-bit floats, as in STL, are rounded by 6e-8 of the largest of them. */
#define PLANE_TOL 1e-6
/* Angle between normals above which two triangles are not one plane, whatever their size [rad]. */
#define MAX_BEND 1e-3

static int compare_sides(const void *x, const void *y)
{
    const fl_region_side *p = x, *q = y;
    if (p->a != q->a) return p->a < q->a ? -1 : 1;
    if (p->b != q->b) return p->b < q->b ? -1 : 1;
    return (p->t > q->t) - (p->t < q->t);
}

static int corner_of(const fl_tri *t, int32_t v) { return t->v[0] == v ? 0 : t->v[1] == v ? 1 : 2; }

int fl_region_side_of(const fl_tri *t, int32_t a, int32_t b)
{
    const int k = corner_of(t, a);
    return t->v[(k + 1) % 3] == b ? k : corner_of(t, b);
}

/* True if both have an area, and are not one triangle twice. */
static int is_misoriented(const fl_coplanar_regions *f, int32_t t, int kt, int32_t u, int ku)
{
    return v3_norm2(f->normal[t]) > 0.0 && v3_norm2(f->normal[u]) > 0.0 &&
           f->p->t[t].v[(kt + 2) % 3] != f->p->t[u].v[(ku + 2) % 3];
}

/* Of three or more triangles at an edge, side[k .. end), finds the two that continue most nearly in one
 * plane, if any: a plate with a stiffener behind it has no rim there. */
static int find_smoothest(const fl_coplanar_regions *f, int32_t k, int32_t end, int32_t *one, int32_t *two)
{
    double best = 1.0 - 0.5 * MAX_BEND * MAX_BEND;
    const double least = best;
    for (int32_t i = k; i < end; i++) {
        for (int32_t j = i + 1; j < end; j++) {
            const fl_tri *t = &f->p->t[f->side[i].t], *u = &f->p->t[f->side[j].t];
            if (t->v[fl_region_side_of(t, f->side[k].a, f->side[k].b)] ==
                u->v[fl_region_side_of(u, f->side[k].a, f->side[k].b)])
                continue;
            const double c = v3_dot(f->normal[f->side[i].t], f->normal[f->side[j].t]);
            if (c > best) best = c, *one = i, *two = j;
        }
    }
    return best > least;
}

static void join_sides(fl_coplanar_regions *f)
{
    const fl_part *p = f->p;
    const int32_t ns = 3 * p->nt;
    for (int32_t t = 0; t < p->nt; t++) {
        for (int k = 0; k < 3; k++) {
            const int32_t a = p->t[t].v[k], b = p->t[t].v[(k + 1) % 3];
            f->side[3 * t + k] = (fl_region_side){a < b ? a : b, a < b ? b : a, t};
            f->neighbour[3 * t + k] = -1;
        }
    }
    qsort(f->side, (size_t)ns, sizeof *f->side, compare_sides);
    f->closed = 1;
    f->misoriented[0] = f->misoriented[1] = -1;
    for (int32_t k = 0, end; k < ns; k = end) {
        for (end = k + 1; end < ns && f->side[end].a == f->side[k].a && f->side[end].b == f->side[k].b;
             end++) {}
        int32_t one = k, two = k + 1;
        if (end - k != 2) {
            f->closed = 0;
            if (!find_smoothest(f, k, end, &one, &two)) continue;
        }
        const int32_t t = f->side[one].t, u = f->side[two].t, a = f->side[k].a, b = f->side[k].b;
        const int kt = fl_region_side_of(&p->t[t], a, b), ku = fl_region_side_of(&p->t[u], a, b);
        if (p->t[t].v[kt] == p->t[u].v[ku]) { /* both run the same way: opposite orientations */
            f->closed = 0;
            if (f->misoriented[0] < 0 && is_misoriented(f, t, kt, u, ku))
                f->misoriented[0] = t, f->misoriented[1] = u;
            continue;
        }
        f->neighbour[3 * t + kt] = u;
        f->neighbour[3 * u + ku] = t;
    }
}

/* True if triangle t lies in the plane: its corners do, and its normal agrees within its accuracy, which is
 * poor for a triangle of small height. */
static int is_in_plane(const fl_coplanar_regions *f, int32_t t, fl_vec3 n, double c)
{
    const int32_t *v = f->p->t[t].v;
    const fl_vec3 *x = f->p->v;
    const fl_vec3 e = v3_sub(x[v[1]], x[v[0]]), g = v3_sub(x[v[2]], x[v[0]]), h = v3_sub(x[v[2]], x[v[1]]);
    const double longest = sqrt(fmax(v3_norm2(e), fmax(v3_norm2(g), v3_norm2(h))));
    const double bend = MAX_BEND + f->tol * longest / v3_norm(v3_cross(e, g));
    if (1.0 - v3_dot(f->normal[t], n) > 0.5 * bend * bend) return 0;
    for (int k = 0; k < 3; k++)
        if (fabs(v3_dot(n, x[v[k]]) - c) > f->tol) return 0;
    return 1;
}

/* Fits the plane of the triangles queue[0 .. n). Their area vector, which depends on the rim alone, is more
 * accurate than any of their normals. The offset is midway between the lowest and the highest corner. Returns
 * half the distance of those two. */
static double fit_plane(const fl_coplanar_regions *f, int32_t n, fl_vec3 *normal, double *offset)
{
    const fl_part *p = f->p;
    const fl_vec3 origin = p->v[p->t[f->queue[0]].v[0]];
    fl_vec3 sum = {0};
    double low = INFINITY, high = -INFINITY;
    for (int32_t k = 0; k < n; k++) {
        const int32_t *v = p->t[f->queue[k]].v;
        sum = v3_add(sum, v3_cross(v3_sub(p->v[v[1]], p->v[v[0]]), v3_sub(p->v[v[2]], p->v[v[0]])));
    }
    if (v3_norm(sum) > 0.0) *normal = v3_unit(sum);
    for (int32_t k = 0; k < 3 * n; k++) {
        const double h = v3_dot(*normal, v3_sub(p->v[p->t[f->queue[k / 3]].v[k % 3]], origin));
        low = h < low ? h : low;
        high = h > high ? h : high;
    }
    *offset = v3_dot(*normal, origin) + 0.5 * (low + high);
    return 0.5 * (high - low);
}

/* Floods region f->regions from a triangle; its triangles are queue[0 .. returned).
 *   follow  refit the plane whenever the region has doubled: the plane of a small triangle, with rounded
 *           corners, misses a wide wall by more than the tolerance */
static int32_t flood_region(fl_coplanar_regions *f, int32_t seed, int follow)
{
    fl_vec3 n = f->normal[seed];
    double c = v3_dot(n, f->p->v[f->p->t[seed].v[0]]);
    int32_t tail = 0, next = 2;
    f->region[seed] = f->regions;
    f->queue[tail++] = seed;
    for (int32_t head = 0; head < tail; head++) {
        for (int k = 0; k < 3; k++) {
            const int32_t u = f->neighbour[3 * f->queue[head] + k];
            if (u < 0 || f->region[u] >= 0 || !is_in_plane(f, u, n, c)) continue;
            f->region[u] = f->regions;
            f->queue[tail++] = u;
        }
        if (follow && tail >= next) {
            fit_plane(f, tail, &n, &c);
            next = 2 * tail;
        }
    }
    return tail;
}

/* Grows the region of a triangle and fits its plane. A plane that follows may creep round a gentle curve
 * until its first triangles no longer lie in it; then the plane of the seed decides. */
static void grow_region(fl_coplanar_regions *f, int32_t seed)
{
    fl_vec3 n = f->normal[seed];
    double c;
    int32_t taken = flood_region(f, seed, 1);
    if (fit_plane(f, taken, &n, &c) > f->tol) {
        for (int32_t k = 0; k < taken; k++) f->region[f->queue[k]] = -1;
        taken = flood_region(f, seed, 0);
        fit_plane(f, taken, &n, &c);
    }
    f->region_normal[f->regions] = n;
    f->region_offset[f->regions++] = c;
}

typedef struct {
    double area;
    int32_t t;
} sized_triangle;

static int compare_area(const void *x, const void *y)
{
    const sized_triangle *p = x, *q = y;
    if (p->area != q->area) return p->area > q->area ? -1 : 1;
    return (p->t > q->t) - (p->t < q->t);
}

/* The largest triangles come first: their normals are the most accurate. */
int fl_coplanar_regions_find(fl_coplanar_regions *f, const fl_part *p, fl_err *err)
{
    const fl_aabb box = fl_part_aabb(p);
    sized_triangle *order = fl_alloc(p->nt, sizeof *order, err);
    f->p = p;
    f->tol = PLANE_TOL * v3_norm(v3_sub(box.hi, box.lo));
    f->normal = fl_alloc(p->nt, sizeof *f->normal, err);
    f->side = fl_alloc(3 * (int64_t)p->nt, sizeof *f->side, err);
    f->neighbour = fl_alloc(3 * (int64_t)p->nt, sizeof *f->neighbour, err);
    f->region = fl_alloc(p->nt, sizeof *f->region, err);
    f->region_normal = fl_alloc(p->nt, sizeof *f->region_normal, err);
    f->region_offset = fl_alloc(p->nt, sizeof *f->region_offset, err);
    f->area = fl_alloc(p->nt, sizeof *f->area, err);
    f->queue = fl_alloc(p->nt, sizeof *f->queue, err);
    if (!order || !f->normal || !f->side || !f->neighbour || !f->region || !f->region_normal ||
        !f->region_offset || !f->area || !f->queue) {
        free(order);
        return -1;
    }
    for (int32_t t = 0; t < p->nt; t++) {
        const fl_vec3 a = p->v[p->t[t].v[0]], b = p->v[p->t[t].v[1]], c = p->v[p->t[t].v[2]];
        const fl_vec3 n = v3_cross(v3_sub(b, a), v3_sub(c, a));
        order[t] = (sized_triangle){v3_norm(n), t};
        f->normal[t] = v3_unit(n);
        f->region[t] = -1;
    }
    qsort(order, (size_t)p->nt, sizeof *order, compare_area);
    if (order[0].area == 0.0) {
        free(order);
        return fl_fail(err, FL_INPUT, "part %s: its triangles have no area", p->name);
    }
    join_sides(f);
    for (int32_t o = 0; o < p->nt; o++) {
        const int32_t seed = order[o].t;
        if (f->region[seed] < 0 && order[o].area > 0.0) grow_region(f, seed);
    }
    free(order);
    return 0;
}

void fl_coplanar_regions_free(fl_coplanar_regions *f)
{
    free(f->normal), free(f->side), free(f->neighbour), free(f->region), free(f->region_normal),
        free(f->region_offset), free(f->area);
    free(f->queue);
    *f = (fl_coplanar_regions){0};
}
