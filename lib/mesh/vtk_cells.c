/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "geom/facet.h"
#include "mesh/vtk_cells.h"

enum { STRIP = 6, POLYGON = 7, POLYLINE = 4, QUADRATIC_POLYGON = 36, POLYHEDRON = 42, TYPES = 82 };

/* Cells with a fixed number of nodes: shape, minimum number of nodes, and the order of the nodes if it
 * differs. */
static const struct {
    int8_t shape; /* plus one */
    uint8_t nodes;
    const char *order;
    int coarse;
} CELL[TYPES] = {
    [3] = {FL_LINE2 + 1, 2, NULL, 0},       [5] = {FL_TRI3 + 1, 3, NULL, 0},
    [8] = {FL_QUAD4 + 1, 4, "0132", 0},     [9] = {FL_QUAD4 + 1, 4, NULL, 0},
    [10] = {FL_TET4 + 1, 4, NULL, 0},       [11] = {FL_HEX8 + 1, 8, "01324576", 0},
    [12] = {FL_HEX8 + 1, 8, NULL, 0},       [13] = {FL_WEDGE6 + 1, 6, NULL, 0},
    [14] = {FL_PYRAMID5 + 1, 5, NULL, 0},   [21] = {FL_LINE3 + 1, 3, NULL, 0},
    [22] = {FL_TRI6 + 1, 6, NULL, 0},       [23] = {FL_QUAD8 + 1, 8, NULL, 0},
    [24] = {FL_TET10 + 1, 10, NULL, 0},     [25] = {FL_HEX20 + 1, 20, NULL, 0},
    [26] = {FL_WEDGE15 + 1, 15, NULL, 0},   [27] = {FL_PYRAMID13 + 1, 13, NULL, 0},
    [28] = {FL_QUAD9 + 1, 9, NULL, 0},      [29] = {FL_HEX20 + 1, 27, NULL, 0},
    [30] = {FL_QUAD4 + 1, 6, NULL, 1},      [31] = {FL_WEDGE6 + 1, 12, NULL, 1},
    [32] = {FL_WEDGE15 + 1, 18, NULL, 0},   [33] = {FL_HEX20 + 1, 24, NULL, 0},
    [34] = {FL_TRI6 + 1, 7, NULL, 0},       [35] = {FL_LINE2 + 1, 4, NULL, 1},
    [37] = {FL_PYRAMID13 + 1, 19, NULL, 0}, [68] = {FL_LINE2 + 1, 2, NULL, 1},
    [69] = {FL_TRI3 + 1, 3, NULL, 1},       [70] = {FL_QUAD4 + 1, 4, NULL, 1},
    [71] = {FL_TET4 + 1, 4, NULL, 1},       [72] = {FL_HEX8 + 1, 8, NULL, 1},
    [73] = {FL_WEDGE6 + 1, 6, NULL, 1},     [74] = {FL_PYRAMID5 + 1, 5, NULL, 1},
    [75] = {FL_LINE2 + 1, 2, NULL, 1},      [76] = {FL_TRI3 + 1, 3, NULL, 1},
    [77] = {FL_QUAD4 + 1, 4, NULL, 1},      [78] = {FL_TET4 + 1, 4, NULL, 1},
    [79] = {FL_HEX8 + 1, 8, NULL, 1},       [80] = {FL_WEDGE6 + 1, 6, NULL, 1},
    [81] = {FL_PYRAMID5 + 1, 5, NULL, 1},
};

const char *const FL_VTK_PART_ARRAYS[] = {
    "part",      "part_id",       "PartID",   "gmsh:physical", "cell_tags", "material", "MaterialIds",
    "medit:ref", "CellEntityIds", "GroupIds", "region",        "body",      NULL};

int fl_vtk_part_rank(const char *name)
{
    for (int k = 0; FL_VTK_PART_ARRAYS[k]; k++)
        if (strcasecmp(FL_VTK_PART_ARRAYS[k], name) == 0) return k;
    return -1;
}

int fl_vtk_names_add(fl_vtk_names *v, int64_t id, const char *name, fl_err *err)
{
    const int32_t k = fl_string_table_add(&v->name, name, err);
    if (k < 0 || fl_grow(&v->id, &v->cap, v->name.n, sizeof *v->id, err)) return -1;
    v->id[k] = id;
    return 0;
}

