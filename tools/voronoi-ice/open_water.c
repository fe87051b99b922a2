/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "geom/surface.h"
#include "ice/domain_read.h"
#include "ice/waterplane_cut.h"
#include "mesh/gstruct.h"
#include "open_water.h"

/* Margin of the box of the cells over the size of the domain: no side of a cell lies on a side of the
 * domain. */
#define BOX_MARGIN 0.05

enum { DISC_MIN_SIDES = 24, DISC_MAX_SIDES = 720 };

/* --- rings of the domain -------------------------------------------------------------------------------- */

/* A regular polygon with the area of the disc and sides of about half a floe. */
static int add_disc(fl_domain *d, const struct recipe *o, fl_err *err)
{
    const double r = o->disc[0], floe = sqrt(PI / o->floes) * r;
    const int want = (int)fmin(DISC_MAX_SIDES, ceil(2.0 * PI * r / (0.5 * floe)));
    const int n = want < DISC_MIN_SIDES ? DISC_MIN_SIDES : want;
    const double out = r * sqrt(2.0 * PI / (n * sin(2.0 * PI / n)));
    fl_vec2 v[DISC_MAX_SIDES];
    for (int k = 0; k < n; k++)
        v[k] = (fl_vec2){o->disc[1] + out * cos(2.0 * PI * k / n), o->disc[2] + out * sin(2.0 * PI * k / n)};
    return fl_domain_add(d, n, v, err);
}

static int add_rectangle(fl_domain *d, const struct recipe *o, fl_err *err)
{
    const fl_vec2 lo = o->origin, hi = {lo.x + o->size.x, lo.y + o->size.y};
    const fl_vec2 v[4] = {lo, {hi.x, lo.y}, hi, {lo.x, hi.y}};
    return fl_domain_add(d, 4, v, err);
}

/* A strip of open water between two points, with square ends. */
static int add_lead(fl_domain *d, const double *x, fl_err *err)
{
    const double l = hypot(x[2] - x[0], x[3] - x[1]);
    const double nx = -0.5 * x[4] * (x[3] - x[1]) / l, ny = 0.5 * x[4] * (x[2] - x[0]) / l;
    const fl_vec2 v[4] = {
        {x[0] - nx, x[1] - ny}, {x[2] - nx, x[3] - ny}, {x[2] + nx, x[3] + ny}, {x[0] + nx, x[1] + ny}};
    return fl_domain_add(d, 4, v, err);
}

/* The part of the structure between the bottom and the top of ice of thickness h. */
static int add_structure(struct open_water *w, fl_domain *d, const struct recipe *o, double h,
                         const char *path, fl_err *err)
{
    const double draft = h * (o->ice_density / o->water_density);
    const double coarse = OPEN_WATER_COARSE * sqrt(o->size.x * o->size.y / o->floes);
    fl_surface s = {0};
    int32_t kept = 0;
    int rc;
    if (fl_gstruct_read(&s, path, err)) return -1;
    rc = fl_waterplane_keep_out(d, &s, -draft, h - draft, o->margin, coarse, &kept, err);
    w->structures += kept;
    fl_surface_free(&s);
    return rc;
}

/* Move the domain to the origin, where coordinates have the finest resolution; the field is shifted back
 * at the end. */
static void centre_domain(struct open_water *w, struct recipe *o)
{
    fl_domain *d = &w->domain;
    o->origin = d->lo;
    o->size = (fl_vec2){d->hi.x - d->lo.x, d->hi.y - d->lo.y};
    w->shift = (fl_vec2){0.5 * (d->lo.x + d->hi.x), 0.5 * (d->lo.y + d->hi.y)};
    for (int32_t k = 0; k < d->corners; k++) {
        d->v[k].x -= w->shift.x;
        d->v[k].y -= w->shift.y;
    }
    d->lo = (fl_vec2){d->lo.x - w->shift.x, d->lo.y - w->shift.y};
    d->hi = (fl_vec2){d->hi.x - w->shift.x, d->hi.y - w->shift.y};
}

