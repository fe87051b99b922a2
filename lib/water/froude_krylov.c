/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/array.h"
#include "base/pi.h"
#include "base/simd.h"
#include "water/froude_krylov.h"

/* Longest side of a panel, and largest body for which the rule of degree 2 is used, both in 1/k. The forces
 * on boxes of 2 to 60 m in waves of 14 m, and in irregular waves, are then within 3e-4 of their mean
 * (verify_waves). 2 and 0.1 would reach 5e-6 at up to twice the time; 5 leaves 4e-3. */
#define MAX_SIDE 3.0
#define SMALL_BODY 0.3

/* Half a cell, in 1/max_k: its corner is 7.07 away, which leaves room for crests below FL_WAVE_REACH. */
#define HALF_CELL 5.0

/* --- panels ------------------------------------------------------------------------------------ */

typedef struct {
    fl_hull_panels *p;
    int32_t face_cap, v_cap;
    double longest, wave, size; /* of a side, of the waves, of the floe [m] */
} panel_cutter;

static int add_panel(panel_cutter *c, int32_t face, const fl_vec3 v[3], fl_err *err)
{
    if (c->p->n == FL_HULL_PANELS_MAX)
        return fl_fail(
            err, FL_INPUT,
            "water.period: in waves of %.3g m a floe of %.3g m would be cut into more than %d panels",
            c->wave, c->size, FL_HULL_PANELS_MAX);
    if (fl_grow(&c->p->face, &c->face_cap, (int64_t)c->p->n + 1, sizeof *c->p->face, err) ||
        fl_grow(&c->p->v, &c->v_cap, 3 * ((int64_t)c->p->n + 1), sizeof *c->p->v, err))
        return -1;
    c->p->face[c->p->n] = face;
    for (int k = 0; k < 3; k++) c->p->v[3 * (int64_t)c->p->n + k] = v[k];
    c->p->n++;
    return 0;
}

/* Halves the longest side until none is too long. */
static int split_triangle(panel_cutter *c, int32_t face, fl_vec3 a, fl_vec3 b, fl_vec3 d, fl_err *err)
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
    if (most <= c->longest) return add_panel(c, face, v, err);
    const fl_vec3 x = v[at], y = v[(at + 1) % 3], z = v[(at + 2) % 3], m = v3_lerp(x, y, 0.5);
    return split_triangle(c, face, x, m, z, err) || split_triangle(c, face, m, y, z, err) ? -1 : 0;
}

int fl_hull_panels_make(fl_hull_panels *t, const fl_hull *hull, const fl_waves *w, fl_err *err)
{
    const fl_poly *q = hull->shape;
    panel_cutter c = {.p = t, .longest = MAX_SIDE / w->k95, .wave = 2.0 * PI / w->k95, .size = q->size};
    fl_hull_panels_free(t);
    t->degree5 = q->size * w->k95 > SMALL_BODY;
    for (int32_t f = 0; f < q->nf; f++) {
        const int32_t *at = q->loop + q->first[f], m = q->first[f + 1] - q->first[f];
        for (int32_t k = 1; k + 1 < m; k++)
            if (split_triangle(&c, f, q->v[at[0]], q->v[at[k]], q->v[at[k + 1]], err)) return -1;
    }
    return 0;
}

void fl_hull_panels_free(fl_hull_panels *t)
{
    free(t->face), free(t->v);
    *t = (fl_hull_panels){0};
}

/* --- the wave around a body -------------------------------------------------------------------- */

int32_t fl_wave_field_cells(const fl_waves *w, double reach)
{
    const double across = ceil(reach * w->max_k / HALF_CELL) + 1.0;
    return (int32_t)fmin(across * (across + 2.0), INT32_MAX);
}

