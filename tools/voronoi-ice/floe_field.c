/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "floe_field.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "base/stream.h"
#include "ice/power_cells.h"
#include "ice/certificate.h"
#include "ice/faces.h"
#include "ice/floes.h"
#include "ice/concentration_gradient.h"
#include "ice/floe_gaps.h"
#include "ice/prescribed_areas.h"
#include "ice/pancakes.h"
#include "ice/periodic.h"
#include "certificate_table.h"
#include "field_plot.h"
#include "floe_thickness.h"
#include "recipe.h"
#include "ridge.h"
#include "floe_sizing.h"
#include "open_water.h"

/* One layer of floes.  Layers of rafted ice lie above each other. */
struct layer {
    fl_power_cells cells; /* freed after measuring, except their number */
    fl_floes floes;
    int32_t *cell_of;            /* [floes.n] index of the cell of a floe */
    double full_area;            /* of the floes before some were removed [m2] */
    double floe_area, cell_area; /* of the floes and of their cells after that [m2] */
    fl_certificate certificate;
    struct floe_sizing sizing;
    fl_floe_gaps gaps; /* of --gaps random */
    struct open_water water;
    fl_faces faces; /* of a bonded field */
    struct floe_thickness thickness;
    struct ridges ridges;
    double target;                 /* concentration */
    double max_error;              /* graded: largest error of the concentration of a floe */
    double min_target, max_target; /* graded: range of the concentration */
    int32_t first_id;              /* rafted: added to the ids of the layer */
    double lift; /* rafted: height above the position of the layer if it floated alone [m] */
};

/* Gap between layers of rafted ice over their thickness: no layer touches another at the start. */
#define LAYER_GAP 1e-3

static void print_stage(const struct recipe *o, const char *what)
{
    if (o->verbose) fprintf(stderr, "voronoi-ice: %s\n", what);
}

/* Id of a floe in the file: the index of the site; further pieces of a cell follow all sites. */
static int32_t id_of(const struct layer *a, int32_t i)
{
    return a->first_id + (a->water.is_domain && a->water.id ? a->water.id[a->cell_of[i]] : a->cell_of[i]);
}

static int is_periodic(const struct recipe *o) { return o->periodic[0] || o->periodic[1]; }

static int build_cells(const struct recipe *o, const fl_vec2 *site, fl_vec2 lo, fl_vec2 hi,
                       fl_power_cells *cells, fl_err *err)
{
    if (is_periodic(o)) return fl_periodic_cells(cells, o->floes, site, lo, hi, o->periodic, err);
    return fl_power_cells_build(cells, o->floes, site, lo, hi, err);
}

static int make_cells(const struct recipe *o, struct layer *a, fl_err *err)
{
    const fl_outline in = open_water_outline(&a->water, o);
    fl_power_cells *cells = &a->cells;
    fl_vec2 *site;
    int rc = -1;
    print_stage(o, "dividing the field into cells");
    if (a->water.is_domain) return open_water_cells(&a->water, o, cells, err);
    if (!(site = fl_alloc(o->floes, sizeof *site, err))) return -1;
    fl_random_sites(o->floes, o->seed, in.lo, in.hi, site);
    if (build_cells(o, site, in.lo, in.hi, cells, err)) goto done;
    for (int k = 0; k < o->smooth; k++) {
        print_stage(o, "smoothing");
        fl_power_cells_centroids(cells, site);
        for (int32_t i = 0; i < o->floes; i++) site[i] = fl_periodic_wrap(site[i], in.lo, in.hi, o->periodic);
        fl_power_cells_free(cells);
        if (build_cells(o, site, in.lo, in.hi, cells, err)) goto done;
    }
    rc = 0;
done:
    free(site);
    return rc;
}

/* The concentration of a cell is that at its centroid; for a linear change the cells add up to the
 * integral over the field.  factor compensates the area of slivers. */
