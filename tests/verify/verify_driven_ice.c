/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ice that is pushed: a driven edge row, and the hard cases of rafting, jamming and floes between two
 * cylinders. */
#include <math.h>
#include <stdio.h>
#include "base/pi.h"
#include "base/rng.h"
#include "sim/energy_balance.h"
#include "sim/ice_push.h"
#include "support/small_world.h"
#include "support/verify.h"
#include "world/access.h"

#define G 9.81
static const fl_vec3 ZERO = {0, 0, 0};

/* --- the driven row ----------------------------------------------------------------------------------- */

/* A driven floe that is free to heave is held by its spring; a free floe beside it is not. */
static void heave_of_driven_floe(void)
{
    const double half = 1.0, high = 0.5, bed = 1e4;
    const double side = 2.0 * half - 0.1, face = side * side, mass = 900.0 * 4.0 * half * half * high;
    const double k = bed * face + 2e3, period = 2.0 * PI * sqrt(mass / k), sag = mass * G / k;
    double before = 0.0, first = 0.0, last = 0.0, most = 0.0;
    int n = 0;
    lab l;
    lab_start(&l);
    lab_setf(&l, "run.gravity=%.17g", G);
    lab_set(&l, "boundary.type=free");
    lab_set(&l, "boundary.drive=0.4 0.1 0");
    lab_set(&l, "boundary.drive_width=1.5");
    lab_set(&l, "boundary.drive_spring=2 kN/m");
    lab_setf(&l, "boundary.drive_foundation=%.17g", bed);
    lab_box(&l, ZERO, v3(half, half, 0.5 * high), 0.05, q_one(), v3(9, 9, 0), ZERO);
    lab_box(&l, v3(9, 0, 0), v3(half, half, 0.5 * high), 0.05, q_one(), ZERO, ZERO);
    lab_make(&l, period / 2000.0);
    for (int64_t s = 0; s < 10000; s++) {
        if (lab_run(&l, 1)) return;
        const double z = l.w.b.x[0].z + sag;
        if (before > 0.0 && z <= 0.0) {
            const double t = fl_world_time(&l.w) - l.w.dt * z / (z - before);
            if (n++ == 0) first = t;
            last = t;
        }
        before = z;
        fl_energy_update(&l.w);
        most = fmax(most, fabs(l.w.ledger.residual));
    }
    const double t = fl_world_time(&l.w);
    verify_row("B05", "driven floe, spring and foundation: heave period [s]", (last - first) / (n - 1),
               period, 1e-5, VERIFY_REL);
    verify_row("B05", "displacement along x over speed and time", l.w.b.x[0].x / (0.4 * t), 1.0, 1e-12,
               VERIFY_REL);
    verify_row("B05", "displacement along y over speed and time", l.w.b.x[0].y / (0.1 * t), 1.0, 1e-12,
               VERIFY_REL);
    verify_row("B05", "fall of the floe outside the row [m]", l.w.b.x[1].z, -0.5 * G * t * t, 1e-9,
               VERIFY_REL);
    /* Trapezoidal work keeps the energy to (omega h)^2 / 8 of the oscillating energy. */
    verify_below("B05", "residual over the oscillating energy", most / (0.5 * k * sag * sag), 1e-5);
    lab_free(&l);
}

/* A driven floe pushes a chain of free floes through still water.  The work of the drive is the loss to the
 * water and the kinetic energy. */
static void drive_chain(void)
{
    lab l;
    double held = 0.0;
    lab_start(&l);
    lab_setf(&l, "run.gravity=%.17g", G);
    lab_set(&l, "water.current=0");
    lab_set(&l, "contact.restitution=0.2");
    lab_set(&l, "contact.stiffness_factor=0.01");
    lab_set(&l, "boundary.type=free");
    lab_set(&l, "boundary.drive=0.5");
    lab_set(&l, "boundary.drive_group=none");
    lab_set(&l, "boundary.drive_width=1");
    for (int k = 0; k < 5; k++)
        lab_box(&l, v3(2.1 * k, 0, -0.0305), v3(1, 1, 0.25), 0.05, q_one(), ZERO, ZERO);
    lab_make(&l, 0.0);
    while (fl_world_time(&l.w) < 8.0)
        if (lab_run(&l, 100)) return;
    fl_energy_update(&l.w);
    for (int32_t i = 0; i < l.w.n; i++) held += l.w.b.work_of_constraints[i];
    const fl_ledger *g = &l.w.ledger;
    verify_row("B05", "drive over kinetic, stored and lost energy",
               g->drive_now / (g->kinetic - 0.0 + g->drag + g->damping_now + g->friction_now +
                               (g->gravity + g->hydrostatic + g->elastic - g->start)),
               1.0, 5e-4, VERIFY_REL);
    verify_row("B05", "work of the drive and of the constraints [J]", g->drive_now, held, 1e-12, VERIFY_REL);
    verify_true("B05", "speed of the last floe of the chain", l.w.b.v[4].x > 0.4);
    lab_free(&l);
}

