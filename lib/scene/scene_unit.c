/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>
#include "base/pi.h"
#include "scene/scene_unit.h"
#include "scene/unit_product.h"

static const struct unit {
    enum fl_unit_kind kind;
    const char *word;
    double mul, div;
} units[] = {
    {FL_UNIT_ONE, "", 1, 1},
    {FL_UNIT_ONE, "%", 1, 100},
    {FL_UNIT_TIME, "s", 1, 1},
    {FL_UNIT_TIME, "ms", 1, 1e3},
    {FL_UNIT_TIME, "us", 1, 1e6},
    {FL_UNIT_TIME, "min", 60, 1},
    {FL_UNIT_TIME, "h", 3600, 1},
    {FL_UNIT_LENGTH, "m", 1, 1},
    {FL_UNIT_LENGTH, "mm", 1, 1e3},
    {FL_UNIT_LENGTH, "cm", 1, 100},
    {FL_UNIT_LENGTH, "dm", 1, 10},
    {FL_UNIT_LENGTH, "km", 1e3, 1},
    {FL_UNIT_LENGTH, "um", 1, 1e6},
    {FL_UNIT_SPEED, "m/s", 1, 1},
    {FL_UNIT_SPEED, "mm/s", 1, 1e3},
    {FL_UNIT_SPEED, "cm/s", 1, 100},
    {FL_UNIT_SPEED, "km/h", 1, 3.6},
    {FL_UNIT_SPEED, "kn", 1852, 3600},
    {FL_UNIT_ACCELERATION, "m/s2", 1, 1},
    {FL_UNIT_ACCELERATION, "m/s^2", 1, 1},
    {FL_UNIT_STRESS, "Pa", 1, 1},
    {FL_UNIT_STRESS, "kPa", 1e3, 1},
    {FL_UNIT_STRESS, "MPa", 1e6, 1},
    {FL_UNIT_STRESS, "GPa", 1e9, 1},
    {FL_UNIT_STRESS, "N/m2", 1, 1},
    {FL_UNIT_STRESS, "N/m^2", 1, 1},
    {FL_UNIT_STRESS, "kN/m2", 1e3, 1},
    {FL_UNIT_STRESS, "kN/m^2", 1e3, 1},
    {FL_UNIT_STRESS, "N/mm2", 1e6, 1},
    {FL_UNIT_STRESS, "N/mm^2", 1e6, 1},
    {FL_UNIT_DENSITY, "kg/m3", 1, 1},
    {FL_UNIT_DENSITY, "kg/m^3", 1, 1},
    {FL_UNIT_DENSITY, "t/m3", 1e3, 1},
    {FL_UNIT_DENSITY, "t/m^3", 1e3, 1},
    {FL_UNIT_DENSITY, "g/cm3", 1e3, 1},
    {FL_UNIT_DENSITY, "g/cm^3", 1e3, 1},
    {FL_UNIT_CONTACT_STIFFNESS, "N/m^n", 1, 1},
    {FL_UNIT_CONTACT_STIFFNESS, "N/m", 1, 1},
    {FL_UNIT_CONTACT_STIFFNESS, "kN/m", 1e3, 1},
    {FL_UNIT_CONTACT_STIFFNESS, "MN/m", 1e6, 1},
    {FL_UNIT_CONTACT_STIFFNESS, "GN/m", 1e9, 1},
    {FL_UNIT_CONTACT_STIFFNESS, "N/mm", 1e3, 1},
    {FL_UNIT_CONTACT_STIFFNESS, "N/m^1.5", 1, 1},
    {FL_UNIT_FOUNDATION, "N/m3", 1, 1},
    {FL_UNIT_FOUNDATION, "N/m^3", 1, 1},
    {FL_UNIT_FOUNDATION, "kN/m3", 1e3, 1},
    {FL_UNIT_FOUNDATION, "MN/m3", 1e6, 1},
    {FL_UNIT_FOUNDATION, "GN/m3", 1e9, 1},
    {FL_UNIT_FOUNDATION, "Pa/m", 1, 1},
    {FL_UNIT_FOUNDATION, "kPa/m", 1e3, 1},
    {FL_UNIT_FOUNDATION, "MPa/m", 1e6, 1},
    {FL_UNIT_FOUNDATION, "GPa/m", 1e9, 1},
    {FL_UNIT_AREA_DAMPING, "N.s/m3", 1, 1},
    {FL_UNIT_AREA_DAMPING, "N.s/m^3", 1, 1},
    {FL_UNIT_AREA_DAMPING, "kN.s/m3", 1e3, 1},
    {FL_UNIT_AREA_DAMPING, "MN.s/m3", 1e6, 1},
    {FL_UNIT_MASS, "kg", 1, 1},
    {FL_UNIT_MASS, "g", 1, 1e3},
    {FL_UNIT_MASS, "t", 1e3, 1},
    {FL_UNIT_ANGLE, "deg", 1, 1},
    {FL_UNIT_ANGLE, "rad", 180, PI},
    {FL_UNIT_ANGULAR_VELOCITY, "rad/s", 1, 1},
    {FL_UNIT_ANGULAR_VELOCITY, "deg/s", PI, 180},
    {FL_UNIT_INERTIA, "kg.m2", 1, 1},
    {FL_UNIT_INERTIA, "kg.m^2", 1, 1},
    {FL_UNIT_INERTIA, "t.m2", 1e3, 1},
    {FL_UNIT_INERTIA, "t.m^2", 1e3, 1},
    {FL_UNIT_STIFFNESS, "N/m", 1, 1},
    {FL_UNIT_STIFFNESS, "kN/m", 1e3, 1},
    {FL_UNIT_STIFFNESS, "MN/m", 1e6, 1},
    {FL_UNIT_STIFFNESS, "GN/m", 1e9, 1},
    {FL_UNIT_DAMPING, "N.s/m", 1, 1},
    {FL_UNIT_DAMPING, "kg/s", 1, 1},
    {FL_UNIT_DAMPING, "kN.s/m", 1e3, 1},
    {FL_UNIT_DAMPING, "MN.s/m", 1e6, 1},
    {FL_UNIT_ROTATIONAL_STIFFNESS, "N.m/rad", 1, 1},
    {FL_UNIT_ROTATIONAL_STIFFNESS, "N.m", 1, 1},
    {FL_UNIT_ROTATIONAL_STIFFNESS, "kN.m/rad", 1e3, 1},
    {FL_UNIT_ROTATIONAL_STIFFNESS, "MN.m/rad", 1e6, 1},
    {FL_UNIT_ROTATIONAL_STIFFNESS, "GN.m/rad", 1e9, 1},
    {FL_UNIT_ROTATIONAL_STIFFNESS, "kN.m", 1e3, 1},
    {FL_UNIT_ROTATIONAL_STIFFNESS, "MN.m", 1e6, 1},
    {FL_UNIT_ROTATIONAL_DAMPING, "N.m.s", 1, 1},
    {FL_UNIT_ROTATIONAL_DAMPING, "kN.m.s", 1e3, 1},
    {FL_UNIT_ROTATIONAL_DAMPING, "MN.m.s", 1e6, 1},
    {FL_UNIT_ROTATIONAL_DAMPING, "GN.m.s", 1e9, 1},
    {FL_UNIT_ROTATIONAL_DAMPING, "N.m.s/rad", 1, 1},
    {FL_UNIT_SURFACE_ENERGY, "J/m2", 1, 1},
    {FL_UNIT_SURFACE_ENERGY, "J/m^2", 1, 1},
    {FL_UNIT_SURFACE_ENERGY, "kJ/m2", 1e3, 1},
    {FL_UNIT_SURFACE_ENERGY, "kJ/m^2", 1e3, 1},
    {FL_UNIT_SURFACE_ENERGY, "N/m", 1, 1},
    {FL_UNIT_FREQUENCY, "Hz", 1, 1},
    {FL_UNIT_FREQUENCY, "mHz", 1, 1e3},
    {FL_UNIT_TOUGHNESS, "Pa.m^0.5", 1, 1},
    {FL_UNIT_TOUGHNESS, "kPa.m^0.5", 1e3, 1},
    {FL_UNIT_TOUGHNESS, "MPa.m^0.5", 1e6, 1},
};
enum { N_UNIT = sizeof units / sizeof units[0] };