static int make_graded_floes(const struct recipe *o, struct layer *a, double factor, fl_err *err)
{
    const fl_vec2 hi = {0.5 * o->size.x, 0.5 * o->size.y}, lo = {-hi.x, -hi.y}, shift = a->water.shift;
    const double angle = o->grade_angle * (acos(-1.0) / 180.0);
    double *part = fl_alloc(a->cells.n, sizeof *part, err), *area = fl_alloc(a->cells.n, sizeof *area, err);
    fl_concentration_gradient g = {0};
    int rc = -1;
    if (!part || !area) goto done;
    if (o->grade_file ? fl_concentration_read(&g, angle, o->grade_file, err)
                      : fl_concentration_linear(&g, angle, o->grade[0], o->grade[1],
                                                (fl_vec2){lo.x + shift.x, lo.y + shift.y},
                                                (fl_vec2){hi.x + shift.x, hi.y + shift.y}, err))
        goto done;
    fl_power_cells_areas(&a->cells, area);
    a->min_target = a->max_target = NAN;
    for (int32_t i = 0; i < a->cells.n; i++) {
        const int32_t first = a->cells.first[i], n = a->cells.first[i + 1] - first;
        const fl_vec2 m = fl_polygon_centroid(n, a->cells.v + first);
        const double c = fl_concentration_at(&g, (fl_vec2){m.x + shift.x, m.y + shift.y});
        a->min_target = fmin(a->min_target, c);
        a->max_target = fmax(a->max_target, c);
        part[i] = c * factor;
        area[i] *= part[i];
    }
    a->target = fl_parallel_sum(area, a->cells.n) / a->water.area;
    rc = fl_floes_make_graded(&a->floes, &a->cells, part, o->radius, shift, &a->max_error, err);
done:
    fl_concentration_free(&g);
    free(part);
    free(area);
    return rc;
}

/* Make floes inside the cells; other cells compensate the area of the slivers, which have no floe. */
static int make_floes(const struct recipe *o, struct layer *a, fl_err *err)
{
    const struct open_water *w = &a->water;
    const double part = 1.0 - w->sliver_area / w->area;
    print_stage(o, "shrinking the cells");
    a->target = o->bonded ? 1.0 : o->concentration;
    if (o->graded) return make_graded_floes(o, a, 1.0 / part, err);
    if (o->bonded) return fl_floes_fill(&a->floes, &a->cells, o->radius, w->shift, err);
    if (!(o->concentration < part))
        return fl_fail(err, FL_INPUT,
                       "the pieces of cells that have room for a floe cover %.6g of the water, %.10g is "
                       "requested: more floes or a smaller radius is needed",
                       part, o->concentration);
    if (o->pancakes)
        return fl_pancakes_make(&a->floes, &a->cells, o->pancakes, o->concentration / part, o->radius,
                                w->shift, err);
    return fl_floes_make(&a->floes, &a->cells, o->concentration / part, o->radius, w->shift, err);
}

/* Make cells and floes together: the cells are adjusted until the floes have the requested areas. */
static int make_floes_of_sizes(const struct recipe *o, struct layer *a, fl_err *err)
{
    const fl_outline in = open_water_outline(&a->water, o);
    double off;
    print_stage(o, "dividing the field into cells of given areas");
    a->target = o->bonded ? 1.0 : o->concentration;
    if (o->bonded) {
        if (fl_prescribed_areas_cells(&a->cells, o->floes, o->seed, a->sizing.area, &in, o->smooth, err) ||
            fl_floes_fill(&a->floes, &a->cells, o->radius, a->water.shift, err))
            return -1;
    } else if (fl_prescribed_areas_floes(&a->cells, &a->floes, o->floes, o->seed, a->sizing.area, &in,
                                         o->smooth, o->concentration, o->radius, a->water.shift, &off, err))
        return -1;
    return floe_sizing_measure(&a->sizing, &a->floes, err);
}

/* --- taking floes out ----------------------------------------------------------------------------------- */

