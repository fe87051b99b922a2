/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Packings: gradings against their closed forms, jammed densities against published and independently
 * computed ones, the law of walls, porosity asked and got, isotropy, regions with corners, shapes.
 *
 * Sources: jammed density and contacts of discs and spheres: O'Hern et al., Phys. Rev. E 68 (2003) 011306;
 * the same, and the constants of walls, by another code. */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/pi.h"
#include "pack/growth.h"
#include "pack/pack_world.h"
#include "pack/packing_certificate.h"
#include "pack/throwing.h"
#include "support/near.h"
#include "support/verify.h"

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
    printf("pack: %s\n", err->text);
    exit(1);
}

/* Discs or spheres of sizes d[n] in a region, grown. */
static void grow(sample *s, const char *in, int dim, const char *periodic, int32_t n, const double *d,
                 const char *shape, uint64_t seed)
{
    const fl_growth_options opt = fl_growth_defaults();
    fl_err err = {0};
    int halved;
    if (fl_region_make(&s->region, in, dim, periodic, &err) || fl_pack_shapes_make(&s->shapes, shape, &err) ||
        fl_packing_make(&s->p, dim, n, d, &s->shapes, seed, &err) ||
        fl_throw_bodies(&s->p, &s->region, NULL, FL_THROW_REJECTION, seed, &halved, &err) ||
        fl_packing_sort(&s->p, &err) || fl_overlaps_make(&s->o, &s->p, &s->region, &err))
        stop(&err);
    s->g = fl_growth_start(&opt);
    while (s->g.phase != FL_GROWTH_DONE)
        if (fl_growth_stage(&s->g, &s->o, &opt, &err)) stop(&err);
    if (fl_packing_certify(&s->c, &s->o, NULL, &err)) stop(&err);
}

static void release(sample *s)
{
    fl_overlaps_free(&s->o);
    fl_packing_free(&s->p);
    fl_pack_shapes_free(&s->shapes);
    fl_region_free(&s->region);
}

/* Sizes of a law for a solid part of a region's volume, in descending order. */
static double *draw(const char *law, int dim, double volume, int32_t *n)
{
    fl_grading g = {0};
    fl_err err = {0};
    double *d = NULL;
    int32_t empty;
    if (fl_grading_law(&g, law, dim, &err) != 1 ||
        fl_grading_draw(&g, dim, dim == 2 ? PI / 4.0 : PI / 6.0, volume, 0, &d, n, &empty, &err))
        stop(&err);
    fl_grading_free(&g);
    return d;
}

/* --- P1: gradings ------------------------------------------------------------------------------- */

static void check_grading(const char *name, const fl_grading *g, int dim, const double quantile[5],
                          double number)
{
    static const double U[5] = {0.1, 0.25, 0.5, 0.75, 0.9};
    const double v = dim == 2 ? PI / 4.0 : PI / 6.0;
    fl_err err = {0};
    char what[100];
    double *d, worst = 0.0, mass = 0.0, count = 0.0, sum = 0.0, all = 0.0;
    int32_t n, empty;
    for (int k = 0; quantile && k < 5; k++)
        worst = fmax(worst, fabs(fl_grading_quantile(g, dim, U[k]) / quantile[k] - 1.0));
    snprintf(what, sizeof what, "%s, %d-D: quantiles of the number curve, error", name, dim);
    if (quantile) verify_below("P1", what, worst, 1e-5);
    snprintf(what, sizeof what, "%s, %d-D: bodies per solid volume [1/mm%d]", name, dim, dim);
    verify_row("P1", what, fl_grading_number(g, dim) / v, number, 1e-5, VERIFY_REL);
    const double volume = 1000.0 * v / fl_grading_number(g, dim);
    if (fl_grading_draw(g, dim, v, volume, 0, &d, &n, &empty, &err)) stop(&err);
    for (int32_t k = 0; k < n; k++) all += v * pow(d[k], dim);
    for (int32_t k = n - 1; k >= 0; k--) {
        const double below = sum / all;
        sum += v * pow(d[k], dim);
        mass = fmax(mass, fmax(fabs(sum / all - fl_grading_mass(g, dim, d[k])),
                               fabs(below - fl_grading_mass(g, dim, d[k]))));
        count = fmax(count, fmax(fabs((double)(n - k) / n - fl_grading_count(g, dim, d[k])),
                                 fabs((double)(n - 1 - k) / n - fl_grading_count(g, dim, d[k]))));
    }
    snprintf(what, sizeof what, "%s, %d-D: 1000 bodies, distance of the mass curve", name, dim);
    verify_below("P1", what, mass, 2.0 / n + v * pow(d[0], dim) / all);
    snprintf(what, sizeof what, "%s, %d-D: 1000 bodies, distance of the number curve", name, dim);
    verify_below("P1", what, count, 0.005);
    snprintf(what, sizeof what, "%s, %d-D: 1000 bodies, solid volume", name, dim);
    verify_row("P1", what, all, volume, 1e-3, VERIFY_REL);
    free(d);
}

