/* SPDX-License-Identifier: GPL-3.0-or-later */
/* panel_mesh.h -- hydrodynamic panels of hulls: nodes, panels of three or four corners, bodies and symmetry.
 *
 * Readers of panel files fill it.  A panel that repeats a node, by number or by position, is a triangle.
 * Images in planes of symmetry are added with their winding reversed; a panel in such a plane has none.  The
 * hull stays open where the file leaves it open, as at the waterline. */
#ifndef FL_MESH_PANEL_MESH_H
#define FL_MESH_PANEL_MESH_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/id_map.h"

enum { FL_PLANE_X = 1, FL_PLANE_Y = 2 }; /* x = 0, y = 0: bits */

typedef struct {
    int32_t v[4]; /* vertices; of a triangle v[3] is -1 */
    int32_t body, line;
} fl_hull_panel;

typedef struct {
    fl_bytes *b; /* borrowed */
    fl_vec3 *x;  /* [vertices] */
    fl_hull_panel *panel;
    fl_string_table body;
    int8_t *planes;     /* [body.n] planes of symmetry */
    fl_id_map node;     /* numbered nodes */
    int32_t *vertex_of; /* [node.n] */
    fl_string_table skipped;
    int32_t *skip_count; /* [skipped.n] */
    int32_t vertices, panels, x_cap, panel_cap, body_cap, vertex_cap, skip_cap;
} fl_panel_mesh;

/* Index of a body, added if new; of a new vertex; 0 for a new numbered node; its vertex, -1 if it is not
 * there.  -1 with FL_SYSTEM, or FL_INPUT where a coordinate is not finite. */
int32_t fl_panel_mesh_body(fl_panel_mesh *m, const char *name, fl_err *err);
int32_t fl_panel_mesh_vertex(fl_panel_mesh *m, fl_vec3 x, fl_err *err);
int fl_panel_mesh_node(fl_panel_mesh *m, int32_t scope, int64_t id, fl_vec3 x, fl_err *err);
int32_t fl_panel_mesh_find(const fl_panel_mesh *m, int32_t scope, int64_t id);

/* Add a panel at the current line of the file: by vertices, or by numbers of nodes (n is 3 or 4).  -1 with
 * FL_SYSTEM, or FL_INPUT for a node that is not there. */
int fl_panel_mesh_add(fl_panel_mesh *m, int32_t body, const int32_t v[4], fl_err *err);
int fl_panel_mesh_add_nodes(fl_panel_mesh *m, int32_t body, int32_t scope, int n, const int64_t *id,
                            fl_err *err);

/* Count what is passed over, for a remark.  -1 with FL_SYSTEM. */
int fl_panel_mesh_skip(fl_panel_mesh *m, const char *kind, fl_err *err);

/* Words of the current row as numbers: -1 with FL_INPUT. */
int fl_panel_integer(const fl_bytes *b, int32_t k, const char *what, int64_t *x, fl_err *err);
int fl_panel_real(const fl_bytes *b, int32_t k, const char *what, double *x, fl_err *err);
int fl_panel_point(const fl_bytes *b, int32_t k, fl_vec3 *x, fl_err *err);

/* True if a text is an integer; a number. */
int fl_panel_is_integer(const char *word, int64_t *x);
int fl_panel_is_real(const char *word, double *x);

/* Words of a line in memory: copies up to `most` into word; returns their count, most + 1 for more. */
enum { FL_PANEL_WORD = 32 };
int fl_panel_head_words(const char *line, int most, char word[][FL_PANEL_WORD]);

/* Start of the line after p, or the end. */
const char *fl_panel_next_line(const char *p);

/* Make parts of s, one a body.  -1 with FL_SYSTEM, or FL_INPUT: no panels, or one that crosses a plane of
 * symmetry, or lies on its other side; the message names its line. */
int fl_panel_mesh_finish(fl_panel_mesh *m, fl_surface *s, fl_err *err);
void fl_panel_mesh_free(fl_panel_mesh *m); /* accepts a zeroed struct, leaves one */

#endif
