/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_structure.c -- what a floe that touches a structure costs in a step, by how finely the structure is
 * cut up and by what it is, beside how far its force is from the gradient of its energy and from the force of
 * the same shape in another form.
 *     bench_structure             the table
 *     bench_structure CASE N      N evaluations of one case, for a tool that counts instructions
 * The floe: an octagonal prism of 3 m, 0.4 m thick, radius 50 mm, that overlaps by 4 mm, flat-on (one of its
 * sides lies on the structure) or edge-on (an upright edge does); it moves by a hundredth of a millimetre
 * between evaluations, as in a step of 0.1 ms at 0.1 m/s, so that the cost of finding features anew is in it.
 * "told" is the same with contact.surrogate.  Times are thread time of this machine now, the least of several
 * turns; the ratios are to the wall of 2 triangles, flat-on, in the same run. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "base/pi.h"
#include "contact/pair_force.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "support/small_world.h"

#define RADIUS 0.05
#define OVERLAP 0.004
#define STEP 1e-5      /* [m] */
#define TOLERANCE 1e-3 /* of contacts by surrogates */
#define ROUND 4.0      /* radius of hull and cylinder [m] */
#define LONG 8.0       /* of the hull along its axis [m] */

enum { CORNERS = 8, TIMES = 2000, TURNS = 5 };

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* An upright octagon; one of its sides, or of its edges, looks along x. */
static void floe(lab *l, int edge_on)
{
    fl_vec3 xy[CORNERS];
    fl_poly p = {0};
    fl_err err = {0};
    for (int k = 0; k < CORNERS; k++) {
        const double a = 2.0 * PI * (k + (edge_on ? 0.0 : 0.5)) / CORNERS;
        xy[k] = v3(1.5 * cos(a), 1.5 * sin(a), 0);
    }
    if (fl_poly_prism(&p, CORNERS, xy, -0.2, 0.2, &err)) {
        fprintf(stderr, "%s\n", err.text);
        exit(1);
    }
    lab_poly(l, &p, RADIUS, v3(0, 0, 0), v3(0, 0, 0));
}

static fl_part *part(lab *l)
{
    fl_err err = {0};
    const int32_t k = fl_surface_add(&l->surface, "part", 4, &err);
    if (k < 0) exit(1);
    return &l->surface.part[k];
}

/* nu by nv patches, two triangles each; at(u, v) in [0, 1]^2, seen from outside u to the right, v up; closed:
 * round in u. */
static void grid(fl_part *p, int nu, int nv, int closed, fl_vec3 (*at)(double, double, double, double),
                 double x, double out)
{
    fl_err err = {0};
    const int columns = closed ? nu : nu + 1;
    const int32_t first = p->nv;
    for (int j = 0; j <= nv; j++)
        for (int i = 0; i < columns; i++)
            if (fl_surface_vertex(p, at((double)i / nu, (double)j / nv, x, out), &err)) exit(1);
    for (int j = 0; j < nv; j++) {
        for (int i = 0; i < nu; i++) {
            const int32_t a = first + j * columns + i, b = first + j * columns + (i + 1) % columns;
            const int32_t c = b + columns, d = a + columns;
            if (fl_surface_triangle(p, a, b, c, &err) || fl_surface_triangle(p, a, c, d, &err)) exit(1);
        }
    }
}

/* How far the chords of an arc of radius r lie within it, in the mean: corners so far out have the surface
 * where the arc is. */
static double chord(double r, double length) { return length * length / (12.0 * r); }

/* A wall at x that looks along -x, and the wall at its end that goes back along x. */
static fl_vec3 on_wall(double u, double v, double x, double out)
{
    (void)out;
    return v3(x, 9.0 - 18.0 * u, -5.0 + 10.0 * v);
}
static fl_vec3 on_return(double u, double v, double x, double out)
{
    (void)out;
    return v3(x + 9.0 * u, -9.0, -5.0 + 10.0 * v);
}

/* About the axis through (x + ROUND, 0, 0): a cylinder, and a hull that is also round along it, radius 8 m,
 * twisted. The seams lie off the middle of the floe. */
static fl_vec3 on_cylinder(double u, double v, double x, double out)
{
    const double a = 2.0 * PI * u + 0.003;
    const double r = ROUND + out;
    return v3(x + ROUND + r * cos(a), r * sin(a), -3.0 + 6.0 * v);
}
static fl_vec3 on_hull(double u, double v, double x, double out)
{
    const double a = 2.0 * PI * u - 0.3 * v, z = -2.0 + 4.0 * v,
                 r = out + ROUND - LONG + sqrt(LONG * LONG - (z - 0.01) * (z - 0.01));
    return v3(x + ROUND + r * cos(a), r * sin(a), z);
}

