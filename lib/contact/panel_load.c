/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <omp.h>
#include <stdio.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "contact/panel_load.h"
#include "law/normal.h"
#include "narrow/closest_point.h"

/* --- panels ------------------------------------------------------------------------------------ */

/* Area of a cone: its side and its ends. */
static double cone_area(const fl_cone *c)
{
    const double h = v3_norm(v3_sub(c->p1, c->p0)), slant = sqrt(h * h + (c->r0 - c->r1) * (c->r0 - c->r1));
    return PI * ((c->r0 + c->r1) * slant + c->r0 * c->r0 + c->r1 * c->r1);
}

static fl_load_triangle triangle_of(const fl_part *p, int32_t t, int32_t panel)
{
    const int32_t *at = p->t[t].v;
    const fl_vec3 a = p->v[at[0]], b = p->v[at[1]], c = p->v[at[2]];
    return (fl_load_triangle){{a, b, c}, 0.5 * v3_norm(v3_cross(v3_sub(b, a), v3_sub(c, a))), panel};
}

static int make_panels(fl_panel_loads *s, const fl_surface *surface, fl_err *err)
{
    int64_t n = 0;
    for (int32_t p = 0; p < surface->n; p++) n += surface->part[p].nt + surface->part[p].nc;
    if (n > INT32_MAX) return fl_fail(err, FL_SYSTEM, "%.0f panels are too many", (double)n);
    s->panel = fl_alloc(n, sizeof *s->panel, err);
    s->first = fl_alloc((int64_t)surface->n + 1, sizeof *s->first, err);
    if (!s->panel || !s->first) return -1;
    for (int32_t p = 0; p < surface->n; p++) {
        const fl_part *part = &surface->part[p];
        for (int32_t t = 0; t < part->nt; t++) {
            const fl_load_triangle q = triangle_of(part, t, s->all);
            s->panel[s->all++] =
                (fl_load_panel){v3_scale(1.0 / 3.0, v3_add(q.v[0], v3_add(q.v[1], q.v[2]))), q.area, p};
        }
        for (int32_t c = 0; c < part->nc; c++) {
            const fl_cone *cone = &part->cone[c];
            s->panel[s->all++] =
                (fl_load_panel){v3_scale(0.5, v3_add(cone->p0, cone->p1)), cone_area(cone), p};
        }
        s->first[p + 1] = s->all;
    }
    return 0;
}

static int add_triangle(fl_panel_loads *s, int32_t *n, int32_t *cap, fl_load_triangle t, fl_err *err)
{
    int32_t boxes = *cap;
    if (fl_grow(&s->box, &boxes, (int64_t)*n + 1, sizeof *s->box, err) ||
        fl_grow(&s->triangle, cap, (int64_t)*n + 1, sizeof *s->triangle, err))
        return -1;
    s->triangle[*n] = t;
    s->box[*n] = aabb_empty();
    for (int c = 0; c < 3; c++) s->box[*n] = aabb_add(s->box[*n], t.v[c]);
    ++*n;
    return 0;
}

/* The facets of a cone, for a piece that it is joined in. */
static int add_facets(fl_panel_loads *s, int32_t *n, int32_t *cap, const fl_cone *cone, int32_t panel,
                      fl_err *err)
{
    fl_piece frustum = {.q = q_one()};
    int rc = fl_cone_piece(&frustum, cone, err);
    const fl_poly *p = &frustum.core;
    for (int32_t f = 0; rc == 0 && f < p->nf; f++) {
        const int32_t *loop = p->loop + p->first[f], m = p->first[f + 1] - p->first[f];
        for (int32_t c = 2; rc == 0 && c < m; c++) {
            fl_load_triangle t = {.panel = panel};
            const int32_t at[3] = {loop[0], loop[c - 1], loop[c]};
            for (int k = 0; k < 3; k++) t.v[k] = v3_add(frustum.x, q_rotate(frustum.q, p->v[at[k]]));
            t.area = 0.5 * v3_norm(v3_cross(v3_sub(t.v[1], t.v[0]), v3_sub(t.v[2], t.v[0])));
            rc = add_triangle(s, n, cap, t, err);
        }
    }
    fl_piece_free(&frustum);
    return rc;
}