void fl_vtk_grid_free(fl_vtk_grid *g)
{
    free(g->point.x);
    free(g->corner.x);
    free(g->offset.x);
    free(g->type.x);
    free(g->face.x);
    free(g->face_last.x);
    free(g->part.x);
    *g = (fl_vtk_grid){0};
}

void fl_vtk_names_free(fl_vtk_names *v)
{
    fl_string_table_free(&v->name);
    free(v->id);
    *v = (fl_vtk_names){0};
}

/* A face of a solid, for the comparison with all others. */
typedef struct {
    int32_t cell, first, n; /* corners: corner[first .. first + n), then the same sorted */
} solid_face;

typedef struct {
    fl_elements *e;
    const fl_vtk_grid *g;
    int32_t scope, *coarse;
    int32_t part;     /* of the current cell, -1 before the first */
    double last_part; /* its number in the file */
    int64_t *node;    /* numbers of the nodes of the current cell */
    int32_t nodes, node_cap;
    fl_part pool; /* corners of a polygon */
    int32_t *loop, loop_cap;
    solid_face *face; /* of solids, if there are polyhedra */
    int32_t faces, face_cap;
    int32_t *corner; /* of these */
    int32_t corners, corner_cap;
} cell_adder;

static int64_t point_count(const cell_adder *a) { return a->g->point.n / 3; }

static int fail_cell(const cell_adder *a, int64_t cell, fl_err *err, const char *what, double x)
{
    return fl_elements_fail(a->e, a->e->file, 0, err, "cell %lld has %s %.17g", (long long)cell, what, x);
}

/* True for an integer in lo .. hi. */
static int is_integer(double x, double lo, double hi) { return x >= lo && x <= hi && x == floor(x); }

static int add_element(cell_adder *a, enum fl_shape shape, const int64_t *node, fl_err *err)
{
    return fl_elements_add(a->e, a->scope, -1, shape, a->part, node, err) < 0 ? -1 : 0;
}

static fl_vec3 point_at(const cell_adder *a, int64_t node)
{
    const double *x = a->g->point.x + 3 * (node - 1);
    return v3(x[0], x[1], x[2]);
}

/* Add a polygon of any number of corners. */
static int add_polygon(cell_adder *a, int32_t n, const int64_t *node, fl_err *err)
{
    if (n == 3 || n == 4) return add_element(a, n == 3 ? FL_TRI3 : FL_QUAD4, node, err);
    if (n < 3) return 0;
    if (n > FL_FACET_CORNERS)
        return fl_elements_fail(a->e, a->e->file, 0, err, "a polygon has %d corners, at most %d are expected",
                                n, FL_FACET_CORNERS);
    a->pool.nv = a->pool.nt = 0;
    if (fl_grow(&a->loop, &a->loop_cap, n, sizeof *a->loop, err)) return -1;
    for (int32_t k = 0; k < n; k++) {
        a->loop[k] = k;
        if (fl_surface_vertex(&a->pool, point_at(a, node[k]), err)) return -1;
    }
    if (fl_facet_polygon(&a->pool, n, a->loop, err)) return -1;
    for (int32_t t = 0; t < a->pool.nt; t++) {
        const int32_t *v = a->pool.t[t].v;
        if (add_element(a, FL_TRI3, (const int64_t[]){node[v[0]], node[v[1]], node[v[2]]}, err)) return -1;
    }
    return 0;
}

/* --- polyhedra ------------------------------------------------------------------------------------------ */

static int by_number(const void *pa, const void *pb)
{
    const int32_t x = *(const int32_t *)pa, y = *(const int32_t *)pb;
    return x < y ? -1 : x > y;
}

/* Store the face of a solid. */
static int store_face(cell_adder *a, int64_t cell, int32_t n, const int64_t *node, fl_err *err)
{
    int32_t *c;
    if (n < 3) return 0;
    if (fl_grow(&a->face, &a->face_cap, (int64_t)a->faces + 1, sizeof *a->face, err) ||
        fl_grow(&a->corner, &a->corner_cap, (int64_t)a->corners + 2 * (int64_t)n, sizeof *a->corner, err))
        return -1;
    a->face[a->faces++] = (solid_face){(int32_t)cell, a->corners, n};
    c = a->corner + a->corners;
    for (int32_t k = 0; k < n; k++) c[k] = c[n + k] = (int32_t)node[k];
    qsort(c + n, (size_t)n, sizeof *c, by_number);
    a->corners += 2 * n;
    return 0;
}

