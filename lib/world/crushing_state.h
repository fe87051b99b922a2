/* SPDX-License-Identifier: GPL-3.0-or-later */
/* crushing_state.h -- crushing of a run: its law, and what floes keep of it (contact/crushing.h). */
#ifndef FL_WORLD_CRUSHING_STATE_H
#define FL_WORLD_CRUSHING_STATE_H
#include <stdint.h>
#include "failure/pressure_area.h"
#include "geom/vec3.h"

/* What a contact crushed of a floe, in the axes of the floe; by crushing_law = rate: contact/strip_dent.h. */
typedef struct {
    fl_vec3 x;         /* centre of the contact when it ended [m] */
    fl_vec3 offset;    /* D, as of fl_crush in world/pair.h [m] */
    double half_width; /* within which a contact finds it again [m] */
    double stiffening; /* as of fl_crush; of contact/strip_dent.h: its exponent q */
} fl_dent;

enum { FL_DENTS = 16 };
typedef struct {
    int32_t n;
    fl_dent dent[FL_DENTS];
} fl_floe_dents;

typedef struct {
    int32_t of; /* enum fl_crushing_of; FL_CRUSHING_NONE: nothing below is used */
    int32_t wear;
    fl_pressure_area law;
    fl_floe_dents **dents; /* [n] NULL: the floe has none */
    double volume;         /* of ice crushed so far [m3] */
    int64_t contact_steps; /* evaluations in which a contact yielded */
    double peak;           /* largest force of a contact that yielded [N] */
    int64_t dents_dropped; /* dents beyond FL_DENTS of a floe */
} fl_crushing_state;

#endif
