/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "water/wave_grid.h"
#include <math.h>
#include <omp.h>
#include <string.h>
#include "base/array.h"
#include "base/fast_math.h"
#include "base/pi.h"
#include "base/rng.h"

/* The error at which places and levels have their standard distance. */
#define STANDARD_ERROR 0.003
#define PLACES_PER_LENGTH 12.0
#define LEVELS_PER_PERIOD 32.0 /* half levels: blocks of waves use each second one, or each */
/* First depth and ratio of depths, both at the standard error. */
#define DEPTH_SCALE 0.7
#define DEPTH_RATIO 0.5
/* Amplitude at a depth, over that at the surface, below which a train is left out, and the whole table ends.
 * */
#define DEEP_ENOUGH 1e-7
#define TABLE_END 1e-6
/* k d e^(-2kd) of the bottom has no effect below (wave.c). */
#define MIRROR_TOL 1e-12

/* --- directions ---------------------------------------------------------------------------------- */

/* Angles of 16 directions of equal energy of cos^n; the sin^2 of each is the mean over its part. */
static void spread_angles(double n, double angle[FL_WAVE_DIRECTIONS])
{
    enum { CELLS = 1 << 16 };
    const double d = PI / CELLS;
    double all = 0.0, sum = 0.0, part = 0.0, square = 0.0;
    int at = 0;
    for (int c = 0; c < CELLS; c++) all += pow(cos((c + 0.5) * d - 0.5 * PI), n);
    for (int c = 0; c < CELLS; c++) {
        const double theta = (c + 0.5) * d - 0.5 * PI, e = pow(cos(theta), n) / all;
        sum += e, part += e, square += e * sin(theta) * sin(theta);
        if (c + 1 < CELLS && (at + 1 == FL_WAVE_DIRECTIONS || sum < (at + 1.0) / FL_WAVE_DIRECTIONS))
            continue;
        angle[at] = (2 * at < FL_WAVE_DIRECTIONS ? -1.0 : 1.0) * asin(sqrt(square / part));
        part = square = 0.0;
        if (at + 1 < FL_WAVE_DIRECTIONS) at++;
    }
}

/* Line of train j. */
static int32_t line_of(const fl_wave_grid_form *f, int32_t j)
{
    if (!(f->spread > 0.0)) return 0;
    fl_rng r = fl_rng_of(f->seed, j, FL_RNG_WAVE_DIRECTION);
    return (int32_t)(FL_WAVE_DIRECTIONS * fl_rng_unit(&r));
}

/* --- set-up -------------------------------------------------------------------------------------- */

static int alloc_line(fl_wave_line *d, int32_t n, int32_t depths, int decays, fl_err *err)
{
    d->k = fl_alloc(n, sizeof *d->k, err);
    d->omega = fl_alloc(n, sizeof *d->omega, err);
    d->phase = fl_alloc(n, sizeof *d->phase, err);
    d->turn = fl_alloc(n, sizeof *d->turn, err);
    d->weight = fl_alloc((int64_t)FL_WAVE_NUMBERS * depths * n, sizeof *d->weight, err);
    d->limit = fl_alloc(depths, sizeof *d->limit, err);
    if (decays) d->decay = fl_alloc(n, sizeof *d->decay, err);
    return d->k && d->omega && d->phase && d->turn && d->weight && d->limit && (!decays || d->decay) ? 0 : -1;
}

/* Adds a train to a line that has room for `all`; trains come in ascending k. */
static void add_train(fl_wave_grid *g, fl_wave_line *d, int32_t all, const fl_wave_train *t,
                      const fl_wave_grid_form *f)
{
    const int32_t n = d->n++;
    double c, s;
    d->k[n] = t->k, d->omega[n] = t->omega, d->phase[n] = t->phase;
    if (d->decay)
        d->decay[n] = f->decay[0] * pow(f->thickness, f->decay[1]) * pow(t->omega / (2.0 * PI), f->decay[2]);
    fl_cos_sin(t->k * g->h, &c, &s);
    d->turn[n][0] = c, d->turn[n][1] = s;
    fl_cos_sin(4.0 * t->k * g->h, &d->turn[n][2], &d->turn[n][3]);
    const double a = t->a * 3.0 / (2.0 + c), mirror = t->mirror > MIRROR_TOL ? t->mirror : 0.0;
    for (int32_t j = 0; j < g->depths; j++) {
        const double down = fl_exp(t->k * g->zeta[j]), up = mirror > 0.0 ? mirror / down : 0.0,
                     C = t->norm * (down + up), dC = t->norm * t->k * (down - up),
                     potential = g->gravity / t->omega;
        double *const w = d->weight + (int64_t)FL_WAVE_NUMBERS * j * all + n;
        w[0] = a * C, w[all] = a * dC;
        w[2 * (int64_t)all] = a * potential * C, w[3 * (int64_t)all] = a * potential * dC;
        if (C > DEEP_ENOUGH) d->limit[j] = n + 1;
    }
}

