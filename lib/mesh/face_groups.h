/* SPDX-License-Identifier: GPL-3.0-or-later */
/* face_groups.h -- faces of a finite element mesh grouped by their corner nodes.
 *
 * Two faces coincide where they have the same set of corner nodes.  A solid contributes each of its faces, a
 * shell itself as one face, a line its two ends. */
#ifndef FL_MESH_FACE_GROUPS_H
#define FL_MESH_FACE_GROUPS_H
#include "mesh/elements.h"

/* Order of the faces within a group. */
enum { FL_FACE_WANTED, FL_FACE_OTHER, FL_FACE_SHELL, FL_FACE_LINE };

/* A face.  key: its second to last different corner nodes in ascending order, -1 for those it does not have;
 * all faces of a group share the lowest corner node. */
typedef struct {
    int32_t key[3], element;
    int8_t face, rank;
} fl_face_ref;

/* Rank of an element (see above), < 0 for one that is left out. */
typedef int fl_face_rank(const void *context, int32_t element);

/* Receives the n faces s[0 .. n) of a group, sorted by rank, then element, then face.  0, or -1 to stop. */
typedef int fl_face_visitor(void *context, const fl_face_ref *s, int32_t n, fl_err *err);

/* Call visit() once for each group of coincident faces.  -1 with FL_SYSTEM, or the -1 of visit(). */
int fl_visit_face_groups(const fl_elements *e, fl_face_rank *rank_of, fl_face_visitor *visit, void *context,
                         fl_err *err);

/* Different corner nodes of a face of a solid (of a shell or a line when face < 0) in ascending order, the
 * rest -1.  Returns how many there are. */
int fl_face_corner_nodes(const fl_elements *e, int32_t element, int face, int32_t c[4]);

/* True if two solids have the same corner nodes. */
int fl_same_corners(const fl_elements *e, int32_t a, int32_t b);

/* Number of different solids among s[0 .. n), the solids of one group; solids on the same nodes count once.
 * A solid that has the face twice is flat there and does not count.  *first is the index of the first one
 * counted, 0 if there is none. */
int fl_distinct_solids(const fl_elements *e, const fl_face_ref *s, int32_t n, int32_t *first);

/* Set in free[element] a bit for each face of a solid that no other solid of e has.  -1 with FL_SYSTEM. */
int fl_mark_free_faces(const fl_elements *e, uint8_t *free, fl_err *err);

#endif