void fl_wave_field_fill(const fl_waves *w, double s_lo, double s_hi, double z_lo, double z_hi, double t,
                        fl_wave_expansion *cell, fl_wave_field *a)
{
    const double most = HALF_CELL / w->max_k, low = fmin(z_lo, 0.0), high = fmin(z_hi, 0.0);
    a->columns = (int)ceil(0.5 * (s_hi - s_lo) / most);
    if (a->columns < 1) a->columns = 1;
    a->width = (s_hi - s_lo) / a->columns;
    a->s0 = s_lo;
    a->half = most;
    /* row 0 is that of the surface; row r is centred 2 r halves below it */
    a->row0 = (int)fmax(1.0, floor((-high + most) / (2.0 * most)));
    const int last = (int)floor((-low + most) / (2.0 * most));
    a->rows = last >= a->row0 ? last - a->row0 + 1 : 0;
    a->cell = cell;
    for (int c = 0; c < a->columns; c++) {
        const double s = s_lo + (c + 0.5) * a->width, wide = 0.5 * a->width, tall = fmin(-low, most);
        fl_wave_expand(w, s, 0.0, sqrt(wide * wide + tall * tall), t, cell++);
        for (int r = 0; r < a->rows; r++)
            fl_wave_expand(w, s, -2.0 * most * (a->row0 + r), sqrt(wide * wide + most * most), t, cell++);
    }
}

static const fl_wave_expansion *column_cell(const fl_wave_field *a, double s)
{
    if (a->columns == 1) return a->cell;
    const double at = floor((s - a->s0) / a->width);
    const int c = at < 0.0 ? 0 : at >= a->columns ? a->columns - 1 : (int)at;
    return a->cell + (int64_t)c * (1 + a->rows);
}

double fl_wave_field_elevation(const fl_wave_field *a, double s, double *slope)
{
    return fl_wave_elevation(column_cell(a, s), s, slope);
}

const fl_wave_expansion *fl_wave_field_cell(const fl_wave_field *a, double s, double zeta)
{
    const fl_wave_expansion *top = column_cell(a, s);
    if (a->rows == 0) return top;
    const int row = (int)floor((-zeta + a->half) / (2.0 * a->half)) - a->row0;
    if (row < 0) return -zeta <= a->half || a->row0 > 1 ? top : top + 1;
    return top + 1 + (row < a->rows ? row : a->rows - 1);
}

void fl_wave_field_plane(const fl_wave_field *a, const fl_hull_pose *at, fl_vec3 *up, double *level)
{
    double slope;
    const double eta = fl_wave_field_elevation(a, at->s, &slope), c = 1.0 / sqrt(1.0 + slope * slope);
    *up = v3_scale(c, v3_madd(at->up, -slope, at->along));
    *level = c * (eta - at->z);
}

/* --- the sums ---------------------------------------------------------------------------------- */

/* Radon's rule of degree 5, and the rule of degree 2 with interior points: weights, and barycentric
 * coordinates of each point. Unused points of a batch have weight 0. */
#define SQRT15 3.872983346207417
#define W1 ((155.0 - SQRT15) / 1200.0)
#define W2 ((155.0 + SQRT15) / 1200.0)
#define O1 ((9.0 + 2.0 * SQRT15) / 21.0)
#define O2 ((9.0 - 2.0 * SQRT15) / 21.0)
#define R1 (0.5 * (1.0 - O1))
#define R2 (0.5 * (1.0 - O2))
#define T (1.0 / 3.0)
#define S (1.0 / 6.0)
static const double RULE[2][4][FL_WAVE_BATCH] = {{{T, T, T, 0, 0, 0, 0, 0},
                                                  {4 * S, S, S, T, T, T, T, T},
                                                  {S, 4 * S, S, T, T, T, T, T},
                                                  {S, S, 4 * S, T, T, T, T, T}},
                                                 {{9.0 / 40.0, W1, W1, W1, W2, W2, W2, 0},
                                                  {T, O1, R1, R1, O2, R2, R2, T},
                                                  {T, R1, O1, R1, R2, O2, R2, T},
                                                  {T, R1, R1, O1, R2, R2, O2, T}}};
#undef S
#undef T
static const int POINTS[2] = {3, 7};
/* Sums kept per lane. */
typedef double lanes[FL_SIMD_WIDTH];

typedef struct {
    const fl_waves *w;
    const fl_wave_field *a;
    const fl_hull_pose *at;
    fl_vec3 force, moment;                  /* int p n, int x x p n over rho g */
    lanes first[3], volume, height, wetted; /* int x (z - eta) n_z, ... */
} load_sums;