/* Depths from the surface down. */
static void set_depths(fl_wave_grid *g, const fl_waves *w, double q)
{
    const double finer = sqrt(sqrt(q)), r = 1.0 + DEPTH_RATIO / finer, low_k = w->train[0].k;
    double power = 1.0;
    for (g->depths = 0; g->depths < FL_WAVE_DEPTHS; power *= r) {
        const double z = -DEPTH_SCALE / w->max_k * (power - 1.0);
        g->zeta[g->depths++] = z;
        if (g->depths > 2 && (z < -w->depth || fl_exp(low_k * z) < TABLE_END)) break;
    }
}

int fl_wave_grid_make(fl_wave_grid *g, const fl_waves *w, const fl_wave_grid_form *f, int threads,
                      fl_err *err)
{
    const double q = STANDARD_ERROR / f->error, main = atan2(w->direction.y, w->direction.x);
    const fl_wave_train *last = &w->train[w->n - 1];
    double angle[FL_WAVE_DIRECTIONS] = {0};
    int32_t count[FL_WAVE_DIRECTIONS] = {0}, at[FL_WAVE_DIRECTIONS];
    *g = (fl_wave_grid){.threads = threads,
                        .error = f->error,
                        .h = 2.0 * PI / w->max_k / (PLACES_PER_LENGTH * cbrt(q)),
                        .step = 2.0 * PI / last->omega / (LEVELS_PER_PERIOD * sqrt(sqrt(q))),
                        .water = w->depth,
                        .gravity = w->gravity,
                        .edge = f->edge};
    for (int k = 0; k < FL_WAVE_SLOTS; k++) g->level[k] = INT64_MIN;
    set_depths(g, w, q);
    if (f->spread > 0.0) spread_angles(f->spread, angle);
    for (int32_t j = 0; j < w->n; j++) count[line_of(f, j)]++;
    for (int32_t c = 0; c < FL_WAVE_DIRECTIONS; c++) {
        if (count[c] == 0) continue;
        fl_wave_line *d = &g->line[at[c] = g->lines++];
        d->x = f->spread > 0.0 ? cos(main + angle[c]) : w->direction.x;
        d->y = f->spread > 0.0 ? sin(main + angle[c]) : w->direction.y;
        if (alloc_line(d, count[c], g->depths, f->decay[0] > 0.0, err)) goto failed;
    }
    for (int32_t j = 0; j < w->n; j++) {
        const int32_t c = line_of(f, j);
        add_train(g, &g->line[at[c]], count[c], &w->train[j], f);
    }
    g->outside = fl_alloc(threads, sizeof *g->outside, err);
    if (!g->outside) goto failed;
    for (int k = 0; k < threads; k++) {
        g->outside[k].level = INT64_MIN;
        g->outside[k].at =
            fl_alloc((int64_t)3 * FL_WAVE_CHUNK * FL_WAVE_NUMBERS * g->depths, sizeof *g->outside[k].at, err);
        if (!g->outside[k].at) goto failed;
    }
    return 0;
failed:
    fl_wave_grid_free(g);
    return -1;
}

void fl_wave_grid_free(fl_wave_grid *g)
{
    for (int32_t c = 0; c < g->lines; c++) {
        fl_wave_line *d = &g->line[c];
        free(d->k), free(d->omega), free(d->phase), free(d->decay), free(d->turn), free(d->weight),
            free(d->limit);
        for (int k = 0; k < FL_WAVE_SLOTS; k++) free(d->table[k]);
    }
    for (int k = 0; k < g->threads && g->outside; k++) free(g->outside[k].at);
    free(g->outside);
    *g = (fl_wave_grid){0};
}

/* --- tables -------------------------------------------------------------------------------------- */

enum { TRAINS_AT_ONCE = 32, PLACES_AT_ONCE = 16 };
typedef double phasors[TRAINS_AT_ONCE][FL_WAVE_CHUNK];

/* Factor of the amplitude of train n at the places of a chunk. */
static void decay_chunk(const fl_wave_grid *g, double rate, int64_t chunk, double *c, double *s)
{
    for (int i = 0; i < FL_WAVE_CHUNK; i++) {
        const double past = (double)(FL_WAVE_CHUNK * chunk + i) * g->h - g->edge,
                     f = past > 0.0 ? fl_exp(-rate * past) : 1.0;
        c[i] *= f, s[i] *= f;
    }
}

