/* SPDX-License-Identifier: GPL-3.0-or-later */
/* current.h -- velocity profile of a current. With z the height above still water (<= 0 below it),
 *     uniform   U(z) = U0
 *     power     U(z) = U0 (1 + z/d)^a       d the depth of the water, a = 1/7 over sand
 *     linear    U(z) = U0 (1 + z/d)         d the depth of the sheared layer, 0 below it
 *     table     linear between the rows of a file, the end rows beyond them
 * and U(z) = U(0) above still water. Source: DNV-RP-C205 (2010), 4.1.4, for the power law. */
#ifndef FL_WATER_CURRENT_H
#define FL_WATER_CURRENT_H
#include <stdint.h>
#include "base/err.h"
#include "geom/vec3.h"

/* In the order of the choices of water.profile. */
enum fl_profile { FL_PROFILE_UNIFORM, FL_PROFILE_POWER, FL_PROFILE_LINEAR, FL_PROFILE_TABLE };

typedef struct {
    fl_vec3 velocity; /* U0 [m/s] */
    int kind;         /* enum fl_profile */
    double depth;     /* d > 0 [m]; of power and linear */
    double exponent;  /* a > 0 */
    int32_t n;        /* rows of the table, 0 for the other kinds */
    double *z;        /* [n] rising [m] */
    fl_vec3 *u;       /* [n] [m/s], horizontal */
} fl_current;

/* Velocity at height z above still water [m/s]. The same bits on every machine. */
fl_vec3 fl_current_at(const fl_current *c, double z);

/* Reads the rows "z u v" of a file of the kind current, current(5), into c->n, z, u; z rises or falls
 * throughout. Returns 0, or -1 with FL_INPUT or FL_SYSTEM and c untouched. */
int fl_current_read(fl_current *c, const char *path, fl_err *err);

/* Largest speed at any height [m/s]. */
double fl_current_max_speed(const fl_current *c);

/* Frees the table; accepts a zeroed struct and leaves one. */
void fl_current_free(fl_current *c);

#endif
