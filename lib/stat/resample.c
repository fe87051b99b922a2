/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "stat/resample.h"

static const double EQUAL = 1e-6; /* of the mean interval */

double fl_resample_common_interval(int32_t n, const double *edge)
{
    const double h = (edge[n] - edge[0]) / n;
    for (int32_t k = 0; k < n; k++)
        if (!(fabs(edge[k + 1] - edge[k] - h) <= EQUAL * h)) return 0.0;
    return h;
}

void fl_resample_means(int32_t n, const double *edge, const double *x, int32_t m, double *even, double *y)
{
    const double span = edge[n] - edge[0];
    int32_t k = 0;
    for (int32_t j = 0; j <= m; j++) even[j] = j < m ? edge[0] + span * ((double)j / m) : edge[n];
    for (int32_t j = 0; j < m; j++) {
        double sum = 0.0, time = 0.0;
        for (;;) {
            const double part = fmin(edge[k + 1], even[j + 1]) - fmax(edge[k], even[j]);
            if (part > 0.0) {
                sum += part * x[k];
                time += part;
            }
            if (k + 1 == n || edge[k + 1] >= even[j + 1]) break;
            k++;
        }
        /* Two edges may fall together in rounding; the interval is then as short as it is without effect. */
        y[j] = time > 0.0 ? sum / time : x[k];
    }
}