static int meets_shape(const struct keep_out *s, int32_t n, const fl_vec2 *v)
{
    const fl_vec2 box[4] = {s->lo, {s->hi.x, s->lo.y}, s->hi, {s->lo.x, s->hi.y}};
    if (s->circle) return fl_polygon_point_distance(n, v, s->lo) <= s->r;
    return !fl_polygon_is_apart(n, v, 4, box);
}

/* 1 if a floe meets a shape, a structure or, in a periodic field, a copy of them.  w: room for n corners. */
static int meets_kept_out(const struct recipe *o, const struct layer *a, int32_t n, const fl_vec2 *v,
                          fl_vec2 *w)
{
    for (int ky = -o->periodic[1]; ky <= o->periodic[1]; ky++)
        for (int kx = -o->periodic[0]; kx <= o->periodic[0]; kx++) {
            for (int32_t k = 0; k < n; k++)
                w[k] = (fl_vec2){v[k].x + kx * o->size.x, v[k].y + ky * o->size.y};
            if (open_water_removes(&a->water, n, w)) return 1;
            for (int k = 0; k < o->keep_outs; k++)
                if (meets_shape(&o->keep_out[k], n, w)) return 1;
        }
    return 0;
}

static int removes_floes(const struct recipe *o, const struct layer *a)
{
    return o->keep_outs || a->water.removed.rings;
}

static int remove_floes(const struct recipe *o, struct layer *a, fl_err *err)
{
    char *gone = fl_alloc(a->floes.n, 1, err);
    fl_vec2 *w = fl_alloc(a->floes.first[a->floes.n], sizeof *w, err);
    if (!gone || !w) {
        free(gone);
        free(w);
        return -1;
    }
    for (int32_t i = 0; i < a->floes.n; i++) {
        const int32_t n = a->floes.first[i + 1] - a->floes.first[i];
        gone[i] = (char)meets_kept_out(o, a, n, a->floes.outer + a->floes.first[i], w);
    }
    fl_floes_remove(&a->floes, gone, a->cell_of);
    free(gone);
    free(w);
    if (a->floes.n) return 0;
    return fl_fail(err, FL_INPUT, "all %d floes meet kept-out regions: none is left", o->floes);
}

/* --- the file ------------------------------------------------------------------------------------------- */

/* Core of a floe: an upright floating prism.  Still water is z = 0; the outer shape extends from -draft to
 * thickness - draft.  The core is only written after the check, so its derived data are dropped. */
static int make_core(const struct recipe *o, const struct layer *a, int32_t i, fl_poly *core, fl_err *err)
{
    const int32_t first = a->floes.first[i], n = a->floes.first[i + 1] - first;
    const double h = floe_thickness_at(&a->thickness, o, id_of(a, i)), draft = h * a->thickness.draft_ratio;
    fl_vec3 *xy = fl_alloc(n, sizeof *xy, err);
    fl_err why = {0};
    int rc;
    if (!xy) return -1;
    for (int32_t k = 0; k < n; k++) xy[k] = v3(a->floes.core[first + k].x, a->floes.core[first + k].y, 0.0);
    rc = fl_poly_prism(core, n, xy, o->radius - draft + a->lift, h - draft - o->radius + a->lift, &why);
    free(xy);
    if (rc == 0) return fl_poly_strip(core, err);
    return fl_fail(err, why.code == FL_INPUT ? FL_NUMERIC : why.code, "floe %d: %s", id_of(a, i), why.text);
}

static int add_floes(const struct recipe *o, const struct layer *a, fl_ice_field *out, fl_err *err)
{
    const int32_t n = a->floes.n;
    const fl_vec3 v = v3(o->velocity.x, o->velocity.y, 0.0);
    fl_poly *core = fl_alloc(n, sizeof *core, err);
    int32_t bad = INT32_MAX;
    int rc = -1;
    if (!core) return -1;
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < n; i++) {
        fl_err why = {0};
        if (make_core(o, a, i, &core[i], &why) == 0) continue;
#pragma omp critical
        if (i < bad) { /* report the first floe, independent of the threads */
            bad = i;
            *err = why;
        }
    }
    if (bad < INT32_MAX) goto done;
    for (int32_t i = 0; i < n; i++)
        if (fl_ice_field_add(out, id_of(a, i), o->radius, &core[i], o->material, NULL, v, v3(0, 0, 0), err))
            goto done;
    rc = 0;
