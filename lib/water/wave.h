/* SPDX-License-Identifier: GPL-3.0-or-later */
/* wave.h -- long-crested linear waves on water of constant depth: trains that all run one way.
 *
 * With s along the direction, z over still water, psi = k s - omega t + phi and omega^2 = g k tanh k d,
 *     elevation      eta = sum a cos psi
 *     pressure       p/(rho g) = P - z,  P = sum a C cos psi,     C = cosh k(z+d) / cosh kd
 *     velocity       u = sum a (g k/omega) C cos psi
 *                    w = sum a (g k/omega) S sin psi,             S = sinh k(z+d) / cosh kd
 *     acceleration   -g grad P
 * C and S are taken at the stretched height (Wheeler)
 *     zeta = (z - eta) d / (d + eta),
 * so that nothing grows beyond bounds above still water and the pressure is 0 on the wave.  In deep water C =
 * S = e^(k zeta).  Sources: Airy 1845; Wheeler 1970, J. Petrol. Technol. 22:359; DNV-RP-C205 (2010), 3.3.
 *
 * The field around one body comes as a power series.  With c = zeta + i s from a centre,
 *     P = Re sum_m f_m c^m,   f_m = sum_n (A_n + (-1)^m conj(B_n)) k_n^m / m!,
 * B_n the part that the bottom throws back, and u + i w is such a sum too, both being analytic: one sine and
 * cosine a train and body, then a polynomial for every point, whatever the number of trains.  All bits are
 * functions of place and time: nothing is added up from step to step. */
#ifndef FL_WATER_WAVE_H
#define FL_WATER_WAVE_H
#include <stdint.h>
#include "base/err.h"
#include "base/simd.h"
#include "geom/vec3.h"

/* Terms of a series, and the largest k times distance from its centre that they do for: 8^32/32! = 3e-7. */
enum { FL_WAVE_TERMS = 32 };
#define FL_WAVE_REACH 8.0

typedef struct {
    double k, omega, a, phase;   /* [1/m], [rad/s], [m], [rad] */
    double velocity_factor;      /* g k / omega [1/s] */
    double norm, mirror;         /* 1 / (1 + e^(-2kd)); e^(-2kd), 0 in deep water */
    double power[FL_WAVE_TERMS]; /* k^m / m! */
} fl_wave_train;

typedef struct {
    int32_t n;
    fl_wave_train *train; /* [n] by rising k */
    fl_vec3 direction;    /* unit vector they run along */
    double depth;         /* d, INFINITY: deep [m] */
    double gravity;       /* g [m/s2] */
    double max_k, k95;    /* largest k, and that below which 95 % of the energy lies [1/m] */
    double max_crest,
        four_sigma; /* sum of all amplitudes: no crest is higher; four standard deviations [m] */
} fl_waves;

/* k of omega^2 = g k tanh kd, to rounding [1/m]. */
double fl_wave_number(double omega, double depth, double gravity);

/* One train of height H and period T, its crest at the origin at t = 0.
 *   direction  that it runs to, from x towards y [deg]
 * -1 with FL_SYSTEM. */
int fl_waves_airy(fl_waves *w, double height, double period, double direction, double depth, double gravity,
                  fl_err *err);

/* A sea of the JONSWAP spectrum, of n trains of equal energy and significant height Hs: train j has the
 * frequency below which (j + x)/n of the energy of the spectrum between 0.3 and 4 of its peak lies, x in [0,
 * 1) and its phase by chance from the seed; so no two frequencies have a common period, and the height is Hs
 * over any long time.  -1 with FL_SYSTEM. */
int fl_waves_jonswap(fl_waves *w, double Hs, double Tp, double gamma, int32_t n, uint64_t seed,
                     double direction, double depth, double gravity, fl_err *err);

/* The spectrum itself [m2 s],
 *     S(f) = 5/16 Hs^2 fp^4 f^-5 e^(-5/4 (fp/f)^4) gamma^q (1 - 0.287 ln gamma),
 *     q = e^(-(f/fp - 1)^2 / 2 sigma^2),  sigma = 0.07 up to fp = 1/Tp, 0.09 above.
 * Its area is Hs^2/16 to 1 % only.  Source: DNV-RP-C205, 3.5.5. */
