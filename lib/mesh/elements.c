/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "mesh/elements.h"

static const struct {
    const char *name;
    int8_t corners, nodes, faces;
    const char *face[6]; /* corners of each face, as digits */
} SHAPE[FL_SHAPES] = {
    [FL_LINE2] = {"line2", 2, 2, 0, {0}},
    [FL_LINE3] = {"line3", 2, 3, 0, {0}},
    [FL_TRI3] = {"tri3", 3, 3, 0, {0}},
    [FL_TRI6] = {"tri6", 3, 6, 0, {0}},
    [FL_QUAD4] = {"quad4", 4, 4, 0, {0}},
    [FL_QUAD8] = {"quad8", 4, 8, 0, {0}},
    [FL_QUAD9] = {"quad9", 4, 9, 0, {0}},
    [FL_TET4] = {"tet4", 4, 4, 4, {"012", "031", "132", "230"}},
    [FL_TET10] = {"tet10", 4, 10, 4, {"012", "031", "132", "230"}},
    [FL_PYRAMID5] = {"pyramid5", 5, 5, 5, {"0123", "041", "142", "243", "340"}},
    [FL_PYRAMID13] = {"pyramid13", 5, 13, 5, {"0123", "041", "142", "243", "340"}},
    [FL_WEDGE6] = {"wedge6", 6, 6, 5, {"012", "354", "0341", "1452", "2530"}},
    [FL_WEDGE15] = {"wedge15", 6, 15, 5, {"012", "354", "0341", "1452", "2530"}},
    [FL_HEX8] = {"hex8", 8, 8, 6, {"0123", "4765", "0451", "1562", "2673", "3740"}},
    [FL_HEX20] = {"hex20", 8, 20, 6, {"0123", "4765", "0451", "1562", "2673", "3740"}},
};

const char *fl_shape_name(enum fl_shape shape) { return SHAPE[shape].name; }
int fl_shape_nodes(enum fl_shape shape) { return SHAPE[shape].nodes; }
int fl_shape_corners(enum fl_shape shape) { return SHAPE[shape].corners; }
int fl_shape_faces(enum fl_shape shape) { return SHAPE[shape].faces; }

int fl_shape_face(enum fl_shape shape, int face, int corner[4])
{
    const char *digit = SHAPE[shape].face[face];
    int n = 0;
    for (; digit[n]; n++) corner[n] = digit[n] - '0';
    return n;
}

int fl_elements_start(fl_elements *e, const char *file, fl_err *err)
{
    *e = (fl_elements){0};
    if (fl_elements_set_file(e, file, err) == 0) return 0;
    fl_elements_free(e);
    return -1;
}

int fl_elements_set_file(fl_elements *e, const char *file, fl_err *err)
{
    const int32_t k = fl_string_table_add(&e->files, file, err);
    if (k < 0) return -1;
    e->file = k;
    return 0;
}

int fl_elements_fail(const fl_elements *e, int32_t file, int32_t line, fl_err *err, const char *fmt, ...)
{
    char what[400];
    va_list ap;
    va_start(ap, fmt);
    vsnprintf(what, sizeof what, fmt, ap);
    va_end(ap);
    if (line) return fl_fail(err, FL_INPUT, "%s:%d: %s", e->files.name[file], line, what);
    return fl_fail(err, FL_INPUT, "%s: %s", e->files.name[file], what);
}

/* Index of a node, which is added if new. */
static int32_t add_node_id(fl_elements *e, int32_t scope, int64_t id, fl_err *err)
{
    const int32_t k = fl_id_map_add(&e->node_id, scope, id, err), had = k < 0 ? 0 : e->node_id.n;
    if (k < 0 || fl_grow(&e->x, &e->x_cap, had, sizeof *e->x, err)) return -1;
    return k;
}

/* Index of a node that an element uses; a new node has no position yet. */
static int32_t refer_to_node(fl_elements *e, int32_t scope, int64_t id, fl_err *err)
{
    const int32_t before = e->node_id.n, k = add_node_id(e, scope, id, err);
    if (k >= before) e->x[k] = v3(NAN, NAN, NAN);
    return k;
}

