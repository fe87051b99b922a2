/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "geom/facet.h"
#include "support/model.h"

enum { NX = 3, NY = 2, NZ = 3 }; /* cells of the box that the L lies in */

/* Is the cell in the body?  The leg stands under one end of the deck. */
static int is_filled(int i, int j, int k)
{
    (void)j;
    return k == NZ - 1 || i == 0;
}

/* No face of a cell is a rectangle, so that it never has two diagonals of one length. */
static fl_vec3 node_position(double i, double j, double k)
{
    const double x = 1.5 * i + 0.25 * i * (i > 1.0), y = j + 0.125 * i, z = 0.75 * k + 0.0625 * j + 0.125 * i;
    return v3(x, y, z);
}

/* Number of the node at that position of the half-grid. */
static int64_t node_at(model *m, int i, int j, int k)
{
    const int64_t id = 7 + 10 * (((int64_t)(2 * NZ - k) * (2 * NY + 1) + j) * (2 * NX + 1) + i);
    for (int32_t n = 0; n < m->nodes; n++)
        if (m->id[n] == id) return id;
    m->id[m->nodes] = id;
    m->x[m->nodes++] = node_position(0.5 * i, 0.5 * j, 0.5 * k);
    return id;
}

static const int CORNER[8][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0},
                                 {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}};

/* The elements of a cell, by its corners (8 is its centre).  Wedges and tetrahedra divide every cell in the
 * same way, along diagonals that neighbours share. */
static const char *const HEX[] = {"01234567", NULL};
static const char *const WEDGE[] = {"012456", "023467", NULL};
static const char *const TET[] = {"0126", "0236", "0376", "0746", "0456", "0516", NULL};
static const char *const PYRAMID[] = {"01238", "47658", "04518", "15628", "26738", "37408", NULL};

/* Pairs of corners between which the mid-side nodes lie. */
static const char *mid_side_corners(enum fl_shape shape)
{
    if (shape == FL_TET10) return "011220031323";
    if (shape == FL_WEDGE15) return "011220344553031425";
    return shape == FL_HEX20 ? "011223304556677404152637" : "";
}

