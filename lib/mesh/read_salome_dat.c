/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/read_salome_dat.h"
#include <stdio.h>
#include <string.h>
#include "mesh/panel_mesh.h"

int fl_salome_dat_is(const fl_bytes *b)
{
    char word[4][FL_PANEL_WORD];
    int64_t n, e, id;
    double x;
    if (!fl_bytes_is_text(b) || fl_panel_head_words(b->data, 2, word) != 2 ||
        !fl_panel_is_integer(word[0], &n) || !fl_panel_is_integer(word[1], &e) || n < 3 || e < 1)
        return 0;
    if (fl_panel_head_words(fl_panel_next_line(b->data), 4, word) != 4 ||
        !fl_panel_is_integer(word[0], &id) || id != 1)
        return 0;
    for (int k = 1; k < 4; k++)
        if (!fl_panel_is_real(word[k], &x)) return 0;
    return 1;
}

static int salome_element(fl_bytes *b, fl_panel_mesh *m, fl_err *err)
{
    int64_t type, node[4];
    char kind[40];
    if (fl_panel_integer(b, 1, "the type of the element", &type, err)) return -1;
    const int n = type == 203 || type == 206 ? 3 : type == 204 || type == 208 ? 4 : 0;
    if (n == 0) {
        snprintf(kind, sizeof kind, "elements of type %lld", (long long)type);
        return fl_panel_mesh_skip(m, kind, err);
    }
    for (int k = 0; k < n; k++)
        if (fl_panel_integer(b, 2 + k, "a node of the element", &node[k], err)) return -1;
    return fl_panel_mesh_add_nodes(m, 0, 0, n, node, err);
}

int fl_salome_dat_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    fl_panel_mesh m = {.b = b};
    int64_t nodes, elements, id;
    fl_vec3 x;
    int rc = -1;
    (void)opt;
    if (fl_panel_mesh_body(&m, name, err) < 0 || fl_bytes_row(b, err) < 0 ||
        fl_panel_integer(b, 0, "the number of nodes", &nodes, err) ||
        fl_panel_integer(b, 1, "the number of elements", &elements, err))
        goto done;
    for (int64_t k = 0; k < nodes + elements; k++) {
        const int more = fl_bytes_row(b, err);
        if (more < 0) goto done;
        if (more == 0) {
            fl_bytes_fail(b, err, "line 1 promises %lld nodes and %lld elements, the file ends before",
                          (long long)nodes, (long long)elements);
            goto done;
        }
        if (k < nodes ? fl_panel_integer(b, 0, "the node", &id, err) || fl_panel_point(b, 1, &x, err) ||
                            fl_panel_mesh_node(&m, 0, id, x, err)
                      : salome_element(b, &m, err))
            goto done;
    }
    rc = fl_panel_mesh_finish(&m, s, err);
done:
    fl_panel_mesh_free(&m);
    return rc;
}