/* The surface cell that contains all m points, or NULL. */
static const fl_wave_expansion *common_cell(const load_sums *S, int m, const double *s, const double *z)
{
    const fl_wave_expansion *cell = column_cell(S->a, s[0]);
    if (S->a->columns == 1 && S->a->rows == 0) return cell;
    for (int j = 1; j < m && S->a->columns > 1; j++)
        if (column_cell(S->a, s[j]) != cell) return NULL;
    for (int j = 0; S->a->rows && j < m; j++)
        if (z[j] - S->w->four_sigma < -S->a->half) return NULL;
    return cell;
}

/* Quadrature points of a triangle: body axes, along the wave, and above still water. */
typedef struct {
    double x[3][FL_WAVE_BATCH], s[FL_WAVE_BATCH], z[FL_WAVE_BATCH];
} quadrature_points;

FL_SIMD_INLINE void place_points(const fl_hull_pose *at, int fine, fl_vec3 a, fl_vec3 b, fl_vec3 c,
                                 quadrature_points *p)
{
    const double(*rule)[FL_WAVE_BATCH] = RULE[fine];
    for (int k = 0; k < FL_WAVE_BATCH; k += FL_SIMD_WIDTH) {
        const fl_simd ca = FL_SIMD_LOAD(&rule[1][k]), cb = FL_SIMD_LOAD(&rule[2][k]),
                      cc = FL_SIMD_LOAD(&rule[3][k]), x = ca * a.x + cb * b.x + cc * c.x,
                      y = ca * a.y + cb * b.y + cc * c.y, z = ca * a.z + cb * b.z + cc * c.z;
        FL_SIMD_STORE(&p->x[0][k]) = x;
        FL_SIMD_STORE(&p->x[1][k]) = y;
        FL_SIMD_STORE(&p->x[2][k]) = z;
        FL_SIMD_STORE(&p->s[k]) = at->s + (at->along.x * x + at->along.y * y + at->along.z * z);
        FL_SIMD_STORE(&p->z[k]) = at->z + (at->up.x * x + at->up.y * y + at->up.z * z);
    }
}

/* Adds the loads: the pressure head (head - z) times the area acts at each point along -n. */
FL_SIMD_INLINE void add_loads(load_sums *S, const quadrature_points *p, int fine, double area, fl_vec3 n,
                              double nz, const double *eta, const double *head)
{
    fl_simd pressure = {0.0, 0.0, 0.0, 0.0}, arm[3] = {pressure, pressure, pressure};
    for (int k = 0; k < FL_WAVE_BATCH; k += FL_SIMD_WIDTH) {
        const fl_simd part = area * FL_SIMD_LOAD(&RULE[fine][0][k]), z = FL_SIMD_LOAD(&p->z[k]),
                      e = FL_SIMD_LOAD(&eta[k]), f = part * (FL_SIMD_LOAD(&head[k]) - z),
                      v = part * (z - e) * nz;
        pressure += f;
        FL_SIMD_UNROLL for (int c = 0; c < 3; c++)
        {
            const fl_simd x = FL_SIMD_LOAD(&p->x[c][k]);
            arm[c] += f * x;
            FL_SIMD_STORE(S->first[c]) += v * x;
        }
        FL_SIMD_STORE(S->volume) += v;
        FL_SIMD_STORE(S->height) += 0.5 * v * (z + e);
        FL_SIMD_STORE(S->wetted) += part;
    }
    S->force = v3_madd(S->force, -fl_simd_sum(&pressure), n);
    S->moment =
        v3_sub(S->moment, v3_cross(v3(fl_simd_sum(&arm[0]), fl_simd_sum(&arm[1]), fl_simd_sum(&arm[2])), n));
}

