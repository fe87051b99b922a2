/* SPDX-License-Identifier: GPL-3.0-or-later */
/* skin.h -- the faces that make the surface of a mesh, cut into triangles; what fl_elements_surface() is made
 * of. */
#ifndef FL_MESH_SKIN_H
#define FL_MESH_SKIN_H
#include "mesh/elements.h"
#include "mesh/merge_cylinders.h"

enum { FL_SKIN_COUNTED = 1 << 7 }; /* six faces at most: the highest bit is free */

/* A face of a solid that a set asked for. */
typedef struct {
    int32_t target, element;
    int8_t face;
} fl_skin_face;

typedef struct {
    const fl_elements *e; /* borrowed */
    int32_t *target;      /* [elements] the part, or parts.n plus the set, it goes to; -1 for none */
    int8_t *reversed;     /* [elements] a shell to be turned over */
    uint8_t *outer_faces; /* [elements] a bit for each face that no other wanted solid has */
    uint8_t *free_faces;  /* [elements] the same among all solids; NULL until a set asks for it */
    uint8_t
        *picked_faces; /* [elements] a bit for each face that went to a set, FL_SKIN_COUNTED when counted */
    uint8_t *duplicate_faces; /* [elements] a bit for each face that a twin brings, though it went to a set */
    uint8_t *dropped;         /* [elements] another one brings all that it has */
    int32_t *dropped_of;      /* [targets] elements that stood back behind those of the target */
    fl_skin_face *pick;       /* [picks] */
    int32_t picks, pick_cap;
    int subdivide, by_name;           /* parts were chosen by name */
    int mixed;                        /* shells may lie on solids, or on shells of another part */
    int32_t *owner, *local;           /* [nodes] target that saw a node last, plus one; its vertex there */
    fl_part pool;                     /* corners of the face at hand */
    int32_t lines_without_radius;     /* lines without a radius or a length */
    int32_t curved;                   /* quadratic faces whose mid-side nodes were dropped */
    double sagitta;                   /* largest distance of such a node from its chord */
    int32_t zero_volume, left_handed; /* solids without volume; numbered left-handed */
    int32_t nonmanifold;              /* faces of three or more solids */
    int32_t duplicates;               /* elements on the nodes of another one */
    int32_t covered_shells,
        shell_faces;            /* shells on faces that others bring; that brought the face of a solid */
    int32_t interior_shells;    /* shells between two solids */
    fl_merged_cylinders merged; /* lines that were joined */
} fl_skin;

/* Start with every element going nowhere.  -1 with FL_SYSTEM. */
int fl_skin_start(fl_skin *k, const fl_elements *e, const fl_import_options *opt, fl_err *err);

/* Give the face of a solid (or its free ones) to a target, unless it went to one before.  Shells and lines
 * are passed over.  -1 with FL_SYSTEM. */
int fl_skin_pick(fl_skin *k, const fl_pick *p, int32_t target, fl_err *err);

/* Things by their targets: after this, list[first[t] .. first[t + 1]) are the numbers of those of t,
 * ascending.
 *   n            things; that of thing i is target[i * stride], < 0 for none
 *   first, list  out, [targets + 1] and [n]: freed by the caller, on failure too
 * Returns 0, or -1 with FL_SYSTEM. */
int fl_group_by_target(int32_t n, int32_t targets, const int32_t *target, int stride, int32_t **first,
                       int32_t **list, fl_err *err);

/* Add a part to s for each target that has something.  -1 with FL_INPUT (a node without a place) or
 * FL_SYSTEM. */
int fl_skin_emit(fl_skin *k, fl_surface *s, fl_err *err);

/* Remarks on what was passed over or turned. */
void fl_skin_report(const fl_skin *k, fl_bytes *b);

void fl_skin_free(fl_skin *k); /* accepts a zeroed struct, leaves one */

#endif
