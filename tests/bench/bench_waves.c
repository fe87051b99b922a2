/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_waves.c -- cost of the waves on a floe beside the error of the force: water.wave_error against the
 * evaluation in each step, for seas of different periods and numbers of trains; one thread, tables included.
 *
 *     bench_waves [FLOES [STEPS]]     10 000 floes of 6 to 20 m by 0.8 m, 300 steps of 5 ms
 *
 * us: processor time of a floe-step in all, without contacts; "each step" is measured on 64 of the floes.
 * error: rms over 64 floes of the difference of the two forces at the same pose, over rho g A Hs/4. ledger:
 * residual over the throughput. Then a floating structure, alone: a half-submerged ellipsoid of 100 x 20 x
 * 16 m and 50 000 triangles. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "base/pi.h"
#include "base/rng.h"
#include "body/integrate.h"
#include "sim/energy_balance.h"
#include "support/small_world.h"

#define G 9.81

static double processor_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

typedef struct {
    double Hs, Tp;
    int trains;
    const char *error, *more;
} sea_case;

enum { SAMPLE = 64 };

/* Floes on a square grid, apart. */
static void make_sea(lab *l, const sea_case *c, const char *error, int32_t n, double level)
{
    const int32_t side = (int32_t)ceil(sqrt(n));
    lab_start(l);
    lab_set(l, "run.gravity=9.81");
    if (c->trains) {
        lab_set(l, "water.wave=jonswap");
        lab_setf(l, "water.components=%d", c->trains);
        lab_setf(l, "water.height=%g", c->Hs);
        lab_setf(l, "water.period=%g", c->Tp);
        lab_setf(l, "water.wave_error=%s", error);
        if (c->more) lab_set(l, c->more);
    } else lab_setf(l, "water.level=%g", level);
    for (int32_t k = 0; k < n; k++) {
        fl_rng g = fl_rng_of(7, k, FL_RNG_TEST);
        const double a = 0.5 * fl_rng_in(&g, 6, 20), b = a * fl_rng_in(&g, 0.6, 1.0);
        lab_box(l, v3(28.0 * (k % side), 28.0 * (k / side), 0.4 - 0.8 * 900 / 1025), v3(a, b, 0.4), 0.1,
                q_about_axis(2, fl_rng_in(&g, 0, PI)), v3(0, 0, 0), v3(0, 0, 0));
    }
    lab_make(l, 5e-3);
}

/* rms of the difference of the forces of two worlds at the poses of the first. */
static double force_error(lab *a, lab *b, double Hs)
{
    double off = 0.0;
    b->w.sea.time = a->w.sea.time;
    for (int32_t k = 0; k < b->w.n; k++) {
        b->w.b.x[k] = a->w.b.x[k], b->w.b.q[k] = a->w.b.q[k];
        b->w.b.v[k] = a->w.b.v[k], b->w.b.w[k] = a->w.b.w[k];
        b->w.b.f[k] = b->w.b.t[k] = v3(0, 0, 0);
        fl_environment_force(&b->w.sea, &b->w.b, k);
        const fl_hull *h = &a->w.sea.hull[k];
        const double e = v3_norm(v3_sub(a->w.sea.water_force[k], b->w.sea.water_force[k])) /
                         (1025 * G * h->prism.area * 0.25 * Hs);
        off += e * e / b->w.n;
    }
    return sqrt(off);
}

static int print_row(const sea_case *c, int32_t n, int64_t steps)
{
    lab l, few, fine;
    make_sea(&l, c, c->error, n, 0.0);
    const double start = processor_time();
    const int bad = lab_run(&l, steps);
    const double cost = 1e6 * (processor_time() - start) / (double)steps / n;
    fl_energy_update(&l.w);
    const double ledger = fabs(l.w.ledger.residual) / l.w.ledger.throughput;
    if (!c->trains) {
        printf("%-6s %4s %7s %6s %8.2f\n", "calm", "", "", "", cost);
        lab_free(&l);
        return bad != 0;
    }
    int64_t points = 0;
    for (int32_t k = 0; k < n; k++) points += l.w.sea.nodes[k].n;
    double each = NAN, error = NAN, off = NAN;
    if (!c->more) {
        make_sea(&few, c, "none", n < SAMPLE ? n : SAMPLE, 0.0);
        make_sea(&fine, c, "0.0003", n < SAMPLE ? n : SAMPLE, 0.0);
        error = force_error(&l, &fine, c->Hs);
        off = force_error(&fine, &few, c->Hs);
        lab_free(&fine);
        const double begun = processor_time();
        lab_run(&few, 10);
        each = 1e6 * (processor_time() - begun) / 10 / few.w.n;
        lab_free(&few);
    }
    printf("%-6g %4g %7d %6s %8.2f %10.1f %9.1f %10.2g %10.2g %10.2g   %s\n", c->Tp, c->Hs, c->trains,
           c->error, cost, each, (double)points / n, error, off, ledger, c->more ? c->more : "");
    lab_free(&l);
    return bad != 0 || (!c->more && !(error < 0.05));
}

