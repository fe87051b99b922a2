/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/read_nemoh.h"
#include <string.h>
#include "mesh/panel_mesh.h"

/* The line at p is an integer and three numbers. */
static int is_node_row(const char *p)
{
    char word[4][FL_PANEL_WORD];
    int64_t id;
    double x;
    if (fl_panel_head_words(p, 4, word) != 4 || !fl_panel_is_integer(word[0], &id)) return 0;
    for (int k = 1; k < 4; k++)
        if (!fl_panel_is_real(word[k], &x)) return 0;
    return 1;
}

int fl_nemoh_is(const fl_bytes *b)
{
    char word[4][FL_PANEL_WORD];
    int64_t x[4];
    const int n = fl_panel_head_words(b->data, 4, word);
    if (!fl_bytes_is_text(b) || (n != 2 && n != 4) || !is_node_row(fl_panel_next_line(b->data))) return 0;
    for (int k = 0; k < n; k++)
        if (!fl_panel_is_integer(word[k], &x[k])) return 0;
    return x[0] == 2 && (x[1] == 0 || x[1] == 1);
}

static int read_nodes(fl_bytes *b, fl_panel_mesh *m, fl_err *err)
{
    int more;
    while ((more = fl_bytes_row(b, err)) > 0) {
        int64_t id;
        fl_vec3 x;
        if (fl_panel_integer(b, 0, "the node", &id, err)) return -1;
        if (id == 0) return 0;
        if (fl_panel_point(b, 1, &x, err) || fl_panel_mesh_node(m, 0, id, x, err)) return -1;
    }
    return more < 0 ? -1 : fl_bytes_fail(b, err, "the file ends among the nodes, a row of zeros ends them");
}

int fl_nemoh_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    fl_panel_mesh m = {.b = b};
    int64_t node[4], half;
    int rc = -1, more;
    (void)name, (void)opt;
    if (fl_panel_mesh_body(&m, "hull", err) < 0 || fl_bytes_row(b, err) < 0) goto done;
    if (b->words > 2) {
        fl_bytes_fail(b, err, "a mesh of the free surface: the mesh of the body is expected");
        goto done;
    }
    if (fl_panel_integer(b, 1, "the symmetry", &half, err) || read_nodes(b, &m, err)) goto done;
    if (half == 1) m.planes[0] = FL_PLANE_Y;
    while ((more = fl_bytes_row(b, err)) > 0) {
        for (int k = 0; k < 4; k++)
            if (fl_panel_integer(b, k, "a corner of the panel", &node[k], err)) goto done;
        if (node[0] == 0) break;
        if (fl_panel_mesh_add_nodes(&m, 0, 0, 4, node, err)) goto done;
    }
    rc = more < 0 ? -1 : fl_panel_mesh_finish(&m, s, err);
done:
    fl_panel_mesh_free(&m);
    return rc;
}