/* Add the rings of leads, ridges and structures. */
static int add_kept_out_rings(struct open_water *w, fl_domain *d, const struct recipe *o, double h,
                              fl_err *err)
{
    for (int k = 0; k < o->leads; k++)
        if (add_lead(d, o->lead[k], err)) return -1;
    for (int k = 0; k < o->ridges; k++) { /* strip for sail and keel */
        const double *r = o->ridge[k], x[5] = {r[0], r[1], r[2], r[3], fmax(r[5], r[7])};
        if (add_lead(d, x, err)) return -1;
    }
    for (int k = 0; k < o->structures; k++)
        if (add_structure(w, d, o, h, o->structure[k], err)) return -1;
    return 0;
}

int open_water_make(struct open_water *w, struct recipe *o, double h, fl_err *err)
{
    const int open = o->leads || o->ridges || o->structures,
              whole = o->sizes || o->periodic[0] || o->periodic[1];
    w->is_domain = o->outline || o->disc[0] > 0.0 || (open && !whole);
    w->area = o->size.x * o->size.y;
    w->shift = (fl_vec2){o->origin.x + 0.5 * o->size.x, o->origin.y + 0.5 * o->size.y};
    if (!w->is_domain) return open ? add_kept_out_rings(w, &w->removed, o, h, err) : 0;
    if (o->outline         ? fl_domain_read(&w->domain, o->outline, err)
        : o->disc[0] > 0.0 ? add_disc(&w->domain, o, err)
                           : add_rectangle(&w->domain, o, err))
        return -1;
    o->size = (fl_vec2){w->domain.hi.x - w->domain.lo.x, w->domain.hi.y - w->domain.lo.y};
    if (add_kept_out_rings(w, o->sizes ? &w->removed : &w->domain, o, h, err)) return -1;
    centre_domain(w, o);
    if (fl_domain_build(&w->domain, err)) return -1;
    if (fl_domain_is_convex(&w->domain)) w->area = fl_polygon_area(w->domain.corners, w->domain.v);
    else if (o->sizes) return fl_fail(err, FL_INPUT, "--sizes needs water whose outline is convex");
    return 0;
}