/* Cosine and sine of train n at the places of a chunk: lane l of four turns by 4 k h at a time. */
FL_SIMD_INLINE void turn_chunk(const fl_wave_grid *g, const fl_wave_line *d, int32_t n, double t,
                               int64_t chunk, double *cosine, double *sine)
{
    const double *turn = d->turn[n];
    double c, s;
    fl_simd x, y;
    fl_cos_sin(d->k[n] * ((double)(FL_WAVE_CHUNK * chunk) * g->h) - d->omega[n] * t + d->phase[n], &c, &s);
    for (int l = 0; l < FL_SIMD_WIDTH; l++) {
        x[l] = c, y[l] = s;
        const double next = c * turn[0] - s * turn[1];
        s = s * turn[0] + c * turn[1];
        c = next;
    }
    for (int i = 0; i < FL_WAVE_CHUNK; i += FL_SIMD_WIDTH) {
        FL_SIMD_STORE(cosine + i) = x;
        FL_SIMD_STORE(sine + i) = y;
        const fl_simd next = x * turn[2] - y * turn[3];
        y = y * turn[2] + x * turn[3];
        x = next;
    }
}

/* row[i] += sum_n weight[n] wave[n][i]; begin: the row starts at 0. */
FL_SIMD_INLINE void add_row(double *row, const double *weight, double (*wave)[FL_WAVE_CHUNK], int32_t n,
                            int begin)
{
    for (int i = 0; i < FL_WAVE_CHUNK; i += PLACES_AT_ONCE) {
        const fl_simd zero = {0.0, 0.0, 0.0, 0.0};
        fl_simd a = begin ? zero : FL_SIMD_LOAD(row + i), b = begin ? zero : FL_SIMD_LOAD(row + i + 4),
                c = begin ? zero : FL_SIMD_LOAD(row + i + 8), d = begin ? zero : FL_SIMD_LOAD(row + i + 12);
        for (int32_t k = 0; k < n; k++) {
            a += weight[k] * FL_SIMD_LOAD(&wave[k][i]);
            b += weight[k] * FL_SIMD_LOAD(&wave[k][i + 4]);
            c += weight[k] * FL_SIMD_LOAD(&wave[k][i + 8]);
            d += weight[k] * FL_SIMD_LOAD(&wave[k][i + 12]);
        }
        FL_SIMD_STORE(row + i) = a, FL_SIMD_STORE(row + i + 4) = b;
        FL_SIMD_STORE(row + i + 8) = c, FL_SIMD_STORE(row + i + 12) = d;
    }
}

/* Fills the 64 places of a chunk; the next number is `stride` further. */
FL_SIMD4_VERSIONS static void fill_chunk(const fl_wave_grid *g, const fl_wave_line *d, int64_t level,
                                         int64_t chunk, double *out, int64_t stride)
{
    _Alignas(64) phasors cosine, sine;
    const double t = (double)level * g->step;
    const int beyond = d->decay && (double)(FL_WAVE_CHUNK * (chunk + 1)) * g->h > g->edge;
    for (int32_t first = 0; first < d->n; first += TRAINS_AT_ONCE) {
        const int32_t many = d->n - first < TRAINS_AT_ONCE ? d->n - first : TRAINS_AT_ONCE;
        for (int32_t k = 0; k < many; k++) {
            turn_chunk(g, d, first + k, t, chunk, cosine[k], sine[k]);
            if (beyond) decay_chunk(g, d->decay[first + k], chunk, cosine[k], sine[k]);
        }
        for (int32_t j = 0; j < g->depths; j++) {
            const int32_t left = d->limit[j] - first, n = left < many ? left : many;
            if (n <= 0 && first) break;
            for (int c = 0; c < FL_WAVE_NUMBERS; c++) {
                const int64_t row = FL_WAVE_NUMBERS * j + c;
                add_row(out + row * stride, d->weight + row * d->n + first, c < 2 ? cosine : sine,
                        n > 0 ? n : 0, first == 0);
            }
        }
    }
}

static int64_t chunk_of(const fl_wave_grid *g, double s)
{
    return (int64_t)floor(s / (g->h * FL_WAVE_CHUNK));
}

/* Moves the window of a line to the extent, if it does not fit. Returns 1 if it has moved. */
static int move_window(const fl_wave_grid *g, fl_wave_line *d, double lo, double hi)
{
    const int64_t first = chunk_of(g, lo) - 1, last = chunk_of(g, hi) + 1, n = last - first + 1;
    if (first >= d->first && last < d->first + d->chunks && d->chunks <= 2 * n) return 0;
    d->first = first;
    d->chunks = (int32_t)n;
    return 1;
}