/* The triangles of a piece. */
static int add_piece_triangles(fl_panel_loads *s, const fl_surface *surface, const fl_piece *piece,
                               int32_t *n, int32_t *cap, fl_err *err)
{
    const fl_piece_member own = {piece->part, piece->cone}, *member = piece->members ? piece->member : &own;
    for (int32_t m = 0; m < (piece->members ? piece->members : 1); m++) {
        const fl_part *part = &surface->part[member[m].part];
        const int32_t first = s->first[member[m].part], cone = member[m].cone;
        if (cone >= 0 && add_facets(s, n, cap, &part->cone[cone], first + part->nt + cone, err)) return -1;
        for (int32_t t = 0; cone < 0 && t < part->nt; t++)
            if (add_triangle(s, n, cap, triangle_of(part, t, first + t), err)) return -1;
    }
    return 0;
}

int fl_panels_make(fl_world *w, const fl_surface *surface, fl_err *err)
{
    fl_panel_loads *s = &w->panel_load;
    const fl_scene_output *o = &w->scene->output;
    int32_t n = 0, cap = 0;
    for (int32_t k = 0; k < w->structure.n; k++) s->shared |= w->structure.piece[k].several_parts;
    if (!surface || (!o->panels[0] && !o->events[0] && !s->shared)) return 0;
    if (make_panels(s, surface, err)) return -1;
    s->panels = o->panels[0] || o->events[0] ? s->all : 0;
    s->pieces = w->structure.n, s->threads = w->threads;
    s->impulse = fl_alloc(s->panels, sizeof *s->impulse, err);
    s->first_triangle = fl_alloc((int64_t)s->pieces + 1, sizeof *s->first_triangle, err);
    s->tree = fl_alloc(s->pieces, sizeof *s->tree, err);
    s->cone = fl_alloc(s->pieces, sizeof *s->cone, err);
    s->by_thread = fl_alloc(w->threads, sizeof *s->by_thread, err);
    if (err->code) return -1;
    for (int32_t k = 0; k < s->pieces; k++) {
        const fl_piece *piece = &w->structure.piece[k];
        s->first_triangle[k] = s->first_triangle[k + 1] = n;
        s->cone[k] =
            piece->cone < 0 ? -1 : s->first[piece->part] + surface->part[piece->part].nt + piece->cone;
        if (piece->kind == FL_PIECE_PLANE || piece->cone >= 0 || !(s->panels || piece->several_parts))
            continue;
        if (add_piece_triangles(s, surface, piece, &n, &cap, err) ||
            fl_bvh_build(&s->tree[k], s->box + s->first_triangle[k], n - s->first_triangle[k], err))
            return -1;
        s->first_triangle[k + 1] = n;
    }
    return 0;
}

void fl_panels_free(fl_panel_loads *s)
{
    for (int32_t t = 0; s->by_thread && t < s->threads; t++)
        free(s->by_thread[t].point), free(s->by_thread[t].list), free(s->by_thread[t].share);
    for (int32_t p = 0; s->tree && p < s->pieces; p++) fl_bvh_free(&s->tree[p]);
    free(s->panel), free(s->box), free(s->impulse), free(s->first), free(s->tree), free(s->by_thread);
    free(s->triangle), free(s->first_triangle), free(s->share);
    free(s->cone), free(s->point), free(s->event);
    *s = (fl_panel_loads){0};
}

