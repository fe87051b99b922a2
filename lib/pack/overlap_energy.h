/* SPDX-License-Identifier: GPL-3.0-or-later */
/* overlap_energy.h -- the energy of the overlaps of a packing, its forces, and its minimum.
 *
 *     E = sum over contacts of k phi(delta),  phi(delta) = delta^2/2 for delta > 0 (law/normal.h, n = 1),
 * with k = 1 for all sizes, and 1/4 for the corners of polyhedra.  Lengths in m, so forces are in m, too.
 * delta is
 *     of two spheres        r_i + r_j less the distance of their centres: one point;
 *     of two other bodies   r_i + r_j less the distance of their cores (narrow/gjk.h; of cores that overlap
 *                           their depth is added, narrow/penetration.h), and of polyhedra the same of each
 *                           corner of one core and the other core (narrow/closest_point.h), so that faces
 *                           touch at their corners, too;
 *     at the boundary       r_i less the distance (pack_region.h) of the centre of a sphere, or of
 *                           each corner of a core, and of each edge and corner of the boundary that points
 *                           inwards.
 *
 * The minimum is found by FIRE (body/relaxation.h) with fictitious masses: 1, and more for bodies with many
 * neighbours, so that a body between hundreds of small ones does not set the step; of rotation m rho^2 with
 * rho = ARM of the bounding radius.  No body moves more than a fifth of its radius in a step.
 *
 * Lists of neighbours hold all pairs up to the scale `reach` and a skin of SKIN of the smallest body; they
 * last while the scale and the paths of the bodies stay below these.  Each body sums its own contacts in the
 * order of the list, and totals go by blocks of bodies in order: the same bits for any number of threads. */
#ifndef FL_PACK_OVERLAP_ENERGY_H
#define FL_PACK_OVERLAP_ENERGY_H
#include "body/relaxation.h"
#include "broad/pairs.h"
#include "narrow/penetration.h"
#include "pack/pack_region.h"
#include "pack/packing.h"

/* Sums over a block of bodies, or all. */
typedef struct {
    double energy;                /* [m2] */
    double power, force2, speed2; /* of fl_fire_next() */
    double max_force;             /* largest |force| on a body [m] */
    double max_overlap;           /* largest delta over the smaller bounding radius, at this scale */
    double overlap_sum, pressure; /* sums over contacts of delta [m], and of delta times the distance [m2] */
    double max_move2;             /* square of the largest displacement since the list was made [m2] */
    int64_t contacts;             /* touching pairs, each once, and contacts with the boundary */
    int64_t wall_contacts;
} fl_overlap_totals;

/* Contact of two bodies that are not both spheres. */
typedef struct {
    int32_t i, j;
    fl_gjk_cache cache;
    fl_vec3 force, torque_i, torque_j; /* on i; about either centre, less opposite on j [m], [m2] */
    double energy;                     /* 0: no contact [m2] */
    double deepest, strength;          /* largest delta of its points; |force| [m] */
    double distance;                   /* of the centres [m] */
} fl_overlap_pair;

/* A sphere at the present scale. */
typedef struct {
    fl_vec3 x;
    double r;
} fl_overlap_ball;

typedef struct {
    fl_packing *p; /* borrowed, as the region */
    const fl_pack_region *region;
    fl_pairs candidates;
    fl_aabb *box;   /* [n] */
    int64_t *first; /* [n + 1] neighbours of i, each pair from both sides */
    int32_t *near, near_cap, first_cap;
    int64_t *near_pair; /* where there are shapes: pair of each neighbour */
    int32_t near_pair_cap;
    uint8_t *at_wall;            /* [n] the boundary is near */
    double reach, skin;          /* scale up to which the list holds; [m] */
    fl_vec3 *listed_at;          /* [n] where bodies were then [m] */
    fl_vec3 period, half_period; /* 0 and infinite where not periodic [m] */
    fl_overlap_ball *ball;       /* [n] of the last evaluation, of spheres */
    double *mass;                /* [n] fictitious */
    fl_vec3 *force, *torque;     /* [n] torque over rho [m] */
    fl_vec3 *v, *spin;           /* [n] velocities; spin times rho [m] */
    double *wall_force;          /* [walls] sum of overlaps on each wall, of the last evaluation [m] */
    double *block_wall;          /* [blocks][walls] */
    fl_overlap_totals *block;    /* [blocks] */
    int32_t blocks;
    fl_overlap_pair *pair; /* of shapes */
    int32_t pairs, pair_cap;
    fl_vec3 *corner, *normal; /* of all bodies, at corner_first, normal_first */
    int32_t *corner_first, *normal_first;
    int stale;  /* the list is made anew at the next evaluation */
    int strict; /* the balance of every body counts, not that of most */
    fl_fire fire;
    fl_overlap_totals now; /* of the last evaluation */
    int64_t steps, lists;  /* FIRE steps and neighbour lists so far */
} fl_overlaps;

/* -1 with FL_SYSTEM. */
int fl_overlaps_make(fl_overlaps *o, fl_packing *p, const fl_pack_region *region, fl_err *err);

/* Energy, forces and totals at the scale of the packing.  -1 with FL_SYSTEM. */
int fl_overlaps_evaluate(fl_overlaps *o, fl_err *err);

enum fl_relaxed {
    FL_RELAXED_FREE,   /* no overlap above `free` of the smaller body */
    FL_RELAXED_JAMMED, /* forces balance (of bodies with edges the energy stalls), overlaps remain */
    FL_RELAXED_SLOW    /* neither, after the given steps */
};

/* Relax from rest.
 *   free     overlap over the smaller bounding radius that counts as none
 *   balance  root mean square of the forces on bodies, or where `strict` the largest, over the mean overlap
 *            of the contacts, that counts as balance
 *   steps    at most
 * Returns enum fl_relaxed, or -1 with FL_SYSTEM. */
int fl_overlaps_relax(fl_overlaps *o, double free, double balance, int64_t steps, fl_err *err);

/* Contacts of the last evaluation: calls `with` for each touching pair (j >= 0) and each contact with the
 * boundary (j = -1 - wall).
 *   n      direction on i
 *   delta  overlap [m] */
typedef void fl_overlap_call(void *with, int32_t i, int32_t j, fl_vec3 n, double delta);
void fl_overlaps_each(const fl_overlaps *o, fl_overlap_call *call, void *with);

void fl_overlaps_free(fl_overlaps *o); /* accepts a zeroed struct, leaves one */

#endif
