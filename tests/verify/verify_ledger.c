/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy ledger of a field of 200 floes that drift against a cylinder: its residual. */
#include <math.h>
#include "base/rng.h"
#include "sim/energy_balance.h"
#include "support/small_world.h"
#include "support/verify.h"
#include "sim/sleep.h"

enum { ROWS = 15, FLOES = 200 };

/* 200 floes of 2.4 m in water, with random velocities, about a cylinder.  With a pitch of 3 m nothing
 * touches at first; at 2.8 m some floes overlap at the start. */
static void make_field(lab *l, double safety, int elastic, double pitch, double sleep)
{
    int32_t n = 0;
    lab_start(l);
    if (sleep > 0.0) lab_setf(l, "run.sleep=%g", sleep);
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "water.current=0.5 0 0");
    lab_setf(l, "contact.friction=%g", elastic ? 0.0 : 0.3);
    lab_setf(l, "contact.restitution=%g", elastic ? 1.0 : 0.3);
    lab_set(l, "contact.stiffness_factor=0.02");
    lab_setf(l, "run.safety=%.17g", safety);
    lab_cone(l, (fl_cone){v3(0, 0, -3), v3(0, 0, 3), 1.3, 1.3});
    for (int32_t k = 0; n < FLOES; k++) {
        fl_rng g = fl_rng_of(11, k, FL_RNG_TEST);
        const fl_vec3 x = v3(pitch * (k % ROWS - 7), pitch * (k / ROWS - 6), -0.0305);
        const fl_vec3 v = v3(0.5 + 0.5 * fl_rng_normal(&g), 0.5 * fl_rng_normal(&g), 0);
        if (hypot(x.x, x.y) < 3.1) continue;
        lab_box(l, x, v3(1.2, 1.2, 0.25), 0.05, q_of_vector(v3(0, 0, 0.1 * fl_rng_normal(&g))), v,
                v3(0, 0, 0));
        n++;
    }
    lab_make(l, 0);
}

/* dt^2 sum (m a^2 + e.I e)/12 now [J].  A step (kick, drift, kick) that begins inside a contact starts with
 * a velocity error of dt^2 x'''/6.  Its energy error is dt^2 (m a^2/24 + m v.x'''/12), the second term at
 * most as large as the first. */
static double start_error(const fl_world *w)
{
    double sum = 0.0;
    for (int32_t i = 0; i < w->n; i++) {
        const fl_vec3 turn = m3_tmul(fl_body_axes(&w->b, i), w->b.t[i]), I = w->b.I[i];
        sum += v3_norm2(w->b.f[i]) * w->b.invm[i] + turn.x * turn.x / I.x + turn.y * turn.y / I.y +
               turn.z * turn.z / I.z;
    }
    return w->dt * w->dt * sum / 12.0;
}

typedef struct {
    double step, residual, lost, off; /* [s]; the others over the throughput */
    double asleep;                    /* share of all floe-steps */
} result;

/* Largest residual of a run, energy lost in contacts, error of the start. */
static result run_field(double safety, int elastic, double pitch, double sleep, double seconds)
{
    lab l;
    result r = {0};
    make_field(&l, safety, elastic, pitch, sleep);
    r.off = start_error(&l.w);
    const int64_t steps = (int64_t)ceil(seconds / l.w.dt);
    r.step = l.w.dt;
    for (int64_t k = 0; k < steps; k += 20) {
        if (lab_run(&l, steps - k < 20 ? steps - k : 20)) return (result){.residual = NAN};
        fl_sleep_advance_to_now(&l.w);
        fl_energy_update(&l.w);
        fl_sleep_restore(&l.w);
        r.residual = fmax(r.residual, fabs(l.w.ledger.residual));
    }
    r.asleep = (double)fl_sleep_sum_totals(&l.w).ballistic_steps / ((double)l.w.step * l.w.n);
    const double all = l.w.ledger.throughput;
    r.lost = (l.w.ledger.friction_now + l.w.ledger.damping_now) / all;
    r.residual /= all;
    r.off /= all;
    lab_free(&l);
    return r;
}

/* A sphere hits a wall obliquely, with damping and friction, and leaves: residual over the energy lost. */
static double sphere_on_wall(double dt)
{
    lab l;
    lab_start(&l);
    lab_set(&l, "contact.friction=0.3");
    lab_set(&l, "contact.restitution=0.5");
    lab_set(&l, "material.ice.young=1e7");
    lab_wall(&l, v3(-3, -3, -1), v3(3, 3, 0), 1);
    lab_sphere(&l, v3(0, 0, 0.51), 0.5, v3(0.5, 0, -1), v3(0, 1, 0));
    lab_make(&l, dt);
    if (lab_run(&l, (int64_t)(0.1 / dt))) return NAN;
    fl_energy_update(&l.w);
    const double lost = l.w.ledger.damping_now + l.w.ledger.friction_now,
                 r = l.w.ledger.elastic > 0.0 ? NAN : fabs(l.w.ledger.residual) / lost;
    lab_free(&l);
    return r;
}

int main(void)
{
    const double safety[] = {0.2, 0.1, 0.05}, apart = 3.0, pressed = 2.8;
    double h[3], r[3];
    const double seconds = verify_quick() ? 0.45 : 1.5;
    verify_begin("the ledger of 200 floes");
    for (int k = 0; k < 3; k++) {
        const result all = run_field(safety[k], 0, apart, 0.0, seconds);
        h[k] = all.step;
        r[k] = all.residual;
        verify_note("run.safety %g: residual %.3g of the throughput, %.3g of it lost in contacts", safety[k],
                    all.residual, all.lost);
    }
    verify_order("L01", "largest residual over the throughput against the step [s]", h, r, 3, 2.0, 0.5);
    /* Work is of order 4 from the begin of a contact to its end.  What remains is from contacts in
     * progress, and from the kink of the force within the step in which faces meet, of either sign. */
    verify_below("L01", "at the default step", r[1], 1e-6);
    verify_below("L02", "the same without friction and damping",
                 run_field(0.1, 1, apart, 0.0, seconds).residual, 1e-6);
    const result begun = run_field(0.1, 0, pressed, 0.0, seconds);
    verify_note("some overlap at the start: %.3g, where the error of such a start is up to %.3g",
                begun.residual, begun.off);
    verify_below("L03", "overlap at the start: residual over the error of such a start + 1e-6",
                 begun.residual / (begun.off + 1e-6), 1.0);
    const result sleepy = run_field(0.1, 0, apart, 1e-5, seconds);
    verify_note("run.sleep 1e-5: %.3g of all floe-steps are skipped", sleepy.asleep);
    /* they heave by 16 cm; the energy of a heave of omega varies by (omega s)^2/12 in steps of s */
    verify_below("L05", "the same with run.sleep = 1e-5", sleepy.residual, 1e-4);
    for (int k = 0; k < 3; k++) {
        h[k] = 4e-4 / (1 << k);
        r[k] = sphere_on_wall(h[k]);
    }
    /* its force starts as the power 3/2 of the overlap, so the sums are of order 5/2 */
    verify_order("L04", "one impact of a sphere: residual over lost energy", h, r, 3, 2.5, 0.5);
    verify_below("L04", "at the smallest", r[2], 1e-5);
    return verify_end();
}
