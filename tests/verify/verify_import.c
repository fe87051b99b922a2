/* SPDX-License-Identifier: GPL-3.0-or-later */
/* verify_import.c -- mass properties of a structure that is written in each format and read back: volume,
 * area, centroid and inertia against those of the source, and the source against closed forms. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/pi.h"
#include "geom/facet.h"
#include "geom/moments.h"
#include "geom/mesh_patch.h"
#include "geom/affine.h"
#include "geom/weld.h"
#include "mesh/gstruct.h"
#include "mesh/read_mesh.h"
#include "mesh/write_obj.h"
#include "mesh/write_off.h"
#include "mesh/write_ply.h"
#include "mesh/write_stl.h"
#include "mesh/write_vtp.h"
#include "support/verify.h"

static fl_err err;

static void die(void)
{
    fprintf(stderr, "verify_import: %s\n", err.text);
    exit(1);
}

static fl_part *add_part(fl_surface *s, const char *name)
{
    const int32_t i = fl_surface_add(s, name, strlen(name), &err);
    if (i < 0) die();
    return &s->part[i];
}

/* Legs, a deck with a cavity, and a fender of thin triangles, rotated out of the axes. */
static void make_model(fl_surface *s, int32_t facets)
{
    static const fl_vec3 at[4] = {{-7, -5, 0}, {7, -5, 0}, {-7, 5, 0}, {7, 5, 0}};
    const fl_affine turn = {fl_affine_rotation(v3(1, 2, 3), 37.0), 1.0, v3(120, -45, 3)};
    fl_weld w;
    fl_part *p = add_part(s, "legs");
    int bad = 0;
    for (int k = 0; k < 4; k++) {
        const fl_cone c = {v3_add(at[k], v3(0, 0, -20)), v3_add(at[k], v3(0, 0, 8)), 1.5, 1.1};
        bad |= fl_facet_cone(p, &c, facets, &err);
    }
    p = add_part(s, "deck");
    bad |= fl_facet_box(p, v3(-9, -7, 8), v3(9, 7, 11), &err);
    const int32_t first = p->nt;
    bad |= fl_facet_box(p, v3(-2, -2, 9), v3(2, 2, 10), &err);
    for (int32_t t = first; t < p->nt; t++) { /* the surface of the cavity points inward */
        const int32_t keep = p->t[t].v[1];
        p->t[t].v[1] = p->t[t].v[2];
        p->t[t].v[2] = keep;
    }
    p = add_part(s, "fender");
    bad |= fl_facet_cone(p, &(fl_cone){v3(-9.5, 0, -2), v3(-9.5, 0, 2), 0.02, 0.03}, facets, &err);
    for (int32_t i = 0; i < s->n; i++) {
        fl_part_map(&s->part[i], &turn);
        bad |= fl_part_weld(&s->part[i], -1.0, &w, &err);
    }
    if (bad) die();
}

static void verify_moments(const char *id, const char *what, const fl_moments *a, const fl_moments *b,
                           double tol)
{
    char text[80];
    double most = 0.0, size = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            most = fmax(most, fabs(a->inertia.m[i][j] - b->inertia.m[i][j]));
            size = fmax(size, fabs(b->inertia.m[i][j]));
        }
    snprintf(text, sizeof text, "%s: volume [m3]", what);
    verify_row(id, text, a->volume, b->volume, tol, VERIFY_REL);
    snprintf(text, sizeof text, "%s: area [m2]", what);
    verify_row(id, text, a->area, b->area, tol, VERIFY_REL);
    snprintf(text, sizeof text, "%s: centroid error over its distance", what);
    verify_row(id, text, v3_norm(v3_sub(a->centroid, b->centroid)) / v3_norm(b->centroid), 0.0, tol,
               VERIFY_ABS);
    snprintf(text, sizeof text, "%s: inertia error over its largest", what);
    verify_row(id, text, most / size, 0.0, tol, VERIFY_ABS);
}

enum { OWN, STL, STL32, OBJ, OFF, PLY, VTP, FORMATS };

static void write_format(int way, FILE *f, const fl_surface *s)
{
    fl_history_line by;
    fl_history_line_start(&by, "verify-import");
    if (way == OWN) fl_gstruct_write(f, s, &by);
    else if (way == STL) fl_stl_write_ascii(f, s);
    else if (way == STL32) fl_stl_write_binary(f, s);
    else if (way == OBJ) fl_obj_write(f, s);
    else if (way == OFF) fl_off_write(f, s);
    else if (way == PLY ? fl_ply_write(f, s, &err) : fl_vtp_write(f, s, &err)) die();
}

static void round_trip(int way, const fl_surface *s, const fl_moments *source)
{
    static const char *const name[FORMATS] = {"g_struct", "STL", "STL, float32", "OBJ", "OFF", "PLY", "VTP"};
    static const char *const id[FORMATS] = {"I10", "I11", "I12", "I13", "I14", "I15", "I16"};
    const char *dir = getenv("TMPDIR");
    char path[4096], note[FL_MESH_NOTE], text[80];
    fl_surface back = {0};
    fl_moments m;
    fl_weld w;
    FILE *f;
    int64_t nt = 0, had = 0;
    snprintf(path, sizeof path, "%s/floe-import-%ld", dir ? dir : "/tmp", (long)getpid());
    f = fopen(path, "wb");
    if (!f) {
        perror(path);
        exit(1);
    }
    write_format(way, f, s);
    if (fclose(f) != 0 || fl_mesh_read(&back, path, NULL, note, &err)) die();
    remove(path);
    for (int32_t i = 0; i < back.n; i++) {
        if (fl_part_weld(&back.part[i], 0.0, &w, &err)) die();
        nt += back.part[i].nt;
    }
    for (int32_t i = 0; i < s->n; i++) had += s->part[i].nt;
    snprintf(text, sizeof text, "%s: triangles", name[way]);
    verify_row(id[way], text, (double)nt, (double)had, 0.0, VERIFY_ABS);
    m = fl_moments_of(back.part, back.n);
    verify_moments(id[way], name[way], &m, source, way == STL32 ? 1e-5 : 1e-12);
    fl_surface_free(&back);
}

int main(void)
{
    const int32_t facets = verify_quick() ? 60 : 600;
    /* inscribed prisms: area of the polygon over r^2; a truncated cone integrates r(z)^2 */
    const double n = facets, polygon = 0.5 * n * sin(2.0 * PI / n);
    const double leg = polygon * 28.0 / 3.0 * (1.5 * 1.5 + 1.5 * 1.1 + 1.1 * 1.1);
    const double fender = polygon * 4.0 / 3.0 * (0.02 * 0.02 + 0.02 * 0.03 + 0.03 * 0.03);
    fl_surface s = {0};
    fl_moments source;
    verify_begin("structures written and read back");
    make_model(&s, facets);
    source = fl_moments_of(s.part, s.n);
    verify_row("I01", "volume of legs [m3]", fl_moments_of(&s.part[0], 1).volume, 4.0 * leg, 1e-12,
               VERIFY_REL);
    verify_row("I02", "volume of a deck with a cavity [m3]", fl_moments_of(&s.part[1], 1).volume,
               756.0 - 16.0, 1e-12, VERIFY_REL);
    verify_note("the fender is 2 cm thick and 130 m from the origin: its coordinates are good to 1e-12 of "
                "its thickness");
    verify_row("I03", "volume of a fender [m3]", fl_moments_of(&s.part[2], 1).volume, fender, 1e-11,
               VERIFY_REL);
    for (int way = 0; way < FORMATS; way++) round_trip(way, &s, &source);
    fl_surface_free(&s);
    return verify_end();
}
