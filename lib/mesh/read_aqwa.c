/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/read_aqwa.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "mesh/deck_lines.h"
#include "mesh/panel_mesh.h"

enum { CARD = 16, COORDINATE = 10 };

typedef struct {
    fl_panel_mesh m;
    fl_bytes *b;
    char *line;
    int32_t len, body;
    int64_t structure; /* of the nodes or elements that follow */
    int8_t *given;     /* [bodies] SYMX 1, SYMY 2 */
    int32_t given_cap, dry;
} aqwa_reader;

/* Columns from..to of the line, counted from 1, without blanks around. */
static const char *cut_card(const aqwa_reader *r, int from, int to, char text[CARD])
{
    int32_t n = to < r->len ? to - from + 1 : r->len - from + 1;
    if (n < 0) n = 0;
    if (n >= CARD) n = CARD - 1;
    memcpy(text, r->line + (n ? from - 1 : 0), (size_t)n);
    text[n] = '\0';
    char *trimmed = fl_deck_trim(text);
    memmove(text, trimmed, strlen(trimmed) + 1);
    return text;
}

int fl_aqwa_is(const fl_bytes *b)
{
    int job = 0, nodes = 0;
    for (const char *p = b->data; *p && !(job && nodes); p = fl_panel_next_line(p)) {
        job |= strncmp(p, "JOB", 3) == 0 && fl_bytes_blank(p[3]);
        nodes |= strcspn(p, "\r\n") >= 14 && strncmp(p + 10, "COOR", 4) == 0;
    }
    return job && nodes;
}

static int is_end_card(const aqwa_reader *r)
{
    char text[CARD];
    return strcmp(cut_card(r, 2, 4, text), "END") == 0;
}

static int next_card(aqwa_reader *r, fl_err *err)
{
    int more;
    while ((more = fl_bytes_line(r->b, &r->line, &r->len, err)) > 0)
        if (r->line[0] != '*' && r->line[strspn(r->line, " \t")] != '\0') return 1;
    return more;
}

/* --- nodes ---------------------------------------------------------------------------------------------- */

static int aqwa_node(aqwa_reader *r, fl_err *err)
{
    char text[CARD];
    int64_t id;
    double x[3];
    if (fl_deck_integer(cut_card(r, 7, 11, text), &id)) return 0; /* another card */
    for (int k = 0; k < 3; k++) {
        x[k] = 0.0;
        cut_card(r, 21 + COORDINATE * k, 30 + COORDINATE * k, text);
        if (*text && fl_deck_real(text, &x[k]))
            return fl_bytes_fail(r->b, err, "columns %d to %d are \"%s\", a number is expected",
                                 21 + COORDINATE * k, 30 + COORDINATE * k, text);
    }
    return fl_panel_mesh_node(&r->m, (int32_t)r->structure, id, v3(x[0], x[1], x[2]), err);
}

static int aqwa_nodes(aqwa_reader *r, fl_err *err)
{
    int more;
    r->structure = 1;
    while ((more = next_card(r, err)) > 0 && !is_end_card(r)) {
        char text[CARD], number[CARD];
        if (strcmp(cut_card(r, 7, 10, text), "STRC") == 0) {
            cut_card(r, 11, 25, number);
            if (fl_deck_integer(number, &r->structure) || r->structure < 1 || r->structure > 10000)
                return fl_bytes_fail(r->b, err, "STRC \"%s\", a number from 1 to 10000 is expected", number);
        } else if (aqwa_node(r, err)) {
            return -1;
        }
    }
    return more < 0 ? -1 : 0;
}

/* --- elements ------------------------------------------------------------------------------------------- */

/* Nodes of "(1)(n1)(n2) ...": their count, -1 with FL_INPUT. */
static int card_nodes(aqwa_reader *r, int64_t node[4], fl_err *err)
{
    const char *p = strchr(r->line, '(');
    int n = 0;
    for (int k = 0; p && k < 5; k++) {
        char text[CARD];
        const size_t len = strcspn(p + 1, ")");
        if (len == 0 || len >= CARD || p[1 + len] != ')') break;
        memcpy(text, p + 1, len);
        text[len] = '\0';
        if (k > 0 && fl_deck_integer(fl_deck_trim(text), &node[n++]))
            return fl_bytes_fail(r->b, err, "node \"%s\" of the element, a whole number is expected", text);
        p = p[2 + len] == '(' ? p + 2 + len : NULL;
    }
    return n;
}

static int aqwa_element(aqwa_reader *r, fl_err *err)
{
    char kind[CARD], wet[CARD];
    int64_t node[4];
    cut_card(r, 7, 10, kind);
    if (strcmp(kind, "SYMX") == 0 || strcmp(kind, "SYMY") == 0) {
        r->given[r->body] |= (int8_t)(kind[3] == 'X' ? 1 : 2);
        if (strcmp(cut_card(r, 12, 15, kind), "SYMX") == 0) r->given[r->body] |= 1;
        else if (strcmp(kind, "SYMY") == 0) r->given[r->body] |= 2;
        return 0;
    }
    const int corners = strcmp(kind, "QPPL") == 0 ? 4 : strcmp(kind, "TPPL") == 0 ? 3 : 0;
    if (corners == 0)
        return strchr(r->line, '(') && *kind && strcmp(kind, "ZLWL") ? fl_panel_mesh_skip(&r->m, kind, err)
                                                                     : 0;
    const int n = card_nodes(r, node, err);
    if (n < 0) return -1;
    if (n < corners) return fl_bytes_fail(r->b, err, "%s has %d nodes, %d are expected", kind, n, corners);
    r->dry += strcmp(cut_card(r, 12, 15, wet), "DIFF") != 0;
    return fl_panel_mesh_add_nodes(&r->m, r->body, (int32_t)r->structure, corners, node, err);
}

