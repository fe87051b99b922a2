/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "water/drag.h"

double fl_drag_radius(const fl_poly *p, double dilation)
{
    double far = 0.0;
    for (int32_t v = 0; v < p->nv; v++) far = fmax(far, v3_norm(p->v[v]));
    return far + dilation;
}
