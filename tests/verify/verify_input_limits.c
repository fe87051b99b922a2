/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hard cases of the input: shapes, files, meshes, waves.  No step is made. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/pi.h"
#include "geom/facet.h"
#include "geom/mass.h"
#include "geom/mesh_patch.h"
#include "geom/surface.h"
#include "scene/ice_field.h"
#include "support/near.h"
#include "support/verify.h"
#include "water/wave.h"

/* Four corners within 1e-12 of one plane are no solid; a plate of no thickness is a core with a dilation
 * radius. */
static void cores_without_volume(void)
{
    const double h = 1e-12, r = 0.3;
    const fl_vec3 flat[4] = {v3(0, 0, 0), v3(2, 0, 0), v3(0, 1, 0), v3(0.5, 0.3, h)};
    const int32_t first[5] = {0, 3, 6, 9, 12}, loop[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    const fl_vec3 plate[4] = {v3(0, 0, 0), v3(2, 0, 0), v3(2, 1, 0), v3(0, 1, 0)};
    const int32_t ends[3] = {0, 4, 8}, round[8] = {0, 1, 2, 3, 3, 2, 1, 0};
    fl_poly p = {0};
    fl_mass m;
    fl_err err = {0};
    const int refused =
        fl_poly_make(&p, 4, flat, 4, first, loop, &err) && err.code == FL_INPUT && err.text[0];
    verify_true("H06", "four corners in one plane within 1e-12: refused with a sentence", refused);
    err = (fl_err){0};
    if (fl_poly_make(&p, 4, plate, 2, ends, round, &err) || fl_mass_of(&m, &p, r, &err)) exit(1);
    verify_row("H13", "radius above half the thickness: volume of a plate by Steiner", m.volume,
               2.0 * 2.0 * r + 0.5 * PI * r * r * 6.0 + 4.0 / 3.0 * PI * r * r * r, 1e-14, VERIFY_REL);
    fl_poly_free(&p);
}

/* A file of bodies with one error. */
static int read_body(const char *numbers)
{
    char text[400];
    fl_ice_field f = {0};
    fl_err err = {0};
    snprintf(text, sizeof text, "#g-polys 1\npoly 1 0.5 1 0\n%s\n", numbers);
    const int rc = fl_ice_field_read(&f, test_file("bad.dat", text, strlen(text)), &err);
    if (rc == 0) fl_ice_field_free(&f);
    return rc == 0 ? 0 : err.code == FL_INPUT && strstr(err.text, "bad.dat:") ? 1 : -1000;
}

/* A cube with a duplicate corner, and one in the middle of an edge. */
static void redundant_corners(void)
{
    static const char CLEAN[] = "#g-polys 1\npoly 1 0.05 8 6\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n"
                                "v 1 0 1\nv 1 1 1\nv 0 1 1\nf 4 0 3 2 1\nf 4 4 5 6 7\nf 4 0 1 5 4\n"
                                "f 4 1 2 6 5\nf 4 2 3 7 6\nf 4 3 0 4 7\n";
    static const char MORE[] = "#g-polys 1\npoly 1 0.05 10 7\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n"
                               "v 1 0 1\nv 1 1 1\nv 0 1 1\nv 1 1 1\nv 0.5 0 0\nf 5 0 3 2 1 9\nf 5 4 5 6 8 7\n"
                               "f 5 0 9 1 5 4\nf 4 1 2 8 5\nf 4 2 3 7 6\nf 4 3 0 4 7\nf 3 6 8 7\n";
    fl_ice_field f[2] = {{0}};
    fl_mass m[2];
    fl_err err = {0};
    for (int k = 0; k < 2; k++) {
        const char *text = k ? MORE : CLEAN;
        if (fl_ice_field_read(&f[k], test_file("cube.dat", text, strlen(text)), &err) ||
            fl_mass_of(&m[k], &f[k].core[0], 0.05, &err)) {
            fprintf(stderr, "%s\n", err.text);
            exit(1);
        }
    }
    verify_row("H07", "duplicate corner, corner on an edge: dilated volume", m[1].volume, m[0].volume, 1e-15,
               VERIFY_REL);
    verify_row("H07", "and moment of inertia", m[1].inertia.x, m[0].inertia.x, 1e-15, VERIFY_REL);
    verify_row("H07", "corners left", f[1].core[0].nv, 9, 0, VERIFY_ABS);
    for (int k = 0; k < 2; k++) fl_ice_field_free(&f[k]);
}

static void bad_numbers(void)
{
    static const char *const BAD[] = {"v 0 0 nan", "v 0 inf 0", "v 0,5 0 0",
                                      "v 0 0",     "v 0 0 0 0", "v 0 0 1e999"};
    int refused = 0;
    for (int k = 0; k < 6; k++) refused += read_body(BAD[k]);
    verify_row("H37", "nan, inf, comma, too few, too many, 1e999: refused with file and line", refused, 6, 0,
               VERIFY_ABS);
    verify_row("H37", "lines that end in CR LF are accepted", read_body("v 0 0 0\r"), 0, 0, VERIFY_ABS);
}

/* A wave a tenth below the breaking height, and one a tenth above it: in deep water and in shallow water. */
static void breaking_waves(void)
{
    const double depth[2] = {(double)INFINITY, 2.0};
    double first[2];
    for (int k = 0; k < 2; k++) {
        double limit;
        const double one = fl_wave_steepness(1.0, 3.0, depth[k], 9.81, &limit);
        const double below = fl_wave_steepness(0.9 * limit / one, 3.0, depth[k], 9.81, &limit);
        const double above = fl_wave_steepness(1.1 * limit / one, 3.0, depth[k], 9.81, &limit);
        first[k] = limit;
        verify_true("H39",
                    k ? "2 m of water: refused a tenth above breaking, accepted a tenth below"
                      : "deep water: refused a tenth above breaking, accepted a tenth below",
                    below < limit && above > limit);
    }
    verify_row("H39", "breaking steepness in deep water", first[0], 0.14, 0.02, VERIFY_REL);
    verify_below("H39", "and in 2 m over that", first[1] / first[0], 0.99);
}

/* A box with any of its triangles inverted. */
static void inverted_triangles(void)
{
    double worst = 0.0;
    int left = 0, unequal = 0;
    for (int mask = 0; mask < 4096; mask += 5) {
        fl_surface s = {0};
        fl_mesh_quality came, q;
        fl_orient_counts o;
        fl_err err = {0};
        const int32_t at = fl_surface_add(&s, "box", 1, &err);
        int turned = 0;
        if (at < 0) exit(1);
        fl_part *p = &s.part[at];
        if (fl_facet_box(p, v3(0, 0, 0), v3(1, 1, 1), &err)) exit(1);
        for (int t = 0; t < p->nt; t++)
            if (mask >> t & 1) {
                const int32_t v = p->t[t].v[1];
                p->t[t].v[1] = p->t[t].v[2];
                p->t[t].v[2] = v;
                turned++;
            }
        if (fl_part_orient(p, &came, &o, &err) || fl_part_measure(p, &q, &err)) exit(1);
        worst = fmax(worst, fabs(q.volume - 1.0));
        left += q.incoherent + q.inverted;
        unequal += o.triangles != (turned < p->nt - turned ? turned : p->nt - turned);
        fl_surface_free(&s);
    }
    verify_below("H40", "a box, any of its triangles inverted: error of the volume", worst, 1e-15);
    verify_row("H40", "edges and boxes still inverted", left, 0, 0, VERIFY_ABS);
    verify_row("H40", "as many triangles turned as were inverted, or the rest", unequal, 0, 0, VERIFY_ABS);
}

int main(void)
{
    verify_begin("hard cases of the input");
    cores_without_volume();
    redundant_corners();
    bad_numbers();
    breaking_waves();
    inverted_triangles();
    return verify_end();
}
