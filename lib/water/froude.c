/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/mem.h"
#include "water/froude.h"

/* Longest side of a panel, in 1/k, and up to what size of a body the rule of degree 2 will do.  Boxes of 2 to
 * 60 m in waves of 14 m and in seas then feel forces right to 3e-4 of their mean (verify_waves); 2 and 0.1
 * would cost up to twice the time for 5e-6, and 5 leaves 4e-3. */
#define LONGEST 3.0
#define SMALL 0.3

/* Half of a cell, in 1/k_top: its corner is 7.07 away, which leaves room for crests below FL_WAVE_REACH. */
#define HALF 5.0

/* --- panels ------------------------------------------------------------------------------------ */

typedef struct {
    fl_tiles *p;
    int32_t face_cap, v_cap;
    double longest;
} cutter;

static int keep(cutter *c, int32_t face, const fl_vec3 v[3], fl_err *err)
{
    if (fl_grow(&c->p->face, &c->face_cap, (int64_t)c->p->n + 1, sizeof *c->p->face, err) ||
        fl_grow(&c->p->v, &c->v_cap, 3 * ((int64_t)c->p->n + 1), sizeof *c->p->v, err))
        return -1;
    c->p->face[c->p->n] = face;
    for (int k = 0; k < 3; k++) c->p->v[3 * (int64_t)c->p->n + k] = v[k];
    c->p->n++;
    return 0;
}

/* Halve the longest side until none is too long. */
static int cut(cutter *c, int32_t face, fl_vec3 a, fl_vec3 b, fl_vec3 d, fl_err *err)
{
    const fl_vec3 v[3] = {a, b, d};
    double most = 0.0;
    int at = 0;
    for (int k = 0; k < 3; k++) {
        const double len = v3_norm(v3_sub(v[(k + 1) % 3], v[k]));
        if (len > most) {
            most = len;
            at = k;
        }
    }
    if (most <= c->longest) return keep(c, face, v, err);
    const fl_vec3 x = v[at], y = v[(at + 1) % 3], z = v[(at + 2) % 3], m = v3_lerp(x, y, 0.5);
    return cut(c, face, x, m, z, err) || cut(c, face, m, y, z, err) ? -1 : 0;
}

int fl_tiles_make(fl_tiles *t, const fl_hull *hull, const fl_waves *w, fl_err *err)
{
    cutter c = {.p = t, .longest = LONGEST / w->most};
    const fl_poly *q = hull->p;
    fl_tiles_free(t);
    t->fine = q->size * w->most > SMALL;
    for (int32_t f = 0; f < q->nf; f++) {
        const int32_t *at = q->loop + q->first[f], m = q->first[f + 1] - q->first[f];
        for (int32_t k = 1; k + 1 < m; k++)
            if (cut(&c, f, q->v[at[0]], q->v[at[k]], q->v[at[k + 1]], err)) return -1;
    }
    return 0;
}

void fl_tiles_free(fl_tiles *t)
{
    free(t->face), free(t->v);
    *t = (fl_tiles){0};
}

/* --- the wave around a body -------------------------------------------------------------------- */

int32_t fl_wave_cells(const fl_waves *w, double reach)
{
    const double across = ceil(reach * w->top / HALF) + 1.0;
    return (int32_t)fmin(across * (across + 2.0), INT32_MAX);
}

void fl_wave_surround(const fl_waves *w, double s_lo, double s_hi, double z_lo, double z_hi, double t,
                      fl_wave_near *cell, fl_wave_around *a)
{
    const double most = HALF / w->top, low = fmin(z_lo, 0.0), high = fmin(z_hi, 0.0);
    a->columns = (int)ceil(0.5 * (s_hi - s_lo) / most);
    if (a->columns < 1) a->columns = 1;
    a->width = (s_hi - s_lo) / a->columns;
    a->s0 = s_lo;
    a->half = most;
    /* the first row is the surface's; row r below it is centred 2 r halves down */
    a->row0 = (int)fmax(1.0, floor((-high + most) / (2.0 * most)));
    const int last = (int)floor((-low + most) / (2.0 * most));
    a->rows = last >= a->row0 ? last - a->row0 + 1 : 0;
    a->cell = cell;
    for (int c = 0; c < a->columns; c++) {
        const double s = s_lo + (c + 0.5) * a->width, wide = 0.5 * a->width, tall = fmin(-low, most);
        fl_wave_look(w, s, 0.0, sqrt(wide * wide + tall * tall), t, cell++);
        for (int r = 0; r < a->rows; r++)
            fl_wave_look(w, s, -2.0 * most * (a->row0 + r), sqrt(wide * wide + most * most), t, cell++);
    }
}