/* --- a push with a limit ------------------------------------------------------------------------------ */

/* Mass of box k of a lab, and a chain of floes before a driven one. */
static void start_pushed(lab *l, const char *load)
{
    lab_start(l);
    lab_set(l, "contact.restitution=0.2");
    lab_set(l, "contact.stiffness_factor=0.01");
    lab_set(l, "boundary.type=free");
    lab_set(l, "boundary.drive=0.5");
    lab_set(l, "boundary.drive_width=1");
    lab_set(l, load);
    lab_box(l, ZERO, v3(1, 1, 0.25), 0.05, q_one(), ZERO, ZERO);
}

/* The row pushes dry floes that are free: until all have its speed it pushes with P, the sum of all momenta
 * is the impulse of the push, and the ledger has its work. P t is the momentum while it is at the limit. */
static void push_free_floes(void)
{
    const double load = 300.0, width = 2.0;
    double momentum, all, residual;
    lab l;
    start_pushed(&l, "boundary.line_load=300 N/m");
    for (int k = 1; k < 4; k++) lab_box(&l, v3(2.1 * k, 0, 0), v3(1, 1, 0.25), 0.05, q_one(), ZERO, ZERO);
    lab_make(&l, 0.0);
    const double start = l.w.b.m[0] * 0.5;
    verify_row("B06", "largest push: line load times width [N]", l.w.push.limit, load * width, 1e-12,
               VERIFY_REL);
    while (fl_world_time(&l.w) < 1.5)
        if (lab_run(&l, 20)) return;
    momentum = 0.0;
    for (int32_t i = 0; i < l.w.n; i++) momentum += l.w.b.m[i] * l.w.b.v[i].x;
    verify_row("B06", "momentum of all less that of the start [N s]", momentum - start, l.w.push.impulse,
               1e-9, VERIFY_REL);
    verify_row("B06", "impulse over the time at the limit [N]", l.w.push.impulse / l.w.push.limited,
               load * width, 0.02, VERIFY_REL);
    while (fl_world_time(&l.w) < 12.0)
        if (lab_run(&l, 100)) return;
    all = l.w.b.m[0] + l.w.b.m[1] + l.w.b.m[2] + l.w.b.m[3];
    verify_row("B06", "impulse when all have the speed of the drive [N s]", l.w.push.impulse,
               all * 0.5 - start, 0.05, VERIFY_REL);
    fl_energy_update(&l.w);
    residual = fabs(l.w.ledger.residual);
    verify_below("B06", "residual over the work of the push", residual / l.w.push.work, 2e-3);
    verify_row("B06", "work of the push and of the drive [J]", l.w.push.work, l.w.ledger.drive_now, 1e-2,
               VERIFY_REL);
    lab_free(&l);
}

/* Against a floe that is held the row stands, and the force on it is the line load times the width; without
 * a limit it would rise without end. */
static void push_held_floe(void)
{
    fl_err err = {0};
    lab l;
    start_pushed(&l, "boundary.line_load=5 kN/m");
    lab_set(&l, "group.held.fixed=x y z rx ry rz");
    lab_box(&l, v3(2.1, 0, 0), v3(1, 1, 0.25), 0.05, q_one(), ZERO, ZERO);
    l.field.group[1] = fl_string_table_add(&l.field.groups, "held", &err);
    lab_make(&l, 0.0);
    while (fl_world_time(&l.w) < 4.0)
        if (lab_run(&l, 100)) return;
    verify_row("B06", "force on a floe that is held, over line load and width", l.w.b.f[1].x / 10e3, 1.0,
               1e-6, VERIFY_REL);
    verify_below("B06", "speed of the row before it [m/s]", fabs(l.w.push.velocity), 1e-6);
    lab_free(&l);
}

