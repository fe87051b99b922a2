/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_zones.c -- cost of deformable blocks.  A cube of SIDE^3 cells, five zones each, on a fixed base,
 * moves freely under a weight that it has not carried before; elastic, and Mohr-Coulomb that does not
 * yield.  zone-step is the whole step over the zones; plain: without strains averaged at the nodes.  The
 * error beside it: the residual of the energy over the throughput.  Times are of the processor of this
 * machine; compare rows of one run only.
 *
 *     bench_zones           the table
 *     bench_zones SIDE      one cube, elastic */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "sim/energy_balance.h"
#include "sim/memory_use.h"
#include "support/small_world.h"
#include "world/access.h"

static double thread_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

enum { ELASTIC, PLAIN, YIELDING, KINDS };

static int print_cube(int side, int kind)
{
    static const char *const NAME[KINDS] = {"elastic", "plain", "mohr-coulomb"};
    const double R = 1e-3, half = 0.5 * side - R;
    lab l;
    fl_poly p = {0};
    fl_err err = {0};
    lab_start(&l);
    lab_set(&l, "run.safety=0.5");
    lab_set(&l, "run.gravity=0 0 -9.81");
    lab_set(&l, "material.ice.density=2500");
    lab_set(&l, "material.ice.cohesion=10 MPa");
    lab_set(&l, "material.ice.friction_angle=30");
    lab_set(&l, "zones.size=1.001 m");
    lab_set(&l, "zones.min_side=free free fixed");
    if (kind == PLAIN) lab_set(&l, "zones.averaging=0");
    if (kind == YIELDING) lab_set(&l, "zones.law=mohr-coulomb");
    if (fl_poly_box(&p, v3(half, half, half), &err) ||
        fl_ice_field_add(&l.field, 0, R, &p, NULL, NULL, v3(0, 0, 0), v3(0, 0, 0), &err))
        exit(1);
    const double begun = thread_seconds();
    lab_make(&l, 0.0);
    const double setup = thread_seconds() - begun;
    const fl_zone_set *s = &l.w.zones.set;
    const int64_t steps = 3 + 1000000 / s->zones;
    const double start = thread_seconds();
    if (lab_run(&l, steps)) exit(1);
    const double spent = thread_seconds() - start;
    const fl_memory_use use = fl_memory_use_of(&l.w);
    fl_energy_update(&l.w);
    const double error = fabs(l.w.ledger.residual) / l.w.ledger.throughput;
    printf("%-12s %9d %9d %12.2f %13.1f %12.1f %12.2g\n", NAME[kind], s->zones, s->nodes, setup,
           1e9 * spent / (double)steps / s->zones, fl_memory_use_sum(&use) / s->zones, error);
    lab_free(&l);
    return error < 1e-2;
}

int main(int argc, char **argv)
{
    static const int SIDE[] = {8, 20};
    int ok = 1;
    printf("%-12s %9s %9s %12s %13s %12s %12s\n", "zones", "number", "nodes", "set-up s", "ns/zone-step",
           "bytes/zone", "energy error");
    if (argc == 2) ok = print_cube(atoi(argv[1]), ELASTIC);
    for (int k = 0; k < 2 && argc != 2; k++)
        for (int kind = 0; kind < KINDS; kind++) ok &= print_cube(SIDE[k], kind);
    printf("%d passed, %d failed\n", ok, !ok);
    return !ok;
}
