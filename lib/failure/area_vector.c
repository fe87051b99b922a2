/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "failure/area_vector.h"
#include <math.h>
#include <string.h>
#include "failure/cone_area.h"

enum { CORNERS = 96 };

/* Clips a convex polygon by all half-spaces but number `but`; returns its number of corners. */
static int clip_polygon(const fl_half_spaces *a, int but, fl_vec3 *v, int n)
{
    fl_vec3 other[CORNERS], *from = v, *to = other;
    for (int k = 0; k < a->n && n > 0; k++) {
        int m = 0;
        if (k == but) continue;
        double last = v3_dot(a->normal[k], from[n - 1]) - a->c[k];
        for (int e = 0; e < n; e++) {
            const double now = v3_dot(a->normal[k], from[e]) - a->c[k];
            const fl_vec3 before = from[e ? e - 1 : n - 1];
            if ((now > 0.0) != (last > 0.0) && m < CORNERS)
                to[m++] = v3_lerp(before, from[e], last / (last - now));
            if (now <= 0.0 && m < CORNERS) to[m++] = from[e];
            last = now;
        }
        n = m;
        fl_vec3 *const swap = from;
        from = to, to = swap;
    }
    if (from != v && n > 0) memcpy(v, from, (size_t)n * sizeof *v);
    return n;
}

/* Faces of a body that are along a direction up to this sine do not face it. */
#define ASIDE 1e-9
/* S and all that is closed are told apart at this share of the area. */
#define CLOSED 1e-6
/* What faces up or down by more than this share is a floor. */
#define FLAT 0.99

typedef struct {
    fl_vec3 S;
    double area;
    fl_vec3 facing; /* what does not face this is left out; 0: nothing is */
} area_sum;

static void add_polygon(area_sum *q, const fl_vec3 *v, int n)
{
    fl_vec3 S = v3(0, 0, 0);
    for (int k = 1; k + 1 < n; k++) S = v3_add(S, v3_cross(v3_sub(v[k], v[0]), v3_sub(v[k + 1], v[0])));
    if (v3_dot(S, q->facing) < 0.0) return;
    q->S = v3_madd(q->S, 0.5, S);
    q->area += 0.5 * v3_norm(S);
}

/* Adds face f of p. */
static void add_face(area_sum *q, const fl_half_spaces *a, const fl_poly *p, int32_t f)
{
    fl_vec3 v[CORNERS];
    const int32_t n = p->first[f + 1] - p->first[f];
    if (n > CORNERS / 2) { /* a fan of triangles */
        for (int32_t k = 1; k + 1 < n; k++) {
            const int32_t *l = &p->loop[p->first[f]];
            v[0] = p->v[l[0]], v[1] = p->v[l[k]], v[2] = p->v[l[k + 1]];
            add_polygon(q, v, clip_polygon(a, -1, v, 3));
        }
        return;
    }
    for (int32_t k = 0; k < n; k++) v[k] = p->v[p->loop[p->first[f] + k]];
    add_polygon(q, v, clip_polygon(a, -1, v, n));
}

/* Adds the faces of a mesh whose boxes overlap that of a. */
static void add_mesh(area_sum *q, const fl_half_spaces *a, const fl_piece *piece)
{
    const fl_bvh *t = &piece->mesh.tree;
    int32_t stack[2 * FL_BVH_STACK], top = 0;
    if (t->nodes) stack[top++] = 0;
    while (top > 0) {
        const fl_bvh_node *node = &t->node[stack[--top]];
        if (!aabb_overlap(node->box, a->box)) continue;
        if (node->count == 0) {
            stack[top++] = node->first + 1;
            stack[top++] = node->first;
            continue;
        }
        for (int32_t k = node->first; k < node->first + node->count; k++)
            if (aabb_overlap(piece->mesh.box[t->order[k]], a->box)) add_face(q, a, &piece->core, t->order[k]);
    }
}

/* True if the box of face f overlaps that of a. */
static int face_is_near(const fl_half_spaces *a, const fl_poly *p, int32_t f)
{
    fl_aabb box = aabb_empty();
    for (int32_t k = p->first[f]; k < p->first[f + 1]; k++) box = aabb_add(box, p->v[p->loop[k]]);
    return aabb_overlap(box, a->box);
}

static area_sum sum_of_piece(const fl_half_spaces *a, const fl_piece *piece, fl_vec3 facing)
{
    area_sum q = {.facing = facing};
    if (piece->kind == FL_PIECE_CONE) q.S = fl_cone_area_vector(a, piece, facing, &q.area);
    else if (piece->kind == FL_PIECE_MESH) add_mesh(&q, a, piece);
    else if (piece->kind == FL_PIECE_SOLID)
        for (int32_t f = 0; f < piece->core.nf; f++)
            if (face_is_near(a, &piece->core, f)) add_face(&q, a, &piece->core, f);
    return q;
}

fl_vec3 fl_area_vector_of_piece(const fl_half_spaces *a, const fl_piece *piece, fl_vec3 facing)
{
    return sum_of_piece(a, piece, facing).S;
}

int fl_area_is_closed(const fl_half_spaces *a, const fl_piece *piece, fl_vec3 across)
{
    const area_sum q = sum_of_piece(a, piece, v3(0, 0, 0));
    const double along = v3_dot(q.S, across);
    return q.area > 0.0 && fabs(along) < FLAT * q.area &&
           v3_norm(v3_madd(q.S, -along, across)) <= CLOSED * q.area;
}

fl_vec3 fl_area_vector_of_body(const fl_half_spaces *a, const fl_half_spaces *b, fl_vec3 facing)
{
    const double size = v3_norm(v3_sub(b->box.hi, b->box.lo));
    const fl_vec3 middle = v3_scale(0.5, v3_add(b->box.lo, b->box.hi));
    area_sum q = {.S = {0, 0, 0}};
    for (int f = 0; f < b->n; f++) {
        if (!(v3_dot(b->normal[f], facing) > ASIDE)) continue;
        /* a square in the plane of the face, clipped by the other planes of B: a face of the sharp shape */
        const fl_vec3 n = b->normal[f], x = v3_unit(fabs(n.x) < 0.7 ? v3(0, n.z, -n.y) : v3(-n.z, 0, n.x)),
                      y = v3_cross(n, x), m = v3_madd(middle, b->c[f] - v3_dot(n, middle), n);
        fl_vec3 v[CORNERS] = {v3_madd(v3_madd(m, size, x), size, y), v3_madd(v3_madd(m, -size, x), size, y),
                              v3_madd(v3_madd(m, -size, x), -size, y),
                              v3_madd(v3_madd(m, size, x), -size, y)};
        const int corners = clip_polygon(b, f, v, 4);
        if (corners > 2) add_polygon(&q, v, clip_polygon(a, -1, v, corners));
    }
    return q.S;
}
