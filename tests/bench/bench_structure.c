/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_structure.c -- cost of a step of a floe that touches a structure, by mesh size and kind of the
 * structure, with the deviation of its force from the gradient of its energy and from the force of the same
 * shape in another form.
 *
 *     bench_structure             the table
 *     bench_structure CASE N      N evaluations of one case, for instruction counts
 *
 * The floe is an octagonal prism of 3 m, 0.4 m thick, radius 50 mm, with an overlap of 4 mm, flat-on (one
 * of its sides lies on the structure) or edge-on (an upright edge does).  It moves by 0.01 mm between
 * evaluations, as in a step of 0.1 ms at 0.1 m/s, so the cost of finding new features is included.  Columns
 * `surr`, `exact`, `F off`: the same with contact.surrogate, the share of exact evaluations, the largest
 * relative error of the force.  Times are thread time of this machine, the least of several turns; ratios
 * are to the wall of 2 triangles, flat-on, in the same run. */
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

static double thread_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* An upright octagon with one of its sides, or of its edges, towards +x. */
static void make_floe(lab *l, int edge_on)
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

static fl_part *add_part(lab *l)
{
    fl_err err = {0};
    const int32_t k = fl_surface_add(&l->surface, "part", 4, &err);
    if (k < 0) exit(1);
    return &l->surface.part[k];
}

/* nu by nv patches of two triangles each; at(u, v) in [0, 1]^2, seen from outside with u to the right and v
 * up; closed: periodic in u. */
