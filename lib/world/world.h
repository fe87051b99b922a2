/* SPDX-License-Identifier: GPL-3.0-or-later */
/* world.h -- everything that a scene sets in motion: bodies, what is held, pairs, laws, surroundings, ledger.
 *
 * Indices [0, n) are floes; then come the pieces of the structure, then the walls of the boundary. */
#ifndef FL_WORLD_WORLD_H
#define FL_WORLD_WORLD_H
#include "base/gate.h"
#include "base/portion.h"
#include "body/body.h"
#include "bound/cell.h"
#include "bound/shell.h"
#include "broad/pairs.h"
#include "geom/topology.h"
#include "narrow/deep.h"
#include "narrow/places.h"
#include "scene/field.h"
#include "scene/scene.h"
#include "step/ball.h"
#include "step/team.h"
#include "water/sea.h"
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
#define FL_OVERLAP_HALF 0.5

typedef struct {
    const fl_scene *scene; /* borrowed */
    fl_bodies b;
    fl_topologies alike; /* of cores and outer shapes */
    int points;          /* some core is a point: they ask others for the offsets of their faces */
    int32_t n, pieces, walls;
    fl_structure structure;
    fl_cell cell;
    fl_ride ride;
    fl_press press;
    fl_beds bed;
    fl_traffic traffic;
    fl_row row;
    fl_sleep sleep;
    fl_frozen frozen;
    fl_sea sea;        /* water and wind; n = 0 where there are none */
    int32_t *id;       /* [n] as in the ice file                 */
    int32_t *material; /* [total] of the scene, or FL_SCENE_STRUCTURE, FL_SCENE_BOUNDARY */
    double *face;      /* [total] area of the largest face [m2]  */
    fl_quat *q0;       /* [n] body axes in the ice file's pose: orientations are told against it */
    fl_vec3 gravity;
    fl_touching *law; /* [materials][materials + 2]             */
    int32_t materials;
    int32_t rolls; /* some law has what keeps spheres from rolling */

    fl_pairs near;
    fl_aabb *box;    /* [total] while neighbours are searched, NULL else, like */
    fl_vec3 *home;   /* [total] the cell that each is in, where something wraps */
    fl_group *group; /* [n / FL_BALLS_GROUP + 1] */
    fl_balls balls;  /* near pairs of spheres; all others: */
    fl_near *pair;
    fl_pair_store contacts;
    int32_t n_pair, pair_cap;
    int32_t *inc_first; /* [total + 1] pairs of each body, ascending */
    int32_t *inc;       /* [2 n_pair] */
    fl_watch *watch;    /* [n_pair] */
    /* Which pairs touch, apart from the pairs themselves: most do not, and need not be looked at for it. */
    uint8_t *hit;  /* [n_pair] 1: touches, else 0 */
    int32_t *live; /* [n_live] those that do, ascending */
    uint8_t *met;  /* [total] is of one of those */
    int32_t n_live, hit_cap, live_cap, watch_cap;
    fl_portion *share, *turn; /* [threads] of pairs, of groups of bodies; of a step those of its team */
    fl_gate gate;             /* of the team that does a step, */
    fl_team team;             /* and how many they are */
    int32_t inc_cap, inc_first_cap;
    fl_sinks sink, was; /* of the forces of now, and of those before; see works.h */
    /* [gain_cap] at was.place[k], 0: of nobody; of the first kick of a step, and of all of its first half */
    fl_gain *gain, *lead;
    fl_gain *drag; /* [n] of spheres, what of that half was drag's; NULL where there is none */
    int32_t gain_cap;
    double skin;            /* boxes are grown by half of it [m] */
    double *odometer_found; /* [total] odometers at the last search */
    int64_t found_at;       /* step of the last search, -1 before the first */
    double passing;         /* what it took of memory, while it lasted [B] */

    fl_places *scratch;        /* [threads] */
    fl_surrogate_count *told;  /* [threads], NULL where nothing has a surrogate */
    fl_shell_near *near_shell; /* [threads] */
    int32_t threads;

    double dt, dt_critical; /* dt_critical: the smallest 2/omega seen [s] */
    double dt_touching;     /* and that without bonds */
    double dt_safe; /* fl_world_dt() at the start, at most 0.2 of 2/omega; longer steps look more often */
    int32_t critical_body; /* id of the one that had it, -1 */
    int64_t step;
    double t0; /* the time of step `step0`, from which on steps are of dt [s] */
    int64_t step0;
    fl_ledger ledger;
    fl_vec3 *part_impulse,
        *part_moment;                  /* [parts] since the last loads row [N s], [N m s], about part_about */
    fl_vec3 *part_about;               /* [parts] reference point, now [m] */
    fl_vec3 *part_force, *part_torque; /* [parts] now                                                       */
    double *part_peak;                 /* [parts] largest |F| since the last row */
    int32_t parts;
    fl_vec3 imbalance;   /* sum of all contact impulses, floes and held things together: 0 but for rounding */
    double impulse_size; /* sum of their sizes */
    double worst_overlap; /* largest overlap over the sum of the radii (or the radius of the floe) so far */
    int32_t worst_i, worst_j;     /* names of the two, -1 before there are any */
    double worst_time;            /* when [s] */
    int64_t half_steps;           /* steps in which an overlap was past FL_OVERLAP_HALF of the radii */
    int32_t half_i, half_j;       /* who was so first */
    double half_time;             /* and when [s] */
    int64_t touching_steps;       /* sum over steps of pairs in contact */
    int64_t searches, deep_pairs; /* neighbour searches; evaluations with overlapping cores */
    fl_deep_count deep_count;
    int failed; /* a thread ran out of memory */
} fl_world;

/* The number by which tables call a thing: the id of a floe; -1 - part of the structure; walls after those.
 */
int32_t fl_world_name(const fl_world *w, int32_t k);

/* "the wall at x = -5 m", of wall k. */
const char *fl_world_wall(const fl_world *w, int32_t k, char name[64]);

#endif
