/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "failure/splitting.h"
#include <math.h>

enum { NODES = 8 };
static const double ALPHA[NODES] = {0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5};
/* B/L = 1/2, 1, 2; the first column from the limit 1.4636/sqrt(alpha) where it was not computed. */
static const double OPENING[3][NODES] = {{10.44, 7.802, 7.720, 8.792, 10.14, 12.95, 15.75, 18.57},
                                         {10.44, 6.895, 5.544, 5.351, 5.558, 6.511, 7.962, 10.16},
                                         {10.40, 6.760, 5.200, 4.786, 4.784, 5.447, 6.851, 9.244}},
                    CLOSING[3][NODES] = {{3.165, 1.977, 1.649, 1.640, 1.676, 1.721, 1.732, 1.737},
                                         {3.165, 1.949, 1.411, 1.246, 1.200, 1.239, 1.364, 1.597},
                                         {3.310, 2.210, 1.721, 1.586, 1.577, 1.752, 2.135, 2.783}},
                    TENSION[NODES] = {0.288, 0.456, 0.689, 0.922, 1.179, 1.793, 2.604, 3.770};

/* Linear in alpha: 1/sqrt(alpha) falls faster below the first node, where the bound is on the safe side. */
static double value_at(const double *k, double alpha)
{
    int n = 0;
    if (alpha <= ALPHA[0]) return k[0] * (k == TENSION ? sqrt(alpha / ALPHA[0]) : sqrt(ALPHA[0] / alpha));
    while (n < NODES - 2 && alpha > ALPHA[n + 1]) n++;
    const double t = (alpha - ALPHA[n]) / (ALPHA[n + 1] - ALPHA[n]);
    return k[n] + fmin(t, 1.0) * (k[n + 1] - k[n]);
}

static double between(const double k[3][NODES], double alpha, double ratio)
{
    if (ratio <= 0.5) return value_at(k[0], alpha);
    if (ratio >= 2.0) return value_at(k[2], alpha);
    const int n = ratio < 1.0 ? 0 : 1;
    const double a = value_at(k[n], alpha), b = value_at(k[n + 1], alpha),
                 t = ratio < 1.0 ? 2.0 * (ratio - 0.5) : ratio - 1.0;
    return a + t * (b - a);
}

double fl_split_opening(double alpha, double ratio) { return between(OPENING, alpha, ratio); }
double fl_split_closing(double alpha, double ratio) { return between(CLOSING, alpha, ratio); }
double fl_split_tension(double alpha) { return value_at(TENSION, alpha); }

double fl_split_least(double Q, double F, double Q2, double S, double ratio, double from)
{
    double least = INFINITY;
    for (int n = -1; n < NODES; n++) { /* linear between nodes, so the least is at one */
        const double alpha = n < 0 ? from : ALPHA[n];
        if (alpha < from || alpha > ALPHA[NODES - 1]) continue;
        const double kQ = fl_split_opening(alpha, ratio);
        least =
            fmin(least, Q * kQ - F * fl_split_closing(alpha, ratio) + Q2 * kQ + S * fl_split_tension(alpha));
    }
    return least;
}

double fl_split_intensity(const fl_split_line *s)
{
    const double Q2 = 2.0 * s->moment / s->length,
                 from = fmin(fmax(0.5 * s->width / s->length, 1e-3), ALPHA[NODES - 1]),
                 k = fl_split_least(s->Q, s->F, Q2, s->tension - Q2, s->breadth / s->length, from);
    return k / (s->thickness * sqrt(s->length));
}
