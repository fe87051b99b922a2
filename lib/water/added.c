/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "water/added.h"

static const double PI = 3.141592653589793;

static double pick(double asked, double unit, double otherwise)
{
    return asked == FL_ADDED_AUTO ? otherwise : asked * unit;
}

/* Radius of the disc with the area of the shadow along the third axis: half of sum A |n_z|. */
static double disc(const fl_poly *p)
{
    double area = 0.0;
    for (int32_t f = 0; f < p->nf; f++) area += 0.5 * fabs(fl_poly_area(p, f).z);
    return sqrt(area / PI);
}

fl_vec3 fl_added_mass(const fl_poly *outer, double displaced, double density, fl_vec3 asked)
{
    const int round = outer->nf == 0;
    const double a = disc(outer), plane = (round ? 0.5 : 0.1) * displaced,
                 across = round ? plane : 4.0 / 3.0 * density * a * a * a;
    return v3(pick(asked.x, displaced, plane), pick(asked.y, displaced, plane),
              pick(asked.z, displaced, across));
}

fl_vec3 fl_added_inertia(const fl_poly *outer, fl_vec3 own, double density, fl_vec3 asked)
{
    const double a = disc(outer), tilt = 8.0 / 45.0 * density * a * a * a * a * a;
    return v3(pick(asked.x, own.x, tilt), pick(asked.y, own.y, tilt), pick(asked.z, own.z, 0.0));
}
