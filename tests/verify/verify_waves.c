/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Waves: dispersion, kinematics, spectra, and floating floes, against closed forms. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "sim/energy_balance.h"
#include "stat/power_spectrum.h"
#include "support/small_world.h"
#include "support/shapes.h"
#include "support/verify.h"

#define G 9.81
#define DRAFT (900.0 / 1025.0)
#define REST (0.5 - DRAFT)

static void dispersion(void)
{
    static const struct {
        const char *what;
        double T, d, k;
    } cases[4] = {{"k at T = 8 s, d = 20 m [1/m]", 8, 20, 0.070762},
                  {"T = 8 s, d = 10 m", 8, 10, 0.088622},
                  {"T = 5 s, d = 20 m", 5, 20, 0.161477},
                  {"T = 12 s, deep", 12, INFINITY, 0.027947}};
    double worst = 0.0;
    for (int c = 0; c < 4; c++)
        verify_row("V58", cases[c].what, fl_wave_number(2 * PI / cases[c].T, cases[c].d, G), cases[c].k, 2e-5,
                   VERIFY_REL);
    for (int c = -60; c <= 60; c++) {
        const double w = pow(10, c / 20.0), k = fl_wave_number(w, 1.0, G);
        worst = fmax(worst, fabs(G * k * tanh(k) / (w * w) - 1));
    }
    verify_below("V58", "omega^2 = g k tanh kd, omega^2 d/g of 1e-7 .. 1e5: error", worst, 1e-14);
    verify_row("V58", "length at T = 8 s, d = 20 m [m]", 2 * PI / fl_wave_number(2 * PI / 8, 20, G), 88.793,
               1e-5, VERIFY_REL);
    fl_waves w;
    fl_err err = {0};
    fl_wave_expansion near;
    double u[2], a[2];
    fl_waves_airy(&w, 1, 8, 0, 20, G, &err);
    fl_wave_expand(&w, 0, 0, 20, 0, &near);
    fl_wave_kinematics(&w, &near, 0, 0, u, a);
    verify_row("V58", "u under the crest, H = 1 m [m/s]", u[0], 0.44193, 2e-5, VERIFY_REL);
    fl_wave_kinematics(&w, &near, 0, -20, u, a);
    verify_row("V58", "at the bottom [m/s]", u[0], 0.20270, 2e-5, VERIFY_REL);
    verify_below("V58", "  and none across it [m/s]", fabs(u[1]), 1e-7);
    fl_waves_free(&w);
}

/* The power series around a body against the sum over the wave trains. */
static void power_series(void)
{
    static const double DEPTH[3] = {INFINITY, 20, 8};
    for (int c = 0; c < 3; c++) {
        fl_waves w;
        fl_err err = {0};
        double off[4] = {0};
        fl_waves_jonswap(&w, 2, 8, 3.3, 100, 7, 30, DEPTH[c], G, &err);
        for (int k = 0; k < 300; k++) {
            fl_rng g = fl_rng_of(3, k, FL_RNG_TEST);
            const double s0 = fl_rng_in(&g, -500, 500), z0 = k % 3 ? 0.0 : fl_rng_in(&g, -6, 0);
            const double t = fl_rng_in(&g, 0, 1e4), R = FL_WAVE_REACH / w.max_k;
            const double angle = fl_rng_in(&g, 0, PI), r = fl_rng_in(&g, 0, 0.95 * R);
            const double s = s0 + r * cos(angle), z = z0 - r * sin(angle);
            double P = 0, eta = 0, u[2] = {0}, a[2] = {0}, v[2], b[2];
            fl_wave_expansion near;
            if (z < -w.depth) continue;
            fl_wave_expand(&w, s0, z0, R, t, &near);
            for (int32_t j = 0; j < w.n; j++) {
                const fl_wave_train *q = &w.train[j];
                const double psi = q->k * s - q->omega * t + q->phase, kd = q->k * w.depth;
                const double C = kd < 300 ? cosh(q->k * z + kd) / cosh(kd) : exp(q->k * z),
                             S = kd < 300 ? sinh(q->k * z + kd) / cosh(kd) : exp(q->k * z);
                P += q->a * C * cos(psi);
                eta += q->a * cos(psi);
                u[0] += q->a * G * q->k / q->omega * C * cos(psi);
                u[1] += q->a * G * q->k / q->omega * S * sin(psi);
                a[0] += q->a * G * q->k * C * sin(psi);
                a[1] -= q->a * G * q->k * S * cos(psi);
            }
            fl_wave_kinematics(&w, &near, s, z, v, b);
            off[0] = fmax(off[0], fabs(fl_wave_pressure(&near, s, z) - P));
            if (z0 == 0.0) off[1] = fmax(off[1], fabs(fl_wave_elevation(&near, s, NULL) - eta));
            off[2] = fmax(off[2], hypot(v[0] - u[0], v[1] - u[1]));
            off[3] = fmax(off[3], hypot(b[0] - a[0], b[1] - a[1]));
        }
        verify_note("a sea of 100 trains, Hs 2 m, depth %g m: power series against the sum", w.depth);
        verify_below("V58", "error of the pressure head [m]", off[0], 1e-5);
        verify_below("V58", "elevation off by [m]", off[1], 1e-5);
        verify_below("V58", "velocity off by [m/s]", off[2], 2e-5);
        verify_below("V58", "error of the acceleration [m/s2]", off[3], 2e-4);
        fl_waves_free(&w);
    }
}

