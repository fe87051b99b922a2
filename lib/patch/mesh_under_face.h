/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh_under_face.h -- patch terms of a mesh of many small triangles under one face F of a core, in one sum.
 *
 * A is the core, B the mesh, n_F the normal of F, p_F a point of it, R the reach.  Where a face f of B, an
 * edge or a corner lies in the prism over F, farther from the sides of F than its fading rim is wide, F cuts
 * nothing of it and covers it whole.  Its parts of U (patch_law.h) are then integrals over f, the edge or the
 * corner, which are fixed in B, of powers of s, with h = n_F.(x - p_F):
 *     s = R - h                       of f over F, of an edge and of a corner
 *     s = R - h/c,  c = -n_F.n_f      of F over f
 *     U = 1/2 m(c) (int (R - h)^4 c dA + int (R - h/c)^4 dA) + ...
 * A motion of A changes h as if F pressed along its normal at x, so all forces have the direction -n_F.  One
 * sum has the force and the moment of a thousand faces, computed four or eight at a time, besides the couple
 * dU/dc n_F x n_f.  There is no rim force: by Gauss' theorem the rim forces of the sides of f
 * (face_integral.h) are the difference of its forces along n_f and along n_F.  All this is exact where f is
 * flat; corners off its plane count where they are.
 *
 * Where f lies over a side of F it is clipped.  With the inward normal m of the side, a point p_m on it and
 * d = m.(x - p_m):
 *     to d >= 0                      for f over F; its weight fades as d/rim towards the side
 *     to g = d + (h/c) m.n_f >= 0    for F over f
 * The clipping adds forces that move with the side,
 *     m s^4/rim                          for each area of the rim
 *     (m + n_F m.n_f/c) s^4/|grad g|     for each length of the border g = 0, at x + n_f h/c
 * and no others; one more point has their sum.  Edges are clipped at any side.  A feature over three or more
 * sides, or within rounding of one, is left to face_integral.h and edge_integral.h.
 *
 * Which features lie under F is decided at each evaluation, and the sums run in the order of features.  So no
 * bit of a result depends on when the lists were built. */
#ifndef FL_PATCH_MESH_UNDER_FACE_H
#define FL_PATCH_MESH_UNDER_FACE_H
#include "patch/feature_pairs.h"
#include "patch/mesh_under_face_sum.h"

typedef struct fl_mesh_under_face fl_mesh_under_face;

/* Scratch of an evaluation.  Zeroed to start. */
typedef struct {
    double *number;             /* of vertices and sides of F (mesh_under_face_sum.h) */
    uint8_t *status;            /* FL_UNDER_FACE_SKIPPED for faces or edges */
    uint8_t *skipped;           /* [l->n] listed here, but left to the caller */
    int32_t *remaining;         /* rows that are left to the caller, where some are skipped */
    fl_row_selection selection; /* of rows that are left to the caller */
    int32_t *list;              /* indices of faces or corners */
    fl_under_face_cut *cut_face;
    fl_under_face_edge_part *edge_part;
    int32_t number_cap, status_cap, skipped_cap, remaining_cap, list_cap, cut_face_cap, edge_part_cap;
} fl_mesh_under_face_work;

/* Lists in l->under_face the pairs of l that may lie under a face of A, and edge pairs (mesh_edge_batch.h).
 * -1 when memory runs out. */
int fl_mesh_under_face_list(fl_feature_pairs *l, const fl_patch_core *A, const fl_patch_core *B);

/* Adds the points of the pairs listed in l->under_face to w.
 *   R, prism_depth  as in plane_distances.h [m]
 *   rim             width of the fading rims of A's faces, at most [m]
 *   *rest           out: l without the pairs that this has evaluated; borrows from l and work
 * -1 when memory runs out. */
int fl_mesh_under_face_evaluate(fl_patch_points *w, const fl_feature_pairs *l, fl_mesh_under_face_work *work,
                                const fl_patch_core *A, const fl_patch_core *B, double R, double prism_depth,
                                double rim, fl_feature_pairs *rest);

/* Frees l and what fl_mesh_under_face_list() has stored in it; leaves a zeroed struct. */
void fl_mesh_under_face_free_pairs(fl_feature_pairs *l);

void fl_mesh_under_face_free(fl_mesh_under_face *o); /* takes NULL */
void fl_mesh_under_face_work_free(fl_mesh_under_face_work *work);

#endif
