/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/read_hydrostar.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "mesh/panel_mesh.h"

/* NUMPANEL body first last. */
typedef struct {
    int64_t body, first, last;
} body_range;

typedef struct {
    fl_panel_mesh m;
    fl_bytes *b;
    body_range *range;
    int8_t *planes; /* [bodies] of SYMMETRY_BODY */
    int32_t ranges, range_cap, bodies, planes_cap;
    int all;           /* planes of all bodies */
    int64_t next_node; /* number of the next node without one */
} hydrostar_reader;

static int begins_line(const char *p, const char *word)
{
    const size_t n = strlen(word);
    p += strspn(p, " \t");
    return strncmp(p, word, n) == 0 && strchr(" \t\r\n", p[n]) != NULL;
}

int fl_hydrostar_is(const fl_bytes *b)
{
    int nodes = 0, panels = 0;
    for (const char *p = b->data; *p && !(nodes && panels); p = fl_panel_next_line(p)) {
        nodes |= begins_line(p, "COORDINATES");
        panels |= begins_line(p, "PANEL");
    }
    return nodes && panels;
}

static int planes_of(int64_t k) { return k == 1 ? FL_PLANE_Y : k == 2 ? FL_PLANE_X | FL_PLANE_Y : 0; }

static int symmetry_of_body(hydrostar_reader *r, fl_err *err)
{
    int64_t body, k;
    if (fl_panel_integer(r->b, 1, "the body", &body, err) ||
        fl_panel_integer(r->b, 2, "the symmetry", &k, err))
        return -1;
    if (body < 1 || body > 10000)
        return fl_bytes_fail(r->b, err, "body %lld, a number from 1 to 10000 is expected", (long long)body);
    if (fl_grow(&r->planes, &r->planes_cap, body + 1, 1, err)) return -1;
    while (r->bodies <= (int32_t)body) r->planes[r->bodies++] = -1;
    r->planes[body] = (int8_t)planes_of(k);
    return 0;
}

static int panels_of_body(hydrostar_reader *r, fl_err *err)
{
    body_range g;
    if (fl_panel_integer(r->b, 1, "the body", &g.body, err) ||
        fl_panel_integer(r->b, 2, "its first panel", &g.first, err) ||
        fl_panel_integer(r->b, 3, "its last panel", &g.last, err) ||
        fl_grow(&r->range, &r->range_cap, (int64_t)r->ranges + 1, sizeof *r->range, err))
        return -1;
    r->range[r->ranges++] = g;
    return 0;
}

/* Reads rows up to the word that ends the block. */
static int read_coordinates(hydrostar_reader *r, fl_err *err)
{
    int more;
    while ((more = fl_bytes_row(r->b, err)) > 0 && strcmp(r->b->field[0], "ENDCOORDINATES") != 0) {
        int64_t id = r->next_node;
        fl_vec3 x;
        const int numbered = r->b->words > 3;
        if ((numbered && fl_panel_integer(r->b, 0, "the node", &id, err)) ||
            fl_panel_point(r->b, numbered, &x, err) || fl_panel_mesh_node(&r->m, 0, id, x, err))
            return -1;
        r->next_node = id + 1;
    }
    return more < 0 ? -1 : more ? 0 : fl_bytes_fail(r->b, err, "the file ends before ENDCOORDINATES");
}

/* The body of the next panel, by NUMPANEL. */
static int32_t body_of_panel(hydrostar_reader *r, fl_err *err)
{
    int64_t body = 1;
    char name[32] = "hull";
    for (int32_t k = 0; k < r->ranges; k++)
        if (r->m.panels + 1 >= r->range[k].first && r->m.panels + 1 <= r->range[k].last)
            body = r->range[k].body;
    if (r->ranges > 1) snprintf(name, sizeof name, "body_%lld", (long long)body);
    const int32_t at = fl_panel_mesh_body(&r->m, name, err);
    const int own = body >= 0 && body < r->bodies ? r->planes[body] : -1;
    if (at >= 0) r->m.planes[at] = (int8_t)(own >= 0 ? own : r->all);
    return at;
}

static int read_panels(hydrostar_reader *r, fl_err *err)
{
    int64_t type = 0;
    int more;
    if (r->b->words > 2 && fl_panel_integer(r->b, 2, "the type of PANEL", &type, err)) return -1;
    if (type < 0 || type > 1)
        return fl_bytes_fail(r->b, err, "PANEL TYPE %lld, 0 or 1 is expected", (long long)type);
    while ((more = fl_bytes_row(r->b, err)) > 0 && strcmp(r->b->field[0], "ENDPANEL") != 0) {
        const int n = r->b->words - (int)type;
        int64_t node[4];
        if (n < 3 || n > 4) return fl_bytes_fail(r->b, err, "a panel of %d corners, 3 or 4 are expected", n);
        for (int k = 0; k < n; k++)
            if (fl_panel_integer(r->b, k + (int)type, "a corner of the panel", &node[k], err)) return -1;
        const int32_t body = body_of_panel(r, err);
        if (body < 0 || fl_panel_mesh_add_nodes(&r->m, body, 0, n, node, err)) return -1;
    }
    return more < 0 ? -1 : more ? 0 : fl_bytes_fail(r->b, err, "the file ends before ENDPANEL");
}

int fl_hydrostar_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    hydrostar_reader r = {.m = {.b = b}, .b = b, .next_node = 1};
    int rc = -1, more;
    (void)name, (void)opt;
    while ((more = fl_bytes_row(b, err)) > 0) {
        const char *word = b->field[0];
        int64_t k;
        int bad = 0;
        if (strcmp(word, "ENDFILE") == 0) break;
        if (strcmp(word, "COORDINATES") == 0) bad = read_coordinates(&r, err);
        else if (strcmp(word, "PANEL") == 0) bad = read_panels(&r, err);
        else if (strcmp(word, "SYMMETRY_BODY") == 0) bad = symmetry_of_body(&r, err);
        else if (strcmp(word, "NUMPANEL") == 0) bad = panels_of_body(&r, err);
        else if (strcmp(word, "SYMMETRY") == 0) {
            bad = fl_panel_integer(b, 1, "the symmetry", &k, err);
            if (!bad) r.all = planes_of(k);
        }
        if (bad) goto done;
    }
    rc = more < 0 ? -1 : fl_panel_mesh_finish(&r.m, s, err);
done:
    fl_panel_mesh_free(&r.m);
    free(r.range), free(r.planes);
    return rc;
}
