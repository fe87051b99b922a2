/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rolling resistance of a sphere, law/rolling.h, against closed forms of rigid rolling: on a wall of the
 * boundary, which has a contact list of its own (wall_contact.h), on a plate of the structure and on
 * another sphere. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "law/material.h"
#include "sim/energy_balance.h"
#include "support/small_world.h"
#include "support/verify.h"
#include "world/access.h"

#define G 9.81

enum ground { WALL, PLATE, SPHERE, ELASTIC_WALL, GROUNDS };
static const char *const ON[GROUNDS] = {"on a wall", "on a plate", "on a sphere", "on an elastic wall"};
static const double R = 0.5;
#define FOUNDATION 1e6

/* R* and kappa of ice of 100 MPa on this ground; the structure has its default, steel. */
static double effective_radius(enum ground on) { return on == SPHERE ? 0.5 * R : R; }
static double kappa(enum ground on)
{
    const fl_elastic_constants ice = {1e8, 0.3},
                               under[SPHERE + 1] = {{INFINITY, 0.0}, {210e9, 0.3}, {1e8, 0.3}};
    return fl_material_hertz(fl_material_modulus(ice, under[on]), effective_radius(on));
}

static double mass(void) { return 900.0 * 4.0 / 3.0 * PI * R * R * R; }

/* Overlap at rest, and lever arm of rolling: the middle of the overlap touches the ground. */
static double depth_of(enum ground on, double slope)
{
    if (on == ELASTIC_WALL) { /* pi d^2 (R - d/3) of its volume is behind the wall */
        double d = 0.1 * R;
        for (int k = 0; k < 50; k++) d = sqrt(mass() * G / (FOUNDATION * PI * (R - d / 3.0)));
        return d;
    }
    return pow(mass() * G * cos(slope) / kappa(on), 2.0 / 3.0);
}

static double arm_of(enum ground on) { return R - 0.5 * depth_of(on, 0.0); }

/* A sphere at rest on the ground, which is level, or gravity is inclined by `slope`. */
static void rest_on(lab *l, enum ground on, double rolling, double slope, fl_vec3 v, fl_vec3 spin)
{
    lab_start(l);
    lab_set(l, "material.ice.young=100 MPa"), lab_set(l, "material.ice.poisson=0.3");
    lab_set(l, "material.ice.density=900");
    lab_setf(l, "run.gravity=%.17g 0 %.17g", G * sin(slope), -G * cos(slope));
    lab_set(l, "contact.friction=2"), lab_set(l, "contact.restitution=0.3");
    lab_setf(l, "contact.rolling=%.17g", rolling);
    if (on == WALL || on == ELASTIC_WALL) lab_set(l, "boundary.min=none none 0");
    if (on == ELASTIC_WALL)
        lab_set(l, "boundary.type=free free elastic"), lab_set(l, "boundary.foundation=1e6");
    if (on == PLATE) lab_wall(l, v3(-20, -9, -1), v3(20, 9, 0), 1);
    if (on == SPHERE) lab_sphere(l, v3(0, 0, -R), R, v3(0, 0, 0), v3(0, 0, 0));
    lab_sphere(l, v3(0, 0, R - depth_of(on, slope)), R, v, spin);
}

/* Makes the world.  Returns the sphere that moves; the other one is held. */
static int32_t make_world(lab *l, double dt)
{
    lab_make(l, dt);
    const int32_t k = l->w.n == 2 && l->w.b.x[0].z < l->w.b.x[1].z ? 1 : 0;
    if (l->w.n == 2) l->w.b.fixed_dof[1 - k] = 63;
    return k;
}

/* Rolling on the level: deceleration mu_r m g R a/(I + m a^2), 5/7 mu_r g for a = R. */
static void roll_to_rest(enum ground on)
{
    const double mu = 0.05, v = 1.0, seconds = 2.0, arm = arm_of(on);
    lab l;
    rest_on(&l, on, mu, 0.0, v3(v, 0, 0), v3(0, v / R, 0));
    const int32_t k = make_world(&l, 2e-4);
    lab_run(&l, lround(1.0 / l.w.dt));
    const double was = l.w.b.v[k].x;
    lab_run(&l, lround((seconds - 1.0) / l.w.dt));
    char what[80];
    snprintf(what, sizeof what, "%s: deceleration [m/s2]", ON[on]);
    verify_row("RR1", what, (was - l.w.b.v[k].x) / (seconds - 1.0),
               mu * mass() * G * R * arm / (l.w.b.I[k].z + mass() * arm * arm), 2e-5, VERIFY_REL);
    lab_run(&l, lround(6.0 / l.w.dt));
    snprintf(what, sizeof what, "%s: speed at rest [m/s]", ON[on]);
    verify_row("RR1", what, l.w.b.v[k].x, 0.0, 5e-3, VERIFY_ABS);
    lab_free(&l);
}

