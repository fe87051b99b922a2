/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_step.c -- cost of a step and its accuracy: a frictionless elastic gas of square floes between
 * walls, by law and by fraction of the critical step.  Energy must be constant, so its drift is the error.
 * Then the cost of ordered sums against sums in the order of threads; the cost of a floe without contacts;
 * and the time per body against the number of bodies.  Times are of this machine; compare rows of one run
 * only.
 *
 *     bench_step                       the tables
 *     bench_step order THREADS         ordered sums against unordered ones, alone
 *     bench_step one|any STEPS         steps of the gas with ordered sums (one) or unordered ones (any);
 *                                      prints the number of body-steps
 *     bench_step dry|water|added|waves|held|facets STEPS
 *                                      steps of a hundred floes without contacts: dry, in still water, with
 *                                      added mass besides, in waves, which are evaluated every 20th step
 *                                      (held), in still water with drag on each facet; prints the number of
 *                                      body-steps
 *     bench_step whole|strong STEPS    steps of two hundred floes in a current among ten piles; strong: with
 *                                      crushing, bending and splitting, none of which happens; prints the
 *                                      number of body-steps
 *     bench_step bonds STEPS           steps of bonded boxes and spheres; prints the number of bond-steps */
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "base/rng.h"
#include "body/integrate.h"
#include "contact/active_pairs.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "sim/energy_balance.h"
#include "sim/neighbour_list.h"
#include "sim/sleep.h"
#include "support/small_world.h"
#include "support/scenes.h"

static double processor_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* One row; 1 when the run completed and, for a law with a potential, kept its energy. */
static int print_row(const char *law, int potential, double safety)
{
    lab l;
    lab_gas(&l, law, safety);
    const double begun = processor_time(), energy = lab_energy(&l);
    const int64_t steps = (int64_t)(4.0 / l.w.dt);
    const int ended = lab_run(&l, steps) == 0;
    const double drift = lab_energy(&l) / energy - 1.0;
    const double spent = processor_time() - begun, touches = (double)l.w.contact_steps;
    printf("%-10s %8.3f %10.3g %12.0f %15.0f %15.2g %14.3g %12.2g\n", law, safety, l.w.dt,
           1e9 * spent / (double)steps / l.w.n, touches > 0 ? 1e9 * spent / touches : 0.0,
           (double)l.w.contact_steps / (double)steps, drift, l.w.max_overlap);
    lab_free(&l);
    return ended && isfinite(drift) && (!potential || fabs(drift) < 1e-3);
}

static double wall_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* --- ordered or unordered sums ------------------------------------------------------------------------ */

static void add_atomic(double *to, double x)
{
#pragma omp atomic
    *to += x;
}

static void scatter_forces(fl_bodies *b, int32_t k, double sign, fl_vec3 f, fl_vec3 t)
{
    if (b->invm[k] == 0.0) return;
    add_atomic(&b->f[k].x, sign * f.x), add_atomic(&b->f[k].y, sign * f.y),
        add_atomic(&b->f[k].z, sign * f.z);
    add_atomic(&b->t[k].x, t.x), add_atomic(&b->t[k].y, t.y), add_atomic(&b->t[k].z, t.z);
}

static void gather_forces(fl_world *w, int32_t k)
{
    fl_bodies *b = &w->b;
    for (int64_t c = w->first_pair_of_body[k]; c < w->first_pair_of_body[k + 1]; c++) {
        if (!w->pair_touches[w->pairs_of_body[c]]) continue;
        const fl_pair *p = w->pair[w->pairs_of_body[c]].contact;
        b->f[k] = v3_madd(b->f[k], p->i == k ? 1.0 : -1.0, p->force);
        b->t[k] = v3_add(b->t[k], p->i == k ? p->torque_i : p->torque_j);
    }
}

/* A step of a dry gas and nothing else: contacts add their forces to bodies in the order of threads, or
 * bodies sum them in the order of the list, as fl_step() does. */