/* Squared distance of x from a triangle (Ericson 2005, 5.1.5: by the regions of its corners and sides). */
static double triangle_distance2(const fl_vec3 v[3], fl_vec3 x)
{
    const fl_vec3 ab = v3_sub(v[1], v[0]), ac = v3_sub(v[2], v[0]), n = v3_cross(ab, ac);
    double best = INFINITY;
    int inside = v3_norm2(n) > 0.0;
    for (int k = 0; k < 3; k++) {
        const fl_vec3 a = v[k], e = v3_sub(v[(k + 1) % 3], a), ax = v3_sub(x, a);
        const double length2 = v3_norm2(e);
        double t = length2 > 0.0 ? v3_dot(ax, e) / length2 : 0.0;
        t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
        const double d2 = v3_norm2(v3_madd(ax, -t, e));
        if (d2 < best) best = d2;
        if (v3_dot(v3_cross(e, ax), n) < 0.0) inside = 0;
    }
    if (inside) {
        const double h = v3_dot(v3_sub(x, v[0]), n);
        best = h * h / v3_norm2(n);
    }
    return best;
}

/* Lists the triangles of piece k in the box, from its first one on.  -1 when memory runs out. */
static int32_t query_triangles(fl_panel_points *points, const fl_panel_loads *s, int32_t k, fl_aabb box)
{
    const fl_aabb *boxes = s->box + s->first_triangle[k];
    const int32_t n = fl_bvh_query(&s->tree[k], boxes, box, points->list, points->list_cap);
    if (n <= points->list_cap) return n;
    if (fl_reserve(&points->list, &points->list_cap, n, sizeof *points->list)) return -1;
    return fl_bvh_query(&s->tree[k], boxes, box, points->list, points->list_cap);
}

/* The panel of piece k that is nearest to x, in the pose of the file; the first of several.  reach: first
 * radius of the search [m].  -1 when memory runs out. */
static int32_t find_nearest_panel(fl_panel_points *points, const fl_panel_loads *s, int32_t k, fl_vec3 x,
                                  double reach)
{
    const int32_t first = s->first_triangle[k];
    for (;; reach *= 4.0) {
        const int32_t n = query_triangles(points, s, k, aabb_grow((fl_aabb){x, x}, reach));
        int32_t best = -1;
        if (n < 0) return -1;
        double least = INFINITY;
        for (int32_t c = 0; c < n; c++) {
            const int32_t t = points->list[c];
            if (!(s->triangle[first + t].area > 0.0)) continue; /* degenerate: it has no row in the table */
            const double d2 = triangle_distance2(s->triangle[first + t].v, x);
            if (d2 < least || (d2 == least && t < best)) least = d2, best = t;
        }
        if (best >= 0 && (least <= reach * reach || n == s->tree[k].n))
            return s->triangle[first + best].panel;
        if (!(reach < 1e30)) return s->triangle[first].panel;
    }
}

/* --- points of the threads --------------------------------------------------------------------- */

static fl_panel_point *append_point(fl_world *w, const fl_pair *p, fl_panel_points *points)
{
    if (fl_reserve(&points->point, &points->point_cap, (int64_t)points->n + 1, sizeof *points->point)) {
#pragma omp atomic write
        w->failed = 1;
        return NULL;
    }
    fl_panel_point *m = &points->point[points->n++];
    *m = (fl_panel_point){.pair = p->index, .i = p->i};
    return m;
}

/* The panel at a point of the piece; -1 when memory runs out. */
static int32_t panel_of_point(fl_world *w, const fl_pair *p, fl_panel_points *points, fl_vec3 at)
{
    const int32_t k = p->j - w->n;
    const fl_piece *piece = &w->structure.piece[k];
    const double reach = 2.0 * (p->overlap + w->b.radius[p->i]) + 1e-9 * piece->core.size;
    if (w->panel_load.cone[k] >= 0) return w->panel_load.cone[k];
    return find_nearest_panel(points, &w->panel_load, k, v3_add(piece->x, q_rotate(piece->q, at)), reach);
}

