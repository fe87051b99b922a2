/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Packings of cubes and of Voronoi cells: nobody outside, no overlap, random orientations (P13).
 *
 * The axes of a body that is turned at random have a mean |cos| of 1/2 to any direction, of a body along
 * the axes of the box 1/3 over the three; one body scatters by 0.038. */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/rng.h"
#include "geom/clip.h"
#include "geom/mass.h"
#include "pack/growth.h"
#include "pack/packing_certificate.h"
#include "pack/throwing.h"
#include "support/near.h"
#include "support/verify.h"

/* Dilation radius over the size of a cell. */
static const double ROUND = 0.025;

typedef struct {
    fl_pack_region region;
    fl_pack_shapes shapes;
    fl_packing p;
    fl_overlaps o;
    fl_growth g;
    fl_packing_certificate c;
} sample;

static void stop(const fl_err *err)
{
    printf("shapes: %s\n", err->text);
    exit(1);
}

/* --- shapes ------------------------------------------------------------------------------------- */

static void write_shapes(const char *path, fl_ice_field *field)
{
    FILE *f = fopen(path, "w");
    fl_history_line by;
    fl_history_line_start(&by, "verify");
    if (!f) exit(1);
    fl_ice_field_write(f, field, &by);
    if (fclose(f)) exit(1);
    fl_ice_field_free(field);
}

static void write_cube(const char *path)
{
    fl_ice_field field = {0};
    fl_poly cube = {0};
    fl_err err = {0};
    const double h = 0.5 - ROUND;
    if (fl_poly_box(&cube, v3(h, h, h), &err) ||
        fl_ice_field_add(&field, 0, ROUND, &cube, NULL, NULL, v3(0, 0, 0), v3(0, 0, 0), &err))
        stop(&err);
    write_shapes(path, &field);
}

/* Cells of random points in a periodic cell of side 2.5: rocks of a mean volume of 1. */
static void write_rocks(const char *path)
{
    enum { POINTS = 16 };
    const double side = 2.52;
    fl_ice_field field = {0};
    fl_err err = {0};
    fl_vec3 at[POINTS];
    fl_rng g = fl_rng_of(4, 0, FL_RNG_TEST);
    for (int k = 0; k < POINTS; k++)
        at[k] = v3(fl_rng_in(&g, 0, side), fl_rng_in(&g, 0, side), fl_rng_in(&g, 0, side));
    for (int k = 0; k < POINTS; k++) {
        fl_poly cell = {0}, core = {0};
        if (fl_poly_box(&cell, v3(side, side, side), &err)) stop(&err);
        for (int j = 0; j < 27 * POINTS; j++) {
            const fl_vec3 image = v3(side * (j % 3 - 1), side * (j / 3 % 3 - 1), side * (j / 9 % 3 - 1)),
                          d = v3_sub(v3_add(at[j / 27], image), at[k]);
            if (v3_norm2(d) > 0.0 && fl_poly_cut(&cell, v3_unit(d), 0.5 * v3_norm(d), &err)) stop(&err);
        }
        if (fl_poly_offset(&core, &cell, -ROUND, &err) ||
            fl_ice_field_add(&field, k, ROUND, &core, NULL, NULL, v3(0, 0, 0), v3(0, 0, 0), &err))
            stop(&err);
        fl_poly_free(&cell);
    }
    write_shapes(path, &field);
}

/* --- packings ----------------------------------------------------------------------------------- */

/* n bodies of the sieve size d, so that the region is filled to `solid`. */
static void grow(sample *s, const char *in, const char *shape, int32_t n, double solid, uint64_t seed)
{
    const fl_growth_options opt = fl_growth_defaults();
    fl_err err = {0};
    double *d = malloc((size_t)n * sizeof *d);
    int halved;
    for (int32_t k = 0; k < n; k++) d[k] = 1.0;
    *s = (sample){.g = {0}};
    if (fl_region_make(&s->region, in, 3, "", &err) || fl_pack_shapes_make(&s->shapes, shape, &err) ||
        fl_packing_make(&s->p, 3, n, d, &s->shapes, seed, &err))
        stop(&err);
    free(d);
    const double scale = cbrt(solid * s->region.volume / fl_packing_volume(&s->p, 1.0, 0));
    for (int32_t i = 0; i < n; i++) s->p.size[i] *= scale, s->p.radius[i] *= scale, s->p.bound[i] *= scale;
    if (fl_throw_bodies(&s->p, &s->region, NULL, FL_THROW_REJECTION, seed, &halved, &err) ||
        fl_packing_sort(&s->p, &err) || fl_overlaps_make(&s->o, &s->p, &s->region, &err))
        stop(&err);
    s->g = fl_growth_start(&opt);
    const double t = omp_get_wtime();
    while (s->g.phase != FL_GROWTH_DONE)
        if (fl_growth_stage(&s->g, &s->o, &opt, &err)) stop(&err);
    if (fl_packing_certify(&s->c, &s->o, NULL, &err)) stop(&err);
    verify_note("%d bodies, %lld steps, %.1f s%s", n, (long long)s->o.steps, omp_get_wtime() - t,
                s->g.jammed ? ", jammed" : "");
}

