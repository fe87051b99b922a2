/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "geom/inner_walls.h"
#include "geom/connected_parts.h"
#include "cleanup.h"
#include "mesh/crossing.h"
#include "shim/cgal_distance.h"
#include "shim/cgal_remesh.h"
#include "shim/cgal_simplify.h"

static const double BLUR = 1e-9; /* of the diagonal: to this distances are told */
enum { TRIALS = 5 };

static int to_soup(const fl_part *p, fl_soup *s, fl_err *err)
{
    *s = (fl_soup){.nv = p->nv, .nt = p->nt};
    s->x = fl_alloc(3 * (int64_t)p->nv, sizeof *s->x, err);
    s->t = s->x ? fl_alloc(3 * (int64_t)p->nt, sizeof *s->t, err) : NULL;
    if (!s->t) {
        fl_soup_free(s);
        return -1;
    }
    for (int32_t v = 0; v < p->nv; v++) memcpy(s->x + 3 * (int64_t)v, &p->v[v].x, 3 * sizeof *s->x);
    for (int32_t t = 0; t < p->nt; t++) memcpy(s->t + 3 * (int64_t)t, p->t[t].v, 3 * sizeof *s->t);
    return 0;
}

/* What was cut along branched edges is joined, and vertices are put back into the order of their use. */
static int from_soup(fl_part *p, const fl_soup *s, fl_err *err)
{
    fl_weld w;
    p->nv = p->nt = 0;
    for (int32_t v = 0; v < s->nv; v++) {
        const double *x = s->x + 3 * (int64_t)v;
        if (fl_surface_vertex(p, v3(x[0], x[1], x[2]), err)) return -1;
    }
    for (int32_t t = 0; t < s->nt; t++) {
        const int32_t *v = s->t + 3 * (int64_t)t;
        if (fl_surface_triangle(p, v[0], v[1], v[2], err)) return -1;
    }
    return fl_part_weld(p, 0.0, &w, err);
}

/* A part as a soup that is only looked at: coordinates and corners lie one behind the other in both. */
static fl_soup seen_as(const fl_part *p)
{
    return (fl_soup){p->nv, p->nt, p->nv ? &p->v[0].x : NULL, p->nt ? p->t[0].v : NULL};
}

/* Is there anything that needs a mesh of CGAL?  Sound surfaces of one patch, and open ones, do not. */
static int ailing(const fl_mesh_quality *q, const struct options *o)
{
    const int fill = o->fill_holes > 0 || o->fill > 0.0;
    return q->branched || q->degenerate || (q->closed && (q->patches > 1 || q->volume == 0.0)) ||
           (q->open && fill);
}

static void add_repair(fl_repair *sum, const fl_repair *more)
{
    sum->duplicates += more->duplicates;
    sum->stitched += more->stitched;
    sum->degenerate += more->degenerate;
    sum->holes += more->holes;
    sum->patched += more->patched;
    sum->stuck = more->stuck;
    sum->bounding = more->bounding;
}

static int repair(fl_part *p, int32_t holes, double size, fl_repair *did, fl_err *err)
{
    fl_soup s = {0};
    fl_orient_counts again;
    fl_mesh_quality was;
    fl_repair more;
    int rc = -1;
    if (to_soup(p, &s, err) == 0 && fl_cgal_repair(&s, holes, size, &more, err) == 0 &&
        from_soup(p, &s, err) == 0) {
        add_repair(did, &more);
        rc = more.bounding
                 ? 0
                 : fl_part_orient(p, &was, &again, err); /* a cavity looks inward, and is right so */
    }
    fl_soup_free(&s);
    return rc;
}

