/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "zone/zone_joint.h"
#include <string.h>
#include "base/array.h"
#include "geom/polygon_clip.h"

/* Share of a triangle below which a piece of it gets one point, and below which it is rounding. */
static const double SMALL_PIECE = 1e-3, NO_PIECE = 1e-10;
/* How far outside a triangle, as a share of it, a point counts as on the face. */
static const double BESIDE = 1e-4;

/* --- points ------------------------------------------------------------------------------------- */

/* The plane of the joint at the start. */
typedef struct {
    fl_vec3 o, ta, tb, n;
} joint_plane;

static fl_vec2 flat_of(const joint_plane *p, fl_vec3 x)
{
    const fl_vec3 d = v3_sub(x, p->o);
    return (fl_vec2){v3_dot(p->ta, d), v3_dot(p->tb, d)};
}

static double cross2(fl_vec2 a, fl_vec2 b, fl_vec2 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Shares of x in the triangle v. */
static void shares_in(const fl_vec2 v[3], fl_vec2 x, double share[3])
{
    const double all = cross2(v[0], v[1], v[2]);
    share[0] = cross2(x, v[1], v[2]) / all, share[1] = cross2(v[0], x, v[2]) / all;
    share[2] = 1.0 - share[0] - share[1];
}

/* What the points of a triangle share. */
typedef struct {
    fl_zone_joint_list *l;
    const int32_t *node;
    fl_vec2 v[3]; /* of that triangle, turned as node */
    int32_t triangle, off;
    const fl_vec2 *other; /* the other triangle, NULL if it is rigid */
} point_owner;

static int append_point(const point_owner *o, fl_vec2 x, double area, fl_err *err)
{
    fl_zone_joint_list *l = o->l;
    if (fl_grow(&l->point, &l->cap_point, (int64_t)l->points + 1, sizeof *l->point, err)) return -1;
    fl_zone_point *p = &l->point[l->points++];
    *p = (fl_zone_point){.triangle = o->triangle, .area = area, .off = o->off};
    memcpy(p->node, o->node, sizeof p->node);
    shares_in(o->v, x, p->share);
    if (o->other) shares_in(o->other, x, p->other);
    return 0;
}

/* Points of a piece v[n] of a triangle of that area. */
static int append_piece(const point_owner *o, int32_t n, const fl_vec2 *v, double whole, fl_err *err)
{
    const fl_polygon_moments m = fl_polygon_moments_of(n, v);
    if (n < 3 || !(m.area > NO_PIECE * whole)) return 0;
    if (o->off || m.area < SMALL_PIECE * whole) return append_point(o, m.centre, m.area, err);
    for (int32_t k = 1; k + 1 < n; k++) {
        const fl_vec2 t[3] = {v[0], v[k], v[k + 1]};
        const double area = 0.5 * cross2(t[0], t[1], t[2]);
        const fl_vec2 mean = {(t[0].x + t[1].x + t[2].x) / 6.0, (t[0].y + t[1].y + t[2].y) / 6.0};
        if (!(area > NO_PIECE * whole)) continue;
        for (int e = 0; e < 3; e++)
            if (append_point(o, (fl_vec2){mean.x + 0.5 * t[e].x, mean.y + 0.5 * t[e].y}, area / 3.0, err))
                return -1;
    }
    return 0;
}

/* The parts of a triangle outside the other face c[n], counter-clockwise. */
static int append_outside(point_owner *o, const fl_vec2 t[3], int32_t n, const fl_vec2 *c, double whole,
                          fl_err *err)
{
    fl_vec2 in[3 + FL_JOINT_CORNERS], out[4 + FL_JOINT_CORNERS];
    int32_t left = 3;
    memcpy(in, t, 3 * sizeof *t);
    o->off = 1, o->triangle = -1, o->other = NULL;
    for (int32_t k = 0; k < n && left; k++) {
        const fl_vec2 d = {c[(k + 1) % n].x - c[k].x, c[(k + 1) % n].y - c[k].y};
        memcpy(out, in, (size_t)left * sizeof *in);
        const int32_t beyond = fl_polygon_keep_left(left, out, c[k], (fl_vec2){-d.x, -d.y});
        if (append_piece(o, beyond, out, whole, err)) return -1;
        left = fl_polygon_keep_left(left, in, c[k], d);
    }
    return 0;
}

/* Triangles of a face of a block, appended to the list of the joint. */
static int list_face(fl_zone_joint_list *l, const fl_zone_set *s, int32_t block, int32_t face, fl_err *err)
{
    const fl_zone_block *q = &s->block[block];
    for (int32_t k = q->triangle; k < q->triangle_end; k++) {
        if (s->face[k] != face) continue;
        if (fl_grow(&l->triangle, &l->cap_triangle, (int64_t)l->triangles + 1, sizeof *l->triangle, err))
            return -1;
        l->triangle[l->triangles++] = k;
    }
    return 0;
}

static void flat_triangle(const joint_plane *p, const fl_zone_set *s, int32_t k, fl_vec2 v[3])
{
    for (int e = 0; e < 3; e++) v[e] = flat_of(p, s->x[s->triangle[k][e]]);
}

/* The points on triangle k; corner[n]: the other face. */
static int cover_triangle(fl_zone_joint_list *l, const fl_zone_set *s, const fl_zone_joint *j,
                          const joint_plane *p, int32_t k, int32_t n, const fl_vec2 *corner, fl_err *err)
{
    fl_vec2 t[3], turned[3], w[3], piece[6 + FL_JOINT_CORNERS];
    flat_triangle(p, s, k, t);
    turned[0] = t[0], turned[1] = t[2], turned[2] = t[1]; /* it faces the other side */
    point_owner o = {.l = l, .node = s->triangle[k], .triangle = -1};
    memcpy(o.v, t, sizeof t);
    const double whole = 0.5 * cross2(turned[0], turned[1], turned[2]);
    double covered = 0.0;
    if (j->other < 0) {
        const int32_t m = fl_polygon_common(3, turned, n, corner, piece);
        covered = fl_polygon_moments_of(m, piece).area;
        if (append_piece(&o, m, piece, whole, err)) return -1;
    }
    for (int32_t e = j->triangle; e < j->triangle_end && j->other >= 0; e++) {
        flat_triangle(p, s, l->triangle[e], w);
        const int32_t m = fl_polygon_common(3, turned, 3, w, piece);
        if (m < 3) continue;
        o.triangle = l->triangle[e], o.other = w;
        covered += fl_polygon_moments_of(m, piece).area;
        if (append_piece(&o, m, piece, whole, err)) return -1;
    }
    return whole - covered > 1e-6 * whole ? append_outside(&o, turned, n, corner, whole, err) : 0;
}

/* --- where a point is --------------------------------------------------------------------------- */

static fl_vec3 place_in_triangle(const int32_t *node, const double w[3], const fl_vec3 *x)
{
    return v3_madd(v3_madd(v3_scale(w[0], x[node[0]]), w[1], x[node[1]]), w[2], x[node[2]]);
}

/* Shares of the projection of x in triangle k, and its normal; the least share. */
static double project_on(const fl_zone_set *s, int32_t k, fl_vec3 x, double share[3], fl_vec3 *normal)
{
    const int32_t *t = s->triangle[k];
    const fl_vec3 a = s->x[t[0]], b = s->x[t[1]], c = s->x[t[2]], N = v3_cross(v3_sub(b, a), v3_sub(c, a));
    const double size2 = v3_norm2(N);
    share[0] = v3_dot(N, v3_cross(v3_sub(b, x), v3_sub(c, x))) / size2;
    share[1] = v3_dot(N, v3_cross(v3_sub(c, x), v3_sub(a, x))) / size2;
    share[2] = 1.0 - share[0] - share[1];
    *normal = v3_scale(1.0 / sqrt(size2), N);
    return fmin(share[0], fmin(share[1], share[2]));
}

/* Finds the triangle of the other face under x; 0 if there is none. */
static int find_triangle(const fl_zone_joint_list *l, const fl_zone_joint *j, const fl_zone_set *s,
                         fl_zone_point *p, fl_vec3 x, fl_vec3 *normal)
{
    double share[3], best = -INFINITY;
    fl_vec3 n;
    if (p->triangle >= 0) {
        best = project_on(s, p->triangle, x, p->other, normal);
        if (best > -1e-9) return 1;
    }
    for (int32_t e = j->triangle; e < j->triangle_end; e++) {
        const double least = project_on(s, l->triangle[e], x, share, &n);
        if (!(least > best)) continue;
        best = least, *normal = n, p->triangle = l->triangle[e];
        memcpy(p->other, share, sizeof share);
    }
    return best > -BESIDE;
}

/* The place of x on the rigid face; 0 if it is beside it. */
static int find_on_face(const fl_zone_joint *j, const fl_joint_pool pool, fl_vec3 local, fl_zone_point *p)
{
    const fl_vec3 *c = pool.corner + j->corner;
    const double h = v3_dot(j->normal, v3_sub(local, c[0]));
    local = v3_madd(local, -h, j->normal);
    p->other[0] = local.x, p->other[1] = local.y, p->other[2] = local.z;
    for (int32_t k = 0; k < j->corners; k++) {
        const fl_vec3 side = v3_sub(c[(k + 1) % j->corners], c[k]), d = v3_sub(local, c[k]);
        if (v3_dot(j->normal, v3_cross(side, d)) < -BESIDE * v3_norm2(side)) return 0;
    }
    return 1;
}

/* Both places of a point. */
typedef struct {
    fl_vec3 x, other, n; /* the second place follows the material found before; normal */
    int on;
} point_places;

static fl_vec3 other_place(const fl_zone_joint *j, const fl_zone_set *s, const fl_bodies *b, const fl_mat3 *R,
                           const fl_zone_point *p)
{
    if (j->other < 0)
        return v3_add(b->x[-1 - j->other], m3_mul(*R, v3(p->other[0], p->other[1], p->other[2])));
    return place_in_triangle(s->triangle[p->triangle], p->other, s->x);
}

/* Projects the point anew; its place on the other side follows. */
static point_places find_places(const fl_zone_joint_list *l, const fl_zone_joint *j, const fl_zone_set *s,
                                fl_joint_pool pool, const fl_bodies *b, const fl_mat3 *R, fl_zone_point *p)
{
    point_places q = {.x = place_in_triangle(p->node, p->share, s->x)};
    if (j->other < 0) {
        q.n = m3_mul(*R, j->normal);
        q.on = find_on_face(j, pool, m3_tmul(*R, v3_sub(q.x, b->x[-1 - j->other])), p);
    } else {
        q.on = find_triangle(l, j, s, p, q.x, &q.n);
    }
    q.other = other_place(j, s, b, R, p);
    return q;
}

/* --- set-up ------------------------------------------------------------------------------------- */

/* Energy that a point stores before any of its strength is lost [J/m2]. */
static double energy_at_start(const fl_joint_material *m, fl_joint_point p, double s_n)
{
    static const double NO_SLIP[2] = {0.0, 0.0};
    fl_joint_material strong = *m;
    strong.cohesion = strong.tension = INFINITY;
    return fl_joint_laws[m->law].step(&strong, &p, s_n, NO_SLIP).stored;
}

/* Adds the area of a point to its nodes on both sides. */
static void add_area(const fl_zone_set *s, const fl_zone_point *p, double *area)
{
    for (int e = 0; e < 3; e++) {
        area[p->node[e]] += p->share[e] * p->area;
        if (p->triangle >= 0) area[s->triangle[p->triangle][e]] += p->other[e] * p->area;
    }
}

/* Joint stiffness on node n, once: its area becomes 0.  Lowers the least mass per area. */
static void stiffen_node(fl_zone_set *s, int32_t n, double kn, double *area, double *least)
{
    if (!(area[n] > 0.0)) return;
    s->stiffness[n] += 2.0 * kn * area[n];
    *least = fmin(*least, s->m[n] / area[n]);
    area[n] = 0.0;
}

/* Joint stiffness on the nodes; returns the least mass per area of those with points. */
static double add_stiffness(fl_zone_set *s, const fl_zone_joint_list *l, const fl_zone_joint *j, double kn)
{
    double least = INFINITY;
    for (int32_t k = j->point; k < j->point_end; k++) add_area(s, &l->point[k], l->area);
    for (int32_t k = j->point; k < j->point_end; k++) {
        const fl_zone_point *p = &l->point[k];
        for (int e = 0; e < 3; e++) {
            stiffen_node(s, p->node[e], kn, l->area, &least);
            if (p->triangle >= 0) stiffen_node(s, s->triangle[p->triangle][e], kn, l->area, &least);
        }
    }
    return least;
}

static int make_points(fl_zone_joint_list *l, fl_zone_set *s, fl_zone_joint *j, const fl_zone_side *own,
                       const fl_zone_side *other, const joint_plane *plane, fl_joint_pool pool,
                       const fl_bodies *b, fl_err *err)
{
    fl_vec2 corner[FL_JOINT_CORNERS];
    const fl_mat3 R = fl_body_axes(b, other->body);
    for (int32_t k = 0; k < other->corners; k++)
        corner[k] = flat_of(plane, v3_add(b->x[other->body], m3_mul(R, pool.corner[other->corner + k])));
    j->triangle = j->triangle_end = l->triangles, j->point = l->points;
    if (j->other >= 0 && list_face(l, s, j->other, other->face, err)) return -1;
    j->triangle_end = l->triangles;
    const fl_zone_block *q = &s->block[own->block];
    for (int32_t k = q->triangle; k < q->triangle_end; k++)
        if (s->face[k] == own->face && cover_triangle(l, s, j, plane, k, other->corners, corner, err))
            return -1;
    j->point_end = l->points;
    return 0;
}

/* Stress and places at the start. */
static void start_points(fl_zone_joint_list *l, const fl_zone_set *s, fl_zone_joint *j, fl_bond *c,
                         fl_joint_pool pool, const fl_joint_material *m, const fl_bodies *b,
                         const double S[6])
{
    const fl_mat3 R = fl_body_axes(b, j->other < 0 ? -1 - j->other : s->block[j->other].body);
    const fl_vec3 n = m3_mul(R, j->normal), ta = m3_mul(R, j->along), tb = v3_cross(n, ta),
                  t = v3(S[0] * n.x + S[3] * n.y + S[5] * n.z, S[3] * n.x + S[1] * n.y + S[4] * n.z,
                         S[5] * n.x + S[4] * n.y + S[2] * n.z);
    /* the traction on the side with the points is t = S n */
    const double sigma = v3_dot(n, t), tau[2] = {-v3_dot(ta, t), -v3_dot(tb, t)};
    c->elastic_energy = 0.0;
    for (int32_t k = j->point; k < j->point_end; k++) {
        fl_zone_point *p = &l->point[k];
        if (p->off && j->other >= 0)
            p->triangle = j->triangle_end > j->triangle ? l->triangle[j->triangle] : -1;
        const point_places q = find_places(l, j, s, pool, b, &R, p);
        p->opening = v3_dot(q.n, v3_sub(q.x, q.other));
        p->apart = v3_sub(q.x, q.other);
        fl_joint_point_start(m, &p->law, p->off ? 0.0 : sigma, p->off ? (double[2]){0, 0} : tau);
        p->law.offset += p->opening; /* rounding of the file */
        p->sigma = p->off ? 0.0 : sigma + m->water_pressure;
        if (!p->off)
            c->elastic_energy +=
                p->area * (energy_at_start(m, p->law, p->opening) - m->water_pressure * p->opening);
    }
}

int fl_zone_joint_make(fl_zone_joint_list *l, fl_zone_set *s, fl_bond *c, fl_joint *q, fl_joint_pool pool,
                       const fl_bodies *b, int32_t bond, const fl_zone_side side[2], const double S[6],
                       double damping, fl_err *err)
{
    const int on_j = side[0].block < 0 || (side[1].block >= 0 && side[1].area < side[0].area * (1.0 - 1e-9));
    const fl_zone_side *own = &side[on_j], *other = &side[!on_j];
    const fl_joint_material *m = &pool.material[q->material];
    const fl_mat3 R = fl_body_axes(b, other->body);
    const fl_vec3 *corner = pool.corner + other->corner;
    if (!l->area && !(l->area = fl_alloc(s->nodes, sizeof *l->area, err))) return -1;
    if (fl_grow(&l->joint, &l->cap_joint, (int64_t)l->n + 1, sizeof *l->joint, err)) return -1;
    fl_zone_joint *j = &l->joint[l->n];
    *j = (fl_zone_joint){.bond = bond,
                         .own = own->block,
                         .other = other->block >= 0 ? other->block : -1 - other->body,
                         .points_on_i = !on_j,
                         .corner = other->corner,
                         .corners = other->corners};
    /* ni of a bond points out of i, nj into j, each in its frame */
    j->normal = on_j ? c->ni : v3_neg(c->nj);
    j->along = v3_sub(corner[1], corner[0]);
    j->along = v3_unit(v3_madd(j->along, -v3_dot(j->along, j->normal), j->normal));
    const fl_vec3 n = m3_mul(R, j->normal), ta = m3_mul(R, j->along);
    const joint_plane plane = {v3_add(b->x[other->body], m3_mul(R, corner[0])), ta, v3_cross(n, ta), n};
    if (make_points(l, s, j, own, other, &plane, pool, b, err)) return -1;
    l->n++;
    const double kn = fmax(fl_joint_most_kn(m), fl_joint_most_ks(m)), least = add_stiffness(s, l, j, kn);
    j->rate = isfinite(least) ? 2.0 * damping * sqrt(least / kn) : 0.0;
    start_points(l, s, j, c, pool, m, b, S);
    return 0;
}

int fl_zone_joint_list_finish(fl_zone_joint_list *l, const fl_zone_set *s, fl_err *err)
{
    free(l->area);
    l->area = NULL;
    l->first = fl_alloc((int64_t)s->blocks + 1, sizeof *l->first, err);
    l->of = fl_alloc(2 * (int64_t)l->n, sizeof *l->of, err);
    if (!l->first || !l->of) return -1;
    int32_t n = 0;
    for (int32_t b = 0; b < s->blocks; b++) {
        for (int32_t k = 0; k < l->n; k++)
            if (l->joint[k].own == b || l->joint[k].other == b) l->of[n++] = k;
        l->first[b + 1] = n;
    }
    return 0;
}

void fl_zone_joint_list_free(fl_zone_joint_list *l)
{
    free(l->joint), free(l->point), free(l->triangle), free(l->first), free(l->of), free(l->area);
    *l = (fl_zone_joint_list){0};
}

/* --- force -------------------------------------------------------------------------------------- */

/* Sums over the points of a joint. */
typedef struct {
    fl_vec3 force, moment; /* on the side with the points; about the rigid body */
    double stored, work, area;
    int32_t failed, on;
} zone_joint_sums;

/* Velocity of one place over the other. */
static fl_vec3 slip_rate(const fl_zone_joint *j, const fl_zone_set *s, const fl_bodies *b,
                         const fl_zone_point *p, fl_vec3 x)
{
    const fl_vec3 own = place_in_triangle(p->node, p->share, s->v);
    if (j->other >= 0) return v3_sub(own, place_in_triangle(s->triangle[p->triangle], p->other, s->v));
    const int32_t body = -1 - j->other;
    return v3_sub(own, fl_body_point_velocity(b, body, v3_sub(x, b->x[body])));
}

/* A step of a point that is on the other face. */
static void step_on(fl_zone_joint *j, const fl_zone_set *s, fl_joint *q, fl_bond *c,
                    const fl_joint_material *m, const fl_bodies *b, const fl_vec3 t[2],
                    const point_places *at, fl_vec3 moved, fl_zone_point *p, double dt, zone_joint_sums *out)
{
    const double ds[2] = {v3_dot(moved, t[0]), v3_dot(moved, t[1])}, tau[2] = {p->law.tau[0], p->law.tau[1]},
                 water = m->water_pressure, s_n = v3_dot(at->n, v3_sub(at->x, at->other));
    const fl_joint_point_result r = fl_joint_laws[m->law].step(m, &p->law, s_n, ds);
    const double pressed = p->law.sigma + water;
    p->force = v3_scale(
        p->area, v3_madd(v3_madd(v3_scale(pressed, at->n), -p->law.tau[0], t[0]), -p->law.tau[1], t[1]));
    out->work += p->area * (-0.5 * (p->sigma + pressed) * (s_n - p->opening) +
                            0.5 * (tau[0] + p->law.tau[0]) * ds[0] + 0.5 * (tau[1] + p->law.tau[1]) * ds[1]);
    out->stored += p->area * (r.stored - water * s_n);
    out->area += p->area, out->failed += p->law.failed, out->on++;
    q->friction_loss += p->area * r.friction, c->dissipated -= p->area * r.friction;
    q->slips += r.slips, q->opens += p->law.open;
    p->sigma = pressed, p->opening = s_n;
    if (!(j->rate > 0.0) || p->law.open) return;
    const fl_vec3 v = slip_rate(j, s, b, p, at->other);
    const double vn = v3_dot(v, at->n), shear = r.slips ? 0.0 : j->rate * m->ks;
    const fl_vec3 d = v3_scale(-p->area, v3_madd(v3_scale(shear, v), (j->rate * m->kn - shear) * vn, at->n));
    p->force = v3_add(p->force, d);
    j->damped -= dt * v3_dot(d, v);
}

/* A point beside the other face bears nothing. */
static void step_off(fl_zone_point *p)
{
    p->off = 1;
    p->law.open = p->law.failed = 1;
    p->law.sigma = p->law.tau[0] = p->law.tau[1] = p->sigma = 0.0;
    p->force = v3(0, 0, 0);
}

/* Numbers of points that slip or are open, as if the joint had the nine of a rigid one. */
static void count_of_nine(fl_joint *q, int32_t on)
{
    if (on == 0) return;
    const int all_open = q->opens == on;
    q->slips = (FL_BOND_POINTS * q->slips + on - 1) / on;
    q->opens = (FL_BOND_POINTS * q->opens + on - 1) / on;
    if (!all_open && q->opens == FL_BOND_POINTS) q->opens--;
}

int fl_zone_joint_force(fl_zone_joint_list *l, int32_t k, const fl_zone_set *s, fl_bond *c, fl_joint *q,
                        fl_joint_pool pool, const fl_bodies *b, double dt)
{
    fl_zone_joint *j = &l->joint[k];
    const fl_joint_material *m = &pool.material[q->material];
    const int32_t body = j->other < 0 ? -1 - j->other : s->block[j->other].body;
    const fl_mat3 R = fl_body_axes(b, body);
    const fl_vec3 along = m3_mul(R, j->along);
    const double had = c->elastic_energy;
    zone_joint_sums r = {0};
    q->slips = q->opens = 0;
    for (int32_t e = j->point; e < j->point_end; e++) {
        fl_zone_point *p = &l->point[e];
        const int was_off = p->off;
        const fl_vec3 before = place_in_triangle(p->node, p->share, s->x);
        const fl_vec3 moved =
            was_off ? v3(0, 0, 0) : v3_sub(v3_sub(before, other_place(j, s, b, &R, p)), p->apart);
        const point_places at = find_places(l, j, s, pool, b, &R, p);
        p->off = !at.on;
        if (!at.on) {
            step_off(p);
            continue;
        }
        const fl_vec3 ta = v3_unit(v3_madd(along, -v3_dot(along, at.n), at.n)),
                      t[2] = {ta, v3_cross(at.n, ta)};
        if (was_off) p->opening = v3_dot(at.n, v3_sub(at.x, at.other));
        step_on(j, s, q, c, m, b, t, &at, moved, p, dt, &r);
        p->apart = v3_sub(at.x, at.other);
        r.force = v3_add(r.force, p->force);
        if (j->other < 0) r.moment = v3_sub(r.moment, v3_cross(v3_sub(at.other, b->x[body]), p->force));
    }
    c->elastic_energy = r.stored;
    c->dissipated += r.work + had - r.stored;
    c->area = r.area;
    c->state = r.failed == 0 ? FL_BOND_INTACT : r.failed == r.on ? FL_BOND_BROKEN : FL_BOND_DAMAGED;
    count_of_nine(q, r.on);
    c->force = j->points_on_i ? r.force : v3_neg(r.force); /* on i */
    c->torque_i = c->torque_j = v3(0, 0, 0);
    if (j->other < 0 && j->points_on_i) c->torque_j = r.moment;
    if (j->other < 0 && !j->points_on_i) c->torque_i = r.moment;
    if (r.on) return 0;
    for (int32_t e = j->point; e < j->point_end; e++) l->point[e].force = v3(0, 0, 0);
    fl_bond_end(c);
    return 1;
}

void fl_zone_joint_add(const fl_zone_joint_list *l, int32_t k, int32_t block, fl_zone_set *s)
{
    const fl_zone_joint *j = &l->joint[k];
    for (int32_t e = j->point; e < j->point_end; e++) {
        const fl_zone_point *p = &l->point[e];
        if (p->off) continue;
        for (int a = 0; a < 3 && j->own == block; a++)
            s->f[p->node[a]] = v3_madd(s->f[p->node[a]], p->share[a], p->force);
        const int32_t *t = p->triangle >= 0 ? s->triangle[p->triangle] : NULL;
        for (int a = 0; a < 3 && t && j->other == block; a++)
            s->f[t[a]] = v3_madd(s->f[t[a]], -p->other[a], p->force);
    }
}
