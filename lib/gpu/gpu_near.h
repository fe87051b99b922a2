/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gpu_near.h -- what a device keeps of spheres that are near the structure, held or driven: types for
 * gpu_view.h.  C17 and C++17; no function. */
#ifndef FL_GPU_GPU_NEAR_H
#define FL_GPU_GPU_NEAR_H
#include <stdint.h>
#include "contact/point_kernel.h"
#include "geom/poly.h"
#include "structure/structure.h"

/* A piece of the structure: a cone, or a convex solid or a mesh whose arrays are on the device. */
typedef struct {
    fl_poly core;
    fl_mat3 R; /* its axes */
    fl_vec3 x, v, w, change_v, change_w;
    double r0, r1, h; /* of a cone [m] */
    double radius, odometer;
    const int32_t *cone_of_face; /* of a mesh with cones, else NULL */
    const fl_free_cone *free_cone;
    double facet_error;
    int32_t kind; /* fl_piece_kind */
    int32_t pad;
} fl_gpu_piece;

/* A sphere and a piece that are near each other; in the order of fl_world.pair. */
typedef struct {
    fl_point_memory memory;
    fl_point_forces forces;
    fl_point_law law;
    double mass, free_travel; /* as in fl_pair */
    double moved;             /* way of the two in this step [m] */
    fl_vec3 n, aj, off;       /* from the centre of the piece to the point; from the sphere to the piece */
    double normal;            /* [N] */
    double known;             /* on a mesh: fl_mesh_contact_known_distance() [m] */
    int32_t body, piece, pair, touching;
    int32_t first_tile, tiles; /* faces of a mesh that may be the nearest */
    int32_t row, undecided;    /* its index here; 1: the CPU evaluates it in this step */
} fl_gpu_pair;

/* Damping and friction of the pairs of a body, as fl_contact_sum. */
typedef struct {
    fl_vec3 damping, damping_torque, friction, friction_torque;
    int64_t contacts;
} fl_gpu_pair_sum;

/* A body that is near the structure, held, or driven. */
typedef struct {
    fl_gpu_pair_sum now, before; /* of this step and of the one before */
    fl_vec3 kick_v, kick_w;      /* change of the velocities by the first kick */
    fl_vec3 change_v, change_w;  /* and by the first half */
    double spring, rest_height;  /* of a driven body [N/m], [m] */
    double work_of_constraints;  /* [J] */
    int32_t body, first, end;    /* its pairs */
    uint32_t hold;               /* FL_DOF_X | ... */
    int32_t is_driven;
    int32_t is_always_single; /* it is never in a batch of the CPU */
} fl_gpu_near;

#endif