static int store_polyhedron(cell_adder *a, int64_t cell, fl_err *err)
{
    const fl_vtk_array *f = &a->g->face;
    const double last = cell < a->g->face_last.n ? a->g->face_last.x[cell] : -1.0;
    double from = 0.0;
    int64_t k, faces;
    for (k = cell - 1; k >= 0; k--)
        if (a->g->face_last.x[k] >= 0.0) {
            from = a->g->face_last.x[k];
            break;
        }
    if (!is_integer(last, from + 1.0, (double)f->n))
        return fail_cell(a, cell, err, "its faces end at place", last);
    k = (int64_t)from;
    if (!is_integer(f->x[k], 0.0, last)) return fail_cell(a, cell, err, "a number of faces of", f->x[k]);
    for (faces = (int64_t)f->x[k++]; faces > 0; faces--) {
        int32_t n;
        if (k >= (int64_t)last) return fail_cell(a, cell, err, "faces missing:", (double)faces);
        if (!is_integer(f->x[k], 0.0, last - (double)k - 1.0) || f->x[k] > FL_FACET_CORNERS)
            return fail_cell(a, cell, err, "a number of corners of", f->x[k]);
        n = (int32_t)f->x[k++];
        a->nodes = 0;
        if (fl_grow(&a->node, &a->node_cap, n, sizeof *a->node, err)) return -1;
        for (; a->nodes < n; k++) {
            if (!is_integer(f->x[k], 0.0, (double)point_count(a) - 1.0))
                return fail_cell(a, cell, err, "the point", f->x[k]);
            a->node[a->nodes++] = (int64_t)f->x[k] + 1;
        }
        if (store_face(a, cell, n, a->node, err)) return -1;
    }
    return 0;
}

static int store_solid(cell_adder *a, int64_t cell, enum fl_shape shape, const int64_t *node, fl_err *err)
{
    for (int f = 0; f < fl_shape_faces(shape); f++) {
        int place[4];
        int64_t corner[4];
        const int n = fl_shape_face(shape, f, place);
        for (int k = 0; k < n; k++) corner[k] = node[place[k]];
        if (store_face(a, cell, n, corner, err)) return -1;
    }
    return 0;
}

/* A face as a sort key: its sorted corners. */
typedef struct {
    const int32_t *key;
    int32_t n, face;
} face_key;

static int compare_keys(const void *pa, const void *pb)
{
    const face_key *x = pa, *y = pb;
    if (x->n != y->n) return x->n < y->n ? -1 : 1;
    for (int32_t k = 0; k < x->n; k++)
        if (x->key[k] != y->key[k]) return x->key[k] < y->key[k] ? -1 : 1;
    return x->face < y->face ? -1 : x->face > y->face;
}

static int same_key(const face_key *x, const face_key *y)
{
    return x->n == y->n && memcmp(x->key, y->key, (size_t)x->n * sizeof *x->key) == 0;
}

/* Set the part of a cell. */
static int set_part(cell_adder *a, int64_t cell, const fl_vtk_names *v, const char *name, fl_err *err)
{
    char text[80];
    double x;
    if (a->g->part.n == 0) {
        if (a->part >= 0) return 0;
        a->part = fl_string_table_add(&a->e->parts, name, err);
        return a->part < 0 ? -1 : 0;
    }
    x = a->g->part.x[cell];
    if (x == a->last_part) return 0; /* the cells of a part mostly follow one another */
    if (!is_integer(x, -1e15, 1e15)) return fail_cell(a, cell, err, "the part", x);
    a->last_part = x;
    for (int32_t k = 0; k < v->name.n; k++)
        if (v->id[k] == (int64_t)x) {
            a->part = fl_string_table_add(&a->e->parts, v->name.name[k], err);
            return a->part < 0 ? -1 : 0;
        }
    snprintf(text, sizeof text, "%s_%lld", a->g->part_word, (long long)x);
    a->part = fl_string_table_add(&a->e->parts, text, err);
    return a->part < 0 ? -1 : 0;
}

