/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gpu_view.h -- the state of spheres as kernels see it: numbers, and pointers into the memory of the device.
 * A kernel gets it by value.  C17 and C++17; no function.
 *
 * A body is known by its number in the world, which is also its place; rows are sorted by (i, j, image) as on
 * the CPU, and each body adds its rows in the order of its links.  So neither the memory nor the moment of a
 * list changes a bit.  Bodies with host not 0, the guests, are moved by the CPU; their states come in before
 * rows are evaluated. */
#ifndef FL_GPU_GPU_VIEW_H
#define FL_GPU_GPU_VIEW_H
#include <stdint.h>
#include "bond/disc_types.h"
#include "geom/quat.h"
#include "gpu/gpu_near.h"
#include "water/sphere_water_kernel.h"
#include "world/body_block.h"
#include "world/sphere_contacts.h"

/* What a row leaves for its two bodies and for the sums of its chunk. */
typedef struct {
    fl_vec3 n;
    double elastic, overlap, slope, size; /* F_e, s, dF_e/ds, |F| */
} fl_gpu_row_result;

/* Parameters of a contact law. */
typedef struct {
    double friction, tangential, impact_damping, slow_factor2, rolling;
    double stiffness, stiffness_factor, modulus, round_young; /* of a new contact, as in fl_pair_law */
} fl_gpu_law;

/* A rigid wall: normal into the domain, and point. */
typedef struct {
    fl_vec3 n, x;
} fl_gpu_wall;

/* What the CPU tells of a guest before rows are evaluated. */
typedef struct {
    fl_sphere_state state;
    fl_vec3 yields; /* diagonal of the inverse masses [1/kg] */
    double inverse; /* inverse mass along a free direction [1/kg] */
} fl_gpu_guest_state;

/* What the CPU tells of a guest after its step. */
typedef struct {
    fl_vec3 contact_force;              /* [N] */
    double damping_work, friction_work; /* [J] */
    int64_t is_finite;
} fl_gpu_guest_work;

/* What the device tells of a guest: its sums and touching contacts. */
typedef struct {
    fl_sphere_sum sum;
    int64_t contacts;
} fl_gpu_guest_sum;

/* Who moves a body: the device; the CPU; nobody, a place of no body.  A new guest is one since a search
 * within this step, whose first half the device has done. */
enum { FL_GPU_OWN, FL_GPU_GUEST, FL_GPU_NEW_GUEST, FL_GPU_EMPTY };

/* Numbers that change in a step. */
typedef struct {
    int32_t ended;    /* bonds that ended in this step */
    int32_t touching; /* pairs that touch */
} fl_gpu_control;

typedef struct {
    /* of the run */
    int32_t n, rows, walls, discs, guests, guest_discs, chunks, blocks, wall_planes;
    int32_t
        floats; /* 0: dry; 1: drag and buoyancy; 2: the same where bonds make the sheet (floating_batch.h) */
    int32_t linear, has_rolling, damped_discs;
    double dt, step; /* step: its number */
    fl_vec3 gravity;
    fl_vec3 cell_lo, cell_length; /* periodic cell [m] */
    fl_vec3 domain_lo, domain_hi; /* bounds where bodies leave, infinite for others [m] */
    /* still water */
    fl_sphere_drag drag;
    double level, specific_weight, heave_factor, gravity_size;

    /* bodies [n] */
    const uint8_t *host;
    fl_sphere_state *state;
    fl_vec3 *L, *f, *t;
    fl_quat *q;
    const double *m, *invm, *turn, *inertia; /* turn: 1/I */
    double *odometer;
    const double *odometer_at_search;
    fl_vec3 *yields; /* diagonal of the inverse masses, where it depends on the direction */
    double *inverse; /* inverse mass along a free direction */
    int32_t *contact_count;
    fl_sphere_sum *sum, *previous_sum;
    fl_vec3 *contact_force;
    double *damping_work, *friction_work;
    uint8_t *bad;         /* a number of the body is not finite */
    const double *extent; /* reach of the body from its centre [m]; NULL: bodies stay in the domain */
    uint8_t *leaves;      /* [blocks] an own body is beyond a bound where bodies leave */
    /* in water */
    double *heave_mass, *heave_work; /* NULL without added mass */
    double *wetted_area, *buoyancy, *drag_loss;
    const double *drag_radius, *volume, *surface, *fill;

    /* rows [rows] */
    int32_t *row_i, *row_j, *row_law;
    int32_t *row_image; /* [3 rows]; NULL without a periodic cell */
    uint8_t *touches;
    fl_sphere_contact *contact;
    fl_rolling_spring *rolling;
    fl_gpu_row_result *result;
    int32_t *first;      /* [n + 1] rows of body i */
    int32_t *link_first; /* [n + 1] */
    int32_t *link;       /* row * 2, + 1 if the body is its j */
    const fl_gpu_law *law;

    /* contacts with walls [walls] */
    fl_wall_contact *wall;
    fl_rolling_spring *wall_rolling;
    fl_gpu_row_result *wall_result;
    const int32_t *wall_of_body;  /* [n + 1] */
    const int32_t *wall_of_chunk; /* [chunks + 1] */
    const fl_gpu_wall *plane;     /* [wall_planes] */
    int32_t plane_first;          /* number of the first wall */
    fl_wall_load *wall_load;      /* [chunks][wall_planes] */

    /* bonds [discs] */
    fl_disc_law disc_law;
    const fl_disc_class *disc_class;
    const uint16_t *disc_which;
    const int32_t *disc_i, *disc_j;
    const double *disc_scatter; /* NULL: 1 */
    const fl_vec3 *disc_shift;  /* NULL without a periodic cell */
    const double *disc_k;       /* kappa of the contact that a bond leaves */
    fl_disc_memory *disc;
    fl_disc_wrench *disc_out;
    uint8_t *disc_whole, *disc_ended, *disc_done;
    double *disc_size, *disc_pending;
    const int64_t *disc_first_i, *disc_first_j;
    const int32_t *disc_of;
    double *disc_force_sum; /* [discs / FL_DISC_RUN + 1] */

    /* bodies near the structure, held or driven; their pairs with pieces */
    int32_t pairs, nears;
    const int32_t *near_of; /* [n] 1 + index into near_body, 0: none; NULL: of no body */
    fl_gpu_near *near_body; /* [nears] */
    const fl_gpu_piece *piece;
    fl_gpu_pair *pair;      /* [pairs] */
    int32_t *pair_count;    /* [pairs + 1] 1: touches; then the number of those before */
    fl_gpu_pair *told_pair; /* [pairs] those that touch, in front */
    /* vertices, normals, plane offsets and loops of all solid pieces and meshes; cones of the faces */
    fl_vec3 *piece_v, *piece_n;
    double *piece_c;
    int32_t *piece_first, *piece_loop, *piece_cone;
    fl_free_cone *free_cone;
    fl_interval *free_interval;
    const int32_t *tile; /* of rows on meshes */

    const int32_t *again; /* bodies whose sums are computed again, after a partner has left */

    /* guests */
    const int32_t *guest; /* [guests] */
    fl_gpu_guest_state *guest_state;
    fl_gpu_guest_work *guest_work;
    fl_gpu_guest_sum *guest_sum;
    const int32_t *guest_disc;    /* [guest_discs] bonds of guests */
    fl_disc_wrench *guest_wrench; /* [guest_discs] */

    /* the list, while it is made */
    double skin;
    double cell_scale[3]; /* cells a metre */
    int32_t cells[3];     /* in a direction with a period, else 0 */
    int32_t law_columns;
    const int32_t *material;             /* [n] */
    uint64_t *key;                       /* [n] */
    int32_t *order;                      /* [n] bodies by their keys */
    int32_t *lower;                      /* [links] partners of each body with smaller numbers, ascending */
    int32_t *new_first, *new_link_first; /* [n + 1] */
    int32_t *new_row_i, *new_row_j, *new_row_law, *new_row_image;
    uint8_t *new_touches;
    fl_sphere_contact *new_contact;
    fl_rolling_spring *new_rolling;
    const int32_t *disc_image; /* [3 discs]; NULL without a periodic cell */

    /* sums */
    fl_body_block *block;    /* [blocks] */
    fl_chunk_totals *totals; /* [chunks] */
    double *moves;           /* two largest of each group, level after level */
    double *omega2;          /* [n] */
    fl_gpu_control *control;
} fl_gpu_view;