/* Appends a point at `at` with the normal n, both in the frame of the piece. */
static fl_panel_point *record_point(fl_world *w, const fl_pair *p, fl_panel_points *points, int32_t panel,
                                    fl_vec3 at, fl_vec3 n)
{
    fl_panel_point *m = append_point(w, p, points);
    if (!m) return NULL;
    if (panel < 0) {
#pragma omp atomic write
        w->failed = 1;
        panel = 0;
    }
    m->panel = panel;
    m->part = w->panel_load.panel[panel].part;
    const fl_mat3 R = fl_body_axes(&w->b, p->j);
    m->point = v3_add(w->b.x[p->j], m3_mul(R, at));
    m->n = m3_mul(R, n);
    m->overlap = p->overlap;
    return m;
}

/* Distributes the force of the pair without its normal forces over its points, in proportion to these. */
static void distribute_rest(const fl_pair *p, fl_panel_point *m, int32_t n)
{
    fl_vec3 rest = p->force;
    double sum = 0.0;
    for (int32_t k = 0; k < n; k++) {
        rest = v3_madd(rest, -m[k].normal_force, m[k].n);
        sum += m[k].normal_force;
    }
    for (int32_t k = 0; k < n; k++) {
        const double share = sum > 0.0 ? m[k].normal_force / sum : 1.0 / n;
        m[k].force = v3_madd(v3_scale(m[k].normal_force, m[k].n), share, rest);
    }
}

/* A pressure: n points that stand for a strip (2) or an area (3), patch_points.h. */
typedef struct {
    int32_t n;
    fl_vec3 middle, e1, e2; /* the points are at middle +- e1, or at middle + e1 cos a + e2 sin a */
    fl_vec3 across;         /* unit normal */
    double normal, area;    /* force of the n points [N]; area of the whole contact [m2] */
} pressure;

/* Least cosine of a triangle's normal and that of the contact: others bear no load of it, nor do distant
 * ones. */
#define MIN_FACING 0.5

/* Width of a strip over its length, so that it covers an area of triangles. */
#define STRIP_WIDTH 0.01

/* A corner of a triangle, in the coordinates of the strip or area. */
typedef struct {
    double u, v;
} point2;

/* Clips the polygon p[n] to side * coordinate <= far; returns the number of corners. */
static int32_t clip_polygon(point2 *p, int32_t n, int axis, double side, double far)
{
    point2 kept[8];
    int32_t m = 0;
    for (int32_t k = 0; k < n; k++) {
        const point2 a = p[k], b = p[(k + 1) % n];
        const double ha = far - side * (axis ? a.v : a.u), hb = far - side * (axis ? b.v : b.u);
        if (ha >= 0.0) kept[m++] = a;
        if ((ha < 0.0) != (hb < 0.0)) {
            const double t = ha / (ha - hb);
            kept[m++] = (point2){a.u + t * (b.u - a.u), a.v + t * (b.v - a.v)};
        }
    }
    memcpy(p, kept, (size_t)m * sizeof *p);
    return m;
}

/* Area of the triangle within |u|, |v| <= far, and its centroid. */
static double clipped_area(const point2 t[3], double far, point2 *middle)
{
    point2 p[8] = {t[0], t[1], t[2]};
    int32_t n = 3;
    double twice = 0.0;
    *middle = (point2){0};
    for (int c = 0; c < 4 && n > 2; c++) n = clip_polygon(p, n, c / 2, c % 2 ? 1.0 : -1.0, far);
    for (int32_t k = 2; k < n; k++) {
        const double a =
            (p[k - 1].u - p[0].u) * (p[k].v - p[0].v) - (p[k - 1].v - p[0].v) * (p[k].u - p[0].u);
        twice += a;
        middle->u += a * (p[0].u + p[k - 1].u + p[k].u) / 3.0;
        middle->v += a * (p[0].v + p[k - 1].v + p[k].v) / 3.0;
    }
    if (twice == 0.0) return 0.0;
    middle->u /= twice, middle->v /= twice;
    return 0.5 * fabs(twice);
}

/* Records a pressure at one panel. */
static void record_at_panel(fl_world *w, const fl_pair *p, fl_panel_points *points, const pressure *q)
{
    fl_panel_point *m =
        record_point(w, p, points, panel_of_point(w, p, points, q->middle), q->middle, q->across);
    if (!m) return;
    m->normal_force = q->normal;
    m->area = q->area;
}

