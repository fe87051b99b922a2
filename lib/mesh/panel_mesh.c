/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/panel_mesh.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "geom/facet.h"
#include "geom/mirror_half.h"
#include "mesh/deck_lines.h"

static const double IN_PLANE = 1e-6; /* of the diagonal of the box: what lies in a plane of symmetry */

int32_t fl_panel_mesh_body(fl_panel_mesh *m, const char *name, fl_err *err)
{
    const int32_t had = m->body.n, at = fl_string_table_add(&m->body, name, err);
    if (at < 0 || fl_grow(&m->planes, &m->body_cap, m->body.n, 1, err)) return -1;
    if (at >= had) m->planes[at] = 0;
    return at;
}

int32_t fl_panel_mesh_vertex(fl_panel_mesh *m, fl_vec3 x, fl_err *err)
{
    if (!isfinite(x.x) || !isfinite(x.y) || !isfinite(x.z))
        return fl_bytes_fail(m->b, err, "a node at %g %g %g, finite coordinates are expected", x.x, x.y, x.z);
    if (fl_grow(&m->x, &m->x_cap, (int64_t)m->vertices + 1, sizeof *m->x, err)) return -1;
    m->x[m->vertices] = x;
    return m->vertices++;
}

int fl_panel_mesh_node(fl_panel_mesh *m, int32_t scope, int64_t id, fl_vec3 x, fl_err *err)
{
    const int32_t had = m->node.n, at = fl_id_map_add(&m->node, scope, id, err);
    if (at < 0 || fl_grow(&m->vertex_of, &m->vertex_cap, m->node.n, sizeof *m->vertex_of, err)) return -1;
    if (at < had) return fl_bytes_fail(m->b, err, "node %lld is defined a second time", (long long)id);
    return (m->vertex_of[at] = fl_panel_mesh_vertex(m, x, err)) < 0 ? -1 : 0;
}

int32_t fl_panel_mesh_find(const fl_panel_mesh *m, int32_t scope, int64_t id)
{
    const int32_t at = fl_id_map_find(&m->node, scope, id);
    return at < 0 ? -1 : m->vertex_of[at];
}

int fl_panel_mesh_add(fl_panel_mesh *m, int32_t body, const int32_t v[4], fl_err *err)
{
    if (fl_grow(&m->panel, &m->panel_cap, (int64_t)m->panels + 1, sizeof *m->panel, err)) return -1;
    m->panel[m->panels++] = (fl_hull_panel){{v[0], v[1], v[2], v[3]}, body, m->b->line};
    return 0;
}

int fl_panel_mesh_add_nodes(fl_panel_mesh *m, int32_t body, int32_t scope, int n, const int64_t *id,
                            fl_err *err)
{
    int32_t v[4] = {-1, -1, -1, -1};
    for (int k = 0; k < n; k++) {
        v[k] = fl_panel_mesh_find(m, scope, id[k]);
        if (v[k] < 0)
            return fl_bytes_fail(m->b, err, "the panel has node %lld, which is not defined",
                                 (long long)id[k]);
    }
    return fl_panel_mesh_add(m, body, v, err);
}

int fl_panel_mesh_skip(fl_panel_mesh *m, const char *kind, fl_err *err)
{
    const int32_t had = m->skipped.n, at = fl_string_table_add(&m->skipped, kind, err);
    if (at < 0 || fl_grow(&m->skip_count, &m->skip_cap, m->skipped.n, sizeof *m->skip_count, err)) return -1;
    if (at >= had) m->skip_count[at] = 0;
    m->skip_count[at]++;
    return 0;
}

/* --- words ---------------------------------------------------------------------------------------------- */

int fl_panel_is_integer(const char *word, int64_t *x) { return fl_deck_integer(word, x) == 0; }
int fl_panel_is_real(const char *word, double *x) { return fl_deck_real(word, x) == 0; }

int fl_panel_integer(const fl_bytes *b, int32_t k, const char *what, int64_t *x, fl_err *err)
{
    if (k < b->words && fl_deck_integer(b->field[k], x) == 0) return 0;
    return fl_bytes_fail(b, err, "%s is \"%.40s\", a whole number is expected", what,
                         k < b->words ? b->field[k] : "");
}

