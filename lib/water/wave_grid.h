/* SPDX-License-Identifier: GPL-3.0-or-later */
/* wave_grid.h -- the waves of a sea as tables along each direction of propagation.
 *
 * One table holds one level of time, t = level step, and one direction d. Along s = d.x it has places s_i =
 * i h, and below the surface the depths
 *     zeta_j = -(A / k_top) (r^j - 1),   A (r - 1) = 0.35 q^(-1/4),   A = 0.7.
 * At each place and depth stand four numbers, with a, k, omega, phi of wave.h, psi = k s - omega t + phi:
 *     P,  dP/dzeta,    P   = sum_n b_n a_n C_n cos psi_n          pressure head [m]
 *     F,  dF/dzeta,    F   = sum_n b_n (a_n g / omega_n) C_n sin psi_n   velocity potential [m2/s]
 *     b_n = 3 / (2 + cos k_n h)
 * Along s they are coefficients of a cubic B-spline; b_n makes the spline meet each wave train at the places.
 * Between depths a cubic Hermite polynomial is used. Velocity is the gradient of F, the acceleration of the
 * water -g times the gradient of P.
 *
 * With an error e asked for, q = 0.003/e, and L, T being length and period of the shortest train,
 *     h = L / (12 q^(1/3)),     2 step = T / (16 q^(1/4)).
 * At q = 1 a train of length L is off by 2e-5 of its amplitude, its slope by 4e-4, at the depths P by 4e-5.
 * The coefficients of a chunk of 64 places start from a sine and cosine for each train (fl_cos_sin()) and
 * are rotated from place to place, whatever the window. So the table is a function of place and level alone:
 * bits do not depend on windows, threads and restarts. A place outside the window is computed when needed, by
 * the same operations.
 *
 * Spread: train j has one of 16 directions, by chance from (seed, j); each has the same share of the energy
 * of D(theta) ~ cos^n theta about the main direction, and its sin^2 is the mean over its share. The mean over
 * all directions is <sin^2> = 1/(n + 2).
 *
 * Decay in ice: the amplitude of a train falls as e^(-k_i (s - edge)) beyond the edge of the ice,
 *     k_i = C H^m f^n   [1/m],   H thickness of the ice [m], f frequency [Hz].
 * Sources: Rogers et al. 2021, Cold Reg. Sci. Technol. 182:103184 (2.9, 1.25, 4.5); Meylan et al. 2018, J.
 * Geophys. Res. 123:4256 (0.059, 1, 3). Attenuation in ice is not always exponential (Squire 2018).
 *
 * Limits: linear waves; no change of the wavelength by ice or current; places up to 42 km apart. */
#ifndef FL_WATER_WAVE_GRID_H
#define FL_WATER_WAVE_GRID_H
#include "base/simd.h"
#include "water/wave.h"

enum {
    FL_WAVE_CHUNK = 64,      /* places of a chunk */
    FL_WAVE_SLOTS = 7,       /* levels held at a time */
    FL_WAVE_DEPTHS = 48,     /* most depths */
    FL_WAVE_DIRECTIONS = 16, /* most directions */
    FL_WAVE_NUMBERS = 4      /* numbers at a place and depth: P, dP, F, dF */
};

/* Longest stretch of places [m]. */
#define FL_WAVE_GRID_MAX 42e3

typedef struct {
    double x, y;               /* unit vector of propagation */
    int32_t n;                 /* trains */
    double *k, *omega, *phase; /* [n] [1/m], [rad/s], [rad] */
    double *decay;             /* [n] k_i, or NULL [1/m] */
    double (*turn)[4];         /* [n] cos kh, sin kh, cos 4kh, sin 4kh */
    double *weight;            /* [depths][4][n] factors of cos psi or sin psi */
    int32_t *limit;            /* [depths] trains that reach so deep */
    int64_t first;             /* first chunk of the window */
    int32_t chunks;
    double *table[FL_WAVE_SLOTS]; /* [depths][4][64 chunks] */
    int64_t room[FL_WAVE_SLOTS];  /* doubles allocated */
} fl_wave_line;

/* Chunks around a place outside the window. */
typedef struct {
    int64_t level, chunk;
    int32_t line;
    double *at; /* [depths][4][3 * 64] */
} fl_wave_outside;

typedef struct {
    int32_t lines, depths, threads;
    fl_wave_line line[FL_WAVE_DIRECTIONS];
    double error;   /* e asked for */
    double h, step; /* between places [m], between levels [s] */
    double water;   /* depth of the water, INFINITY if deep [m] */
    double gravity; /* g [m/s2] */
    double edge;    /* s of the edge of the ice [m] */
    double zeta[FL_WAVE_DEPTHS];
    int64_t level[FL_WAVE_SLOTS]; /* level in each slot; INT64_MIN: none */
    fl_wave_outside *outside;     /* [threads] */
} fl_wave_grid;

typedef struct {
    double error;          /* asked for */
    double spread;         /* n of cos^n, 0: one direction */
    uint64_t seed;         /* of the directions */
    double decay[3], edge; /* C, m, n, C = 0: none; s of the edge of the ice [m] */
    double thickness;      /* H [m] */
} fl_wave_grid_form;