/* 1 if the ring m has p inside. */
static int surrounds(int32_t m, const fl_vec2 *ring, fl_vec2 p)
{
    int inside = 0;
    for (int32_t k = 0; k < m; k++) {
        const fl_vec2 a = ring[k], b = ring[(k + 1) % m];
        if ((a.y <= p.y) != (b.y <= p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
            inside = !inside;
    }
    return inside;
}

/* A floe meets a ring that it is inside of, or whose sides it meets. */
int open_water_removes(const struct open_water *w, int32_t n, const fl_vec2 *v)
{
    for (int32_t r = 0; r < w->removed.rings; r++) {
        const int32_t m = w->removed.first[r + 1] - w->removed.first[r];
        const fl_vec2 *ring = w->removed.v + w->removed.first[r];
        if (surrounds(m, ring, v[0])) return 1;
        for (int32_t k = 0; k < m; k++) {
            const fl_vec2 side[2] = {ring[k], ring[(k + 1) % m]};
            if (!fl_polygon_is_apart(n, v, 2, side)) return 1;
        }
    }
    return 0;
}

fl_outline open_water_outline(const struct open_water *w, const struct recipe *o)
{
    const fl_vec2 hi = {0.5 * o->size.x, 0.5 * o->size.y};
    fl_outline in = {.lo = {-hi.x, -hi.y}, .hi = hi};
    if (w->is_domain) {
        in.n = w->domain.corners;
        in.v = w->domain.v;
    }
    return in;
}

/* --- cells ---------------------------------------------------------------------------------------------- */

static int cut_cells(const struct open_water *w, const struct recipe *o, const fl_vec2 *site, double least,
                     fl_pieces *out, fl_err *err)
{
    const double m = BOX_MARGIN * (w->domain.hi.x - w->domain.lo.x + w->domain.hi.y - w->domain.lo.y);
    const fl_vec2 lo = {w->domain.lo.x - m, w->domain.lo.y - m},
                  hi = {w->domain.hi.x + m, w->domain.hi.y + m};
    fl_power_cells cells = {0};
    int rc;
    if (fl_power_cells_build(&cells, o->floes, site, lo, hi, err)) return -1;
    rc = fl_domain_cut(out, &cells, &w->domain, least, err);
    fl_power_cells_free(&cells);
    return rc;
}

static void move_to_centroids(const fl_pieces *p, fl_vec2 *site)
{
    for (int32_t k = 0; k < p->largest; k++) {
        const int32_t first = p->cells.first[k];
        site[p->parent[k]] = fl_polygon_centroid(p->cells.first[k + 1] - first, p->cells.v + first);
    }
}

/* Of a graded field, about. */
static double concentration_of(const struct recipe *o)
{
    return o->graded && !o->grade_file ? 0.5 * (o->grade[0] + o->grade[1]) : o->concentration;
}

int open_water_cells(struct open_water *w, const struct recipe *o, fl_power_cells *cells, fl_err *err)
{
    fl_vec2 *site = fl_alloc(o->floes, sizeof *site, err);
    fl_pieces p = {0};
    double least;
    int rc = -1;
    if (!site || fl_domain_sites(o->floes, o->seed, &w->domain, site, err) ||
        cut_cells(w, o, site, 0.0, &p, err))
        goto done;
    /* The inset takes about half of 1 - sqrt(C) of the size of a cell, and a core needs room in addition to
     * the dilation radius. */
    least = fmax((OPEN_WATER_SLIVER + (o->bonded ? 0.0 : 0.5 * (1.0 - sqrt(concentration_of(o))))) *
                     sqrt(p.area / o->floes),
                 1.5 * o->radius);
    for (int k = 0; k < o->smooth; k++) {
        move_to_centroids(&p, site);
        fl_pieces_free(&p);
        if (cut_cells(w, o, site, 0.0, &p, err)) goto done;
    }
    fl_pieces_free(&p);
    if (cut_cells(w, o, site, least, &p, err)) goto done;
    if (p.cells.n == 0) {
        fl_fail(err, FL_INPUT,
                "no piece of the water has room for a floe: more floes or a smaller radius is needed");
        goto done;
    }
    w->id = fl_alloc(p.cells.n, sizeof *w->id, err);
    if (!w->id) goto done;
    for (int32_t k = 0; k < p.cells.n; k++) w->id[k] = k < p.largest ? p.parent[k] : o->floes + k - p.largest;
    w->area = p.area;
    w->sliver_area = p.dropped_area;
    w->slivers = p.dropped;
    *cells = p.cells;
    p.cells = (fl_power_cells){0};
    rc = 0;
done:
    fl_pieces_free(&p);
    free(site);
    return rc;
}

/* --- the certificate ------------------------------------------------------------------------------------ */

void open_water_certify(const struct open_water *w, const struct recipe *o, struct certificate_table *t)
{
    if (o->structures && !w->is_domain)
        certificate_add(t, "parts of structures kept out", NOT_REQUESTED, w->structures, NO_DISTANCE, 10,
                        NULL);
    if (!w->is_domain) return;
    if (o->disc[0] > 0.0 && w->domain.rings == 1) {
        const double requested = PI * o->disc[0] * o->disc[0];
        certificate_add(t, "water [m2]", requested, w->area, fabs(w->area - requested) / requested, 10, NULL);
    } else {
        certificate_add(t, "water [m2]", NOT_REQUESTED, w->area, NO_DISTANCE, 10, NULL);
    }
    if (o->structures)
        certificate_add(t, "parts of structures kept out", NOT_REQUESTED, w->structures, NO_DISTANCE, 10,
                        NULL);
    certificate_add(t, "slivers left open [m2]", NOT_REQUESTED, w->sliver_area, NO_DISTANCE, 4, "%d",
                    w->slivers);
}

void open_water_free(struct open_water *w)
{
    fl_domain_free(&w->domain);
    fl_domain_free(&w->removed);
    free(w->id);
    *w = (struct open_water){0};
}