/* The sphere stays on a slope of less than mu_r and rolls down a steeper one with 5/7 (g_x - mu_r g_z), for
 * a = R. */
static void roll_on_slope(enum ground on)
{
    const double mu = 0.1, seconds = 3.0, arm = arm_of(on);
    char what[80];
    for (int steep = 0; steep < 2; steep++) {
        const double a = atan(steep ? 1.2 * mu : 0.9 * mu);
        double way[2] = {0.0, 0.0};
        lab l;
        rest_on(&l, on, mu, a, v3(0, 0, 0), v3(0, 0, 0));
        const int32_t k = make_world(&l, 2e-4);
        for (int t = 0; t < 2; t++) {
            lab_run(&l, lround(seconds / l.w.dt));
            way[t] = steep ? l.w.b.v[k].x : l.w.b.x[k].x;
        }
        if (steep) {
            snprintf(what, sizeof what, "%s: acceleration down 1.2 mu_r [m/s2]", ON[on]);
            verify_row("RR2", what, (way[1] - way[0]) / seconds,
                       G * (sin(a) - mu * R / arm * cos(a)) / (1.0 + l.w.b.I[k].z / (mass() * arm * arm)),
                       1e-4, VERIFY_REL);
        } else {
            snprintf(what, sizeof what, "%s: creep on 0.9 mu_r [m]", ON[on]);
            verify_row("RR2", what, way[1] - way[0], 0.0, 1e-5, VERIFY_ABS);
        }
        lab_free(&l);
    }
}

/* Spin about the normal: deceleration mu_r R* m g/I. */
static void spin_to_rest(enum ground on)
{
    const double mu = 0.05, spin = 3.0, round = effective_radius(on);
    lab l;
    rest_on(&l, on, mu, 0.0, v3(0, 0, 0), v3(0, 0, spin));
    const int32_t k = make_world(&l, 2e-4);
    lab_run(&l, lround(0.5 / l.w.dt));
    const double was = l.w.b.w[k].z;
    lab_run(&l, lround(0.5 / l.w.dt));
    char what[80];
    snprintf(what, sizeof what, "%s: angular deceleration of spin [rad/s2]", ON[on]);
    verify_row("RR3", what, (was - l.w.b.w[k].z) / 0.5, mu * round * mass() * G / l.w.b.I[k].z, 2e-4,
               VERIFY_REL);
    lab_free(&l);
}

/* Below the limit it oscillates: about the point on which it rolls, whose friction spring yields as well;
 * when spinning, about its own axis. */
static void oscillation_period(enum ground on, int spins)
{
    const double mu = 0.02, round = effective_radius(on), slight = 1e-6;
    lab l;
    rest_on(&l, on, mu, 0.0, v3(0, 0, 0), spins ? v3(0, 0, slight) : v3(0, slight, 0));
    lab_set(&l, "contact.restitution=1");
    lab_set(&l, "contact.tangential_ratio=2");
    const int32_t k = make_world(&l, 1e-5);
    if (!spins) l.w.b.v[k].x = R * slight;
    const double slope = 1.5 * pow(kappa(on), 2.0 / 3.0) * cbrt(mass() * G),
                 turning = 2.25 * mu * mu * round * round * slope, inertia = l.w.b.I[k].z,
                 about = spins ? inertia : inertia + mass() * R * R;
    int crossed = 0;
    double first = 0.0, last = 0.0;
    while (crossed < 9) {
        const double w = spins ? l.w.b.w[k].z : l.w.b.w[k].y, t = fl_world_time(&l.w);
        if (lab_run(&l, 1)) break;
        const double now = spins ? l.w.b.w[k].z : l.w.b.w[k].y;
        if ((w > 0.0) == (now > 0.0)) continue;
        last = t + l.w.dt * w / (w - now);
        if (!crossed++) first = last;
    }
    char what[80];
    snprintf(what, sizeof what, "%s: period of %s [s]", ON[on], spins ? "spinning to and fro" : "rocking");
    verify_row("RR4", what, (last - first) / 4.0, 2.0 * PI * sqrt(about / turning), spins ? 1e-4 : 2e-3,
               VERIFY_REL);
    lab_free(&l);
}