FL_SIMD4_VERSIONS static void integrate_triangle(load_sums *S, int fine, fl_vec3 n, double nz,
                                                 const fl_vec3 *at_a, const fl_vec3 *at_b,
                                                 const fl_vec3 *at_c)
{
    const fl_vec3 a = *at_a, b = *at_b, c = *at_c;
    const double area = 0.5 * v3_dot(n, v3_cross(v3_sub(b, a), v3_sub(c, a)));
    quadrature_points p;
    double eta[FL_WAVE_BATCH], head[FL_WAVE_BATCH];
    place_points(S->at, fine, a, b, c, &p);
    const fl_wave_expansion *one = common_cell(S, POINTS[fine], p.s, p.z);
    if (one) {
        fl_wave_pressure_batch(S->w, one, p.s, p.z, eta, head);
    } else {
        for (int j = 0; j < FL_WAVE_BATCH; j++) eta[j] = head[j] = 0.0;
        for (int j = 0; j < POINTS[fine]; j++) {
            eta[j] = fl_wave_field_elevation(S->a, p.s[j], NULL);
            const double zeta = fl_wave_stretch(S->w, p.z[j], eta[j]);
            head[j] = fl_wave_pressure(fl_wave_field_cell(S->a, p.s[j], zeta), p.s[j], zeta);
        }
    }
    add_loads(S, &p, fine, area, n, nz, eta, head);
}

/* Integrates the part of a panel below the wave. h[k]: heights of its corners above the wave, linear in
 * between. */
static void integrate_panel(load_sums *S, int fine, fl_vec3 n, double nz, const fl_vec3 *v, const double *h)
{
    fl_vec3 out[4];
    int m = 0;
    for (int k = 0; k < 3; k++) {
        const int j = (k + 1) % 3;
        if (h[k] <= 0.0) out[m++] = v[k];
        if ((h[k] <= 0.0) != (h[j] <= 0.0)) /* from the wet end, as across the side */
            out[m++] = h[k] <= 0.0 ? v3_lerp(v[k], v[j], h[k] / (h[k] - h[j]))
                                   : v3_lerp(v[j], v[k], h[j] / (h[j] - h[k]));
    }
    for (int k = 1; k + 1 < m; k++) integrate_triangle(S, fine, n, nz, &out[0], &out[k], &out[k + 1]);
}

/* Panels whose corners are evaluated side by side. */
enum { PANELS_AT_ONCE = FL_SIMD_WIDTH, CORNERS = 3 * PANELS_AT_ONCE };

/* Heights of their corners above the wave, all in one cell. */
FL_SIMD4_VERSIONS static void corner_heights(const fl_wave_expansion *one, const fl_hull_pose *at,
                                             const fl_vec3 *v, double *over)
{
    const fl_simd zero = {0.0, 0.0, 0.0, 0.0};
    fl_simd s[3], z[3], eta[3] = {zero, zero, zero};
    FL_SIMD_UNROLL for (int k = 0; k < 3; k++)
    {
        fl_simd x[3];
        fl_simd_from_triples(x, v + FL_SIMD_WIDTH * k);
        s[k] = at->s + (at->along.x * x[0] + at->along.y * x[1] + at->along.z * x[2]) - one->s;
        z[k] = at->z + (at->up.x * x[0] + at->up.y * x[1] + at->up.z * x[2]);
    }
    for (int m = one->terms - 1; m >= 0; m--) {
        const double c = one->eta[m];
        FL_SIMD_UNROLL for (int k = 0; k < 3; k++) eta[k] = eta[k] * s[k] + c;
    }
    FL_SIMD_UNROLL for (int k = 0; k < 3; k++) FL_SIMD_STORE(over + FL_SIMD_WIDTH * k) = z[k] - eta[k];
}

/* The same for corners in any cells. */
static void heights_over_wave(const fl_wave_field *a, const fl_hull_pose *at, const fl_vec3 *v, double *over)
{
    double s[CORNERS];
    int same = 1;
    for (int c = 0; c < CORNERS && a->columns > 1; c++) {
        s[c] = at->s + v3_dot(at->along, v[c]);
        same = same && column_cell(a, s[c]) == column_cell(a, s[0]);
    }
    if (same) {
        corner_heights(a->columns > 1 ? column_cell(a, s[0]) : a->cell, at, v, over);
        return;
    }
    for (int c = 0; c < CORNERS; c++)
        over[c] = at->z + v3_dot(at->up, v[c]) - fl_wave_field_elevation(a, s[c], NULL);
}

/* Fills up an incomplete group of panels with its first corner. */
static const fl_vec3 *pad_panels(fl_vec3 *to, const fl_vec3 *v, int many)
{
    for (int c = 0; c < CORNERS; c++) to[c] = v[c < 3 * many ? c : 0];
    return to;
}