static void gradings(void)
{
    static const double uniform2[] = {1.05263, 1.14286, 1.33333, 1.60000, 1.81818},
                        uniform3[] = {1.03975, 1.10940, 1.26491, 1.51186, 1.75412},
                        fuller2[] = {2.14052, 2.40595, 3.10959, 4.74419, 7.85568},
                        fuller3[] = {2.08580, 2.24296, 2.63569, 3.46908, 4.96770};
    fl_err err = {0};
    for (int dim = 2; dim <= 3; dim++) {
        fl_grading u = {0}, f = {0}, s = {0};
        static fl_grading_piece sieve[] = {{1, 2, 0.1, 0}, {2, 4, 0.25, 0}, {4, 8, 0.4, 0}, {8, 16, 0.25, 0}};
        static const double share[2][3] = {{.52245, .84898, .97959}, {.72470, .95117, .99646}};
        if (fl_grading_law(&u, "uniform:1,2", dim, &err) < 0 ||
            fl_grading_law(&f, "fuller:0.5,2,20", dim, &err) < 0)
            stop(&err);
        s = (fl_grading){.pieces = 4, .piece = sieve};
        check_grading("uniform 1-2", &u, dim, dim == 2 ? uniform2 : uniform3, dim == 2 ? 0.636620 : 0.716197);
        check_grading("Fuller 2-20", &f, dim, dim == 2 ? fuller2 : fuller3, dim == 2 ? 0.0475184 : 0.0220117);
        check_grading("sieves 1-16", &s, dim, NULL, dim == 2 ? 0.1318475 : 0.1108932);
        for (int k = 0; k < 3; k++)
            verify_row("P1", "sieves 1-16: part of the bodies below 2, 4, 8",
                       fl_grading_count(&s, dim, 2 << k), share[dim - 2][k], 2e-5, VERIFY_ABS);
        fl_grading_free(&u);
        fl_grading_free(&f);
    }
}

/* --- P3, P9: discs ------------------------------------------------------------------------------ */

/* Half of n discs 1.4 times as large as the others; the region would be filled to 0.87. */
static void bidisperse(sample *s, int32_t n, uint64_t seed)
{
    double *d = malloc((size_t)n * sizeof *d), area = 0.0;
    char in[100];
    for (int32_t k = 0; k < n; k++) d[k] = k < n / 2 ? 1.4 : 1.0, area += PI / 4.0 * d[k] * d[k];
    const double L = sqrt(area / 0.87);
    snprintf(in, sizeof in, "box:0,0,0,%.17g,%.17g,0", L, L);
    grow(s, in, 2, "xy", n, d, "sphere", seed);
    free(d);
}

static double density_of(const sample *s, double scale)
{
    return fl_packing_volume(&s->p, scale, 0) / s->region.volume;
}

/* Compresses a jammed packing by dphi, and relaxes. */
static void compress(sample *s, double dphi)
{
    fl_err err = {0};
    const double phi = density_of(s, s->g.jam_scale);
    s->p.s = s->g.jam_scale * pow(1.0 + dphi / phi, 1.0 / s->p.dim);
    s->o.strict = 1;
    if (fl_overlaps_relax(&s->o, 0.0, 1e-4, 20000, &err) < 0) stop(&err);
    s->o.strict = 0;
    if (fl_packing_certify(&s->c, &s->o, NULL, &err)) stop(&err);
}

