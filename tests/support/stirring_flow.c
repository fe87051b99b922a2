/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "ice/power_cells.h"
#include "ice/floes.h"
#include "scene/ice_field_order.h"
#include "support/stirring_flow.h"

#define CONCENTRATION 0.8
#define RADIUS 0.05
#define AREA 12.5 /* of the field, for a floe [m2] */
#define EDDY 6.0  /* [m] */

enum { SMOOTH = 2 };

static void check_result(int rc, const fl_err *err)
{
    if (rc == 0) return;
    printf("eddies: %s\n", err->text);
    exit(1);
}

/* Cores of floes made like those of voronoi-ice: prisms over the cells of n sites, smoothed twice. */
static void make_cores(fl_poly *out, int32_t n)
{
    const double half = 0.5 * sqrt(AREA * n);
    const fl_vec2 lo = {-half, -half}, hi = {half, half};
    fl_vec2 *site = malloc((size_t)n * sizeof *site);
    fl_power_cells c = {0};
    fl_floes a = {0};
    fl_err err = {0};
    if (!site) exit(1);
    fl_random_sites(n, 1, lo, hi, site);
    check_result(fl_power_cells_build(&c, n, site, lo, hi, &err), &err);
    for (int k = 0; k < SMOOTH; k++) {
        fl_power_cells_centroids(&c, site);
        fl_power_cells_free(&c);
        check_result(fl_power_cells_build(&c, n, site, lo, hi, &err), &err);
    }
    check_result(fl_floes_make(&a, &c, CONCENTRATION, RADIUS, (fl_vec2){0, 0}, &err), &err);
    for (int32_t i = 0; i < n; i++) {
        const int32_t corners = a.first[i + 1] - a.first[i];
        fl_vec3 *xy = malloc((size_t)corners * sizeof *xy);
        if (!xy) exit(1);
        for (int32_t k = 0; k < corners; k++) {
            const fl_vec2 v = a.core[a.first[i] + k];
            xy[k] = v3(v.x, v.y, 0);
        }
        check_result(fl_poly_prism(&out[i], corners, xy, -0.4, 0.0, &err), &err);
        free(xy);
    }
    free(site);
    fl_floes_free(&a), fl_power_cells_free(&c);
}

void stirring_flow_start(lab *l, int32_t n, double speed)
{
    fl_poly *core = calloc((size_t)n, sizeof *core);
    int32_t *at = malloc((size_t)n * sizeof *at);
    fl_err err = {0};
    if (!core || !at) exit(1);
    lab_start(l);
    lab_set(l, "contact.stiffness_factor=0.025");
    lab_set(l, "contact.friction=0.3");
    lab_set(l, "contact.restitution=0.1");
    make_cores(core, n);
    for (int32_t i = 0; i < n; i++) {
        const double x = PI / EDDY * core[i].v[0].x, y = PI / EDDY * core[i].v[0].y;
        lab_poly(l, &core[i], RADIUS, v3(speed * sin(x) * cos(y), -speed * cos(x) * sin(y), 0), v3(0, 0, 0));
    }
    check_result(fl_ice_field_order(&l->field, at, &err), &err);
    free(core), free(at);
}
