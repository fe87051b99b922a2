/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/pi.h"
#include "law/manual.h"
#include "law/material.h"

double fl_manual_stiffness(const fl_manual_contact *c, double modulus, double overlap, int si, int literal18,
                           double *n)
{
    const double both = fl_material_radius(c->r_low, c->r_high);
    const double low = c->r_low > 0.0 ? c->r_low : both; /* a sharp feature takes the radius of the other */
    double r = both;
    *n = 1.5;
    switch (c->kind) {
    case FL_MANUAL_VV: break;
    case FL_MANUAL_VE: r = sqrt(low * both); break;
    case FL_MANUAL_VF: r = low; break;
    case FL_MANUAL_EE: {
        const double ra = low, rb = c->r_high > 0.0 ? c->r_high : low;
        const double t = 0.5 * (1.0 / ra + 1.0 / rb), d = c->sine * c->sine / (4.0 * ra * rb);
        const double root = t * t > 4.0 * d ? sqrt(t * t - 4.0 * d) : 0.0;
        const double big = 1.0 / (t + root); /* the shorter radius: larger curvature, no cancellation */
        double longer = d > 0.0 ? 1.0 / (4.0 * d * big) : INFINITY;
        const double most = c->edge * c->edge / (4.0 * overlap);
        if (longer > most) longer = most;
        r = sqrt(big * longer) * (literal18 ? 2.0 : 1.0);
        break;
    }
    case FL_MANUAL_EP:
    case FL_MANUAL_EF:
        if (si) {
            *n = 1.0;
            return 0.25 * PI * modulus * c->length;
        }
        return c->length * fl_material_hertz(modulus, c->kind == FL_MANUAL_EP ? both : low);
    case FL_MANUAL_FF: *n = 1.0; return fl_material_punch(modulus, c->area);
    }
    return fl_material_hertz(modulus, r);
}

double fl_manual_damping(double k, double n, double overlap, double mass, double zeta, double alpha, double u)
{
    if (n == 1.0) return 2.0 * zeta * sqrt(mass * k) * u;
    return alpha * sqrt(mass * k) * sqrt(sqrt(overlap)) * u;
}