/* With closed, only where all bodies are. */
static int untangle(fl_part *p, int closed, struct mended *m, fl_err *err)
{
    fl_soup s = {0};
    fl_untangle did = {0};
    int32_t *shell = fl_alloc(p->nt, sizeof *shell, err), odd;
    int rc = -1;
    if (!shell || fl_part_connected(p, shell, &odd, err)) goto done;
    rc = closed && odd ? 0 : to_soup(p, &s, err) || fl_cgal_untangle(&s, shell, &did, err);
    /* new corners were rounded, which may leave triangles of one line */
    if (rc == 0 && did.joined + did.rebuilt > 0)
        rc = from_soup(p, &s, err) || repair(p, 0, 0.0, &m->repair, err) ||
             fl_part_crossings(p, &m->meet, err) || fl_part_measure(p, &m->left, err);
    m->untangle.joined += did.joined;
    m->untangle.rebuilt += did.rebuilt;
    m->untangle.changed = fmax(m->untangle.changed, did.changed);
    m->untangle.failed = did.failed;
done:
    free(shell);
    fl_soup_free(&s);
    return rc ? -1 : 0;
}

/* Bounds of the distance of either from the other. */
static int both_ways(const fl_soup *a, const fl_soup *b, double blur, double *strays, double *misses,
                     fl_err *err)
{
    double least;
    return fl_cgal_distance(a, b, blur, &least, strays, err) ||
                   fl_cgal_distance(b, a, blur, &least, misses, err)
               ? -1
               : 0;
}

/* The envelope holds for the result alone; where the source then lies too far from that, a narrower one is
 * tried. */
static int simplify(fl_part *p, double distance, double blur, int32_t *gone, fl_err *err)
{
    const fl_soup before = seen_as(p);
    double within = distance, strays, misses;
    for (int k = 0; k < TRIALS; k++, within *= 0.5) {
        fl_soup s = {0};
        int rc = to_soup(p, &s, err) || fl_cgal_simplify(&s, within, gone, err) || s.nt == 0 ||
                 both_ways(&s, &before, blur, &strays, &misses, err);
        if (rc == 0 && fmax(strays, misses) <= distance) {
            rc = from_soup(p, &s, err);
            fl_soup_free(&s);
            return rc;
        }
        rc = rc && s.nt > 0;
        fl_soup_free(&s);
        if (rc) return -1;
    }
    *gone = 0;
    return 0;
}

static int remesh(fl_part *p, const struct options *o, double blur, fl_err *err)
{
    const fl_soup before = seen_as(p);
    fl_soup s = {0};
    double strays, misses;
    int rc = -1;
    if (to_soup(p, &s, err) || fl_cgal_remesh(&s, o->remesh, err)) goto done;
    if (s.nt == 0 || both_ways(&s, &before, blur, &strays, &misses, err)) goto done;
    if (fmax(strays, misses) > o->remesh_within) {
        fl_fail(err, FL_NUMERIC,
                "part \"%.60s\": triangles of %g m stray up to %g m from it, %g m were allowed: a smaller "
                "length or a larger distance is expected",
                p->name, o->remesh, fmax(strays, misses), o->remesh_within);
        goto done;
    }
    rc = from_soup(p, &s, err);
done:
    fl_soup_free(&s);
    return rc;
}

/* Everything behind welding and turning. */
static int cure(fl_part *p, const struct options *o, struct mended *m, double blur, fl_err *err)
{
    /* before triangles that two bodies have in common are taken for doubles of one */
    if (o->repair && m->left.branched && !m->left.open && !m->left.degenerate &&
        (fl_part_crossings(p, &m->meet, err) || (m->meet.crossings && untangle(p, 1, m, err))))
        return -1;
    if (ailing(&m->left, o) && repair(p, o->fill_holes, o->fill, &m->repair, err)) return -1;
    if (fl_part_crossings(p, &m->meet, err)) return -1;
    if (o->repair && m->meet.crossings && untangle(p, 0, m, err)) return -1;
    if (p->nt == 0 || (o->simplify <= 0.0 && o->remesh <= 0.0)) return 0;
    if (o->simplify > 0.0 && simplify(p, o->simplify, blur, &m->simplified, err)) return -1;
    if (o->remesh > 0.0 && remesh(p, o, blur, err)) return -1;
    return fl_part_crossings(p, &m->meet, err);
}

