/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sphere_contacts.h -- the contact list of sphere pairs, and of spheres on walls: a tenth of the data that
 * other pairs need.  The floor sphere/ computes with it.
 *
 * Contacts are sorted by (i, j, image).  Bodies form chunks of FL_SPHERE_CHUNK by their number.  A chunk owns
 * the contacts of its bodies i and the sums of its bodies.  The force of a contact on j is added at once if j
 * is in the same chunk; else it is stored in a slot of the contact, which j adds later.  Wall contacts come
 * last.  So every sum has one order, that of the contacts, for any number of threads.  A listed pair that
 * does not touch adds zeros, which change no bit: the result does not depend on which pairs are listed. */
#ifndef FL_WORLD_SPHERE_CONTACTS_H
#define FL_WORLD_SPHERE_CONTACTS_H
#include <stdint.h>
#include "geom/vec3.h"
#include "law/rolling.h"

enum { FL_SPHERE_CHUNK = 256, FL_BODY_BLOCK = 32 };

/* Memory of a contact, and its forces of the last step.  A vector stands before a number, so that both fill
 * one register of four. */
typedef struct {
    fl_vec3 spring_force;      /* elastic part of the tangential force on i [N] */
    double spring_stiffness;   /* tangential stiffness that belongs to it [N/m] */
    fl_vec3 friction_force;    /* tangential force on i, with damping [N] */
    double normal_damping;     /* damping part of the normal force [N] */
    double max_approach_speed; /* largest of this contact so far [m/s] */
    double k;                  /* kappa of Hertz [N/m^1.5] */
} fl_sphere_contact;

/* Contact of sphere i with wall j, wall_contact.h. */
typedef struct {
    int32_t i, j;
    int32_t law; /* into fl_world.law */
    int32_t touches;
    fl_sphere_contact contact;
} fl_wall_contact;

/* Load of the spheres of one chunk on a wall: force, and torque about the point of the wall, world axes. */
typedef struct {
    fl_vec3 f, t; /* [N], [N m] */
} fl_wall_load;

/* What contacts need of a body, collected from several arrays into two cache lines. */
typedef struct {
    fl_vec3 x; /* [m] */
    double r;  /* [m] */
    fl_vec3 v; /* mean velocity of the step [m/s] */
    double inv_mass;
    fl_vec3 w;               /* [rad/s] */
    double r_copy;           /* r again, beside w */
    fl_vec3 dv;              /* predicted change of v until the end of the step, velocity_predictor.h */
    double contact_inv_mass; /* (n - 1)/m with n contacts in the step before, taken as in line */
    fl_vec3 rdw;             /* r times the predicted change of w [m/s] */
    double inv_inertia;      /* r^2/I [1/kg] */
} fl_sphere_state;

/* Offset from a body to one of its periodic images [m]. */
typedef struct {
    fl_vec3 by;
    double pad;
} fl_image_shift;

/* Sums over the contacts of one body: forces and torques on it, world axes. */
typedef struct {
    fl_vec3 elastic, damping, friction; /* [N] */
    fl_vec3 torque;                     /* of friction, the only force with an arm [N m] */
} fl_sphere_sum;

/* Totals over the contacts of a chunk. */
typedef struct {
    int64_t touching;
    double force_sum;                     /* sum of |F| [N] */
    double max_overlap;                   /* largest overlap over the sum of the radii */
    int32_t max_overlap_i, max_overlap_j; /* bodies of the first contact that has it; -1: none */
    double elastic, spring;               /* energies; spring: the tangential part [J] */
} fl_chunk_totals;

typedef struct {
    int32_t n;                       /* contacts (listed pairs) */
    int32_t bodies;                  /* floes; 0: no pair was ever listed, and nothing else is set */
    int32_t *i, *j;                  /* [n] */
    int32_t *law;                    /* [n] into fl_world.law */
    int32_t one_law;                 /* law of all contacts; -1: there are several */
    int32_t *image;                  /* [n][3]; NULL without a periodic cell */
    uint8_t *touches;                /* [n] */
    fl_sphere_contact *contact;      /* [n] */
    fl_rolling_spring *rolling;      /* [n]; NULL without rolling resistance */
    int32_t *contact_count;          /* [bodies] touching contacts and walls of each body now */
    int32_t *previous_contact_count; /* [bodies] and in the step before */
    int32_t *first;                  /* [bodies + 1] contacts of body i */
    fl_sphere_state *state;          /* [bodies] */
    uint8_t *is_listed; /* [chunks * FL_SPHERE_CHUNK / FL_BODY_BLOCK] some contact refers to the block;
                                      * states and sums of the others are not needed */
    int32_t *target;    /* [n] where the force on j goes: j, or ~slot if j is in another chunk */
    int32_t chunks;
    int32_t *first_source;       /* [chunks] first chunk with a contact that refers to this chunk */
    uint8_t *finished;           /* [chunks] scratch of a step */
    fl_image_shift *shift;       /* [shifts] 0: no shift */
    uint8_t *shift_index;        /* [n] into shift */
    int32_t shifts;              /* 0: more than fit in a byte, shift_index is not used */
    int32_t *slot_first;         /* [chunks + 1] slots of the contacts that leave a chunk, in order */
    int32_t *incoming_first;     /* [bodies + 1] offsets into incoming */
    int32_t *incoming;           /* [slot_first[chunks]] slots that body j adds, ascending */
    fl_sphere_sum *slot;         /* [slot_first[chunks]] */
    fl_sphere_sum *sum;          /* [bodies] */
    fl_sphere_sum *previous_sum; /* [bodies] of the step before */
    const fl_sphere_sum *
        *cleared;            /* [2 chunks] which of these two arrays are 0 in a chunk without contacts */
    fl_chunk_totals *totals; /* [chunks] */
    double *omega2;          /* [bodies] sum of bounds of omega^2, last stiffness update [1/s2] */
    double *omega2_slot;     /* [slot_first[chunks]] */
    fl_wall_contact *wall;   /* [walls] sorted by (i, j) */
    fl_rolling_spring *wall_rolling; /* [walls]; NULL without rolling resistance */
    int32_t *wall_first;             /* [chunks + 1] wall contacts of each chunk */
    fl_wall_load *wall_load;         /* [chunks][walls of the boundary] */
    int32_t walls, wall_cap, wall_rolling_cap;
    int32_t i_cap, j_cap, law_cap, image_cap, touches_cap, contact_cap, rolling_cap;
} fl_sphere_contacts;

#endif
