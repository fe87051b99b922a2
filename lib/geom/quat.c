/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "geom/quat.h"

fl_quat q_of_matrix(fl_mat3 a)
{
    const double t = a.m[0][0] + a.m[1][1] + a.m[2][2];
    fl_quat q;
    if (t >= a.m[0][0] && t >= a.m[1][1] && t >= a.m[2][2])
        q = (fl_quat){1 + t, a.m[2][1] - a.m[1][2], a.m[0][2] - a.m[2][0], a.m[1][0] - a.m[0][1]};
    else if (a.m[0][0] >= a.m[1][1] && a.m[0][0] >= a.m[2][2])
        q = (fl_quat){a.m[2][1] - a.m[1][2], 1 + 2 * a.m[0][0] - t, a.m[0][1] + a.m[1][0],
                      a.m[0][2] + a.m[2][0]};
    else if (a.m[1][1] >= a.m[2][2])
        q = (fl_quat){a.m[0][2] - a.m[2][0], a.m[0][1] + a.m[1][0], 1 + 2 * a.m[1][1] - t,
                      a.m[1][2] + a.m[2][1]};
    else
        q = (fl_quat){a.m[1][0] - a.m[0][1], a.m[0][2] + a.m[2][0], a.m[1][2] + a.m[2][1],
                      1 + 2 * a.m[2][2] - t};
    return q_unit(q);
}

fl_quat q_of_vector(fl_vec3 r)
{
    double c, s;
    q_cos_sinc(0.25 * v3_norm2(r), &c, &s);
    s *= 0.5;
    return (fl_quat){c, s * r.x, s * r.y, s * r.z};
}

fl_quat q_about_axis(int k, double a)
{
    double c, s;
    q_cos_sinc(0.25 * a * a, &c, &s);
    s *= 0.5 * a;
    return (fl_quat){c, k == 0 ? s : 0.0, k == 1 ? s : 0.0, k == 2 ? s : 0.0};
}
