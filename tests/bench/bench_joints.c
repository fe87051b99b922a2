/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_joints.c -- cost of the joints of rigid blocks.  Grids of cubes of 1 m, every face a joint under 30
 * kPa: all joints evaluated where they are (no point is laid anew), and whole steps.  held: joints that
 * cannot fail, blocks that move at about 1 mm/s without loss.  slip: the blocks keep velocities that shear
 * every joint at 1 cm/s against friction of 10 degrees.  The error beside it: the residual of the energy
 * over the throughput.  Times are of the processor of this machine; compare rows of one run only.
 *
 *     bench_joints           the table
 *     bench_joints SIDE      a grid of SIDE^3 blocks */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "base/rng.h"
#include "contact/joint_list.h"
#include "sim/energy_balance.h"
#include "sim/memory_use.h"
#include "support/block_cuts.h"
#include "world/access.h"

static double thread_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Holds the cubes to velocities that shear every joint at 1 cm/s: below the radius of the edges in all, so
 * that joints alone touch. */
static void shear_all(fl_world *w)
{
    fl_err err = {0};
    for (int32_t k = 0; k < w->n; k++) {
        const fl_vec3 x = w->b.x[k];
        w->b.fixed_dof[k] = FL_DOF_X | FL_DOF_Y | FL_DOF_Z | FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ;
        w->b.v[k] = v3_scale(0.01, v3(floor(x.z), floor(x.x), floor(x.y)));
    }
    if (fl_step_start(w, &err)) exit(1);
}

/* side^3 cubes; slips: all are held to their velocities. */
static void make_grid(lab *l, int side, int slips)
{
    static const char *const SET[] = {"name=a dip=0 dd=0 spacing=1 origin=0,0,0",
                                      "name=b dip=90 dd=90 spacing=1 origin=0,0,0",
                                      "name=c dip=90 dd=0 spacing=1 origin=0,0,0", NULL};
    rock_cut t;
    rock_cut_box(&t, v3(0, 0, 0), v3(side, side, side), SET, 1);
    lab_start(l);
    lab_set(l, "material.ice.density=2500");
    lab_set(l, "material.ice.young=1 GPa");
    for (int k = 0; k < 3; k++) {
        lab_setf(l, "joint.%c.normal_stiffness=1 GPa/m", 'a' + k);
        lab_setf(l, "joint.%c.shear_stiffness=1 GPa/m", 'a' + k);
        lab_setf(l, "joint.%c.friction_angle=10", 'a' + k);
        lab_setf(l, "joint.%c.initial_stress=%g %g %g Pa", 'a' + k, 3e4, 3e4, 3e4);
        if (slips) continue;
        lab_setf(l, "joint.%c.cohesion=none", 'a' + k);
        lab_setf(l, "joint.%c.tension=none", 'a' + k);
    }
    rock_cut_fill(&t, l, 1e-3, -1);
    rock_cut_free(&t);
    for (int32_t k = 0; k < l->field.n && !slips; k++) {
        fl_rng g = fl_rng_of(1, k, FL_RNG_TEST);
        l->field.velocity[k] =
            v3(1e-3 * fl_rng_normal(&g), 1e-3 * fl_rng_normal(&g), 1e-3 * fl_rng_normal(&g));
    }
    lab_make(l, 0.0);
    if (slips) shear_all(&l->w);
}

/* Nanoseconds of a joint at the present poses. */
static double joint_time(lab *l)
{
    const fl_bond_list *s = &l->w.bonds;
    const int rounds = 1 + 500000 / s->n;
    const double begun = thread_seconds();
    for (int r = 0; r < rounds; r++)
        for (int32_t k = s->faces; k < s->n; k++) fl_joint_list_force(&l->w, k, v3(0, 0, 0));
    return 1e9 * (thread_seconds() - begun) / rounds / (s->n - s->faces);
}

static int print_grid(int side, int slips)
{
    lab l;
    make_grid(&l, side, slips);
    const int32_t joints = l.w.bonds.n;
    const int64_t steps = 40 + 1000000 / joints; /* slip takes some thirty to begin */
    const double alone = joint_time(&l);
    const double begun = thread_seconds();
    const int ended = lab_run(&l, steps) == 0;
    const double spent = 1e9 * (thread_seconds() - begun) / (double)steps;
    const fl_joint_counts n = fl_joint_list_counts(&l.w);
    const fl_memory_use use = fl_memory_use_of(&l.w);
    fl_energy_update(&l.w);
    const double error = fabs(l.w.ledger.residual) / l.w.ledger.throughput;
    printf("%-5s %8d %8d %8d %8d %12.1f %12.1f %14.1f %14.1f %12.2f %12.2g\n", slips ? "slip" : "held", l.w.n,
           joints, n.slip, n.open, alone / FL_BOND_POINTS, spent / joints / FL_BOND_POINTS, spent / joints,
           spent / l.w.n, fl_memory_use_sum(&use) / l.w.n / 1024.0, error);
    lab_free(&l);
    return ended && n.open == 0 && n.slip == (slips ? joints : 0) && error < 1e-2;
}

int main(int argc, char **argv)
{
    static const int SIDE[] = {5, 10, 22};
    int ok = 1;
    printf("%-5s %8s %8s %8s %8s %12s %12s %14s %14s %12s %12s\n", "joint", "blocks", "joints", "slip",
           "open", "ns/point", "ns/point-step", "ns/joint-step", "ns/body-step", "KiB/block", "energy error");
    for (int k = 0; k < (argc == 2 ? 1 : 3); k++)
        for (int slips = 0; slips < 2; slips++) ok &= print_grid(argc == 2 ? atoi(argv[1]) : SIDE[k], slips);
    printf("%d passed, %d failed\n", ok, !ok);
    return !ok;
}
