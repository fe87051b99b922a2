/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sphere_contacts.h -- what is kept of pairs of spheres, and of spheres on walls, apart from all other pairs: a tenth of
 * what those need.
 *
 * Rows are sorted by (i, j, image).  Bodies are taken in chunks of FL_SPHERE_CHUNK by their number.  A chunk
 * owns the rows of its bodies i and the sums of its bodies: what a row does to a j of the same chunk is added
 * there at once, what it does to a j beyond goes to a slot of the row, which j adds up later; the rows of its
 * bodies and walls come last.  Every sum so has one order, that of the rows, for any number of threads; a row
 * that does not touch adds zeros, which change no bit, so that it does not matter which rows are listed. */
#ifndef FL_WORLD_SPHERE_CONTACTS_H
#define FL_WORLD_SPHERE_CONTACTS_H
#include <stdint.h>
#include "geom/vec3.h"
#include "law/rolling.h"

enum { FL_SPHERE_CHUNK = 256, FL_BODY_BLOCK = 32 };

/* What a row remembers, and the forces that it gave last.  Vectors stand before a number, so that either two
 * are one register of four. */
typedef struct {
    fl_vec3 spring_force;      /* elastic part of the tangential force on i                       [N]       */
    double spring_stiffness;   /* tangential stiffness that it was built with                     [N/m]     */
    fl_vec3 friction_force;    /* tangential force on i, with damping                             [N]       */
    double normal_damping;     /* what damping adds to the normal force                           [N]       */
    double max_approach_speed; /* largest approach speed of this touch                            [m/s]     */
    double k;                  /* kappa of Hertz                                                  [N/m^1.5] */
} fl_sphere_contact;

/* A sphere and a wall, wall_contact.h. */
typedef struct {
    int32_t i, j;
    int32_t law;     /* into fl_world.law */
    int32_t touches; /* touches */
    fl_sphere_contact contact;
} fl_wall_contact;

/* What those of a chunk do to a wall: force, and torque about its point, world axes. */
typedef struct {
    fl_vec3 f, t; /* [N], [N m] */
} fl_wall_load;

/* What rows see of a body: its motion at the contacts of a step, and at its end.  Bodies are far apart to the
 * rows that they are the j of, and wait in as many places as there are arrays. */
typedef struct {
    fl_vec3 x; /* [m]     */
    double r;  /* [m]     */
    fl_vec3 v; /* [m/s]   */
    double inv_mass;
    fl_vec3 w;     /* [rad/s] */
    double r_copy; /* r, where that is wanted beside w */
    fl_vec3 dv;    /* by how much v will have changed by the end of the step, velocity_predictor.h */
    double contact_inv_mass; /* (n - 1)/m, of n contacts in the step before, as many as they are in line */
    fl_vec3 rdw;             /* r times that of w                                     [m/s]    */
    double inv_inertia;      /* r^2/I                                                 [1/kg]   */
} fl_sphere_state;

/* From a body to an image of it [m]. */
typedef struct {
    fl_vec3 by;
    double pad;
} fl_image_shift;

/* Sums over the rows of one body; forces and torques on it, world axes. */
typedef struct {
    fl_vec3 elastic, damping, friction; /* [N]   */
    fl_vec3 torque;                     /* [N m], of friction: nothing else has an arm */
} fl_sphere_sum;

/* What the rows of a chunk tell. */
typedef struct {
    int64_t touching;
    double force_sum;            /* sum of |F| [N]                                            */
    double max_overlap;          /* largest overlap over the sum of the radii                 */
    int32_t max_overlap_contact; /* where that is, the first of them; of a wall ~row          */
    double elastic, spring;      /* energies of its rows [J]                                  */
} fl_chunk_totals;

typedef struct {
    int32_t n;                  /* rows */
    int32_t bodies;             /* as many as move; 0: there has been no row yet, and the rest is not there */
    int32_t *i, *j;             /* [n] */
    int32_t *law;               /* [n] into fl_world.law */
    int32_t one_law;            /* of all rows; -1: there are several */
    int32_t *image;             /* [n][3]; NULL without a periodic cell */
    uint8_t *touches;           /* [n] touches */
    fl_sphere_contact *contact; /* [n] */
    fl_rolling_spring *rolling; /* [n]; NULL where nothing keeps spheres from rolling */
    int32_t *contact_count;     /* [bodies] rows and walls that touch it now, */
    int32_t *previous_contact_count; /* [bodies] and that did in the step before   */
    int32_t *first;                  /* [bodies + 1] rows of body i */
    fl_sphere_state *state;          /* [bodies] */
    int32_t *target;                 /* [n] where j adds up: j, or of a row that leaves its chunk ~slot */
    int32_t chunks;
    int32_t *first_source;           /* [chunks] the first chunk with a row that leads there */
    uint8_t *finished;               /* [chunks] scratch of a step */
    fl_image_shift *shift;           /* [ways] 0 is that of j itself */
    uint8_t *shift_index;            /* [n] which of them */
    int32_t shifts;                  /* 0: there are more than a byte can tell */
    int32_t *slot_first;             /* [chunks + 1] slots of the rows that leave a chunk, in their order */
    int32_t *incoming_first;         /* [bodies + 1] offsets into slots */
    int32_t *incoming;               /* [cross[chunks]] the slots that body j has to add up, ascending */
    fl_sphere_sum *slot;             /* [cross[chunks]] */
    fl_sphere_sum *sum;              /* [bodies] */
    fl_sphere_sum *previous_sum;     /* [bodies] of the step before */
    fl_chunk_totals *totals;         /* [chunks] */
    double *omega2;                  /* [bodies] sum of bounds of omega^2, of the last survey [1/s2] */
    double *omega2_slot;             /* [cross[chunks]] */
    fl_wall_contact *wall;           /* [leans] by (i, j) */
    fl_rolling_spring *wall_rolling; /* [leans] as roll */
    int32_t *wall_first;             /* [chunks + 1] those of a chunk */
    fl_wall_load *wall_load;         /* [chunks][walls] */
    int32_t walls, wall_cap, wall_rolling_cap;
    int32_t i_cap, j_cap, law_cap, image_cap, touches_cap, contact_cap, rolling_cap;
} fl_sphere_contacts;

#endif