static void jonswap_spectrum(void)
{
    double m[3] = {0}, e = 0, m7 = 0, up = 0;
    const double df = 1e-5;
    for (double f = 0.5 * df; f < 5; f += df) {
        const double S = fl_jonswap_spectrum(f, 2, 8, 3.3);
        m[0] += S * df;
        m[1] += S * f * df;
        m[2] += S * f * f * df;
        e += S / f * df;
        m7 += fl_jonswap_spectrum(f, 2, 8, 7) * df;
    }
    verify_row("V58", "JONSWAP, Hs 2 m, Tp 8 s: 4 sqrt(m0) [m]", 4 * sqrt(m[0]), 2.00241, 1e-5, VERIFY_REL);
    verify_row("V58", "  gamma = 7", 4 * sqrt(m7), 1.98239, 1e-5, VERIFY_REL);
    verify_row("V58", "  S(fp) [m2 s]", fl_jonswap_spectrum(0.125, 2, 8, 3.3), 6.21497, 1e-5, VERIFY_REL);
    verify_row("V58", "  Tz [s]", sqrt(m[0] / m[2]), 6.221, 1e-4, VERIFY_REL);
    verify_row("V58", "  Te [s]", e / m[0], 7.226, 1e-4, VERIFY_REL);

    enum { N = 21600 }; /* 3 h, twice a second */
    static double x[N];
    static const double EDGE[6] = {0.05, 0.1, 0.125, 0.16, 0.25, 0.5};
    for (int seed = 1; seed <= 3; seed++) {
        fl_waves w;
        fl_err err = {0};
        fl_power_spectrum welch = {0};
        double mean = 0, var = 0, worst = 0;
        fl_waves_jonswap(&w, 2, 8, 3.3, 100, (uint64_t)seed, 0, INFINITY, G, &err);
        for (int k = 0; k < N; k++) {
            fl_wave_expansion near;
            fl_wave_expand(&w, 3.0, 0, 0.01, 0.5 * k, &near);
            mean += x[k] = fl_wave_elevation(&near, 3.0, NULL);
        }
        mean /= N;
        for (int k = 0; k < N; k++) var += (x[k] - mean) * (x[k] - mean) / N;
        verify_note("3 h of the sea with seed %d", seed);
        verify_row("V58", "4 standard deviations [m]", 4 * sqrt(var), 2.0, 0.01, VERIFY_REL);
        if (fl_power_spectrum_make(&welch, N, x, 2.0, 1000, FL_TAPER_HANN, &err)) continue;
        verify_row("V58", "area of the spectrum by Welch [m2]", fl_power_spectrum_variance(&welch), 0.25,
                   0.03, VERIFY_REL);
        for (int c = 0; c < 5; c++) {
            double got = 0, want = 0;
            for (int32_t k = 0; k < welch.n; k++)
                if (k * welch.df >= EDGE[c] && k * welch.df < EDGE[c + 1]) got += welch.psd[k] * welch.df;
            for (double f = EDGE[c] + 0.5 * df - 0.5 * welch.df; f < EDGE[c + 1] - 0.5 * welch.df; f += df)
                want += fl_jonswap_spectrum(f, 2, 8, 3.3) * df;
            worst = fmax(worst, fabs(got - want));
        }
        /* a line on the border of a band spreads over 3 df of it, and a wave train has a hundredth of the
         * energy */
        verify_below("V58", "energy in five bands: error over the total", worst / 0.25, 0.05);
        for (int k = 1; k < N; k++) up += (x[k - 1] < mean && x[k] >= mean) / 3.0;
        fl_power_spectrum_free(&welch);
        fl_waves_free(&w);
    }
    verify_row("V58", "upward crossings of the mean, three seas: Tz [s]", 0.5 * N / up, 6.221, 0.05,
               VERIFY_REL);
}

