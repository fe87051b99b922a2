/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair.h -- the data of contacts, of near pairs, and of the laws between two materials. */
#ifndef FL_WORLD_PAIR_H
#define FL_WORLD_PAIR_H
#include <math.h>
#include <stddef.h>
#include "law/contact_law.h"
#include "law/rolling.h"
#include "law/tangent.h"
#include "narrow/contact.h"
#include "narrow/gjk.h"
#include "patch/feature_pairs.h"
#include "patch/quick_list.h"
#include "patch/surrogate.h"
#include "world/strip_state.h"

/* The contact law of a pair of materials. */
typedef struct {
    const fl_contact_law *law;  /* row of the table of laws */
    double exponent;            /* n of contact points of polyhedra */
    double round_exponent;      /* n of those of spheres and ends of capsules: 3/2 or 1 */
    double round_young;         /* E of a linear one [Pa] */
    double modulus;             /* E* [Pa] */
    double stiffness;           /* given by the scene [N/m^n]; 0: from the modulus */
    double stiffness_factor;    /* multiplies the stiffness that follows from the modulus */
    double friction;            /* mu */
    double tangential_ratio;    /* k_t over the tangent stiffness of the contact point */
    double rolling;             /* mu_r of law/rolling.h; 0: no rolling resistance */
    double impact_damping;      /* D = chi v_impact of laws patch and core */
    double slow_damping_factor; /* c of fl_damping_slow_factor() */
    double zeta, alpha;         /* of the laws manual and manual-si */
    double surrogate_tolerance; /* of patch/surrogate.h; 0: no surrogate */
    double stable_share;        /* share of the critical step that damping by the speed of half a step ago
                                 * leaves stable */
    int32_t literal2, literal18;
} fl_pair_law;

/* Memory of a contact in which ice crushes, contact/crushing.h.  Vectors in the axes of floe A. */
typedef struct {
    fl_vec3 offset;    /* D: what is crushed [m] */
    fl_vec3 centre;    /* of the contact when it last touched [m] */
    fl_vec3 normal;    /* n of its last evaluation */
    fl_vec3 lean;      /* t = S/A - n of the last yield of this contact */
    double stiffening; /* g */
    double work;       /* Q of the step work_step [J] */
    double volume;     /* crushed since it was last booked [m3] */
    double force;      /* y at the last yield [N] */
    int64_t work_step;
    int64_t yielded_step; /* of the last yield */
    int32_t booked;       /* Q is in the ledger */
    int32_t unsaved;      /* D has grown and is not yet in the floe */
} fl_crush;

/* A contact of two bodies: i is a floe; j a floe, piece or wall; i < j.
 * A new member that lasts from step to step must be added to snapshot_pair.c (and what is new in fl_world to
 * snapshot.c): prop_restart finds it missing once it changes a bit.  What lasts while the two do not touch
 * must be added to fl_neighbour_pair too. */
