/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contacts from one potential.  An elastic gas keeps its energy, the force of a face follows its area, and
 * sliding over an edge changes the force smoothly.  The laws of the manual are listed beside it, with their
 * losses. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "law/material.h"
#include "sim/energy_balance.h"
#include "contact/pair_force.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "support/small_world.h"
#include "support/shapes.h"
#include "support/sweeps.h"
#include "support/verify.h"

static const fl_vec3 ZERO = {0, 0, 0};

/* Largest |E/E(0) - 1| of the gas over the run, sampled every half second; surrogate 0: every contact is
 * evaluated in every step.  *surrogate_share: fraction of the contact-steps that the surrogate supplied, or
 * NULL. */
static double energy_error_of_gas(const char *law, double safety, double time, double surrogate,
                                  double *surrogate_share)
{
    lab l;
    if (surrogate > 0.0) lab_gas_surrogate(&l, safety, surrogate);
    else lab_gas(&l, law, safety);
    const double start = lab_energy(&l);
    const int64_t some = (int64_t)(0.5 / l.w.dt);
    double worst = 0.0;
    while ((double)l.w.step * l.w.dt < time) {
        if (lab_run(&l, some)) {
            worst = NAN;
            break;
        }
        worst = fmax(worst, fabs(lab_energy(&l) / start - 1.0));
    }
    if (surrogate_share)
        *surrogate_share =
            (double)fl_surrogate_count_sum(l.w.surrogate_counts, 1).hits / (double)l.w.contact_steps;
    lab_free(&l);
    return worst;
}

static void elastic_gas(void)
{
    enum { LEVELS = 3 };
    const double time = verify_quick() ? 4.0 : 150.0;
    const int levels = verify_quick() ? 2 : LEVELS;
    double h[LEVELS], e[LEVELS];
    verify_note("196 floes between four walls, no friction, no damping, %g s; largest |E/E(0) - 1|", time);
    for (int k = 0; k < levels; k++) {
        char what[64];
        h[k] = 0.4 / (1 << k);
        e[k] = energy_error_of_gas("patch", h[k], time, 0.0, NULL);
        snprintf(what, sizeof what, "patch at %g of the critical step", h[k]);
        verify_below("gas", what, e[k], 1e-3);
    }
    if (!verify_quick()) verify_order("gas", "largest |E/E(0) - 1| of patch", h, e, levels, 2.0, 0.6);
    for (int k = 0; k < levels; k++) {
        char what[64];
        e[k] = energy_error_of_gas("quick", h[k], time, 0.0, NULL);
        snprintf(what, sizeof what, "quick at %g of the critical step", h[k]);
        verify_below("gas", what, e[k], 1e-3);
    }
    for (int k = 3; k <= 4 && lab_has_surrogates(); k++) {
        char what[120];
        double surrogate_share;
        const double tolerance = pow(10.0, -k),
                     off = energy_error_of_gas("patch", 0.1, time, tolerance, &surrogate_share);
        snprintf(what, sizeof what,
                 "patch at 0.1 of it, surrogate %g, %.2f of the contact-steps by surrogate", tolerance,
                 surrogate_share);
        verify_below("gas", what, off, 0.2 * tolerance);
    }
    static const char *const LAW[] = {"core", "manual-si", "manual"};
    for (int k = 0; k < 3; k++)
        verify_note("%s at 0.1 of it, 4 s: %.2g", LAW[k], energy_error_of_gas(LAW[k], 0.1, 4.0, 0.0, NULL));
}

/* Two cubes, one on the other, aligned, with a face of a given area: force for an overlap. */
static double force_of_face(double area, double radius, double overlap)
{
    lab l;
    const double h = 0.5 * sqrt(area) + radius;
    lab_start(&l);
    lab_box(&l, v3(0, 0, h), v3(h, h, h), radius, q_one(), ZERO, ZERO);
    lab_box(&l, v3(0, 0, 3.0 * h), v3(h, h, h), radius, q_one(), ZERO, ZERO);
    lab_make(&l, 1e-9);
    l.w.b.x[1].z -= overlap;
    const double f = v3_norm(lab_evaluate_pair(&l.w, 0, 1).force);
    lab_free(&l);
    return f;
}

