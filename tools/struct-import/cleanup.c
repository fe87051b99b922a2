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

static const double DISTANCE_ACCURACY = 1e-9; /* share of the diagonal: accuracy of measured distances */
/* The lines of fl_check_volume() tell volumes apart to this share. */
static const double VOLUME_TOLERANCE = 1e-3;
enum { MAX_TRIALS = 5 };

static int copy_part(fl_part *to, const fl_part *p, fl_err *err)
{
    *to = (fl_part){0};
    for (int32_t v = 0; v < p->nv; v++)
        if (fl_surface_vertex(to, p->v[v], err)) return -1;
    for (int32_t t = 0; t < p->nt; t++)
        if (fl_surface_triangle(to, p->t[t].v[0], p->t[t].v[1], p->t[t].v[2], err)) return -1;
    return 0;
}

/* Exchange the triangles of two parts. */
static void swap_triangles(fl_part *p, fl_part *q)
{
    const fl_part keep = *p;
    p->v = q->v, p->nv = q->nv, p->v_cap = q->v_cap;
    p->t = q->t, p->nt = q->nt, p->t_cap = q->t_cap;
    q->v = keep.v, q->nv = keep.nv, q->v_cap = keep.v_cap;
    q->t = keep.t, q->nt = keep.nt, q->t_cap = keep.t_cap;
}

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

/* Copy a soup to a part.  Welding joins vertices that were duplicated along branched edges and restores the
 * order of first use. */
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

/* A read-only soup that shares the arrays of a part: coordinates and corners are contiguous in both. */
static fl_soup view_as_soup(const fl_part *p)
{
    return (fl_soup){p->nv, p->nt, p->nv ? &p->v[0].x : NULL, p->nt ? p->t[0].v : NULL};
}

/* True if the part needs repair by CGAL.  Open surfaces and sound closed ones of one patch do not. */
static int needs_repair(const fl_mesh_quality *q, const struct options *o)
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

static int repair_part(fl_part *p, int32_t holes, double size, fl_repair *done_steps, fl_err *err)
{
    fl_soup s = {0};
    fl_orient_counts again;
    fl_mesh_quality was;
    fl_repair more;
    int rc = -1;
    if (to_soup(p, &s, err) == 0 && fl_cgal_repair(&s, holes, size, &more, err) == 0 &&
        from_soup(p, &s, err) == 0) {
        add_repair(done_steps, &more);
        rc = more.bounding
                 ? 0
                 : fl_part_orient(p, &was, &again, err); /* a cavity must keep its inward orientation */
    }
    fl_soup_free(&s);
    return rc;
}

/* Compare the volume of the part with that of the bodies it was made of. */
static int check_volume(const fl_part *p, const fl_part *source, const int32_t *body, const int32_t *group,
                        struct cleanup *m, fl_err *err)
{
    if (fl_check_volume(source, body, group, p, &m->volume, err)) return -1;
    m->lost = m->volume.bodies > 0 ||
              fabs(m->volume.result - m->volume.source) > VOLUME_TOLERANCE * m->volume.source;
    return 0;
}

/* Resolve bodies and patches that cross.  With closed, only if all bodies are closed. */
static int untangle_part(fl_part *p, int closed, struct cleanup *m, fl_err *err)
{
    fl_soup s = {0};
    fl_part source = {0};
    fl_untangle done_steps = {0};
    int32_t *shell = fl_alloc(p->nt, sizeof *shell, err), odd;
    int32_t *group = shell ? fl_alloc(p->nt, sizeof *group, err) : NULL;
    int rc = -1;
    if (!group || copy_part(&source, p, err) || fl_part_connected(p, shell, &odd, err)) goto done;
    rc = closed && odd ? 0 : to_soup(p, &s, err) || fl_cgal_untangle(&s, shell, group, &done_steps, err);
    /* new corners are rounded, which may leave degenerate triangles */
    if (rc == 0 && done_steps.joined + done_steps.rebuilt > 0)
        rc = from_soup(p, &s, err) || repair_part(p, 0, 0.0, &m->repair, err) ||
             fl_part_crossings(p, &m->crossing, err) || fl_part_measure(p, &m->quality, err) ||
             (odd == 0 && check_volume(p, &source, shell, group, m, err));
    m->untangle.joined += done_steps.joined;
    m->untangle.rebuilt += done_steps.rebuilt;
    m->untangle.changed = fmax(m->untangle.changed, done_steps.changed);
    m->untangle.failed = done_steps.failed;
done:
    free(shell);
    free(group);
    fl_part_free(&source);
    fl_soup_free(&s);
    return rc ? -1 : 0;
}

