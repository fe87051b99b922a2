/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "comparison.h"

comparison compare_parts(const struct record_views *r, int32_t s, int w)
{
    const int32_t last = r->series->parts - 1;
    const fl_signal_view *total =
        strcmp(r->series->part[last], "total") == 0 ? find_view(r, last, s, w) : NULL;
    comparison c = {.total = last > 0 && total ? last : -1, .at = -1, .most_max = -INFINITY};
    for (int32_t p = 0; p < r->series->parts; p++) {
        const fl_signal_view *v = p == c.total ? NULL : find_view(r, p, s, w);
        if (!v) continue;
        if (fabs(v->stats.mean) > fabs(c.most_mean)) c.most_mean = v->stats.mean;
        c.most_max = fmax(c.most_max, v->stats.max);
        c.sum_max += v->stats.max;
    }
    if (c.total >= 0) c.at = total->stats.at_max;
    return c;
}