static const fl_wave_near *column(const fl_wave_around *a, double s)
{
    if (a->columns == 1) return a->cell;
    const double at = floor((s - a->s0) / a->width);
    const int c = at < 0.0 ? 0 : at >= a->columns ? a->columns - 1 : (int)at;
    return a->cell + (int64_t)c * (1 + a->rows);
}

double fl_wave_over(const fl_wave_around *a, double s, double *slope)
{
    return fl_wave_elevation(column(a, s), s, slope);
}

const fl_wave_near *fl_wave_at(const fl_wave_around *a, double s, double zeta)
{
    const fl_wave_near *top = column(a, s);
    if (a->rows == 0) return top;
    const int row = (int)floor((-zeta + a->half) / (2.0 * a->half)) - a->row0;
    if (row < 0) return -zeta <= a->half || a->row0 > 1 ? top : top + 1;
    return top + 1 + (row < a->rows ? row : a->rows - 1);
}

void fl_wave_plane(const fl_wave_around *a, const fl_afloat *at, fl_vec3 *up, double *level)
{
    double slope;
    const double eta = fl_wave_over(a, at->s, &slope), c = 1.0 / sqrt(1.0 + slope * slope);
    *up = v3_scale(c, v3_madd(at->up, -slope, at->along));
    *level = c * (eta - at->z);
}

/* --- the sums ---------------------------------------------------------------------------------- */

/* Radon's rule of degree 5 and the rule of degree 2 with points inside: weights and the coordinates of the
 * first corner; the other two share the rest. */
#define SQRT15 3.872983346207417
static const double FIVE[2][2] = {{(155.0 - SQRT15) / 1200.0, (9.0 + 2.0 * SQRT15) / 21.0},
                                  {(155.0 + SQRT15) / 1200.0, (9.0 - 2.0 * SQRT15) / 21.0}};

typedef struct {
    const fl_waves *w;
    const fl_wave_around *a;
    const fl_afloat *at;
    fl_vec3 force, moment, first; /* int p n, int x x p n over rho g; int x (z - eta) n_z */
    double volume, height, wetted;
} sums;

static void point(sums *S, fl_vec3 n, double nz, fl_vec3 x, double area, double z, double eta, double head)
{
    const double p = area * (head - z), v = area * (z - eta) * nz;
    const fl_vec3 f = v3_scale(p, n);
    S->force = v3_sub(S->force, f);
    S->moment = v3_sub(S->moment, v3_cross(x, f));
    S->volume += v;
    S->first = v3_madd(S->first, v, x);
    S->height += 0.5 * v * (z + eta);
    S->wetted += area;
}

/* The cell of the surface that all m points lie in, NULL where there is none. */
static const fl_wave_near *shared_cell(const sums *S, int m, const double *s, const double *z)
{
    const fl_wave_near *cell = column(S->a, s[0]);
    for (int j = 1; j < m; j++)
        if (column(S->a, s[j]) != cell) return NULL;
    for (int j = 0; S->a->rows && j < m; j++)
        if (z[j] - S->w->swing < -S->a->half) return NULL;
    return cell;
}

static void triangle(sums *S, int fine, fl_vec3 n, double nz, fl_vec3 a, fl_vec3 b, fl_vec3 c)
{
    const double area = 0.5 * v3_dot(n, v3_cross(v3_sub(b, a), v3_sub(c, a)));
    const fl_vec3 v[3] = {a, b, c};
    fl_vec3 x[FL_WAVE_BATCH];
    double part[FL_WAVE_BATCH], s[FL_WAVE_BATCH] = {0}, z[FL_WAVE_BATCH] = {0}, eta[FL_WAVE_BATCH],
                                head[FL_WAVE_BATCH];
    int m = 0;
    if (fine) {
        x[m] = v3_scale(1.0 / 3.0, v3_add(a, v3_add(b, c)));
        part[m++] = 9.0 / 40.0;
    }
    for (int r = 0; r < (fine ? 2 : 1); r++) {
        const double own = fine ? FIVE[r][1] : 2.0 / 3.0, other = 0.5 * (1.0 - own);
        for (int k = 0; k < 3; k++) {
            x[m] = v3_madd(v3_scale(own, v[k]), other, v3_add(v[(k + 1) % 3], v[(k + 2) % 3]));
            part[m++] = fine ? FIVE[r][0] : 1.0 / 3.0;
        }
    }
    for (int j = 0; j < m; j++) {
        s[j] = S->at->s + v3_dot(S->at->along, x[j]);
        z[j] = S->at->z + v3_dot(S->at->up, x[j]);
    }
    for (int j = m; j < FL_WAVE_BATCH; j++) s[j] = s[0], z[j] = z[0];
    const fl_wave_near *one = shared_cell(S, m, s, z);
    if (one) {
        fl_wave_heads(S->w, one, s, z, eta, head);
    } else {
        for (int j = 0; j < m; j++) {
            eta[j] = fl_wave_over(S->a, s[j], NULL);
            const double zeta = fl_wave_stretch(S->w, z[j], eta[j]);
            head[j] = fl_wave_pressure(fl_wave_at(S->a, s[j], zeta), s[j], zeta);
        }
    }
    for (int j = 0; j < m; j++) point(S, n, nz, x[j], part[j] * area, z[j], eta[j], head[j]);
}

