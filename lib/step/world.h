/* SPDX-License-Identifier: GPL-3.0-or-later */
/* world.h -- everything that a scene sets in motion: bodies, what is held, pairs, laws, surroundings, ledger.
 *
 * Indices [0, n) are floes; then come the pieces of the structure, then the walls of the boundary. */
#ifndef FL_STEP_WORLD_H
#define FL_STEP_WORLD_H
#include <math.h>
#include "base/gate.h"
#include "base/portion.h"
#include "body/body.h"
#include "bond/bond.h"
#include "bound/cell.h"
#include "bound/flotation.h"
#include "bound/mover.h"
#include "bound/shell.h"
#include "broad/pairs.h"
#include "law/tangent.h"
#include "narrow/contact.h"
#include "narrow/matches.h"
#include "narrow/deep.h"
#include "narrow/gjk.h"
#include "narrow/places.h"
#include "geom/topology.h"
#include "scene/field.h"
#include "scene/scene.h"
#include "step/ball.h"
#include "step/surrogate.h"
#include "step/team.h"
#include "water/added.h"
#include "water/sea.h"

/* A pair of materials, resolved. */
typedef struct {
    int32_t kind;       /* enum fl_law                                       */
    double exponent;    /* n of the polyhedra's places                       */
    double modulus;     /* E* [Pa]                                           */
    double stiffness;   /* given by the user [N/m^n]; 0: from the modulus    */
    double softening;   /* multiplies the stiffness that comes from the modulus */
    double friction;    /* mu                                                */
    double tangential;  /* k_t over the tangent stiffness of the place       */
    double rolling;     /* mu_r of law/rolling.h; 0: nothing keeps a sphere from rolling */
    double chi;         /* D = chi v_impact of patch and core                */
    double rest;        /* c of fl_damping_rest()                            */
    double zeta, alpha; /* of the manual's laws                              */
    double surrogate;   /* tolerance of surrogate.h; 0: none                 */
    double left;        /* what damping by the speed half a step ago leaves of the critical step */
    int32_t literal2, literal18;
} fl_touching;

/* A contact of two things.  What is new here and lasts from step to step, or is new in fl_world, goes into
 * snapshot_pair.c or snapshot.c as well: prop_restart finds what is missing there, once it bears on a bit;
 * what lasts while they do not touch goes into fl_near too. */
typedef struct {
    int32_t i, j;            /* i moves, i < j                                        */
    int32_t image[3];        /* j is where it is, moved by so many lengths of the cell */
    int32_t n;               /* touching                                              */
    fl_slip slip;            /* what friction remembers                               */
    fl_matches *matches;     /* which features may touch, or NULL; can be made again at any time */
    fl_surrogate *surrogate; /* NULL until there is one */
    fl_roll *roll;           /* of a sphere, rolls.h; NULL where nothing keeps it from rolling */
    fl_gjk_cache cache;      /* where the distance query starts                       */
    fl_mode mode;            /* of the manual's laws                                  */
    int32_t deep;            /* the cores overlap                                     */
    int32_t has_axis;        /* axis has been set                                     */
    fl_vec3 axis;            /* from j to i in the frame of j: separates the cores, or did */
    double asleep;           /* while the odometers add up to less, it cannot touch [m] */
    double k;                /* stiffness of one place [N/m^n]; of `patch`, c in W = c sqrt(U) [N/m2] */
    double exponent;         /* n; 0 for `patch` */
    double mass;             /* reduced [kg]                                          */
    double touch;            /* largest approach speed of this touch [m/s]            */
    int32_t bond;            /* 1 + number of the bond that stood here, 0: there was none; frozen.h */
    double keep;             /* so much of its radii counts: 1, but after a bond */
    const fl_touching *law;  /* borrowed */
    /* of the last evaluation; world axes, torques about the two centres */
    fl_vec3 f, ti, tj;       /* force on i (on j its opposite), torques               */
    fl_vec3 fd, di, dj;      /* the part of damping                                   */
    fl_vec3 fs, si, sj;      /* the part of friction                                  */
    double energy;           /* elastic, normal and tangential [J]                    */
    double spring;           /* the tangential part of it [J]                         */
    double overlap;          /* largest [m]                                           */
    double stiff_i, stiff_j; /* bounds of omega^2 of this contact for either, the other held [1/s2] */
    int32_t at;              /* place in fl_world.pair */
} fl_pair;

/* What an evaluation tells, from f on: so many doubles in a row. */
enum { FL_PAIR_TELLS = 32 };
_Static_assert(offsetof(fl_pair, stiff_j) == offsetof(fl_pair, f) + (FL_PAIR_TELLS - 1) * sizeof(double),
               "nothing between them");

