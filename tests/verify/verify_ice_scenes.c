/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The closed forms of ice-scenes(7) beside runs: one floe on a leg. */
#include <math.h>
#include <stdio.h>
#include "ice/drift_bounds.h"
#include "support/small_world.h"
#include "support/verify.h"
#include "world/access.h"

#define SPEED 0.5
#define RESTITUTION 0.3

/* A floe of 20 m by 20 m by 1 m that drifts with the water, its front half a metre before a leg of 1.5 m. */
static void start_floe(lab *l, double arm, double stiffness_factor, int with_added_mass)
{
    lab_start(l);
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "material.ice.density=900");
    lab_setf(l, "contact.restitution=%.17g", RESTITUTION);
    lab_setf(l, "contact.stiffness_factor=%.17g", stiffness_factor);
    lab_setf(l, "water.current=%.17g 0 0", SPEED);
    lab_set(l, "water.drag_force_coef=0");
    lab_set(l, "water.drag_moment_coef=0");
    if (with_added_mass) lab_set(l, "water.added_mass=auto");
    lab_box(l, v3(-11.25, arm, 0.5 - 900.0 / 1025.0), v3(10.0, 10.0, 0.5), 0.1, q_one(), v3(SPEED, 0, 0),
            v3(0, 0, 0));
    lab_cone(l, (fl_cone){v3(0, 0, -5), v3(0, 0, 5), 0.75, 0.75});
    lab_make(l, 0.0);
}

/* What the leg took of the momentum along the drift by the hit [N s], and the largest load of a step [N]. */
struct hit {
    double impulse, peak;
};

static struct hit run_hit(lab *l)
{
    struct hit h = {0};
    double before = 0.0;
    while (fl_world_time(&l->w) < 3.0) {
        if (lab_run(l, 1)) return (struct hit){NAN, NAN};
        const double impulse = l->w.part_impulse[0].x;
        h.peak = fmax(h.peak, (impulse - before) / l->w.dt);
        before = impulse;
    }
    h.impulse = before;
    return h;
}

/* IS1: the impulse is that of the momentum of the floe, less where it can turn, more with the water that it
 * moves. */
static void impulse_of_one_floe(void)
{
    for (int k = 0; k < 3; k++) {
        const double arm = k == 1 ? 5.0 : 0.0;
        lab l;
        start_floe(&l, arm, 0.02, k == 2);
        const double m = l.w.b.m[0], gyration = sqrt(l.w.b.I[0].z / m);
        const double moved = k == 2 ? l.w.b.added_mass[0].x : 0.0;
        const double expected = 1e-3 * fl_floe_impulse(RESTITUTION, m + moved, SPEED, arm, gyration);
        static const char *const WHAT[] = {"impulse of a floe on a leg in line with its centre [kN s]",
                                           "the same with an arm of 5 m [kN s]",
                                           "the same in line, with added mass [kN s]"};
        verify_row("IS1", WHAT[k], 1e-3 * run_hit(&l).impulse, expected, k == 1 ? 0.01 : 0.005, VERIFY_REL);
        if (k == 2)
            verify_row("IS1", "mass with added mass over mass", 1.0 + moved / m, 1.1, 0.005, VERIFY_REL);
        lab_free(&l);
    }
}

/* IS2: peaks go with the stiffness factor to 0.446, impulses do not: a factor of 1 gives six times the
 * crushing load of 1.17 MN, 0.02 about what ice can carry. */
static void peak_against_stiffness(void)
{
    const double factor[] = {1.0, 0.1, 0.02};
    double peak[3], impulse[3];
    for (int k = 0; k < 3; k++) {
        lab l;
        start_floe(&l, 0.0, factor[k], 0);
        const struct hit h = run_hit(&l);
        peak[k] = 1e-6 * h.peak, impulse[k] = h.impulse;
        verify_note("stiffness factor %g: peak %.3g MN, crushing 1.17 MN", factor[k], peak[k]);
        lab_free(&l);
    }
    verify_row("IS2", "power of the peak with the stiffness factor", log(peak[0] / peak[2]) / log(50.0),
               0.446, 0.015, VERIFY_ABS);
    verify_row("IS2", "peak at 0.02 [MN]", peak[2], 1.33, 0.03, VERIFY_REL);
    verify_row("IS2", "impulse at 1 over that at 0.02", impulse[0] / impulse[2], 1.0, 0.002, VERIFY_REL);
}

int main(void)
{
    verify_begin("ice scenes: what bounds the load");
    impulse_of_one_floe();
    peak_against_stiffness();
    return verify_end();
}
