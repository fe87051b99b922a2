/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh_under_face.h -- what of a surface of many small faces lies under a face F of a core.
 *
 * Where a face f of the surface B, an edge or a corner of it lies within the prism over a face F of the core
 * A, farther from its sides than its fading rim is wide, nothing of it is cut by F, and F covers f whole.
 * Then its parts of U (patch_points.h) are integrals over f, its edge or its corner, which are fixed in B, of
 * powers of
 *     s = R - h,      h = n_F.(x - p_F),      of f over F, of an edge and of a corner,
 *     s = R - h/c,    c = -n_F.n_f,           of F over f,
 *     U = 1/2 m(c) (int (R - h)^4 c dA + int (R - h/c)^4 dA) + ...
 * h changes with a motion of A as if F pressed along its normal in x, so that all their forces have the
 * direction of -n_F: one sum has the force and the moment of a thousand faces, eight or four at a time, and
 * beside it stands the couple dU/dc n_F x n_f.  There is no rim to pull: by Gauss' theorem the pulls of the
 * sides of f in face_integral.h are what its forces along n_f lack of those along n_F.  All this is exact
 * where f is flat; corners off its plane count where they are.
 *
 * Where f lies over one side of F, with the inward normal m there and d = m.(x - p_m), it is cut:
 *     to d >= 0                       for f over F, which fades as d/rim to the side,
 *     to g = d + (h/c) m.n_f >= 0     for F over f.
 * That gives forces that move with the side,
 *     m s^4/rim                            for each area of the rim,
 *     (m + n_F m.n_f/c) s^4/|grad g|       for each length of the border g = 0 there at x + n_f h/c,
 * and no more than that: one more place has their sum. Edges are cut at any sides.  What is over two sides of
 * F, or within a hair of one, is left to face_integral.h and edge_integral.h.
 *
 * What is under F is asked anew at each evaluation, and the sums run in the order of features: not a bit
 * depends on when the lists were made. */
#ifndef FL_PATCH_MESH_UNDER_FACE_H
#define FL_PATCH_MESH_UNDER_FACE_H
#include "patch/feature_pairs.h"
#include "patch/mesh_under_face_sum.h"

typedef struct fl_mesh_under_face fl_mesh_under_face;

/* Zeroed to start. */
typedef struct {
    double *number;     /* of vertices and sides of F (mesh_under_face_sum.h) */
    uint8_t *status;    /* what has been made of faces or edges */
    uint8_t *covered;   /* [l->n] what the footings have, but have left */
    int32_t *remaining; /* where the rows of the matches begin that are left, where some of those are */
    fl_row_selection selection;  /* those */
    int32_t *list;               /* numbers of faces or corners */
    fl_under_face_cut *cut_face; /* faces that are cut */
    fl_under_face_edge_part *edge_part;
    int32_t number_cap, status_cap, covered_cap, remaining_cap, list_cap, cut_face_cap, edge_part_cap;
} fl_mesh_under_face_work;

/* Sort out of the matches l of core A and surface B those that may lie under a face of A, into l->footing. -1
 * when memory runs out. */
int fl_mesh_under_face_list(fl_feature_pairs *l, const fl_patch_core *A, const fl_patch_core *B);

/* The places of all that lies under faces of A now, and of mesh_edge_batch.h, added to w; *rest is l without
 * the matches that this accounts for, and borrows from l and work. behind   as in feature_pairs.h [m] rim
 * width of the fading rims of A's faces, at most [m] -1 when memory runs out. */
int fl_mesh_under_face_evaluate(fl_patch_points *w, const fl_feature_pairs *l, fl_mesh_under_face_work *work,
                                const fl_patch_core *A, const fl_patch_core *B, double R, double behind,
                                double rim, fl_feature_pairs *rest);

/* Frees l and what fl_mesh_under_face_list() has stored in it; leaves a zeroed struct. */
void fl_mesh_under_face_free_pairs(fl_feature_pairs *l);

void fl_mesh_under_face_free(fl_mesh_under_face *o); /* takes NULL */
void fl_mesh_under_face_work_free(fl_mesh_under_face_work *work);

#endif
