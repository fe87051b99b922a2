/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/pi.h"
#include "law/material.h"

#define BETA 1.02 /* of a polygon; circle 1.000, square 1.012, triangle 1.034 */

double fl_material_modulus(fl_elastic_constants a, fl_elastic_constants b)
{
    return 1.0 / ((1.0 - a.poisson * a.poisson) / a.young + (1.0 - b.poisson * b.poisson) / b.young);
}

double fl_material_radius(double ra, double rb)
{
    if (ra <= 0.0) return rb;
    if (rb <= 0.0) return ra;
    return ra * rb / (ra + rb);
}

double fl_material_punch(double modulus, double area) { return 2.0 * modulus * BETA * sqrt(area / PI); }

double fl_material_hertz(double modulus, double radius) { return 4.0 / 3.0 * modulus * sqrt(radius); }