static int reserve_tables(fl_wave_grid *g, int slot, fl_err *err)
{
    for (int32_t c = 0; c < g->lines; c++) {
        fl_wave_line *d = &g->line[c];
        const int64_t want = (int64_t)FL_WAVE_CHUNK * d->chunks * FL_WAVE_NUMBERS * g->depths;
        if (want <= d->room[slot]) continue;
        free(d->table[slot]);
        d->room[slot] = 0;
        d->table[slot] = fl_alloc(want, sizeof(double), err);
        if (!d->table[slot]) return -1;
        d->room[slot] = want;
    }
    return 0;
}

static void fill_tables(fl_wave_grid *g, const int *slot, int slots, int threads)
{
    int64_t all = 0;
    for (int32_t c = 0; c < g->lines; c++) all += g->line[c].chunks;
#pragma omp parallel for schedule(dynamic) num_threads(threads) if (threads > 1)
    for (int64_t k = 0; k < all * slots; k++) {
        int64_t at = k % all;
        const int to = slot[k / all];
        int32_t c = 0;
        while (at >= g->line[c].chunks) at -= g->line[c++].chunks;
        const fl_wave_line *d = &g->line[c];
        fill_chunk(g, d, g->level[to], d->first + at, d->table[to] + FL_WAVE_CHUNK * at,
                   (int64_t)FL_WAVE_CHUNK * d->chunks);
    }
}

int fl_wave_grid_fill(fl_wave_grid *g, const fl_wave_extent *at, int64_t first, int every, int many,
                      int threads, fl_err *err)
{
    int moved = 0, fresh[FL_WAVE_SLOTS], n = 0;
    for (int32_t c = 0; c < g->lines; c++) moved |= move_window(g, &g->line[c], at->lo[c], at->hi[c]);
    for (int k = 0; k < FL_WAVE_SLOTS; k++) {
        const int64_t past = g->level[k] - first;
        if (moved || g->level[k] < first || past % every || past / every >= many) g->level[k] = INT64_MIN;
    }
    for (int c = 0; c < many; c++) {
        int slot = 0;
        if (fl_wave_grid_view(g, first + (int64_t)every * c).slot >= 0) continue;
        while (slot + 1 < FL_WAVE_SLOTS && g->level[slot] != INT64_MIN) slot++;
        if (reserve_tables(g, slot, err)) return -1;
        g->level[slot] = first + (int64_t)every * c;
        fresh[n++] = slot;
    }
    if (n) fill_tables(g, fresh, n, threads);
    return 0;
}

double fl_wave_grid_bytes(const fl_wave_grid *g)
{
    double sum = 0.0;
    for (int32_t c = 0; c < g->lines; c++)
        for (int k = 0; k < FL_WAVE_SLOTS; k++) sum += 8.0 * (double)g->line[c].room[k];
    return sum;
}

/* --- evaluation ---------------------------------------------------------------------------------- */

fl_wave_view fl_wave_grid_view(const fl_wave_grid *g, int64_t level)
{
    fl_wave_view v = {.grid = g, .level = level, .slot = -1};
    for (int k = 0; k < FL_WAVE_SLOTS; k++)
        if (g->level[k] == level) v.slot = k;
    return v;
}

const double *fl_wave_grid_outside(const fl_wave_grid *g, int32_t line, int64_t level, int64_t place)
{
    fl_wave_outside *const a = &g->outside[omp_get_thread_num()];
    const int64_t chunk =
        (place >= 0 ? place : place - (FL_WAVE_CHUNK - 1)) / FL_WAVE_CHUNK - 1; /* before that of place */
    if (a->level != level || a->line != line || a->chunk != chunk) {
        for (int k = 0; k < 3; k++)
            fill_chunk(g, &g->line[line], level, chunk + k, a->at + FL_WAVE_CHUNK * k, 3 * FL_WAVE_CHUNK);
        a->level = level, a->line = line, a->chunk = chunk;
    }
    return a->at + (place - FL_WAVE_CHUNK * chunk);
}

fl_vec3 fl_wave_velocity(const fl_wave_view *v, double x, double y, double zeta)
{
    fl_vec3 u = v3(0, 0, 0);
    fl_wave_depth deep;
    fl_wave_depth_at(v->grid, zeta, &deep);
    for (int32_t c = 0; c < v->grid->lines; c++) {
        const fl_wave_line *d = &v->grid->line[c];
        fl_wave_taps p = {0};
        fl_simd value, dz;
        fl_wave_taps_at(v, c, x, y, &p);
        fl_wave_between(&p, &deep, 2, &value, &dz);
        const double along = fl_wave_dot(&value, &p.dw);
        u = v3_add(u, v3(d->x * along, d->y * along, fl_wave_dot(&dz, &p.w)));
    }
    return u;
}
