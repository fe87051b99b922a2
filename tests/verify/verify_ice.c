/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ice fields as the solver sees them.  Each field is written to a file and read by the reader of dem-solve.
 * Its bodies are measured by the mass and buoyancy code of the solver, which shares no code with the
 * generator: core faces moved out by the dilation radius, volume and moments by the divergence theorem, and
 * the part below still water.  They are compared with the specification: concentration times area,
 * thickness and density; and with the draft of a prism, thickness times density over that of water, at
 * which a floe displaces its weight.  H05: cells that are slivers. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include "support/verify.h"
#include "base/array.h"
#include "base/parallel.h"
#include "base/pi.h"
#include "base/rng.h"
#include "geom/clip.h"
#include "geom/mass.h"
#include "ice/power_cells.h"
#include "ice/certificate.h"
#include "ice/floes.h"
#include "scene/ice_field.h"

#define THICKNESS 0.5
#define ICE 900.0
#define WATER 1025.0

struct measured {
    double mass;   /* of all [kg]                                              */
    double worst;  /* largest relative error of the mass of one                */
    double afloat; /* largest difference of weight and buoyancy over weight */
    double least;  /* smallest ratio of a floe's principal moments of inertia  */
    int32_t bodies;
};

static int add_floe(fl_ice_field *out, const fl_floes *a, int32_t i, double radius, fl_err *err)
{
    const double draft = THICKNESS * (ICE / WATER);
    const int32_t n = a->first[i + 1] - a->first[i];
    fl_vec3 *xy = fl_alloc(n, sizeof *xy, err);
    fl_poly core = {0};
    int rc = -1;
    if (!xy) return -1;
    for (int32_t k = 0; k < n; k++) xy[k] = v3(a->core[a->first[i] + k].x, a->core[a->first[i] + k].y, 0.0);
    rc = fl_poly_prism(&core, n, xy, radius - draft, THICKNESS - draft - radius, err) ||
                 fl_ice_field_add(out, i, radius, &core, "ice", NULL, v3(0, 0, 0), v3(0, 0, 0), err)
             ? -1
             : 0;
    free(xy);
    return rc;
}

/* Writes a field to a file and reads it back. */
static int write_and_read(fl_ice_field *field, fl_err *err)
{
    char path[300];
    const char *tmp = getenv("TMPDIR");
    fl_history_line by;
    fl_ice_field back = {0};
    FILE *f;
    int rc;
    snprintf(path, sizeof path, "%.200s/floe-ice-%ld", tmp ? tmp : "/tmp", (long)getpid());
    f = fopen(path, "w");
    if (!f) return fl_fail(err, FL_SYSTEM, "%s cannot be written", path);
    fl_history_line_start(&by, "verify_ice");
    fl_ice_field_write(f, field, &by);
    rc = fclose(f) == 0 ? fl_ice_field_read(&back, path, err) : -1;
    unlink(path);
    if (rc) return -1;
    fl_ice_field_free(field);
    *field = back;
    return 0;
}

static int measure_bodies(const fl_ice_field *field, const fl_floes *a, struct measured *s, fl_err *err)
{
    *s = (struct measured){.least = INFINITY, .bodies = field->n};
    for (int32_t i = 0; i < field->n; i++) {
        const double area = fl_polygon_area(a->first[i + 1] - a->first[i], a->outer + a->first[i]);
        fl_poly outer = {0};
        fl_mass whole = {0}, wet = {0};
        int rc = field->radius[i] > 0.0 ? fl_poly_offset(&outer, &field->core[i], field->radius[i], err)
                                        : fl_poly_copy(&outer, &field->core[i], err);
        if (rc == 0) rc = fl_mass_of(&whole, &outer, 0.0, err);
        if (rc == 0) rc = fl_poly_cut(&outer, v3(0, 0, 1), 0.0, err) || fl_mass_of(&wet, &outer, 0.0, err);
        fl_poly_free(&outer);
        if (rc) return -1;
        s->mass += ICE * whole.volume;
        s->worst = fmax(s->worst, fabs(whole.volume / (area * THICKNESS) - 1.0));
        s->afloat = fmax(s->afloat, fabs(WATER * wet.volume / (ICE * whole.volume) - 1.0));
        s->least = fmin(s->least, whole.inertia.x / whole.inertia.z);
    }
    return 0;
}

