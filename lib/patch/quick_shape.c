/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/quick_shape.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/simd.h"
#include "patch/patch_law.h"

/* Arrays one behind the other; sizes are multiples of 8. */
typedef struct {
    size_t vertex, weight, edge, face, side, corner, plane, loop, all;
} block_layout;

static block_layout layout_of(const fl_quick_shape *s)
{
    block_layout b = {0};
    b.weight = (size_t)s->vertices * sizeof *s->vertex;
    b.edge = b.weight + (size_t)s->vertices * sizeof *s->weight;
    b.face = b.edge + (size_t)s->edges * sizeof *s->edge;
    b.side = b.face + (size_t)s->faces * sizeof *s->face;
    b.corner = b.side + (size_t)s->loops * sizeof *s->side;
    b.plane = b.corner + 3 * (size_t)(s->loops + FL_SIMD_WIDTH) * sizeof **s->corner;
    b.loop = b.plane + 4 * (size_t)s->planes * sizeof **s->plane;
    b.all = b.loop + (size_t)s->loops * sizeof *s->loop;
    return b;
}

/* Plane, axes and sides of face f; the axes turn with its first side. */
static void make_face(fl_quick_shape *s, const fl_poly *p, int32_t f)
{
    fl_quick_face *const to = &s->face[f];
    const int32_t first = p->first[f], n = p->first[f + 1] - first;
    const int32_t *loop = p->loop + first;
    *to = (fl_quick_face){.n = p->n[f],
                          .area = v3_norm(fl_poly_face_area_vector(p, f)),
                          .height = v3_dot(p->n[f], p->v[loop[0]]),
                          .first = first,
                          .sides = n};
    const fl_vec3 x = v3_sub(p->v[loop[1]], p->v[loop[0]]);
    to->t1 = v3_unit(v3_madd(x, -v3_dot(x, to->n), to->n));
    to->t2 = v3_cross(to->n, to->t1);
    for (int32_t k = 0; k < n; k++) {
        const fl_vec3 a = p->v[loop[k]], b = p->v[loop[k + 1 < n ? k + 1 : 0]];
        fl_quick_side *const side = &s->side[first + k];
        const fl_vec3 mirrored = p->v[loop[n - 1 - k]];
        s->loop[first + k] = loop[k];
        s->corner[0][first + k] = mirrored.x, s->corner[1][first + k] = mirrored.y;
        s->corner[2][first + k] = mirrored.z;
        side->q = v3_unit(v3_cross(v3_sub(b, a), to->n));
        side->qx = v3_dot(side->q, to->t1), side->qy = v3_dot(side->q, to->t2);
        side->c = fmax(v3_dot(side->q, a), v3_dot(side->q, b));
    }
}

/* Width by which the sides of face f are moved inward. */
static double inset_of(const fl_quick_shape *s, const fl_quick_face *f)
{
    double width = FL_QUICK_INSET * s->radius;
    for (int32_t k = 0; k < f->sides; k++) {
        const fl_quick_side *side = s->side + f->first;
        const fl_vec3 before = side[k > 0 ? k - 1 : f->sides - 1].q, q = side[k].q,
                      after = side[k + 1 < f->sides ? k + 1 : 0].q;
        const int32_t *loop = s->loop + f->first;
        const double l = v3_norm(v3_sub(s->vertex[loop[k + 1 < f->sides ? k + 1 : 0]], s->vertex[loop[k]]));
        const double ta = v3_norm(v3_cross(before, q)) / (1.0 + v3_dot(before, q)),
                     tb = v3_norm(v3_cross(q, after)) / (1.0 + v3_dot(q, after));
        width = fmin(width, FL_QUICK_INSET_SHARE * l / (ta + tb));
    }
    return width > 0.0 ? width : 0.0;
}

int fl_quick_shape_make(fl_quick_shape *s, const fl_poly *p, double radius, fl_err *err)
{
    *s = (fl_quick_shape){
        .vertices = p->nv, .edges = p->ne, .faces = p->nf, .loops = p->first[p->nf], .radius = radius};
    s->planes = (p->nf + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH * FL_SIMD_WIDTH;
    const block_layout b = layout_of(s);
    char *const at = fl_alloc((int64_t)b.all, 1, err);
    if (!at) return -1;
    s->block = at;
    s->vertex = (fl_vec3 *)(void *)at, s->weight = (double *)(void *)(at + b.weight);
    s->edge = (fl_quick_edge *)(void *)(at + b.edge), s->face = (fl_quick_face *)(void *)(at + b.face);
    s->side = (fl_quick_side *)(void *)(at + b.side), s->loop = (int32_t *)(void *)(at + b.loop);
    for (int c = 0; c < 3; c++)
        s->corner[c] = (double *)(void *)(at + b.corner) + c * (s->loops + FL_SIMD_WIDTH);
    for (int c = 0; c < 4; c++) s->plane[c] = (double *)(void *)(at + b.plane) + c * s->planes;
    for (int32_t v = 0; v < p->nv; v++) {
        s->vertex[v] = p->v[v];
        s->weight[v] = fmin(1.0, FL_PATCH_CORNER_WEIGHT * fl_poly_corner_angle(p, v));
        s->bound = fmax(s->bound, v3_norm(p->v[v]));
    }
    for (int32_t f = 0; f < p->nf; f++) make_face(s, p, f);
    for (int32_t f = 0; f < s->planes; f++) {
        const fl_quick_face *face = f < p->nf ? &s->face[f] : NULL;
        s->plane[0][f] = face ? face->n.x : 0.0, s->plane[1][f] = face ? face->n.y : 0.0;
        s->plane[2][f] = face ? face->n.z : 0.0, s->plane[3][f] = face ? face->height : INFINITY;
    }
    for (int32_t f = 0; f < p->nf; f++) {
        const double width = inset_of(s, &s->face[f]);
        for (int32_t k = 0; k < s->face[f].sides; k++) {
            fl_quick_side *const side = &s->side[s->face[f].first + k];
            side->inset_c = side->c - width;
        }
    }
    for (int32_t e = 0; e < p->ne; e++) {
        const fl_edge from = p->edge[e];
        const fl_vec3 along = v3_sub(p->v[from.b], p->v[from.a]);
        s->edge[e] = (fl_quick_edge){.a = p->v[from.a],
                                     .d = v3_unit(along),
                                     .length = v3_norm(along),
                                     .weight = fmin(1.0, FL_PATCH_EDGE_WEIGHT * fl_poly_edge_angle(p, e)),
                                     .face = {from.left, from.right},
                                     .end = {from.a, from.b}};
    }
    return 0;
}

double fl_quick_shape_bytes(const fl_quick_shape *s)
{
    return (double)(sizeof *s + (s->block ? layout_of(s).all : 0));
}

void fl_quick_shape_free(fl_quick_shape *s)
{
    free(s->block);
    *s = (fl_quick_shape){0};
}