static int contact_step(fl_world *w, int ordered)
{
    fl_bodies *b = &w->b;
    fl_err err = {0};
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < w->n; i++) {
        fl_kick(b, i, 0.5 * w->dt);
        fl_drift(b, i, w->dt);
        b->f[i] = b->t[i] = v3(0, 0, 0);
    }
    w->step++;
    if (fl_neighbour_list_update(w, &err)) return -1;
#pragma omp parallel for schedule(dynamic, 16)
    for (int32_t c = 0; c < w->n_pair; c++) {
        if (!fl_pair_may_touch(w, c)) continue;
        fl_evaluate_neighbour_pair(w, c, omp_get_thread_num(), NULL, w->dt, 0);
        fl_set_next_check(w, c);
        w->pair_touches[c] = w->pair[c].touching;
        if (ordered || !w->pair_touches[c]) continue;
        const fl_pair *p = w->pair[c].contact;
        scatter_forces(b, p->i, 1.0, p->force, p->torque_i);
        scatter_forces(b, p->j, -1.0, p->force, p->torque_j);
    }
    fl_update_touching_pairs(w);
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < w->n; i++) {
        if (ordered) gather_forces(w, i);
        fl_kick(b, i, 0.5 * w->dt);
    }
    return 0;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Many windows, the two variants in turn, so that other load affects both: the best of each; of the ratios
 * of neighbours the median and the quartiles. */
static int compare_sum_orders(int threads)
{
    enum { WINDOWS = 48, STEPS = 100 };
    lab l[2];
    double best[2] = {INFINITY, INFINITY}, energy = 0.0, took[2] = {0}, ratio[WINDOWS];
    for (int k = 0; k < 2; k++) {
        lab_gas_on(&l[k], "patch", 0.1, threads);
        lab_run(&l[k], 2000); /* until there are as many contacts as later */
    }
    energy = lab_energy(&l[0]);
    for (int r = 0; r < 2 * WINDOWS; r++) {
        const double begun = wall_time();
        for (int s = 0; s < STEPS; s++)
            if (contact_step(&l[r % 2].w, r % 2)) return 0;
        took[r % 2] = (wall_time() - begun) / STEPS;
        best[r % 2] = fmin(best[r % 2], took[r % 2]);
        if (r % 2) ratio[r / 2] = took[1] / took[0];
    }
    qsort(ratio, WINDOWS, sizeof *ratio, by_size);
    omp_set_num_threads(1);
    const double drift = lab_energy(&l[0]) / energy - 1.0, drift1 = lab_energy(&l[1]) / energy - 1.0;
    printf("%d thread%s    one order %8.2f us a step, energy drift %9.2g    any order %8.2f us, %9.2g\n",
           threads, threads > 1 ? "s" : " ", 1e6 * best[1], drift1, 1e6 * best[0], drift);
    printf("             one over any %.3f of the best, median %.3f of %d turns, quartiles %.3f to %.3f "
           "of them\n",
           best[1] / best[0], ratio[WINDOWS / 2], WINDOWS, ratio[WINDOWS / 4], ratio[3 * WINDOWS / 4]);
    lab_free(&l[0]), lab_free(&l[1]);
    return fabs(drift) < 1e-3 && fabs(drift1) < 1e-3;
}

/* --- bodies without contacts, and many of them -------------------------------------------------------- */

enum sea { DRY, STILL, ADDED, WAVES, HELD, FACETS, SEAS };
static const char *const sea_names[SEAS] = {"dry", "water", "added", "waves", "held", "facets"};

