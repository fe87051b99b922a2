/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cells of random sites against published results.  A wall would change the cells along it, so the square
 * is periodic: the sites are repeated round it, and only the cells of the original sites count.  V41:
 * Brakke, Random Voronoi (1986, 2005); Ferenc & Neda, Physica A 385 (2007) 518.  V43: a Monte Carlo study
 * of unstated, small size.  Smoothing increases the scatter between samples.  Over ten fields of 2000
 * cells, four of this program and six of a brute-force program without common code, the deviation of the
 * value after 20 steps is 6 % of its mean (0.125); that of the value before the first step is 2 % (0.527).
 * Hence 5 % for up to five steps, as stated there, and 10 % beyond. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "support/verify.h"
#include "base/array.h"
#include "ice/power_cells.h"

/* At one site per unit of area no cell of a million reaches farther than 3 for its corners, and so 6 for
 * its neighbours: an empty circle of radius 3 has probability exp(-9 pi). */
#define MARGIN 6.0

struct stats {
    double sides, sides_var, outline, area_var, share[20];
};

/* Cells of site[n] in the periodic square 0 .. side; `image` has the given capacity. */
static int periodic_cells(int32_t n, const fl_vec2 *site, double side, fl_vec2 *image, int32_t capacity,
                          fl_power_cells *c)
{
    fl_err err = {0};
    int32_t m = n;
    for (int32_t i = 0; i < n; i++) image[i] = site[i];
    for (int32_t i = 0; i < n; i++) {
        for (int k = 0; k < 9; k++) {
            const fl_vec2 p = {site[i].x + side * (k % 3 - 1), site[i].y + side * (k / 3 - 1)};
            if (k == 4 || p.x < -MARGIN || p.x > side + MARGIN || p.y < -MARGIN || p.y > side + MARGIN)
                continue;
            if (m == capacity) return -1;
            image[m++] = p;
        }
    }
    return fl_power_cells_build(c, m, image, (fl_vec2){-MARGIN, -MARGIN},
                                (fl_vec2){side + MARGIN, side + MARGIN}, &err);
}

static struct stats describe_cells(int32_t n, const fl_power_cells *c)
{
    struct stats s = {0};
    for (int32_t i = 0; i < n; i++) {
        const int32_t m = c->first[i + 1] - c->first[i];
        const double area = fl_polygon_area(m, c->v + c->first[i]);
        s.sides += m;
        s.sides_var += (m - 6.0) * (m - 6.0);
        s.outline += fl_polygon_perimeter(m, c->v + c->first[i]);
        s.area_var += (area - 1.0) * (area - 1.0); /* the mean is 1: they fill the square */
        if (m < 20) s.share[m] += 1.0 / n;
    }
    s.sides /= n;
    s.sides_var /= n;
    s.outline /= n;
    s.area_var /= n;
    return s;
}

static int random_cells(int32_t n, fl_vec2 *site, fl_vec2 *image, int32_t capacity)
{
    static const double share[10] = {0, 0, 0, 0.011, 0.107, 0.260, 0.294, 0.199, 0.090, 0.029};
    const double side = sqrt(n), tol = verify_quick() ? 0.04 : 0.01;
    fl_power_cells c = {0};
    struct stats s;
    char what[60];
    fl_random_sites(n, 41, (fl_vec2){0, 0}, (fl_vec2){side, side}, site);
    if (periodic_cells(n, site, side, image, capacity, &c)) return -1;
    s = describe_cells(n, &c);
    fl_power_cells_free(&c);
    verify_note("%d cells of random sites, periodic, one per unit of area", n);
    verify_row("V41", "sides, mean", s.sides, 6.0, 1e-12, VERIFY_ABS);
    verify_row("V41", "sides, variance", s.sides_var, 1.7808, tol, VERIFY_REL);
    verify_row("V41", "area, variance", s.area_var, 0.2802, tol, VERIFY_REL);
    verify_row("V41", "outline, mean", s.outline, 4.0, tol / 4.0, VERIFY_REL);
    for (int m = 3; m < 10; m++) {
        snprintf(what, sizeof what, "share of cells with %d sides", m);
        verify_row("V41", what, s.share[m], share[m], verify_quick() ? 0.015 : 0.003, VERIFY_ABS);
    }
    return 0;
}

static int smoothed_cells(int32_t n, fl_vec2 *site, fl_vec2 *image, int32_t capacity)
{
    static const int step[] = {0, 1, 2, 5, 10, 20};
    static const double cv[] = {0.538, 0.386, 0.303, 0.227, 0.181, 0.121};
    const double side = sqrt(n);
    char what[60];
    fl_random_sites(n, 43, (fl_vec2){0, 0}, (fl_vec2){side, side}, site);
    verify_note("%d cells, each site moved to the centroid of its cell, step by step", n);
    for (int k = 0, done = 0; k < 6; k++) {
        fl_power_cells c = {0};
        for (; done <= step[k]; done++) {
            fl_power_cells_free(&c);
            if (periodic_cells(n, site, side, image, capacity, &c)) return -1;
            if (done == step[k]) {
                snprintf(what, sizeof what, "area, deviation over mean, %d steps", step[k]);
                verify_row("V43", what, sqrt(describe_cells(n, &c).area_var), cv[k],
                           step[k] > 5 ? 0.10 : 0.05, VERIFY_REL);
            }
            for (int32_t i = 0; i < n; i++) { /* back into the square, so that the images are valid again */
                const int32_t first = c.first[i];
                site[i] = fl_polygon_centroid(c.first[i + 1] - first, c.v + first);
                site[i].x -= side * floor(site[i].x / side);
                site[i].y -= side * floor(site[i].y / side);
            }
        }
        fl_power_cells_free(&c);
    }
    return 0;
}

int main(void)
{
    const int32_t n = verify_quick() ? 20000 : 400000,
                  capacity = n + 100 + (int32_t)(30.0 * MARGIN * sqrt(n));
    fl_err err = {0};
    fl_vec2 *site = fl_alloc(n, sizeof *site, &err), *image = fl_alloc(capacity, sizeof *image, &err);
    verify_begin("Voronoi cells");
    if (!site || !image || random_cells(n, site, image, capacity) ||
        smoothed_cells(verify_quick() ? 20000 : 100000, site, image, capacity))
        verify_true("V41", "the cells can be built", 0);
    free(site);
    free(image);
    return verify_end();
}
