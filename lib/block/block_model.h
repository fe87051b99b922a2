/* SPDX-License-Identifier: GPL-3.0-or-later */
/* block_model.h -- a model of rock: convex pieces, cut into blocks by joint sets.
 *
 * A model that is not convex (a slope, a tunnel) is cut by the planes of its own surface where triangles of
 * it pass through a piece; what lies outside is dropped.  Faces between such pieces are intact rock.  A
 * region inside the model (an excavation) is cut in the same way and its blocks get a group.  Then joints cut
 * every piece they meet.
 *
 * Corners within FL_BLOCK_TOL of the size of the model from a plane lie on it.  That is one rule for all
 * blocks, so that neighbours agree; it is larger than the rounding of a corner where planes meet at 0.01
 * degrees (1e-12 of the size) and smaller than what a polyhedron may deviate from its planes (1e-9 of its own
 * size) for blocks down to 1/100 of the model.
 *
 * Blocks of one plane are independent of each other.  They are cut in parallel, and the results stand in the
 * order of the blocks; fl_block_model_sort() puts them along a Hilbert curve by their centroids. */
#ifndef FL_BLOCK_BLOCK_MODEL_H
#define FL_BLOCK_BLOCK_MODEL_H
#include "base/string_table.h"
#include "block/block_shape.h"
#include "block/joint_set.h"
#include "geom/surface.h"

#define FL_BLOCK_TOL 1e-11

typedef struct {
    int32_t n, cap;
    fl_block_shape *block; /* [n] */
    int32_t pieces;
    fl_block_shape *piece; /* [pieces] the convex pieces before joints cut them; empty until then */
    int32_t planes, plane_cap;
    fl_joint_plane *plane; /* [planes] */
    int32_t *cuts;         /* [planes] blocks that each plane cut */
    int32_t cuts_cap;
    double size, tol; /* largest side of the model; within which a corner lies on a plane [m] */
    double volume;    /* of the model as given [m3] */
    fl_string_table groups;
    int32_t first_joint; /* number of planes of surfaces, which come before those of joints */
} fl_block_model;

/* The box lo .. hi. */
int fl_block_model_box(fl_block_model *m, fl_vec3 lo, fl_vec3 hi, fl_err *err);

/* The inside of a closed surface of triangles: FL_INPUT if it is not closed. */
int fl_block_model_surface(fl_block_model *m, const fl_part *p, fl_err *err);

/* Cuts out a region, the inside of a closed surface, and gives its blocks that group.  Before the joints. */
int fl_block_model_region(fl_block_model *m, const fl_part *p, const char *group, fl_err *err);

/* Cuts by all planes of the sets, which must be sorted.  Planes of two sets that coincide are FL_INPUT. */
int fl_block_model_cut(fl_block_model *m, const fl_joint_sets *sets, uint64_t seed, fl_err *err);

/* Sorts the blocks along a Hilbert curve through their centroids. */
int fl_block_model_sort(fl_block_model *m, fl_err *err);

/* Removes the blocks of a group.  Returns their number, or -1 with FL_INPUT for an unknown one. */
int32_t fl_block_model_delete(fl_block_model *m, const char *group, fl_err *err);

void fl_block_model_free(fl_block_model *m); /* accepts a zeroed struct, leaves one */

#endif
