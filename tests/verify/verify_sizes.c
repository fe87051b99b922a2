/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Floes of prescribed sizes, diameters of 1:100: distance of their area distribution from the law.  It is
 * the Kolmogorov-Smirnov distance between the floes as written (outer polygons) and the law in closed form;
 * the requirement is 0.03 at 1000 floes and 0.01 at 10 000.  The laws are widened until the largest floe
 * has a hundred times the diameter of the smallest, a ratio that the floes must have too. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "support/verify.h"
#include "base/array.h"
#include "base/parallel.h"
#include "ice/prescribed_areas.h"
#include "ice/sizes.h"

#define CONCENTRATION 0.8
#define RATIO 100.0

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double diameter_ratio(const fl_sizes *s, int32_t n, double *area)
{
    fl_sizes_areas(s, n, 1.0, area);
    return sqrt(area[n - 1] / area[0]);
}

/* The parameter x of a law at which n floes have the ratio RATIO; the ratio grows from lo to hi. */
static void widen(fl_sizes *s, double *x, double lo, double hi, int32_t n, double *area)
{
    for (int k = 0; k < 60; k++) {
        *x = sqrt(lo * hi);
        if (diameter_ratio(s, n, area) < RATIO) lo = *x;
        else hi = *x;
    }
}

static int verify_field(const char *name, const fl_sizes *s, int32_t n, double *area, double bound)
{
    const double side = sqrt(n), mean = CONCENTRATION;
    const fl_outline in = {.lo = {-0.5 * side, -0.5 * side}, .hi = {0.5 * side, 0.5 * side}};
    fl_power_cells c = {0};
    fl_floes a = {0};
    fl_err err = {0};
    double off, total = 0.0;
    char what[80];
    fl_sizes_areas(s, n, mean, area);
    for (int32_t i = 0; i < n; i++) { /* an order that is unrelated to the sizes */
        const int32_t j = (int32_t)((int64_t)i * 7919 % (i + 1));
        const double x = area[i];
        area[i] = area[j];
        area[j] = x;
    }
    if (fl_prescribed_areas_floes(&c, &a, n, 61, area, &in, 2, CONCENTRATION, 1e-4, (fl_vec2){0, 0}, &off,
                                  &err)) {
        verify_note("%s: %s", name, err.text);
        return -1;
    }
    for (int32_t i = 0; i < n; i++) {
        area[i] = fl_polygon_area(a.first[i + 1] - a.first[i], a.outer + a.first[i]);
        total += area[i];
    }
    qsort(area, (size_t)n, sizeof *area, ascending);
    snprintf(what, sizeof what, "%s, %d floes: distance of distributions", name, n);
    verify_below("S6", what, fl_sizes_ks_distance(s, mean, n, area), bound);
    snprintf(what, sizeof what, "%s, %d floes: largest diameter over smallest", name, n);
    verify_row("S6", what, sqrt(area[n - 1] / area[0]), RATIO, 0.01, VERIFY_REL);
    snprintf(what, sizeof what, "%s, %d floes: concentration", name, n);
    verify_row("S6", what, total / n, CONCENTRATION, 1e-12, VERIFY_REL);
    fl_power_cells_free(&c);
    fl_floes_free(&a);
    return 0;
}

int main(int argc, char **argv)
{
    static const struct {
        int32_t n;
        double bound;
    } size[] = {{1000, 0.03}, {10000, 0.01}};
    fl_err err = {0};
    double *area = fl_alloc(10000, sizeof *area, &err);
    (void)argc;
    fl_parallel_limit_spin(argv);
    verify_begin("floes of prescribed sizes");
    for (int k = 0; area && k < (verify_quick() ? 1 : 2); k++) {
        const int32_t n = size[k].n;
        fl_sizes lognormal = {.kind = FL_SIZES_LOGNORMAL, .mean = 1.0}, weibull = {.kind = FL_SIZES_WEIBULL};
        fl_sizes power = {.kind = FL_SIZES_POWER, .beta = 2.87, .dmin = 1.0};
        double shape = 1.0;
        widen(&lognormal, &lognormal.cv, 0.1, 10.0, n, area);
        widen(&power, &power.dmax, 50.0, 5000.0, n, area);
        for (double lo = 0.2, hi = 5.0, m = 0; m < 60; m++) { /* narrower as its shape parameter grows */
            weibull.k = shape = sqrt(lo * hi);
            if (diameter_ratio(&weibull, n, area) > RATIO) lo = shape;
            else hi = shape;
        }
        verify_note("log-normal of cv %.3f, Weibull of shape %.3f, N(> D) ~ D^-1.87 up to %.0f times the "
                    "smallest",
                    lognormal.cv, shape, power.dmax);
        if (verify_field("log-normal", &lognormal, n, area, size[k].bound) ||
            verify_field("Weibull", &weibull, n, area, size[k].bound) ||
            verify_field("power law", &power, n, area, size[k].bound))
            verify_true("S6", "the field can be made", 0);
    }
    if (!area) verify_true("S6", "there is memory", 0);
    free(area);
    return verify_end();
}
