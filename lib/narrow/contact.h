/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contact.h -- how two dilated polyhedra face one another: mode, gap, normal, point, length and area. */
#ifndef FL_NARROW_CONTACT_H
#define FL_NARROW_CONTACT_H
#include <stdint.h>
#include "narrow/penetration.h"
#include "narrow/gjk.h"

/* The kinds of contact, by the features of the two cores that are nearest or parallel:
 *   VV  two vertices                  VE  a vertex and an edge         VF  a vertex and a face
 *   EE  two edges that cross          EP  two parallel edges that overlap by a length
 *   EF  an edge along a face, inside it for a length     FF  two parallel faces that overlap by an area
 * "Parallel" allows an angle: see fl_contact_find. */
typedef enum { FL_MODE_NONE, FL_VV, FL_VE, FL_VF, FL_EE, FL_EP, FL_EF, FL_FF } fl_mode;

#define FL_PARALLEL_ENTER 1e-3 /* [rad] features become parallel below this angle, */
#define FL_PARALLEL_LEAVE 2e-3 /* [rad] and cease to be above this one, fl_contact_find() */

typedef struct {
    fl_mode mode;
    int32_t overlap;    /* 1 when the cores themselves meet                                             */
    double d;           /* signed distance of the cores, negative when they penetrate               [m] */
    double gap;         /* d - ra - rb; negative is overlap of the dilated bodies                   [m] */
    fl_vec3 n;          /* unit, from b to a                                                            */
    fl_vec3 p;          /* the point of the contact: midway between the two dilated surfaces, over the
                      * centroid of the overlap of the features (or on the line of nearest points) [m] */
    double length;      /* EP, EF: length of the overlap, seen along n; else 0                      [m] */
    double area;        /* FF: area of the overlap, seen along n; else 0                           [m2] */
    double sine;        /* EE: sine of the angle between the two edges; else 0                          */
    double edge;        /* EE: length of the shorter of the two edges; else 0                       [m] */
    int32_t lower_is_b; /* VE, VF, EF: 1 when the lower feature (vertex before edge before face) is b's  */
} fl_contact;

/* Two letters and a nul: "VV" .. "FF"; "--" for FL_MODE_NONE. */
const char *fl_mode_name(fl_mode mode);

/* The contact of a and b at whatever distance. before   the mode this pair had last time, FL_MODE_NONE for a
 * new pair: a parallel mode is entered below
 *            FL_PARALLEL_ENTER and left above FL_PARALLEL_LEAVE
 * cache    as for fl_gjk, may be NULL;   count   as for fl_penetration_find, may be NULL
 *
 * n is the direction of least distance (fl_gjk) or of least penetration (fl_penetration_find).  On each side
 * a face or an edge that touches the nearest vertices counts when its angle to the plane across n is within
 * the tolerance.  Tried in this order, with the features projected along n: two faces with an area in common
 * (FF), an edge with a length inside a face (EF), two edges parallel within the tolerance with a length in
 * common (EP).  When none is found the mode is that of the nearest features (VV VE VF EE).  Cannot fail. */
void fl_contact_find(const fl_solid *a, const fl_solid *b, fl_mode before, fl_gjk_cache *cache,
                     fl_penetration_count *count, fl_contact *out);

#endif
