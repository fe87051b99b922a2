/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "ice/cells.h"
#include "ice/floes.h"
#include "support/voronoi.h"

enum { SMOOTH = 2 };

static void must(int rc, const fl_err *err)
{
    if (rc == 0) return;
    printf("voronoi: %s\n", err->text);
    exit(1);
}

void voronoi_cores(fl_poly *out, int32_t n, double area, double concentration, double radius, double z0,
                   double z1)
{
    const double half = 0.5 * sqrt(area * n);
    const fl_vec2 lo = {-half, -half}, hi = {half, half};
    fl_vec2 *site = malloc((size_t)n * sizeof *site);
    fl_cells c = {0};
    fl_floes a = {0};
    fl_err err = {0};
    if (!site) exit(1);
    fl_cells_sites(n, 1, lo, hi, site);
    must(fl_cells_build(&c, n, site, lo, hi, &err), &err);
    for (int k = 0; k < SMOOTH; k++) {
        fl_cells_centroids(&c, site);
        fl_cells_free(&c);
        must(fl_cells_build(&c, n, site, lo, hi, &err), &err);
    }
    must(fl_floes_make(&a, &c, concentration, radius, (fl_vec2){0, 0}, &err), &err);
    for (int32_t i = 0; i < n; i++) {
        const int32_t corners = a.first[i + 1] - a.first[i];
        fl_vec3 *xy = malloc((size_t)corners * sizeof *xy);
        if (!xy) exit(1);
        for (int32_t k = 0; k < corners; k++) {
            const fl_vec2 v = a.core[a.first[i] + k];
            xy[k] = v3(v.x, v.y, 0);
        }
        must(fl_poly_prism(&out[i], corners, xy, z0, z1, &err), &err);
        free(xy);
    }
    free(site);
    fl_floes_free(&a), fl_cells_free(&c);
}
