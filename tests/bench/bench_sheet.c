/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_sheet.c -- cost of a floating sheet of bonded spheres, and the error beside it: bonds alone in lanes
 * and one by one, then whole steps of sheets of several sizes.  The sheets swing freely without loss, so that
 * the residual of their energy is the error: that of order 2 of steps of 0.2 sqrt(m/k).  Times are of the
 * processor of this machine; compare rows of one run only.
 *
 *     bench_sheet            the table
 *     bench_sheet N STEPS    one sheet of about N spheres */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "base/rng.h"
#include "contact/bond_list.h"
#include "ice/sphere_packing.h"
#include "sim/energy_balance.h"
#include "sim/memory_use.h"
#include "support/small_world.h"
#include "world/access.h"

static double processor_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A sheet of three layers of about n spheres of 0.094 m, with random speeds of 1 mm/s. */
static void make_sheet(lab *l, int32_t n)
{
    const double D = 0.094, side = D * sqrt(n / 3.0 * 0.87), draft_of = 900.0 / 1035.0;
    const fl_vec2 lo = {-0.5 * side, -0.5 * side}, hi = {0.5 * side, 0.5 * side};
    fl_sphere_packing a;
    fl_err err = {0};
    if (fl_sphere_packing_make(&a, FL_PACKING_HCP, D, 3, lo, hi, &err)) exit(1);
    const double draft = fl_sphere_packing_draft(&a, draft_of);
    lab_start(l);
    lab_set(l, "material.ice.young=1 GPa");
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "ice.slab=0.23 m");
    lab_set(l, "contact.round_law=linear");
    lab_set(l, "bond.on=true");
    lab_set(l, "bond.poisson=0.3");
    lab_set(l, "bond.softening=stretch");
    lab_set(l, "water.density=1035");
    lab_set(l, "water.drag_force_coef=0.005");
    lab_set(l, "water.added_mass=0 0 3");
    for (int32_t k = 0; k < a.n; k++) {
        fl_rng g = fl_rng_of(1, k, FL_RNG_TEST);
        lab_sphere(l, v3(a.x[k].x, a.x[k].y, a.x[k].z - draft), 0.5 * D,
                   v3(1e-3 * fl_rng_normal(&g), 1e-3 * fl_rng_normal(&g), 1e-3 * fl_rng_normal(&g)),
                   v3(0, 0, 0));
    }
    for (int32_t k = 0; k < a.pairs; k++) {
        const int32_t i = a.pair[k][0], j = a.pair[k][1];
        const fl_vec3 x = v3_lerp(l->field.core[i].v[0], l->field.core[j].v[0], 0.5);
        if (fl_ice_field_add_bond(&l->field, i, j, 1.0, D, x, &err)) exit(1);
    }
    fl_sphere_packing_free(&a);
    lab_make(l, 1.7e-5);
}

/* Nanoseconds of a bond, in lanes or one by one; `one` turns the lanes off. */
static double bond_time(lab *l, int one)
{
    fl_disc_list *s = &l->w.discs;
    const int rounds = 1 + 2000000 / s->n;
    for (int32_t k = 0; k < s->n && one; k++) s->at.is_whole[k] = 0;
    const double begun = processor_time();
    for (int r = 0; r < rounds; r++)
        for (int32_t k = 0; k < s->n; k += FL_DISC_RUN)
            fl_disc_list_evaluate(&l->w, k, k + FL_DISC_RUN < s->n ? k + FL_DISC_RUN : s->n, 0.0);
    const double spent = processor_time() - begun;
    for (int32_t k = 0; k < s->n && one; k++) s->at.is_whole[k] = 1;
    return 1e9 * spent / rounds / s->n;
}

/* Returns 1 if the run kept its energy. */
static int print_row(int32_t about, int64_t steps)
{
    lab l;
    make_sheet(&l, about);
    const double lanes = bond_time(&l, 0), alone = bond_time(&l, 1), begun = processor_time();
    const int ended = lab_run(&l, steps) == 0;
    const double spent = processor_time() - begun;
    const fl_memory_use use = fl_memory_use_of(&l.w);
    fl_energy_update(&l.w);
    const double error = fabs(l.w.ledger.residual) / l.w.ledger.throughput;
    printf("%8d %8d %12.1f %12.1f %14.1f %14.1f %12.2f %12.2g\n", l.w.n, l.w.discs.n, lanes, alone,
           1e9 * spent / (double)steps / l.w.discs.n, 1e9 * spent / (double)steps / l.w.n,
           fl_memory_use_sum(&use) / l.w.n / 1024.0, error);
    lab_free(&l);
    return ended && error < 3e-2;
}

int main(int argc, char **argv)
{
    int ok = 1;
    printf("%8s %8s %12s %12s %14s %14s %12s %12s\n", "spheres", "bonds", "ns in lanes", "ns alone",
           "ns/bond-step", "ns/body-step", "KiB/sphere", "energy error");
    if (argc == 3) ok = print_row(atoi(argv[1]), atol(argv[2]));
    else
        for (int32_t n = 1000; n <= 100000; n *= 10) ok &= print_row(n, 2000000 / n);
    printf("%d passed, %d failed\n", ok, !ok);
    return !ok;
}