/* A rigid wall moves: without a limit at its speed, whatever is before it; with one as the row does. */
static void push_by_wall(int limited)
{
    lab l;
    double momentum = 0.0;
    lab_start(&l);
    lab_set(&l, "contact.restitution=0.2");
    lab_set(&l, "contact.stiffness_factor=0.01");
    lab_set(&l, "boundary.type=rigid free free");
    lab_set(&l, "boundary.min=-2 none none");
    lab_set(&l, "boundary.max=none none none");
    lab_set(&l, "boundary.drive=0.5");
    lab_set(&l, "boundary.drive_of=wall");
    if (limited) lab_set(&l, "boundary.line_load=300 N/m");
    for (int k = 0; k < 3; k++) lab_box(&l, v3(2.1 * k, 0, 0), v3(1, 1, 0.25), 0.05, q_one(), ZERO, ZERO);
    lab_make(&l, 0.0);
    const double t = limited ? 3.5 : 6.0;
    while (fl_world_time(&l.w) < t)
        if (lab_run(&l, 20)) return;
    fl_energy_update(&l.w);
    for (int32_t i = 0; i < l.w.n; i++) momentum += l.w.b.m[i] * l.w.b.v[i].x;
    if (limited) {
        verify_row("B06", "wall: momentum of all and of its mass [N s]",
                   momentum + l.w.push.mass * (l.w.push.velocity - 0.5), l.w.push.impulse, 1e-9, VERIFY_REL);
        verify_true("B06", "wall: it has lost speed to the ice", l.w.push.velocity < 0.45);
        verify_row("B06", "wall: way of the wall [m]", l.w.b.x[l.w.push.wall].x + 2.0, l.w.push.way, 1e-9,
                   VERIFY_REL);
    } else {
        verify_row("B06", "wall without a limit: its way over speed and time",
                   (l.w.b.x[l.w.push.wall].x + 2.0) / (0.5 * fl_world_time(&l.w)), 1.0, 1e-12, VERIFY_REL);
        verify_row("B06", "wall without a limit: momentum of the floes and its impulse [N s]", momentum,
                   l.w.push.impulse, 1e-9, VERIFY_REL);
    }
    verify_below("B06", "wall: residual over its work",
                 fabs(l.w.ledger.residual) / fabs(l.w.ledger.drive_now), 2e-3);
    lab_free(&l);
}

/* p_D of ISO 19906 for 1 m of ice and a pack of 1 km: 48 to 240 kN/m. */
static void iso_line_load(void)
{
    verify_row("B06", "p_D, R 2, 1 m, 1 km [kN/m]", 1e-3 * fl_iso_line_load(2.0, 1.0, 1000.0),
               2e3 / exp(0.54 * log(1000.0)), 1e-12, VERIFY_REL);
    verify_row("B06", "p_D, R 10, 2 m, 4 km [kN/m]", 1e-3 * fl_iso_line_load(10.0, 2.0, 4000.0),
               10e3 * exp(1.25 * log(2.0) - 0.54 * log(4000.0)), 1e-12, VERIFY_REL);
}

/* --- H26 ---------------------------------------------------------------------------------------------- */

/* One floe is driven against a fixed one whose edge lies lower by half of the thickness: it slides over or
 * under it. */
