/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "water/drag.h"

double fl_drag_radius(const fl_poly *p, double dilation)
{
    double far = 0.0;
    for (int32_t v = 0; v < p->nv; v++) far = fmax(far, v3_norm(p->v[v]));
    return far + dilation;
}

void fl_drag(const fl_fluid *fluid, double area, double radius, fl_vec3 u, fl_vec3 w, fl_vec3 *force,
             fl_vec3 *moment)
{
    const double k = -0.5 * fluid->density * area;
    if (force) *force = v3_scale(k * fluid->force * v3_norm(u), u);
    if (moment) *moment = v3_scale(k * fluid->moment * radius * radius * radius * v3_norm(w), w);
}