/* Records a pressure over the triangles under it.  An even pressure with the mean and the second moments of
 * the points extends by sqrt(3) e1 to both ends of a strip, and by sqrt(3/2) (e1, e2) for a parallelogram.
 * Each triangle gets its share of the area. */
static void record_spread(fl_world *w, const fl_pair *p, fl_panel_points *points, const pressure *q)
{
    const fl_panel_loads *s = &w->panel_load;
    const fl_piece *piece = &w->structure.piece[p->j - w->n];
    const double far = q->n == 2 ? 1.7320508075688772 : 1.2247448713915890;
    const double near = 2.0 * (p->overlap + w->b.radius[p->i]) + 1e-9 * piece->core.size;
    const int32_t k = p->j - w->n, first = s->first_triangle[k], from = points->n;
    const fl_vec3 m = v3_add(piece->x, q_rotate(piece->q, q->middle)), n = q_rotate(piece->q, q->across);
    fl_vec3 e1 = q_rotate(piece->q, q->e1), e2 = q_rotate(piece->q, q->e2);
    if (q->n == 2) e2 = v3_scale(STRIP_WIDTH, v3_cross(n, e1));
    /* u = r1.(x - m), v = r2.(x - m) in the plane of e1 and e2 */
    const fl_vec3 c = v3_cross(e1, e2), r1 = v3_scale(1.0 / v3_norm2(c), v3_cross(e2, c)),
                  r2 = v3_scale(1.0 / v3_norm2(c), v3_cross(c, e1));
    const int plate = piece->core.nf == 2 || piece->mesh.thin; /* has two sides */
    fl_aabb box = aabb_empty();
    double all = 0.0;
    if (s->cone[k] >= 0 || q->n == 1 || !(v3_norm2(c) > 0.0)) {
        record_at_panel(w, p, points, q);
        return;
    }
    for (int corner = 0; corner < 4; corner++)
        box = aabb_add(box, v3_madd(v3_madd(m, corner & 1 ? far : -far, e1), corner & 2 ? far : -far, e2));
    const int32_t found = query_triangles(points, s, k, aabb_grow(box, near));
    if (found < 0) {
#pragma omp atomic write
        w->failed = 1;
        return;
    }
    for (int32_t h = 0; h < found; h++) {
        const fl_load_triangle *t = &s->triangle[first + points->list[h]];
        const fl_vec3 a = v3_sub(t->v[0], m), b = v3_sub(t->v[1], m), d = v3_sub(t->v[2], m);
        const fl_vec3 normal = v3_unit(v3_cross(v3_sub(b, a), v3_sub(d, a)));
        const double facing = plate ? fabs(v3_dot(normal, n)) : v3_dot(normal, n);
        if (!(facing > MIN_FACING) || fabs(v3_dot(normal, a)) > near) continue;
        const point2 uv[3] = {
            {v3_dot(r1, a), v3_dot(r2, a)}, {v3_dot(r1, b), v3_dot(r2, b)}, {v3_dot(r1, d), v3_dot(r2, d)}};
        point2 middle;
        const double area = clipped_area(uv, far, &middle);
        if (!(area > 0.0)) continue;
        fl_panel_point *point = record_point(
            w, p, points, t->panel, v3_madd(v3_madd(q->middle, middle.u, q->e1), middle.v, q->e2), q->across);
        if (!point) return;
        point->normal_force = area;
        all += area;
    }
    for (int32_t h = from; h < points->n; h++) {
        points->point[h].normal_force *= q->normal / all;
        points->point[h].area = q->area;
    }
    if (points->n == from) record_at_panel(w, p, points, q);
}

