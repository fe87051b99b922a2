/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "water/added_mass.h"
#include "base/pi.h"

static double value_or_auto(double factor, double unit, double otherwise)
{
    return factor == FL_ADDED_MASS_AUTO ? otherwise : factor * unit;
}

static double *component_of(fl_vec3 *a, int axis) { return axis == 0 ? &a->x : axis == 1 ? &a->y : &a->z; }

/* Inclinations that differ by less than this fraction are equal: far above the rounding of the direction,
 * 1e-16, and far below any difference that counts. */
#define AXIS_MARGIN 1e-9

/* The axis nearest to the vertical; among equal ones the last. */
static int vertical_axis(fl_vec3 up)
{
    int axis = 2;
    for (int c = 1; c >= 0; c--)
        if (fabs(*component_of(&up, c)) > (1.0 + AXIS_MARGIN) * fabs(*component_of(&up, axis))) axis = c;
    return axis;
}

/* Radius of the disc with the projected area along that axis, half of sum A |n_z|. */
static double disc_radius(const fl_poly *p, int axis)
{
    double area = 0.0;
    for (int32_t f = 0; f < p->nf; f++) {
        fl_vec3 a = fl_poly_face_area_vector(p, f);
        area += 0.5 * fabs(*component_of(&a, axis));
    }
    return sqrt(area / PI);
}

/* Puts the numbers of the two axes in the plane, in their order, and that of the axis across in place. */
static fl_vec3 arrange_axes(int across, fl_vec3 a)
{
    fl_vec3 out = {0};
    *component_of(&out, across == 0 ? 1 : 0) = a.x;
    *component_of(&out, across == 2 ? 1 : 2) = a.y;
    *component_of(&out, across) = a.z;
    return out;
}

fl_vec3 fl_added_mass(const fl_poly *outer, fl_vec3 up, double displaced, double density, fl_vec3 factor)
{
    const int round = outer->nf == 0, axis = vertical_axis(up);
    const double a = disc_radius(outer, axis), plane = (round ? 0.5 : 0.1) * displaced,
                 across = round ? plane : 4.0 / 3.0 * density * a * a * a;
    return arrange_axes(axis, v3(value_or_auto(factor.x, displaced, plane),
                                 value_or_auto(factor.y, displaced, plane),
                                 value_or_auto(factor.z, displaced, across)));
}

fl_vec3 fl_added_inertia(const fl_poly *outer, fl_vec3 up, fl_vec3 own, double density, fl_vec3 factor)
{
    const int axis = vertical_axis(up);
    const double a = disc_radius(outer, axis), tilt = 8.0 / 45.0 * density * a * a * a * a * a;
    return arrange_axes(axis, v3(value_or_auto(factor.x, *component_of(&own, axis == 0 ? 1 : 0), tilt),
                                 value_or_auto(factor.y, *component_of(&own, axis == 2 ? 1 : 2), tilt),
                                 value_or_auto(factor.z, *component_of(&own, axis), 0.0)));
}
