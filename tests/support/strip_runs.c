/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/strip_runs.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "world/access.h"

void strip_start(lab *l, double v, int seed, int ring)
{
    const fl_vec3 still = {0, 0, 0};
    lab_start(l);
    lab_set(l, "boundary.type=free");
    lab_set(l, "boundary.drive_width=1000");
    lab_set(l, "boundary.drive_edge=-x");
    lab_set(l, "boundary.drive_fixed=x y z rx ry rz");
    lab_setf(l, "boundary.drive=%.17g", v);
    lab_set(l, "failure.crushing=structure");
    lab_set(l, "failure.crushing_law=rate");
    lab_set(l, "failure.pressure_exponent=0");
    lab_setf(l, "failure.pressure=%.17g", STRIP_F0 / 5.0);
    lab_setf(l, "failure.seed=%d", seed);
    if (ring) {
        lab_setf(l, "failure.element_width=%.17g", 2.0 * PI * 5.0 / ring * (1.0 + 1e-9));
        lab_cone(l, (fl_cone){v3(0, 0, -2), v3(0, 0, 2), 5, 5});
        lab_box(l, v3(-40, 0, 0), v3(80, 30, 0.25), 0.05, q_one(), v3(v, 0, 0), still);
    } else {
        lab_set(l, "failure.element_width=0.5");
        lab_wall(l, v3(0, -5, -2), v3(1, 5, 2), 1);
        lab_box(l, v3(-60, 0, 0), v3(60 + STRIP_FRONT, 30, 0.25), 0.05, q_one(), v3(v, 0, 0), still);
    }
}

void strip_add_oscillator(lab *l)
{
    lab_set(l, "mode one.frequency=2");
    lab_set(l, "mode one.mass=2.533e6");
    lab_set(l, "mode one.damping_ratio=0.02");
}

void strip_record_add(strip_record *s, const fl_world *w)
{
    const double f = w->part_force[0].x / STRIP_F0, g = w->part_force[0].y / STRIP_F0;
    s->n++, s->f += f, s->ff += f * f, s->g += g, s->gg += g * g;
    if (w->moving.movers.n == 0) return;
    const double x = w->moving.movers.b.x[0].x, v = w->moving.movers.b.v[0].x;
    s->x += x, s->xx += x * x, s->v += v, s->vv += v * v;
}

double strip_deviation(double n, double sum, double square)
{
    return sqrt(fmax(0.0, square / n - (sum / n) * (sum / n)));
}

double strip_beta(const strip_record *s, double v)
{
    return sqrt(2.0) * strip_deviation(s->n, s->v, s->vv) / v;
}

void strip_run_until(lab *l, double t, double since, strip_record *s)
{
    while (fl_world_time(&l->w) < t - 0.5 * l->w.dt) {
        if (lab_run(l, 1)) exit(1);
        if (fl_world_time(&l->w) > since) strip_record_add(s, &l->w);
    }
}

void strip_values_add(strip_values *s, double x) { s->n++, s->sum += x, s->square += x * x; }

void strip_row(const char *id, const char *what, const strip_values *s, double expected, double tol,
               enum verify_kind kind)
{
    char line[160];
    if (s->n < 2.0) {
        verify_row(id, what, s->sum / s->n, expected, tol, kind);
        return;
    }
    const double own = strip_deviation(s->n, s->sum, s->square) * sqrt(s->n / (s->n - 1.0)),
                 half = gsl_cdf_tdist_Pinv(0.975, s->n - 1.0) * own / sqrt(s->n);
    snprintf(line, sizeof line, "%s, %.0f runs +-%.2g", what, s->n, half);
    verify_row(id, line, s->sum / s->n, expected, tol, kind);
}
