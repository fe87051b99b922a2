/* SPDX-License-Identifier: GPL-3.0-or-later */
/* shared_faces.h -- whose a face is: each face of a mesh comes to the surface once, however many elements lie on it.
 */
#ifndef FL_MESH_SHARED_FACES_H
#define FL_MESH_SHARED_FACES_H
#include "mesh/skin.h"

/* Settle who brings each face, by its corner nodes, from k->target and from what sets picked of single faces:
 *  - of elements of one kind on the same nodes (lines: of the same radii too) the first that is wanted stays;
 *  - a face of one wanted solid is brought by the set that picked it, or else, when parts were chosen by name
 *    (k->by_name), by the part of the first shell that lies on it, looking outward as the solid does, or else
 *    by the solid: k->outer;
 *  - a face of two wanted solids is brought by none, nor by shells on it;
 *  - of a face of no wanted solid the first shell stays, turned as the solid is that it lies on, if there is
 *    one alone and no set tells the side of the shell.
 * Elements that bring nothing get the target -1; counts are left in k.  -1 with FL_SYSTEM. */
int fl_resolve_shared_faces(fl_skin *k, fl_err *err);

#endif
