/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_unit.h -- units of the values of a scene, and their conversion to SI. */
#ifndef FL_SCENE_SCENE_UNIT_H
#define FL_SCENE_SCENE_UNIT_H
#include <stddef.h>

/* Kinds of quantities.  Values are stored and written in the first unit of each kind: SI, and degrees. */
enum fl_unit_kind {
    FL_UNIT_ONE,                  /* a pure number; % */
    FL_UNIT_TIME,                 /* s ms us min h */
    FL_UNIT_LENGTH,               /* m mm cm dm km um */
    FL_UNIT_SPEED,                /* m/s mm/s cm/s km/h kn */
    FL_UNIT_ACCELERATION,         /* m/s2 m/s^2 */
    FL_UNIT_STRESS,               /* Pa kPa MPa GPa N/m2 N/m^2 kN/m2 kN/m^2 N/mm2 N/mm^2 */
    FL_UNIT_DENSITY,              /* kg/m3 kg/m^3 t/m3 t/m^3 g/cm3 g/cm^3 */
    FL_UNIT_CONTACT_STIFFNESS,    /* N/m^n, n: exponent of the law; N/m kN/m MN/m GN/m N/mm; N/m^1.5 */
    FL_UNIT_FOUNDATION,           /* N/m3 N/m^3 kN/m3 MN/m3 GN/m3 Pa/m kPa/m MPa/m GPa/m */
    FL_UNIT_AREA_DAMPING,         /* N.s/m3 N.s/m^3 kN.s/m3 MN.s/m3 */
    FL_UNIT_MASS,                 /* kg g t */
    FL_UNIT_ANGLE,                /* deg rad */
    FL_UNIT_ANGULAR_VELOCITY,     /* rad/s deg/s */
    FL_UNIT_INERTIA,              /* kg.m2 t.m2, also with ^2 */
    FL_UNIT_STIFFNESS,            /* N/m kN/m MN/m GN/m */
    FL_UNIT_DAMPING,              /* N.s/m kN.s/m MN.s/m, or kg/s */
    FL_UNIT_ROTATIONAL_STIFFNESS, /* N.m/rad kN.m/rad MN.m/rad GN.m/rad, or N.m kN.m MN.m */
    FL_UNIT_ROTATIONAL_DAMPING,   /* N.m.s kN.m.s MN.m.s GN.m.s, or N.m.s/rad */
    FL_UNIT_SURFACE_ENERGY,       /* J/m2 J/m^2 kJ/m2 kJ/m^2 N/m */
    FL_UNIT_FREQUENCY,            /* Hz mHz */
    FL_UNIT_TOUGHNESS             /* Pa.m^0.5 kPa.m^0.5 MPa.m^0.5 */
};

/* Convert *x from the unit `word` to the first unit of the kind: *x * mul / div, where mul or div is 1 in
 * most rows, so that "50 mm" is the double 0.05 after one rounding.  A product that is not in the table, as
 * "kNm/deg" or "kN/mm", is converted if it has the dimensions of one that is, unit_product.h.  Returns 0, or
 * -1 if the kind has no such unit. */
int fl_unit_convert(enum fl_unit_kind kind, const char *word, double *x);

/* The first unit of the kind, "" for a pure number. */
const char *fl_unit_si(enum fl_unit_kind kind);

/* Write all units of the kind, separated by blanks, to buf.  Returns buf. */
char *fl_unit_list(enum fl_unit_kind kind, char *buf, size_t size);

#endif