/* Makes the grid of a sea, without tables. threads: how many may sample at once. Returns -1 with FL_SYSTEM.
 * */
int fl_wave_grid_make(fl_wave_grid *g, const fl_waves *w, const fl_wave_grid_form *f, int threads,
                      fl_err *err);
void fl_wave_grid_free(fl_wave_grid *g); /* accepts a zeroed struct, leaves one */

/* Extent of floating bodies along each line [m]. */
typedef struct {
    double lo[FL_WAVE_DIRECTIONS], hi[FL_WAVE_DIRECTIONS];
} fl_wave_extent;

/* Fills tables of the levels first, first + every, ..., `many` of them, for the extent and a chunk beyond.
 * threads: how many fill them. Tables that are there already are kept. Returns -1 with FL_SYSTEM. */
int fl_wave_grid_fill(fl_wave_grid *g, const fl_wave_extent *at, int64_t first, int every, int many,
                      int threads, fl_err *err);

/* Bytes of all tables. */
double fl_wave_grid_bytes(const fl_wave_grid *g);

/* Fills the three chunks around one outside the window; for fl_wave_grid_cell(). */
const double *fl_wave_grid_outside(const fl_wave_grid *g, int32_t line, int64_t level, int64_t place);

/* --- evaluation ---------------------------------------------------------------------------------- */

/* One level, to sample at. */
typedef struct {
    const fl_wave_grid *grid;
    int64_t level;
    int slot; /* -1: none has that level */
} fl_wave_view;

fl_wave_view fl_wave_grid_view(const fl_wave_grid *g, int64_t level);

/* Weights of four neighbouring places at a position: value, slope and second derivative. */
typedef struct {
    fl_simd w, dw, ddw;
    const double *at; /* the first of the four, depth 0 */
    int64_t stride;   /* to the next number */
    int outside;      /* 1: `at` holds until the next place outside the window only */
} fl_wave_taps;

FL_SIMD_INLINE void fl_wave_taps_at(const fl_wave_view *v, int32_t line, double x, double y, fl_wave_taps *p)
{
    const fl_wave_grid *g = v->grid;
    const fl_wave_line *d = &g->line[line];
    const double per = 1.0 / g->h, s = per * (d->x * x + d->y * y), down = (double)(int64_t)s,
                 i = down > s ? down - 1.0 : down, f = s - i, r = 1.0 - f;
    const int64_t place = (int64_t)i - 1, rel = place - FL_WAVE_CHUNK * d->first;
    p->w = (fl_simd){r * r * r / 6.0, 2.0 / 3.0 - f * f * (1.0 - 0.5 * f),
                     2.0 / 3.0 - r * r * (1.0 - 0.5 * r), f * f * f / 6.0};
    p->dw = (fl_simd){-0.5 * r * r, -2.0 * f + 1.5 * f * f, 2.0 * r - 1.5 * r * r, 0.5 * f * f} * per;
    p->ddw = (fl_simd){r, 3.0 * f - 2.0, 3.0 * r - 2.0, f} * (per * per);
    if (v->slot >= 0 && rel >= 0 && rel + 3 < (int64_t)FL_WAVE_CHUNK * d->chunks) {
        p->at = d->table[v->slot] + rel;
        p->stride = (int64_t)FL_WAVE_CHUNK * d->chunks;
        p->outside = 0;
    } else {
        p->at = fl_wave_grid_outside(g, line, v->level, place);
        p->stride = 3 * FL_WAVE_CHUNK;
        p->outside = 1;
    }
}

/* Polynomials of Hermite between two depths: factors of the value and derivative above and below, and those
 * of the derivative. */
typedef struct {
    int32_t j;
    double f[4], df[4];
} fl_wave_depth;

/* zeta <= 0. Below the last depth all factors are 0. */
FL_SIMD_INLINE void fl_wave_depth_at(const fl_wave_grid *g, double zeta, fl_wave_depth *d)
{
    int32_t j = 0;
    while (j + 2 < g->depths && zeta < g->zeta[j + 1]) j++;
    const double width = g->zeta[j + 1] - g->zeta[j], u = (zeta - g->zeta[j]) / width, uu = u * u;
    d->j = j;
    if (u > 1.0) {
        for (int k = 0; k < 4; k++) d->f[k] = d->df[k] = 0.0;
        return;
    }
    d->f[0] = 1.0 - uu * (3.0 - 2.0 * u), d->f[1] = width * (u - uu * (2.0 - u));
    d->f[2] = uu * (3.0 - 2.0 * u), d->f[3] = width * uu * (u - 1.0);
    d->df[0] = -6.0 * (u - uu) / width, d->df[1] = 1.0 - 4.0 * u + 3.0 * uu;
    d->df[2] = 6.0 * (u - uu) / width, d->df[3] = 3.0 * uu - 2.0 * u;
}

