/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ledger of a field of 200 floes that drift against a cylinder: what it does not close by. */
#include <math.h>
#include "base/rng.h"
#include "support/lab.h"
#include "support/verify.h"

enum { ROWS = 15, FLOES = 200 };

/* 200 floes of 2.4 m in water, with speeds of their own, about a cylinder. */
static void field(lab *l, double safety, int elastic)
{
    const double pitch = 2.8;
    int32_t n = 0;
    lab_start(l);
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "water.current=0.5 0 0");
    lab_setf(l, "contact.friction=%g", elastic ? 0.0 : 0.3);
    lab_setf(l, "contact.restitution=%g", elastic ? 1.0 : 0.3);
    lab_set(l, "contact.softening=0.02");
    lab_setf(l, "run.safety=%.17g", safety);
    lab_cone(l, (fl_cone){v3(0, 0, -3), v3(0, 0, 3), 1.3, 1.3});
    for (int32_t k = 0; n < FLOES; k++) {
        fl_rng g = fl_rng_of(11, k, FL_RNG_TEST);
        const fl_vec3 x = v3(pitch * (k % ROWS - 7), pitch * (k / ROWS - 6), -0.0305);
        const fl_vec3 v = v3(0.5 + 0.5 * fl_rng_normal(&g), 0.5 * fl_rng_normal(&g), 0);
        if (hypot(x.x, x.y) < 2.7) continue;
        lab_box(l, x, v3(1.2, 1.2, 0.25), 0.05, q_of_vector(v3(0, 0, 0.1 * fl_rng_normal(&g))), v,
                v3(0, 0, 0));
        n++;
    }
    lab_make(l, 0);
}

/* Largest residual over the throughput, and what was turned over in contacts. */
static double residual(double safety, int elastic, double seconds, double *h, double *lost)
{
    lab l;
    double most = 0.0;
    field(&l, safety, elastic);
    const int64_t steps = (int64_t)ceil(seconds / l.w.dt);
    *h = l.w.dt;
    for (int64_t k = 0; k < steps; k += 50) {
        if (lab_run(&l, steps - k < 50 ? steps - k : 50)) return NAN;
        fl_step_ledger(&l.w);
        most = fmax(most, fabs(l.w.ledger.residual));
    }
    *lost = (l.w.ledger.friction_now + l.w.ledger.damping_now) / l.w.ledger.throughput;
    most /= l.w.ledger.throughput;
    lab_free(&l);
    return most;
}

int main(void)
{
    const double safety[] = {0.2, 0.1, 0.05};
    double h[3], r[3], lost = 0.0;
    const double seconds = verify_quick() ? 0.4 : 1.5;
    verify_begin("the ledger of 200 floes");
    for (int k = 0; k < 3; k++) {
        r[k] = residual(safety[k], 0, seconds, &h[k], &lost);
        verify_note("run.safety %g: residual %.3g of the throughput, %.3g of it lost in contacts", safety[k],
                    r[k], lost);
    }
    verify_order("L01", "largest residual over the throughput against the step [s]", h, r, 3, 2.0, 0.5);
    /* The works of the kicks are the trapezoidal rule for those of the potentials: what is left over comes
     * from the bend of the force where a contact begins and ends, (omega dt)^2 / 6 of what is lost in it at
     * the most, where omega dt is 2 safety; most contacts are far from the stiffest. */
    verify_below("L01", "at the default step, over its bound", r[1] / (0.2 * 0.2 / 6.0 * lost), 1.0);
    verify_below("L01", "at the default step, over what is lost in contacts", r[1] / lost, 1e-4);
    /* And so it is less where nothing is lost: what the end of a contact gives back is what its begin took.
     */
    double step, none;
    verify_below("L02", "the same without friction and damping, at the default step",
                 residual(0.1, 1, seconds, &step, &none), 0.6 * r[1]);
    return verify_end();
}
