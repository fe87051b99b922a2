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

static void add_panel(fl_panel_loads *s, int32_t part, const fl_vec3 *v, fl_vec3 middle, double area)
{
    const int32_t k = s->panels++;
    s->panel[k] = (fl_load_panel){.part = part, .centroid = middle, .area = area};
    s->box[k] = aabb_empty();
    for (int c = 0; c < 3; c++) {
        s->panel[k].v[c] = v ? v[c] : middle;
        s->box[k] = aabb_add(s->box[k], s->panel[k].v[c]);
    }
}

/* Area of a cone: its side and its ends. */
static double cone_area(const fl_cone *c)
{
    const double h = v3_norm(v3_sub(c->p1, c->p0)), slant = sqrt(h * h + (c->r0 - c->r1) * (c->r0 - c->r1));
    return PI * ((c->r0 + c->r1) * slant + c->r0 * c->r0 + c->r1 * c->r1);
}

int fl_panels_make(fl_world *w, const fl_surface *surface, fl_err *err)
{
    fl_panel_loads *s = &w->panel_load;
    const fl_scene_output *o = &w->scene->output;
    int64_t n = 0;
    if (!surface || (!o->panels[0] && !o->events[0])) return 0;
    for (int32_t p = 0; p < surface->n; p++) n += surface->part[p].nt + surface->part[p].nc;
    if (n > INT32_MAX) return fl_fail(err, FL_SYSTEM, "%.0f panels are too many", (double)n);
    s->panel = fl_alloc(n, sizeof *s->panel, err);
    s->box = fl_alloc(n, sizeof *s->box, err);
    s->impulse = fl_alloc(n, sizeof *s->impulse, err);
    s->first = fl_alloc(surface->n + 1, sizeof *s->first, err);
    s->tree = fl_alloc(surface->n, sizeof *s->tree, err);
    s->trees = surface->n;
    s->by_thread = fl_alloc(w->threads, sizeof *s->by_thread, err);
    s->threads = w->threads;
    s->cone = fl_alloc(w->structure.n, sizeof *s->cone, err);
    if (err->code) return -1;
    for (int32_t p = 0; p < surface->n; p++) {
        const fl_part *part = &surface->part[p];
        for (int32_t t = 0; t < part->nt; t++) {
            const int32_t *at = part->t[t].v;
            const fl_vec3 v[3] = {part->v[at[0]], part->v[at[1]], part->v[at[2]]};
            const fl_vec3 middle = v3_scale(1.0 / 3.0, v3_add(v[0], v3_add(v[1], v[2])));
            add_panel(s, p, v, middle, 0.5 * v3_norm(v3_cross(v3_sub(v[1], v[0]), v3_sub(v[2], v[0]))));
        }
        if (part->nt && fl_bvh_build(&s->tree[p], s->box + s->first[p], part->nt, err)) return -1;
        for (int32_t c = 0; c < part->nc; c++) {
            const fl_cone *cone = &part->cone[c];
            add_panel(s, p, NULL, v3_scale(0.5, v3_add(cone->p0, cone->p1)), cone_area(cone));
        }
        s->first[p + 1] = s->panels;
    }
    for (int32_t t = 0; t < w->threads; t++) w->scratch[t].keep_features = 1;
    /* the pieces of a part are that of its triangles, then its cones in their order */
    for (int32_t k = 0, part = -1, c = 0; k < w->structure.n; k++) {
        const fl_piece *piece = &w->structure.piece[k];
        s->cone[k] = -1;
        if (piece->kind != FL_PIECE_CONE) continue;
        if (piece->part != part) part = piece->part, c = 0;
        s->cone[k] = s->first[part] + surface->part[part].nt + c++;
    }
    return 0;
}