/* Equation (25) of the manual, with beta of a square. */
static void stiffness_by_area(void)
{
    const fl_elastic_constants ice = {1e9, 0.3};
    const double E = fl_material_modulus(ice, ice);
    verify_note("a cube on a cube, radius a hundredth of the side, overlap a tenth of the radius");
    for (int k = -2; k <= 2; k++) {
        char what[64];
        const double area = pow(10.0, k), radius = 0.01 * sqrt(area), s = 0.1 * radius;
        snprintf(what, sizeof what, "stiffness of a face of %g m2 over (25)", area);
        verify_row("(25)", what, force_of_face(area, radius, s) / s / fl_material_punch(E, area), 1.0, 0.2,
                   VERIFY_ABS);
    }
}

/* The upper of two boxes slides off the lower one, at a fixed height. */
static double slide_force(void *what, double s, double t)
{
    lab *l = what;
    fl_vec3 f[2];
    for (int k = 0; k < 2; k++) {
        l->w.b.x[1].x = k ? t : s;
        f[k] = lab_evaluate_pair(&l->w, 0, 1).force;
    }
    return v3_norm(v3_sub(f[1], f[0]));
}

static void slide_off_face(void)
{
    lab l;
    const double radius = 0.05, s = 0.01;
    lab_start(&l);
    lab_box(&l, v3(0, 0, 0), v3(0.5, 0.4, 0.3), radius, q_one(), ZERO, ZERO);
    lab_box(&l, v3(0, 0.1, 0.6 - s), v3(0.5, 0.4, 0.3), radius, q_one(), ZERO, ZERO);
    lab_make(&l, 1e-9);
    const double whole = v3_norm(lab_evaluate_pair(&l.w, 0, 1).force);
    double most = 0.0, before = INFINITY;
    for (int k = 0; k <= 1000; k++) {
        l.w.b.x[1].x = 1e-3 * k;
        const double f = fabs(lab_evaluate_pair(&l.w, 0, 1).force.z) / whole;
        if (k > 0) most = fmax(most, f - before);
        before = f;
    }
    verify_below("(25)", "sliding off: largest relative rise of the lateral force", most, 1e-9);
    verify_below("(25)", "  force where the boxes are apart", before, 0.0);
    /* over 1e-9 m a face loses 1e-9 of its length, its rim 1e-9 of its fade of 10 mm */
    verify_below("(25)", "  largest relative change of the force over 1e-9 m",
                 sweep_largest(slide_force, &l, 0.0, 1.0, 1e-9) / whole, 1e-6);
    lab_free(&l);
}

/* A box bounces elastically on a plane: energy gained or lost over the total, after 50 bounces or more.  A
 * surrogate must not gain energy at each of them. */
static double gain_of_bounces(double surrogate)
{
    lab l;
    lab_start(&l);
    lab_setf(&l, "contact.surrogate=%g", surrogate);
    lab_set(&l, "material.ice.young=10 MPa");
    lab_set(&l, "run.gravity=9.81");
    lab_set(&l, "boundary.type=free free rigid");
    lab_set(&l, "boundary.min=none none 0");
    lab_box(&l, v3(0, 0, 0.5005), v3(0.5, 0.4, 0.5), 0.05, q_one(), ZERO, ZERO);
    lab_make(&l, 0.0);
    const double start = lab_energy(&l), height = l.w.b.m[0] * 9.81 * 5e-4;
    const int bad = lab_run(&l, (int64_t)(2.0 / l.w.dt));
    const double end = lab_energy(&l);
    lab_free(&l);
    return bad ? NAN : fabs(end - start) / height;
}