static int verify_field(const char *what, int32_t n, const fl_vec2 *site, fl_vec2 lo, fl_vec2 hi, int smooth,
                        double concentration, double radius, const char *id)
{
    fl_vec2 *x = NULL;
    fl_power_cells c = {0};
    fl_floes a = {0};
    fl_ice_field field = {0};
    fl_certificate t;
    struct measured s;
    fl_err err = {0};
    char text[120];
    int rc = -1;
    const double asked = concentration * (hi.x - lo.x) * (hi.y - lo.y) * THICKNESS * ICE;
    x = fl_alloc(n, sizeof *x, &err);
    if (!x) goto done;
    for (int32_t i = 0; i < n; i++) x[i] = site[i];
    for (int k = 0; k <= smooth; k++) {
        if (k) fl_power_cells_centroids(&c, x);
        fl_power_cells_free(&c);
        if (fl_power_cells_build(&c, n, x, lo, hi, &err)) goto done;
    }
    if (fl_floes_make(&a, &c, concentration, radius, (fl_vec2){0, 0}, &err) ||
        fl_certificate_make(&t, &a, &err))
        goto done;
    for (int32_t i = 0; i < n; i++)
        if (add_floe(&field, &a, i, radius, &err)) goto done;
    if (write_and_read(&field, &err) || measure_bodies(&field, &a, &s, &err)) goto done;
    verify_note("%s: %d floes, %d sides of cells dropped, %d moved in farther, %d corners cut off", what, n,
                a.dropped_sides, a.shifted_sides, a.blunted_corners);
    snprintf(text, sizeof text, "mass of all [kg]");
    verify_row(id, text, s.mass, asked, 1e-12, VERIFY_REL);
    verify_below(id, "mass of one, largest relative error", s.worst, 1e-12);
    verify_below(id, "weight and buoyancy of one at rest, difference", s.afloat, 1e-12);
    verify_below(id, "overlaps and floes that are not convex", (double)t.overlaps + t.nonconvex, 0.0);
    verify_true(id, "no corner of a core is sharper than the bound",
                t.min_angle >= FL_FLOES_SHARP_ANGLE * (1.0 - 1e-12));
    verify_true(id, "moments of inertia of all are positive", s.least > 0.0);
    rc = 0;
done:
    if (rc) verify_note("%s: %s", what, err.text);
    if (rc) verify_true(id, "the field can be made", 0);
    free(x);
    fl_ice_field_free(&field);
    fl_floes_free(&a);
    fl_power_cells_free(&c);
    return rc;
}

static void random_fields(void)
{
    static const double concentration[] = {0.1, 0.5, 0.8, 0.95, 0.98};
    enum { N = 2000 };
    static fl_vec2 site[N];
    const int32_t n = verify_quick() ? 300 : N;
    const double side = 4.0 * sqrt(n);
    const fl_vec2 lo = {1000.0, -0.5 * side}, hi = {1000.0 + side, 0.5 * side};
    char what[80];
    fl_random_sites(n, 7, lo, hi, site);
    for (int k = 0; k < 5; k++) {
        snprintf(what, sizeof what, "smoothed cells, concentration %g, radius 0.02 m", concentration[k]);
        verify_field(what, n, site, lo, hi, 2, concentration[k], 0.02, "mass");
        snprintf(what, sizeof what, "cells of random points, concentration %g, sharp", concentration[k]);
        verify_field(what, n, site, lo, hi, 0, concentration[k], 0.0, "mass");
    }
}

/* Sites in distant rows, close together in each row and displaced by `off` of their distance: the cells are
 * long and come to sharp points. */
static void needle_cells(void)
{
    enum { ACROSS = 60, ROWS = 4, N = ACROSS * ROWS };
    static const double off[] = {0.1, 0.3, 0.45};
    static fl_vec2 site[N];
    char what[80];
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < N; i++) {
            fl_rng g = fl_rng_of(9, i, FL_RNG_TEST);
            site[i].x = i % ACROSS + 0.5 + fl_rng_in(&g, -off[k], off[k]);
            site[i].y = 40.0 * (i / ACROSS + 0.5) + 10.0 * fl_rng_in(&g, -off[k], off[k]);
        }
        snprintf(what, sizeof what, "needles, displaced by up to %g of their width", off[k]);
        verify_field(what, N, site, (fl_vec2){0, 0}, (fl_vec2){ACROSS, 40 * ROWS}, 0, 0.7, k ? 0.0 : 0.005,
                     "H05");
    }
}

/* Squares whose sites are slightly displaced have sides as short as the displacement where four of them
 * meet. */
static void sliver_cells(void)
{
    enum { SIDE = 12, N = SIDE * SIDE };
    static const double off[] = {0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3};
    static fl_vec2 site[N];
    char what[80];
    for (int k = 0; k < 6; k++) {
        for (int i = 0; i < N; i++) {
            fl_rng g = fl_rng_of(5, i, FL_RNG_TEST);
            site[i].x = i % SIDE + 0.5 + fl_rng_in(&g, -off[k], off[k]);
            site[i].y = i / SIDE + 0.5 + fl_rng_in(&g, -off[k], off[k]);
        }
        snprintf(what, sizeof what, "a lattice of sites displaced by up to %.0e", off[k]);
        verify_field(what, N, site, (fl_vec2){0, 0}, (fl_vec2){SIDE, SIDE}, 0, 0.9, 0.02, "H05");
    }
    /* a cell of 1e-12 the area of the others, between six cells that meet in a point */
    for (int i = 0; i < N; i++) site[i] = (fl_vec2){i % SIDE + 0.4, i / SIDE + 0.7};
    for (int k = 0; k < 7; k++) {
        const double t = k * PI / 3.0, r = k < 6 ? 1e-6 : 0.0;
        site[60 + k] = (fl_vec2){5.3 + r * cos(t), 5.1 + r * sin(t)};
    }
    verify_field("a cell of area 1e-12", N, site, (fl_vec2){0, 0}, (fl_vec2){SIDE, SIDE}, 0, 0.9, 0.0, "H05");
}

int main(int argc, char **argv)
{
    (void)argc;
    fl_parallel_limit_spin(argv);
    verify_begin("Ice fields as the solver sees them");
    random_fields();
    sliver_cells();
    needle_cells();
    return verify_end();
}