/* Two bonded spheres roll to rest side by side like one; so do two whose bond has broken. */
static void bonded_pair_rolls(enum ground on, int ended)
{
    const double mu = 0.05, v = 1.0, arm = arm_of(on);
    fl_err err = {0};
    lab l;
    rest_on(&l, on, mu, 0.0, v3(v, 0, 0), v3(0, v / R, 0));
    lab_set(&l, "bond.on=true");
    lab_sphere(&l, v3(0, 2 * R, R - depth_of(on, 0.0)), R, v3(v, 0, 0), v3(0, v / R, 0));
    if (fl_ice_field_add_bond(&l.field, 0, 1, PI * R * R, 2 * R, v3(0, R, R), &err)) exit(1);
    lab_make(&l, 2e-4);
    if (ended) l.w.discs.has_ended[0] = FL_DISC_JUST_ENDED, l.w.discs.ended++;
    lab_run(&l, lround(0.5 / l.w.dt));
    const double was = l.w.b.v[0].x;
    lab_run(&l, lround(0.5 / l.w.dt));
    char what[80];
    snprintf(what, sizeof what, "%s: two %s frozen together: deceleration", ON[on], ended ? "once" : "now");
    verify_row("RR6", what, (was - l.w.b.v[0].x) / 0.5,
               mu * mass() * G * R * arm / (l.w.b.I[0].z + mass() * arm * arm), 1e-4, VERIFY_REL);
    lab_free(&l);
}

/* A plate that stands on a sphere of ten times its size is rotated by the rolling resistance of that
 * sphere: the automatic step is stable, and energy balances. */
static void plate_on_a_sphere(const char *law)
{
    char what[80];
    lab l;
    lab_start(&l);
    lab_setf(&l, "contact.law=%s", law), lab_set(&l, "run.safety=0.2"), lab_set(&l, "run.gravity=9.81");
    lab_set(&l, "material.ice.young=10 MPa"), lab_set(&l, "contact.friction=0.5");
    lab_set(&l, "contact.rolling=2"), lab_set(&l, "boundary.min=none none 0");
    lab_sphere(&l, v3(0, 0, 2), 2, v3(0, 0, 0), v3(0, 0, 0));
    lab_box(&l, v3(0, 0, 4.11), v3(0.2, 0.2, 0.05), 0.02, q_one(), v3(0.1, 0.05, 0), v3(0.5, 0, 3));
    lab_make(&l, 0.0);
    const int rc = lab_run(&l, lround(0.5 / l.w.dt));
    fl_energy_update(&l.w);
    snprintf(what, sizeof what, "%s, a plate on a sphere: step over the critical one", law);
    verify_below("RR7", what, rc ? INFINITY : l.w.dt / l.w.dt_critical, 0.2);
    snprintf(what, sizeof what, "%s: energy residual over the throughput", law);
    verify_below("RR7", what, fabs(l.w.ledger.residual) / l.w.ledger.throughput, 1e-5);
    lab_free(&l);
}

/* Twenty spheres of two sizes fall into a pit and come to rest: the residual over the energy lost. */
static double pit_residual(double dt, int *resting)
{
    lab l;
    lab_start(&l);
    lab_set(&l, "material.ice.young=10 MPa"), lab_set(&l, "run.gravity=9.81");
    lab_set(&l, "contact.friction=0.5"), lab_set(&l, "contact.restitution=0.4");
    lab_set(&l, "contact.rolling=0.2");
    lab_set(&l, "boundary.min=-1.3 -1.3 0"), lab_set(&l, "boundary.max=1.3 1.3 none");
    for (int k = 0; k < 20; k++)
        lab_sphere(&l, v3(-0.7 + 1.4 * (k % 2) + 0.02 * k, -0.7 + 1.4 * (k / 2 % 2), 0.7 + 1.15 * (k / 4)),
                   k % 3 ? 0.5 : 0.42, v3(0, 0, 0), v3(0.3 * (k % 4), 0.2, 0.1 * k));
    lab_make(&l, dt);
    lab_run(&l, lround(3.0 / dt));
    fl_energy_update(&l.w);
    const fl_ledger *g = &l.w.ledger;
    *resting = g->kinetic < 1e-2 * (g->friction_now + g->damping_now);
    const double off = fabs(g->residual) / (g->friction_now + g->damping_now);
    lab_free(&l);
    return off;
}

int main(void)
{
    verify_begin("rolling");
    for (enum ground on = WALL; on < GROUNDS; on++) {
        spin_to_rest(on);
        if (on == ELASTIC_WALL) continue;
        if (on != SPHERE) roll_to_rest(on), roll_on_slope(on), oscillation_period(on, 0);
        oscillation_period(on, 1);
    }
    for (int k = 0; k < 4; k++) bonded_pair_rolls(k / 2 ? PLATE : WALL, k % 2);
    plate_on_a_sphere("patch");
    plate_on_a_sphere("core");
    double h[3], off[3];
    int resting = 0;
    for (int k = 0; k < 3; k++) off[k] = pit_residual(h[k] = 4e-4 / (1 << k), &resting);
    verify_true("RR5", "twenty spheres in a pit come to rest", resting);
    verify_below("RR5", "energy residual over the loss, the longest step", off[0], 2e-4);
    verify_order("RR5", "that against the step", h, off, 3, 2.0, 1.0);
    return verify_end();
}