done:
    for (int32_t i = 0; i < n; i++) fl_poly_free(&core[i]);
    free(core);
    return rc;
}

/* Height of the common face of two prisms and, in middle, the z of its centre. */
static double common_face_height(const struct recipe *o, const struct layer *a, const fl_face *f,
                                 double *middle)
{
    const double hi = floe_thickness_at(&a->thickness, o, id_of(a, f->i)),
                 hj = floe_thickness_at(&a->thickness, o, id_of(a, f->j));
    const double h = fmin(hi, hj),
                 r = a->thickness.draft_ratio; /* the thinner floe has the lower top and the higher bottom */
    *middle = (0.5 - r) * h;
    return h;
}

static int add_bonds(const struct recipe *o, const struct layer *a, fl_ice_field *out, fl_err *err)
{
    for (int32_t k = 0; k < a->faces.n; k++) {
        const fl_face *f = &a->faces.face[k];
        const double length = hypot(f->b.x - f->a.x, f->b.y - f->a.y);
        double z;
        const double area = length * common_face_height(o, a, f, &z);
        if (fl_ice_field_add_bond(out, f->i, f->j, area, length,
                                  v3(0.5 * (f->a.x + f->b.x), 0.5 * (f->a.y + f->b.y), z), err))
            return -1;
    }
    return 0;
}

static int write_field(struct recipe *o, const struct layer *a, int32_t layers, fl_err *err)
{
    fl_ice_field out = {0};
    fl_out file = {0};
    fl_history_line by;
    int rc = -1;
    for (int32_t k = 0; k < layers; k++)
        if (add_floes(o, &a[k], &out, err)) goto done;
    if (add_bonds(o, a, &out, err) || ridges_add(&a->ridges, o, &out, err)) goto done;
    recipe_set_id(o, &out);
    recipe_history(o, &by);
    if (fl_out_open(&file, o->out, o->gzip, err)) goto done;
    fl_ice_field_write(file.f, &out, &by);
    rc = fl_out_close(&file, err);
done:
    fl_ice_field_free(&out);
    return rc;
}

/* --- the certificate ------------------------------------------------------------------------------------ */

/* If no floe was removed, the perimeters without the shared sides are the outline of the field. */
static void add_face_rows(const struct recipe *o, const struct layer *a, struct certificate_table *t)
{
    const fl_faces *f = &a->faces;
    const double open = f->perimeter - 2.0 * f->total_length, outline = 2.0 * (o->size.x + o->size.y);
    double area = 0.0;
    certificate_add(t, "overlap, deepest [m]", 0, f->max_overlap, f->max_overlap, 4, NULL);
    certificate_add(t, "bond candidates", NOT_REQUESTED, f->n, NO_DISTANCE, 10, NULL);
    for (int32_t k = 0; k < f->n; k++) {
        double z;
        area += hypot(f->face[k].b.x - f->face[k].a.x, f->face[k].b.y - f->face[k].a.y) *
                common_face_height(o, a, &f->face[k], &z);
    }
    certificate_add(t, "bonded area [m2]", NOT_REQUESTED, area, NO_DISTANCE, 6, NULL);
    if (removes_floes(o, a) || a->water.is_domain)
        certificate_add(t, "sides on no other [m]", NOT_REQUESTED, open, NO_DISTANCE, 6, NULL);
    else
        certificate_add(t, "sides on no other [m]", outline, open, fabs(open - outline) / f->perimeter, 6,
                        NULL);
}

