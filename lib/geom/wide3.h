/* SPDX-License-Identifier: GPL-3.0-or-later */
/* wide3.h -- vectors by lanes: four of them at a time.  Macros, as in base/wide.h. */
#ifndef FL_GEOM_WIDE3_H
#define FL_GEOM_WIDE3_H
#include "base/wide.h"

typedef struct {
    fl_wide x, y, z;
} fl_wide3;

/* From three rows of FL_LANES doubles, and into them. */
#define FL_WIDE3(a) ((fl_wide3){FL_FOUR((a)[0]), FL_FOUR((a)[1]), FL_FOUR((a)[2])})
#define FL_WIDE3_INTO(a, p)                                                                                  \
    (FL_FOUR_INTO((a)[0]) = (p).x, FL_FOUR_INTO((a)[1]) = (p).y, FL_FOUR_INTO((a)[2]) = (p).z)

/* a - b;  a + s b;  s a;  a.b */
#define FL_WIDE3_SUB(a, b) ((fl_wide3){(a).x - (b).x, (a).y - (b).y, (a).z - (b).z})
#define FL_WIDE3_MADD(a, s, b) ((fl_wide3){(a).x + (s) * (b).x, (a).y + (s) * (b).y, (a).z + (s) * (b).z})
#define FL_WIDE3_SCALE(s, a) ((fl_wide3){(s) * (a).x, (s) * (a).y, (s) * (a).z})
#define FL_WIDE3_DOT(a, b) ((a).x * (b).x + (a).y * (b).y + (a).z * (b).z)

#endif