/* Where pairs are most frequent over the area of the ring: middle of a bin of 0.01 of r/(r_i + r_j). */
static double first_peak(const sample *s)
{
    enum { BINS = 100 };
    double count[BINS] = {0}, most = 0.0, at = 0.0;
    for (int32_t i = 0; i < s->p.n; i++)
        for (int32_t j = 0; j < i; j++) {
            const double r = v3_norm(fl_region_wrap(&s->region, v3_sub(s->p.x[i], s->p.x[j]))) /
                             (s->p.s * (s->p.radius[i] + s->p.radius[j]));
            if (r > 0.5 && r < 1.5) count[(int)((r - 0.5) * BINS)] += 1.0 / r;
        }
    for (int k = 0; k < BINS; k++)
        if (count[k] > most) most = count[k], at = 0.5 + (k + 0.5) / BINS;
    return at;
}

static void discs(void)
{
    const int seeds = verify_quick() ? 1 : 5, n = verify_quick() ? 400 : 1000;
    double phi = 0.0;
    for (int k = 0; k < seeds; k++) {
        sample s = {0};
        bidisperse(&s, n, 1 + (uint64_t)k);
        const double here = density_of(&s, s.g.jam_scale);
        phi += here / seeds;
        if (k == 0) {
            verify_below("P7", "jammed discs: largest overlap over the radius", s.c.max_overlap, 0.01);
            verify_below("P7", "jammed discs: unbalanced force over the mean contact force", s.c.unbalanced,
                         1e-3);
            compress(&s, 1e-3);
            verify_row("P9", "  first peak of the pair correlation in r/(r_i + r_j)", first_peak(&s), 1.0,
                       0.02, VERIFY_REL);
            verify_below("P9", "discs at phi_J + 0.001: F1 - F2 of the fabric", s.c.fabric[0] - s.c.fabric[1],
                         verify_quick() ? 0.08 : 0.05);
        }
        compress(&s, 1e-2);
        /* few discs scatter by more than the bound */
        if (verify_quick()) verify_note("Z - 4 at phi_J + 0.01: %.3f", s.c.without_rattlers - 4.0);
        else
            verify_row("P3", "discs at phi_J + 0.01: (Z - 4)/sqrt(phi - phi_J)",
                       (s.c.without_rattlers - 4.0) / 0.1, 3.5, 0.25, VERIFY_REL);
        verify_note("seed %d: phi_J %.4f, rattlers %d of %d", k + 1, here, s.c.rattlers, n);
        release(&s);
    }
    verify_row("P3", "jammed density of discs 1 : 1.4, periodic", phi, 0.839, verify_quick() ? 0.008 : 0.004,
               VERIFY_ABS);
}

/* --- P4, P5: spheres ---------------------------------------------------------------------------- */

static void equal_spheres(sample *s, int32_t n, double L, const char *periodic, uint64_t seed)
{
    double *d = malloc((size_t)n * sizeof *d);
    char in[100];
    for (int32_t k = 0; k < n; k++) d[k] = 1.0;
    snprintf(in, sizeof in, "box:0,0,0,%.17g,%.17g,%.17g", L, L, L);
    grow(s, in, 3, periodic, n, d, "sphere", seed);
    free(d);
}