static void make_floe(lab *l, const char *keys[], int n)
{
    lab_start(l);
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "water.density=1025");
    lab_set(l, "water.drag_force_coef=0");
    lab_set(l, "water.drag_moment_coef=0");
    for (int k = 0; k < n; k++) lab_set(l, keys[k]);
}

/* A wave of negligible height: pressure panels against exact clipping. */
static void flat_wave(void)
{
    const char *wavy[] = {"water.wave=airy", "water.height=1e-15", "water.period=4", "water.direction=20"};
    double force = 0, moment = 0, volume = 0, centre = 0, wetted = 0;
    const double d = 20; /* a current of (1 + z/d) m/s measures the depth of the submerged centre */
    lab a, b;
    make_floe(&a, NULL, 0);
    make_floe(&b, wavy, 4);
    for (int j = 0; j < 2; j++) {
        lab_set(j ? &b : &a, "water.current=1 0 0");
        lab_set(j ? &b : &a, "water.profile=linear");
        lab_setf(j ? &b : &a, "water.profile_depth=%g", d);
    }
    for (int k = 0; k < 60; k++) {
        fl_rng g = fl_rng_of(11, k, FL_RNG_TEST);
        const fl_quat q = shape_rotation(&g);
        const fl_vec3 at = v3(50 * k, fl_rng_in(&g, -20, 20), fl_rng_in(&g, -6, 6));
        for (int j = 0; j < 2; j++) lab_box(j ? &b : &a, at, v3(5, 4, 2), 0.05, q, v3(0, 0, 0), v3(0, 0, 0));
    }
    lab_make(&a, 1e-3);
    lab_make(&b, 1e-3);
    for (int32_t k = 0; k < 60; k++) {
        const double size = 1025 * G * 320;
        force = fmax(force, v3_norm(v3_sub(a.w.b.f[k], b.w.b.f[k])) / size);
        moment = fmax(moment, v3_norm(v3_sub(a.w.b.t[k], b.w.b.t[k])) / (size * 5));
        volume = fmax(volume, fabs(a.w.sea.buoyancy[k] - b.w.sea.buoyancy[k]) / size);
        centre = fmax(centre, d * v3_norm(v3_sub(a.w.sea.flow_velocity[k], b.w.sea.flow_velocity[k])) *
                                  (a.w.sea.buoyancy[k] > 0));
        wetted = fmax(wetted, fabs(a.w.sea.wetted_area[k] - b.w.sea.wetted_area[k]) / 232);
    }
    verify_note("60 tilted boxes in a wave of 1e-15 m: against exact clipping");
    verify_below("V48", "force, of the largest", force, 1e-13);
    verify_below("V48", "moment", moment, 1e-13);
    verify_below("V48", "volume", volume, 1e-13);
    verify_below("V48", "height of the centre [m]", centre, 1e-9);
    verify_below("V48", "wetted area", wetted, 1e-12);
    lab_free(&a);
    lab_free(&b);
}

/* Forces on a box of length L at its draft in a sea of small waves, against the sum over its trains:
 *     F_z = rho g B sum a e^(-kd) (2/k) sin(kL/2) cos psi,
 *     F_x = rho g B sum a (1 - e^(-kd))/k 2 sin(kL/2) sin psi. */
