/* SPDX-License-Identifier: GPL-3.0-or-later */
/* frustum_face.h -- a face beside a truncated cone (frustum.h): by rows across the projected axis. */
#ifndef FL_NARROW_FRUSTUM_FACE_H
#define FL_NARROW_FRUSTUM_FACE_H
#include "narrow/meridian.h"

/* Add the places of face F of A to w.  -1 when memory runs out. */
int fl_frustum_face(fl_places *w, const fl_side *A, int32_t F, const fl_meridian *c);

#endif