int32_t fl_elements_add_node(fl_elements *e, int32_t scope, int64_t id, fl_vec3 x, fl_err *err)
{
    const int32_t had = e->node_id.n;
    int32_t k;
    if (!isfinite(x.x) || !isfinite(x.y) || !isfinite(x.z))
        return fl_elements_fail(e, e->file, e->line, err,
                                "node %lld is at %g %g %g, finite coordinates are expected", (long long)id,
                                x.x, x.y, x.z);
    k = add_node_id(e, scope, id, err);
    if (k < 0) return -1;
    if (k < had && !isnan(e->x[k].x) && v3_norm2(v3_sub(e->x[k], x)) > 0.0) e->moved++;
    e->x[k] = x;
    return k;
}

/* A mid-side node that repeats a corner stands for an omitted one, as archives write it. */
static void drop_repeated_mids(enum fl_shape shape, int32_t *node)
{
    for (int i = SHAPE[shape].corners; i < SHAPE[shape].nodes; i++)
        for (int c = 0; c < SHAPE[shape].corners; c++)
            if (node[i] == node[c]) node[i] = -1;
}

int32_t fl_elements_add(fl_elements *e, int32_t scope, int64_t id, enum fl_shape shape, int32_t part,
                        const int64_t *node, fl_err *err)
{
    const int n = SHAPE[shape].nodes;
    const int32_t first = e->connectivity_n, had = e->element_id.n;
    int32_t k;
    if (fl_grow(&e->connectivity, &e->connectivity_cap, (int64_t)first + n, sizeof *e->connectivity, err) ||
        fl_grow(&e->element, &e->element_cap, (int64_t)e->element_id.n + 1, sizeof *e->element, err))
        return -1;
    for (int i = 0; i < n; i++) {
        if (node[i] < 1 && i < SHAPE[shape].corners)
            return fl_elements_fail(
                e, e->file, e->line, err,
                "corner %d of the element is node %lld, a number of 1 or more is expected", i + 1,
                (long long)node[i]);
        k = node[i] < 1 ? -1 : refer_to_node(e, scope, node[i], err);
        if (k < 0 && node[i] >= 1) return -1;
        e->connectivity[first + i] = k;
    }
    drop_repeated_mids(shape, e->connectivity + first);
    /* an element without a number gets one that no file can refer to */
    k = id < 0 ? fl_id_map_add(&e->element_id, -1, e->element_id.n, err)
               : fl_id_map_add(&e->element_id, scope, id, err);
    if (k < 0) return -1;
    e->connectivity_n += n;
    e->replaced += k < had;
    e->element[k] = (fl_element){first, part, -1, e->line, e->file, (uint8_t)shape};
    return k;
}

int fl_elements_set_radius(fl_elements *e, int32_t element, double r0, double r1, fl_err *err)
{
    const int32_t k = e->sections;
    /* the elements of a set follow one another with the same radii */
    if (k && e->section[k - 1][0] == r0 && e->section[k - 1][1] == r1) {
        e->element[element].section = k - 1;
        return 0;
    }
    if (fl_grow(&e->section, &e->section_cap, (int64_t)k + 1, sizeof *e->section, err)) return -1;
    e->section[k][0] = r0;
    e->section[k][1] = r1;
    e->element[element].section = e->sections++;
    return 0;
}

int fl_elements_pick(fl_elements *e, fl_pick pick, fl_err *err)
{
    const int faces = SHAPE[e->element[pick.element].shape].faces;
    if (faces && pick.face >= faces) return 0;
    if (fl_grow(&e->pick, &e->pick_cap, (int64_t)e->picks + 1, sizeof *e->pick, err)) return -1;
    e->pick[e->picks++] = pick;
    return 0;
}

int fl_elements_skip(fl_elements *e, const char *type, fl_err *err)
{
    const int32_t had = e->skipped.n, k = fl_string_table_add(&e->skipped, type, err);
    if (k < 0 || fl_grow(&e->skip_count, &e->skip_cap, e->skipped.n, sizeof *e->skip_count, err)) return -1;
    if (k >= had) e->skip_count[k] = 0;
    e->skip_count[k]++;
    return 0;
}

void fl_elements_free(fl_elements *e)
{
    fl_id_map_free(&e->node_id);
    fl_id_map_free(&e->element_id);
    fl_string_table_free(&e->parts);
    fl_string_table_free(&e->sets);
    fl_string_table_free(&e->files);
    fl_string_table_free(&e->skipped);
    free(e->x);
    free(e->element);
    free(e->connectivity);
    free(e->pick);
    free(e->skip_count);
    free(e->section);
    *e = (fl_elements){0};
}