/* The part of a panel below the wave: h[k] are the heights of its corners over the wave, in between they go
 * straight. */
static void panel(sums *S, int fine, fl_vec3 n, double nz, const fl_vec3 *v, const double *h)
{
    fl_vec3 out[4];
    int m = 0;
    for (int k = 0; k < 3; k++) {
        const int j = (k + 1) % 3;
        if (h[k] <= 0.0) out[m++] = v[k];
        if ((h[k] <= 0.0) != (h[j] <= 0.0)) /* from the wet end, as the neighbour across the side does */
            out[m++] = h[k] <= 0.0 ? v3_lerp(v[k], v[j], h[k] / (h[k] - h[j]))
                                   : v3_lerp(v[j], v[k], h[j] / (h[j] - h[k]));
    }
    for (int k = 1; k + 1 < m; k++) triangle(S, fine, n, nz, out[0], out[k], out[k + 1]);
}

void fl_froude_solid(const fl_tiles *tiles, const fl_hull *h, const fl_waves *w, const fl_wave_around *a,
                     const fl_afloat *at, double weight, fl_push *push)
{
    sums S = {.w = w, .a = a, .at = at};
    for (int64_t k = 0; k < tiles->n; k++) {
        const fl_vec3 n = h->p->n[tiles->face[k]], *v = tiles->v + 3 * k;
        const double nz = v3_dot(n, at->up);
        double over[3], low = INFINITY;
        for (int c = 0; c < 3; c++) {
            over[c] = at->z + v3_dot(at->up, v[c]);
            low = fmin(low, over[c]);
        }
        if (low >= w->crest) continue;
        for (int c = 0; c < 3; c++) over[c] -= fl_wave_over(a, at->s + v3_dot(at->along, v[c]), NULL);
        panel(&S, tiles->fine, n, nz, v, over);
    }
    *push = (fl_push){.force = v3_scale(weight, S.force),
                      .moment = v3_scale(weight, S.moment),
                      .volume = S.volume > 0.0 ? S.volume : 0.0,
                      .wetted = S.wetted};
    if (!(S.volume > 0.0)) return;
    /* the sum is right along the water; up it takes the place of what the height says */
    const fl_vec3 c = v3_scale(1.0 / S.volume, S.first);
    push->centre = v3_madd(c, S.height / S.volume - at->z - v3_dot(at->up, c), at->up);
}

void fl_froude_round(const fl_hull *h, const fl_waves *w, const fl_wave_around *a, const fl_afloat *at,
                     double weight, fl_push *push)
{
    fl_vec3 up;
    double level, u[2], acc[2];
    fl_wet wet;
    fl_wave_plane(a, at, &up, &level);
    fl_buoyancy(h, up, level, &wet);
    *push = (fl_push){.volume = wet.volume, .centre = wet.centre, .wetted = wet.wetted};
    if (!(wet.volume > 0.0)) return;
    const double s = at->s + v3_dot(at->along, wet.centre), z = at->z + v3_dot(at->up, wet.centre),
                 zeta = fl_wave_stretch(w, z, fl_wave_over(a, s, NULL));
    fl_wave_motion(w, fl_wave_at(a, s, zeta), s, zeta, u, acc);
    const double m = weight * wet.volume;
    push->force =
        v3_madd(v3_scale(m * (1.0 + acc[1] / w->gravity), at->up), m * acc[0] / w->gravity, at->along);
    push->moment = v3_cross(wet.centre, push->force);
}
