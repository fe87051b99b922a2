/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh_sphere_kernel.h -- the nearest point of listed faces of a mesh, and the exact cone that some of them
 * stand for, by value, for mesh_contact.c and devices.  No call but sqrt. */
#ifndef FL_STRUCTURE_MESH_SPHERE_KERNEL_H
#define FL_STRUCTURE_MESH_SPHERE_KERNEL_H
#include "geom/quat.h"
#include "narrow/closest_kernel.h"
#include "structure/free_cone.h"

/* Distances within this fraction of the size are equal: rounding of the coordinates. */
#define FL_MESH_ROUNDING 1e-12
/* A point lies on an edge or face if it is within this fraction of the size: straight runs of edges are
 * straight, and corners of faces lie in their planes, to that (coplanar_regions.c). */
#define FL_MESH_EDGE 2e-6
/* Cosine between the way to a face and its normal above which that face decides the side: another face of the
 * same point could be more in front by 1e-9 of the distance at most. */
#define FL_MESH_NORMAL_COSINE (1.0 - 1e-9)
/* Normals that differ by less are of one plane: the tolerance of the planes over the smallest side of a tile
 * that matters. More planes than there are only take the longer way. */
#define FL_MESH_SAME_NORMAL 1e-9

/* Search for the nearest point of some faces, tried one by one; the result does not depend on their order but
 * for rounding. */
typedef struct {
    fl_closest_point at;
    double least; /* distance, whatever the order */
    double front; /* height of x in front of the face */
    double same;
    int32_t of; /* face */
    int thin;   /* the mesh has sheets with two sides */
} fl_nearest_search;

static inline fl_nearest_search fl_nearest_of_none(const fl_poly *p, int thin)
{
    fl_nearest_search b;
    b.at.d = b.least = INFINITY, b.at.p = b.at.n = v3(0, 0, 0);
    b.front = 0.0, b.same = FL_MESH_ROUNDING * p->size, b.of = -1, b.thin = thin;
    return b;
}

/* True if a face at height s decides the side rather than one at height `most`.  Of the two sides of a sheet,
 * at equal heights, it is the one that x is in front of. */
static inline int fl_nearest_is_decisive(double s, double most, int thin)
{
    if (thin && fabs(s + most) <= 1e-9 * fabs(s)) return s > most;
    return fabs(s) > fabs(most);
}

/* Among faces whose nearest points agree within rounding (a shared edge or corner), the one that x is most in
 * front of decides the side: its plane passes between x and the others. */
static inline void fl_nearest_try(fl_nearest_search *b, const fl_poly *p, int32_t f, fl_vec3 x)
{
    const double s = v3_dot(p->n[f], x) - p->c[f], most = b->at.d + b->same;
    if (fabs(s) > most) return;
    const fl_closest_point q = fl_point_on_face(p, f, x);
    if (q.d > most) return;
    if (q.d < b->least) b->least = q.d;
    if (q.d < b->at.d - b->same || fl_nearest_is_decisive(s, b->front, b->thin))
        b->at = q, b->front = s, b->of = f;
}

/* True if x is known to be in front of the surface whose listed faces are all that meet in the nearest point
 * (height_in_front() of mesh_contact.c). */
static inline int fl_nearest_is_in_front(const fl_nearest_search *b, const fl_poly *p, const int32_t *face,
                                         int32_t n, fl_vec3 x)
{
    const fl_vec3 r = v3_sub(x, b->at.p);
    const double same = FL_MESH_EDGE * p->size;
    double most = v3_dot(p->n[b->of], r);
    if (fabs(most) > FL_MESH_NORMAL_COSINE * b->at.d) return most >= 0.0;
    for (int32_t k = 0; k < n; k++) {
        const double s = v3_dot(p->n[face[k]], r);
        if (fl_point_on_face(p, face[k], b->at.p).d > same) continue;
        if (s < 0.0) return 0;
        if (fl_nearest_is_decisive(s, most, b->thin)) most = s;
    }
    return most >= 0.0;
}

/* Takes the distance of the exact cone with its weight, and that of its facet with the rest.  Returns 0 if it
 * has none. */
static inline int fl_blend_with_cone(fl_closest_point *q, const fl_free_cone *c, fl_vec3 x, double ra)
{
    const fl_vec3 at = q_rotate(q_conj(c->q), v3_sub(x, c->x));
    const double weight = fl_free_cone_weight(c, at.z, ra).weight;
    if (weight == 0.0) return 0;
    const fl_closest_point exact = fl_point_on_cone(c->r0, c->r1, c->h, at);
    q->d = (1.0 - weight) * q->d + weight * exact.d;
    q->n = v3_unit(v3_madd(v3_scale(1.0 - weight, q->n), weight, q_rotate(c->q, exact.n)));
    return 1;
}

#endif