static void raft_over_floe(double tilt)
{
    lab l;
    double most = 0.0, deepest = 0.0, force = 0.0;
    char what[120];
    lab_start(&l);
    lab_setf(&l, "run.gravity=%.17g", G);
    lab_set(&l, "water.current=0");
    lab_set(&l, "contact.friction=0.2");
    lab_set(&l, "contact.restitution=0.3");
    lab_set(&l, "contact.stiffness_factor=0.05");
    lab_set(&l, "boundary.type=free");
    lab_set(&l, "boundary.drive=0.5");
    lab_set(&l, "boundary.drive_width=4");
    lab_set(&l, "boundary.drive_fixed=x y rx rz");
    /* nose up: its lower edge stands above the upper edge of the other */
    lab_box(&l, v3(-3.2, 0, 0.12), v3(3, 1.5, 0.25), 0.05, q_of_vector(v3(0, -tilt, 0)), ZERO, ZERO);
    lab_box(&l, v3(3.2, 0, -0.0305), v3(3, 2, 0.25), 0.05, q_one(), ZERO, ZERO);
    lab_make(&l, 0.0);
    while (fl_world_time(&l.w) < 7.0) {
        if (lab_run(&l, 20)) return;
        fl_energy_update(&l.w);
        most = fmax(most, fabs(l.w.ledger.residual));
        for (int32_t c = 0; c < l.w.n_pair; c++) {
            if (l.w.pair[c].touching == 0) continue;
            deepest = fmax(deepest, l.w.pair[c].contact->overlap / 0.1);
            force = fmax(force, v3_norm(l.w.pair[c].contact->force));
        }
    }
    /* the middle of the lower nose, against the faces of the other floe, 0.25 m from its middle */
    const fl_vec3 nose = v3_add(
        l.w.b.x[0], q_rotate(l.w.b.q[0], q_rotate(q_conj(l.w.q0[0]),
                                                  q_rotate(q_of_vector(v3(0, -tilt, 0)), v3(3, 0, -0.25)))));
    const fl_vec3 in = q_rotate(l.w.q0[1], q_rotate(q_conj(l.w.b.q[1]), v3_sub(nose, l.w.b.x[1])));
    const int clear = in.z > 0.2 || in.z + 0.5 < -0.2;
    verify_note(
        "nose up by %g rad: %.3g m over one another, nose at %.3g m over the middle of the other, largest "
        "force %.3g kN",
        tilt, 6.0 - (l.w.b.x[1].x - l.w.b.x[0].x), in.z, force / 1e3);
    snprintf(what, sizeof what, "rafting at 0.5 m/s, nose up by %g: residual over the throughput", tilt);
    verify_below("H26", what, most / l.w.ledger.throughput, 1e-3);
    snprintf(what, sizeof what, "rafting, nose up by %g: overlap over the radii", tilt);
    verify_below("H26", what, deepest, 0.3);
    snprintf(what, sizeof what, "rafting, nose up by %g: over or under the other floe, not inside it", tilt);
    verify_true("H26", what, 6.0 - (l.w.b.x[1].x - l.w.b.x[0].x) > 0.5 && clear);
    lab_free(&l);
}

/* --- H27 ---------------------------------------------------------------------------------------------- */

/* A loose field between walls is compacted by a driven row until it jams. */
static void jam_field(void)
{
    enum { COLUMNS = 9, ROWS = 6 };
    const double pitch = 2.2;
    lab l;
    double loose = 0.0, jammed = 0.0, deepest = 0.0, residual = 0.0;
    lab_start(&l);
    lab_set(&l, "contact.friction=0.3");
    lab_set(&l, "contact.restitution=0.3");
    lab_set(&l, "contact.stiffness_factor=0.1");
    lab_set(&l, "boundary.type=rigid");
    lab_setf(&l, "boundary.min=none %.17g none", -0.5 * ROWS * pitch);
    lab_setf(&l, "boundary.max=%.17g %.17g none", (COLUMNS - 0.5) * pitch, 0.5 * ROWS * pitch);
    lab_set(&l, "boundary.drive=0.5");
    lab_set(&l, "boundary.drive_width=1.5");
    for (int k = 0; k < COLUMNS * ROWS; k++) {
        fl_rng g = fl_rng_of(3, k, FL_RNG_TEST);
        const int row = k / COLUMNS, column = k % COLUMNS;
        const double a = column ? fl_rng_in(&g, 0.75, 0.9) : 1.0;
        const fl_vec3 at = v3(pitch * column, pitch * (row - 0.5 * (ROWS - 1)), 0);
        lab_box(&l, at, v3(a, a, 0.25), 0.05, q_about_axis(2, column ? fl_rng_in(&g, -0.3, 0.3) : 0.0), ZERO,
                ZERO);
    }
    lab_make(&l, 0.0);
    while (fl_world_time(&l.w) < 30.0 && jammed < 5e5) {
        if (lab_run(&l, 10)) return;
        double push = 0.0;
        for (int32_t k = l.w.n; k < l.w.b.total; k++) push = fmax(push, fabs(l.w.b.f[k].x));
        if (fl_world_time(&l.w) < 2.0) loose = fmax(loose, push);
        jammed = push;
        for (int32_t c = 0; c < l.w.n_pair; c++)
            if (l.w.pair[c].touching)
                deepest = fmax(deepest, l.w.pair[c].contact->overlap /
                                            (l.w.b.radius[l.w.pair[c].i] + l.w.b.radius[l.w.pair[c].j]));
    }
    fl_energy_update(&l.w);
    residual = fabs(l.w.ledger.residual) / l.w.ledger.throughput;
    double covered = 0.0, length = (COLUMNS - 0.5) * pitch - l.w.b.x[0].x - 1.0;
    for (int32_t i = 0; i < l.w.n; i++)
        if (i % COLUMNS) covered += l.w.b.m[i] / (900.0 * 0.5);
    verify_note("jammed at %.3g s, %.3g of the water covered; %.3g kN on the end wall, %.3g kN while loose",
                fl_world_time(&l.w), covered / (length * ROWS * pitch), jammed / 1e3, loose / 1e3);
    verify_true("H27", "the field jams: the force on the far wall rises to 0.5 MN",
                jammed >= 5e5 && loose < 1e5);
    verify_below("H27", "ice over water at the jam", covered / (length * ROWS * pitch), 1.0);
    verify_below("H27", "0.65 over it: compacted before it carries load",
                 0.65 / (covered / (length * ROWS * pitch)), 1.0);
    verify_below("H27", "overlap over the radii", deepest, 0.3);
    verify_below("H27", "residual over the throughput", residual, 1e-3);
    lab_free(&l);
}

