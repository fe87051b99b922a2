/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_spheres.c -- a packing of spheres at rest under gravity, Hertz and Mindlin with history: cost of a
 * step for each body and for each contact, everything included; energy error and overlaps; memory of a body
 * with its pairs.
 *
 *     bench_spheres                        the table
 *     bench_spheres count STEPS            steps of a thousand spheres in a lattice, for instruction counts;
 *                                          prints the number of contact-steps
 *     bench_spheres rolls [STEPS]          either with contact.rolling = 0.1
 *     bench_spheres THREADS TILES STEPS    one row
 *     bench_spheres pack TILES STEPS PARTS the packing after STEPS steps, each cut into PARTS (0: the packing
 *                                          itself): a row with the number of spheres, the step that is cut
 *                                          and the length of the cell; a row per sphere: radius, x, v, w
 *
 * A column of a thousand spheres, radii within a tenth of each other, is poured into a periodic cell and
 * settles; larger packings repeat it side by side.  Times are processor times, the best of several windows
 * on this machine, and elapsed time once more for the contact; compare rows of one run only. */
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "base/rng.h"
#include "scene/ice_field_order.h"
#include "sim/energy_balance.h"
#include "sim/neighbour_list.h"
#include "support/small_world.h"

#define RADIUS 0.05 /* mean radius [m] */
#define PITCH 0.112 /* of the initial lattice [m] */
#define SETTLE 1.2  /* [s] */
enum { SIDE = 10, COLUMN = SIDE * SIDE * SIDE, WINDOWS = 40 };

typedef struct {
    fl_vec3 x, v, w;
    double r;
} sphere_state;

static double read_clock(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double rolling; /* contact.rolling */

static void set_keys(lab *l, int32_t tiles, int threads)
{
    lab_start(l);
    lab_set(l, "material.ice.young=20 MPa");
    lab_set(l, "contact.friction=0.4");
    lab_set(l, "contact.restitution=0.3");
    lab_setf(l, "contact.rolling=%g", rolling);
    lab_set(l, "run.gravity=9.81");
    lab_setf(l, "run.threads=%d", threads);
    lab_set(l, "boundary.type=periodic periodic rigid");
    lab_set(l, "boundary.min=0 0 0");
    lab_setf(l, "boundary.max=%.17g %.17g none", PITCH * SIDE * tiles, PITCH * SIDE * tiles);
}

/* The column at rest. */
static void pour_column(sphere_state *b, double *dt)
{
    lab l;
    set_keys(&l, 1, 1);
    for (int32_t k = 0; k < COLUMN; k++) {
        fl_rng g = fl_rng_of(3, k, FL_RNG_TEST);
        const fl_vec3 at = v3(k % SIDE + 0.5, k / SIDE % SIDE + 0.5, k / (SIDE * SIDE) + 0.5);
        const double r = RADIUS * fl_rng_in(&g, 0.9, 1.1);
        const fl_vec3 v = v3(fl_rng_in(&g, -0.5, 0.5), fl_rng_in(&g, -0.5, 0.5), 0);
        lab_sphere(&l, v3_scale(PITCH, at), r, v, v3(0, 0, 0));
    }
    lab_make(&l, 0.0);
    *dt = l.w.dt;
    if (lab_run(&l, (int64_t)(SETTLE / l.w.dt))) exit(1);
    for (int32_t k = 0; k < COLUMN; k++) {
        const fl_bodies *a = &l.w.b;
        b[k] = (sphere_state){a->x[k], a->v[k], a->w[k], a->radius[k]};
        b[k].x = fl_periodic_cell_wrap(&l.w.cell, b[k].x);
    }
    lab_free(&l);
}

/* The column, repeated tiles by tiles times. */
static void repeat_column(lab *l, const sphere_state *b, int32_t tiles, int threads)
{
    set_keys(l, tiles, threads);
    for (int32_t t = 0; t < tiles * tiles; t++) {
        const fl_vec3 by = v3(PITCH * SIDE * (t % tiles), PITCH * SIDE * (t / tiles), 0);
        for (int32_t k = 0; k < COLUMN; k++) lab_sphere(l, v3_add(b[k].x, by), b[k].r, b[k].v, b[k].w);
    }
}

/* The same, ready to run. */
static void make_packing(lab *l, const sphere_state *b, int32_t tiles, int threads, double dt)
{
    repeat_column(l, b, tiles, threads);
    fl_err err = {0};
    int32_t *at = malloc((size_t)l->field.n * sizeof *at);
    if (!at || fl_ice_field_order(&l->field, at, &err)) exit(1); /* as dem-solve does */
    free(at);
    lab_make(l, dt);
}

static double memory(void)
{
    const struct mallinfo2 m = mallinfo2();
    return (double)m.uordblks + (double)m.hblkhd;
}

static int print_row(const sphere_state *b, int32_t tiles, int threads, double dt, int64_t steps)
{
    lab l;
    const double before = memory();
    make_packing(&l, b, tiles, threads, dt);
    lab_run(&l, 20);
    const int32_t n = l.w.n;
    double field = 0.0; /* the input is not memory of the solver */
    for (int32_t i = 0; i < n; i++) field += (double)malloc_usable_size(l.field.core[i].v);
    const double bytes = (memory() - before - field) / n;
    double best = INFINITY, cpu = INFINITY, contacts = 0.0;
    for (int k = 0; k < WINDOWS; k++) {
        const int64_t touched = l.w.contact_steps;
        const double begun = read_clock(CLOCK_MONOTONIC), used = read_clock(CLOCK_PROCESS_CPUTIME_ID);
        if (lab_run(&l, steps)) return 1;
        best = fmin(best, (read_clock(CLOCK_MONOTONIC) - begun) / (double)steps);
        cpu = fmin(cpu, (read_clock(CLOCK_PROCESS_CPUTIME_ID) - used) / (double)steps);
        contacts = (double)(l.w.contact_steps - touched) / (double)steps;
    }
    fl_err err = {0};
    double search = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double used = read_clock(CLOCK_PROCESS_CPUTIME_ID);
        l.w.last_search_step = -1;
        if (fl_neighbour_list_update(&l.w, &err)) return 1;
        search = fmin(search, read_clock(CLOCK_PROCESS_CPUTIME_ID) - used);
    }
    fl_energy_update(&l.w);
    const fl_ledger *g = &l.w.ledger;
    printf("%8d %7d %10.1f %12.1f %10.2f %10.4f %10.0f %10.0f %12.1e %12.1e\n", n, threads, 1e9 * cpu / n,
           1e9 * cpu / contacts, 1e9 * best / contacts, contacts / n, 1e9 * search / n, bytes,
           fabs(g->residual) / g->elastic, l.w.max_overlap);
    const int bad = !(fabs(g->residual) < 1e-3 * g->elastic && l.w.max_overlap < 0.1);
    lab_free(&l);
    return bad;
}