/* Without them what is left may have another outside. */
static int drop_fins(fl_part *p, struct mended *m, fl_err *err)
{
    fl_orient_counts again;
    if (fl_part_drop_fins(p, &m->fins, err)) return -1;
    if (m->fins == 0) return 0;
    if (fl_part_orient(p, &m->left, &again, err)) return -1;
    again.triangles += m->orient.triangles;
    again.patches += m->orient.patches;
    m->orient = again;
    return fl_part_measure(p, &m->left, err);
}

/* Can anything but welding have moved the surface? */
static int may_move(const fl_mesh_quality *q, const struct options *o)
{
    return ailing(q, o) || o->repair || o->simplify > 0.0 || o->remesh > 0.0;
}

/* *same becomes 1 where the triangles are those that came, to the last bit of their corners. */
static int mend_triangles(fl_part *p, const struct options *o, struct mended *m, int *same, fl_err *err)
{
    const fl_aabb box = fl_part_aabb(p);
    const double blur = BLUR * v3_norm(v3_sub(box.hi, box.lo));
    fl_soup source = {0};
    int rc = -1;
    if (fl_part_weld(p, o->weld, &m->weld, err)) return -1;
    if (p->nt == 0 && p->nc == 0)
        return fl_fail(err, FL_INPUT, "part \"%.60s\": each of its triangles is a point or a line", p->name);
    if (o->raw ? fl_part_measure(p, &m->left, err) : fl_part_orient(p, &m->left, &m->orient, err)) return -1;
    m->came_closed = m->left.closed;
    m->strays = m->misses = m->weld.moved;
    *same = m->weld.moved == 0.0 && m->weld.collapsed == 0;
    if (p->nt == 0 || o->raw) return 0;
    *same = *same && m->orient.triangles + m->orient.patches == 0;
    if (m->orient.triangles + m->orient.patches > 0 && fl_part_measure(p, &m->left, err)) return -1;
    if (m->left.branched && drop_fins(p, m, err)) return -1;
    *same = *same && !m->fins;
    if (o->repair && m->left.branched &&
        (fl_part_drop_inner_walls(p, &m->walls, err) || fl_part_measure(p, &m->left, err)))
        return -1;
    if (may_move(&m->left, o) && to_soup(p, &source, err)) return -1;
    *same = *same && !source.nt;
    if (cure(p, o, m, blur, err)) goto done;
    if (p->nt == 0 && p->nc == 0) {
        fl_fail(err, FL_INPUT, "part \"%.60s\": nothing is left after repair", p->name);
        goto done;
    }
    if (source.nt && p->nt) {
        const fl_soup now = seen_as(p);
        if (both_ways(&now, &source, blur, &m->strays, &m->misses, err)) goto done;
        m->strays += m->weld.moved;
        m->misses += m->weld.moved;
    }
    rc = source.nt ? fl_part_measure(p, &m->left, err) : 0;
done:
    fl_soup_free(&source);
    return rc;
}

int mend(fl_part *p, const struct options *o, struct mended *m, fl_err *err)
{
    *m = (struct mended){
        .came_triangles = p->nt, .came = fl_moments_of(p, 1), .came_closed = 1, .doubled = p->duplicates};
    int same = 0;
    fl_err why = {0};
    if (p->nt ? mend_triangles(p, o, m, &same, &why) : fl_part_measure(p, &m->left, &why)) {
        const int named = strncmp(why.text, "part ", 5) == 0;
        return named ? fl_fail(err, why.code, "%s", why.text)
                     : fl_fail(err, why.code, "part \"%.60s\": %s", p->name, why.text);
    }
    m->went = same ? m->came : fl_moments_of(p, 1);
    return 0;
}