static void pressure_on_panels(void)
{
    static const struct {
        const char *what;
        double L, Tp, tolerance;
        int n;
    } cases[6] = {{"10 m in one wave of 14 m", 10, 3, 5e-4, 1}, {"10 m in one wave of 100 m", 10, 8, 1e-4, 1},
                  {"10 m in a sea, Tp 8 s", 10, 8, 5e-4, 100},  {"10 m in a sea, Tp 5 s", 10, 5, 5e-4, 100},
                  {"60 m in a sea, Tp 8 s", 60, 8, 5e-4, 100},  {"2 m in a sea, Tp 8 s", 2, 8, 5e-4, 100}};
    for (int c = 0; c < 6; c++) {
        const double L = cases[c].L, B = 4;
        double off[2] = {0}, mean[2] = {0};
        char what[80];
        lab l;
        lab_start(&l);
        lab_set(&l, "run.gravity=9.81");
        lab_set(&l, cases[c].n > 1 ? "water.wave=jonswap" : "water.wave=airy");
        lab_set(&l, "water.height=1e-5");
        lab_set(&l, "water.wave_error=none");
        lab_setf(&l, "water.period=%g", cases[c].Tp);
        for (int k = 0; k < 40; k++)
            lab_box(&l, v3(137.3 * k, 6 * k, REST), v3(0.5 * L, 0.5 * B, 0.5), 0.05, q_one(), v3(0, 0, 0),
                    v3(0, 0, 0));
        lab_make(&l, 1e-3);
        const fl_waves *w = &l.w.sea.wave;
        for (int32_t k = 0; k < 40; k++) {
            double F[2] = {0};
            for (int32_t j = 0; j < w->n; j++) {
                const fl_wave_train *t = &w->train[j];
                const double psi = t->k * l.w.b.x[k].x + t->phase, fall = exp(-t->k * DRAFT);
                const double both = 1025 * G * B * t->a * 2 / t->k * sin(0.5 * t->k * L);
                F[0] += both * fall * cos(psi);
                F[1] += both * (1 - fall) * sin(psi);
            }
            const double got[2] = {l.w.b.f[k].z, l.w.b.f[k].x};
            for (int d = 0; d < 2; d++) {
                off[d] += (got[d] - F[d]) * (got[d] - F[d]);
                mean[d] += F[d] * F[d];
            }
        }
        snprintf(what, sizeof what, "%s: relative error of the lift", cases[c].what);
        verify_below("D8", what, sqrt(off[0] / mean[0]), cases[c].tolerance);
        verify_below("D8", "  push off by", sqrt(off[1] / mean[1]), cases[c].tolerance);
        lab_free(&l);
    }
}

/* Amplitude of y(t) at omega, with a free oscillation at omega_0: least squares with five functions. */
static double amplitude(int n, const double *t, const double *y, double omega, double omega0)
{
    double a[5][6] = {{0}};
    for (int k = 0; k < n; k++) {
        const double f[6] = {
            1, cos(omega * t[k]), sin(omega * t[k]), cos(omega0 * t[k]), sin(omega0 * t[k]), y[k]};
        for (int i = 0; i < 5; i++)
            for (int j = 0; j < 6; j++) a[i][j] += f[i] * f[j];
    }
    for (int i = 0; i < 5; i++)
        for (int r = 0; r < 5; r++) {
            if (r == i) continue;
            const double s = a[r][i] / a[i][i];
            for (int j = i; j < 6; j++) a[r][j] -= s * a[i][j];
        }
    return hypot(a[1][5] / a[1][1], a[2][5] / a[2][2]);
}

