/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_strip.c -- cost of ice that crushes by its speed (contact/strip_contact.h).  A floe 0.5 m thick is
 * driven at 0.1 m/s against a wall or a pile whose elements are 0.5 m wide, in steps of 1 ms.  The processor
 * time of a contact is that of a step less that of a step in which nothing touches, the least of several
 * rounds; that of an element and step is the slope from 31 to 248 elements, on a pile of those on its front.
 * Beside it the same contact under crushing_law = plain, and the error: the residual of the energy over the
 * throughput.
 *
 *     bench_strip               the table
 *     bench_strip CASE STEPS    steps of apart, plain, plain-S and hard-S (its ice does not crush), S one of
 *                               wall, pile, cone, mesh, ice (under the law quick: quick-plain-S), wall-N of N
 *                               elements, pile-N with N on its front; prints their number, for counts of
 *                               instructions */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "base/pi.h"
#include "sim/energy_balance.h"
#include "support/small_world.h"

#define SPEED 0.1
#define DEPTH 6e-3 /* of the floe in the wall at the start [m] */
#define WIDTH 0.5  /* of an element [m] */

enum { FEW = 31, MANY = 248, ROUNDS = 7, STEPS = 4000, SETTLE = 500 };

static double thread_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A pile of `radius` about 0, upright; a cone of that radius at the floe; or a mesh, its rear hollow. */
static void add_pile(lab *l, const char *name, double radius)
{
    enum { SIDES = 24 };
    const double lean = strstr(name, "cone") ? 0.4 : 0.0;
    if (!strstr(name, "mesh")) {
        lab_cone(l, (fl_cone){v3(0, 0, -2), v3(0, 0, 2), radius + 2.0 * lean, radius - 2.0 * lean});
        return;
    }
    fl_vec3 xy[SIDES + 2];
    for (int k = 0; k <= SIDES; k++) {
        const double a = PI * (0.5 + (double)k / SIDES);
        xy[k] = v3(radius * cos(a), radius * sin(a), 0);
    }
    xy[SIDES + 1] = v3(-0.3 * radius, 0, 0);
    lab_prism(l, SIDES + 2, xy, -2, 2);
}

/* 0 with a message for an unknown case. */
static int make_case(lab *l, const char *name)
{
    const int quick = strncmp(name, "quick-", 6) == 0;
    if (quick) name += 6;
    const int ice = strstr(name, "ice") != NULL, hard = strncmp(name, "hard-", 5) == 0,
              apart = strcmp(name, "apart") == 0, plain = hard || strncmp(name, "plain", 5) == 0,
              wall = !strstr(name, "pile") && !strstr(name, "cone") && !strstr(name, "mesh"),
              elements = apart || plain ? FEW : atoi(name + 5);
    if (!apart && !plain && (elements < 1 || (strncmp(name, "wall-", 5) && strncmp(name, "pile-", 5)))) {
        fprintf(
            stderr,
            "bench_strip: %s: apart, plain, hard-S or plain-S, S of wall, pile, cone and mesh, with quick- "
            "before it, wall-N or pile-N is expected\n",
            name);
        return 0;
    }
    lab_start(l);
    lab_set(l, "boundary.type=free");
    lab_set(l, "boundary.drive_width=2000");
    lab_set(l, "boundary.drive_edge=-x");
    lab_set(l, "boundary.drive_fixed=x y z rx ry rz");
    if (quick) lab_set(l, "contact.law=quick");
    const double speed = hard ? 1e-3 * SPEED : SPEED;
    lab_setf(l, "boundary.drive=%g", speed);
    if (!hard) {
        lab_set(l, "failure.crushing=structure");
        lab_set(l, "failure.pressure=0.4 MPa");
    }
    if (!plain) lab_set(l, "failure.crushing_law=rate");
    if (!plain) lab_setf(l, "failure.element_width=%.17g", WIDTH * (1.0 + 1e-9));
    const double half = 0.5 * WIDTH * elements, radius = WIDTH * elements / PI;
    if (ice) lab_set(l, "boundary.drive_width=500");
    else if (wall) lab_wall(l, v3(0, -half, -2), v3(1, half, 2), 1);
    else add_pile(l, name, radius);
    /* the law `rate` has the pile in the ice; `plain` its front edge */
    const double front = apart ? -2.0 * radius : wall ? DEPTH : plain ? -radius + DEPTH : 100.0;
    lab_box(l, v3(front - 200.0, 0, 0), v3(200, 100, 0.25), 0.05, (fl_quat){1, 0, 0, 0}, v3(speed, 0, 0),
            v3(0, 0, 0));
    if (ice) { /* a floe that is held, in the place of the wall */
        if (!hard) lab_set(l, "failure.crushing=all");
        lab_box(l, v3(200, 0, 0), v3(200, half, 0.25), 0.05, (fl_quat){1, 0, 0, 0}, v3(0, 0, 0), v3(0, 0, 0));
    }
    lab_make(l, 1e-3);
    if (ice) l->w.b.fixed_dof[1] = FL_DOF_X | FL_DOF_Y | FL_DOF_Z | FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ;
    return 1;
}

/* Seconds of a step, the least of the rounds so far. */
typedef struct {
    const char *name;
    lab l;
    double seconds, residual;
} strip_case;

static void time_round(strip_case *c)
{
    const double begun = thread_seconds();
    if (lab_run(&c->l, STEPS)) exit(1);
    c->seconds = fmin(c->seconds, (thread_seconds() - begun) / STEPS);
}

int main(int argc, char **argv)
{
    strip_case row[] = {{"apart", {.made = 0}, INFINITY, 0},      {"plain", {.made = 0}, INFINITY, 0},
                        {"plain-pile", {.made = 0}, INFINITY, 0}, {"wall-31", {.made = 0}, INFINITY, 0},
                        {"wall-248", {.made = 0}, INFINITY, 0},   {"pile-31", {.made = 0}, INFINITY, 0},
                        {"pile-248", {.made = 0}, INFINITY, 0}};
    enum { ROWS = sizeof row / sizeof *row };
    if (argc == 3) {
        lab l;
        if (!make_case(&l, argv[1])) return 2;
        if (lab_run(&l, atoll(argv[2]))) return 1;
        printf("%lld\n", atoll(argv[2]));
        lab_free(&l);
        return 0;
    }
    for (int k = 0; k < ROWS; k++) {
        if (!make_case(&row[k].l, row[k].name) || lab_run(&row[k].l, SETTLE)) return 1;
    }
    for (int r = 0; r < ROUNDS; r++)
        for (int k = 0; k < ROWS; k++) time_round(&row[k]);
    printf("%-12s %10s %12s %12s %14s %10s\n", "case", "step[us]", "contact[us]", "over plain", "element[ns]",
           "residual");
    for (int k = 0; k < ROWS; k++) {
        const double contact = row[k].seconds - row[0].seconds;
        fl_energy_update(&row[k].l.w);
        printf("%-12s %10.3f", row[k].name, 1e6 * row[k].seconds);
        if (k > 0) printf(" %12.3f", 1e6 * contact);
        if (k >= 3) printf(" %12.3f", contact / (row[k >= 5 ? 2 : 1].seconds - row[0].seconds));
        if (k == 4 || k == 6) printf(" %14.2f", 1e9 * (row[k].seconds - row[k - 1].seconds) / (MANY - FEW));
        else if (k > 0) printf("%*s", k >= 3 ? 15 : 28, "-");
        if (k > 0) printf(" %10.1e", fabs(row[k].l.w.ledger.residual) / row[k].l.w.ledger.throughput);
        printf("\n");
        lab_free(&row[k].l);
    }
    return 0;
}