static void add_grid(fl_part *p, int nu, int nv, int closed, fl_vec3 (*at)(double, double, double, double),
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

/* Mean depth of the chords of an arc of radius r: corners displaced outward by it give a surface at the
 * arc. */
static double chord(double r, double length) { return length * length / (12.0 * r); }

/* A wall at x facing -x, and the wall at its end that goes back along x. */
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

/* About the axis through (x + ROUND, 0, 0): a cylinder, and a twisted hull that is also curved along the
 * axis, radius 8 m.  The seams lie off the middle of the floe. */
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

/* The ends of a cylinder, closed by fans. */
static void add_lids(fl_part *p, int nu, int nv)
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
    int n, m; /* patches around or along, and up */
    int like; /* the case of the same force, flat-on; -1 for none */
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

static void make_world(lab *l, const structure *c, int edge_on, double surrogate)
{
    const double half = edge_on ? 1.5 : 1.5 * cos(PI / 8.0), x = half + RADIUS - OVERLAP;
    lab_start(l);
    lab_set(l, "contact.friction=0.3");
    lab_setf(l, "contact.surrogate=%g", surrogate);
    make_floe(l, edge_on);
    switch (c->what) {
    case WALL: {
        fl_part *p = add_part(l);
        add_grid(p, c->n, c->m, 0, on_wall, x, 0.0);
        add_grid(p, 1, c->m, 0, on_return, x, 0.0);
        break;
    }
    case BLOCK: lab_wall(l, v3(x, -9, -5), v3(x + 9, 9, 5), c->n); break;
    case HULL:
        add_grid(add_part(l), c->n, c->m, 1, on_hull, x,
                 chord(ROUND, 2.0 * PI * ROUND / c->n) + chord(LONG, 4.0 / c->m));
        break;
    case CYLINDER: {
        fl_part *p = add_part(l);
        add_grid(p, c->n, c->m, 1, on_cylinder, x, chord(ROUND, 2.0 * PI * ROUND / c->n));
        add_lids(p, c->n, c->m);
        break;
    }
    default: lab_cone(l, (fl_cone){v3(x + ROUND, 0, -6), v3(x + ROUND, 0, 6), ROUND, ROUND});
    }
    lab_make(l, 1e-9);
}

/* To and fro: sliding, and by a fifth of that in depth; every step has a new pose. */
static void move_floe(lab *l, int k)
{
    fl_bodies *b = &l->w.b;
    b->x[0].y += k / 100 % 2 ? -STEP : STEP;
    b->x[0].x += k / 70 % 2 ? -0.2 * STEP : 0.2 * STEP;
    b->odometer[0] += 1.2 * STEP;
}

static void evaluate(lab *l, fl_pair *p, int times)
{
    for (int k = 0; k < times; k++) {
        move_floe(l, k);
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
    double with_surrogate, exact_share,
        surrogate_error; /* with surrogates: ns, share of exact evaluations, largest relative error of |F| */
    int32_t triangles, matches, places;
} results;

/* With contact.surrogate. */
static void with_surrogate(const structure *c, int edge_on, results *out)
{
    lab l;
    fl_pair p;
    make_world(&l, c, edge_on, TOLERANCE);
    fl_pair_init(&l.w, &p, 0, 1);
    evaluate(&l, &p, 200);
    out->with_surrogate = INFINITY;
    const int64_t before = l.w.surrogate_counts[0].hits;
    for (int k = 0; k < TURNS; k++) {
        const double begun = thread_time();
        evaluate(&l, &p, TIMES);
        const double ns = 1e9 * (thread_time() - begun) / TIMES;
        out->with_surrogate = ns < out->with_surrogate ? ns : out->with_surrogate;
    }
    out->exact_share = 1.0 - (double)(l.w.surrogate_counts[0].hits - before) / (TURNS * TIMES);
    out->surrogate_error = 0.0;
    for (int k = 0; k < 400; k++) {
        move_floe(&l, k);
        fl_pair_evaluate(&l.w, &p, 0, 1e-9, 0);
        const fl_vec3 f = lab_evaluate_pair(&l.w, 0, 1).force;
        out->surrogate_error =
            fmax(out->surrogate_error,
                 v3_norm(v3_sub(v3_sub(p.force, v3_add(p.force_friction, p.force_damping)), f)) / v3_norm(f));
    }
    fl_pair_free(&p);
    lab_free(&l);
}

static int measure_case(const structure *c, int edge_on, results *out)
{
    lab l;
    make_world(&l, c, edge_on, 0.0);
    const fl_vec3 f = lab_evaluate_pair(&l.w, 0, 1).force;
    fl_pair p;
    *out = (results){
        .triangles = l.surface.part[0].nt, .f = v3_norm(f), .off = off_gradient(&l, f), .ns = INFINITY};
    fl_pair_init(&l.w, &p, 0, 1);
    evaluate(&l, &p, 200);
    for (int k = 0; k < TURNS; k++) {
        const double begun = thread_time();
        evaluate(&l, &p, TIMES);
        const double ns = 1e9 * (thread_time() - begun) / TIMES;
        out->ns = ns < out->ns ? ns : out->ns;
    }
    out->matches = p.feature_pairs ? p.feature_pairs->n : 0;
    out->places = l.w.scratch[0].n;
    const int bad = p.touching == 0 || !(out->off < 1e-5);
    fl_pair_free(&p);
    lab_free(&l);
    with_surrogate(c, edge_on, out);
    return bad;
}

int main(int argc, char **argv)
{
    results all[2][CASES];
    int bad = 0;
    if (argc == 3) {
        const int c = atoi(argv[1]);
        lab l;
        fl_pair p;
        if (c < 0 || c >= 2 * CASES) return 2;
        make_world(&l, &CASE[c / 2], c % 2, 0.0);
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
           "features", "points", "ns", "of first", "F + grad W", "surr[ns]", "exact", "F off", "|F| [N]",
           "off another");
    for (int e = 0; e < 2; e++) {
        for (int c = 0; c < CASES; c++) bad += measure_case(&CASE[c], e, &all[e][c]);
        for (int c = 0; c < CASES; c++) {
            const results *q = &all[e][c];
            printf("%-18s %9d %5s %8d %7d %9.0f %8.2f %11.1e %9.0f %7.3f %8.1e %10.4g", CASE[c].name,
                   q->triangles, e ? "edge" : "flat", q->matches, q->places, q->ns, q->ns / all[0][0].ns,
                   q->off, q->with_surrogate, q->exact_share, q->surrogate_error, q->f);
            if (CASE[c].like >= 0) printf(" %11.1e", q->f / all[e][CASE[c].like].f - 1.0);
            printf("\n");
        }
    }
    printf("%d passed, %d failed\n", 2 * CASES - bad, bad);
    return bad > 0;
}
