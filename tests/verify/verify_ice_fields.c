/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ice fields in water domains of every kind, and ice of every kind, against identities that hold for any
 * numbers: sums of areas and lengths, counts of lattices, filled parts. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "support/verify.h"
#include "base/array.h"
#include "ice/blocks.h"
#include "ice/certificate.h"
#include "ice/domain.h"
#include "ice/faces.h"
#include "ice/floes.h"
#include "ice/sphere_packing.h"
#include "ice/pancakes.h"
#include "ice/periodic.h"
#include "ice/thickness.h"

static const fl_vec2 LO = {-30.0, -20.0}, HI = {30.0, 20.0};

enum { SIDES_X = 60, SIDES_Y = 40 };

static int cells_of(int32_t n, uint64_t seed, int smooth, const int periodic[2], fl_power_cells *c,
                    fl_err *err)
{
    fl_vec2 *site = fl_alloc(n, sizeof *site, err);
    int rc = -1;
    if (!site) return -1;
    fl_random_sites(n, seed, LO, HI, site);
    if (fl_periodic_cells(c, n, site, LO, HI, periodic, err)) goto done;
    for (int k = 0; k < smooth; k++) {
        fl_power_cells_centroids(c, site);
        for (int32_t i = 0; i < n; i++) site[i] = fl_periodic_wrap(site[i], LO, HI, periodic);
        fl_power_cells_free(c);
        if (fl_periodic_cells(c, n, site, LO, HI, periodic, err)) goto done;
    }
    rc = 0;
done:
    free(site);
    return rc;
}

/* Level ice: each side is shared or lies on the outline, and of n regions in the plane at most 3 n - 6
 * pairs share a side (Euler). */
static int level_ice(int32_t n, fl_err *err)
{
    const int none[2] = {0, 0};
    fl_power_cells c = {0};
    fl_floes a = {0};
    fl_faces f = {0};
    double area = 0.0;
    int rc = -1;
    if (cells_of(n, 6, 2, none, &c, err) || fl_floes_fill(&a, &c, 0.0, (fl_vec2){0, 0}, err) ||
        fl_faces_find(&f, &a, err))
        goto done;
    for (int32_t i = 0; i < n; i++)
        area += fl_polygon_area(a.first[i + 1] - a.first[i], a.outer + a.first[i]);
    verify_note("%d floes without gaps on %d m x %d m", n, SIDES_X, SIDES_Y);
    verify_row("-", "area of all floes [m2]", area, SIDES_X * SIDES_Y, 1e-9, VERIFY_REL);
    verify_row("-", "outlines less shared sides, twice [m]", f.perimeter - 2.0 * f.total_length,
               2.0 * (SIDES_X + SIDES_Y), 1e-3, VERIFY_REL);
    verify_below("-", "deepest overlap over the tolerance of a shared side", f.max_overlap, f.tolerance);
    verify_true("-", "faces of a plane graph: at most 3 n - 6", f.n <= 3 * n - 6);
    rc = 0;
done:
    fl_faces_free(&f);
    fl_floes_free(&a);
    fl_power_cells_free(&c);
    return rc;
}

/* Two by two copies of a periodic field: four times the area, no overlap, and no gap narrower than inside
 * it. */