/* The rings of a cylinder closed by fans. */
static void lids(fl_part *p, int nu, int nv)
{
    fl_err err = {0};
    for (int top = 0; top < 2; top++) {
        const int32_t ring = top ? nv * nu : 0;
        for (int32_t i = 1; i + 1 < nu; i++)
            if (fl_surface_triangle(p, ring, ring + (top ? i : i + 1), ring + (top ? i + 1 : i), &err))
                exit(1);
    }
}

typedef enum { WALL, BLOCK, CYLINDER, HULL, PRIMITIVE } shape;

typedef struct {
    const char *name;
    shape what;
    int n, m; /* patches round or along, and up */
    int like; /* the case whose force it should have, flat-on; -1 for none */
} structure;

static const structure CASE[] = {
    {"wall (shell)", WALL, 1, 1, -1},          {"wall (shell)", WALL, 10, 10, 0},
    {"wall (shell)", WALL, 100, 100, 0},       {"wall (block)", BLOCK, 1, 1, 0},
    {"wall (block)", BLOCK, 58, 58, 0},        {"cylinder (mesh)", CYLINDER, 80, 5, 9},
    {"cylinder (mesh)", CYLINDER, 200, 24, 9}, {"cylinder (mesh)", CYLINDER, 440, 56, 9},
    {"cylinder (96-gon)", CYLINDER, 96, 1, 9}, {"cylinder (cone)", PRIMITIVE, 0, 0, -1},
    {"hull (shell)", HULL, 56, 9, 12},         {"hull (shell)", HULL, 178, 28, 12},
    {"hull (shell)", HULL, 397, 63, -1},
};
enum { CASES = sizeof CASE / sizeof *CASE };

static void make(lab *l, const structure *c, int edge_on, double surrogate)
{
    const double half = edge_on ? 1.5 : 1.5 * cos(PI / 8.0), x = half + RADIUS - OVERLAP;
    lab_start(l);
    lab_set(l, "contact.friction=0.3");
    lab_setf(l, "contact.surrogate=%g", surrogate);
    floe(l, edge_on);
    switch (c->what) {
    case WALL: {
        fl_part *p = part(l);
        grid(p, c->n, c->m, 0, on_wall, x, 0.0);
        grid(p, 1, c->m, 0, on_return, x, 0.0);
        break;
    }
    case BLOCK: lab_wall(l, v3(x, -9, -5), v3(x + 9, 9, 5), c->n); break;
    case HULL:
        grid(part(l), c->n, c->m, 1, on_hull, x,
             chord(ROUND, 2.0 * PI * ROUND / c->n) + chord(LONG, 4.0 / c->m));
        break;
    case CYLINDER: {
        fl_part *p = part(l);
        grid(p, c->n, c->m, 1, on_cylinder, x, chord(ROUND, 2.0 * PI * ROUND / c->n));
        lids(p, c->n, c->m);
        break;
    }
    default: lab_cone(l, (fl_cone){v3(x + ROUND, 0, -6), v3(x + ROUND, 0, 6), ROUND, ROUND});
    }
    lab_make(l, 1e-9);
}

/* There and back again, sliding and, by a fifth of it, pressing; path counts every step. */
static void go(lab *l, int k)
{
    fl_bodies *b = &l->w.b;
    b->x[0].y += k / 100 % 2 ? -STEP : STEP;
    b->x[0].x += k / 70 % 2 ? -0.2 * STEP : 0.2 * STEP;
    b->odometer[0] += 1.2 * STEP;
}

static void evaluate(lab *l, fl_pair *p, int times)
{
    for (int k = 0; k < times; k++) {
        go(l, k);
        fl_pair_evaluate(&l->w, p, 0, 1e-9, 0);
    }
}

static double energy_at(lab *l, fl_vec3 d)
{
    fl_bodies *b = &l->w.b;
    const fl_vec3 x = b->x[0];
    b->x[0] = v3_add(x, d);
    const double e = lab_evaluate_pair(&l->w, 0, 1).energy;
    b->x[0] = x;
    return e;
}

/* |F + grad W| / |F|, by central differences. */
static double off_gradient(lab *l, fl_vec3 f)
{
    const double h = 1e-7;
    const fl_vec3 g = v3(energy_at(l, v3(h, 0, 0)) - energy_at(l, v3(-h, 0, 0)),
                         energy_at(l, v3(0, h, 0)) - energy_at(l, v3(0, -h, 0)),
                         energy_at(l, v3(0, 0, h)) - energy_at(l, v3(0, 0, -h)));
    return v3_norm(v3_madd(f, 0.5 / h, g)) / v3_norm(f);
}