/* Two things that are near: what is known of them while they do not touch, and their contact where they do,
 * or did a moment ago, or are left by a bond.  Most near pairs do not touch for most of the time. */
typedef struct {
    int32_t i, j;     /* i moves, i < j */
    int32_t image[3]; /* as in fl_pair, like all that follows */
    uint8_t n : 1, deep : 1, has_axis : 1, cached : 3;
    uint8_t mode;
    double asleep;
    float axis[3];      /* no longer than 1: gaps along it are bounds */
    uint8_t a[4], b[4]; /* of the cache */
    fl_pair *full;      /* or NULL; where there is one it knows better, but for n, deep and asleep */
} fl_near;

/* When a near pair has to be looked at, which is asked in every step: short, to lie close together. */
typedef struct {
    int32_t i, j;
    double until; /* while the odometers add up to less, it cannot touch [m]; -INFINITY: it touches */
} fl_watch;

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

/* Overlaps past this part of the radii are counted: no law is meant for them, and beyond 1 the cores meet. */
#define FL_OVERLAP_HALF 0.5

/* Stores, sinks and sources of energy [J].  The residual is stores - start + taken out - put in: 0 but for
 * the error of the time integration. */
typedef struct {
    double kinetic, gravity, elastic, hydrostatic; /* stores now; elastic with the springs of friction */
    double friction_now, damping_now, drag;        /* taken out since the start                        */
    double wind, drive_now;                        /* put in: by the wind, by what is moved or held    */
    double waves;                                  /* and by waves, the work of buoyancy with it */
    double moving, spring, damper; /* of a structure that moves by itself: in it, in its springs; taken out */
    double bond, fracture;         /* in bonds; taken out by their damage */
    double carried;                /* put in by floes that came, less what left with others */
    double start, residual;
    double throughput; /* largest kinetic energy + |each of the works|: what the residual is held against */
    double friction, damping, drive; /* the works booked so far: with that of the half kick that lies ahead */
} fl_ledger;

/* What damping and friction of its contacts do to a thing: forces and torques about its centre, world axes.
 */
typedef struct {
    fl_vec3 damping, damping_turn, friction, friction_turn;
    int32_t n; /* with 0 all is 0 */
} fl_sink;

/* Those of all that are pressed.  A body has the sink at[place[k]]; at[0] is of all that nothing presses on,
 * and stays 0.  Few touch at a time: only they have one of their own, but where faces are frozen together or
 * somebody sleeps; then place[k] = k + 1.  What rows do to spheres is in their own sums, ball.h. */
typedef struct {
    int32_t *place; /* [total] */
    fl_sink *at;    /* [cap] */
    int32_t cap;
    int all; /* every body has one */
} fl_sinks;

/* How its velocities change in a kick. */
typedef struct {
    fl_vec3 v, w;
} fl_gain;

/* Who is awake and who sleeps, see sleep.h; nap NULL where nobody does. */
enum fl_nap_kind { FL_AWAKE, FL_COASTS, FL_RESTS, FL_ENDS, FL_QUIET };

typedef struct {
    int64_t since;           /* step in which it fell asleep, or woke */
    double way;              /* bound of its path in between, in the odometer already; of who is quiet, that
                              * of the window [m]                                              */
    double mark;             /* odometer when the window of rest began, -1: there is none  [m] */
    double drag;             /* rate at which drag changed the speed of its points last [m/s2] */
    double off, summed;      /* largest error of a step over the radius so far, and all of it  */
    fl_vec3 a, turn;         /* accelerations at the begin of the step that ends               */
    int64_t coasted, rested; /* steps so far                                                   */
    int64_t naps;            /* how often it has coasted                                       */
    int32_t span;            /* steps that it may coast next                                   */
} fl_nap;

typedef struct fl_nap_image fl_nap_image;
typedef struct {
    double tol;
    fl_nap *nap;         /* [n] */
    uint8_t *kind;       /* [n] enum fl_nap_kind */
    int64_t *until;      /* [n] step in which it wakes; of who is awake, in which it may fall asleep at the
                          * earliest */
    fl_nap_image *image; /* [n] */
    int32_t *stack;      /* [n] */
    uint8_t *due;        /* [n_pair] is to be looked at: 1 until it has been */
    int32_t resting, due_cap;
    double rise, slope; /* bounds of the speed and of the slope of the waves' surface [m/s] */
} fl_sleep;

/* Elastic walls: a foundation of springs and dashpots, which a body presses by what of it is behind the wall.
 * Winkler's pressure k_A x depth is that of a heavy fluid of specific weight k_A, so force, moment and energy
 * are those of buoyancy, exact for any attitude and one potential. */