void fl_panels_free(fl_panel_loads *s)
{
    for (int32_t t = 0; s->by_thread && t < s->threads; t++)
        free(s->by_thread[t].point), free(s->by_thread[t].list);
    for (int32_t p = 0; s->tree && p < s->trees; p++) fl_bvh_free(&s->tree[p]);
    free(s->panel), free(s->box), free(s->impulse), free(s->first), free(s->tree), free(s->by_thread);
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

/* The panel of a part that is nearest to x, in the pose of the file; the first of several.  reach: first
 * radius of the search [m].  -1 when memory runs out. */
static int32_t find_nearest_panel(fl_panel_points *points, const fl_panel_loads *s, int32_t part, fl_vec3 x,
                                  double reach)
{
    const int32_t first = s->first[part];
    const fl_bvh *tree = &s->tree[part];
    for (;; reach *= 4.0) {
        const fl_aabb box = aabb_grow((fl_aabb){x, x}, reach);
        int32_t n = fl_bvh_query(tree, s->box + first, box, points->list, points->list_cap), best = -1;
        if (n > points->list_cap) {
            if (fl_reserve(&points->list, &points->list_cap, n, sizeof *points->list)) return -1;
            n = fl_bvh_query(tree, s->box + first, box, points->list, points->list_cap);
        }
        double least = INFINITY;
        for (int32_t k = 0; k < n; k++) {
            const int32_t t = points->list[k];
            if (!(s->panel[first + t].area > 0.0)) continue; /* degenerate: it has no row in the table */
            const double d2 = triangle_distance2(s->panel[first + t].v, x);
            if (d2 < least || (d2 == least && t < best)) least = d2, best = t;
        }
        if (best >= 0 && (least <= reach * reach || n == tree->n)) return first + best;
        if (!(reach < 1e30)) return first;
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
    *m = (fl_panel_point){.pair = p->index, .i = p->i, .part = w->structure.piece[p->j - w->n].part};
    return m;
}

/* The panel at a point of the piece; -1 when memory runs out. */
static int32_t panel_of_point(fl_world *w, const fl_pair *p, fl_panel_points *points, fl_vec3 at)
{
    const int32_t k = p->j - w->n;
    const fl_piece *piece = &w->structure.piece[k];
    const double reach = 2.0 * (p->overlap + w->b.radius[p->i]) + 1e-9 * piece->core.size;
    if (w->panel_load.cone[k] >= 0) return w->panel_load.cone[k];
    return find_nearest_panel(points, &w->panel_load, piece->part, v3_add(piece->x, q_rotate(piece->q, at)),
                              reach);
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
    const int32_t first = s->first[piece->part], from = points->n;
    const fl_vec3 m = v3_add(piece->x, q_rotate(piece->q, q->middle)), n = q_rotate(piece->q, q->across);
    fl_vec3 e1 = q_rotate(piece->q, q->e1), e2 = q_rotate(piece->q, q->e2);
    if (q->n == 2) e2 = v3_scale(STRIP_WIDTH, v3_cross(n, e1));
    /* u = r1.(x - m), v = r2.(x - m) in the plane of e1 and e2 */
    const fl_vec3 c = v3_cross(e1, e2), r1 = v3_scale(1.0 / v3_norm2(c), v3_cross(e2, c)),
                  r2 = v3_scale(1.0 / v3_norm2(c), v3_cross(c, e1));
    const int plate = piece->core.nf == 2; /* has two sides */
    fl_aabb box = aabb_empty();
    double all = 0.0;
    if (s->cone[p->j - w->n] >= 0 || q->n == 1 || !(v3_norm2(c) > 0.0)) {
        record_at_panel(w, p, points, q);
        return;
    }
    for (int k = 0; k < 4; k++)
        box = aabb_add(box, v3_madd(v3_madd(m, k & 1 ? far : -far, e1), k & 2 ? far : -far, e2));
    box = aabb_grow(box, near);
    const fl_bvh *tree = &s->tree[piece->part];
    int32_t found = fl_bvh_query(tree, s->box + first, box, points->list, points->list_cap);
    if (found > points->list_cap) {
        if (fl_reserve(&points->list, &points->list_cap, found, sizeof *points->list)) {
#pragma omp atomic write
            w->failed = 1;
            return;
        }
        found = fl_bvh_query(tree, s->box + first, box, points->list, points->list_cap);
    }
    for (int32_t k = 0; k < found; k++) {
        const int32_t panel = first + points->list[k];
        const fl_load_panel *t = &s->panel[panel];
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
            w, p, points, panel, v3_madd(v3_madd(q->middle, middle.u, q->e1), middle.v, q->e2), q->across);
        if (!point) return;
        point->normal_force = area;
        all += area;
    }
    for (int32_t k = from; k < points->n; k++) {
        points->point[k].normal_force *= q->normal / all;
        points->point[k].area = q->area;
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
}

void fl_panels_record_point(fl_world *w, const fl_pair *p, fl_vec3 at, fl_vec3 n, double area)
{
    fl_panel_points *points = &w->panel_load.by_thread[omp_get_thread_num()];
    fl_panel_point *m = record_point(w, p, points, panel_of_point(w, p, points, at), at, n);
    if (!m) return;
    m->normal_force = v3_dot(p->force, m->n);
    m->area = area;
    m->force = p->force;
}

void fl_panels_clear(fl_world *w)
{
    for (int32_t t = 0; t < w->threads; t++) w->panel_load.by_thread[t].n = 0;
}

static int compare_points(const void *x, const void *y)
{
    const fl_panel_point *a = x, *b = y;
    if (a->pair != b->pair) return a->pair < b->pair ? -1 : 1;
    return (a->order > b->order) - (a->order < b->order);
}

/* All points of a pair are of one thread, in their order. */
int fl_panels_sort(fl_world *w, fl_err *err)
{
    fl_panel_loads *s = &w->panel_load;
    int64_t n = 0;
    for (int32_t t = 0; t < w->threads; t++) n += s->by_thread[t].n;
    if (fl_grow(&s->point, &s->point_cap, n, sizeof *s->point, err)) return -1;
    s->points = 0;
    for (int32_t t = 0; t < w->threads; t++) {
        for (int32_t k = 0; k < s->by_thread[t].n; k++) {
            s->by_thread[t].point[k].order = k;
            s->point[s->points++] = s->by_thread[t].point[k];
        }
    }
    if (s->points > 1) qsort(s->point, (size_t)s->points, sizeof *s->point, compare_points);
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
