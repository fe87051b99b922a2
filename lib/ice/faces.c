/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/array.h"
#include "base/parallel.h"
#include "broad/bvh.h"
#include "ice/faces.h"

/* Rounding of corners of a field far from the origin, over the distance: some hundred ulps. */
#define FAR 1e-14

struct polygon {
    int32_t n;
    const fl_vec2 *v;
};

static struct polygon outer_of(const fl_floes *a, int32_t i)
{
    return (struct polygon){a->first[i + 1] - a->first[i], a->outer + a->first[i]};
}

static fl_vec2 next_corner(struct polygon p, int32_t k) { return p.v[k + 1 < p.n ? k + 1 : 0]; }

/* The line through two corners, with its outward normal. */
static fl_polygon_side line_of(fl_vec2 p, fl_vec2 q)
{
    const double s = 1.0 / hypot(q.x - p.x, q.y - p.y), nx = s * (q.y - p.y), ny = -s * (q.x - p.x);
    return (fl_polygon_side){nx, ny, nx * p.x + ny * p.y, 0};
}

/* Overlap by the sides of a: the least depth of b behind a side of a. */
static double overlap_behind_sides(struct polygon a, struct polygon b)
{
    double most = -INFINITY;
    for (int32_t k = 0; k < a.n; k++) {
        const fl_polygon_side s = line_of(a.v[k], next_corner(a, k));
        double least = INFINITY;
        for (int32_t j = 0; j < b.n; j++) least = fmin(least, fl_polygon_side_distance(s, b.v[j]));
        most = fmax(most, least);
    }
    return -most;
}

/* The common part of the sides p q and r s, from p to q, on the line of the longer side, whose direction
 * is more accurate.  Returns its length, 0 if there is none. */
static double common_part(fl_vec2 p, fl_vec2 q, fl_vec2 r, fl_vec2 s, double within, fl_vec2 *from,
                          fl_vec2 *to)
{
    const double pq = hypot(q.x - p.x, q.y - p.y), rs = hypot(s.x - r.x, s.y - r.y);
    const fl_vec2 o = pq >= rs ? p : s, e = pq >= rs ? q : r, b = pq >= rs ? s : p, c = pq >= rs ? r : q;
    const double l = fmax(pq, rs), ux = (e.x - o.x) / l, uy = (e.y - o.y) / l;
    const double t0 = ux * (b.x - o.x) + uy * (b.y - o.y), t1 = ux * (c.x - o.x) + uy * (c.y - o.y);
    const double lo = fmax(t0, 0.0), hi = fmin(t1, l);
    if (fabs(uy * (b.x - o.x) - ux * (b.y - o.y)) > within) return 0.0;
    if (fabs(uy * (c.x - o.x) - ux * (c.y - o.y)) > within) return 0.0;
    if (!(hi - lo > within)) return 0.0;
    *from = (fl_vec2){o.x + lo * ux, o.y + lo * uy};
    *to = (fl_vec2){o.x + hi * ux, o.y + hi * uy};
    return hi - lo;
}

/* The common side of two polygons: convex polygons without overlap have at most one; rounding may split
 * it. */
static double face_of(struct polygon a, struct polygon b, double within, fl_face *out)
{
    double best = 0.0;
    for (int32_t k = 0; k < a.n; k++)
        for (int32_t m = 0; m < b.n; m++) {
            fl_vec2 from = {0}, to = {0};
            const double l =
                common_part(a.v[k], next_corner(a, k), b.v[m], next_corner(b, m), within, &from, &to);
            if (l <= best) continue;
            best = l;
            out->a = from;
            out->b = to;
        }
    return best;
}

static int add_face(fl_faces *f, int32_t *cap, fl_face face, fl_err *err)
{
    if (fl_grow(&f->face, cap, (int64_t)f->n + 1, sizeof *f->face, err)) return -1;
    f->face[f->n++] = face;
    return 0;
}

static int by_number(const void *a, const void *b)
{
    const int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    return (p > q) - (p < q);
}

static int find_pairs(fl_faces *f, const fl_floes *a, const fl_bvh *tree, const fl_aabb *box, double within,
                      fl_err *err)
{
    int32_t *near = NULL, near_cap = 0, cap = 0, got;
    int rc = -1;
    for (int32_t i = 0; i < a->n; i++) {
        const fl_aabb q = aabb_grow(box[i], within);
        while ((got = fl_bvh_query(tree, box, q, near, near_cap)) > near_cap)
            if (fl_grow(&near, &near_cap, got, sizeof *near, err)) goto done;
        qsort(near, (size_t)got, sizeof *near, by_number);
        for (int32_t k = 0; k < got; k++) {
            const struct polygon p = outer_of(a, i), r = outer_of(a, near[k]);
            fl_face face = {.i = i, .j = near[k]};
            double deep;
            if (near[k] <= i) continue;
            deep = fmin(overlap_behind_sides(p, r), overlap_behind_sides(r, p));
            if (deep > f->max_overlap) {
                f->max_overlap = deep;
                f->max_overlap_pair[0] = i;
                f->max_overlap_pair[1] = near[k];
            }
            if (deep >= -within && face_of(p, r, within, &face) > 0.0 && add_face(f, &cap, face, err))
                goto done;
        }
    }
    rc = 0;
done:
    free(near);
    return rc;
}

int fl_faces_find(fl_faces *out, const fl_floes *a, fl_err *err)
{
    fl_faces f = {.max_overlap_pair = {-1, -1}};
    fl_aabb *box = fl_alloc(a->n, sizeof *box, err), all = aabb_empty();
    double *length = NULL, *outline = fl_alloc(a->n, sizeof *outline, err), size, far;
    fl_bvh tree = {0};
    int rc = -1;
    if (!box || !outline) goto done;
    for (int32_t i = 0; i < a->n; i++) {
        const struct polygon p = outer_of(a, i);
        box[i] = aabb_empty();
        for (int32_t k = 0; k < p.n; k++) box[i] = aabb_add(box[i], v3(p.v[k].x, p.v[k].y, 0.0));
        all = aabb_join(all, box[i]);
        outline[i] = fl_polygon_perimeter(p.n, p.v);
    }
    size = fmax(all.hi.x - all.lo.x, all.hi.y - all.lo.y);
    far = fmax(fmax(fabs(all.lo.x), fabs(all.hi.x)), fmax(fabs(all.lo.y), fabs(all.hi.y)));
    f.tolerance = FL_FACES_TOL * size + FAR * far;
    if (fl_bvh_build(&tree, box, a->n, err) || find_pairs(&f, a, &tree, box, f.tolerance, err)) goto done;
    length = fl_alloc(f.n, sizeof *length, err);
    if (!length) goto done;
    for (int32_t k = 0; k < f.n; k++)
        length[k] = hypot(f.face[k].b.x - f.face[k].a.x, f.face[k].b.y - f.face[k].a.y);
    f.total_length = fl_parallel_sum(length, f.n);
    f.perimeter = fl_parallel_sum(outline, a->n);
    *out = f;
    f = (fl_faces){0};
    rc = 0;
done:
    fl_bvh_free(&tree);
    fl_faces_free(&f);
    free(length);
    free(outline);
    free(box);
    return rc;
}

void fl_faces_free(fl_faces *a)
{
    free(a->face);
    *a = (fl_faces){0};
}
