/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/member_section.h"
#include <math.h>
#include "base/pi.h"

fl_member_section fl_member_section_pipe(double d, double t, double e, double g, double rho)
{
    const double in = d - 2.0 * t, area = PI * t * (d - t),
                 i = PI / 64.0 * (d * d * d * d - in * in * in * in);
    return (fl_member_section){.ea = e * area,
                               .eiy = e * i,
                               .eiz = e * i,
                               .gj = 2.0 * g * i,
                               .mass = rho * area,
                               .radius = 0.5 * d,
                               .form = FL_MEMBER_PIPE,
                               .given = {d, t, e, g, rho}};
}

fl_member_section fl_member_section_rectangle(double b, double h, double e, double g, double rho)
{
    const double longer = b > h ? b : h, shorter = b > h ? h : b;
    double sum = 0.0;
    for (int n = 1; n < 60; n += 2) sum += tanh(n * PI * longer / (2.0 * shorter)) / pow(n, 5);
    const double j = longer * shorter * shorter * shorter *
                     (1.0 / 3.0 - 64.0 / (PI * PI * PI * PI * PI) * shorter / longer * sum);
    return (fl_member_section){.ea = e * b * h,
                               .eiy = e * b * h * h * h / 12.0,
                               .eiz = e * h * b * b * b / 12.0,
                               .gj = g * j,
                               .mass = rho * b * h,
                               .radius = 0.5 * sqrt(b * b + h * h),
                               .form = FL_MEMBER_RECTANGLE,
                               .given = {b, h, e, g, rho}};
}

fl_member_section fl_member_section_bar(double area, double e, double rho)
{
    return (fl_member_section){.ea = e * area,
                               .mass = rho * area,
                               .radius = sqrt(area / PI),
                               .bar = 1,
                               .form = FL_MEMBER_BAR_FORM,
                               .given = {area, e, rho}};
}
