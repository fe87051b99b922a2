/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ice/floe_gaps.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"

/* What a pushed floe leaves of its way, so that rounding makes no overlap. */
#define WAY_LEFT 1e-6

/* Share of the even gap below which two floes touch. */
#define TOUCH_SHARE 0.01

/* Distance from floe i to side k of its cell. */
static double slack_of(const fl_floes *a, int32_t i, fl_polygon_side side, fl_vec2 shift)
{
    double least = INFINITY;
    for (int32_t v = a->first[i]; v < a->first[i + 1]; v++) {
        const fl_vec2 p = {a->outer[v].x - shift.x, a->outer[v].y - shift.y};
        least = fmin(least, -fl_polygon_side_distance(side, p));
    }
    return fmax(0.0, least);
}

void fl_floes_push(fl_floes *a, const fl_power_cells *cells, fl_vec2 shift, uint64_t seed)
{
    for (int32_t i = 0; i < a->n; i++) {
        fl_rng g = fl_rng_of(seed, i, FL_RNG_GAP);
        const double angle = fl_rng_in(&g, 0.0, 2.0 * PI), x = cos(angle), y = sin(angle);
        double way = INFINITY;
        for (int32_t k = cells->first[i]; k < cells->first[i + 1]; k++) {
            const double along = cells->side[k].nx * x + cells->side[k].ny * y;
            if (along > 0.0) way = fmin(way, slack_of(a, i, cells->side[k], shift) / along);
        }
        if (isinf(way)) continue;
        way *= 1.0 - WAY_LEFT;
        for (int32_t v = a->first[i]; v < a->first[i + 1]; v++) {
            a->outer[v] = (fl_vec2){a->outer[v].x + way * x, a->outer[v].y + way * y};
            a->core[v] = (fl_vec2){a->core[v].x + way * x, a->core[v].y + way * y};
        }
    }
}

static int compare_gaps(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The side of cell j that it shares with cell i along side k of i: of the same line, other way round; -1. */
static int32_t twin_side(const fl_power_cells *cells, int32_t i, int32_t k)
{
    const int32_t j = cells->side[k].tag;
    int32_t best = -1;
    double facing = 0.0;
    for (int32_t m = cells->first[j]; m < cells->first[j + 1]; m++) {
        const double cosine = fl_polygon_side_cos(cells->side[k], cells->side[m]);
        if (cells->side[m].tag != i || !(cosine < facing)) continue;
        facing = cosine, best = m;
    }
    return best;
}

int fl_floe_gaps_measure(fl_floe_gaps *g, const fl_floes *a, const fl_power_cells *cells, fl_vec2 shift,
                         fl_err *err)
{
    double *gap = fl_alloc(cells->first[cells->n], sizeof *gap, err);
    int32_t n = 0, touching = 0;
    *g = (fl_floe_gaps){0};
    if (!gap) return -1;
    for (int32_t i = 0; i < a->n; i++) {
        int touches = 0;
        for (int32_t k = cells->first[i]; k < cells->first[i + 1]; k++) {
            const int32_t j = cells->side[k].tag, twin = j < 0 || j == i ? -1 : twin_side(cells, i, k);
            if (twin < 0) continue;
            gap[n] = slack_of(a, i, cells->side[k], shift) + slack_of(a, j, cells->side[twin], shift);
            touches |= gap[n++] < TOUCH_SHARE * 2.0 * a->inset;
        }
        touching += touches;
    }
    if (n) {
        qsort(gap, (size_t)n, sizeof *gap, compare_gaps);
        g->median = gap[n / 2];
        g->q90 = gap[(int32_t)(0.9 * (n - 1))];
        g->touching = (double)touching / a->n;
    }
    free(gap);
    return 0;
}
