/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "failure/pressure_area.h"
#include "base/fast_math.h"

fl_pressure_area fl_pressure_area_of(const fl_scene_failure *s)
{
    static const double polar[7] = {6.0e6, 4.2e6, 3.0e6, 2.45e6, 2.0e6, 1.5e6, 1.3e6};
    fl_pressure_area q = {s->pressure, s->pressure_area, s->pressure_exponent, 0.0, s->pressure_max};
    if (s->pressure_law == FL_PRESSURE_USER) return q;
    q.area = 1.0;
    if (s->pressure_law == FL_PRESSURE_ISO_LOCAL) q.p0 = 7.4e6, q.exponent = 0.7, q.least = 1.48e6;
    else if (s->pressure_law == FL_PRESSURE_API) q.p0 = 8.1e6, q.exponent = 0.5, q.least = 1.5e6;
    else q.p0 = polar[s->pressure_law - FL_PRESSURE_POLAR_1], q.exponent = 0.1;
    return q;
}

double fl_crushing_pressure(const fl_pressure_area *law, double A)
{
    double p = law->p0;
    if (law->exponent > 0.0) p /= fl_pow(A / law->area, law->exponent);
    if (p < law->least) p = law->least;
    return p > law->most ? law->most : p;
}