/* A box in a slot between two walls that press it from both sides: work of friction while it falls. */
static double friction_in_slot(double surrogate)
{
    static const double half = 0.4999;
    const fl_vec3 xy[8] = {v3(-2, -2, 0),   v3(2, -2, 0),     v3(2, 1, 0),     v3(half, 1, 0),
                           v3(half, -1, 0), v3(-half, -1, 0), v3(-half, 1, 0), v3(-2, 1, 0)};
    lab l;
    lab_start(&l);
    lab_setf(&l, "contact.surrogate=%g", surrogate);
    lab_set(&l, "contact.friction=0.2");
    lab_set(&l, "contact.restitution=0.3");
    lab_set(&l, "material.ice.young=10 MPa");
    lab_set(&l, "run.safety=0.2");
    lab_prism(&l, 8, xy, -50, 5);
    lab_box(&l, v3(1e-5, 0, 0), v3(0.5, 0.4, 0.5), 0.05, q_one(), v3(0.001, 0, -1), ZERO);
    lab_make(&l, 0.0);
    const int bad = lab_run(&l, (int64_t)(0.4 / l.w.dt));
    fl_energy_update(&l.w);
    const double work = l.w.ledger.friction_now;
    lab_free(&l);
    return bad ? NAN : work;
}

/* A box on a plane with friction is sheared at one tilt and depth, sheared back at another tilt and depth,
 * and returns to the first.  Work of friction in a cycle over the largest energy of its spring. */
static double gain_of_friction_cycle(double surrogate, const double tilt[2], const double depth[2])
{
    enum { STEPS = 20000, CYCLES = 3 };
    const double dt = 1.0 / STEPS, R = 0.1, shear = 1e-5;
    double taken = 0.0, held = 0.0, first = 0.0;
    fl_vec3 was = ZERO;
    double leant = tilt[0];
    lab l;
    fl_pair p;
    lab_start(&l);
    lab_setf(&l, "contact.surrogate=%g", surrogate);
    lab_set(&l, "contact.friction=1000");
    lab_set(&l, "boundary.type=rigid");
    lab_set(&l, "boundary.min=none none 0");
    lab_box(&l, v3(0, 0, 10), v3(0.5, 0.5, 0.3), R, q_one(), ZERO, ZERO);
    lab_make(&l, 1e-5);
    fl_bodies *b = &l.w.b;
    fl_pair_init(&l.w, &p, 0, 1);
    for (int c = 0; c <= CYCLES; c++) {
        if (c == 1)
            taken = 0.0, first = p.spring_energy; /* the first cycle only brings it to its starting state */
        for (int k = 0; k < STEPS; k++) {
            const int part = 4 * k / STEPS;
            const double t = (4.0 * (k + 1)) / STEPS - part, u = t * t * (3.0 - 2.0 * t);
            const double y = shear * (part == 0 ? u : part == 1 ? 1.0 : part == 2 ? 1.0 - u : 0.0);
            const double m = part == 0 ? 0.0 : part == 1 ? u : part == 2 ? 1.0 : 1.0 - u;
            const double angle = tilt[0] + m * (tilt[1] - tilt[0]), s = depth[0] + m * (depth[1] - depth[0]);
            const fl_quat q = q_about_axis(1, angle);
            const fl_vec3 low = q_rotate(q, v3(0.4, 0, -0.2)), x = v3(-low.x, y, R - s - low.z);
            if (c == 0 && k == 0) was = x;
            const fl_vec3 v = v3_scale(1.0 / dt, v3_sub(x, was)), w = v3(0, (angle - leant) / dt, 0);
            was = x, leant = angle;
            lab_pose(&l.w, 0, x, q);
            b->v[0] = v, b->w[0] = w;
            l.w.step++;
            fl_pair_evaluate(&l.w, &p, 0, dt, 1);
            taken -= (v3_dot(p.force_friction, v) + v3_dot(p.torque_i_friction, w)) * dt;
            held = fmax(held, p.spring_energy);
        }
    }
    taken -= p.spring_energy - first;
    fl_pair_free(&p);
    lab_free(&l);
    return taken / CYCLES / held;
}

