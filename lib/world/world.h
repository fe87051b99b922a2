/* SPDX-License-Identifier: GPL-3.0-or-later */
/* world.h -- the state of a simulation: bodies, structure, walls, contacts, water, energy ledger.
 *
 * Things are numbered: [0, n) floes, then `pieces` pieces of the structure, then `walls` walls of the
 * boundary; total = n + pieces + walls = b.total.  world/ has types and accessors; sim/setup.h builds a
 * world, sim/step.h advances it. */
#ifndef FL_WORLD_WORLD_H
#define FL_WORLD_WORLD_H
#include "base/barrier.h"
#include "base/thread_count.h"
#include "base/work_share.h"
#include "body/body.h"
#include "broad/pairs.h"
#include "geom/topology.h"
#include "narrow/penetration.h"
#include "patch/patch_points.h"
#include "patch/quick_rows.h"
#include "scene/ice_field.h"
#include "scene/scene.h"
#include "structure/mesh_contact.h"
#include "structure/periodic_cell.h"
#include "water/environment.h"
#include "world/body_block.h"
#include "world/bond_state.h"
#include "world/breaking_state.h"
#include "world/contact_sums.h"
#include "world/crushing_state.h"
#include "world/device_link.h"
#include "world/disc_state.h"
#include "world/driven_floes.h"
#include "world/elastic_walls.h"
#include "world/inflow_state.h"
#include "world/ledger.h"
#include "world/moving_parts.h"
#include "world/pair.h"
#include "world/panel_state.h"
#include "world/push_state.h"
#include "world/relax_state.h"
#include "world/sleep_state.h"
#include "world/sphere_contacts.h"
#include "world/strip_state.h"
#include "world/zone_state.h"

/* Overlaps above this fraction of the sum of the radii are counted: no contact law is meant for them.  At 1
 * the cores meet. */
#define FL_DEEP_OVERLAP 0.5

/* Contacts that began deeper than the two bodies moved in the step. No motion makes one, so the surface of a
 * part is not what it seems: it crosses itself, its normals are mixed, or it is open and ice comes from
 * behind. */
typedef struct {
    int64_t n;             /* such contacts so far */
    int64_t step;          /* of the first; of several in one step the one of the lowest bodies */
    int32_t i, j;          /* its bodies */
    double overlap, moved; /* its overlap, and the way of the two in that step [m] */
    double time;           /* [s] */
} fl_sudden_contacts;