/* Records a pressure on a mesh by its features, from feature[from] on; returns their number. */
static int32_t record_features(fl_world *w, const fl_pair *p, fl_panel_points *points, const pressure *all,
                               const fl_patch_points *s, int32_t from)
{
    int32_t n = 0;
    double force = 0.0;
    for (; from + n < s->features && s->feature[from + n].first_point == s->feature[from].first_point; n++)
        force += s->feature[from + n].force;
    for (int32_t k = from; k < from + n; k++) {
        const fl_patch_feature *share = &s->feature[k];
        pressure one = *all;
        one.n = share->n, one.middle = share->p, one.e1 = share->e1, one.e2 = share->e2;
        one.normal *= share->force / force;
        record_spread(w, p, points, &one);
    }
    return n;
}

/* --- shares of parts ----------------------------------------------------------------------------- */

static fl_load_share *share_of(fl_world *w, const fl_pair *p, fl_panel_points *points, int32_t from,
                               int32_t part)
{
    for (int32_t k = from; k < points->shares; k++)
        if (points->share[k].part == part) return &points->share[k];
    if (fl_reserve(&points->share, &points->share_cap, (int64_t)points->shares + 1, sizeof *points->share)) {
#pragma omp atomic write
        w->failed = 1;
        return NULL;
    }
    fl_load_share *new = &points->share[points->shares++];
    *new = (fl_load_share){.pair = p->index, .i = p->i, .j = p->j, .part = part};
    return new;
}

/* Splits the load of pair p between the parts of its points, from point[from] on.  The moment that the points
 * leave over, of rolling or of the turn of faces, goes by the normal forces. */
static void split_load(fl_world *w, const fl_pair *p, fl_panel_points *points, int32_t from)
{
    const int32_t first = points->shares;
    fl_vec3 rest = v3_neg(p->torque_j);
    double sum = 0.0;
    for (int32_t k = from; k < points->n; k++) {
        const fl_panel_point *m = &points->point[k];
        fl_load_share *to = share_of(w, p, points, first, m->part);
        if (!to) return;
        const fl_vec3 moment = v3_cross(v3_sub(m->point, w->b.x[p->j]), m->force);
        to->force = v3_sub(to->force, m->force);
        to->torque = v3_sub(to->torque, moment);
        rest = v3_sub(rest, moment);
        sum += m->normal_force;
    }
    for (int32_t k = from; k < points->n; k++) {
        const fl_panel_point *m = &points->point[k];
        fl_load_share *to = share_of(w, p, points, first, m->part);
        if (to)
            to->torque =
                v3_madd(to->torque, sum > 0.0 ? -m->normal_force / sum : -1.0 / (points->n - from), rest);
    }
}

/* All points of pair p are recorded, from point[from] on: splits its load if parts share it, and drops the
 * points if no table wants them. */
static void end_of_pair(fl_world *w, const fl_pair *p, fl_panel_points *points, int32_t from)
{
    if (p->load_part == FL_LOAD_SHARED) split_load(w, p, points, from);
    if (!w->panel_load.panels) points->n = from;
}

void fl_load_find_part(fl_world *w, fl_pair *p, const fl_patch_points *s)
{
    fl_panel_points *points = &w->panel_load.by_thread[omp_get_thread_num()];
    const fl_panel_loads *l = &w->panel_load;
    const int32_t k = p->j - w->n, first = l->first_triangle[k];
    const fl_piece *piece = &w->structure.piece[k];
    double overlap = 0.0;
    fl_aabb box = aabb_empty();
    for (int32_t c = 0; c < s->n; c++) {
        box = aabb_add(box, v3_add(piece->x, q_rotate(piece->q, s->point[c].p)));
        overlap = fmax(overlap, s->point[c].overlap);
    }
    for (int32_t c = 0; c < s->features; c++)
        box = aabb_add(box, v3_add(piece->x, q_rotate(piece->q, s->feature[c].p)));
    /* pressures reach farther than their points, record_spread() */
    const fl_vec3 half = v3_scale(0.5, v3_sub(box.hi, box.lo));
    box = aabb_join(box, (fl_aabb){v3_sub(box.lo, half), v3_add(box.hi, half)});
    box = aabb_grow(box, 2.0 * (overlap + w->b.radius[p->i]) + 1e-9 * piece->core.size);
    const int32_t n = query_triangles(points, l, k, box);
    p->load_part = piece->part;
    if (n < 0) {
#pragma omp atomic write
        w->failed = 1;
    } else if (n == 0) {
        p->load_part = FL_LOAD_SHARED; /* the nearest triangle decides */
    }
    for (int32_t c = 0; c < n; c++) {
        const int32_t part = l->panel[l->triangle[first + points->list[c]].panel].part;
        if (c > 0 && part != p->load_part) {
            p->load_part = FL_LOAD_SHARED;
            break;
        }
        p->load_part = part;
    }
}