static void spheres(void)
{
    const int seeds = verify_quick() ? 1 : 5, n = verify_quick() ? 400 : 2000;
    double phi = 0.0, slope = 0.0, q6 = 0.0;
    for (int k = 0; k < seeds; k++) {
        sample s = {0};
        equal_spheres(&s, n, cbrt(n * PI / 6.0 / 0.67), "xyz", 1 + (uint64_t)k);
        phi += density_of(&s, s.g.jam_scale) / seeds;
        q6 = fmax(q6, s.c.q6);
        compress(&s, 1e-2);
        slope += (s.c.without_rattlers - 6.0) / 0.1 / seeds;
        release(&s);
    }
    verify_row("P4", "jammed density of equal spheres, periodic", phi, 0.637, verify_quick() ? 0.012 : 0.006,
               VERIFY_ABS);
    verify_row("P4", "spheres at phi_J + 0.01: (Z - 6)/sqrt(phi - phi_J)", slope, verify_quick() ? 6.2 : 7.5,
               0.3, VERIFY_REL);
    verify_below("P4", "order Q6: no crystal", q6, 0.1);
    /* P5: the law of walls */
    const double sizes[] = {verify_quick() ? 5.0 : 7.7, 15.0};
    for (int c = 0; c < (verify_quick() ? 1 : 2); c++) {
        const int tries = verify_quick() ? 1 : 3;
        const double L = sizes[c];
        double in_box = 0.0;
        for (int k = 0; k < tries; k++) {
            sample s = {0};
            equal_spheres(&s, (int32_t)(0.66 * L * L * L * 6.0 / PI), L, "", 11 + (uint64_t)k);
            in_box += density_of(&s, s.g.jam_scale) / tries;
            if (c == 0 && k == 0) {
                verify_below("P2", "equal spheres in a box: outside by, over the radius", 1.0 - s.c.room,
                             1e-3);
                verify_below("P7", "jammed spheres: largest overlap over the radius", s.c.max_overlap, 0.01);
                verify_below("P7", "jammed spheres: unbalanced force over the mean contact force",
                             s.c.unbalanced, 1e-3);
            }
            release(&s);
        }
        verify_row("P5", "walls: (1 - phi(L)/phi) L/d", (1.0 - in_box / (verify_quick() ? 0.636 : phi)) * L,
                   0.75, 0.15, VERIFY_ABS);
    }
}

/* --- P6: porosity ------------------------------------------------------------------------------- */

static void porosities(void)
{
    const double ask[] = {0.50, 0.45, 0.42};
    const double L = verify_quick() ? 15.0 : 30.0;
    for (int k = 0; k < 3; k++) {
        sample s = {0};
        char in[100];
        int32_t n;
        double *d = draw("uniform:1,2", 3, (1.0 - ask[k]) * L * L * L, &n);
        snprintf(in, sizeof in, "box:0,0,0,%g,%g,%g", L, L, L);
        const double t = omp_get_wtime();
        if (verify_quick() && k) { /* one of them, in a smaller box */
            free(d);
            continue;
        }
        grow(&s, in, 3, "", n, d, "sphere", 3);
        verify_note("%d spheres in %.1f s, %lld steps", n, omp_get_wtime() - t, (long long)s.o.steps);
        verify_row("P6", "porosity in a box, sizes 1 to 2", 1.0 - s.c.solid, ask[k], 0.001, VERIFY_ABS);
        verify_below("P6", "largest overlap over the smaller radius", s.c.max_overlap, 1e-3);
        verify_below("P7", "below phi_J: largest overlap over the radius", s.c.max_overlap, 1e-6);
        verify_below("P2", "outside by, over the radius", 1.0 - s.c.room, 1e-3);
        free(d);
        release(&s);
    }
}

/* --- P2: regions with corners ------------------------------------------------------------------- */

static void write_file(const char *path, const char *text)
{
    FILE *f = fopen(path, "w");
    if (!f || fputs(text, f) < 0 || fclose(f)) exit(1);
}