/* Orient a face away from the mean of the corners of its cell. */
static void turn_outward(const cell_adder *a, const fl_vec3 *mean, int32_t n, int64_t *node)
{
    fl_vec3 area = {0};
    for (int32_t k = 1; k + 1 < n; k++)
        area = v3_add(area, v3_cross(v3_sub(point_at(a, node[k]), point_at(a, node[0])),
                                     v3_sub(point_at(a, node[k + 1]), point_at(a, node[0]))));
    if (v3_dot(area, v3_sub(point_at(a, node[0]), *mean)) >= 0.0) return;
    for (int32_t k = 0; k < n / 2; k++) {
        const int64_t other = node[k];
        node[k] = node[n - 1 - k];
        node[n - 1 - k] = other;
    }
}

static int add_free_faces(cell_adder *a, const fl_vtk_names *v, const char *name, fl_err *err)
{
    face_key *s = fl_alloc(a->faces, sizeof *s, err);
    char *is_free = fl_alloc(a->faces, 1, err);
    fl_vec3 mean = {0};
    int rc = -1;
    if (!s || !is_free) goto done;
    for (int32_t i = 0; i < a->faces; i++)
        s[i] = (face_key){a->corner + a->face[i].first + a->face[i].n, a->face[i].n, i};
    qsort(s, (size_t)a->faces, sizeof *s, compare_keys);
    for (int32_t i = 0, j; i < a->faces; i = j) {
        for (j = i + 1; j < a->faces && same_key(&s[i], &s[j]); j++) {}
        is_free[s[i].face] = j == i + 1;
    }
    for (int32_t i = 0, end; i < a->faces; i = end) { /* the faces of a cell follow one another */
        double corners = 0.0;
        mean = v3(0.0, 0.0, 0.0);
        for (end = i; end < a->faces && a->face[end].cell == a->face[i].cell; end++)
            for (int32_t k = 0; k < a->face[end].n; k++, corners += 1.0)
                mean = v3_add(mean, point_at(a, a->corner[a->face[end].first + k]));
        mean = v3_scale(1.0 / corners, mean);
        if (set_part(a, a->face[i].cell, v, name, err)) goto done;
        for (int32_t f = i; f < end; f++) {
            if (!is_free[f]) continue;
            if (fl_grow(&a->node, &a->node_cap, a->face[f].n, sizeof *a->node, err)) goto done;
            for (int32_t k = 0; k < a->face[f].n; k++) a->node[k] = a->corner[a->face[f].first + k];
            turn_outward(a, &mean, a->face[f].n, a->node);
            if (add_polygon(a, a->face[f].n, a->node, err)) goto done;
        }
    }
    rc = 0;
done:
    free(s);
    free(is_free);
    return rc;
}

/* --- cells ---------------------------------------------------------------------------------------------- */

/* Read the nodes of a cell. */
static int read_nodes(cell_adder *a, int64_t cell, fl_err *err)
{
    const double from = cell ? a->g->offset.x[cell - 1] : 0.0, to = a->g->offset.x[cell];
    if (!is_integer(to, from, (double)a->g->corner.n) || to - from > INT32_MAX / 2)
        return fail_cell(a, cell, err, "corners up to place", to);
    a->nodes = 0;
    if (fl_grow(&a->node, &a->node_cap, (int64_t)(to - from), sizeof *a->node, err)) return -1;
    for (int64_t k = (int64_t)from; k < (int64_t)to; k++) {
        const double x = a->g->corner.x[k];
        if (!is_integer(x, 0.0, (double)point_count(a) - 1.0))
            return fl_elements_fail(a->e, a->e->file, 0, err,
                                    "cell %lld refers to point %.17g, 0 to %lld is expected", (long long)cell,
                                    x, (long long)point_count(a) - 1);
        a->node[a->nodes++] = (int64_t)x + 1;
    }
    return 0;
}

static int add_strip(cell_adder *a, fl_err *err)
{
    for (int32_t k = 0; k + 2 < a->nodes; k++) {
        const int64_t tri[3] = {a->node[k], a->node[k + 1 + k % 2], a->node[k + 2 - k % 2]};
        if (add_element(a, FL_TRI3, tri, err)) return -1;
    }
    return 0;
}