static int periodic_field(int32_t n, fl_err *err)
{
    const int both[2] = {1, 1};
    fl_power_cells c = {0};
    fl_floes a = {0}, t = {0};
    fl_certificate one, four;
    int32_t all;
    int rc = -1;
    if (cells_of(n, 7, 1, both, &c, err) || fl_floes_make(&a, &c, 0.85, 0.02, (fl_vec2){0, 0}, err))
        goto done;
    all = a.first[n];
    t.inset = a.inset;
    t.first = fl_alloc(4 * (int64_t)n + 1, sizeof *t.first, err);
    t.core = fl_alloc(4 * (int64_t)all, sizeof *t.core, err);
    t.outer = fl_alloc(4 * (int64_t)all, sizeof *t.outer, err);
    if (!t.first || !t.core || !t.outer) goto done;
    for (int k = 0; k < 4; k++)
        for (int32_t i = 0; i < n; i++) {
            const int32_t at = t.first[t.n], m = a.first[i + 1] - a.first[i];
            for (int32_t v = 0; v < m; v++) {
                const fl_vec2 p = a.core[a.first[i] + v], q = a.outer[a.first[i] + v];
                const double dx = SIDES_X * (k % 2), dy = SIDES_Y * (k / 2);
                t.core[at + v] = (fl_vec2){p.x + dx, p.y + dy};
                t.outer[at + v] = (fl_vec2){q.x + dx, q.y + dy};
            }
            t.first[++t.n] = at + m;
        }
    if (fl_certificate_make(&one, &a, err) || fl_certificate_make(&four, &t, err)) goto done;
    verify_note("%d floes of a periodic field, and two by two copies of it", n);
    verify_row("-", "concentration", one.total_area / (SIDES_X * SIDES_Y), 0.85, 1e-12, VERIFY_REL);
    verify_row("-", "area of the copies over that of one", four.total_area / one.total_area, 4.0, 1e-12,
               VERIFY_REL);
    verify_row("-", "overlaps", (double)four.overlaps, 0.0, 0.0, VERIFY_ABS);
    /* corners of floes stay inside their cells by half of the inset, also across a periodic border */
    verify_below("-", "inset over the narrowest gap of the copies", a.inset / four.min_gap, 1.0);
    rc = 0;
done:
    fl_floes_free(&t);
    fl_floes_free(&a);
    fl_power_cells_free(&c);
    return rc;
}

/* A star-shaped lake with an island; areas by the shoelace formula. */
static int lake(int32_t n, fl_err *err)
{
    enum { SHORE = 24 };
    fl_vec2 shore[SHORE], island[5], *site = fl_alloc(n, sizeof *site, err);
    const double pi = acos(-1.0);
    fl_domain d = {0};
    fl_power_cells c = {0};
    fl_pieces p = {0};
    fl_floes a = {0};
    fl_certificate cert;
    double area, whole;
    int rc = -1;
    for (int k = 0; k < SHORE; k++) {
        const double r = k % 2 ? 20.0 : 13.0 + 0.1 * k;
        shore[k] = (fl_vec2){r * cos(2 * pi * k / SHORE), r * sin(2 * pi * k / SHORE)};
    }
    for (int k = 0; k < 5; k++) island[k] = (fl_vec2){3 * cos(2 * pi * k / 5), 1 + 3 * sin(2 * pi * k / 5)};
    area = fl_polygon_area(SHORE, shore) - fl_polygon_area(5, island);
    if (!site || fl_domain_add(&d, SHORE, shore, err) || fl_domain_add(&d, 5, island, err) ||
        fl_domain_build(&d, err) || fl_domain_sites(n, 4, &d, site, err) ||
        fl_power_cells_build(&c, n, site, (fl_vec2){-25, -25}, (fl_vec2){25, 25}, err) ||
        fl_domain_cut(&p, &c, &d, 0.12, err))
        goto done;
    whole = 1.0 - p.dropped_area / p.area;
    if (fl_floes_make(&a, &p.cells, 0.7 / whole, 0.02, (fl_vec2){0, 0}, err) ||
        fl_certificate_make(&cert, &a, err))
        goto done;
    verify_note("%d floes in a lake of %d capes with an island", p.cells.n, SHORE / 2);
    verify_row("-", "water [m2]", p.area, area, 1e-12, VERIFY_REL);
    verify_row("-", "concentration of the water", cert.total_area / area, 0.7, 1e-11, VERIFY_REL);
    verify_row("-", "overlaps", (double)cert.overlaps, 0.0, 0.0, VERIFY_ABS);
    rc = 0;
done:
    fl_floes_free(&a);
    fl_pieces_free(&p);
    fl_power_cells_free(&c);
    fl_domain_free(&d);
    free(site);
    return rc;
}

/* Counts of published sheets.  The pairs of n rows of m in hexagonal layers follow from the lattice: n (m -
 * 1) + (n - 1)(2 m - 1) per layer. */
