/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contact.h -- contact of two dilated polyhedra by features, for the laws of the manual: mode, gap, normal,
 * point, length and area. */
#ifndef FL_NARROW_CONTACT_H
#define FL_NARROW_CONTACT_H
#include <stdint.h>
#include "narrow/gjk.h"
#include "narrow/penetration.h"

/* Contact modes, by the features of the two cores that are closest or parallel:
 *     VV  two vertices                  VE  a vertex and an edge         VF  a vertex and a face
 *     EE  two crossing edges            EP  two parallel edges with a common length
 *     EF  an edge along a face, inside it for a length     FF  two parallel faces with a common area
 * "Parallel" allows an angle: see fl_contact_find(). */
typedef enum { FL_MODE_NONE, FL_VV, FL_VE, FL_VF, FL_EE, FL_EP, FL_EF, FL_FF } fl_mode;

#define FL_PARALLEL_ENTER 1e-3 /* [rad] features become parallel below this angle */
#define FL_PARALLEL_LEAVE 2e-3 /* [rad] and stop being parallel above this one    */

typedef struct {
    fl_mode mode;
    int32_t overlap;    /* 1 when the cores themselves overlap                                          */
    double d;           /* signed distance of the cores, negative when they penetrate               [m] */
    double gap;         /* d - ra - rb; negative: overlap of the dilated bodies                     [m] */
    fl_vec3 n;          /* unit, from b to a                                                            */
    fl_vec3 p;          /* contact point: midway between the two dilated surfaces, over the centroid of the
                      * common part of the features (or on the line of closest points)           [m] */
    double length;      /* EP, EF: common length, projected along n; else 0                         [m] */
    double area;        /* FF: common area, projected along n; else 0                              [m2] */
    double sine;        /* EE: sine of the angle between the two edges; else 0                          */
    double edge;        /* EE: length of the shorter edge; else 0                                   [m] */
    int32_t lower_is_b; /* VE, VF, EF: 1 when the lower feature (vertex < edge < face) is b's        */
} fl_contact;

/* Two letters: "VV" .. "FF"; "--" for FL_MODE_NONE. */
const char *fl_mode_name(fl_mode mode);

/* The contact of a and b at any distance.
 *     before   the mode that this pair had last, FL_MODE_NONE for a new pair: a parallel mode is entered
 *              below FL_PARALLEL_ENTER and left above FL_PARALLEL_LEAVE
 *     cache    as for fl_gjk(), may be NULL;   count: as for fl_penetration_find(), may be NULL
 *
 * n is the direction of least distance (fl_gjk()) or of least penetration (fl_penetration_find()).  On each
 * side a face or an edge that touches the closest vertices counts when its angle to the plane across n is
 * within the tolerance.  With the features projected along n, tried in this order: two faces with a common
 * area (FF), an edge with a length inside a face (EF), two edges parallel within the tolerance with a common
 * length (EP).  If none is found the mode is that of the closest features (VV VE VF EE).  Cannot fail. */
void fl_contact_find(const fl_solid *a, const fl_solid *b, fl_mode before, fl_gjk_cache *cache,
                     fl_penetration_count *count, fl_contact *out);

#endif