static void release(sample *s)
{
    fl_overlaps_free(&s->o);
    fl_packing_free(&s->p);
    fl_pack_shapes_free(&s->shapes);
    fl_region_free(&s->region);
}

static void check(const sample *s, const char *name, double solid)
{
    char what[100];
    snprintf(what, sizeof what, "%s: solid part", name);
    verify_row("P13", what, s->c.solid, solid, 1e-9, VERIFY_ABS);
    snprintf(what, sizeof what, "%s: outside by, over the radius", name);
    verify_below("P13/P2", what, 1.0 - s->c.room, 1e-3);
    snprintf(what, sizeof what, "%s: bodies outside", name);
    verify_row("P13/P2", what, s->c.outside, 0.0, 0.0, VERIFY_ABS);
    snprintf(what, sizeof what, "%s: largest overlap over the radius", name);
    verify_below("P13/P7", what, s->c.max_overlap, 1e-6);
}

/* Mean |cos| of the face normals of cubes to the axes of the box, of those beyond 1.5 d from a wall. */
static double mean_cosine(const fl_packing *p, const fl_pack_region *r, int32_t *n)
{
    double sum = 0.0;
    *n = 0;
    for (int32_t i = 0; i < p->n; i++) {
        if (fl_region_distance(r, p->x[i], INFINITY) < 1.5 * p->size[i]) continue;
        const fl_mat3 axes = q_matrix(p->q[i]);
        ++*n;
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) sum += fabs(axes.m[a][b]) / 9.0;
    }
    return *n ? sum / *n : 0.0;
}

static void cubes(void)
{
    const int32_t n = verify_quick() ? 40 : 500;
    const double solid = verify_quick() ? 0.35 : 0.55, side = cbrt(n / solid);
    const char *path = test_path("cube.dat");
    sample s;
    char in[100];
    int32_t inner;
    write_cube(path);
    snprintf(in, sizeof in, "box:0,0,0,%.17g,%.17g,%.17g", side, side, side);
    grow(&s, in, path, n, solid, 3);
    check(&s, "cubes in a box", solid);
    const double cosine = mean_cosine(&s.p, &s.region, &inner);
    if (verify_quick()) verify_note("mean |cos| of %d cubes %.3f", inner, cosine);
    else verify_row("P13", "cubes: mean |cos| of face normals to the box", cosine, 0.5, 0.02, VERIFY_ABS);
    release(&s);
    remove(path);
}

static void rocks(void)
{
    const int32_t n = verify_quick() ? 20 : 500;
    const double solid = verify_quick() ? 0.35 : 0.55, side = cbrt(n / solid);
    const char *path = test_path("rocks.dat");
    char in[100], mesh[1000];
    sample s;
    write_rocks(path);
    snprintf(in, sizeof in, "box:0,0,0,%.17g,%.17g,%.17g", side, side, side);
    grow(&s, in, path, n, solid, 3);
    check(&s, "Voronoi rocks in a box", solid);
    release(&s);
    /* a hopper: the frustum of a pyramid, mouth 8, outlet 3, height 8 */
    snprintf(mesh, sizeof mesh, "%s", test_path("hopper.obj"));
    FILE *f = fopen(mesh, "w");
    if (!f ||
        fputs("v -1.5 -1.5 0\nv 1.5 -1.5 0\nv 1.5 1.5 0\nv -1.5 1.5 0\n"
              "v -4 -4 8\nv 4 -4 8\nv 4 4 8\nv -4 4 8\n"
              "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\n"
              "f 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n",
              f) < 0 ||
        fclose(f))
        exit(1);
    grow(&s, mesh, path, verify_quick() ? 20 : 200, verify_quick() ? 0.25 : 0.45, 5);
    check(&s, "rubble in a hopper", verify_quick() ? 0.25 : 0.45);
    release(&s);
    remove(mesh);
    remove(path);
}

int main(void)
{
    verify_begin("packings of polyhedra");
    omp_set_num_threads(1); /* programs run side by side */
    cubes();
    rocks();
    return verify_end();
}
