/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Many contacts on one body, and bodies that touch and move at the start.  The restitution of an impact
 * does not depend on the number of other contacts, and neither damping nor friction gains energy. */
#include <math.h>
#include <stdlib.h>
#include "base/rng.h"
#include "support/small_world.h"
#include "support/shapes.h"
#include "support/verify.h"

static const fl_vec3 Z = {0, 0, 0};

/* The base that many small bodies hit. */
enum base { HELD, HEAVY, MOORED, BASES };
static const char *const BASE[] = {"a held body", "a body 1e5 times as heavy", "a structure on springs"};

static void add_base(lab *l, enum base base, int balls)
{
    const fl_vec3 at = v3(0, 0, balls ? -50 : -5);
    fl_poly p;
    fl_err err = {0};
    if (base == MOORED) {
        lab_wall(l, v3(-20, -20, -10), v3(20, 20, 0), 1);
        lab_set(l, "structure.mass=1e8");
        lab_set(l, "structure.free=z");
        return;
    }
    if (balls && fl_poly_make(&p, 1, &at, 0, NULL, NULL, &err)) abort();
    if (!balls && fl_poly_box(&p, v3(19.95, 19.95, 4.95), &err)) abort();
    if (!balls) shape_move(&p, q_one(), at);
    if (fl_ice_field_add(&l->field, 1, balls ? 50 : 0.05, &p, NULL, "base", Z, Z, &err)) abort();
    if (base == HELD) lab_set(l, "group.base.fixed=x y z rx ry rz");
}

/* n x n bodies hit a base together at 1 m/s, boxes flat.  Returns the mean speed at which they leave it.
 * *made: largest rise of the stored energy above its minimum, over that of the start. */
static double rebound_from_base(int n, double e, enum base base, int balls, double *made)
{
    lab l;
    int64_t over = 0;
    lab_start(&l);
    lab_setf(&l, "contact.restitution=%g", e);
    add_base(&l, base, balls);
    for (int k = 0; k < n * n; k++) {
        const double x = 1.2 * (k % n - 0.5 * (n - 1)), y = 1.2 * (k / n - 0.5 * (n - 1));
        const fl_vec3 up = balls && base != MOORED ? v3_unit(v3(x, y, 50)) : v3(0, 0, 1);
        const fl_vec3 at = balls && base != MOORED ? v3_madd(v3(0, 0, -50), 50.507, up) : v3(x, y, 0.507);
        if (balls) lab_sphere(&l, at, 0.5, v3_neg(up), Z);
        else lab_box(&l, at, v3(0.45, 0.45, 0.5), 0.05, q_one(), v3_neg(up), Z);
    }
    lab_make(&l, 0);
    const int32_t first = l.w.n - n * n;
    const double all = lab_energy(&l);
    double low = all, sum = 0.0;
    *made = 0.0;
    for (int hit = 0; over < 200000 && !(hit && l.w.contact_steps == hit); over++) {
        hit = (int)l.w.contact_steps;
        if (lab_run(&l, 1)) return NAN;
        const double now = lab_energy(&l);
        *made = fmax(*made, (now - low) / all), low = fmin(low, now);
    }
    const fl_vec3 moves = first > 0 ? l.w.b.v[0] : l.w.b.v[l.w.n];
    for (int32_t k = first; k < l.w.n; k++) sum += v3_norm(v3_sub(l.w.b.v[k], moves));
    lab_free(&l);
    return sum / (n * n);
}

static void small_bodies_on_base(void)
{
    static const double ASKED[] = {0.01, 0.1, 0.3};
    const int n = verify_quick() ? 4 : 8;
    for (int base = 0; base < BASES; base++)
        for (int balls = 0; balls < 2; balls++) {
            double worst = 0.0, most = 0.0;
            for (size_t k = 0; k < sizeof ASKED / sizeof *ASKED; k++) {
                double made;
                worst = fmax(worst,
                             fabs(rebound_from_base(n, ASKED[k], (enum base)base, balls, &made) - ASKED[k]));
                most = fmax(most, made);
            }
            verify_note("%d %s hit %s at once, restitution 0.01 to 0.3", n * n, balls ? "balls" : "boxes",
                        BASE[base]);
            verify_below("S29", "largest error of the restitution", worst, 1e-4);
            verify_below("S29", "energy made, of all", most, 1e-6);
        }
}

/* A plate falls flat on n x n posts of the structure at 1 m/s.  Returns its speed afterwards. */
static double drop_plate_on_posts(int n, double e, double safety)
{
    lab l;
    const double half = 0.2 + 0.15 * n;
    lab_start(&l);
    lab_setf(&l, "contact.restitution=%g", e);
    lab_setf(&l, "run.safety=%g", safety);
    lab_box(&l, v3(0, 0, 0.1037), v3(half, half, 0.1), 0.02, q_one(), v3(0, 0, -1), Z);
    for (int k = 0; k < n * n; k++) {
        const fl_vec3 c = v3(0.3 * (k % n - 0.5 * (n - 1)), 0.3 * (k / n - 0.5 * (n - 1)), 0);
        lab_wall(&l, v3(c.x - 0.05, c.y - 0.05, -1), v3(c.x + 0.05, c.y + 0.05, 0), 1);
    }
    lab_make(&l, 0);
    for (int hit = 0; !(hit && l.w.b.v[0].z > 0.0 && !lab_pair(&l, 0).touching) && l.w.step < 2000000;) {
        if (lab_run(&l, 1)) return NAN;
        hit |= lab_pair(&l, 0).touching;
    }
    const double v = l.w.b.v[0].z;
    lab_free(&l);
    return v;
}

