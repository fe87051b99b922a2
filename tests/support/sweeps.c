/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/sweeps.h"

double sweep_largest(double (*change)(void *what, double s, double t), void *what, double from, double to,
                     double fine)
{
    for (int parts = 400;; parts = 10) {
        const double h = (to - from) / parts;
        double most = -1.0;
        int at = 0;
        for (int k = 0; k < parts; k++) {
            const double c = change(what, from + k * h, from + (k + 1) * h);
            if (!(c <= most)) most = c, at = k;
        }
        if (h <= fine) return most;
        from += at * h;
        to = from + h;
    }
}