typedef struct {
    double stiffness, damping; /* k_A [N/m3], c_A [N s/m3] */
    fl_poly *outer;            /* [n] sharp outer shapes, body frames; empty where the core is round */
    fl_hull *hull;             /* [n]; NULL: no wall is elastic */
} fl_beds;

/* What of the structure moves, see ride.h; m.n = 0 and no memory where nothing does. */
typedef struct {
    fl_movers m;
    int32_t *part;        /* [parts] its mover, -1: stands still */
    int32_t *of;          /* [pieces + walls] the same */
    fl_vec3 *arm;         /* [pieces + walls] from the reference to the piece, axes of the mover [m] */
    fl_quat *turn;        /* [pieces + walls] axes of the piece in those of the mover */
    double *slope;        /* [movers] of the contacts, for the survey [1/s2] */
    fl_flotation *afloat; /* [movers] volume 0 where the sea was not asked */
    double fastest;       /* bound of the told speeds [m/s] */
} fl_ride;

/* Where the ice presses, see press.h; panels = 0 and no memory where nobody asks. */
typedef struct {
    fl_vec3 v[3], middle; /* in the pose of the file; a cone has its middle three times [m] */
    double area;          /* [m2] */
    int32_t part;
} fl_panel_place;

/* One place of a contact. */
typedef struct {
    int32_t pair, turn, i, part, panel;
    fl_vec3 f;      /* on the floe [N] */
    fl_vec3 n, at;  /* from the structure to the floe; the point, world [m] */
    double normal;  /* [N] */
    double area;    /* of the whole contact [m2] */
    double overlap; /* [m] */
} fl_press_mark;

typedef struct {
    fl_press_mark *mark;
    int32_t *list;
    int32_t n, mark_cap, list_cap;
} fl_press_notes;

typedef struct fl_press_event fl_press_event;
typedef struct {
    int32_t panels, trees, threads;
    fl_panel_place *panel; /* [panels] part by part, triangles before cones */
    fl_aabb *box;          /* [panels] */
    fl_vec3 *impulse;      /* [panels] of the interval [N s] */
    int32_t *first;        /* [parts + 1] */
    fl_bvh *tree;          /* [parts] over the triangles of each */
    int32_t *cone;         /* [pieces + walls] panel of a cone, -1 for others */
    fl_press_notes *noted; /* [threads] */
    fl_press_mark *now;    /* [n_now] of all pairs, in their order */
    fl_press_event *event; /* [events] of the interval, by floe and part */
    int32_t n_now, now_cap, events, event_cap;
} fl_press;

/* Floes that leave, and floes that come in.  Every floe has a place in the arrays, [0, n); that of one that
 * has left is empty and is taken again by one that comes, so memory is bounded by what is there at a time.
 *
 * What comes in is a field, copied again and again against the drift: an endless sheet that moves at one
 * speed.  Copy m of floe k is due when its foremost point reaches the bound, at t = (lag[k] + m pitch) /
 * speed. It is then given its place, and is guided: held in x, y and about z, so that it drifts as the sheet
 * does whatever is in its way, until the last of it is inside. */
typedef struct {
    uint8_t *away;  /* [n] nobody is in this place; NULL: nobody leaves or comes, and the rest is not there */
    fl_vec3 lo, hi; /* who is wholly beyond leaves [m]; infinite where nobody does */
    int64_t *born;  /* [n] the step in which it came                               */
    int64_t left, entered;
    double mass_left, mass_entered;          /* [kg]    */
    fl_vec3 momentum_left, momentum_entered; /* [kg m/s] */
    const fl_field *feed,
        *ice; /* borrowed: what comes in, and what stood there at first; NULL: nobody comes */
    int axis; /* of the drift: 0 x, 1 y */
    double sign, entry, speed, pitch; /* +1: upwards; the bound, times sign [m]; [m/s]; [m] */
    double *lag;                      /* [feed->n] [m] */
    int64_t *tile;                    /* [feed->n] m of the copy that is next */
    int32_t *floe;                    /* [n] which of feed; -1: one of the ice file */
    uint8_t *guided, *hold;           /* [n] whether; what else holds it afterwards */
    int32_t next_id;
    int64_t waited, missed; /* floes whose place was taken; that had to be given up a pitch later */
} fl_traffic;

/* The edge row of ice that is driven: held at a velocity, and on a spring in heave where that is free. */
typedef struct {
    int32_t n;    /* floes of the ice file, or 0: nobody is driven */
    uint8_t *in;  /* [n] is driven */
    double *k;    /* [n] spring [N/m]            */
    double *rest; /* [n] the height it pulls to [m] */
} fl_row;