static void plate_on_posts(void)
{
    const int n = verify_quick() ? 4 : 8;
    verify_note("a plate falls flat on %d posts", n * n);
    verify_row("S30", "restitution for the key 0.3", drop_plate_on_posts(n, 0.3, 0.2), 0.3, 3e-3, VERIFY_ABS);
    verify_row("S30", "0.1", drop_plate_on_posts(n, 0.1, 0.2), 0.1, 7e-3, VERIFY_ABS);
    verify_row("S30", "0.01", drop_plate_on_posts(n, 0.01, 0.2), 0.01, 7e-3, VERIFY_ABS);
    verify_row("S30", "0.01 in a quarter of the step", drop_plate_on_posts(n, 0.01, 0.05), 0.01, 1e-3,
               VERIFY_ABS);
}

/* side^3 bodies that overlap and move in all directions at the start.  Returns the largest rise of the
 * stored energy over the kinetic energy.  *given: the largest energy that friction or damping returns, over
 * the same. */
static double gain_of_overlapping_start(int side, int boxes, double e, double mu, double *given)
{
    lab l;
    fl_rng g = fl_rng_of(7, 3, FL_RNG_TEST);
    const double pitch = boxes ? 0.999 : 0.99, speed = boxes ? 0.1 : 1.0;
    double low, rise = 0.0, took[2] = {0.0, 0.0};
    lab_start(&l);
    lab_set(&l, "material.ice.young=20 MPa");
    lab_setf(&l, "contact.restitution=%g", e);
    lab_setf(&l, "contact.friction=%g", mu);
    for (int k = 0; k < side * side * side; k++) {
        const fl_vec3 at = v3(pitch * (k % side), pitch * (k / side % side), pitch * (k / side / side));
        double r[6];
        for (int m = 0; m < 6; m++) r[m] = speed * fl_rng_in(&g, -1, 1);
        const fl_vec3 v = v3(r[0], r[1], r[2]), spin = v3(2 * r[3], 2 * r[4], 2 * r[5]);
        if (boxes) lab_box(&l, at, v3(0.5, 0.5, 0.5), 0.05, q_one(), v, spin);
        else lab_sphere(&l, at, 0.5, v, spin);
    }
    lab_make(&l, 0);
    low = lab_energy(&l);
    const double moves = l.w.ledger.kinetic;
    *given = 0.0;
    for (int k = 0; k < 200; k++) {
        if (lab_run(&l, 1)) return NAN;
        const double now = lab_energy(&l), takes[2] = {l.w.ledger.friction_now, l.w.ledger.damping_now};
        rise = fmax(rise, now - low), low = fmin(low, now);
        for (int m = 0; m < 2; m++) *given = fmax(*given, took[m] - takes[m]), took[m] = takes[m];
    }
    lab_free(&l);
    *given /= moves;
    return rise / moves;
}

static void overlapping_starts(void)
{
    static const double ROWS[][3] = {{0, 0, 2}, {0, 0.05, 1}, {1, 0, 0.4}, {1, 0.2, 2}};
    for (size_t k = 0; k < sizeof ROWS / sizeof *ROWS; k++) {
        const int boxes = ROWS[k][0] > 0.0, side = boxes ? 3 : 4;
        double given;
        const double made = gain_of_overlapping_start(side, boxes, ROWS[k][1], ROWS[k][2], &given);
        verify_note("%d %s overlap and move at the start, restitution %g, friction %g", side * side * side,
                    boxes ? "cubes" : "balls", ROWS[k][1], ROWS[k][2]);
        verify_below("S31", "energy gained over the kinetic energy", made, 1e-6);
        verify_below("S31", "energy returned by friction or damping, the same", given, 0.1);
    }
}

/* Three boxes together hit a post without mass that can only rotate. */
static void impact_on_rotating_post(void)
{
    lab l;
    lab_start(&l);
    lab_set(&l, "contact.restitution=0.3");
    lab_wall(&l, v3(-2, -2, -1), v3(2, 2, 0), 1);
    lab_set(&l, "structure.free=ry");
    lab_set(&l, "structure.inertia=0 1e7 0");
    for (int k = 0; k < 3; k++)
        lab_box(&l, v3(1.5, 1.2 * (k - 1), 0.507), v3(0.45, 0.45, 0.5), 0.05, q_one(), v3(0, 0, -1), Z);
    lab_make(&l, 0);
    const int rc = lab_run(&l, (int64_t)(0.1 / l.w.dt));
    verify_note("3 boxes hit a structure that can only rotate");
    verify_true("S29", "it runs to its end", rc == 0);
    for (int k = 0; k < 3; k++)
        verify_row("S29", "speed of one box afterwards [m/s]", l.w.b.v[k].z, 0.3, 2e-3, VERIFY_ABS);
    lab_free(&l);
}

int main(void)
{
    verify_begin("many contacts on one body, and overlap at the start");
    small_bodies_on_base();
    impact_on_rotating_post();
    plate_on_posts();
    overlapping_starts();
    return verify_end();
}
