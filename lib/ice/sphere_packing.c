/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/array.h"
#include "base/pi.h"
#include "ice/sphere_packing.h"

enum { SPHERES_MAX = 1 << 27 };

static double floor_tolerant(double x) { return floor(x * (1.0 + FL_PACKING_WHOLE_TOL)); }

/* Positions along x count half diameters: column c of a row is at 2 c + row_offset(). */
static int row_offset(enum fl_packing_kind kind, int32_t k, int32_t r)
{
    return kind == FL_PACKING_HCP ? (r + k) & 1 : kind == FL_PACKING_HEX ? r & 1 : 0;
}

static double row_spacing(enum fl_packing_kind kind, double d)
{
    return kind == FL_PACKING_SQUARE ? d : d * sqrt(0.75);
}

/* --- the pairs ------------------------------------------------------------------------------------------ */

/* Add the pair of sphere i and the sphere in layer k, row r at position `at`, if it exists. */
static int add_pair(fl_sphere_packing *a, int32_t *cap, enum fl_packing_kind kind, int32_t i, int32_t k,
                    int32_t r, int32_t at, fl_err *err)
{
    const int32_t twice = at - row_offset(kind, k, r);
    if (k >= a->layers || r < 0 || r >= a->rows || twice < 0 || twice >= 2 * a->columns) return 0;
    if (fl_grow(&a->pair, cap, (int64_t)a->pairs + 1, sizeof *a->pair, err)) return -1;
    a->pair[a->pairs][0] = i;
    a->pair[a->pairs++][1] = (k * a->rows + r) * a->columns + twice / 2;
    return 0;
}

/* Add the neighbours with higher index, ascending. */
static int add_pairs(fl_sphere_packing *a, int32_t *cap, enum fl_packing_kind kind, int32_t k, int32_t r,
                     int32_t c, fl_err *err)
{
    const int32_t i = (k * a->rows + r) * a->columns + c, at = 2 * c + row_offset(kind, k, r);
    if (add_pair(a, cap, kind, i, k, r, at + 2, err)) return -1;
    if (kind == FL_PACKING_SQUARE)
        return add_pair(a, cap, kind, i, k, r + 1, at, err) || add_pair(a, cap, kind, i, k + 1, r, at, err);
    if (add_pair(a, cap, kind, i, k, r + 1, at - 1, err) || add_pair(a, cap, kind, i, k, r + 1, at + 1, err))
        return -1;
    if (kind == FL_PACKING_HEX) return add_pair(a, cap, kind, i, k + 1, r, at, err);
    /* odd layers are D sqrt(3)/6 farther along y: the third sphere of the hollow is a row back from an
     * even one, a row ahead from an odd one */
    if (k % 2 == 0 && add_pair(a, cap, kind, i, k + 1, r - 1, at, err)) return -1;
    if (add_pair(a, cap, kind, i, k + 1, r, at - 1, err) || add_pair(a, cap, kind, i, k + 1, r, at + 1, err))
        return -1;
    return k % 2 ? add_pair(a, cap, kind, i, k + 1, r + 1, at, err) : 0;
}

/* --- the sheet ------------------------------------------------------------------------------------------ */

int fl_sphere_packing_make(fl_sphere_packing *out, enum fl_packing_kind kind, double diameter, int32_t layers,
                           fl_vec2 lo, fl_vec2 hi, fl_err *err)
{
    const double d = diameter, wide = hi.x - lo.x, deep = hi.y - lo.y, step = row_spacing(kind, d);
    const double columns = floor_tolerant(wide / d);
    const double rows =
        deep * (1.0 + FL_PACKING_WHOLE_TOL) < d ? 0.0 : 1.0 + floor_tolerant((deep - d) / step);
    const double shift = kind == FL_PACKING_HCP ? d * sqrt(0.75) / 3.0 : 0.0;
    fl_sphere_packing a = {.layers = layers, .diameter = d};
    fl_vec2 from;
    int32_t cap = 0;
    a.layer_spacing = kind == FL_PACKING_HCP ? d * sqrt(2.0 / 3.0) : d;
    if (columns < 1.0 || rows < 1.0)
        return fl_fail(err, FL_INPUT, "no sphere of %g m fits on %g m x %g m, a smaller one is expected", d,
                       wide, deep);
    if (columns * rows * layers > SPHERES_MAX)
        return fl_fail(err, FL_INPUT, "%.0f x %.0f x %d spheres are too many, %d at most are expected",
                       columns, rows, layers, SPHERES_MAX);
    a.columns = (int32_t)columns;
    a.rows = (int32_t)rows;
    a.n = a.columns * a.rows * layers;
    a.x = fl_alloc(a.n, sizeof *a.x, err);
    if (!a.x) goto bad;
    from.x = 0.5 * (lo.x + hi.x) - 0.5 * d * (columns - (kind == FL_PACKING_SQUARE ? 1.0 : 0.5));
    from.y = 0.5 * (lo.y + hi.y) - 0.5 * (step * (rows - 1.0) + (layers > 1 ? shift : 0.0));
    for (int32_t k = 0, i = 0; k < layers; k++)
        for (int32_t r = 0; r < a.rows; r++)
            for (int32_t c = 0; c < a.columns; c++, i++) {
                a.x[i] = v3(from.x + 0.5 * d * (2 * c + row_offset(kind, k, r)),
                            from.y + step * r + (k % 2 ? shift : 0.0), 0.5 * d + a.layer_spacing * k);
                if (add_pairs(&a, &cap, kind, k, r, c, err)) goto bad;
            }
    *out = a;
    return 0;
bad:
    fl_sphere_packing_free(&a);
    return -1;
}

double fl_spherical_cap_volume(double r, double t)
{
    if (t <= 0.0) return 0.0;
    if (t >= 2.0 * r) return 4.0 / 3.0 * PI * r * r * r;
    return PI * t * t * (r - t / 3.0);
}

double fl_sphere_packing_draft(const fl_sphere_packing *a, double ratio)
{
    const double r = 0.5 * a->diameter, want = ratio * a->layers * (4.0 / 3.0 * PI * r * r * r);
    double lo = 0.0, hi = a->layer_spacing * (a->layers - 1) + a->diameter;
    for (;;) {
        const double t = 0.5 * (lo + hi);
        double under = 0.0;
        if (t <= lo || t >= hi) return t;
        for (int32_t k = 0; k < a->layers; k++) under += fl_spherical_cap_volume(r, t - a->layer_spacing * k);
        if (under < want) lo = t;
        else hi = t;
    }
}

void fl_sphere_packing_free(fl_sphere_packing *a)
{
    free(a->x);
    free(a->pair);
    *a = (fl_sphere_packing){0};
}