/* --- a floating structure ------------------------------------------------------------------------ */

#define RHO 1025.0

/* Triangles of an ellipsoid with half axes h: n rows of 2 n, n at the poles. Returns their number. */
static int32_t make_ellipsoid(fl_vec3 h, int32_t n, fl_vec3 **out)
{
    fl_vec3 *const v = malloc(sizeof *v * 6 * (size_t)n * (size_t)n);
    int32_t k = 0;
    if (!v) exit(1);
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < n; j++) {
            fl_vec3 x[2][2];
            for (int c = 0; c < 4; c++) {
                const double a = PI * (i + c / 2) / n, b = 2 * PI * ((j + c % 2) % n) / n;
                const double s = i + c / 2 == n ? 0 : sin(a);
                x[c / 2][c % 2] = v3(h.x * cos(a), h.y * s * cos(b), h.z * s * sin(b));
            }
            if (i > 0) v[k++] = x[0][0], v[k++] = x[1][1], v[k++] = x[0][1];
            if (i + 1 < n) v[k++] = x[0][0], v[k++] = x[1][0], v[k++] = x[1][1];
        }
    *out = v;
    return k / 3;
}

/* A hull afloat, alone with its sea; it is no structure of the world, which would join its surface. */
typedef struct {
    lab l;
    fl_bodies b;
    fl_floating_hulls hulls;
    double section;          /* area of its water plane [m2] */
    double tables, load, dt; /* processor time so far [s]; step [s] */
} ship;

static void start_ship(ship *a, const sea_case *c, const char *error)
{
    const fl_vec3 h = v3(50, 10, 8);
    const double V = 2.0 / 3.0 * PI * h.x * h.y * h.z, m = RHO * V;
    fl_err err = {0};
    fl_vec3 *v;
    lab_start(&a->l);
    lab_set(&a->l, "run.gravity=9.81");
    lab_sphere(&a->l, v3(0, 0, 0), 0.1, v3(0, 0, 0), v3(0, 0, 0)); /* a world needs ice */
    lab_set(&a->l, "water.wave=jonswap");
    lab_setf(&a->l, "water.components=%d", c->trains);
    lab_setf(&a->l, "water.height=%g", c->Hs);
    lab_setf(&a->l, "water.period=%g", c->Tp);
    lab_setf(&a->l, "water.wave_error=%s", error);
    a->dt = 5e-3;
    a->tables = a->load = 0;
    a->section = PI * h.x * h.y;
    a->b = (fl_bodies){0}, a->hulls = (fl_floating_hulls){0};
    lab_make(&a->l, a->dt);
    const int32_t n = make_ellipsoid(h, 158, &v);
    if (fl_bodies_alloc(&a->b, 1, 1, &err) || fl_floating_hulls_alloc(&a->hulls, 1, &a->l.w.sea, &err) ||
        fl_floating_hulls_set(&a->hulls, 0, v, n, V, v3(0, 0, -0.375 * h.z), &err))
        exit(1);
    a->b.m[0] = m, a->b.invm[0] = 1 / m;
    fl_body_set_inertia(&a->b, 0, v3(40 * m, 600 * m, 600 * m));
    fl_floating_hulls_attach(&a->hulls, &a->b);
}

static void free_ship(ship *a)
{
    fl_floating_hulls_free(&a->hulls);
    fl_bodies_free(&a->b);
    lab_free(&a->l);
}

static void sail(ship *a, int64_t steps)
{
    fl_environment *sea = &a->l.w.sea;
    fl_err err = {0};
    for (int64_t s = 0; s < steps; s++) {
        fl_kick(&a->b, 0, 0.5 * a->dt);
        fl_drift(&a->b, 0, a->dt);
        sea->time += a->dt;
        const double start = processor_time();
        if (fl_environment_prepare(sea, &a->l.w.b, NULL, sea->time, 1, &err)) exit(1);
        const double middle = processor_time();
        a->b.f[0] = a->b.t[0] = v3(0, 0, 0);
        fl_floating_hull_force(&a->hulls, &a->b, 0);
        a->tables += middle - start, a->load += processor_time() - middle;
        fl_kick(&a->b, 0, 0.5 * a->dt);
    }
}