static int add_polyline(cell_adder *a, fl_err *err)
{
    for (int32_t k = 0; k + 1 < a->nodes; k++)
        if (add_element(a, FL_LINE2, a->node + k, err)) return -1;
    return 0;
}

static int add_cell(cell_adder *a, int64_t cell, int polyhedra, fl_err *err)
{
    const double t = a->g->type.x[cell];
    const int type = is_integer(t, 0.0, TYPES - 1.0) ? (int)t : 0;
    char text[40];
    int64_t node[20];
    enum fl_shape shape;
    if (read_nodes(a, cell, err)) return -1;
    if (type == POLYHEDRON) return store_polyhedron(a, cell, err);
    if (type == STRIP) return add_strip(a, err);
    if (type == POLYGON) return add_polygon(a, a->nodes, a->node, err);
    if (type == POLYLINE) return add_polyline(a, err);
    if (type == QUADRATIC_POLYGON) {
        ++*a->coarse;
        return add_polygon(a, a->nodes / 2, a->node, err);
    }
    if (CELL[type].shape == 0) {
        if (type == 1 || type == 2) snprintf(text, sizeof text, "vertex");
        else snprintf(text, sizeof text, "VTK type %.17g", t);
        return fl_elements_skip(a->e, text, err);
    }
    if (a->nodes < CELL[type].nodes || (a->nodes > CELL[type].nodes && type < 68))
        return fl_elements_fail(a->e, a->e->file, 0, err,
                                "cell %lld of type %d has %d nodes, %d are expected", (long long)cell, type,
                                (int)a->nodes, CELL[type].nodes);
    shape = (enum fl_shape)(CELL[type].shape - 1);
    *a->coarse += CELL[type].coarse;
    for (int k = 0; k < fl_shape_nodes(shape); k++)
        node[k] = a->node[CELL[type].order ? CELL[type].order[k] - '0' : k];
    if (polyhedra && fl_shape_faces(shape)) return store_solid(a, cell, shape, node, err);
    return add_element(a, shape, node, err);
}

static int add_points(cell_adder *a, fl_err *err)
{
    if (a->g->point.n % 3 || point_count(a) > INT32_MAX - 1)
        return fl_elements_fail(a->e, a->e->file, 0, err, "%lld coordinates are not three for each point",
                                (long long)a->g->point.n);
    for (int64_t k = 1; k <= point_count(a); k++)
        if (fl_elements_add_node(a->e, a->scope, k, point_at(a, k), err) < 0) return -1;
    return 0;
}

int fl_vtk_add_cells(fl_elements *e, const fl_vtk_grid *g, int32_t scope, const fl_vtk_names *v,
                     const char *name, int32_t *coarse, fl_err *err)
{
    cell_adder a = {.e = e, .g = g, .scope = scope, .coarse = coarse, .part = -1, .last_part = NAN};
    int polyhedra = 0, rc = -1;
    e->line = 0;
    if (g->type.n != g->offset.n || (g->part.n && g->part.n != g->type.n))
        return fl_elements_fail(e, e->file, 0, err, "%lld types, %lld offsets and %lld parts of cells",
                                (long long)g->type.n, (long long)g->offset.n, (long long)g->part.n);
    if (add_points(&a, err)) return -1;
    for (int64_t c = 0; c < g->type.n; c++) polyhedra |= g->type.x[c] == (double)POLYHEDRON;
    if (polyhedra && (g->face_last.n != g->type.n || g->type.n > INT32_MAX))
        return fl_elements_fail(e, e->file, 0, err, "%lld of %lld cells have a place for their faces",
                                (long long)g->face_last.n, (long long)g->type.n);
    for (int64_t c = 0; c < g->type.n; c++)
        if (set_part(&a, c, v, name, err) || add_cell(&a, c, polyhedra, err)) goto done;
    rc = polyhedra ? add_free_faces(&a, v, name, err) : 0;
done:
    free(a.node);
    free(a.loop);
    free(a.face);
    free(a.corner);
    fl_part_free(&a.pool);
    return rc;
}