static double sum_lanes(const double *a) { return (a[0] + a[2]) + (a[1] + a[3]); }

/* The nearest point of the bounding box of a body. For a volume hardly larger than the error by the curvature
 * of the wave within a panel, the computed centre can lie anywhere. */
static fl_vec3 clamp_to_box(const fl_poly *p, fl_vec3 x)
{
    fl_vec3 lo = p->v[0], hi = p->v[0];
    for (int32_t k = 1; k < p->nv; k++) {
        const fl_vec3 v = p->v[k];
        lo = v3(v.x < lo.x ? v.x : lo.x, v.y < lo.y ? v.y : lo.y, v.z < lo.z ? v.z : lo.z);
        hi = v3(v.x > hi.x ? v.x : hi.x, v.y > hi.y ? v.y : hi.y, v.z > hi.z ? v.z : hi.z);
    }
    return v3(fmin(fmax(x.x, lo.x), hi.x), fmin(fmax(x.y, lo.y), hi.y), fmin(fmax(x.z, lo.z), hi.z));
}

void fl_froude_krylov_solid(const fl_hull_panels *tiles, const fl_hull *h, const fl_waves *w,
                            const fl_wave_field *a, const fl_hull_pose *at, double weight,
                            fl_water_load *push)
{
    load_sums S = {.w = w, .a = a, .at = at};
    for (int32_t first = 0; first < tiles->n; first += PANELS_AT_ONCE) {
        const int many = tiles->n - first < PANELS_AT_ONCE ? tiles->n - first : PANELS_AT_ONCE;
        const fl_vec3 *v = tiles->v + 3 * (int64_t)first;
        fl_vec3 rest[CORNERS];
        double over[CORNERS];
        if (many < PANELS_AT_ONCE) v = pad_panels(rest, v, many);
        heights_over_wave(a, at, v, over);
        for (int k = 0; k < many; k++) {
            const fl_vec3 n = h->shape->n[tiles->face[first + k]];
            const double *const o = over + 3 * k;
            if (o[0] <= 0.0 || o[1] <= 0.0 || o[2] <= 0.0)
                integrate_panel(&S, tiles->degree5, n, v3_dot(n, at->up), v + 3 * k, o);
        }
    }
    const double volume = sum_lanes(S.volume);
    *push = (fl_water_load){.force = v3_scale(weight, S.force),
                            .moment = v3_scale(weight, S.moment),
                            .volume = volume > 0.0 ? volume : 0.0,
                            .wetted = sum_lanes(S.wetted)};
    if (!(volume > 0.0)) return;
    /* the sum is right along the water; the vertical part is replaced by that of the heights */
    const fl_vec3 c =
        v3_scale(1.0 / volume, v3(sum_lanes(S.first[0]), sum_lanes(S.first[1]), sum_lanes(S.first[2])));
    push->centre =
        clamp_to_box(h->shape, v3_madd(c, sum_lanes(S.height) / volume - at->z - v3_dot(at->up, c), at->up));
}

void fl_froude_krylov_round(const fl_hull *h, const fl_waves *w, const fl_wave_field *a,
                            const fl_hull_pose *at, double weight, fl_water_load *push)
{
    fl_vec3 up;
    double level, u[2], acc[2];
    fl_submerged wet;
    fl_wave_field_plane(a, at, &up, &level);
    fl_hull_submerged(h, up, level, &wet);
    *push = (fl_water_load){.volume = wet.volume, .centre = wet.centre, .wetted = wet.wetted_area};
    if (!(wet.volume > 0.0)) return;
    const double s = at->s + v3_dot(at->along, wet.centre), z = at->z + v3_dot(at->up, wet.centre),
                 zeta = fl_wave_stretch(w, z, fl_wave_field_elevation(a, s, NULL));
    fl_wave_kinematics(w, fl_wave_field_cell(a, s, zeta), s, zeta, u, acc);
    const double m = weight * wet.volume;
    push->force =
        v3_madd(v3_scale(m * (1.0 + acc[1] / w->gravity), at->up), m * acc[0] / w->gravity, at->along);
    push->moment = v3_cross(wet.centre, push->force);
}
