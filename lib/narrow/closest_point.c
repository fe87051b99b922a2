/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/closest_point.h"

fl_closest_point fl_closest_on_segment(fl_vec3 a, fl_vec3 b, fl_vec3 x)
{
    return fl_point_on_segment(a, b, x);
}

fl_closest_point fl_closest_on_face_border(const fl_poly *p, int32_t f, fl_vec3 x)
{
    return fl_point_on_face_border(p, f, x);
}

fl_closest_point fl_closest_on_face(const fl_poly *p, int32_t f, fl_vec3 x)
{
    return fl_point_on_face(p, f, x);
}

fl_closest_point fl_closest_on_poly(const fl_poly *p, fl_vec3 x) { return fl_point_on_poly(p, x); }

fl_closest_point fl_closest_on_cone(double r0, double r1, double h, fl_vec3 x)
{
    return fl_point_on_cone(r0, r1, h, x);
}