/* Heave of the floe of V48 in a long wave: (sin x / x) e^(-kd) / (1 - omega^2 d/g), x = kL/2. */
static void heave_in_long_wave(void)
{
    enum { N = 24000 };
    static double t[N], z[N], x[N];
    static const double LENGTH[4] = {100, 400, 50, 30};
    for (int c = 0; c < 4; c++) {
        const double k = 2 * PI / LENGTH[c], omega = sqrt(G * k), a = 2e-6 / k;
        const int n = LENGTH[c] > 200 ? N : N / 4; /* 6 periods; the free heave needs small steps */
        const double dt = 2 * PI / omega * 6 / n;
        const double half = 0.5 * k * 10, sinc = sin(half) / half;
        const double heave = sinc * exp(-k * DRAFT) / (1 - omega * omega * DRAFT / G);
        /* the pressure on the two ends, and nothing else: m x'' = -rho g a (e^-kd - 1)/k B 2 sin(kL/2) sin */
        const double surge = sinc * (1 - exp(-k * DRAFT)) / (k * DRAFT);
        lab l;
        char what[80];
        make_floe(&l, NULL, 0);
        lab_box(&l, v3(0, 0, REST), v3(5, 5, 0.5), 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
        lab_set(&l, "water.wave=airy");
        lab_setf(&l, "water.height=%.17g", 2 * a);
        lab_setf(&l, "water.period=%.17g", 2 * PI / omega);
        lab_make(&l, dt);
        /* its speed when it follows the wave, so that it does not drift away */
        l.w.b.v[0].x = a * omega * surge;
        for (int s = 0; s < n; s++) {
            lab_run(&l, 1);
            t[s] = dt * (s + 1);
            z[s] = l.w.b.x[0].z;
            x[s] = l.w.b.x[0].x;
        }
        snprintf(what, sizeof what, "heave over the wave, 10 m of ice in %g m", LENGTH[c]);
        verify_row("D8", what, amplitude(n, t, z, omega, sqrt(G / DRAFT)) / a, heave, 1e-4, VERIFY_REL);
        if (c == 0)
            verify_row("D8", "  as listed, not 1.041", amplitude(n, t, z, omega, sqrt(G / DRAFT)) / a, 0.985,
                       5e-4, VERIFY_ABS);
        verify_row("D8", "  surge over the wave", amplitude(n, t, x, omega, sqrt(G / DRAFT)) / a, surge, 1e-3,
                   VERIFY_REL);
        lab_free(&l);
    }
}

/* A floe of any size in waves of its own length: finer panels change nothing. */
static void energy_in_waves(void)
{
    const char *KEYS[] = {"water.wave=jonswap",    "water.height=1",   "water.period=4",
                          "water.added_mass=auto", "water.drag=facet", "water.current=0.3 0 0"};
    double h[4], residual[4];
    for (int c = 0; c < 4; c++) {
        lab l;
        h[c] = 0.04 / (1 << c);
        make_floe(&l, KEYS, 6);
        lab_box(&l, v3(0, 0, REST), v3(5, 5, 0.5), 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
        lab_make(&l, h[c]);
        residual[c] = 0.0;
        for (int s = 0; s < 250 << c; s++) {
            lab_run(&l, 1);
            fl_energy_update(&l.w);
            residual[c] = fmax(residual[c], fabs(l.w.ledger.residual));
        }
        residual[c] /= l.w.ledger.throughput;
        lab_free(&l);
    }
    verify_order("V29", "a floe in a sea, 10 s: residual over throughput", h, residual, 4, 2.0, 0.5);
}

/* A floe is thrown obliquely into a sea that is not evaluated in each step: against the run that evaluates
 * it in each step, with the same steps. */
static void interval_of_evaluations(void)
{
    enum { MOST = 400, STEPS = 8000 };
    const char *KEYS[] = {"water.current=0.3 0 0", "water.wave=jonswap",  "water.height=0.5",
                          "water.period=5",        "water.components=20", "water.wave_error=none"};
    static fl_vec3 path[STEPS / MOST];
    double h[4], off[4], opened[4];
    for (int c = -1; c < 4; c++) {
        const int every = c < 0 ? 1 : MOST >> (c + 1);
        lab l;
        double still = 0.0;
        make_floe(&l, KEYS, 6);
        lab_set(&l, "water.drag_force_coef=0.005");
        lab_set(&l, "water.drag_moment_coef=0.002");
        lab_setf(&l, "water.every=%d", every);
        lab_box(&l, v3(0, 0, REST + 0.03), v3(2, 1.5, 0.5), 0.05, q_of_vector(v3(0.02, 0.04, 0)), v3(0, 0, 0),
                v3(0, 0, 0));
        lab_make(&l, 2e-4);
        if (c >= 0) h[c] = every * l.w.dt, off[c] = 0.0;
        for (int s = 0; s < STEPS / MOST; s++) {
            if (lab_run(&l, MOST)) exit(1);
            fl_energy_update(&l.w);
            still = fmax(still, fabs(l.w.ledger.residual) / l.w.ledger.throughput);
            if (c < 0) path[s] = l.w.b.x[0];
            else off[c] = fmax(off[c], v3_norm(v3_sub(l.w.b.x[0], path[s])));
        }
        if (c >= 0) opened[c] = still;
        else verify_note("residual over throughput with an evaluation in each step: %.2g", still);
        lab_free(&l);
    }
    verify_order("V29", "water.every > 1: position [m]", h, off, 4, 2.0, 0.3);
    verify_below("V29", "  residual over throughput, the largest", fmax(opened[0], opened[3]), 5e-6);
}

/* The same without drag for five minutes, 160 periods of heave, in swell of small effect: amplitude in the
 * last tenth over that in the first, with 20 evaluations of the water per period. */
static void long_interval_run(void)
{
    enum { TENTH = 10000 };
    const char *KEYS[] = {"water.wave=jonswap", "water.height=0.001", "water.period=8", "water.components=20",
                          "water.wave_error=none"};
    double swing[2][2] = {{0}};
    for (int seldom = 0; seldom < 2; seldom++) {
        lab l;
        make_floe(&l, KEYS, 5);
        lab_setf(&l, "water.every=%d", seldom ? 20 : 1);
        lab_box(&l, v3(0, 0, REST + 0.03), v3(2, 1.5, 0.5), 0.05, q_of_vector(v3(0.02, 0.04, 0)), v3(0, 0, 0),
                v3(0, 0, 0));
        lab_make(&l, 3e-3);
        for (int s = 0; s < 10 * TENTH; s++) {
            double *const most = &swing[seldom][s >= 9 * TENTH];
            if (lab_run(&l, 1)) exit(1);
            if (s < TENTH || s >= 9 * TENTH) *most = fmax(*most, fabs(l.w.b.x[0].z - REST));
        }
        lab_free(&l);
    }
    verify_note("amplitude, last over first, with an evaluation in each step: %.4f",
                swing[0][1] / swing[0][0]);
    verify_row("V29", "water.every > 1: amplitude, last over first", swing[1][1] / swing[1][0],
               swing[0][1] / swing[0][0], 0.01, VERIFY_REL);
}

/* The sea throws up a raft of 0.14 m.  When it leaves the water, the submerged volume goes to zero while
 * some of its skin is wet, and the centre of that volume is undefined. */
static void raft_leaves_water(void)
{
    static const fl_vec3 CORNER[4] = {{3.3980215619269085, 3.5631228938112924, -0.17425077513220655},
                                      {3.1060886499210527, 3.8550558058171482, -0.17425077513220655},
                                      {2.814155737915197, 3.5631228938112924, -0.17425077513220655},
                                      {3.1060886499210527, 3.2711899818054366, -0.17425077513220655}};
    static const int32_t FIRST[3] = {0, 4, 8}, LOOP[8] = {0, 1, 2, 3, 3, 2, 1, 0};
    double least = INFINITY, most = 0.0;
    for (double dt = 2e-5; dt < 7e-5; dt += 1e-5) {
        fl_poly p = {0};
        fl_err err = {0};
        lab l;
        lab_start(&l);
        lab_set(&l, "run.gravity=9.81");
        lab_set(&l, "water.current=2 m/s");
        lab_set(&l, "water.wave=airy");
        lab_set(&l, "water.height=0.5 m");
        lab_set(&l, "water.period=2 s");
        lab_set(&l, "water.direction=30");
        if (fl_poly_make(&p, 4, CORNER, 2, FIRST, LOOP, &err)) exit(1);
        lab_poly(&l, &p, 0.07191607761925031, v3(0.3527660912271873, -0.5708562813895888, 0.5097704843025077),
                 v3(0.2857940533669441, -0.4262772995146036, 0.04415947528091868));
        lab_make(&l, dt);
        if (lab_run(&l, (int64_t)(0.3 / dt))) exit(1);
        const double now = fl_body_kinetic_energy(&l.w.b, 0);
        least = fmin(least, now), most = fmax(most, now);
        lab_free(&l);
    }
    verify_note(
        "a raft leaves the crest of a wave: its energy after 0.3 s is %g to %g J for steps of 20 to 60 us",
        least, most);
    verify_below("V62", "the largest over the smallest", most / least, 1.01);
}

int main(void)
{
    verify_begin("waves");
    dispersion();
    power_series();
    jonswap_spectrum();
    flat_wave();
    pressure_on_panels();
    heave_in_long_wave();
    raft_leaves_water();
    energy_in_waves();
    interval_of_evaluations();
    long_interval_run();
    return verify_end();
}