/* Numbers at four places, between depths; first: 0 for P, 2 for F. */
FL_SIMD_INLINE void fl_wave_between(const fl_wave_taps *p, const fl_wave_depth *d, int first, fl_simd *value,
                                    fl_simd *dz)
{
    const double *a = p->at + (FL_WAVE_NUMBERS * (int64_t)d->j + first) * p->stride,
                 *b = a + FL_WAVE_NUMBERS * p->stride;
    const fl_simd a0 = FL_SIMD_LOAD(a), a1 = FL_SIMD_LOAD(a + p->stride), b0 = FL_SIMD_LOAD(b),
                  b1 = FL_SIMD_LOAD(b + p->stride);
    *value = (a0 * d->f[0] + a1 * d->f[1]) + (b0 * d->f[2] + b1 * d->f[3]);
    *dz = (a0 * d->df[0] + a1 * d->df[1]) + (b0 * d->df[2] + b1 * d->df[3]);
}

FL_SIMD_INLINE double fl_wave_dot(const fl_simd *a, const fl_simd *b)
{
    const fl_simd c = *a * *b;
    return fl_simd_sum(&c);
}

/* Elevation, its slopes along x and y, dP/dzeta at the surface; its parts by direction d are summed as d d^T.
 */
typedef struct {
    double eta, x, y;
    double zeta, xx, xy, yy;
} fl_wave_surface;

FL_SIMD_INLINE void fl_wave_surface_add(const fl_wave_line *d, const fl_wave_taps *p, fl_wave_surface *a)
{
    const fl_simd value = FL_SIMD_LOAD(p->at), dz = FL_SIMD_LOAD(p->at + p->stride);
    const double slope = fl_wave_dot(&value, &p->dw), zeta = fl_wave_dot(&dz, &p->w);
    a->eta += fl_wave_dot(&value, &p->w);
    a->x += d->x * slope, a->y += d->y * slope;
    a->zeta += zeta;
    a->xx += d->x * d->x * zeta, a->xy += d->x * d->y * zeta, a->yy += d->y * d->y * zeta;
}

FL_SIMD_INLINE void fl_wave_surface_at(const fl_wave_view *v, double x, double y, fl_wave_surface *a)
{
    *a = (fl_wave_surface){0};
    for (int32_t c = 0; c < v->grid->lines; c++) {
        fl_wave_taps p = {0};
        fl_wave_taps_at(v, c, x, y, &p);
        fl_wave_surface_add(&v->grid->line[c], &p, a);
    }
}

/* P below the surface, at a stretched height: its derivatives along x, y at constant zeta, by zeta, and that
 * by zeta in parts d d^T. */
typedef struct {
    double p, x, y;
    double zeta, xx, xy, yy;
} fl_wave_head;

FL_SIMD_INLINE void fl_wave_head_at(const fl_wave_view *v, double x, double y, double zeta, fl_wave_head *a)
{
    fl_wave_depth deep;
    fl_wave_depth_at(v->grid, zeta, &deep);
    *a = (fl_wave_head){0};
    for (int32_t c = 0; c < v->grid->lines; c++) {
        const fl_wave_line *d = &v->grid->line[c];
        fl_wave_taps p = {0};
        fl_simd value, dz;
        fl_wave_taps_at(v, c, x, y, &p);
        fl_wave_between(&p, &deep, 0, &value, &dz);
        const double slope = fl_wave_dot(&value, &p.dw), down = fl_wave_dot(&dz, &p.w);
        a->p += fl_wave_dot(&value, &p.w);
        a->x += d->x * slope, a->y += d->y * slope;
        a->zeta += down;
        a->xx += d->x * d->x * down, a->xy += d->x * d->y * down, a->yy += d->y * d->y * down;
    }
}

/* The same along one line, at a distance s from the position of the taps, small against the places: by
 * Taylor's formula to s^2. */
FL_SIMD_INLINE void fl_wave_head_near(const fl_wave_grid *g, const fl_wave_taps *p, double s, double zeta,
                                      fl_wave_head *a)
{
    const fl_wave_line *d = &g->line[0];
    const fl_simd w = p->w + s * (p->dw + 0.5 * s * p->ddw), dw = p->dw + s * p->ddw;
    fl_wave_depth deep;
    fl_simd value, dz;
    fl_wave_depth_at(g, zeta, &deep);
    fl_wave_between(p, &deep, 0, &value, &dz);
    const double slope = fl_wave_dot(&value, &dw), down = fl_wave_dot(&dz, &w);
    a->p = fl_wave_dot(&value, &w);
    a->x = d->x * slope, a->y = d->y * slope;
    a->zeta = down;
    a->xx = d->x * d->x * down, a->xy = d->x * d->y * down, a->yy = d->y * d->y * down;
}

/* Stretched height of z above still water below the elevation eta, <= 0; *rate: d zeta / d z. */
FL_SIMD_INLINE double fl_wave_grid_stretch(const fl_wave_grid *g, double z, double eta, double *rate)
{
    const double below = z - eta < 0.0 ? z - eta : 0.0;
    *rate = g->water < INFINITY ? g->water / (g->water + eta) : 1.0;
    return below * *rate;
}

/* Velocity of the water at a stretched height [m/s]. */
fl_vec3 fl_wave_velocity(const fl_wave_view *v, double x, double y, double zeta);

#endif
