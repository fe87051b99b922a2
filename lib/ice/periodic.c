/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "ice/periodic.h"

/* Width of the first band, in square roots of the mean area of a cell: cells of random sites need more in
 * about one of 1e9 cells. */
#define BAND 3.0

static double wrap_coordinate(double x, double lo, double hi)
{
    const double l = hi - lo, t = x - l * floor((x - lo) / l);
    return t < lo || t >= hi ? lo : t; /* rounding */
}

fl_vec2 fl_periodic_wrap(fl_vec2 p, fl_vec2 lo, fl_vec2 hi, const int periodic[2])
{
    return (fl_vec2){periodic[0] ? wrap_coordinate(p.x, lo.x, hi.x) : p.x,
                     periodic[1] ? wrap_coordinate(p.y, lo.y, hi.y) : p.y};
}

/* Add the copies of the sites up to a distance of band outside; of[] is the site of a copy. */
static int add_copies(int32_t n, const fl_vec2 *site, fl_vec2 lo, fl_vec2 hi, const int reach[2],
                      fl_vec2 band, fl_vec2 **image, int32_t **of, int32_t *count, fl_err *err)
{
    const double lx = hi.x - lo.x, ly = hi.y - lo.y;
    int32_t cap = 0, of_cap = 0, m = n;
    if (fl_grow(image, &cap, n, sizeof **image, err) || fl_grow(of, &of_cap, n, sizeof **of, err)) return -1;
    for (int32_t i = 0; i < n; i++) {
        (*image)[i] = site[i];
        (*of)[i] = i;
    }
    for (int ky = -reach[1]; ky <= reach[1]; ky++)
        for (int kx = -reach[0]; kx <= reach[0]; kx++)
            for (int32_t i = 0; i < n && (kx || ky); i++) {
                const fl_vec2 p = {site[i].x + kx * lx, site[i].y + ky * ly};
                if (p.x < lo.x - band.x || p.x > hi.x + band.x || p.y < lo.y - band.y || p.y > hi.y + band.y)
                    continue;
                if (fl_grow(image, &cap, (int64_t)m + 1, sizeof **image, err) ||
                    fl_grow(of, &of_cap, (int64_t)m + 1, sizeof **of, err))
                    return -1;
                (*image)[m] = p;
                (*of)[m++] = i;
            }
    *count = m;
    return 0;
}

static int is_wide_enough(const fl_power_cells *c, int32_t n, const fl_vec2 *site, fl_vec2 lo, fl_vec2 hi,
                          const int periodic[2])
{
    for (int32_t i = 0; i < n; i++)
        for (int32_t k = c->first[i]; k < c->first[i + 1]; k++) {
            const fl_vec2 v = c->v[k];
            const double r = hypot(v.x - site[i].x, v.y - site[i].y) * (1.0 + 1e-9);
            if (periodic[0] && (v.x - r < lo.x || v.x + r > hi.x)) return 0;
            if (periodic[1] && (v.y - r < lo.y || v.y + r > hi.y)) return 0;
        }
    return 1;
}

/* Drop the cells of the copies. */
static void drop_copies(fl_power_cells *c, int32_t n, const int32_t *of)
{
    c->n = n;
    for (int32_t k = 0; k < c->first[n]; k++)
        if (c->side[k].tag >= 0) c->side[k].tag = of[c->side[k].tag];
}

int fl_periodic_cells(fl_power_cells *out, int32_t n, const fl_vec2 *site, fl_vec2 lo, fl_vec2 hi,
                      const int periodic[2], fl_err *err)
{
    const double lx = hi.x - lo.x, ly = hi.y - lo.y;
    for (double band = BAND * sqrt(lx * ly / n);; band *= 2.0) {
        const fl_vec2 b = {periodic[0] ? band : 0.0, periodic[1] ? band : 0.0};
        const int reach[2] = {(int)ceil(b.x / lx), (int)ceil(b.y / ly)};
        const fl_vec2 from = {lo.x - b.x, lo.y - b.y}, to = {hi.x + b.x, hi.y + b.y};
        fl_vec2 *image = NULL;
        int32_t *of = NULL, m = 0;
        fl_power_cells c = {0};
        int rc = add_copies(n, site, lo, hi, reach, b, &image, &of, &m, err);
        int ready = 0;
        if (rc == 0) rc = fl_power_cells_build(&c, m, image, from, to, err);
        if (rc == 0 && (ready = is_wide_enough(&c, n, site, from, to, periodic))) {
            drop_copies(&c, n, of);
            *out = c;
            c = (fl_power_cells){0};
        }
        fl_power_cells_free(&c);
        free(image);
        free(of);
        if (rc || ready) return rc;
    }
}
