/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/cone_blend.h"
#include <math.h>
#include "base/array.h"
#include "patch/cone.h"

/* Upper bound of the extent of A along the axis of the cone, from its centre, and the derivative by a
 * rotation of A.  It is the norm (sum h^8)^(1/8) over the heights h of the vertices, which is smooth and
 * does not depend on the choice of A's axes. */
static double extent_along(const fl_poly *a, const fl_mat3 *M, fl_vec3 *turn)
{
    const fl_vec3 axis = v3(M->m[2][0], M->m[2][1], M->m[2][2]);
    double sum = 0.0;
    fl_vec3 g = v3(0, 0, 0); /* sum of h^7 a */
    for (int32_t v = 0; v < a->nv; v++) {
        const double h = v3_dot(axis, a->v[v]), h2 = h * h, h7 = h2 * h2 * h2 * h;
        sum += h7 * h;
        g = v3_madd(g, h7, a->v[v]);
    }
    const double e4 = sqrt(sum), e2 = sqrt(e4), e = sqrt(e2), e7 = e4 * e2 * e;
    *turn = v3_cross(v3_scale(e7 > 0.0 ? 1.0 / e7 : 0.0, m3_mul(*M, g)), v3(0, 0, 1));
    return e;
}

fl_cone_blend fl_cone_blend_of(const fl_piece *cone, const fl_poly *a, const fl_mat3 *M, fl_vec3 o, double R)
{
    fl_vec3 turn;
    const double size = extent_along(a, M, &turn) + R;
    const fl_cone_weight q = fl_cone_weight_between(0.0, cone->h, o.z, size);
    return (fl_cone_blend){q.weight, q.slope, v3_scale(q.size, turn)};
}

int fl_cone_blend_points(fl_patch_points *s, int32_t first, int32_t exact, fl_vec3 couple,
                         const fl_cone_blend *of, fl_vec3 centre)
{
    double u[2] = {0};
    for (int32_t k = first; k < s->n; k++) {
        fl_patch_point *q = &s->point[k];
        const double part = k < exact ? 1.0 - of->weight : of->weight;
        u[k >= exact] += q->u;
        q->u *= part, q->du *= part, q->ddu *= part;
    }
    const double more = u[1] - u[0], du = -of->slope * more;
    s->couple = v3_add(v3_scale(1.0 - of->weight, couple), v3_scale(of->weight, s->couple));
    s->couple = v3_madd(s->couple, -more, of->turn);
    if (du == 0.0) return 0;
    return fl_patch_points_add(
        s, (fl_patch_point){.du = fabs(du), .n = v3(0, 0, du > 0.0 ? 1.0 : -1.0), .p = centre});
}

/* --- joined pieces ------------------------------------------------------------------------------ */

/* The pose of A in the frame of the piece. */
typedef struct {
    fl_mat3 M;
    fl_vec3 o;
} pose;

/* The pose of A in the frame of a cone of the piece. */
static void pose_at_cone(const fl_free_cone *c, const pose *r, fl_mat3 *M, fl_vec3 *o)
{
    const fl_mat3 Q = q_matrix(c->q);
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
            M->m[k][l] = Q.m[0][k] * r->M.m[0][l] + Q.m[1][k] * r->M.m[1][l] + Q.m[2][k] * r->M.m[2][l];
    *o = m3_tmul(Q, v3_sub(r->o, c->x));
}

/* True if A, within `size` of o, may come within R of the cone. */
static int may_reach(const fl_free_cone *c, fl_vec3 o, double size, double R)
{
    const double far = size + R, across = fmax(c->r0, c->r1) + far;
    return o.z > -far && o.z < c->h + far && o.x * o.x + o.y * o.y < across * across;
}

/* Points from `first` on, and the couple, from the frame of the cone to that of the piece. */
static void points_to_piece(fl_patch_points *s, int32_t first, const fl_free_cone *c)
{
    const fl_mat3 Q = q_matrix(c->q);
    for (int32_t k = first; k < s->n; k++) {
        fl_patch_point *q = &s->point[k];
        q->p = v3_add(c->x, m3_mul(Q, q->p));
        q->n = m3_mul(Q, q->n);
        q->unit_normal = m3_mul(Q, q->unit_normal);
    }
    s->couple = m3_mul(Q, s->couple);
}