typedef struct {
    const fl_scene *scene; /* borrowed */

    /* bodies and their surroundings */
    fl_bodies b;
    fl_topologies topologies; /* of cores and outer shapes */
    double slab_fill;         /* mass of a sphere over that of its volume, ice.slab; 1 without */
    int has_points;           /* some core is a point, whose contacts need face offsets of the other cores */
    int32_t n, pieces, walls;
    fl_structure structure;
    fl_periodic_cell cell;
    fl_moving_structure moving;
    fl_panel_loads panel_load;
    fl_strips strips; /* crushing by speed */
    fl_elastic_walls elastic_walls;
    fl_inflow_state inflow;
    fl_crushing_state crushing;
    fl_breaking_state breaking;
    fl_driven_floes driven_floes;
    fl_push push;
    fl_device_link device;
    fl_sleep sleep;
    fl_relax_state relax;
    int64_t stage_step;          /* step at which the last stage began */
    int32_t next_stage;          /* of the scene */
    fl_bond_list bonds;          /* faces */
    fl_disc_list discs;          /* of spheres */
    fl_zone_state zones;         /* deformable blocks */
    fl_environment sea;          /* water and wind; n = 0 without them */
    int32_t *id;                 /* [n] number in the ice file */
    int32_t *material;           /* [total] of the scene, or FL_SCENE_STRUCTURE, FL_SCENE_BOUNDARY */
    double *max_face_area;       /* [total] [m2] */
    fl_quick_shape *quick_shape; /* [total] tables of the law `quick`, without faces where it does not apply;
                                  * NULL if no pair has that law */
    fl_quat *q0; /* [n] body axes in the pose of the ice file: the reference of written orientations */
    fl_vec3 gravity;
    fl_pair_law *law; /* [materials][materials + 2] */
    int32_t materials;
    int32_t has_rolling; /* some law has rolling resistance */

    /* neighbours and contacts */
    fl_pairs candidates;
    fl_aabb *box;               /* [total] during a neighbour search, NULL else, like: */
    fl_vec3 *cell_of_body;      /* [total] periodic cell that each body is in */
    fl_body_block *blocks;      /* [n / FL_BODY_BLOCK + 1] */
    fl_sphere_contacts spheres; /* near pairs of spheres, and of spheres and walls; all others: */
    fl_neighbour_pair *pair;    /* [n_pair] */
    fl_pair_store pair_store;
    int32_t n_pair, pair_cap;
    int32_t *first_pair_of_body; /* [total + 1] offsets into pairs_of_body */
    int32_t *pairs_of_body;      /* [2 n_pair] pairs of each body, ascending */
    fl_next_check *next_check;   /* [n_pair] */
    /* which pairs touch: apart from the pairs, as most do not touch and need not be read for it */
    uint8_t *pair_touches;   /* [n_pair] 0 or 1 */
    int32_t *touching_pairs; /* [n_touching] ascending */
    uint8_t *body_touches;   /* [total] the body has a touching pair */
    int32_t n_touching, pair_touches_cap, touching_pairs_cap, next_check_cap;
    fl_work_share *pair_share,
        *block_share;     /* [threads] ranges of pairs, of blocks; used: those of the team */
    fl_barrier barrier;   /* of the team of a step */
    fl_thread_count team; /* number of threads of the team */
    int32_t pairs_of_body_cap, first_pair_of_body_cap;
    fl_contact_sums contact_sums, previous_sums; /* of this step and of the one before; energy_ledger.h */
    /* [change_cap] at previous_sums.slot[k], 0: none; by the first kick, and by the first half of a step */
    fl_velocity_change *kick_change, *predicted_change;
    fl_velocity_change *drag_change; /* [n] of spheres: by drag in that first half; NULL without drag */
    int32_t change_cap;
    double skin;                /* boxes are larger by half of it on each side [m] */
    double *odometer_at_search; /* [total] odometers at the last search */
    int64_t last_search_step;   /* -1 before the first search */
    double search_bytes;        /* memory that the last search used while it ran [B] */

    /* scratch */
    fl_patch_points *scratch;             /* [threads] */
    fl_quick_scratch *quick_scratch;      /* [threads], NULL without the law `quick` */
    fl_surrogate_count *surrogate_counts; /* [threads], NULL without surrogates */
    fl_mesh_contact_work *mesh_near;      /* [threads] */
    int32_t threads;

    /* time */
    double dt, dt_critical;      /* step; smallest 2/omega seen [s] */
    double dt_critical_contacts; /* smallest 2/omega by contacts alone, without bonds [s] */
    double dt_safe;        /* fl_automatic_step() at the start, at most 0.2 of 2/omega; a longer step updates
                     * stiffnesses more often [s] */
    int automatic_dt;      /* dt is that of fl_automatic_step(): overlaps at the start may shorten it */
    int32_t critical_body; /* body of dt_critical; b.total + mover for a mover; -1: none */
    int64_t step;
    double t0; /* time of step step0; from there on steps are of dt [s] */
    int64_t step0;

    /* results */
    fl_ledger ledger;
    fl_vec3 *part_impulse, *part_moment; /* [parts] since the last row of the loads [N s], [N m s]; moments
                                          * about part_reference */
    fl_vec3 *part_reference;             /* [parts] reference point now [m] */
    fl_vec3 *part_force, *part_torque;   /* [parts] now [N], [N m] */
    double *part_peak;                   /* [parts] largest |F| since the last row [N] */
    int32_t parts;
    fl_vec3 imbalance;  /* sum of all contact impulses on all things: 0 but for rounding [N s] */
    double impulse_sum; /* sum of their magnitudes [N s] */
    double max_overlap; /* largest overlap over the sum of the radii so far */
    int32_t max_overlap_i, max_overlap_j;   /* ids of the two, -1 without any overlap */
    double max_overlap_time;                /* [s] */
    int64_t deep_overlap_steps;             /* steps with an overlap above FL_DEEP_OVERLAP */
    int32_t deep_overlap_i, deep_overlap_j; /* ids of the first two with such an overlap */
    double deep_overlap_time;               /* and its time [s] */
    fl_sudden_contacts sudden;              /* contacts that begin deeper than the bodies moved */
    int64_t contact_steps;                  /* sum over steps of the number of contacts */
    int64_t searches, overlapping_cores;    /* neighbour searches; evaluations with overlapping cores */
    fl_penetration_count penetration_count;
    int failed; /* a thread ran out of memory */
} fl_world;

/* Number of thing k in the tables: the id of a floe; -1 - part for a piece; walls after those. */
int32_t fl_world_id(const fl_world *w, int32_t k);

/* Name of wall k, such as "the wall at x = -5 m". */
const char *fl_wall_name(const fl_world *w, int32_t k, char name[64]);

#endif
