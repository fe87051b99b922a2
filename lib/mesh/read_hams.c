/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/read_hams.h"
#include <string.h>
#include <strings.h>
#include "mesh/panel_mesh.h"

static int begins_with(const char *p, const char *text)
{
    p += strspn(p, " \t");
    return strncasecmp(p, text, strlen(text)) == 0;
}

int fl_hams_is(const fl_bytes *b)
{
    int count = 0, nodes = 0;
    for (const char *p = b->data; *p && !(count && nodes); p = fl_panel_next_line(p)) {
        count |= begins_with(p, "# Number of Panels") || begins_with(p, "#Number of Panels");
        nodes |= begins_with(p, "#Start Definition of Node") || begins_with(p, "# Start Definition of Node");
    }
    return count && nodes;
}

/* Row that is no comment: 1; 2 for a comment that begins with #End; 0 at the end; -1. */
static int next_row(fl_bytes *b, fl_err *err)
{
    int more;
    while ((more = fl_bytes_row(b, err)) > 0) {
        const char *p = b->field[0];
        if (strncasecmp(p, "#End", 4) == 0 ||
            (strcmp(p, "#") == 0 && b->words > 1 && strcasecmp(b->field[1], "End") == 0))
            return 2;
        if (*p != '#' && *p != '-') return 1;
        if (*p == '-' && p[1] != '-') return 1;
    }
    return more;
}

static int hams_node(fl_bytes *b, fl_panel_mesh *m, fl_err *err)
{
    int64_t id;
    fl_vec3 x;
    return fl_panel_integer(b, 0, "the node", &id, err) || fl_panel_point(b, 1, &x, err)
               ? -1
               : fl_panel_mesh_node(m, 0, id, x, err);
}

static int hams_panel(fl_bytes *b, fl_panel_mesh *m, fl_err *err)
{
    int64_t n, node[4];
    if (fl_panel_integer(b, 1, "the number of corners", &n, err)) return -1;
    if (n < 3 || n > 4)
        return fl_bytes_fail(b, err, "a panel of %lld corners, 3 or 4 are expected", (long long)n);
    for (int k = 0; k < n; k++)
        if (fl_panel_integer(b, 2 + k, "a corner of the panel", &node[k], err)) return -1;
    return fl_panel_mesh_add_nodes(m, 0, 0, (int)n, node, err);
}

int fl_hams_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    fl_panel_mesh m = {.b = b};
    int64_t x[4];
    int rc = -1, more, block = 0;
    (void)name, (void)opt;
    if (fl_panel_mesh_body(&m, "hull", err) < 0 || next_row(b, err) < 0) goto done;
    for (int k = 0; k < 4; k++)
        if (fl_panel_integer(b, k, "a count of panels, nodes or symmetry", &x[k], err)) goto done;
    m.planes[0] = (int8_t)((x[2] == 1 ? FL_PLANE_X : 0) | (x[3] == 1 ? FL_PLANE_Y : 0));
    while (block < 2 && (more = next_row(b, err)) != 0) {
        if (more < 0) goto done;
        if (more == 2) block++;
        else if (block == 0 ? hams_node(b, &m, err) : hams_panel(b, &m, err)) goto done;
    }
    if (m.panels != x[0] || m.node.n != x[1])
        fl_bytes_note(b, "the file promises %lld panels and %lld nodes, and has %d and %d", (long long)x[0],
                      (long long)x[1], m.panels, m.node.n);
    rc = fl_panel_mesh_finish(&m, s, err);
done:
    fl_panel_mesh_free(&m);
    return rc;
}
