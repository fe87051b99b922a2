/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What bounds the ice: elastic walls against the oscillator that they are. */
#include <math.h>
#include <stdio.h>
#include "support/lab.h"
#include "support/verify.h"

#define PI 3.14159265358979323846
static const fl_vec3 ZERO = {0, 0, 0};

/* A floe flat against an elastic wall is a mass on the spring k = k_A A and the dashpot c = c_A A, until the
 * force is 0: with b = c/2m, w = sqrt(k/m - b^2),
 *     t = (pi - atan2(2 b w, w^2 - b^2)) / w,    e = exp(-b t).
 * Source: Schwager & Poeschel, Granular Matter 9 (2007) 465. */
static void bounce(double ratio)
{
    enum { STEPS = 5 };
    const double side = 2.0, high = 1.5, wide = 4.0, bed = 1e6, v = 0.3;
    const double area = high * wide, mass = 900.0 * side * area, k = bed * area;
    const double omega0 = sqrt(k / mass), c = 2.0 * ratio * sqrt(k * mass), b = 0.5 * c / mass;
    const double w = sqrt(omega0 * omega0 - b * b);
    const double t = (PI - atan2(2.0 * b * w, w * w - b * b)) / w, e = exp(-b * t);
    double h[STEPS], err[STEPS], lasted = 0.0;
    char what[100];
    for (int s = 0; s < STEPS; s++) {
        lab l;
        int64_t pressed = 0;
        lab_start(&l);
        lab_set(&l, "boundary.type=elastic");
        lab_set(&l, "boundary.min=0 none none");
        lab_setf(&l, "boundary.foundation=%.17g", bed);
        lab_setf(&l, "boundary.damping=%.17g", c / area);
        h[s] = 2.0 * PI / omega0 / (100 << s);
        /* it touches in the middle of a step */
        lab_box(&l, v3(0.5 * side + 0.5 * h[s] * v, 0.2, 0.1), v3(0.5 * side, 0.5 * wide, 0.5 * high), 0.05,
                q_one(), v3(-v, 0, 0), ZERO);
        lab_make(&l, h[s]);
        while ((double)l.w.step * h[s] < 1.2 * t) {
            if (lab_run(&l, 1)) return;
            pressed += l.w.b.f[0].x > 0.0;
        }
        lasted = (double)pressed * h[s];
        err[s] = fabs(l.w.b.v[0].x / v / e - 1.0);
        lab_free(&l);
    }
    snprintf(what, sizeof what, "floe on an elastic wall, damping ratio %g: duration [s]", ratio);
    verify_row("B01", what, lasted, t, 2.0 * h[STEPS - 1], VERIFY_ABS);
    snprintf(what, sizeof what, "floe on an elastic wall, damping ratio %g: restitution, error", ratio);
    if (ratio > 0.0) verify_order("B01", what, h, err, STEPS, 1.0, 0.25);
    verify_below("B01", what, err[STEPS - 1], ratio > 0.0 ? 2e-3 : 1e-9);
}

/* Gravity presses it into an elastic floor: it swings about where the weight is borne. */
static void swing(void)
{
    lab l;
    const double a = 2.0, high = 1.0, bed = 2e5, mass = 900.0 * a * a * high, k = bed * a * a, g = 9.81;
    const double period = 2.0 * PI * sqrt(mass / k), rest = mass * g / k, out = 0.2 * rest;
    double before = 1.0, crossed[2] = {0}, start, most = 0.0;
    int n = 0;
    lab_start(&l);
    lab_setf(&l, "run.gravity=%.17g", g);
    lab_set(&l, "boundary.type=free free elastic");
    lab_set(&l, "boundary.min=none none 0");
    lab_setf(&l, "boundary.foundation=%.17g", bed);
    lab_box(&l, v3(0, 0, 0.5 * high - rest + out), v3(0.5 * a, 0.5 * a, 0.5 * high), 0.05, q_one(), ZERO,
            ZERO);
    lab_make(&l, period / 1000.0);
    start = lab_energy(&l);
    for (int64_t s = 0; s < 5000; s++) {
        if (lab_run(&l, 1)) return;
        const double z = l.w.b.x[0].z - 0.5 * high + rest;
        if (before > 0.0 && z <= 0.0) {
            const double t = ((double)l.w.step - 1.0 + before / (before - z)) * l.w.dt;
            if (n++ == 0) crossed[0] = t;
            crossed[1] = t;
        }
        most = fmax(most, fabs(lab_energy(&l) - start));
        before = z;
    }
    verify_row("B01", "swinging on an elastic floor: period [s]", (crossed[1] - crossed[0]) / (n - 1), period,
               2e-5, VERIFY_REL);
    verify_below("B01", "swinging on an elastic floor: energy error over its energy",
                 most / (0.5 * k * out * out), 1e-4);
    lab_free(&l);
}

/* Boxes, needles and balls that tumble between elastic walls keep their energy; its error is of order 2. */
static void tumble(void)
{
    enum { STEPS = 3 };
    double h[STEPS], err[STEPS];
    for (int s = 0; s < STEPS; s++) {
        lab l;
        const fl_vec3 end[2] = {{-0.5, 0, 2.0}, {0.5, 0, 2.0}};
        fl_poly p = {0};
        fl_err no = {0};
        lab_start(&l);
        lab_set(&l, "boundary.type=elastic");
        lab_set(&l, "boundary.min=-4 -4 -4");
        lab_set(&l, "boundary.max=4 4 4");
        lab_set(&l, "boundary.foundation=1 MN/m3");
        lab_box(&l, v3(-2, 0.3, 0), v3(0.9, 0.6, 0.3), 0.05, q_of_vector(v3(0.3, 0.5, 0.1)), v3(1, 2, 1.5),
                v3(1, 0.5, 2));
        lab_sphere(&l, v3(2.5, 1, -1), 0.5, v3(-1, 2, 2), ZERO);
        if (fl_poly_make(&p, 2, end, 0, NULL, NULL, &no)) return;
        lab_poly(&l, &p, 0.2, v3(2, 0.3, 1.7), v3(0, 1, 0.3));
        h[s] = 1e-3 / (1 << s);
        lab_make(&l, h[s]);
        const double start = lab_energy(&l);
        err[s] = 0.0;
        for (int64_t n = 0; (double)n * h[s] < 8.0; n++) {
            if (lab_run(&l, 1)) return;
            err[s] = fmax(err[s], fabs(lab_energy(&l) / start - 1.0));
        }
        lab_free(&l);
    }
    verify_order("B01", "energy of a box, a needle and a ball between elastic walls against the step [s]", h,
                 err, STEPS, 2.0, 0.5);
    verify_below("B01", "and its error at the smallest step", err[STEPS - 1], 3e-4);
}

int main(void)
{
    verify_begin("boundaries");
    bounce(0.0);
    bounce(0.2);
    bounce(0.6);
    swing();
    tumble();
    return verify_end();
}