/* Upper bounds of the distance of either surface from the other. */
static int measure_distances(const fl_soup *a, const fl_soup *b, double accuracy, double *deviation,
                             double *source_deviation, fl_err *err)
{
    double least;
    return fl_cgal_distance(a, b, accuracy, &least, deviation, err) ||
                   fl_cgal_distance(b, a, accuracy, &least, source_deviation, err)
               ? -1
               : 0;
}

/* The envelope bounds only the distance of the result from the source.  If the source is then too far from
 * the result, the step is repeated with half the envelope. */
static int simplify_part(fl_part *p, double distance, double accuracy, int32_t *gone, fl_err *err)
{
    const fl_soup before = view_as_soup(p);
    double within = distance, deviation, source_deviation;
    for (int k = 0; k < MAX_TRIALS; k++, within *= 0.5) {
        fl_soup s = {0};
        int rc = to_soup(p, &s, err) || fl_cgal_simplify(&s, within, gone, err) || s.nt == 0 ||
                 measure_distances(&s, &before, accuracy, &deviation, &source_deviation, err);
        if (rc == 0 && fmax(deviation, source_deviation) <= distance) {
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

static int remesh_part(fl_part *p, const struct options *o, double accuracy, fl_err *err)
{
    const fl_soup before = view_as_soup(p);
    fl_soup s = {0};
    double deviation, source_deviation;
    int rc = -1;
    if (to_soup(p, &s, err) || fl_cgal_remesh(&s, o->remesh, err)) goto done;
    if (s.nt == 0 || measure_distances(&s, &before, accuracy, &deviation, &source_deviation, err)) goto done;
    if (fmax(deviation, source_deviation) > o->remesh_within) {
        fl_fail(err, FL_NUMERIC,
                "part \"%.60s\": triangles of %g m deviate up to %g m, %g m are allowed: choose a smaller "
                "length or a larger distance",
                p->name, o->remesh, fmax(deviation, source_deviation), o->remesh_within);
        goto done;
    }
    rc = from_soup(p, &s, err);
done:
    fl_soup_free(&s);
    return rc;
}

/* Drop walls between closed bodies that touch, and two-sided plates apart from them, unless the part would be
 * open or empty without them. */
static int drop_pairs(fl_part *p, struct cleanup *m, fl_err *err)
{
    fl_part whole = {0};
    fl_mesh_quality q;
    int32_t same = 0, walls = 0, plates = 0;
    int rc = -1;
    if (!m->quality.closed || (!m->quality.branched && m->quality.patches < 2)) return 0;
    if (copy_part(&whole, p, err) || fl_part_drop_contact_walls(p, &walls, &same, err) ||
        fl_part_drop_sheets(p, &plates, err))
        goto done;
    rc = walls + plates == 0 && same == 0 ? 0 : fl_part_measure(p, &q, err);
    if (rc == 0 && walls + plates > 0 && p->nt > 0 && q.closed && q.volume != 0.0) {
        m->quality = q;
        m->contact_walls = walls;
        m->sheets = plates;
        m->repair.duplicates += same;
    } else if (rc == 0) {
        swap_triangles(p, &whole);
    }
done:
    fl_part_free(&whole);
    return rc;
}

/* Bodies that touch with other meshes on a part of their walls, or that cross elsewhere, are united whole:
 * without the walls that they have in common they could not be told apart. */
static int unite_bodies(fl_part *p, fl_part *whole, struct cleanup *m, fl_err *err)
{
    fl_mesh_quality q;
    if (fl_part_crossings(p, &m->crossing, err)) return -1;
    if (m->crossing.crossings == 0) return 0;
    if (whole->nt && m->walls + m->contact_walls) {
        int32_t *shell = fl_alloc(whole->nt, sizeof *shell, err), odd = 1;
        const int rc = shell ? fl_part_connected(whole, shell, &odd, err) : -1;
        free(shell);
        if (rc) return -1;
        if (odd == 0) {
            if (fl_part_measure(whole, &q, err)) return -1;
            swap_triangles(p, whole);
            m->quality = q;
            m->walls = m->contact_walls = 0;
        }
    }
    return untangle_part(p, 1, m, err);
}

/* Repair, simplify and remesh a part that is welded and oriented.  whole: the part before walls were dropped.
 */
static int repair_and_refine(fl_part *p, fl_part *whole, const struct options *o, struct cleanup *m,
                             double accuracy, fl_err *err)
{
    /* before triangles that two bodies share are dropped as duplicates */
    if (o->repair && (m->quality.branched || whole->nt) && !m->quality.open && !m->quality.degenerate &&
        unite_bodies(p, whole, m, err))
        return -1;
    if (needs_repair(&m->quality, o) && repair_part(p, o->fill_holes, o->fill, &m->repair, err)) return -1;
    if (fl_part_crossings(p, &m->crossing, err)) return -1;
    if (o->repair && m->crossing.crossings && untangle_part(p, 0, m, err)) return -1;
    if (p->nt == 0 || (o->simplify <= 0.0 && o->remesh <= 0.0)) return 0;
    if (o->simplify > 0.0 && simplify_part(p, o->simplify, accuracy, &m->simplified, err)) return -1;
    if (o->remesh > 0.0 && remesh_part(p, o, accuracy, err)) return -1;
    return fl_part_crossings(p, &m->crossing, err);
}

/* The part is oriented again, since without the fins another side may be outside. */
static int drop_fins(fl_part *p, struct cleanup *m, fl_err *err)
{
    fl_orient_counts again;
    if (fl_part_drop_fins(p, &m->fins, err)) return -1;
    if (m->fins == 0) return 0;
    if (fl_part_orient(p, &m->quality, &again, err)) return -1;
    again.triangles += m->orient.triangles;
    again.patches += m->orient.patches;
    m->orient = again;
    return fl_part_measure(p, &m->quality, err);
}

/* True if a step other than welding may have moved the surface. */
static int may_move(const fl_mesh_quality *q, const struct options *o)
{
    return needs_repair(q, o) || o->repair || o->simplify > 0.0 || o->remesh > 0.0;
}

/* *same is set to 1 if the triangles are unchanged to the last bit of their corners. */
static int clean_triangles(fl_part *p, const struct options *o, struct cleanup *m, int *same, fl_err *err)
{
    const fl_aabb box = fl_part_aabb(p);
    const double accuracy = DISTANCE_ACCURACY * v3_norm(v3_sub(box.hi, box.lo));
    fl_soup source = {0};
    fl_part whole = {0};
    int rc = -1;
    if (fl_part_weld(p, o->weld, &m->weld, err)) return -1;
    if (p->nt == 0 && p->nc == 0)
        return fl_fail(err, FL_INPUT, "part \"%.60s\": all of its triangles are degenerate", p->name);
    if (o->raw ? fl_part_measure(p, &m->quality, err) : fl_part_orient(p, &m->quality, &m->orient, err))
        return -1;
    m->was_closed = m->quality.closed;
    m->deviation = m->source_deviation = m->weld.moved;
    *same = m->weld.moved == 0.0 && m->weld.collapsed == 0;
    if (p->nt == 0 || o->raw) return 0;
    *same = *same && m->orient.triangles + m->orient.patches == 0;
    if (m->orient.triangles + m->orient.patches > 0 && fl_part_measure(p, &m->quality, err)) return -1;
    if (m->quality.branched && drop_fins(p, m, err)) return -1;
    *same = *same && !m->fins;
    if (o->repair && m->quality.branched && m->quality.closed && copy_part(&whole, p, err)) goto done;
    if (drop_pairs(p, m, err)) goto done;
    *same = *same && !m->contact_walls && !m->sheets;
    if (o->repair && m->quality.branched &&
        (fl_part_drop_inner_walls(p, &m->walls, err) || fl_part_measure(p, &m->quality, err)))
        goto done;
    if (may_move(&m->quality, o) && to_soup(p, &source, err)) goto done;
    *same = *same && !source.nt;
    if (repair_and_refine(p, &whole, o, m, accuracy, err)) goto done;
    if (p->nt == 0 && p->nc == 0) {
        fl_fail(err, FL_INPUT, "part \"%.60s\": nothing is left after repair", p->name);
        goto done;
    }
    if (source.nt && p->nt) {
        const fl_soup now = view_as_soup(p);
        if (measure_distances(&now, &source, accuracy, &m->deviation, &m->source_deviation, err)) goto done;
        m->deviation += m->weld.moved;
        m->source_deviation += m->weld.moved;
    }
    rc = source.nt ? fl_part_measure(p, &m->quality, err) : 0;
done:
    fl_part_free(&whole);
    fl_soup_free(&source);
    return rc;
}

int clean_part(fl_part *p, const struct options *o, struct cleanup *m, fl_err *err)
{
    *m = (struct cleanup){.triangles_before = p->nt,
                          .before = fl_moments_of(p, 1),
                          .was_closed = 1,
                          .duplicates = p->duplicates};
    int same = 0;
    fl_err why = {0};
    if (p->nt ? clean_triangles(p, o, m, &same, &why) : fl_part_measure(p, &m->quality, &why)) {
        const int named = strncmp(why.text, "part ", 5) == 0;
        return named ? fl_fail(err, why.code, "%s", why.text)
                     : fl_fail(err, why.code, "part \"%.60s\": %s", p->name, why.text);
    }
    m->after = same ? m->before : fl_moments_of(p, 1);
    return m->quality.open ? fl_part_rims(p, &m->rim, err) : 0;
}