/* Floes or spheres on a square grid, with a pitch that lets a few of them meet. */
static void make_grid(lab *l, int32_t side, int spheres, double pitch, enum sea water)
{
    lab_start(l);
    if (water != DRY) lab_set(l, "run.gravity=9.81"), lab_set(l, "water.current=0.2 0 0");
    if (water == ADDED) lab_set(l, "water.added_mass=auto");
    if (water == WAVES || water == HELD) {
        lab_set(l, "water.wave=airy"), lab_set(l, "water.height=0.2");
        lab_set(l, "water.period=4"), lab_set(l, "water.depth=20");
    }
    if (water == HELD) lab_set(l, "water.every=20");
    if (water == FACETS) lab_set(l, "water.drag=facet");
    lab_set(l, "contact.stiffness_factor=0.05");
    for (int32_t k = 0; k < side * side; k++) {
        fl_rng g = fl_rng_of(4, k, FL_RNG_TEST);
        const fl_vec3 at = v3(pitch * (k % side), pitch * (k / side), water ? -0.03 : 0.0);
        const fl_vec3 v = v3(fl_rng_in(&g, -0.2, 0.2), fl_rng_in(&g, -0.2, 0.2), 0);
        if (spheres) lab_sphere(l, at, 0.5, v, v3(0, 0, 0));
        else lab_box(l, at, v3(0.5, 0.5, 0.2), 0.03, q_about_axis(2, fl_rng_in(&g, 0, 0.05)), v, v3(0, 0, 0));
    }
    lab_make(l, 2e-4);
}

static double print_cost(int32_t side, int spheres, double pitch, enum sea water, int64_t steps,
                         const char *what)
{
    lab l;
    make_grid(&l, side, spheres, pitch, water);
    lab_run(&l, 2);
    const int64_t touching = l.w.contact_steps;
    const double begun = processor_time();
    const int bad = lab_run(&l, steps);
    const double each = 1e9 * (processor_time() - begun) / (double)steps / l.w.n;
    fl_energy_update(&l.w);
    printf("%-34s %8d bodies %8.0f ns a body-step, %8.3g contacts a body, energy residual %8.2g of the "
           "throughput\n",
           what, l.w.n, each, (double)(l.w.contact_steps - touching) / (double)steps / l.w.n,
           fabs(l.w.ledger.residual) / l.w.ledger.throughput);
    lab_free(&l);
    return bad ? INFINITY : each;
}

/* Floes of 1 m among piles that drift at 0.3 m/s; 1 if one of them failed. */
static int run_among_piles(int strong, int64_t steps)
{
    enum { ROWS = 14, COLUMNS = 15, PILES = 10, FLOES = ROWS * COLUMNS - PILES };
    lab l;
    lab_start(&l);
    lab_set(&l, "run.gravity=9.81");
    lab_set(&l, "water.current=0.3 0 0");
    lab_set(&l, "contact.friction=0.1"), lab_set(&l, "contact.restitution=0.3");
    lab_set(&l, "contact.stiffness_factor=0.01");
    if (strong) {
        lab_set(&l, "failure.crushing=structure"), lab_set(&l, "failure.pressure=20 MPa");
        lab_set(&l, "failure.flexural_strength=100 MPa");
        lab_set(&l, "failure.fracture_toughness=1e6 kPa.m^0.5");
    }
    for (int32_t k = 0; k < ROWS * COLUMNS; k++) {
        const fl_vec3 x = v3(1.004 * (k % COLUMNS), 1.004 * (k / COLUMNS), 0);
        if (k % 21 == 10) lab_cone(&l, (fl_cone){v3(x.x, x.y, -2), v3(x.x, x.y, 2), 0.5, 0.5});
        else lab_box(&l, v3(x.x, x.y, -0.075), v3(0.5, 0.5, 0.1), 0.02, q_one(), v3(0.3, 0, 0), v3(0, 0, 0));
    }
    lab_make(&l, 0);
    const int bad = lab_run(&l, steps);
    printf("%lld\n", (long long)(steps * FLOES));
    const int fails = l.w.crushing.contact_steps || l.w.breaking.bent || l.w.breaking.split;
    if (fails || !l.w.contact_steps)
        fprintf(stderr, "bench_step: floes that touch and do not fail are expected\n");
    lab_free(&l);
    return bad || fails;
}