/* The kernels, and what one thread of each works on. */
#define FL_GPU_KERNELS(X)                                                                                    \
    X(TAKE_GUESTS, fl_gpu_take_guest)     /* a guest: its state */                                           \
    X(FIRST_HALF, fl_gpu_first_half)      /* a body: drag, kick, drift */                                    \
    X(BLOCK_MOVES, fl_gpu_block_moves)    /* a block: its two largest paths */                               \
    X(ROWS, fl_gpu_row)                   /* a row: the contact of two spheres */                            \
    X(WALLS, fl_gpu_wall_row)             /* a contact with a wall */                                        \
    X(DISCS, fl_gpu_disc)                 /* a bond */                                                       \
    X(PAIRS, fl_gpu_near_pair)            /* a pair of a sphere and a piece */                               \
    X(TELL_PAIRS, fl_gpu_tell_pair)       /* a pair that touches */                                          \
    X(TELL_GUESTS, fl_gpu_tell_guest)     /* a guest: its sums */                                            \
    X(TELL_DISCS, fl_gpu_tell_guest_disc) /* a bond of a guest */                                            \
    X(SECOND_HALF, fl_gpu_second_half)    /* a body: sums, water, kick, drag, works */                       \
    X(SUM_AGAIN, fl_gpu_sum_again)        /* a body that a partner has left: sums and forces */              \
    X(TAKE_WORKS, fl_gpu_take_guest_work) /* a guest: works */                                               \
    X(BLOCKS, fl_gpu_block)               /* a block: works and contact forces of its bodies */              \
    X(CHUNKS, fl_gpu_chunk)               /* a chunk: totals of its contacts, loads on walls */              \
    X(DISC_RUNS, fl_gpu_disc_run)         /* a run of bonds: sum of |F| */                                   \
    X(STIFFNESS, fl_gpu_stiffness)        /* a body: bound of omega^2 */                                     \
    X(KEYS, fl_gpu_make_key)              /* a body: key of its cell */                                      \
    X(COUNT_ROWS, fl_gpu_count_rows)      /* a body: its partners */                                         \
    X(FILL_ROWS, fl_gpu_fill_rows)        /* a body: its rows, and what they remember */                     \
    X(LINK_ROWS, fl_gpu_link_rows)        /* a body: its rows in the order of its sums */                    \
    X(FORGET_ENDED, fl_gpu_forget_ended)  /* a bond: one that has ended is listed */

#define FL_GPU_KERNEL_ID(name, function) FL_GPU_##name,
enum fl_gpu_kernel { FL_GPU_KERNELS(FL_GPU_KERNEL_ID) FL_GPU_KERNEL_COUNT };

#endif
