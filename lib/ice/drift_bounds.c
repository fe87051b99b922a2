/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ice/drift_bounds.h"
#include <math.h>
#include <stdlib.h>

static int compare_intervals(const void *a, const void *b)
{
    const fl_obstacle *x = a, *y = b;
    return (x->lo > y->lo) - (x->lo < y->lo);
}

int32_t fl_join_intervals(int32_t n, fl_obstacle *a, double gap, double *width)
{
    int32_t kept = 0;
    if (n > 0) qsort(a, (size_t)n, sizeof *a, compare_intervals);
    for (int32_t k = 0; k < n; k++) {
        if (kept && a[k].lo - a[kept - 1].hi < gap) a[kept - 1].hi = fmax(a[kept - 1].hi, a[k].hi);
        else a[kept++] = a[k];
    }
    *width = 0.0;
    for (int32_t k = 0; k < kept; k++) *width += a[k].hi - a[k].lo;
    return kept;
}

double fl_concentration_beside(double concentration, double field_width, double structure_width)
{
    if (!(structure_width < field_width)) return INFINITY;
    return isinf(field_width) ? concentration : concentration * field_width / (field_width - structure_width);
}

double fl_width_needed(double concentration, double structure_width)
{
    const double room = 1.0 - concentration / FL_JAM_CONCENTRATION;
    return room > 0.0 ? structure_width / room : INFINITY;
}

double fl_drag_of_held_ice(double water_density, double coef, double speed, double area)
{
    return 0.5 * water_density * coef * speed * speed * area;
}

double fl_momentum_load(double restitution, double mass_per_area, double speed, double width)
{
    return (1.0 + restitution) * mass_per_area * speed * speed * width;
}

double fl_floe_impulse(double restitution, double mass, double speed, double arm, double gyration)
{
    return (1.0 + restitution) * mass * speed / (1.0 + arm * arm / (gyration * gyration));
}

double fl_brash_load(double thickness, double breadth, double cm, double cp, double parallel, double q,
                     double bow_area_over_length)
{
    const double front = 0.26 + sqrt(thickness * breadth), layer = front + thickness;
    return 845.0 * cm * layer * layer * (breadth + cp * front) + 42.0 * parallel * front * front +
           825.0 * q * bow_area_over_length;
}