int fl_panel_real(const fl_bytes *b, int32_t k, const char *what, double *x, fl_err *err)
{
    if (k < b->words && fl_deck_real(b->field[k], x) == 0) return 0;
    return fl_bytes_fail(b, err, "%s is \"%.40s\", a number is expected", what,
                         k < b->words ? b->field[k] : "");
}

int fl_panel_point(const fl_bytes *b, int32_t k, fl_vec3 *x, fl_err *err)
{
    return fl_panel_real(b, k, "x", &x->x, err) || fl_panel_real(b, k + 1, "y", &x->y, err) ||
                   fl_panel_real(b, k + 2, "z", &x->z, err)
               ? -1
               : 0;
}

const char *fl_panel_next_line(const char *p)
{
    p += strcspn(p, "\n");
    return *p ? p + 1 : p;
}

int fl_panel_head_words(const char *line, int most, char word[][FL_PANEL_WORD])
{
    int n = 0;
    for (;;) {
        line += strspn(line, " \t");
        const size_t len = strcspn(line, " \t\r\n");
        if (len == 0 || n > most) return n;
        if (n < most)
            snprintf(word[n], FL_PANEL_WORD, "%.*s", len < FL_PANEL_WORD ? (int)len : FL_PANEL_WORD - 1,
                     line);
        n++;
        line += len;
    }
}

/* --- the surface ---------------------------------------------------------------------------------------- */

static double plane_distance(fl_vec3 x, int axis) { return axis == 0 ? x.x : x.y; }

/* Range of a panel across a plane. */
static void panel_range(const fl_panel_mesh *m, const fl_hull_panel *p, int axis, double *lo, double *hi)
{
    *lo = INFINITY, *hi = -INFINITY;
    for (int k = 0; k < 4 && p->v[k] >= 0; k++) {
        *lo = fmin(*lo, plane_distance(m->x[p->v[k]], axis));
        *hi = fmax(*hi, plane_distance(m->x[p->v[k]], axis));
    }
}

/* Counts the panels of a body with their images.  One that reaches through a plane of symmetry is refused. */
static int count_images(const fl_panel_mesh *m, int32_t body, double tol, int64_t *all, fl_err *err)
{
    double least[2] = {0.0}, most[2] = {0.0};
    *all = 0;
    for (int32_t i = 0; i < m->panels; i++) {
        const fl_hull_panel *p = &m->panel[i];
        int images = 1;
        if (p->body != body) continue;
        for (int axis = 0; axis < 2; axis++) {
            double lo, hi;
            if (!(m->planes[body] >> axis & 1)) continue;
            panel_range(m, p, axis, &lo, &hi);
            least[axis] = fmin(least[axis], lo), most[axis] = fmax(most[axis], hi);
            if (lo < -tol && hi > tol)
                return fl_fail(err, FL_INPUT,
                               "%s:%d: the panel reaches from %c = %g to %g, through the plane of symmetry",
                               fl_in_name(m->b->in), p->line, "xy"[axis], lo, hi);
            if (least[axis] < -tol && most[axis] > tol)
                return fl_fail(err, FL_INPUT,
                               "%s:%d: the panel lies on the other side of the plane of symmetry %c = 0 than "
                               "those before it",
                               fl_in_name(m->b->in), p->line, "xy"[axis]);
            if (fmax(fabs(lo), fabs(hi)) > tol) images *= 2;
        }
        *all += images;
    }
    return 0;
}

/* The corners of a panel without those that repeat another one, by number or by position. */
static int distinct_corners(const fl_panel_mesh *m, const fl_hull_panel *p, int32_t loop[4])
{
    int n = 0;
    for (int k = 0; k < 4 && p->v[k] >= 0; k++) {
        int seen = 0;
        for (int j = 0; j < n; j++)
            seen |= p->v[k] == loop[j] || v3_norm2(v3_sub(m->x[p->v[k]], m->x[loop[j]])) == 0.0;
        if (!seen) loop[n++] = p->v[k];
    }
    return n;
}