/* Body-steps of floes without contacts, for instruction counts. */
static int run_without_contacts(const char *where, int64_t steps)
{
    lab l;
    const int one = strcmp(where, "one") == 0;
    if (one || strcmp(where, "any") == 0) {
        int bad = 0;
        lab_gas_on(&l, "patch", 0.1, 1);
        for (int64_t k = 0; k < steps && !bad; k++) bad = contact_step(&l.w, one);
        printf("%lld\n", (long long)(steps * l.w.n));
        lab_free(&l);
        return bad;
    }
    if (strcmp(where, "bonds") == 0) {
        scene_of_bonds(&l, 6, NULL);
        lab_set(&l, "bond.normal_strength=1 GPa"), lab_set(&l, "bond.shear_strength=1 GPa");
        lab_set(&l, "boundary.min=-3.5 -9 -9"), lab_set(&l, "boundary.max=3.5 9 none"); /* out of range */
        lab_make(&l, 1e-5);
        const int bad = lab_run(&l, steps);
        printf("%lld\n", (long long)(steps * l.w.bonds.n));
        lab_free(&l);
        return bad;
    }
    enum sea water = DRY;
    while (water + 1 < SEAS && strcmp(where, sea_names[water]) != 0) water++;
    make_grid(&l, 10, 0, 4.0, water);
    const int bad = lab_run(&l, steps);
    printf("%lld\n", (long long)(steps * l.w.n));
    lab_free(&l);
    return bad;
}

/* Cost of a sleeping floe over one that is awake, and its error: all adrift in the same water, or blocks
 * that lie on a floor. */
static double cost_of_sleep(int rests, double sleep, lab *l)
{
    lab_start(l);
    if (sleep > 0.0) lab_setf(l, "run.sleep=%g", sleep);
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "contact.stiffness_factor=0.05");
    if (rests) {
        lab_set(l, "contact.friction=0.3");
        lab_set(l, "contact.restitution=0.1");
        lab_set(l, "boundary.type=free free rigid");
        lab_set(l, "boundary.min=none none 0");
    } else lab_set(l, "water.current=0.2 0 0");
    for (int32_t k = 0; k < (rests ? 100 : 900); k++) {
        fl_rng g = fl_rng_of(4, k, FL_RNG_TEST);
        const double v = rests ? 0.0 : 0.05;
        lab_box(l, v3(2.0 * (k % 30), 2.0 * (k / 30), rests ? 0.2 : -0.151), v3(0.5, 0.5, 0.2), 0.03, q_one(),
                v3(fl_rng_in(&g, -v, v), fl_rng_in(&g, -v, v), 0), v3(0, 0, 0));
    }
    lab_make(l, rests ? 0.0 : 4e-4);
    lab_run(l, 8000); /* until they are at rest */
    const double begun = processor_time();
    const int bad = lab_run(l, 2000);
    const double each = 1e9 * (processor_time() - begun) / 2000 / l->w.n;
    fl_sleep_advance_to_now(&l->w);
    return bad ? INFINITY : each;
}

static void compare_sleep(int rests, int *good, int *bad)
{
    lab off, on;
    double most = 0.0;
    const double awake = cost_of_sleep(rests, 0.0, &off), sleeps = cost_of_sleep(rests, 1e-5, &on);
    for (int32_t k = 0; k < on.w.n; k++)
        most = fmax(most, v3_norm(v3_sub(on.w.b.x[k], off.w.b.x[k])) / on.w.b.radius[k]);
    printf("%-34s %8d bodies %8.0f ns a body-step awake, %6.1f ns asleep: %.3f; error %.2g of the radius\n",
           rests ? "blocks at rest, run.sleep 1e-5" : "floes adrift, run.sleep 1e-5", on.w.n, awake, sleeps,
           sleeps / awake, most);
    if (isfinite(awake + sleeps) && most < 1e-2) ++*good;
    else ++*bad;
    lab_free(&off), lab_free(&on);
}

/* Cost of a floe in a sea whose water is evaluated in every tenth step over one with water in each step,
 * and the distance between the two after a number of steps. */