int32_t fl_load_part_at(fl_world *w, int32_t j, fl_vec3 x)
{
    const fl_piece *piece = &w->structure.piece[j - w->n];
    if (!piece->several_parts) return piece->part;
    const fl_vec3 at = m3_tmul(fl_body_axes(&w->b, j), v3_sub(x, w->b.x[j]));
    const int32_t panel =
        find_nearest_panel(&w->panel_load.by_thread[0], &w->panel_load, j - w->n,
                           v3_add(piece->x, q_rotate(piece->q, at)), 1e-3 * piece->core.size);
    return panel < 0 ? piece->part : w->panel_load.panel[panel].part;
}

void fl_panels_record_points(fl_world *w, const fl_pair *p, const fl_patch_points *s, double scale,
                             double chi)
{
    fl_panel_points *points = &w->panel_load.by_thread[omp_get_thread_num()];
    const int32_t from = points->n;
    const int pair_patch = p->points == FL_POINTS_PATCH,
              mesh = w->structure.piece[p->j - w->n].kind == FL_PIECE_MESH;
    double u = 0.0, du = 0.0;
    int32_t feature = 0;
    for (int32_t k = 0; k < s->n; k++) u += s->point[k].u, du += s->point[k].du;
    for (int32_t k = 0, n; k < s->n; k += n) {
        const fl_patch_point *q = &s->point[k];
        n = 1;
        if (pair_patch ? q->u == 0.0 : q->du < 0.0) continue;
        if (q->group_size) n = q->group_size;
        pressure a = {.n = n, .across = q->unit_normal};
        for (int32_t c = 0; c < n; c++) {
            const double pull = pair_patch ? q[c].du : fl_normal_power(q->overlap, p->exponent);
            a.normal += fl_normal_damped_force(scale * pull * v3_dot(q[c].n, q[c].unit_normal), chi,
                                               q[c].approach_speed);
            a.middle = v3_madd(a.middle, 1.0 / n, q[c].p);
        }
        if (n > 1) a.e1 = v3_sub(q[0].p, a.middle);
        if (n > 2) a.e2 = v3_scale(0.57735026918962576, v3_sub(q[1].p, q[2].p));
        /* an overlap s over a face of area A has u = A s^4 and du = 4 A s^3: A = du^4/(256 u^3) */
        a.area = pair_patch ? du * du * du * du / (256.0 * u * u * u) : PI * w->b.radius[p->i] * q->overlap;
        if (mesh && feature < s->features && s->feature[feature].first_point == k)
            feature += record_features(w, p, points, &a, s, feature);
        else record_spread(w, p, points, &a);
    }
    if (points->n > from) distribute_rest(p, points->point + from, points->n - from);
    end_of_pair(w, p, points, from);
}

void fl_panels_record_point(fl_world *w, const fl_pair *p, fl_vec3 at, fl_vec3 n, double area)
{
    fl_panel_points *points = &w->panel_load.by_thread[omp_get_thread_num()];
    fl_panel_point *m = record_point(w, p, points, panel_of_point(w, p, points, at), at, n);
    if (!m) return;
    m->normal_force = v3_dot(p->force, m->n);
    m->area = area;
    m->force = p->force;
    end_of_pair(w, p, points, points->n - 1);
}

void fl_panels_clear(fl_world *w)
{
    for (int32_t t = 0; t < w->threads; t++)
        w->panel_load.by_thread[t].n = w->panel_load.by_thread[t].shares = 0;
}