static void print_head(void)
{
    printf("%8s %7s %10s %12s %10s %10s %10s %10s %12s %12s\n", "spheres", "threads", "ns/body", "ns/contact",
           "by clock", "contacts", "search", "memory", "residual", "overlap");
    printf("%8s %7s %10s %12s %10s %10s %10s %10s %12s %12s\n", "", "", "and step", "and step", "", "a body",
           "ns/body", "B/body", "/elastic", "/2R");
}

/* Spheres in a lattice that overlap by 2 % of their radius. */
static int count_in_lattice(sphere_state *b, int64_t steps)
{
    lab l;
    for (int32_t k = 0; k < COLUMN; k++) {
        const fl_vec3 at = v3(k % SIDE + 0.5, k / SIDE % SIDE + 0.5, k / (SIDE * SIDE) + 0.5);
        b[k] = (sphere_state){.x = v3_scale(PITCH, at), .v = v3(0.01 * at.z, 0, 0), .r = 0.51 * PITCH};
    }
    make_packing(&l, b, 1, 1, 1e-5);
    const int64_t before = l.w.contact_steps;
    const int failed = lab_run(&l, steps);
    printf("%lld\n", (long long)(l.w.contact_steps - before));
    lab_free(&l);
    return failed;
}

/* Prints the packing, or its state after a number of steps, each cut into parts; spheres in the order of
 * their creation. */
static int print_packing(const sphere_state *b, int32_t tiles, double dt, int64_t steps, int64_t parts)
{
    lab l;
    repeat_column(&l, b, tiles, 1);
    lab_make(&l, dt / (double)parts);
    const int failed = lab_run(&l, steps * parts);
    const fl_bodies *a = &l.w.b;
    printf("%d %.17g %.17g\n", l.w.n, dt, PITCH * SIDE * tiles);
    for (int32_t k = 0; k < l.w.n; k++) {
        const fl_vec3 x = fl_periodic_cell_wrap(&l.w.cell, a->x[k]), v = a->v[k], w = a->w[k];
        printf("%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", a->radius[k], x.x, x.y, x.z,
               v.x, v.y, v.z, w.x, w.y, w.z);
    }
    lab_free(&l);
    return failed;
}

int main(int argc, char **argv)
{
    static sphere_state b[COLUMN];
    static const struct {
        int32_t tiles, threads, steps;
    } ROW[] = {{1, 1, 200}, {3, 1, 20}, {10, 1, 2}, {32, 1, 1}, {1, 2, 200}, {3, 2, 20}, {10, 2, 2}};
    double dt;
    int good = 0, bad = 0;
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (argc > 1 && strcmp(argv[1], "rolls") == 0) rolling = 0.1;
    if (argc == 3) return count_in_lattice(b, atoi(argv[2]));
    pour_column(b, &dt);
    if (argc == 5) return print_packing(b, atoi(argv[2]), dt, atoi(argv[3]), atoi(argv[4]));
    printf("spheres at rest, Hertz and Mindlin, friction 0.4, rolling %g, steps of %.3g s\n", rolling, dt);
    print_head();
    if (argc == 4) return print_row(b, atoi(argv[2]), atoi(argv[1]), dt, atoi(argv[3]));
    for (size_t k = 0; k < sizeof ROW / sizeof *ROW; k++) {
        if (print_row(b, ROW[k].tiles, ROW[k].threads, dt, ROW[k].steps)) bad++;
        else good++;
    }
    printf("%d passed, %d failed\n", good, bad);
    return bad > 0;
}