/* Faces frozen together, see frozen.h; n = 0 and no memory where nothing is. */
typedef struct {
    int32_t n;
    fl_bond *bond;  /* [n] by (i, j) */
    int32_t *image; /* [3 n] j is where it is, moved by so many lengths of the cell */
    double *keep;   /* [n] of the pair that an ended bond leaves, see there; 0: not looked at yet */
    double *stiff;  /* [2 n] shares of omega^2 of i and of j [1/s2] */
    double *most;   /* [bodies] omega^2 by all its bonds [1/s2] */
    int64_t *first; /* [bodies + 1] */
    int32_t *of;    /* [2 n] bonds of each body, ascending */
    int ended;      /* a bond ended in this step */
} fl_frozen;

/* What a step tells of a group of bodies, FL_BALLS_GROUP in a row. */
typedef struct {
    fl_vec3 pushed;        /* sum of the forces of contacts [N]                      */
    double damped, rubbed; /* taken out by damping and friction in the step [J] */
    int32_t lost;          /* the first that has a number which is not finite, or -1 */
    double moved[2];       /* the longest ways since the last search, after the first half of a step [m] */
} fl_group;

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

/* Build everything from what was read.  field and surface are read once and stay the caller's.
 *   surface  NULL for a scene without structure
 * -1 with FL_INPUT (a body without a volume where one is needed, mass not positive), FL_SYSTEM or
 * FL_NUMERIC. */
int fl_world_make(fl_world *w, const fl_scene *scene, const fl_field *field, const fl_surface *surface,
                  fl_err *err);

/* The same where another field than that of the ice comes in: scene->boundary.inflow = file.  Where
 * floes come in both fields are borrowed until fl_world_free(). */
int fl_world_make_fed(fl_world *w, const fl_scene *scene, const fl_field *field, const fl_field *feed,
                      const fl_surface *surface, fl_err *err);
void fl_world_free(fl_world *w);

/* Time now [s].  Steps are of one size, or change it at times that are known exactly. */
static inline double fl_world_time(const fl_world *w) { return w->t0 + (double)(w->step - w->step0) * w->dt; }
/* Put floe k of a field into place i, whoever was there before: at the field's own pose, at rest in the
 * books. -1 as fl_world_make(). */
int fl_world_put(fl_world *w, int32_t i, const fl_field *field, int32_t k, fl_err *err);

/* The spring of a driven floe in place i: its stiffness [N/m], 0 where there is none, and how far it is drawn
 * upwards of its rest [m]. */
static inline double fl_world_spring(const fl_world *w, int32_t i, double *drawn)
{
    if (i >= w->row.n || !w->row.in[i] || (w->traffic.away && w->traffic.floe[i] >= 0)) return 0.0;
    *drawn = w->b.x[i].z - w->row.rest[i];
    return w->row.k[i];
}

/* The number by which tables call a thing: the id of a floe; -1 - part of the structure; walls after those.
 */
int32_t fl_world_name(const fl_world *w, int32_t k);

/* -1 with FL_INPUT where the centre of a floe is behind a rigid wall, from where none comes back but with the
 * energy of a push as long. */
int fl_world_before_walls(const fl_world *w, fl_err *err);

/* "the wall at x = -5 m", of wall k. */
const char *fl_world_wall(const fl_world *w, int32_t k, char name[64]);

/* The piece or wall that thing j is, NULL where it is a floe. */
static inline const fl_piece *fl_world_piece(const fl_world *w, int32_t j)
{
    return j < w->n ? NULL : &w->structure.piece[j - w->n];
}

/* From thing i to j, or to the image of it that is meant [m]. */
static inline fl_vec3 fl_world_way(const fl_world *w, int32_t i, int32_t j, const int32_t image[3])
{
    const fl_vec3 way = v3_sub(w->b.x[j], w->b.x[i]);
    return w->cell.wraps ? v3_add(way, fl_cell_way(&w->cell, v3(image[0], image[1], image[2]))) : way;
}

/* Pair c is watched as it is known now. */
static inline void fl_world_watch(fl_world *w, int32_t c)
{
    const fl_near *p = &w->pair[c];
    w->watch[c] = (fl_watch){p->i, p->j, p->n ? -INFINITY : p->asleep};
}

/* Whether pair c still cannot touch since it was last looked at. */
static inline int fl_world_apart(const fl_world *w, int32_t c)
{
    const fl_watch q = w->watch[c];
    return w->b.odometer[q.i] + w->b.odometer[q.j] < q.until;
}

/* Whether place i < n is empty. */
static inline int fl_world_away(const fl_world *w, int32_t i)
{
    return w->traffic.away && w->traffic.away[i];
}

#endif