/* An impulse runs through a row of touching floes.  Masses m on springs k carry no wave faster than
 * sqrt(k/m) floes per second, and its front comes near to that.  The speed is measured between the middle
 * and the end of the row, at half of the largest speed of a floe. */
static void wave_through_row(void)
{
    enum { N = 40 };
    lab l;
    double arrived[N] = {0}, most[N] = {0};
    const double k_face = 1e8, a = 1.0;
    for (int pass = 0; pass < 2; pass++) {
        lab_start(&l);
        lab_setf(&l, "contact.stiffness=%.17g", k_face);
        for (int i = 0; i < N; i++)
            lab_box(&l, v3(2.0 * a * i, 0, 0), v3(a, a, 0.5 * 1.9), 0.05, q_one(), v3(i ? 0.0 : 1.0, 0, 0),
                    ZERO);
        lab_make(&l, 1e-4);
        while (fl_world_time(&l.w) < 0.4) {
            if (lab_run(&l, 1)) return;
            for (int i = 0; i < N; i++) {
                if (pass == 0) most[i] = fmax(most[i], l.w.b.v[i].x);
                else if (arrived[i] == 0.0 && l.w.b.v[i].x > 0.5 * most[i]) arrived[i] = fl_world_time(&l.w);
            }
        }
        if (pass == 0) lab_free(&l);
    }
    /* faces in contact: 1.9 x 1.8 m of the core; patch has k sqrt(a/A) between faces a of A */
    const double k = k_face * sqrt(1.9 * 1.8 / (1.9 * 1.9)), fastest = sqrt(k / l.w.b.m[0]);
    const double speed = (N - 2 - N / 2) / (arrived[N - 2] - arrived[N / 2]);
    verify_row("H27", "stress wave through a row: floes per second", speed, fastest, 0.05, VERIFY_REL);
    lab_free(&l);
}

/* --- H28 ---------------------------------------------------------------------------------------------- */

/* A floe is pressed between two cylinders, by its weight along x or by a current; the mirrored scene moves
 * alike.  In water it rolls when it hits, and friction keeps the rounding of that: up to 1e-7 m, which is
 * printed. */