double fl_jonswap_spectrum(double f, double Hs, double Tp, double gamma);

typedef struct {
    double re[FL_WAVE_TERMS], im[FL_WAVE_TERMS];
} fl_wave_series;

/* The field within k_top distance <= FL_WAVE_REACH of a centre. */
typedef struct {
    int terms;                 /* used of each */
    double s, z;               /* centre [m] */
    fl_wave_series f, u;       /* of P [m^(1-m)], and of the velocity */
    double eta[FL_WAVE_TERMS]; /* elevation over s, where z = 0 */
} fl_wave_expansion;

/* The series about (s, z) at time t, for points within the radius.  z <= 0; z = 0 gives the elevation too. */
void fl_wave_expand(const fl_waves *w, double s, double z, double radius, double t, fl_wave_expansion *near);

/* Elevation at s, and its slope along s (may be NULL); near was made at z = 0. */
double fl_wave_elevation(const fl_wave_expansion *near, double s, double *slope);

/* Height z over still water, stretched below the elevation eta; never above 0. */
double fl_wave_stretch(const fl_waves *w, double z, double eta);

/* P at s and the stretched height zeta [m]. */
double fl_wave_pressure(const fl_wave_expansion *near, double s, double zeta);

/* Both at FL_WAVE_BATCH places s, z (over still water) at once: elevation, and P at the stretched height. All
 * places go in step: a single sum waits for itself. */
enum { FL_WAVE_BATCH = 8 };
FL_SIMD_INLINE void fl_wave_pressure_batch(const fl_waves *w, const fl_wave_expansion *near, const double *s,
                                           const double *z, double *eta, double *head)
{
    enum { PARTS = FL_WAVE_BATCH / FL_SIMD_WIDTH };
    const fl_simd zero = {0.0, 0.0, 0.0, 0.0};
    const double depth = w->depth;
    fl_simd x[PARTS], y[PARTS], over[PARTS] = {zero, zero}, re[PARTS] = {zero, zero},
                                im[PARTS] = {zero, zero};
    FL_SIMD_UNROLL for (int k = 0; k < PARTS; k++) y[k] = FL_SIMD_LOAD(&s[FL_SIMD_WIDTH * k]) - near->s;
    for (int m = near->terms - 1; m >= 0; m--) {
        const double c = near->eta[m];
        FL_SIMD_UNROLL for (int k = 0; k < PARTS; k++) over[k] = over[k] * y[k] + c;
    }
    FL_SIMD_UNROLL for (int k = 0; k < PARTS; k++) /* as fl_wave_stretch() */
    {
        fl_simd below = FL_SIMD_LOAD(&z[FL_SIMD_WIDTH * k]) - over[k];
        const fl_simd_mask wet = below < 0.0;
        if (depth < INFINITY) below = below * depth / (depth + over[k]);
        x[k] = FL_SIMD_MASKED(wet, below) - near->z;
        FL_SIMD_STORE(&eta[FL_SIMD_WIDTH * k]) = over[k];
    }
    for (int m = near->terms - 1; m >= 0; m--) {
        const double c = near->f.re[m], d = near->f.im[m];
        FL_SIMD_UNROLL for (int k = 0; k < PARTS; k++)
        {
            const fl_simd r = re[k] * x[k] - im[k] * y[k] + c;
            im[k] = re[k] * y[k] + im[k] * x[k] + d;
            re[k] = r;
        }
    }
    FL_SIMD_UNROLL for (int k = 0; k < PARTS; k++) FL_SIMD_STORE(&head[FL_SIMD_WIDTH * k]) = re[k];
}

/* Velocity and acceleration of the water there: along s and up [m/s], [m/s2]. */
void fl_wave_kinematics(const fl_waves *w, const fl_wave_expansion *near, double s, double zeta,
                        double velocity[2], double acceleration[2]);

/* Height over length, of the train of the peak: for a warning where it is above 0.142 tanh kd, the height at
 * which a wave breaks (Miche 1944). */
double fl_wave_steepness(double height, double period, double depth, double gravity, double *breaking);

void fl_waves_free(fl_waves *w); /* accepts a zeroed struct, leaves one */

#endif
