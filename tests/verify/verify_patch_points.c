/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loading events of a pulse in closed form, and local pressure under a uniform pressure. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "stat/event.h"
#include "stat/pressure.h"
#include "support/verify.h"

enum { PULSES = 3, LEVELS = 4 };

/* Pulses A sin(w t), 0 < t < pi/w, each followed by a pause of the same length, as means over intervals of
 * h.  The rise from 0.1 to 0.9 of the peak takes (asin 0.9 - asin 0.1) / w, the time above one half is 2 pi
 * / (3 w), and the impulse is 2 A / w. */
static void loading_events(void)
{
    const double A = 5e4, w = 2.0;
    double h[LEVELS], rise[LEVELS], duration[LEVELS], impulse = 0.0;
    for (int level = 0; level < LEVELS; level++) {
        const int32_t half = 25 << level, n = 2 * half * PULSES;
        double *x = malloc((size_t)n * sizeof *x), *edge = malloc(((size_t)n + 1) * sizeof *edge);
        fl_peaks p = {0};
        fl_err err = {0};
        if (!x || !edge) abort();
        h[level] = PI / w / half;
        for (int32_t k = 0; k <= n; k++) edge[k] = h[level] * k;
        for (int32_t k = 0; k < n; k++) {
            const double a = h[level] * (k % (2 * half)), b = a + h[level];
            x[k] = k % (2 * half) < half ? A * (cos(w * a) - cos(w * b)) / (w * h[level]) : 0.0;
        }
        if (fl_peaks_rayleigh(n, x, 0.5, 0.0, &p, &err) || p.n != PULSES) abort();
        const fl_event e = fl_event_of(n, x, edge, &p, 1, 0.5);
        rise[level] = fabs(e.rise - (asin(0.9) - asin(0.1)) / w);
        duration[level] = fabs(e.duration - 2.0 * PI / (3.0 * w));
        impulse = e.impulse;
        fl_peaks_free(&p);
        free(x);
        free(edge);
    }
    verify_order("pulse", "rise of a half sine [s]", h, rise, LEVELS, 2.0, 0.4);
    verify_order("pulse", "duration above one half [s]", h, duration, LEVELS, 2.0, 0.4);
    verify_row("pulse", "impulse of one pulse [N s]", impulse, 2.0 * A / w, 1e-12, VERIFY_REL);
}

/* Contacts on a square grid of a wall, each with the force of its cell.  The pressure on every window is p,
 * up to the cells that its rim cuts.  There are some 2 pi r / a of them; the best window gains at most half
 * a cell of each. */
static void local_pressure(void)
{
    enum { SIDE = 40 };
    const double pressure = 1.5e6, a = 0.05;
    static fl_contact_event hit[SIDE * SIDE];
    fl_window_work work = {0};
    fl_err err = {0};
    for (int32_t k = 0; k < SIDE * SIDE; k++)
        hit[k] = (fl_contact_event){.part = -1,
                                    .n = {0.0, -1.0, 0.0},
                                    .p = {a * (k % SIDE), 0.0, a * (k / SIDE)},
                                    .area = a * a,
                                    .normal_force = pressure * a * a};
    for (int i = 0; i < 3; i++) {
        const double r = (double[]){0.1, 0.2, 0.4}[i], area = PI * r * r;
        char what[80];
        fl_window b;
        if (fl_largest_load_window(SIDE * SIDE, hit, -1, area, &b, &work, &err)) abort();
        snprintf(what, sizeof what, "window of %.3f m2 on p = 1.5 MPa [MPa]", area);
        verify_row("wall", what, 1e-6 * b.force / area, 1.5, 0.5 * 2.0 * a / r, VERIFY_REL);
        snprintf(what, sizeof what, "... no less than p [MPa]");
        verify_below("wall", what, -1e-6 * b.force / area, -1.5 * (1.0 - 1e-9));
    }
    /* A window smaller than a contact has its share of the force, and so the pressure of the contact. */
    fl_window b;
    if (fl_largest_load_window(1, hit, -1, 0.3 * a * a, &b, &work, &err)) abort();
    verify_row("wall", "window of 0.3 contacts [MPa]", 1e-6 * b.force / (0.3 * a * a), 1.5, 1e-14,
               VERIFY_REL);
    fl_window_work_free(&work);
}

int main(void)
{
    verify_begin("loading events and local pressure");
    loading_events();
    local_pressure();
    return verify_end();
}
