/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ball.h -- what is kept of pairs of spheres, and of spheres on walls, apart from all other pairs: a tenth of
 * what those need.
 *
 * Rows are sorted by (i, j, image).  Bodies are taken in chunks of FL_BALLS_CHUNK by their number.  A chunk
 * owns the rows of its bodies i and the sums of its bodies: what a row does to a j of the same chunk is added
 * there at once, what it does to a j beyond goes to a slot of the row, which j adds up later; the rows of its
 * bodies and walls come last.  Every sum so has one order, that of the rows, for any number of threads; a row
 * that does not touch adds zeros, which change no bit, so that it does not matter which rows are listed. */
#ifndef FL_STEP_BALL_H
#define FL_STEP_BALL_H
#include <stdint.h>
#include "geom/vec3.h"
#include "law/rolling.h"

enum { FL_BALLS_CHUNK = 256, FL_BALLS_GROUP = 32 };

/* What a row remembers, and the forces that it gave last.  Vectors stand before a number, so that either two
 * are one register of four. */
typedef struct {
    fl_vec3 slip;  /* elastic part of the tangential force on i                       [N]       */
    double stiff;  /* tangential stiffness that it was built with                     [N/m]     */
    fl_vec3 rub;   /* tangential force on i, with damping                             [N]       */
    double damped; /* what damping adds to the normal force                           [N]       */
    double touch;  /* largest approach speed of this touch                            [m/s]     */
    double k;      /* kappa of Hertz                                                  [N/m^1.5] */
} fl_ball_row;

/* A sphere and a wall, leans.h. */
typedef struct {
    int32_t i, j;
    int32_t law; /* into fl_world.law */
    int32_t hit; /* touches */
    fl_ball_row row;
} fl_ball_lean;

/* What those of a chunk do to a wall: force, and torque about its point, world axes. */
typedef struct {
    fl_vec3 f, t; /* [N], [N m] */
} fl_ball_load;

/* What rows see of a body: its motion at the contacts of a step, and at its end.  Bodies are far apart to the
 * rows that they are the j of, and wait in as many places as there are arrays. */
typedef struct {
    fl_vec3 x; /* [m]     */
    double r;  /* [m]     */
    fl_vec3 v; /* [m/s]   */
    double invm;
    fl_vec3 w;    /* [rad/s] */
    double r_too; /* r, where that is wanted beside w */
    fl_vec3 dv;   /* by how much v will have changed by the end of the step, lead.h */
    double crowd; /* (n - 1)/m, of n contacts in the step before, as many as they are in line */
    fl_vec3 rdw;  /* r times that of w                                     [m/s]    */
    double turns; /* r^2/I                                                 [1/kg]   */
} fl_ball_seen;

/* From a body to an image of it [m]. */
typedef struct {
    fl_vec3 by;
    double none;
} fl_ball_way;

/* Sums over the rows of one body; forces and torques on it, world axes. */
typedef struct {
    fl_vec3 elastic, damping, friction; /* [N]   */
    fl_vec3 torque;                     /* [N m], of friction: nothing else has an arm */
} fl_ball_sum;

/* What the rows of a chunk tell. */
typedef struct {
    int64_t touching;
    double force;           /* sum of |F| [N]                                            */
    double worst;           /* largest overlap over the sum of the radii                 */
    int32_t worst_row;      /* where that is, the first of them; of a wall ~row          */
    double elastic, spring; /* energies of its rows [J]                                  */
} fl_ball_tally;

typedef struct {
    int32_t n;          /* rows */
    int32_t bodies;     /* as many as move; 0: there has been no row yet, and the rest is not there */
    int32_t *i, *j;     /* [n] */
    int32_t *law;       /* [n] into fl_world.law */
    int32_t one_law;    /* of all rows; -1: there are several */
    int32_t *image;     /* [n][3]; NULL without a periodic cell */
    uint8_t *hit;       /* [n] touches */
    fl_ball_row *row;   /* [n] */
    fl_roll *roll;      /* [n]; NULL where nothing keeps spheres from rolling */
    int32_t *touching;  /* [bodies] rows and walls that touch it now, */
    int32_t *touched;   /* [bodies] and that did in the step before   */
    int32_t *first;     /* [bodies + 1] rows of body i */
    fl_ball_seen *seen; /* [bodies] */
    int32_t *to;        /* [n] where j adds up: j, or of a row that leaves its chunk ~slot */
    int32_t chunks;
    int32_t *source;      /* [chunks] the first chunk with a row that leads there */
    uint8_t *ended;       /* [chunks] scratch of a step */
    fl_ball_way *way;     /* [ways] 0 is that of j itself */
    uint8_t *by;          /* [n] which of them */
    int32_t ways;         /* 0: there are more than a byte can tell */
    int32_t *cross;       /* [chunks + 1] slots of the rows that leave a chunk, in their order */
    int32_t *into;        /* [bodies + 1] offsets into slots */
    int32_t *slots;       /* [cross[chunks]] the slots that body j has to add up, ascending */
    fl_ball_sum *slot;    /* [cross[chunks]] */
    fl_ball_sum *sum;     /* [bodies] */
    fl_ball_sum *was;     /* [bodies] of the step before */
    fl_ball_tally *tally; /* [chunks] */
    double *stiff;        /* [bodies] sum of bounds of omega^2, of the last survey [1/s2] */
    double *stiff_slot;   /* [cross[chunks]] */
    fl_ball_lean *lean;   /* [leans] by (i, j) */
    fl_roll *lean_roll;   /* [leans] as roll */
    int32_t *lean_first;  /* [chunks + 1] those of a chunk */
    fl_ball_load *load;   /* [chunks][walls] */
    int32_t leans, lean_cap, lean_roll_cap;
    int32_t i_cap, j_cap, law_cap, image_cap, hit_cap, row_cap, roll_cap;
} fl_balls;

#endif