static void corners(void)
{
    const char *dir = getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp";
    char outline[400], mesh[400];
    fl_pack_region r;
    fl_err err = {0};
    int32_t n;
    snprintf(outline, sizeof outline, "%s/verify-packing.%d.outline", dir, (int)(omp_get_wtime() * 1e3));
    /* a concave polygon with a wedge of 20 degrees and a hole */
    write_file(outline, "0 0\n20 0\n20 10\n12 10\n10 4\n8 10\n0 10\n\n3 3\n6 3\n6 5\n3 5\n");
    if (fl_region_make(&r, outline, 2, "", &err)) stop(&err);
    verify_row("P2", "concave outline with a hole: area", r.volume, 200.0 - 12.0 - 6.0, 1e-12, VERIFY_REL);
    fl_region_free(&r);
    double *d = draw("uniform:0.3,0.5", 2, 0.75 * 182.0, &n);
    sample s = {0};
    grow(&s, outline, 2, "", n, d, "sphere", 5);
    verify_row("P6", "concave outline with a hole: solid part", s.c.solid, 0.75, 1e-9, VERIFY_ABS);
    verify_below("P2", "concave outline with a hole: outside by, over the radius", 1.0 - s.c.room, 1e-3);
    verify_row("P2", "concave outline with a hole: bodies outside", s.c.outside, 0.0, 0.0, VERIFY_ABS);
    free(d);
    release(&s);
    remove(outline);
    /* a wedge of 20 degrees: a prism over a triangle of 10 x 3.64 m, 4 m wide */
    snprintf(mesh, sizeof mesh, "%s/verify-packing.%d.obj", dir, (int)(omp_get_wtime() * 1e3));
    write_file(mesh, "v 0 0 0\nv 10 0 0\nv 10 0 3.6397\nv 0 4 0\nv 10 4 0\nv 10 4 3.6397\n"
                     "f 1 2 3\nf 4 6 5\nf 1 5 2\nf 1 4 5\nf 2 5 6\nf 2 6 3\nf 1 3 6\nf 1 6 4\n");
    d = draw("uniform:0.3,0.5", 3, 0.5 * 72.794, &n);
    s = (sample){0};
    grow(&s, mesh, 3, "", n, d, "sphere", 5);
    verify_row("P2", "wedge of 20 degrees: volume", s.region.volume, 0.5 * 10.0 * 3.6397 * 4.0, 1e-12,
               VERIFY_REL);
    verify_row("P6", "wedge of 20 degrees: solid part", s.c.solid, 0.5, 1e-9, VERIFY_ABS);
    verify_below("P2", "wedge of 20 degrees: outside by, over the radius", 1.0 - s.c.room, 1e-3);
    free(d);
    release(&s);
    remove(mesh);
}

/* --- P14: hard ---------------------------------------------------------------------------------- */

static void hard_cases(void)
{
    double one = 1.0, d[3010];
    sample s = {0};
    grow(&s, "box:0,0,0,2,2,2", 3, "", 1, &one, "sphere", 1);
    verify_below("P14", "one sphere: outside by, over the radius", 1.0 - s.c.room, 1e-12);
    release(&s);
    /* size ratio 50: fines between coarse discs, periodic along x alone */
    int32_t n = 0;
    const int fines = verify_quick() ? 700 : 3000;
    for (int k = 0; k < (verify_quick() ? 2 : 6); k++) d[n++] = 4.0;
    for (int k = 0; k < fines; k++) d[n++] = 0.08;
    s = (sample){0};
    grow(&s, verify_quick() ? "box:0,0,0,8.4,5,0" : "box:0,0,0,12,12,0", 2, "x", n, d, "sphere", 2);
    verify_below("P14", "size ratio 50: largest overlap over the smaller radius", s.c.max_overlap, 1e-3);
    verify_below("P14", "size ratio 50: outside by, over the radius", 1.0 - s.c.room, 1e-3);
    release(&s);
    /* two parts joined by a neck of three sizes */
    const char *path = test_path("neck.outline");
    write_file(path, "0 0\n6 0\n6 2.55\n8 2.55\n8 0\n14 0\n14 6\n8 6\n8 3.45\n6 3.45\n6 6\n0 6\n");
    double *one_size = malloc(1200 * sizeof *one_size);
    const int32_t bodies = (int32_t)(0.78 * (72.0 + 1.8) / (PI / 4.0 * 0.09));
    for (int32_t k = 0; k < bodies; k++) one_size[k] = 0.3 - 0.1 * k / bodies;
    s = (sample){0};
    grow(&s, path, 2, "", bodies, one_size, "sphere", 4);
    int32_t in_neck = 0, left = 0;
    for (int32_t k = 0; k < s.p.n; k++)
        left += s.p.x[k].x<6.0, in_neck += s.p.x[k].x> 6.0 && s.p.x[k].x < 8.0;
    verify_row("P14", "a neck of three sizes: bodies outside", s.c.outside, 0.0, 0.0, VERIFY_ABS);
    verify_true("P14", "  bodies in the neck and in either part",
                in_neck > 5 && left > 100 && left < s.p.n - 100);
    release(&s);
    free(one_size);
    remove(path);
    /* a solid part that no packing has */
    double *wide = draw("uniform:1,2", 2, 0.9 * (verify_quick() ? 225.0 : 900.0), &n);
    s = (sample){0};
    grow(&s, verify_quick() ? "box:0,0,0,15,15,0" : "box:0,0,0,30,30,0", 2, "", n, wide, "sphere", 6);
    verify_true("P14", "a solid part of 0.9: the discs jam", s.g.jammed);
    verify_row("P14", "  at (phi of discs of 1 to 2, less the effect of walls)", s.c.solid,
               0.845 * (1.0 - 0.42 * 1.5 / (verify_quick() ? 15.0 : 30.0)), 0.02, VERIFY_ABS);
    release(&s);
    free(wide);
}

