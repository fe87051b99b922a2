/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cone_face.h -- face term over a truncated cone (cone.h), integrated by rows across the projected axis. */
#ifndef FL_PATCH_CONE_FACE_H
#define FL_PATCH_CONE_FACE_H
#include "patch/cone_profile.h"
#include "patch/patch_types.h"

/* Adds the patch points of face F of A to w.  -1 when memory runs out. */
int fl_cone_face_evaluate(fl_patch_points *w, const fl_patch_core *A, int32_t F, const fl_cone_profile *c);

#endif