static void friction_cycles(void)
{
    const struct {
        double surrogate, tilt[2], depth[2];
    } IT[] = {{1e-3, {0.00256, 0.0016}, {0.01, 0.008}},
              {1e-2, {0.002, 0.0005}, {0.01, 0.008}},
              {1e-1, {0.00655, 0.0016}, {0.01, 0.01}}};
    double least = INFINITY, looked = INFINITY;
    for (size_t k = 0; k < sizeof IT / sizeof *IT; k++) {
        least = fmin(least, gain_of_friction_cycle(IT[k].surrogate, IT[k].tilt, IT[k].depth));
        looked = fmin(looked, gain_of_friction_cycle(0.0, IT[k].tilt, IT[k].depth));
    }
    verify_note("friction loaded at a higher stiffness than it is unloaded, and the reverse");
    verify_below("friction", "exact: energy released per cycle over that of the springs", -looked, 1e-9);
    verify_below("friction", "surrogates of 1e-3 to 0.1: the same", -least, 1e-9);
}

/* Velocities of two boxes after an oblique impact with friction; the faces are inclined by `tilt`. */
static int throw_at_box(double surrogate, double tilt, fl_vec3 v[4])
{
    lab l;
    lab_start(&l);
    lab_setf(&l, "contact.surrogate=%g", surrogate);
    lab_set(&l, "contact.friction=0.3");
    lab_set(&l, "material.ice.young=10 MPa");
    lab_set(&l, "run.safety=0.01");
    lab_box(&l, ZERO, v3(1, 0.8, 0.5), 0.05, q_one(), ZERO, ZERO);
    lab_box(&l, v3(0.3, 0.1, 1.05), v3(0.5, 0.4, 0.5), 0.05, q_of_vector(v3(tilt, -0.7 * tilt, 0.3)),
            v3(0.3, 0.1, -0.5), v3(0.1, 0.2, 0.3));
    lab_make(&l, 0.0);
    const int bad = lab_run(&l, (int64_t)(0.5 / l.w.dt));
    for (int k = 0; k < 2; k++) v[k] = l.w.b.v[k], v[2 + k] = l.w.b.w[k];
    lab_free(&l);
    return bad;
}

/* The change by surrogates falls with their tolerance.  If friction springs lost a part at every evaluation
 * it would not, for evaluations become more frequent as the tolerance falls. */
static void throws_by_tolerance(void)
{
    enum { THROWS = 8, LEVELS = 3 };
    double off[LEVELS] = {0};
    for (int k = 0; k < THROWS; k++) {
        fl_vec3 exact[4], surrogate_share[4];
        int bad = throw_at_box(0.0, 0.005 * k, exact);
        for (int t = 0; t < LEVELS; t++) {
            bad |= throw_at_box(pow(0.1, 3 + t), 0.005 * k, surrogate_share);
            for (int c = 0; c < 4; c++)
                off[t] += v3_norm2(v3_sub(surrogate_share[c], exact[c])) / (4 * THROWS);
        }
        if (bad) off[0] = NAN;
    }
    verify_note(
        "eight throws of a box at another, friction 0.3: root mean square of the change by surrogates "
        "surrogates");
    verify_note("of 1e-3, 1e-4 and 1e-5 of the velocities after it: %.2g, %.2g, %.2g m/s", sqrt(off[0]),
                sqrt(off[1]), sqrt(off[2]));
    verify_below("surrogate", "change of velocities with 1e-3 [m/s]", sqrt(off[0]), 5e-4);
    verify_below("surrogate", "  with 1e-5, over that", sqrt(off[2] / off[0]), 0.6);
}

enum flyer { CUBE, ICOSAHEDRON, CAPSULE, FLYERS };

