/* SPDX-License-Identifier: GPL-3.0-or-later */
/* wave_block.h -- waves on one floating body from four samples in a block of time.
 *
 * In a block of four levels (wave_grid.h) the body is expected on a path r(t): the caller gives its pose at
 * the four levels, and it is cubic in time in between. On that path the waves are evaluated at the levels. A
 * plane (height and slopes) is fitted to the waves over the nodes of the body (wave_nodes.h), and D is the
 * load of the waves less that of still water up to the plane. At the first and last level G is the change of
 * D with x, y, z and the rotations about x and y. Then
 *     F(t) = B(plane(t), pose) + D(t) + G(t) (pose - r(t)),
 * plane, D, the flow and the acceleration of the water being cubic in time, G linear. B is the buoyancy on
 * the plane by the exact clip of buoyancy.h. So righting moments, overwash and
 * edges that submerge act in each step; without G the error of the motion would be 4 to 8 times as large.
 *
 * The load by the divergence theorem, with p = rho g (P - z):
 *     columns   F = -int grad p dV over the wet part of each, by Simpson's rule;
 *               along the column the pressure at its ends
 *     faces     F = -sum max(p, 0) A, A the area vectors; at the water line the mean over the part
 *     sphere, capsule   F = rho V (g e_z + acceleration at the centre of the wet part)
 * The error of a block is of order 4 in its length, except where an edge submerges: there it is of
 * order 1. A body whose load jumps by more than e rho g A sigma from one block to the next (A the
 * area of its section, sigma the standard deviation of the elevation) takes blocks of half the length,
 * until three long blocks have passed without a jump.
 *
 * The mesh of a floating structure has too many triangles to be cut in each step. There B too is evaluated
 * on the path, by wet_mesh.h, and is part of D; G has its change with the pose, which is the hydrostatic
 * stiffness of the present wet part. What is left out is of second order in the deviation from the path.
 *
 * Bits: all is a function of the path and the levels. A checkpoint holds the path. */
#ifndef FL_WATER_WAVE_BLOCK_H
#define FL_WATER_WAVE_BLOCK_H
#include "geom/quat.h"
#include "water/current.h"
#include "water/wave_grid.h"
#include "water/wave_nodes.h"
#include "water/wet_mesh.h"

enum {
    FL_WAVE_NO_BLOCK = -1,
    FL_WAVE_GROUP = 6, /* levels from the start of one long block to the next */
    FL_WAVE_SAMPLES = 4,
    FL_WAVE_ROW = 16,   /* plane 3, D 6, flow 3, acceleration 3, wetted area of a mesh */
    FL_WAVE_CHANGES = 5 /* columns of G */
};

typedef struct {
    /* path: centre at the four levels [m], and rotation from q, the vector part of whose quaternion is half
     * of it [rad] */
    fl_vec3 x[FL_WAVE_SAMPLES], turn[FL_WAVE_SAMPLES];
    fl_quat q;
    int64_t level;             /* first level; FL_WAVE_NO_BLOCK: none yet */
    int32_t span;              /* levels from sample to sample: 2, or 1 in a short block */
    int32_t short_blocks_left; /* long blocks that are still to be halved */
    double sample[FL_WAVE_SAMPLES][FL_WAVE_ROW];
    double change[2][FL_WAVE_CHANGES][6];
} fl_wave_block;

/* Water and waves, the same for all bodies. */
typedef struct {
    const fl_wave_grid *grid;
    const fl_current *current;
    double level;     /* z of still water [m] */
    double weight;    /* rho g [N/m3] */
    double max_crest; /* [m] */
    double deviation; /* standard deviation of the elevation [m] */
    double k95;       /* [1/m] */
} fl_wave_water;

/* The surface over one node; with one line of propagation its taps too. */
typedef struct {
    fl_wave_surface at;
    fl_wave_taps taps;
} fl_wave_node_sample;

/* One body. */
typedef struct {
    const fl_hull *hull; /* NULL with a mesh */
    const fl_wave_nodes *nodes;
    double reach;                 /* of its points from the centre [m] */
    fl_wave_node_sample *scratch; /* [nodes] */
    const fl_wet_mesh *mesh;      /* of a floating structure; NULL: a floe */
    fl_vec3 wet_centre;           /* mesh: centre of buoyancy at rest, body axes [m] */
    fl_vec3 other, other_moment;  /* mesh: all but the water, when a block begins [N], [N m] */
} fl_wave_body;

/* The part of a body below a plane, by buoyancy.h. */
void fl_wave_body_submerged(const fl_wave_body *body, fl_vec3 up, double level, fl_submerged *wet);

/* First level of the long block that contains t, and of the block of a body. */
int64_t fl_wave_group(const fl_wave_grid *g, double t);
int64_t fl_wave_block_level(const fl_wave_grid *g, double t, int span);

/* Time of sample k of a block [s]; the orientation on the path after a rotation. */
double fl_wave_sample_time(const fl_wave_block *c, const fl_wave_grid *g, int k);
fl_quat fl_wave_block_attitude(const fl_wave_block *c, fl_vec3 turn);

/* Deviation of a pose from the path: of the centre [m], of the orientation [rad]. */
typedef struct {
    fl_vec3 x, turn;
} fl_wave_deviation;
fl_wave_deviation fl_wave_block_deviation(const fl_wave_block *c, const fl_wave_grid *g, double t, fl_vec3 x,
                                          fl_quat q);

/* True if a block must begin at time t with the body at this pose: it has none, or the time is outside, or
 * the body deviates from the path by more than 0.1/k95, as after an impact. */
int fl_wave_block_due(const fl_wave_block *c, const fl_wave_water *sea, double reach, double t, fl_vec3 x,
                      fl_quat q);

/* Evaluates the waves on the path, which the caller has set, with level and span. */
void fl_wave_block_fill(fl_wave_block *c, const fl_wave_water *sea, const fl_wave_body *body);

/* Values at time t for the body at this pose; beyond the last level they go on linearly. */
typedef struct {
    double z, slope[2];         /* plane: height above still water at the centre [m], slopes along x, y */
    fl_vec3 f, t;               /* D + G (pose - r), moment about the centre, world axes [N], [N m] */
    fl_vec3 flow, acceleration; /* of the water at the wet centre [m/s], [m/s2] */
    double wetted;              /* mesh: wetted area [m2] */
} fl_wave_values;
void fl_wave_block_values(const fl_wave_block *c, const fl_wave_grid *g, double t, fl_vec3 x, fl_quat q,
                          fl_wave_values *out);

/* Velocity of the waves at a time of a block, at many points. */
typedef struct {
    fl_wave_view view[FL_WAVE_SAMPLES];
    double weight[FL_WAVE_SAMPLES]; /* of the cubic */
} fl_wave_flow;
void fl_wave_block_flow(const fl_wave_block *c, const fl_wave_grid *g, double t, fl_wave_flow *out);

/* The same at a point z above still water, under the elevation eta [m/s]. */
fl_vec3 fl_wave_flow_velocity(const fl_wave_flow *f, double x, double y, double z, double eta);

#endif
