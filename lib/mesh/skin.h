/* SPDX-License-Identifier: GPL-3.0-or-later */
/* skin.h -- boundary faces of a finite element mesh, split into triangles; used by fl_elements_surface(). */
#ifndef FL_MESH_SKIN_H
#define FL_MESH_SKIN_H
#include "mesh/elements.h"
#include "mesh/merge_cylinders.h"

enum { FL_SKIN_COUNTED = 1 << 7 }; /* there are six faces at most, so the highest bit is free */

/* A face of a solid picked by a set. */
typedef struct {
    int32_t target, element;
    int8_t face;
} fl_skin_face;

typedef struct {
    const fl_elements *e;     /* borrowed */
    int32_t *target;          /* [elements] part, or parts.n plus the set; -1 for none */
    int8_t *reversed;         /* [elements] 1 for a shell to be reversed */
    uint8_t *outer_faces;     /* [elements] bit mask of faces that no other selected solid has */
    uint8_t *free_faces;      /* [elements] the same among all solids; NULL until a set needs it */
    uint8_t *picked_faces;    /* [elements] faces picked by a set, and FL_SKIN_COUNTED */
    uint8_t *duplicate_faces; /* [elements] bit mask of picked faces that a duplicate element contributes */
    uint8_t *dropped;         /* [elements] 1 if other elements contribute all of its faces */
    int32_t *dropped_of;      /* [targets] elements dropped as duplicates of those of the target */
    fl_skin_face *pick;       /* [picks] */
    int32_t picks, pick_cap;
    int subdivide, by_name; /* by_name: parts are selected by name */
    int mixed;              /* shells may lie on solids, or on shells of another part */
    int32_t *owner, *local; /* [nodes] last target that used the node, plus one; its vertex there */
    fl_id_map edge;         /* edges by their lower and higher node, if some mid-side nodes are omitted */
    int32_t *edge_mid, edge_cap;      /* [edge.n] their mid-side nodes */
    fl_part pool;                     /* corners of the current face */
    int32_t lines_without_radius;     /* or without a length */
    int32_t curved;                   /* quadratic faces whose mid-side nodes were dropped */
    double sagitta;                   /* largest distance of such a node from its chord */
    int32_t zero_volume, left_handed; /* solids */
    int32_t nonmanifold;              /* faces of three or more solids */
    int32_t duplicates;               /* elements on the nodes of another one */
    int32_t covered_shells;           /* shells on faces of other elements */
    int32_t shell_faces;              /* faces of solids that went to the part of a shell */
    int32_t interior_shells;          /* shells between two solids */
    fl_merged_cylinders merged;       /* of lines */
} fl_skin;

/* Initialise k with no target for any element.  -1 with FL_SYSTEM. */
int fl_skin_start(fl_skin *k, const fl_elements *e, const fl_import_options *opt, fl_err *err);

/* Assign a face of a solid, or its free faces, to a target, unless it has one already.  Shells and lines are
 * ignored.  -1 with FL_SYSTEM. */
int fl_skin_pick(fl_skin *k, const fl_pick *p, int32_t target, fl_err *err);

/* Group items by target: list[first[t] .. first[t + 1]) are the items of target t, in ascending order.
 *   n            items; the target of item i is target[i * stride], < 0 for none
 *   first, list  out, [targets + 1] and [n]: freed by the caller, on failure too
 * Returns 0, or -1 with FL_SYSTEM. */
int fl_group_by_target(int32_t n, int32_t targets, const int32_t *target, int stride, int32_t **first,
                       int32_t **list, fl_err *err);

/* Add to s a part for each target that is not empty.  -1 with FL_INPUT (an undefined node) or FL_SYSTEM. */
int fl_skin_emit(fl_skin *k, fl_surface *s, fl_err *err);

/* Add remarks on what was skipped or reversed. */
void fl_skin_report(const fl_skin *k, fl_bytes *b);

void fl_skin_free(fl_skin *k); /* accepts a zeroed struct, leaves one */

#endif