static void press_between_cylinders(double off, int wet)
{
    lab l;
    double lean = 0.0, turned = 0.0, speed = 0.0;
    int rc = 0;
    char what[120];
    lab_start(&l);
    lab_set(&l, wet ? "run.gravity=9.81" : "run.gravity=2 0 0");
    if (wet) lab_set(&l, "water.current=1 0 0");
    if (wet) lab_set(&l, "water.drag_force_coef=0.5");
    lab_set(&l, "contact.friction=0.3");
    lab_set(&l, "contact.restitution=0.3");
    lab_set(&l, "contact.stiffness_factor=0.01");
    lab_cone(&l, (fl_cone){v3(2, 1.7, -2), v3(2, 1.7, 2), 0.8, 0.8});
    lab_cone(&l, (fl_cone){v3(2, -1.7, -2), v3(2, -1.7, 2), 0.8, 0.8});
    lab_box(&l, v3(-0.3, off, wet ? -0.0305 : 0.0), v3(1.5, 1.5, 0.25), 0.05, q_one(), v3(1, 0, 0), ZERO);
    lab_make(&l, 0.0);
    for (int64_t n = 0; n < 10000 && rc == 0; n++) {
        rc = lab_run(&l, 1);
        lean = fmax(lean, fabs(l.w.b.x[0].y - off));
        turned = fmax(turned, fabs(l.w.b.q[0].z));
        speed = v3_norm(l.w.b.v[0]);
    }
    verify_note("off the middle by %g m: after %.3g s at x = %.4g m, y = %.3g m, turned by %.3g, %.3g m/s",
                off, fl_world_time(&l.w), l.w.b.x[0].x, l.w.b.x[0].y, 2.0 * l.w.b.q[0].z, speed);
    snprintf(what, sizeof what, "floe pressed between two cylinders%s, off by %g: held, all finite",
             wet ? " by a current" : "", off);
    verify_true("H28", what, rc == 0 && isfinite(l.w.b.x[0].x) && l.w.b.x[0].x < 1.2 && speed < 0.2);
    if (off == 0.0 && !wet) {
        verify_below("H28", "symmetric: sideways displacement in 1e4 steps [m]", lean, 1e-9);
        verify_below("H28", "symmetric: rotation in 1e4 steps [rad]", 2.0 * turned, 1e-9);
    }
    lab_free(&l);
}

/* --- H31 ---------------------------------------------------------------------------------------------- */

/* Laws with extreme parameters: energy never grows. */
static void extreme_laws(void)
{
    static const char *const KEY[] = {"contact.friction=0",    "contact.friction=1e6",
                                      "contact.restitution=0", "contact.restitution=1",
                                      "contact.damping=4",     "contact.damping=40"};
    for (int k = 0; k < 6; k++) {
        lab l;
        double most = 0.0;
        int rc = 0;
        char what[100];
        lab_start(&l);
        lab_set(&l, "contact.friction=0.3");
        lab_set(&l, "contact.restitution=0.3");
        lab_set(&l, KEY[k]);
        lab_set(&l, "run.safety=0.05");
        lab_set(&l, "contact.stiffness_factor=0.02");
        lab_box(&l, ZERO, v3(1, 0.8, 0.4), 0.05, q_of_vector(v3(0.1, 0.2, 0.3)), v3(1, 0.5, 0.2),
                v3(0.5, 1, 2));
        lab_box(&l, v3(2.3, 0.3, 0.1), v3(0.9, 1, 0.5), 0.05, q_of_vector(v3(0.3, 0.1, 0.2)), v3(-1, 0, 0),
                v3(0, 1, 0));
        lab_sphere(&l, v3(1.2, 2.1, 0.3), 0.6, v3(0, -1, 0), v3(3, 0, 1));
        lab_make(&l, 0.0);
        const double start = lab_energy(&l);
        while (fl_world_time(&l.w) < 2.0 && rc == 0) {
            rc = lab_run(&l, 1);
            most = fmax(most, lab_energy(&l) / start - 1.0);
        }
        snprintf(what, sizeof what, "%s: largest gain of energy over the energy", KEY[k]);
        verify_below("H31", what, rc ? INFINITY : most, 1e-4);
        lab_free(&l);
    }
}

int main(void)
{
    verify_begin("ice that is pushed");
    heave_of_driven_floe();
    drive_chain();
    push_free_floes();
    push_held_floe();
    push_by_wall(0);
    push_by_wall(1);
    iso_line_load();
    raft_over_floe(0.08);
    jam_field();
    wave_through_row();
    press_between_cylinders(0.0, 0);
    press_between_cylinders(0.0, 1);
    press_between_cylinders(0.03, 1);
    extreme_laws();
    return verify_end();
}