static int compare_points(const void *x, const void *y)
{
    const fl_panel_point *a = x, *b = y;
    if (a->pair != b->pair) return a->pair < b->pair ? -1 : 1;
    return (a->order > b->order) - (a->order < b->order);
}

static int compare_shares(const void *x, const void *y)
{
    const fl_load_share *a = x, *b = y;
    if (a->pair != b->pair) return a->pair < b->pair ? -1 : 1;
    return (a->order > b->order) - (a->order < b->order);
}

/* All points and shares of a pair are of one thread, in their order. */
int fl_panels_sort(fl_world *w, fl_err *err)
{
    fl_panel_loads *s = &w->panel_load;
    int64_t n = 0, shares = 0;
    for (int32_t t = 0; t < w->threads; t++) n += s->by_thread[t].n, shares += s->by_thread[t].shares;
    if (fl_grow(&s->point, &s->point_cap, n, sizeof *s->point, err) ||
        fl_grow(&s->share, &s->share_cap, shares, sizeof *s->share, err))
        return -1;
    s->points = s->shares = 0;
    for (int32_t t = 0; t < w->threads; t++) {
        for (int32_t k = 0; k < s->by_thread[t].shares; k++) {
            s->by_thread[t].share[k].order = k;
            s->share[s->shares++] = s->by_thread[t].share[k];
        }
        for (int32_t k = 0; k < s->by_thread[t].n; k++) {
            s->by_thread[t].point[k].order = k;
            s->point[s->points++] = s->by_thread[t].point[k];
        }
    }
    if (s->points > 1) qsort(s->point, (size_t)s->points, sizeof *s->point, compare_points);
    if (s->shares > 1) qsort(s->share, (size_t)s->shares, sizeof *s->share, compare_shares);
    return 0;
}

/* --- sums over an interval --------------------------------------------------------------------- */

/* The event of floe and part, sorted by both; appended if there is none. */
static fl_load_event *find_event(fl_panel_loads *s, int32_t id, int32_t part, fl_err *err)
{
    int32_t low = 0, high = s->events;
    while (low < high) {
        const int32_t k = low + (high - low) / 2;
        const fl_load_event *e = &s->event[k];
        if (e->id < id || (e->id == id && e->part < part)) low = k + 1;
        else high = k;
    }
    if (low < s->events && s->event[low].id == id && s->event[low].part == part) return &s->event[low];
    if (fl_grow(&s->event, &s->event_cap, (int64_t)s->events + 1, sizeof *s->event, err)) return NULL;
    memmove(s->event + low + 1, s->event + low, (size_t)(s->events - low) * sizeof *s->event);
    s->events++;
    s->event[low] = (fl_load_event){.id = id, .part = part};
    return &s->event[low];
}

int fl_panels_accumulate(fl_world *w, double h, fl_err *err)
{
    fl_panel_loads *s = &w->panel_load;
    for (int32_t k = 0; k < s->points; k++) {
        const fl_panel_point *m = &s->point[k];
        s->impulse[m->panel] = v3_madd(s->impulse[m->panel], -h, m->force);
        if (!w->scene->output.events[0]) continue;
        fl_load_event *e = find_event(s, w->id[m->i], m->part, err);
        if (!e) return -1;
        const double weight = h * (m->normal_force > 0.0 ? m->normal_force : 0.0);
        e->impulse = v3_madd(e->impulse, -h, m->force);
        e->normal_impulse = v3_madd(e->normal_impulse, weight, m->n);
        e->impulse_point = v3_madd(e->impulse_point, weight, m->point);
        e->impulse_sum += weight;
        e->impulse_area += weight * m->area;
        if (m->overlap > e->max_overlap) e->max_overlap = m->overlap;
    }
    return 0;
}

void fl_panels_end_interval(fl_world *w)
{
    memset(w->panel_load.impulse, 0, (size_t)w->panel_load.panels * sizeof *w->panel_load.impulse);
}

void fl_events_end_interval(fl_world *w) { w->panel_load.events = 0; }