/* Of a product with the dimensions of a unit of the table, by the size of that one. */
static int convert_product(enum fl_unit_kind kind, const char *word, double *x)
{
    fl_unit_product from, to;
    if (fl_unit_product_read(word, &from)) return -1;
    for (int k = 0; k < N_UNIT; k++)
        if (units[k].kind == kind && !fl_unit_product_read(units[k].word, &to) &&
            fl_unit_product_same_dimensions(&from, &to)) {
            *x = fl_unit_product_convert(&from, &to, *x) * units[k].mul / units[k].div;
            return 0;
        }
    return -1;
}

int fl_unit_convert(enum fl_unit_kind kind, const char *word, double *x)
{
    for (int k = 0; k < N_UNIT; k++)
        if (units[k].kind == kind && strcmp(units[k].word, word) == 0) {
            *x = *x * units[k].mul / units[k].div;
            return 0;
        }
    return convert_product(kind, word, x);
}

const char *fl_unit_si(enum fl_unit_kind kind)
{
    int k = 0;
    while (units[k].kind != kind) k++;
    return units[k].word;
}

char *fl_unit_list(enum fl_unit_kind kind, char *buf, size_t size)
{
    size_t len = 0;
    buf[0] = '\0';
    for (int k = 0; k < N_UNIT; k++)
        if (units[k].kind == kind && units[k].word[0] && len < size)
            len += (size_t)snprintf(buf + len, size - len, "%s%s", len ? " " : "", units[k].word);
    return buf;
}