static void add_certificate_rows(const struct recipe *o, const struct layer *a, struct certificate_table *t)
{
    const fl_certificate *c = &a->certificate;
    const double area = a->water.area, concentration = a->full_area / area;
    certificate_add(t, "floes", o->floes, a->cells.n, abs(a->cells.n - o->floes), 10, NULL);
    if (o->sizes) floe_sizing_certify(&a->sizing, o, a->floes.inset, t);
    certificate_add(t, "concentration", a->target, concentration, fabs(concentration - a->target), 10, NULL);
    if (o->graded) {
        certificate_add(t, "concentration, from", NOT_REQUESTED, a->min_target, NO_DISTANCE, 6, NULL);
        certificate_add(t, "concentration, to", NOT_REQUESTED, a->max_target, NO_DISTANCE, 6, NULL);
        certificate_add(t, "concentration, worst floe", 0, a->max_error, a->max_error, 4, NULL);
    }
    if (o->periodic[0])
        certificate_add(t, "period along x [m]", NOT_REQUESTED, o->size.x, NO_DISTANCE, 10, NULL);
    if (o->periodic[1])
        certificate_add(t, "period along y [m]", NOT_REQUESTED, o->size.y, NO_DISTANCE, 10, NULL);
    open_water_certify(&a->water, o, t);
    if (removes_floes(o, a)) {
        certificate_add(t, "floes kept out", NOT_REQUESTED, a->cells.n - a->floes.n, NO_DISTANCE, 10, NULL);
        certificate_add(t, "floes left", NOT_REQUESTED, a->floes.n, NO_DISTANCE, 10, NULL);
        certificate_add(t, "concentration, whole field", NOT_REQUESTED, a->floe_area / area, NO_DISTANCE, 6,
                        NULL);
        certificate_add(t, "concentration, cells left", NOT_REQUESTED, a->floe_area / a->cell_area,
                        NO_DISTANCE, 6, NULL);
    }
    if (o->bonded) add_face_rows(o, a, t);
    else certificate_add(t, "overlaps", 0, (double)c->overlaps, (double)c->overlaps, 10, NULL);
    certificate_add(t, "floes not convex", 0, c->nonconvex, c->nonconvex, 10, NULL);
    floe_thickness_certify(&a->thickness, o, t);
    ridges_certify(&a->ridges, o, t);
    certificate_add(t, "area, mean [m2]", NOT_REQUESTED, c->mean_area, NO_DISTANCE, 6, NULL);
    certificate_add(t, "area, deviation over mean", NOT_REQUESTED, c->cv, NO_DISTANCE, 4, NULL);
    certificate_add(t, "area, smallest [m2]", NOT_REQUESTED, c->min_area, NO_DISTANCE, 6, "floe %d",
                    id_of(a, c->min_area_floe));
    certificate_add(t, "area, largest [m2]", NOT_REQUESTED, c->max_area, NO_DISTANCE, 6, "floe %d",
                    id_of(a, c->max_area_floe));
    certificate_add(t, "sides of a floe, mean", NOT_REQUESTED, c->mean_sides, NO_DISTANCE, 4, NULL);
    certificate_add(t, "shortest side of a core [m]", NOT_REQUESTED, c->min_side, NO_DISTANCE, 4, "floe %d",
                    id_of(a, c->min_side_floe));
    certificate_add(t, "sharpest corner [degrees]", NOT_REQUESTED, c->min_angle * (180.0 / acos(-1.0)),
                    NO_DISTANCE, 4, "floe %d", id_of(a, c->min_angle_floe));
    if (c->min_gap_pair[0] >= 0 && !o->bonded)
        certificate_add(t, "narrowest gap [m]", NOT_REQUESTED, c->min_gap, NO_DISTANCE, 6, "floes %d and %d",
                        id_of(a, c->min_gap_pair[0]), id_of(a, c->min_gap_pair[1]));
    if (o->gaps == GAPS_RANDOM) {
        certificate_add(t, "gap between neighbours, median [m]", NOT_REQUESTED, a->gaps.median, NO_DISTANCE,
                        6, NULL);
        certificate_add(t, "gap between neighbours, 90 % [m]", NOT_REQUESTED, a->gaps.q90, NO_DISTANCE, 6,
                        NULL);
        certificate_add(t, "floes that touch another", NOT_REQUESTED, a->gaps.touching, NO_DISTANCE, 4, NULL);
    }
    certificate_add(t, "inset of the cells [m]", NOT_REQUESTED, a->floes.inset, NO_DISTANCE, 6, NULL);
    certificate_add(t, "floes inset less: small cells", NOT_REQUESTED, a->floes.limited, NO_DISTANCE, 10,
                    NULL);
    if (o->pancakes) {
        certificate_add(t, "circularity, mean", NOT_REQUESTED, fl_pancakes_circularity(&a->floes),
                        NO_DISTANCE, 6, NULL);
        return;
    }
    certificate_add(t, "sides of cells dropped", NOT_REQUESTED, a->floes.dropped_sides, NO_DISTANCE, 10,
                    NULL);
    if (a->floes.blunted_corners)
        certificate_add(t, "corners below 5 degrees cut off", NOT_REQUESTED, a->floes.blunted_corners,
                        NO_DISTANCE, 10, NULL);
    certificate_add(t, "sides moved in farther", NOT_REQUESTED, a->floes.shifted_sides, NO_DISTANCE, 10,
                    NULL);
}