/* ELMn, with the name of the body behind it. */
static int aqwa_elements(aqwa_reader *r, fl_err *err)
{
    char name[64], number[CARD];
    int more;
    int64_t n;
    cut_card(r, 14, 15, number);
    if (fl_deck_integer(number, &n) || n < 1 || n > 10000)
        return fl_bytes_fail(r->b, err, "ELM \"%s\", a number from 1 to 10000 is expected", number);
    r->structure = n;
    snprintf(name, sizeof name, "%.60s", r->len > 15 ? fl_deck_trim(r->line + 15) : "");
    if (!name[0]) snprintf(name, sizeof name, "hull_%d", (int)n);
    r->body = fl_panel_mesh_body(&r->m, name, err);
    if (r->body < 0 || fl_grow(&r->given, &r->given_cap, r->m.body.n, 1, err)) return -1;
    r->given[r->body] = 0;
    while ((more = next_card(r, err)) > 0 && !is_end_card(r))
        if (aqwa_element(r, err)) return -1;
    return more < 0 ? -1 : 0;
}

/* --- symmetry ------------------------------------------------------------------------------------------- */

typedef struct {
    int32_t a, b;
} rim_edge;

static int compare_rim_edges(const void *pa, const void *pb)
{
    const rim_edge *p = pa, *q = pb;
    if (p->a != q->a) return p->a < q->a ? -1 : 1;
    return p->b < q->b ? -1 : p->b > q->b;
}

/* Number of edges of one panel in the plane where coordinate `axis` is 0; -1 with FL_SYSTEM. */
static int32_t open_edges_in_plane(const aqwa_reader *r, int32_t body, int axis, fl_err *err)
{
    const fl_panel_mesh *m = &r->m;
    rim_edge *edge = fl_alloc(4 * (int64_t)m->panels, sizeof *edge, err);
    fl_aabb box = aabb_empty();
    int32_t n = 0, open = 0;
    if (!edge) return -1;
    for (int32_t v = 0; v < m->vertices; v++) box = aabb_add(box, m->x[v]);
    const double tol = 1e-6 * v3_norm(v3_sub(box.hi, box.lo));
    for (int32_t i = 0; i < m->panels; i++) {
        const fl_hull_panel *p = &m->panel[i];
        const int corners = p->v[3] < 0 ? 3 : 4;
        for (int k = 0; k < corners && p->body == body; k++) {
            const int32_t a = p->v[k], b = p->v[(k + 1) % corners];
            const double xa = axis ? m->x[a].y : m->x[a].x, xb = axis ? m->x[b].y : m->x[b].x;
            if (a != b && fabs(xa) <= tol && fabs(xb) <= tol)
                edge[n++] = a < b ? (rim_edge){a, b} : (rim_edge){b, a};
        }
    }
    if (n) qsort(edge, (size_t)n, sizeof *edge, compare_rim_edges);
    for (int32_t i = 0, j; i < n; i = j) {
        for (j = i + 1; j < n && compare_rim_edges(&edge[i], &edge[j]) == 0; j++) {}
        open += j - i == 1;
    }
    free(edge);
    return open;
}

/* Both cards mirror twice.  Of one the plane is not certain: it is the one that holds an open rim. */
static int choose_planes(aqwa_reader *r, fl_err *err)
{
    for (int32_t body = 0; body < r->m.body.n; body++) {
        if (r->given[body] == 3) r->m.planes[body] = FL_PLANE_X | FL_PLANE_Y;
        if (r->given[body] != 1 && r->given[body] != 2) continue;
        const int32_t x = open_edges_in_plane(r, body, 0, err), y = open_edges_in_plane(r, body, 1, err);
        if (x < 0 || y < 0) return -1;
        if ((x > 0) == (y > 0))
            return fl_bytes_fail(r->b, err,
                                 "body %s has SYM%c, and %s: which plane is meant is not certain; delete the "
                                 "card and give --symmetry",
                                 r->m.body.name[body], r->given[body] == 1 ? 'X' : 'Y',
                                 x > 0 ? "is open in x = 0 and in y = 0" : "is closed in x = 0 and in y = 0");
        r->m.planes[body] = x > 0 ? FL_PLANE_X : FL_PLANE_Y;
    }
    return 0;
}

int fl_aqwa_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    aqwa_reader r = {.m = {.b = b}, .b = b};
    int rc = -1, more;
    (void)name, (void)opt;
    while ((more = next_card(&r, err)) > 0) {
        char card[CARD];
        int bad = 0;
        cut_card(&r, 11, 14, card);
        if (strcmp(card, "COOR") == 0) bad = aqwa_nodes(&r, err);
        else if (strncmp(card, "ELM", 3) == 0) bad = aqwa_elements(&r, err);
        else if (strcmp(card, "FINI") == 0 && r.m.panels) break;
        if (bad) goto done;
    }
    if (more < 0 || choose_planes(&r, err)) goto done;
    if (r.dry) fl_bytes_note(b, "%d panels are above the water (without DIFF)", r.dry);
    rc = fl_panel_mesh_finish(&r.m, s, err);
done:
    fl_panel_mesh_free(&r.m);
    free(r.given);
    return rc;
}