/* The load on b at the pose and time of a. */
static fl_vec3 hull_force(const ship *a, ship *b)
{
    b->l.w.sea.time = a->l.w.sea.time;
    b->b.x[0] = a->b.x[0], b->b.q[0] = a->b.q[0], b->b.v[0] = a->b.v[0];
    b->b.w[0] = a->b.w[0], b->b.L[0] = a->b.L[0];
    b->b.f[0] = b->b.t[0] = v3(0, 0, 0);
    fl_floating_hull_force(&b->hulls, &b->b, 0);
    return b->hulls.hull[0].force;
}

static int print_hull(const sea_case *c, int64_t steps)
{
    enum { POSES = 20 };
    ship a, each, fine;
    start_ship(&a, c, c->error), start_ship(&each, c, "none"), start_ship(&fine, c, "0.0003");
    sail(&each, 2);
    const double slow = each.load / 2;
    sail(&a, steps);
    const double load = a.load / (double)steps, tables = a.tables / (double)steps,
                 unit = RHO * G * a.section * 0.25 * c->Hs;
    double off = 0, none = 0;
    for (int k = 0; k < POSES; k++) {
        sail(&a, 37);
        const fl_vec3 f = hull_force(&a, &fine), g = a.hulls.hull[0].force, e = hull_force(&a, &each);
        off += v3_norm2(v3_sub(f, g)) / (unit * unit * POSES);
        none += v3_norm2(v3_sub(f, e)) / (unit * unit * POSES);
    }
    printf("%-6g %4g %7d %6s %8.2f %8.2f %10.0f %9d %10.2g %10.2g\n", c->Tp, c->Hs, c->trains, c->error,
           1e6 * load, 1e6 * tables, 1e6 * slow, a.hulls.hull[0].nodes.n, sqrt(off), sqrt(none));
    free_ship(&a), free_ship(&each), free_ship(&fine);
    return !(sqrt(off) < 0.02);
}

int main(int argc, char **argv)
{
    static const sea_case HULL[] = {{2, 8, 100, "0.003", NULL},
                                    {2, 8, 10, "0.003", NULL},
                                    {1, 6, 100, "0.003", NULL},
                                    {1, 6, 100, "0.01", NULL}};
    static const sea_case CASE[] = {{0, 0, 0, NULL, NULL},
                                    {1, 8, 100, "0.003", NULL},
                                    {1, 6, 10, "0.003", NULL},
                                    {1, 6, 100, "0.003", NULL},
                                    {1, 6, 1000, "0.003", NULL},
                                    {1, 4, 100, "0.01", NULL},
                                    {1, 4, 100, "0.003", NULL},
                                    {0.2, 6, 100, "0.003", NULL},
                                    {0.2, 6, 100, "0.0003", NULL},
                                    {1, 6, 100, "0.01", NULL},
                                    {1, 6, 100, "0.003", "water.drag=facet"},
                                    {1, 6, 100, "0.01", "water.spread=2"}};
    const int32_t n = argc > 1 ? atoi(argv[1]) : 10000;
    const int64_t steps = argc > 2 ? atoi(argv[2]) : 300;
    int bad = 0;
    setvbuf(stdout, NULL, _IOLBF, 0);
    printf("waves on %d floes of 6 to 20 m, %lld steps of 5 ms, one thread\n", n, (long long)steps);
    printf("%-6s %4s %7s %6s %8s %10s %9s %10s %10s %10s\n", "Tp[s]", "Hs", "trains", "e", "us", "each step",
           "points", "error", "each step", "ledger");
    for (size_t k = 0; k < sizeof CASE / sizeof *CASE; k++) bad += print_row(&CASE[k], n, steps);
    printf("a hull of %d triangles: us a step, without and of the tables\n%-6s %4s %7s %6s %8s %8s %10s %9s "
           "%10s %10s\n",
           2 * 158 * 157, "Tp[s]", "Hs", "trains", "e", "load", "tables", "each step", "points", "error",
           "each step");
    for (size_t k = 0; k < sizeof HULL / sizeof *HULL; k++) bad += print_hull(&HULL[k], 2000);
    printf("%d passed, %d failed\n", (int)(sizeof CASE / sizeof *CASE + sizeof HULL / sizeof *HULL) - bad,
           bad);
    return bad > 0;
}