/* Measure gaps and overlaps of a periodic field, with copies of the floes one period away.  Of two
 * opposite directions one is enough. */
static int measure_copies(const struct recipe *o, struct layer *a, fl_err *err)
{
    static const int step[5][2] = {{0, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};
    const int32_t n = a->floes.n, all = a->floes.first[n];
    fl_floes t = {.inset = a->floes.inset};
    fl_certificate c;
    int rc = -1;
    t.first = fl_alloc(5 * (int64_t)n + 1, sizeof *t.first, err);
    t.outer = fl_alloc(5 * (int64_t)all, sizeof *t.outer, err);
    t.core = fl_alloc(5 * (int64_t)all, sizeof *t.core, err);
    if (!t.first || !t.outer || !t.core) goto done;
    for (int k = 0; k < 5; k++) {
        const fl_vec2 d = {step[k][0] * o->size.x, step[k][1] * o->size.y};
        if ((step[k][0] && !o->periodic[0]) || (step[k][1] && !o->periodic[1])) continue;
        for (int32_t i = 0; i < n; i++) {
            const int32_t from = a->floes.first[i], m = a->floes.first[i + 1] - from, at = t.first[t.n];
            for (int32_t v = 0; v < m; v++) {
                t.outer[at + v] =
                    (fl_vec2){a->floes.outer[from + v].x + d.x, a->floes.outer[from + v].y + d.y};
                t.core[at + v] = (fl_vec2){a->floes.core[from + v].x + d.x, a->floes.core[from + v].y + d.y};
            }
            t.first[++t.n] = at + m;
        }
    }
    if (fl_certificate_make(&c, &t, err)) goto done;
    a->certificate.overlaps = c.overlaps;
    a->certificate.min_gap = c.min_gap;
    for (int k = 0; k < 2; k++)
        a->certificate.min_gap_pair[k] = c.min_gap_pair[k] < 0 ? -1 : c.min_gap_pair[k] % n;
    rc = 0;
done:
    fl_floes_free(&t);
    return rc;
}

static int measure_floes(const struct recipe *o, struct layer *a, fl_err *err)
{
    if (fl_certificate_make(&a->certificate, &a->floes, err)) return -1;
    a->full_area = a->floe_area = a->certificate.total_area;
    if (removes_floes(o, a)) {
        if (remove_floes(o, a, err) || fl_certificate_make(&a->certificate, &a->floes, err)) return -1;
        a->floe_area = a->certificate.total_area;
    }
    if (is_periodic(o) && measure_copies(o, a, err)) return -1;
    for (int32_t i = 0; i < a->floes.n; i++) {
        const int32_t first = a->cells.first[a->cell_of[i]];
        a->cell_area += fl_polygon_area(a->cells.first[a->cell_of[i] + 1] - first, a->cells.v + first);
    }
    if (a->certificate.nonconvex)
        return fl_fail(err, FL_NUMERIC, "%d floes are not convex: nothing is written",
                       a->certificate.nonconvex);
    if (o->bonded) {
        if (fl_faces_find(&a->faces, &a->floes, err)) return -1;
        if (a->faces.max_overlap <= a->faces.tolerance) return 0;
        return fl_fail(err, FL_NUMERIC, "floes %d and %d overlap by %g m: nothing is written",
                       id_of(a, a->faces.max_overlap_pair[0]), id_of(a, a->faces.max_overlap_pair[1]),
                       a->faces.max_overlap);
    }
    if (a->certificate.overlaps)
        return fl_fail(err, FL_NUMERIC,
                       "%lld pairs of floes overlap, floes %d and %d among them: nothing is written",
                       (long long)a->certificate.overlaps, id_of(a, a->certificate.min_gap_pair[0]),
                       id_of(a, a->certificate.min_gap_pair[1]));
    return 0;
}

static int measure_thickness(const struct recipe *o, struct layer *a, fl_err *err)
{
    const int32_t n = a->floes.n;
    int32_t *id = fl_alloc(n, sizeof *id, err);
    double *area = fl_alloc(n, sizeof *area, err);
    int rc = -1;
    if (id && area) {
        for (int32_t i = 0; i < n; i++) {
            const int32_t first = a->floes.first[i];
            id[i] = id_of(a, i);
            area[i] = fl_polygon_area(a->floes.first[i + 1] - first, a->floes.outer + first);
        }
        rc = floe_thickness_measure(&a->thickness, o, n, id, area, err);
    }
    free(id);
    free(area);
    return rc;
}

static void free_cells_but_count(struct layer *a)
{
    const int32_t n = a->cells.n;
    fl_power_cells_free(&a->cells);
    a->cells.n = n;
}

static int make_layer(struct recipe *o, struct layer *a, fl_err *err)
{
    if (open_water_make(&a->water, o, a->thickness.max, err) ||
        (o->sizes && floe_sizing_assign(&a->sizing, o, a->water.area, err)))
        return -1;
    if (o->sizes ? make_floes_of_sizes(o, a, err) : make_cells(o, a, err) || make_floes(o, a, err)) return -1;
    if (o->gaps == GAPS_RANDOM) {
        fl_floes_push(&a->floes, &a->cells, a->water.shift, o->seed);
        if (fl_floe_gaps_measure(&a->gaps, &a->floes, &a->cells, a->water.shift, err)) return -1;
    }
    a->cell_of = fl_alloc(a->cells.n, sizeof *a->cell_of, err);
    if (!a->cell_of) return -1;
    for (int32_t i = 0; i < a->cells.n; i++) a->cell_of[i] = i;
    if (o->ridges) print_stage(o, "piling up blocks");
    if (ridges_make(&a->ridges, o, err)) return -1;
    print_stage(o, "measuring");
    if (measure_floes(o, a, err) || measure_thickness(o, a, err)) return -1;
    free_cells_but_count(a);
    return 0;
}

static void free_layer(struct layer *a)
{
    floe_sizing_free(&a->sizing);
    fl_faces_free(&a->faces);
    open_water_free(&a->water);
    floe_thickness_free(&a->thickness);
    ridges_free(&a->ridges);
    fl_floes_free(&a->floes);
    fl_power_cells_free(&a->cells);
    free(a->cell_of);
}

/* Depth of the bottom of n layers of thickness h with equal concentration [m].  The ice displaces a height of
 * ratio n h of water; gaps displace none. */
static double bottom_depth(int32_t n, double h, double ratio)
{
    const double wet = ratio * n * h, full = floor(wet / h);
    return full * h * (1.0 + LAYER_GAP) + (wet - full * h);
}

/* Make all layers, one above the other; further layers have seeds derived from the first. */
static int make_layers(struct recipe *o, struct layer *a, fl_err *err)
{
    const double h = o->thickness, deep = bottom_depth(o->layers, h, a->thickness.draft_ratio);
    const uint64_t seed = o->seed;
    int64_t id = 0;
    int rc = 0;
    for (int32_t k = 0; k < o->layers && rc == 0; k++) {
        fl_rng g = fl_rng_of(seed, k, FL_RNG_LAYER);
        if (k) o->seed = fl_rng_u64(&g);
        if ((k && floe_thickness_read(&a[k].thickness, o, err)) || make_layer(o, &a[k], err)) rc = -1;
        if (rc == 0 && o->layers > 1) {
            a[k].first_id = (int32_t)id;
            a[k].lift = h * a->thickness.draft_ratio - deep + k * h * (1.0 + LAYER_GAP);
            /* pieces of cells have ids after the sites */
            id += (int64_t)o->floes + a[k].cells.n;
            if (id > INT32_MAX)
                rc = fl_fail(err, FL_INPUT, "%d layers have more floes than there are ids", o->layers);
        }
    }
    o->seed = seed;
    return rc;
}

static void add_layer_rows(const struct recipe *o, const struct layer *a, struct certificate_table *t)
{
    double off = 0.0;
    int64_t overlaps = 0;
    int32_t floes = 0;
    if (o->layers == 1) return;
    for (int32_t k = 0; k < o->layers; k++) {
        floes += a[k].floes.n;
        overlaps += a[k].certificate.overlaps;
        off = fmax(off, fabs(a[k].full_area / a[k].water.area - a[k].target));
    }
    certificate_add(t, "layers", o->layers, o->layers, 0, 10, "the rows above are of the lowest");
    certificate_add(t, "layers, floes in all", NOT_REQUESTED, floes, NO_DISTANCE, 10, NULL);
    certificate_add(t, "layers, worst concentration", NOT_REQUESTED, NOT_REQUESTED, off, 10, NULL);
    certificate_add(t, "layers, overlaps", 0, (double)overlaps, (double)overlaps, 10, NULL);
    certificate_add(t, "layers, depth of the lowest [m]", NOT_REQUESTED,
                    bottom_depth(o->layers, o->thickness, a->thickness.draft_ratio), NO_DISTANCE, 6, NULL);
}

void floe_field_history(const struct recipe *o, fl_history_line *by)
{
    recipe_history_floes(o, by);
    if (o->layers > 1) fl_history_line_add(by, "--layers %d", o->layers);
}

/* Read the thickness; layers need a constant one, ridges that or a size of their blocks. */
static int read_thickness(struct recipe *o, struct floe_thickness *d, fl_err *err)
{
    if (floe_thickness_read(d, o, err)) return -1;
    if (d->law.kind == FL_THICKNESS_CONSTANT) {
        if (o->ridges && !(o->block > 0.0)) o->block = o->thickness;
        return 0;
    }
    if (o->layers > 1) return fl_fail(err, FL_USAGE, "--layers needs one thickness, not a law");
    if (o->ridges && !(o->block > 0.0))
        return fl_fail(err, FL_USAGE,
                       "--ridge in ice whose thickness is a law needs the size of its blocks, --block");
    return 0;
}

int floe_field_make(struct recipe *o, fl_err *err)
{
    struct certificate_table table = {0};
    struct layer *a = fl_alloc(o->layers, sizeof *a, err);
    fl_history_line by;
    int rc = -1;
    if (!a) return -1;
    if (read_thickness(o, &a->thickness, err) || make_layers(o, a, err)) goto done;
    print_stage(o, "writing");
    if (write_field(o, a, o->layers, err)) goto done;
    add_certificate_rows(o, a, &table);
    add_layer_rows(o, a, &table);
    recipe_history(o, &by);
    if (o->certificate && certificate_write(&table, o->certificate, &by, err)) goto done;
    if (!o->quiet) certificate_print(&table);
    if (o->plot && plot_field(o, &a->floes, o->sizes ? &a->sizing : NULL, &by, err)) goto done;
    rc = 0;
done:
    for (int32_t k = 0; k < o->layers; k++) free_layer(&a[k]);
    free(a);
    return rc;
}