/* The inverse: from the frame of the piece to that of the cone. */
static void points_to_cone(fl_patch_points *s, int32_t first, const fl_free_cone *c)
{
    const fl_mat3 Q = q_matrix(c->q);
    for (int32_t k = first; k < s->n; k++) {
        fl_patch_point *q = &s->point[k];
        q->p = m3_tmul(Q, v3_sub(q->p, c->x));
        q->n = m3_tmul(Q, q->n);
        q->unit_normal = m3_tmul(Q, q->unit_normal);
    }
    s->couple = m3_tmul(Q, s->couple);
}

/* Adds the points with cone k of the piece, which is free with some weight. */
static int add_free_cone(fl_patch_points *s, fl_mesh_contact_work *near, const fl_poly *a,
                         const fl_piece *piece, const pose *r, int32_t k, const fl_cone_blend *of, double ra,
                         fl_feature_pairs *l)
{
    const fl_free_cone *c = &piece->free_cone[k];
    const fl_truncated_cone cone = {c->r0, c->r1, c->h};
    const fl_vec3 before = s->couple;
    const int32_t first = s->n;
    fl_mat3 M;
    fl_vec3 o;
    s->couple = v3(0, 0, 0);
    if (of->weight < 1.0 && fl_mesh_contact_add_points(s, near, a, piece, ra, k, l)) return -1;
    points_to_cone(s, first, c);
    const int32_t exact = s->n;
    const fl_vec3 couple = s->couple;
    s->couple = v3(0, 0, 0);
    pose_at_cone(c, r, &M, &o);
    if (fl_patch_points_transform(s, a, M, o) || fl_cone_evaluate(s, a, &cone, ra) ||
        (of->weight < 1.0 && fl_cone_blend_points(s, first, exact, couple, of, o)) ||
        fl_patch_points_transform(s, a, r->M, r->o))
        return -1;
    points_to_piece(s, first, c);
    s->couple = v3_add(before, s->couple);
    return 0;
}

int fl_joined_find_points(fl_patch_points *s, fl_mesh_contact_work *near, const fl_poly *a,
                          const fl_piece *piece, const fl_mat3 *axes, fl_vec3 at, double size, double ra,
                          double reach, fl_feature_pairs *l, double *distance)
{
    const pose r = {*axes, at};
    int32_t some = 0;
    if (fl_mesh_contact_reserve_cones(near, piece->cones)) return -1;
    for (int32_t k = 0; k < piece->cones; k++) {
        const fl_free_cone *c = &piece->free_cone[k];
        fl_mat3 M;
        fl_vec3 o, turn;
        near->is_free[k] = 0;
        if (c->n == 0) continue;
        pose_at_cone(c, &r, &M, &o);
        if (!may_reach(c, o, size, ra)) continue;
        near->is_free[k] = fl_free_cone_weight(c, o.z, extent_along(a, &M, &turn) + ra).weight > 0.0;
        some += near->is_free[k];
    }
    if (!some) return fl_mesh_contact_points(s, near, a, piece, ra, reach, l, distance);
    s->n = s->features = 0;
    s->couple = v3(0, 0, 0);
    if (fl_mesh_contact_add_points(s, near, a, piece, ra, -1, l)) return -1;
    for (int32_t k = 0; k < piece->cones; k++) {
        fl_mat3 M;
        fl_vec3 o, turn;
        if (!near->is_free[k]) continue;
        pose_at_cone(&piece->free_cone[k], &r, &M, &o);
        const fl_cone_weight q =
            fl_free_cone_weight(&piece->free_cone[k], o.z, extent_along(a, &M, &turn) + ra);
        const fl_cone_blend of = {q.weight, q.slope, v3_scale(q.size, turn)};
        if (add_free_cone(s, near, a, piece, &r, k, &of, ra, l)) return -1;
    }
    *distance = ra;
    if (s->n == 0) fl_mesh_contact_bound(s, a, piece, reach, distance);
    return 0;
}