/* --- P11: steps --------------------------------------------------------------------------------- */

/* The seconds of these are in bench/pack.sh. */
static void many(void)
{
    sample s = {0};
    int32_t n;
    if (verify_quick()) return;
    double *d = draw("uniform:1,2", 2, 0.82 * 440.0 * 440.0, &n);
    grow(&s, "box:0,0,0,440,440,0", 2, "", n, d, "sphere", 1);
    verify_note("%d discs to 0.82", n);
    verify_below("P11", "100 000 discs to 0.82: steps of relaxation", (double)s.o.steps, 3000);
    verify_below("P11", "  largest overlap over the radius", s.c.max_overlap, 1e-6);
    release(&s);
    free(d);
    d = draw("single:1", 3, 0.6 * 20.6 * 20.6 * 20.6, &n);
    s = (sample){0};
    grow(&s, "box:0,0,0,20.6,20.6,20.6", 3, "", n, d, "sphere", 1);
    verify_note("%d spheres to 0.60", n);
    verify_below("P11", "10 000 spheres to 0.60: steps of relaxation", (double)s.o.steps, 3000);
    verify_below("P11", "  largest overlap over the radius", s.c.max_overlap, 1e-6);
    release(&s);
    free(d);
}

/* --- growth by steps with friction -------------------------------------------------------------- */

/* Solid part at which 500 equal spheres in a periodic box jam. */
static double jam_moving(double friction)
{
    const fl_pack_motion m = {
        .friction = friction, .restitution = 0.2, .young = 1e8, .density = 900.0, .rest = 1e-3};
    sample s = {0};
    double d[500];
    fl_pack_moved moved;
    fl_err err = {0};
    int halved;
    for (int k = 0; k < 500; k++) d[k] = 1.0;
    if (fl_region_make(&s.region, "box:0,0,0,7.35,7.35,7.35", 3, "xyz", &err) ||
        fl_pack_shapes_make(&s.shapes, "sphere", &err) ||
        fl_packing_make(&s.p, 3, 500, d, &s.shapes, 1, &err) ||
        fl_throw_bodies(&s.p, &s.region, NULL, FL_THROW_REJECTION, 1, &halved, &err) ||
        fl_packing_sort(&s.p, &err) || fl_overlaps_make(&s.o, &s.p, &s.region, &err) ||
        fl_pack_grow_moving(&s.p, &s.region, &m, &s.o, NULL, NULL, &moved, &err))
        stop(&err);
    const double phi = fl_packing_volume(&s.p, moved.jammed ? moved.jam_scale : 1.0, 0) / s.region.volume;
    release(&s);
    return phi;
}

/* Friction decides how dense: from random close packing to random loose packing, 0.55. */
static void friction(void)
{
    if (verify_quick()) return;
    verify_row("P4", "grown by steps without friction: solid part", jam_moving(0.0), 0.637, 0.01, VERIFY_ABS);
    verify_row("P4", "grown by steps with friction 0.5, random loose", jam_moving(0.5), 0.56, 0.03,
               VERIFY_ABS);
}

int main(void)
{
    verify_begin("packings");
    omp_set_num_threads(1); /* programs run side by side */
    gradings();
    corners();
    hard_cases();
    porosities();
    discs();
    spheres();
    many();
    friction();
    return verify_end();
}