static void add_body(lab *l, enum flyer kind, fl_vec3 at, fl_rng *g)
{
    double r[6];
    for (int c = 0; c < 6; c++) r[c] = fl_rng_in(g, -1, 1);
    const fl_vec3 v = v3(r[0], r[1], r[2]), spin = v3(r[3], r[4], r[5]);
    const fl_vec3 ends[2] = {v3_add(at, v3(0.3, 0, 0)), v3_add(at, v3(-0.3, 0, 0))};
    fl_poly p;
    fl_err err = {0};
    if (kind == CUBE) {
        lab_box(l, at, v3(0.5, 0.5, 0.5), 0.1, shape_rotation(g), v, spin);
        return;
    }
    if (kind == ICOSAHEDRON) shape_regular(&p, 20, 0.5), shape_move(&p, q_one(), at);
    else if (fl_poly_make(&p, 2, ends, 0, NULL, NULL, &err)) exit(1);
    lab_poly(l, &p, kind == CAPSULE ? 0.3 : 0.1, v, spin);
}

/* Eight elastic bodies between six walls: relative growth of their energy. */
static double energy_gain(enum flyer kind, double tolerance, double seconds, int seed)
{
    const double far = 2.6;
    lab l;
    fl_rng g = fl_rng_of(6, seed, FL_RNG_TEST);
    lab_start(&l);
    lab_setf(&l, "contact.surrogate=%g", tolerance);
    lab_set(&l, "run.safety=0.1");
    lab_set(&l, "material.ice.young=10 MPa");
    lab_setf(&l, "boundary.min=%g %g %g", -far, -far, -far);
    lab_setf(&l, "boundary.max=%g %g %g", far, far, far);
    for (int k = 0; k < 8; k++) add_body(&l, kind, v3(2 * (k & 1) - 1, (k & 2) - 1, 0.5 * (k & 4) - 1), &g);
    lab_make(&l, 0);
    const double before = lab_energy(&l);
    if (lab_run(&l, (int64_t)(seconds / l.w.dt))) return NAN;
    const double grown = lab_energy(&l) / before - 1.0;
    lab_free(&l);
    return grown;
}

/* The energy error of a bounce has no preferred sign; for capsules it has one. */
static void gain_of_free_bodies(void)
{
    static const char *const NAME[] = {"cubes", "icosahedra", "capsules"};
    static const double MOST[FLYERS][2] = {{8e-5, 2e-3}, {8e-5, 4e-4}, {1.5e-3, 1e-2}};
    const int all = !verify_quick(), n = 4;
    const double seconds = all ? 30.0 : 10.0;
    char what[80];
    for (int kind = 0; kind < (all ? FLYERS : 1); kind++)
        for (int c = 0; c < (all ? 2 : 1); c++) {
            const double tolerance = c ? 1e-2 : 1e-3;
            double mean = 0.0;
            for (int k = 0; k < n; k++) mean += energy_gain((enum flyer)kind, tolerance, seconds, k) / n;
            snprintf(what, sizeof what, "%g: eight %s between walls, relative energy gain", tolerance,
                     NAME[kind]);
            verify_row("surrogate", what, mean, 0.0, MOST[kind][c], VERIFY_ABS);
        }
}

static void energy_with_surrogates(void)
{
    verify_note("contacts by surrogate, tolerance 0.001");
    verify_below("surrogate", "a box bounces for 2 s: energy gained over that of a fall",
                 gain_of_bounces(1e-3), 0.01);
    verify_row("surrogate", "a box in a slot: work of friction [J]", friction_in_slot(1e-3),
               friction_in_slot(0.0), 1e-2, VERIFY_REL);
}

int main(void)
{
    verify_begin("contacts from one potential");
    stiffness_by_area();
    slide_off_face();
    elastic_gas();
    if (lab_has_surrogates()) {
        energy_with_surrogates();
        throws_by_tolerance();
    }
    gain_of_free_bodies();
    friction_cycles();
    return verify_end();
}
