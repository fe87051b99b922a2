/* SPDX-License-Identifier: GPL-3.0-or-later */
/* shared_faces.h -- decides to which part a face belongs that several elements share. */
#ifndef FL_MESH_SHARED_FACES_H
#define FL_MESH_SHARED_FACES_H
#include "mesh/skin.h"

/* Assign each face, identified by its corner nodes, to one target, from k->target and the faces picked by
 * sets:
 *   - Of elements of one kind on the same nodes (lines: with the same radii too) the first selected one
 *   stays.
 *   - A face of one selected solid goes to the set that picked it.  Without one, and if parts are selected by
 *      name (k->by_name), it goes to the part of the first shell on it, oriented as the face of the solid.
 *      Otherwise it goes to the part of the solid (k->outer_faces).
 *   - A face of two selected solids is interior: it is dropped, and so are shells on it.
 *   - On a face of no selected solid the first shell stays.  It is oriented as the face of the solid it lies
 *      on, if there is exactly one and no surface set gives the side of the shell.
 * Elements that contribute nothing get the target -1; counts are kept in k.  -1 with FL_SYSTEM. */
int fl_resolve_shared_faces(fl_skin *k, fl_err *err);

#endif