/* Vertices and triangles of a body; index[v] is the vertex of the part, -1 where it is not yet there. */
static int add_body(const fl_panel_mesh *m, int32_t body, fl_part *p, int32_t *index, int32_t *flat,
                    fl_err *err)
{
    for (int32_t i = 0; i < m->panels; i++) {
        int32_t loop[4];
        if (m->panel[i].body != body) continue;
        const int n = distinct_corners(m, &m->panel[i], loop);
        *flat += n < 3;
        for (int k = 0; k < n; k++) {
            if (index[loop[k]] < 0) {
                index[loop[k]] = p->nv;
                if (fl_surface_vertex(p, m->x[loop[k]], err)) return -1;
            }
            loop[k] = index[loop[k]];
        }
        if (n == 3 ? fl_surface_triangle(p, loop[0], loop[1], loop[2], err)
                   : fl_facet_polygon(p, n, loop, err))
            return -1;
    }
    return 0;
}

static int finish_body(fl_panel_mesh *m, int32_t body, fl_surface *s, int32_t *index, fl_err *err)
{
    const char *name = m->body.name[body];
    const int planes = m->planes[body];
    fl_aabb box = aabb_empty();
    int32_t count = 0, without = 0, crosses;
    int64_t all;
    for (int32_t i = 0; i < m->panels; i++) {
        if (m->panel[i].body != body) continue;
        count++;
        for (int k = 0; k < 4 && m->panel[i].v[k] >= 0; k++) box = aabb_add(box, m->x[m->panel[i].v[k]]);
    }
    if (count == 0) return 0;
    const double tol = IN_PLANE * v3_norm(v3_sub(box.hi, box.lo));
    if (count_images(m, body, tol, &all, err)) return -1;
    const int32_t at = fl_surface_add(s, name, strlen(name), err);
    if (at < 0 || add_body(m, body, &s->part[at], index, &without, err)) return -1;
    for (int axis = 0; axis < 2; axis++)
        if (planes >> axis & 1 && fl_part_mirror_half(&s->part[at], axis, tol, &crosses, err)) return -1;
    fl_bytes_note(m->b, "%s%s%lld panels%s%s%s", m->body.n > 1 ? name : "", m->body.n > 1 ? ": " : "",
                  (long long)all, planes ? ", mirrored in " : "", planes & FL_PLANE_X ? "x = 0" : "",
                  planes == (FL_PLANE_X | FL_PLANE_Y) ? " and y = 0"
                  : planes & FL_PLANE_Y               ? "y = 0"
                                                      : "");
    if (without) fl_bytes_note(m->b, "%d panels without area were skipped", without);
    if (box.lo.z >= 0.0)
        fl_bytes_note(m->b, "nothing lies below z = 0, where the water is: --translate moves it");
    return 0;
}

int fl_panel_mesh_finish(fl_panel_mesh *m, fl_surface *s, fl_err *err)
{
    if (m->panels == 0) return fl_bytes_fail(m->b, err, "no panels");
    int32_t *index = fl_alloc(m->vertices, sizeof *index, err);
    int rc = index ? 0 : -1;
    for (int32_t body = 0; rc == 0 && body < m->body.n; body++) {
        for (int32_t v = 0; v < m->vertices; v++) index[v] = -1;
        rc = finish_body(m, body, s, index, err);
    }
    for (int32_t k = 0; rc == 0 && k < m->skipped.n; k++)
        fl_bytes_note(m->b, "passed over: %s (%d)", m->skipped.name[k], m->skip_count[k]);
    free(index);
    return rc;
}

void fl_panel_mesh_free(fl_panel_mesh *m)
{
    fl_string_table_free(&m->body);
    fl_string_table_free(&m->skipped);
    fl_id_map_free(&m->node);
    free(m->x), free(m->panel), free(m->planes), free(m->vertex_of), free(m->skip_count);
    *m = (fl_panel_mesh){0};
}