static double cost_of_water(int every, lab *l)
{
    lab_start(l);
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "water.current=0.2 0 0");
    lab_set(l, "water.wave=jonswap"), lab_set(l, "water.height=0.3"), lab_set(l, "water.period=4");
    lab_set(l, "water.components=20");
    lab_setf(l, "water.every=%d", every);
    for (int32_t k = 0; k < 100; k++)
        lab_box(l, v3(4.0 * (k % 10), 4.0 * (k / 10), -0.151), v3(0.5, 0.5, 0.2), 0.03, q_one(), v3(0, 0, 0),
                v3(0, 0, 0));
    lab_make(l, 1e-4);
    const double begun = processor_time();
    const int bad = lab_run(l, 500);
    const double each = 1e9 * (processor_time() - begun) / 500 / l->w.n;
    fl_energy_update(&l->w);
    return bad ? INFINITY : each;
}

static void compare_water_intervals(int *good, int *bad)
{
    lab all, few;
    double most = 0.0, gone = 0.0;
    const double always = cost_of_water(1, &all), tenth = cost_of_water(10, &few);
    for (int32_t k = 0; k < all.w.n; k++) {
        const fl_vec3 x = v3_sub(all.w.b.x[k], v3(4.0 * (k % 10), 4.0 * (k / 10), -0.151));
        most = fmax(most, v3_norm(v3_sub(few.w.b.x[k], all.w.b.x[k])));
        gone = fmax(gone, v3_norm(x));
    }
    printf(
        "%-34s %8d bodies %8.0f ns a body-step in waves, %6.0f ns with water.every 10: %.3f; error %.2g of "
        "their way\n",
        "floes in a sea", all.w.n, always, tenth, tenth / always, most / gone);
    if (isfinite(always + tenth) && most < 1e-3 * gone) ++*good;
    else ++*bad;
    lab_free(&all), lab_free(&few);
}

int main(int argc, char **argv)
{
    static const double SAFETY[] = {0.4, 0.2, 0.1, 0.05};
    static const char *const LAW[] = {"patch", "core", "manual-si", "manual"};
    if (argc == 3 && strcmp(argv[1], "order") == 0) return !compare_sum_orders(atoi(argv[2]));
    if (argc == 3 && (strcmp(argv[1], "whole") == 0 || strcmp(argv[1], "strong") == 0))
        return run_among_piles(argv[1][0] == 's', atoi(argv[2]));
    if (argc == 3) return run_without_contacts(argv[1], atoi(argv[2]));
    setvbuf(stdout, NULL, _IOLBF, 0);
    printf("gas of 196 floes, elastic, no friction, 4 s, one thread\n");
    printf("%-10s %8s %10s %12s %15s %15s %14s %12s\n", "law", "safety", "dt[s]", "ns/body-step",
           "ns/contact-step", "contacts", "energy drift", "overlap/2R");
    int good = 0, bad = 0;
    for (size_t k = 0; k < 4; k++) {
        for (size_t s = 0; s < 4; s++) {
            if (print_row(LAW[k], k < 2, SAFETY[s])) good++;
            else bad++;
        }
    }
    printf("\nsums in one order, and in the order in which threads come\n");
    for (int threads = 1; threads <= 2; threads++) {
        if (compare_sum_orders(threads)) good++;
        else bad++;
    }
    printf("\nbodies without contacts\n");
    const double far = print_cost(30, 0, 4.0, DRY, 2000, "floes, dry");
    const double afloat = print_cost(30, 0, 4.0, STILL, 500, "floes, in water");
    compare_sleep(0, &good, &bad);
    compare_sleep(1, &good, &bad);
    compare_water_intervals(&good, &bad);
    printf("\ntime against number\n");
    double first = 0.0, last = 0.0;
    for (int32_t side = 32; side <= 317; side *= 3)
        last = print_cost(side, 0, 1.02, DRY, side > 200 ? 20 : 200, "floes"),
        first = first > 0.0 ? first : last;
    double one = 0.0, million = 0.0;
    for (int32_t side = 100; side <= 1000; side *= 10)
        million = print_cost(side, 1, 0.9995, DRY, side > 500 ? 10 : 200, "spheres"),
        one = one > 0.0 ? one : million;
    printf("the largest number over the smallest: floes %.2f, spheres %.2f\n", last / first, million / one);
    if (isfinite(far + afloat + first + last + one + million)) good++;
    else bad++;
    printf("%d passed, %d failed\n", good, bad);
    return bad > 0;
}
