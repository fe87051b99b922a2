/* SPDX-License-Identifier: GPL-3.0-or-later */
/* world.h -- everything that a scene sets in motion: bodies, what is held, pairs, laws, surroundings, ledger.
 *
 * Indices [0, n) are floes; then come the pieces of the structure, then the walls of the boundary. */
#ifndef FL_WORLD_WORLD_H
#define FL_WORLD_WORLD_H
#include "base/barrier.h"
#include "base/work_share.h"
#include "body/body.h"
#include "structure/periodic_cell.h"
#include "structure/mesh_contact.h"
#include "broad/pairs.h"
#include "geom/topology.h"
#include "narrow/penetration.h"
#include "patch/patch_points.h"
#include "scene/ice_field.h"
#include "scene/scene.h"
#include "world/sphere_contacts.h"
#include "base/thread_count.h"
#include "water/environment.h"
#include "world/bond_state.h"
#include "world/contact_sums.h"
#include "world/driven_floes.h"
#include "world/elastic_walls.h"
#include "world/group_state.h"
#include "world/inflow_state.h"
#include "world/ledger.h"
#include "world/moving_parts.h"
#include "world/pair.h"
#include "world/panel_state.h"
#include "world/sleep_state.h"

/* Overlaps past this part of the radii are counted: no law is meant for them, and beyond 1 the cores meet. */
#define FL_DEEP_OVERLAP 0.5

typedef struct {
    const fl_scene *scene; /* borrowed */
    fl_bodies b;
    fl_topologies topologies; /* of cores and outer shapes */
    int has_points;           /* some core is a point: they ask others for the offsets of their faces */
    int32_t n, pieces, walls;
    fl_structure structure;
    fl_periodic_cell cell;
    fl_moving_structure moving;
    fl_panel_loads panel_load;
    fl_elastic_walls elastic_walls;
    fl_inflow_state inflow;
    fl_driven_floes driven_floes;
    fl_sleep sleep;
    fl_bond_list bonds;
    fl_environment sea;    /* water and wind; n = 0 where there are none */
    int32_t *id;           /* [n] as in the ice file                 */
    int32_t *material;     /* [total] of the scene, or FL_SCENE_STRUCTURE, FL_SCENE_BOUNDARY */
    double *max_face_area; /* [total] area of the largest face [m2]  */
    fl_quat *q0;           /* [n] body axes in the ice file's pose: orientations are told against it */
    fl_vec3 gravity;
    fl_pair_law *law; /* [materials][materials + 2]             */
    int32_t materials;
    int32_t has_rolling; /* some law has what keeps spheres from rolling */

    fl_pairs candidates;
    fl_aabb *box;               /* [total] while neighbours are searched, NULL else, like */
    fl_vec3 *cell_of_body;      /* [total] the cell that each is in, where something wraps */
    fl_body_block *blocks;      /* [n / FL_BODY_BLOCK + 1] */
    fl_sphere_contacts spheres; /* near pairs of spheres; all others: */
    fl_neighbour_pair *pair;
    fl_pair_store pair_store;
    int32_t n_pair, pair_cap;
    int32_t *first_pair_of_body; /* [total + 1] pairs of each body, ascending */
    int32_t *pairs_of_body;      /* [2 n_pair] */
    fl_next_check *next_check;   /* [n_pair] */
    /* Which pairs touch, apart from the pairs themselves: most do not, and need not be looked at for it. */
    uint8_t *pair_touches;   /* [n_pair] 1: touches, else 0 */
    int32_t *touching_pairs; /* [n_live] those that do, ascending */
    uint8_t *body_touches;   /* [total] is of one of those */
    int32_t n_touching, pair_touches_cap, touching_pairs_cap, next_check_cap;
    fl_work_share *pair_share,
        *block_share;     /* [threads] of pairs, of groups of bodies; of a step those of its team */
    fl_barrier barrier;   /* of the team that does a step, */
    fl_thread_count team; /* and how many they are */
    int32_t pairs_of_body_cap, first_pair_of_body_cap;
    fl_contact_sums contact_sums,
        previous_sums; /* of the forces of now, and of those before; see energy_ledger.h */
    /* [gain_cap] at was.place[k], 0: of nobody; of the first kick of a step, and of all of its first half */
    fl_velocity_change *kick_change, *predicted_change;
    fl_velocity_change
        *drag_change; /* [n] of spheres, what of that half was drag's; NULL where there is none */
    int32_t change_cap;
    double skin;                /* boxes are grown by half of it [m] */
    double *odometer_at_search; /* [total] odometers at the last search */
    int64_t last_search_step;   /* step of the last search, -1 before the first */
    double search_bytes;        /* what it took of memory, while it lasted [B] */

    fl_patch_points *scratch;             /* [threads] */
    fl_surrogate_count *surrogate_counts; /* [threads], NULL where nothing has a surrogate */
    fl_mesh_contact_work *mesh_near;      /* [threads] */
    int32_t threads;

    double dt, dt_critical;      /* dt_critical: the smallest 2/omega seen [s] */
    double dt_critical_contacts; /* and that without bonds */
    double
        dt_safe; /* fl_automatic_step() at the start, at most 0.2 of 2/omega; longer steps look more often */
    int32_t critical_body; /* id of the one that had it, -1 */
    int64_t step;
    double t0; /* the time of step `step0`, from which on steps are of dt [s] */
    int64_t step0;
    fl_ledger ledger;
    fl_vec3 *part_impulse,
        *part_moment;                  /* [parts] since the last loads row [N s], [N m s], about part_about */
    fl_vec3 *part_reference;           /* [parts] reference point, now [m] */
    fl_vec3 *part_force, *part_torque; /* [parts] now                                                       */
    double *part_peak;                 /* [parts] largest |F| since the last row */
    int32_t parts;
    fl_vec3 imbalance;  /* sum of all contact impulses, floes and held things together: 0 but for rounding */
    double impulse_sum; /* sum of their sizes */
    double max_overlap; /* largest overlap over the sum of the radii (or the radius of the floe) so far */
    int32_t max_overlap_i, max_overlap_j; /* names of the two, -1 before there are any */
    double max_overlap_time;              /* when [s] */
    int64_t deep_overlap_steps; /* steps in which an overlap was past FL_DEEP_OVERLAP of the radii */
    int32_t deep_overlap_i, deep_overlap_j; /* who was so first */
    double deep_overlap_time;               /* and when [s] */
    int64_t contact_steps;                  /* sum over steps of pairs in contact */
    int64_t searches, overlapping_cores;    /* neighbour searches; evaluations with overlapping cores */
    fl_penetration_count penetration_count;
    int failed; /* a thread ran out of memory */
} fl_world;

/* The number by which tables call a thing: the id of a floe; -1 - part of the structure; walls after those.
 */
int32_t fl_world_id(const fl_world *w, int32_t k);

/* "the wall at x = -5 m", of wall k. */
const char *fl_wall_name(const fl_world *w, int32_t k, char name[64]);

#endif
