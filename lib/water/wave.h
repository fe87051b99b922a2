/* SPDX-License-Identifier: GPL-3.0-or-later */
/* wave.h -- long-crested linear waves on water of constant depth: wave trains of one direction.
 *
 * With s along the direction, z above still water, psi = k s - omega t + phi and omega^2 = g k tanh k d,
 *     elevation      eta = sum a cos psi
 *     pressure       p/(rho g) = P - z,  P = sum a C cos psi,     C = cosh k(z+d) / cosh kd
 *     velocity       u = sum a (g k/omega) C cos psi
 *                    w = sum a (g k/omega) S sin psi,             S = sinh k(z+d) / cosh kd
 *     acceleration   -g grad P
 * C and S are taken at the stretched height (Wheeler)
 *     zeta = (z - eta) d / (d + eta),
 * so that they stay bounded above still water and the pressure is 0 on the wave surface. In deep water C = S
 * = e^(k zeta). Sources: Airy 1845; Wheeler 1970, J. Petrol. Technol. 22:359; DNV-RP-C205 (2010), 3.3.
 *
 * The field around one body is a power series. With c = zeta + i s from a centre,
 *     P = Re sum_m f_m c^m,   f_m = sum_n (A_n + (-1)^m conj(B_n)) k_n^m / m!,
 * B_n being the part reflected by the bottom. u + i w is such a sum too, since both are analytic. So a body
 * takes one sine and cosine per train, and each point a polynomial, whatever the number of trains. All values
 * are functions of position and time: nothing accumulates from step to step. */
#ifndef FL_WATER_WAVE_H
#define FL_WATER_WAVE_H
#include <stdint.h>
#include "base/err.h"
#include "base/simd.h"
#include "geom/vec3.h"

/* Terms of a series, and the largest k times distance from its centre within its range: 8^32/32! = 3e-7. */
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
    fl_wave_train *train; /* [n] in ascending k */
    fl_vec3 direction;    /* unit vector of propagation */
    double depth;         /* d, INFINITY for deep water [m] */
    double gravity;       /* g [m/s2] */
    double max_k, k95;    /* largest k, and the k below which 95 % of the energy lies [1/m] */
    double max_crest;     /* sum of all amplitudes, a bound of the crests [m] */
    double four_sigma;    /* four standard deviations of the elevation [m] */
} fl_waves;

/* k of omega^2 = g k tanh kd, to rounding [1/m]. */
double fl_wave_number(double omega, double depth, double gravity);

/* One train of height H and period T, with its crest at the origin at t = 0.
 *   direction  of propagation, from x towards y [deg]
 * Returns -1 with FL_SYSTEM. */
int fl_waves_airy(fl_waves *w, double height, double period, double direction, double depth, double gravity,
                  fl_err *err);

/* A JONSWAP spectrum of significant height Hs as n trains of equal energy. Train j has the frequency below
 * which (j + x)/n of the energy between 0.3 and 4 peak frequencies lies. x in [0, 1) and the phase are
 * random, by the seed. So no two frequencies have a common period, and the height is Hs over any long time.
 * Returns -1 with FL_SYSTEM. */
int fl_waves_jonswap(fl_waves *w, double Hs, double Tp, double gamma, int32_t n, uint64_t seed,
                     double direction, double depth, double gravity, fl_err *err);

/* The JONSWAP spectrum [m2 s],
 *     S(f) = 5/16 Hs^2 fp^4 f^-5 e^(-5/4 (fp/f)^4) gamma^q (1 - 0.287 ln gamma),
 *     q = e^(-(f/fp - 1)^2 / 2 sigma^2),  sigma = 0.07 up to fp = 1/Tp, 0.09 above.
 * Its area is Hs^2/16 within 1 %. Source: DNV-RP-C205, 3.5.5. */
double fl_jonswap_spectrum(double f, double Hs, double Tp, double gamma);

typedef struct {
    double re[FL_WAVE_TERMS], im[FL_WAVE_TERMS];
} fl_wave_series;

/* Expansion of the field within max_k * distance <= FL_WAVE_REACH of a centre. */
typedef struct {
    int terms;                 /* terms in use */
    double s, z;               /* centre [m] */
    fl_wave_series f, u;       /* of P [m^(1-m)], and of the velocity */
    double eta[FL_WAVE_TERMS]; /* elevation over s, if z = 0 */
} fl_wave_expansion;

/* Expands the field about (s, z) at time t, for points within the radius. z <= 0; z = 0 gives the elevation
 * too. */
void fl_wave_expand(const fl_waves *w, double s, double z, double radius, double t, fl_wave_expansion *near);

/* Elevation at s, and its slope along s (may be NULL); the expansion is one at z = 0. */
double fl_wave_elevation(const fl_wave_expansion *near, double s, double *slope);

/* Height z above still water, stretched below the elevation eta; never above 0. */
double fl_wave_stretch(const fl_waves *w, double z, double eta);

/* P at s and the stretched height zeta [m]. */
double fl_wave_pressure(const fl_wave_expansion *near, double s, double zeta);

/* Elevation, and P at the stretched height, at FL_WAVE_BATCH points s, z (above still water). All points
 * advance together, since a single sum would wait on latency. */
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

/* Velocity and acceleration of the water at s and the stretched height zeta: along s and up [m/s], [m/s2]. */
void fl_wave_kinematics(const fl_waves *w, const fl_wave_expansion *near, double s, double zeta,
                        double velocity[2], double acceleration[2]);

/* Height over length of a train. *breaking: 0.142 tanh kd, the steepness at which a wave breaks (Miche 1944).
 */
double fl_wave_steepness(double height, double period, double depth, double gravity, double *breaking);

void fl_waves_free(fl_waves *w); /* accepts a zeroed struct, leaves one */

#endif
