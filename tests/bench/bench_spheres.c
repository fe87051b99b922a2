/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_spheres.c -- a pack of spheres that has come to rest under gravity, by Hertz and Mindlin with
 * history: what a step costs for each body and for each contact, everything included, beside how well energy
 * is kept and how deep spheres stand in one another; and what a body takes of memory with its pairs.
 *     bench_spheres                        the table
 *     bench_spheres count STEPS            so many steps of a thousand spheres in a lattice, for a tool that
 *                                          counts instructions; tells how many contact-steps they were
 *     bench_spheres rolls [STEPS]          either with contact.rolling = 0.1
 *     bench_spheres THREADS TILES STEPS    one row
 *     bench_spheres pack TILES STEPS PARTS what so many steps, each cut into parts, make of the pack (0: the
 *                                          pack): a row with the number of spheres, the step that is cut and
 *                                          the length of the cell; a row a sphere, radius, x, v, w
 * A column of a thousand spheres of radii within a tenth of each other is poured into a cell that repeats
 * itself and settles; larger packs are that one laid side by side.  Times are of the
 * processors, the best of several windows on this machine now, and once more by the clock for the contact;
 * compare rows of one run only. */
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

#define RADIUS 0.05 /* mean [m] */
#define PITCH 0.112 /* of the lattice that is let fall [m] */
#define SETTLE 1.2  /* [s] */
enum { SIDE = 10, COLUMN = SIDE * SIDE * SIDE, WINDOWS = 40 };

typedef struct {
    fl_vec3 x, v, w;
    double r;
} ball;

static double now(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double rolling; /* contact.rolling */

static void keys(lab *l, int32_t tiles, int threads)
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
static void pour(ball *b, double *dt)
{
    lab l;
    keys(&l, 1, 1);
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
        b[k] = (ball){a->x[k], a->v[k], a->w[k], a->radius[k]};
        b[k].x = fl_periodic_cell_wrap(&l.w.cell, b[k].x);
    }
    lab_free(&l);
}

/* The column, tiles by tiles times. */
static void set(lab *l, const ball *b, int32_t tiles, int threads)
{
    keys(l, tiles, threads);
    for (int32_t t = 0; t < tiles * tiles; t++) {
        const fl_vec3 by = v3(PITCH * SIDE * (t % tiles), PITCH * SIDE * (t / tiles), 0);
        for (int32_t k = 0; k < COLUMN; k++) lab_sphere(l, v3_add(b[k].x, by), b[k].r, b[k].v, b[k].w);
    }
}

/* The same, ready to run. */
static void lay(lab *l, const ball *b, int32_t tiles, int threads, double dt)
{
    set(l, b, tiles, threads);
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

static int row(const ball *b, int32_t tiles, int threads, double dt, int64_t steps)
{
    lab l;
    const double before = memory();
    lay(&l, b, tiles, threads, dt);
    lab_run(&l, 20);
    const int32_t n = l.w.n;
    double field = 0.0; /* what was read is not what the solver keeps */
    for (int32_t i = 0; i < n; i++) field += (double)malloc_usable_size(l.field.core[i].v);
    const double bytes = (memory() - before - field) / n;
    double best = INFINITY, cpu = INFINITY, contacts = 0.0;
    for (int k = 0; k < WINDOWS; k++) {
        const int64_t touched = l.w.contact_steps;
        const double begun = now(CLOCK_MONOTONIC), used = now(CLOCK_PROCESS_CPUTIME_ID);
        if (lab_run(&l, steps)) return 1;
        best = fmin(best, (now(CLOCK_MONOTONIC) - begun) / (double)steps);
        cpu = fmin(cpu, (now(CLOCK_PROCESS_CPUTIME_ID) - used) / (double)steps);
        contacts = (double)(l.w.contact_steps - touched) / (double)steps;
    }
    fl_err err = {0};
    double search = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double used = now(CLOCK_PROCESS_CPUTIME_ID);
        l.w.last_search_step = -1;
        if (fl_neighbour_list_update(&l.w, &err)) return 1;
        search = fmin(search, now(CLOCK_PROCESS_CPUTIME_ID) - used);
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

static void head(void)
{
    printf("%8s %7s %10s %12s %10s %10s %10s %10s %12s %12s\n", "spheres", "threads", "ns/body", "ns/contact",
           "by clock", "contacts", "search", "memory", "residual", "overlap");
    printf("%8s %7s %10s %12s %10s %10s %10s %10s %12s %12s\n", "", "", "and step", "and step", "", "a body",
           "ns/body", "B/body", "/elastic", "/2R");
}

/* Spheres that a lattice presses together by 2 % of their radius. */
static int count(ball *b, int64_t steps)
{
    lab l;
    for (int32_t k = 0; k < COLUMN; k++) {
        const fl_vec3 at = v3(k % SIDE + 0.5, k / SIDE % SIDE + 0.5, k / (SIDE * SIDE) + 0.5);
        b[k] = (ball){.x = v3_scale(PITCH, at), .v = v3(0.01 * at.z, 0, 0), .r = 0.51 * PITCH};
    }
    lay(&l, b, 1, 1, 1e-5);
    const int64_t before = l.w.contact_steps;
    const int failed = lab_run(&l, steps);
    printf("%lld\n", (long long)(l.w.contact_steps - before));
    lab_free(&l);
    return failed;
}

/* The pack, or what steps make of it, each cut into parts; spheres in the order in which they were laid. */
static int tell(const ball *b, int32_t tiles, double dt, int64_t steps, int64_t parts)
{
    lab l;
    set(&l, b, tiles, 1);
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
    static ball b[COLUMN];
    static const struct {
        int32_t tiles, threads, steps;
    } ROW[] = {{1, 1, 200}, {3, 1, 20}, {10, 1, 2}, {32, 1, 1}, {1, 2, 200}, {3, 2, 20}, {10, 2, 2}};
    double dt;
    int good = 0, bad = 0;
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (argc > 1 && strcmp(argv[1], "rolls") == 0) rolling = 0.1;
    if (argc == 3) return count(b, atoi(argv[2]));
    pour(b, &dt);
    if (argc == 5) return tell(b, atoi(argv[2]), dt, atoi(argv[3]), atoi(argv[4]));
    printf("spheres at rest, Hertz and Mindlin, friction 0.4, rolling %g, steps of %.3g s\n", rolling, dt);
    head();
    if (argc == 4) return row(b, atoi(argv[2]), atoi(argv[1]), dt, atoi(argv[3]));
    for (size_t k = 0; k < sizeof ROW / sizeof *ROW; k++) {
        if (row(b, ROW[k].tiles, ROW[k].threads, dt, ROW[k].steps)) bad++;
        else good++;
    }
    printf("%d passed, %d failed\n", good, bad);
    return bad > 0;
}
