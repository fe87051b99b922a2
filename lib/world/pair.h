/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair.h -- a contact of two bodies, and two bodies that are near. */
#ifndef FL_WORLD_PAIR_H
#define FL_WORLD_PAIR_H
#include <math.h>
#include <stddef.h>
#include "law/contact_law.h"
#include "law/tangent.h"
#include "narrow/contact.h"
#include "narrow/gjk.h"
#include "patch/feature_pairs.h"
#include "patch/surrogate.h"
#include "law/rolling.h"

/* A pair of materials, resolved. */
typedef struct {
    const fl_contact_law *law;  /* the row of its law                                */
    double exponent;            /* n of the polyhedra's places                       */
    double modulus;             /* E* [Pa]                                           */
    double stiffness;           /* given by the user [N/m^n]; 0: from the modulus    */
    double stiffness_factor;    /* multiplies the stiffness that comes from the modulus */
    double friction;            /* mu                                                */
    double tangential_ratio;    /* k_t over the tangent stiffness of the place       */
    double rolling;             /* mu_r of law/rolling.h; 0: nothing keeps a sphere from rolling */
    double impact_damping;      /* D = chi v_impact of patch and core                */
    double slow_damping_factor; /* c of fl_damping_slow_factor()                            */
    double zeta, alpha;         /* of the manual's laws                              */
    double surrogate_tolerance; /* tolerance of surrogate.h; 0: none                 */
    double stable_share;        /* what damping by the speed half a step ago leaves of the critical step */
    int32_t literal2, literal18;
} fl_pair_law;

/* A contact of two things.  What is new here and lasts from step to step, or is new in fl_world, goes into
 * snapshot_pair.c or snapshot.c as well: prop_restart finds what is missing there, once it bears on a bit;
 * what lasts while they do not touch goes into fl_neighbour_pair too. */
typedef struct {
    int32_t i, j;                    /* i moves, i < j                                        */
    int32_t image[3];                /* j is where it is, moved by so many lengths of the cell */
    int32_t touching;                /* touching                                              */
    fl_friction_springs springs;     /* what friction remembers                               */
    fl_feature_pairs *feature_pairs; /* which features may touch, or NULL; can be made again at any time */
    fl_surrogate *surrogate;         /* NULL until there is one */
    fl_rolling_spring *rolling; /* of a sphere, rolling_pair.h; NULL where nothing keeps it from rolling */
    fl_gjk_cache cache;         /* where the distance query starts                       */
    fl_mode mode;               /* of the manual's laws                                  */
    int32_t cores_overlap;      /* the cores overlap                                     */
    int32_t has_axis;           /* axis has been set                                     */
    int32_t points;             /* enum fl_contact_points: what is evaluated             */
    fl_vec3 axis;               /* from j to i in the frame of j: separates the cores, or did */
    double free_travel;         /* while the odometers add up to less, it cannot touch [m] */
    double k;                   /* stiffness of one place [N/m^n]; of `patch`, c in W = c sqrt(U) [N/m2] */
    double exponent;            /* n of that place; 0 with FL_POINTS_PATCH */
    double mass;                /* reduced [kg]                                          */
    double max_approach_speed;  /* largest approach speed of this touch [m/s]            */
    int32_t bond;               /* 1 + number of the bond that stood here, 0: there was none; bond_list.h */
    double radius_factor;       /* so much of its radii counts: 1, but after a bond */
    const fl_pair_law *law;     /* borrowed */
    /* of the last evaluation; world axes, torques about the two centres */
    fl_vec3 force, torque_i, torque_j; /* force on i (on j its opposite), torques               */
    fl_vec3 force_damping, torque_i_damping,
        torque_j_damping; /* the part of damping                                   */
    fl_vec3 force_friction, torque_i_friction,
        torque_j_friction;     /* the part of friction                                  */
    double energy;             /* elastic, normal and tangential [J]                    */
    double spring_energy;      /* the tangential part of it [J]                         */
    double overlap;            /* largest [m]                                           */
    double omega2_i, omega2_j; /* bounds of omega^2 of this contact for either, the other held [1/s2] */
    int32_t index;             /* place in fl_world.pair */
} fl_pair;

/* What an evaluation tells, from f on: so many doubles in a row. */
enum { FL_PAIR_RESULTS = 32 };
_Static_assert(offsetof(fl_pair, omega2_j) ==
                   offsetof(fl_pair, force) + (FL_PAIR_RESULTS - 1) * sizeof(double),
               "nothing between them");

/* Two things that are near: what is known of them while they do not touch, and their contact where they do,
 * or did a moment ago, or are left by a bond.  Most near pairs do not touch for most of the time. */
typedef struct {
    int32_t i, j;     /* i moves, i < j */
    int32_t image[3]; /* as in fl_pair, like all that follows */
    uint8_t touching : 1, cores_overlap : 1, has_axis : 1, cache_size : 3;
    uint8_t mode;
    double free_travel;
    float axis[3];                  /* no longer than 1: gaps along it are bounds */
    uint8_t cache_a[4], cache_b[4]; /* of the cache */
    fl_pair *contact; /* or NULL; where there is one it knows better, but for n, deep and asleep */
} fl_neighbour_pair;

/* When a near pair has to be looked at, which is asked in every step: short, to lie close together. */
typedef struct {
    int32_t i, j;
    double free_travel; /* while the odometers add up to less, it cannot touch [m]; -INFINITY: it touches */
} fl_next_check;

/* Room for contacts: what one leaves the next one takes. */
typedef union fl_pair_slot {
    fl_pair pair;
    union fl_pair_slot *next;
} fl_pair_slot;

typedef struct {
    fl_pair_slot **block; /* [blocks] of FL_PAIR_BLOCK each */
    fl_pair_slot *free;
    int32_t blocks, cap;
} fl_pair_store;

enum { FL_PAIR_BLOCK = 32 };

#endif
