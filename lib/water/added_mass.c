/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "water/added_mass.h"
#include "base/pi.h"

static double pick(double asked, double unit, double otherwise)
{
    return asked == FL_ADDED_MASS_AUTO ? otherwise : asked * unit;
}

static double *at(fl_vec3 *a, int axis) { return axis == 0 ? &a->x : axis == 1 ? &a->y : &a->z; }

/* The axis nearest to the vertical; of several that are as near but for rounding, the last. */
static int upright(fl_vec3 up)
{
    int axis = 2;
    for (int c = 1; c >= 0; c--)
        if (fabs(*at(&up, c)) > (1.0 + 1e-9) * fabs(*at(&up, axis))) axis = c;
    return axis;
}

/* Radius of the disc with the area of the shadow along that axis: half of sum A |n_z|. */
static double disc(const fl_poly *p, int axis)
{
    double area = 0.0;
    for (int32_t f = 0; f < p->nf; f++) {
        fl_vec3 a = fl_poly_face_area_vector(p, f);
        area += 0.5 * fabs(*at(&a, axis));
    }
    return sqrt(area / PI);
}

/* Numbers of the two other axes, in their order, and of the one across. */
static fl_vec3 about(int across, fl_vec3 a)
{
    fl_vec3 out = {0};
    *at(&out, across == 0 ? 1 : 0) = a.x;
    *at(&out, across == 2 ? 1 : 2) = a.y;
    *at(&out, across) = a.z;
    return out;
}

fl_vec3 fl_added_mass(const fl_poly *outer, fl_vec3 up, double displaced, double density, fl_vec3 asked)
{
    const int round = outer->nf == 0, axis = upright(up);
    const double a = disc(outer, axis), plane = (round ? 0.5 : 0.1) * displaced,
                 across = round ? plane : 4.0 / 3.0 * density * a * a * a;
    return about(axis, v3(pick(asked.x, displaced, plane), pick(asked.y, displaced, plane),
                          pick(asked.z, displaced, across)));
}

fl_vec3 fl_added_inertia(const fl_poly *outer, fl_vec3 up, fl_vec3 own, double density, fl_vec3 asked)
{
    const int axis = upright(up);
    const double a = disc(outer, axis), tilt = 8.0 / 45.0 * density * a * a * a * a * a;
    return about(axis,
                 v3(pick(asked.x, *at(&own, axis == 0 ? 1 : 0), tilt),
                    pick(asked.y, *at(&own, axis == 2 ? 1 : 2), tilt), pick(asked.z, *at(&own, axis), 0.0)));
}
