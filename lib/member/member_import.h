/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_import.h -- a model of members from the frame of a finite element deck.
 *
 * Nodes are called n1 by their numbers (n2.1 in scope 2 of an assembly), members e1. An element becomes a
 * member of `pieces` pieces, a truss a bar; its offsets are arms. A release of both bending moments of an end
 * is a hinge; of one alone it is not carried over. Nodes that no element uses are left out.
 *
 * The deck is in N, s and a length of l metres, as mm, N, t and MPa are with l = 0.001: of the model
 * lengths are times l, moduli over l2, masses over l, densities over l4, moments times l. Source:
 * dimensions of the units. */
#ifndef FL_MEMBER_MEMBER_IMPORT_H
#define FL_MEMBER_MEMBER_IMPORT_H
#include "member/member_model.h"
#include "mesh/frame_model.h"

/* f gets what is not carried over; nodes are moved by `shift`, in metres. -1 with FL_INPUT: a node that is
 * not defined, or no element with a section and a modulus. */
int fl_member_import(fl_member_model *m, fl_frame_model *f, int32_t pieces, double length, fl_vec3 shift,
                     const char *file, fl_err *err);

#endif