static void add_cell_elements(model *m, enum fl_shape shape, int i, int j, int k)
{
    const char *const *piece = shape == FL_WEDGE6 || shape == FL_WEDGE15 ? WEDGE
                               : shape == FL_TET4 || shape == FL_TET10   ? TET
                               : shape == FL_PYRAMID5                    ? PYRAMID
                                                                         : HEX;
    for (; *piece; piece++) {
        model_element *e = &m->e[m->elements++];
        int at[8][3], n = 0;
        e->shape = shape;
        e->part = k == NZ - 1;
        e->id = 1000 - 3 * m->elements;
        for (const char *c = *piece; *c; c++, n++)
            for (int d = 0; d < 3; d++)
                at[n][d] = 2 * (d == 0 ? i : d == 1 ? j : k) + (*c == '8' ? 1 : CORNER[*c - '0'][d]);
        for (int c = 0; c < n; c++) e->node[c] = node_at(m, at[c][0], at[c][1], at[c][2]);
        for (const char *p = mid_side_corners(shape); *p; p += 2, n++) {
            const int *a = at[p[0] - '0'], *b = at[p[1] - '0'];
            e->node[n] = node_at(m, (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2);
        }
    }
}

/* A face by its nodes, outward, and its part. */
typedef struct {
    int n;
    int32_t part;
    int64_t node[4];
} face;

static int same_nodes(const face *a, const face *b)
{
    int met = 0;
    if (a->n != b->n) return 0;
    for (int i = 0; i < a->n; i++)
        for (int j = 0; j < b->n; j++) met += a->node[i] == b->node[j];
    return met == a->n;
}

static int32_t outer_faces(const model *m, face *f)
{
    int32_t n = 0, kept = 0;
    static face all[MODEL_ELEMENTS * 6];
    for (int32_t i = 0; i < m->elements; i++) {
        const model_element *e = &m->e[i];
        const int faces = fl_shape_faces(e->shape);
        for (int k = 0; k < (faces ? faces : 1); k++) {
            int place_of[4] = {0, 1, 2, 3};
            face *g = &all[n++];
            g->n = faces ? fl_shape_face(e->shape, k, place_of) : fl_shape_corners(e->shape);
            g->part = e->part;
            /* the faces of a solid are listed inward */
            for (int c = 0; c < g->n; c++) g->node[c] = e->node[place_of[faces ? g->n - 1 - c : c]];
        }
    }
    for (int32_t i = 0; i < n; i++) {
        int met = 0;
        for (int32_t j = 0; j < n; j++) met += j != i && same_nodes(&all[i], &all[j]);
        if (!met) f[kept++] = all[i];
    }
    return kept;
}

void model_make(model *m, enum fl_shape shape)
{
    static face f[MODEL_ELEMENTS * 6];
    const enum fl_shape solid = shape == FL_QUAD4 ? FL_HEX8 : shape == FL_TRI3 ? FL_TET4 : shape;
    int32_t n;
    *m = (model){.part = {"leg", "deck"}};
    for (int k = 0; k < NZ; k++)
        for (int j = 0; j < NY; j++)
            for (int i = 0; i < NX; i++)
                if (is_filled(i, j, k)) add_cell_elements(m, solid, i, j, k);
    if (solid == shape) return;
    n = outer_faces(m, f);
    m->elements = 0;
    for (int32_t i = 0; i < n; i++) {
        model_element *e = &m->e[m->elements++];
        *e = (model_element){.shape = shape, .part = f[i].part, .id = 1000 - 3 * m->elements};
        memcpy(e->node, f[i].node, sizeof f[i].node);
    }
}

static fl_vec3 position_of(const model *m, int64_t id)
{
    for (int32_t n = 0; n < m->nodes; n++)
        if (m->id[n] == id) return m->x[n];
    abort();
}

void model_surface(const model *m, fl_surface *s)
{
    static face f[MODEL_ELEMENTS * 6];
    fl_err err = {0};
    const int32_t n = outer_faces(m, f);
    for (int32_t p = 0; p < MODEL_PARTS; p++) fl_surface_add(s, m->part[p], strlen(m->part[p]), &err);
    for (int32_t i = 0; i < n; i++) {
        fl_part *p = &s->part[f[i].part];
        int32_t loop[4];
        for (int c = 0; c < f[i].n; c++) {
            loop[c] = p->nv;
            fl_surface_vertex(p, position_of(m, f[i].node[c]), &err);
        }
        fl_facet_polygon(p, f[i].n, loop, &err);
    }
    if (err.code) abort();
}

typedef struct {
    double x[9];
} corners;

static int by_corners(const void *pa, const void *pb)
{
    const corners *a = pa, *b = pb;
    for (int k = 0; k < 9; k++)
        if (a->x[k] != b->x[k]) return a->x[k] < b->x[k] ? -1 : 1;
    return 0;
}

static corners *sorted_corners(const fl_part *p)
{
    corners *c = calloc((size_t)p->nt + 1, sizeof *c);
    if (!c) abort();
    for (int32_t t = 0; t < p->nt; t++) {
        corners best = {{0}};
        for (int first = 0; first < 3; first++) {
            corners one;
            for (int k = 0; k < 3; k++) {
                const fl_vec3 x = p->v[p->t[t].v[(first + k) % 3]];
                one.x[3 * k] = x.x;
                one.x[3 * k + 1] = x.y;
                one.x[3 * k + 2] = x.z;
            }
            if (first == 0 || by_corners(&one, &best) < 0) best = one;
        }
        c[t] = best;
    }
    qsort(c, (size_t)p->nt, sizeof *c, by_corners);
    return c;
}

int model_same(const fl_surface *a, const fl_surface *b)
{
    if (a->n != b->n) return 0;
    for (int32_t i = 0; i < a->n; i++) {
        const fl_part *p = &a->part[i];
        const int32_t k = fl_surface_find(b, p->name, strlen(p->name));
        corners *c, *d;
        int same;
        if (k < 0 || b->part[k].nt != p->nt) return 0;
        c = sorted_corners(p);
        d = sorted_corners(&b->part[k]);
        same = 1;
        for (int32_t t = 0; t < p->nt; t++) same &= by_corners(&c[t], &d[t]) == 0;
        free(c);
        free(d);
        if (!same) return 0;
    }
    return 1;
}