static int sheets(fl_err *err)
{
    fl_sphere_packing a = {0};
    int32_t in_layer;
    if (fl_sphere_packing_make(&a, FL_PACKING_HCP, 0.094, 3, (fl_vec2){0, 0}, (fl_vec2){20, 15}, err))
        return -1;
    verify_note("sheets of spheres");
    verify_row("S1", "spheres of 0.094 m, three layers on 20 m x 15 m", a.n, 117024, 0, VERIFY_ABS);
    fl_sphere_packing_free(&a);
    if (fl_sphere_packing_make(&a, FL_PACKING_HEX, 0.25, 2, (fl_vec2){0, 0}, (fl_vec2){100, 90}, err))
        return -1;
    in_layer = a.rows * (a.columns - 1) + (a.rows - 1) * (2 * a.columns - 1);
    verify_row("S1", "spheres of 0.25 m, two layers on 100 m x 90 m", a.n, 332000, 0, VERIFY_ABS);
    verify_row("S1", "pairs that touch", a.pairs, 2.0 * in_layer + a.rows * a.columns, 0, VERIFY_ABS);
    fl_sphere_packing_free(&a);
    return 0;
}

static int round_floes(int32_t n, fl_err *err)
{
    const int none[2] = {0, 0};
    fl_power_cells c = {0};
    fl_floes a = {0};
    fl_certificate cert;
    int rc = -1;
    if (cells_of(n, 8, 5, none, &c, err) || fl_pancakes_make(&a, &c, 24, 0.75, 0.02, (fl_vec2){0, 0}, err) ||
        fl_certificate_make(&cert, &a, err))
        goto done;
    verify_note("%d pancakes of 24 sides", n);
    verify_row("-", "concentration", cert.total_area / (SIDES_X * SIDES_Y), 0.75, 1e-12, VERIFY_REL);
    verify_row("-", "overlaps", (double)cert.overlaps, 0.0, 0.0, VERIFY_ABS);
    verify_true("-", "circularity above 0.94", fl_pancakes_circularity(&a) > 0.94);
    rc = 0;
done:
    fl_floes_free(&a);
    fl_power_cells_free(&c);
    return rc;
}

static int piles(int32_t n, fl_err *err)
{
    fl_poly box = {0};
    fl_blocks b = {0};
    int64_t pairs = -1;
    int rc = -1;
    if (fl_poly_box(&box, (fl_vec3){4, 3, 1}, err) || fl_blocks_cells(&b, &box, n, 5, 0, 1, err) ||
        fl_blocks_shrink(&b, 0.65, 0.01, err) || fl_blocks_overlaps(&b, 0.01, &pairs, err))
        goto done;
    verify_note("%d blocks in a box", n);
    verify_row("-", "cells [m3]", b.cells_volume, 96.0, 1e-11, VERIFY_REL);
    verify_row("-", "solid part", b.solid_volume / b.region_volume, 0.65, 1e-5, VERIFY_REL);
    verify_row("-", "overlaps", (double)pairs, 0.0, 0.0, VERIFY_ABS);
    rc = 0;
done:
    fl_blocks_free(&b);
    fl_poly_free(&box);
    return rc;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The mean of n numbers has the error cv / sqrt(n), four of which are hardly ever exceeded; Kolmogorov's
 * distance exceeds 1.95 / sqrt(n) once in a thousand times. */
static int thicknesses(int32_t n, fl_err *err)
{
    fl_thickness t = {0};
    double *h = fl_alloc(n, sizeof *h, err), sum = 0.0;
    if (!h || fl_thickness_parse(&t, "lognormal:0.6,0.4", err)) {
        free(h);
        return -1;
    }
    for (int32_t i = 0; i < n; i++) {
        int32_t again;
        sum += h[i] = fl_thickness_draw(&t, 11, i, 0.0, &again);
    }
    qsort(h, (size_t)n, sizeof *h, ascending);
    verify_note("thickness of %d floes, log-normal", n);
    verify_row("-", "mean [m]", sum / n, 0.6, 4.0 * 0.4 / sqrt(n), VERIFY_REL);
    verify_below("-", "Kolmogorov-Smirnov distance", fl_thickness_ks_distance(&t, 0.0, n, h), 1.95 / sqrt(n));
    free(h);
    return 0;
}

int main(void)
{
    const int q = verify_quick();
    fl_err err = {0};
    verify_begin("ice fields in water domains of every kind");
    if (level_ice(q ? 500 : 20000, &err) || periodic_field(q ? 300 : 5000, &err) ||
        lake(q ? 150 : 3000, &err) || sheets(&err) || round_floes(q ? 300 : 5000, &err) ||
        piles(q ? 60 : 1000, &err) || thicknesses(q ? 5000 : 200000, &err))
        verify_true("-", err.text, 0);
    return verify_end();
}