typedef struct {
    double f; /* size of the force [N] */
    double ns, off;
    double told, looks, told_off; /* the same by surrogates: ns, part of the steps, |F| off at most */
    int32_t triangles, matches, places;
} found;

/* The same with contact.surrogate. */
static void told(const structure *c, int edge_on, found *out)
{
    lab l;
    fl_pair p;
    make(&l, c, edge_on, TOLERANCE);
    fl_pair_init(&l.w, &p, 0, 1);
    evaluate(&l, &p, 200);
    out->told = INFINITY;
    const int64_t before = l.w.surrogate_counts[0].hits;
    for (int k = 0; k < TURNS; k++) {
        const double begun = now();
        evaluate(&l, &p, TIMES);
        const double ns = 1e9 * (now() - begun) / TIMES;
        out->told = ns < out->told ? ns : out->told;
    }
    out->looks = 1.0 - (double)(l.w.surrogate_counts[0].hits - before) / (TURNS * TIMES);
    out->told_off = 0.0;
    for (int k = 0; k < 400; k++) {
        go(&l, k);
        fl_pair_evaluate(&l.w, &p, 0, 1e-9, 0);
        const fl_vec3 f = lab_evaluate_pair(&l.w, 0, 1).force;
        out->told_off =
            fmax(out->told_off,
                 v3_norm(v3_sub(v3_sub(p.force, v3_add(p.force_friction, p.force_damping)), f)) / v3_norm(f));
    }
    fl_pair_free(&p);
    lab_free(&l);
}

static int run(const structure *c, int edge_on, found *out)
{
    lab l;
    make(&l, c, edge_on, 0.0);
    const fl_vec3 f = lab_evaluate_pair(&l.w, 0, 1).force;
    fl_pair p;
    *out = (found){
        .triangles = l.surface.part[0].nt, .f = v3_norm(f), .off = off_gradient(&l, f), .ns = INFINITY};
    fl_pair_init(&l.w, &p, 0, 1);
    evaluate(&l, &p, 200);
    for (int k = 0; k < TURNS; k++) {
        const double begun = now();
        evaluate(&l, &p, TIMES);
        const double ns = 1e9 * (now() - begun) / TIMES;
        out->ns = ns < out->ns ? ns : out->ns;
    }
    out->matches = p.feature_pairs ? p.feature_pairs->n : 0;
    out->places = l.w.scratch[0].n;
    const int bad = p.touching == 0 || !(out->off < 1e-5);
    fl_pair_free(&p);
    lab_free(&l);
    told(c, edge_on, out);
    return bad;
}

int main(int argc, char **argv)
{
    found all[2][CASES];
    int bad = 0;
    if (argc == 3) {
        const int c = atoi(argv[1]);
        lab l;
        fl_pair p;
        if (c < 0 || c >= 2 * CASES) return 2;
        make(&l, &CASE[c / 2], c % 2, 0.0);
        fl_pair_init(&l.w, &p, 0, 1);
        evaluate(&l, &p, atoi(argv[2]));
        bad = p.touching == 0;
        fl_pair_free(&p);
        lab_free(&l);
        return bad;
    }
    printf(
        "a floe on a structure, all forces with friction and damping; moved 0.01 mm between evaluations\n");
    printf("%-18s %9s %5s %8s %7s %9s %8s %11s %9s %7s %8s %10s %11s\n", "structure", "triangles", "on",
           "matches", "places", "ns", "of first", "F + grad W", "told[ns]", "looks", "F off", "|F| [N]",
           "off another");
    for (int e = 0; e < 2; e++) {
        for (int c = 0; c < CASES; c++) bad += run(&CASE[c], e, &all[e][c]);
        for (int c = 0; c < CASES; c++) {
            const found *q = &all[e][c];
            printf("%-18s %9d %5s %8d %7d %9.0f %8.2f %11.1e %9.0f %7.3f %8.1e %10.4g", CASE[c].name,
                   q->triangles, e ? "edge" : "flat", q->matches, q->places, q->ns, q->ns / all[0][0].ns,
                   q->off, q->told, q->looks, q->told_off, q->f);
            if (CASE[c].like >= 0) printf(" %11.1e", q->f / all[e][CASE[c].like].f - 1.0);
            printf("\n");
        }
    }
    printf("%d passed, %d failed\n", 2 * CASES - bad, bad);
    return bad > 0;
}