typedef struct {
    int32_t i, j;
    int32_t image[3];            /* periodic image of j: offset in lengths of the cell */
    int32_t touching;            /* the two touch */
    fl_friction_springs springs; /* memory of friction */
    fl_feature_pairs
        *feature_pairs;         /* pairs of features that may touch, or NULL; can be rebuilt at any time */
    fl_quick_list *quick_list;  /* the same of the law `quick`, or NULL */
    fl_surrogate *surrogate;    /* NULL until there is one */
    fl_rolling_spring *rolling; /* of a sphere, rolling_pair.h; NULL without rolling resistance */
    fl_strip *strip;            /* of crushing by speed, strip_contact.h; NULL: none */
    fl_crush *crush;            /* NULL while nothing is crushed */
    fl_gjk_cache cache;         /* start of the distance query */
    fl_mode mode;               /* of the laws manual and manual-si */
    int32_t cores_overlap;      /* the cores overlap */
    int32_t has_axis;           /* axis is set */
    fl_vec3 axis;               /* from j to i, axes of j: separates the cores, now or at an earlier time */
    double free_travel;         /* the two cannot touch while the sum of their odometers is below this [m] */
    double k;            /* FL_POINTS_PATCH: c of W = c sqrt(U) [N/m2]; else stiffness of one point [N/m^n] */
    double exponent;     /* n; 0 with FL_POINTS_PATCH */
    double mass;         /* reduced mass [kg] */
    double nominal_area; /* where ice may crush: largest area of this contact that was needed [m2] */
    double crush_checked;      /* and largest force that was held against it [N] */
    double max_approach_speed; /* largest of this contact so far [m/s] */
    /* load [N] and spin [rad/s] behind a low pass, law/damping.h; their rates; the step of both */
    double sustained_load, sustained_load_rate;
    fl_vec3 sustained_spin, sustained_spin_rate;
    double sustained_step;
    int32_t points;         /* enum fl_contact_points: what is evaluated */
    int32_t bond;           /* 1 + index of the bond that was here, 0: none; bond_list.h */
    double radius_factor;   /* multiplies both radii: 1, but less after a bond */
    const fl_pair_law *law; /* borrowed */
    /* results of the last evaluation: world axes, torques about the two centres, forces on i (-f on j) */
    fl_vec3 force, torque_i, torque_j;
    fl_vec3 force_damping, torque_i_damping, torque_j_damping;    /* the part of damping */
    fl_vec3 force_friction, torque_i_friction, torque_j_friction; /* the part of friction */
    double energy;                                                /* elastic, normal and tangential [J] */
    double spring_energy;                                         /* its tangential part [J] */
    double overlap;                                               /* largest [m] */
    double omega2_i, omega2_j; /* bounds of omega^2 of this contact for i and j, the other fixed [1/s2] */
    fl_vec3 load_point;        /* centre of pressure from the centre of i; set where floes may break [m] */
    int32_t index;             /* into fl_world.pair */
    int32_t load_part;         /* part that bears the load, FL_LOAD_SHARED: several; -1: a floe or wall */
} fl_pair;

enum { FL_LOAD_SHARED = -2 };

/* The results of an evaluation are so many consecutive doubles, from force to omega2_j. */
enum { FL_PAIR_RESULTS = 32 };
_Static_assert(offsetof(fl_pair, omega2_j) ==
                   offsetof(fl_pair, force) + (FL_PAIR_RESULTS - 1) * sizeof(double),
               "the results are consecutive");

/* What is known of the gap between two floes across their axis, contact/pair_gap.h. */
typedef struct {
    float k[3];  /* the axis in the axes of i; all 0: nothing is known */
    float level; /* D + n.(x_j - x_i) [m] */
} fl_known_gap;

/* An entry of the neighbour list.  It keeps what must last while the two bodies do not touch, which is most
 * of the time.  `contact` is set while they touch, shortly after, and where a bond was.  While set, read its
 * members, except touching, cores_overlap, free_travel: these are kept here too. */
typedef struct {
    int32_t i, j;
    int32_t image[3]; /* like all members below, as in fl_pair */
    uint8_t touching : 1, cores_overlap : 1, has_axis : 1, cache_size : 3;
    uint8_t mode;
    double free_travel;
    float axis[3];                  /* length at most 1, so that gaps along it are lower bounds */
    uint8_t cache_a[4], cache_b[4]; /* vertices of the cache */
    fl_pair *contact;               /* or NULL */
    fl_known_gap gap;
} fl_neighbour_pair;

/* The members of a near pair that every step reads, kept together. */
typedef struct {
    int32_t i, j;
    double free_travel; /* as above [m]; -INFINITY: the two touch */
} fl_next_check;

/* Pool of contacts with a free list. */
typedef union fl_pair_slot {
    fl_pair pair;
    union fl_pair_slot *next;
} fl_pair_slot;

typedef struct {
    fl_pair_slot **block; /* [blocks] of FL_PAIR_SLOTS slots each */
    fl_pair_slot *free;
    int32_t blocks, cap;
} fl_pair_store;

enum { FL_PAIR_SLOTS = 32 };

#endif
