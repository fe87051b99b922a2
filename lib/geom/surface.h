/* SPDX-License-Identifier: GPL-3.0-or-later */
/* surface.h -- the surface of a structure: named parts made of triangles and solid truncated cones. */
#ifndef FL_GEOM_SURFACE_H
#define FL_GEOM_SURFACE_H
#include <stddef.h>
#include <stdint.h>
#include "base/err.h"
#include "base/string_table.h"
#include "geom/aabb.h"
#include "geom/vec3.h"

typedef struct {
    int32_t v[3]; /* vertices, counter-clockwise from outside; the normal is outward */
} fl_tri;

/* The convex hull of the disc of radius r0 about p0 and the disc of radius r1 about p1, both normal to p1 -
 * p0.  r0 = r1 is a cylinder, one of them 0 a pointed cone. */
typedef struct {
    fl_vec3 p0, p1; /* [m] */
    double r0, r1;  /* [m] */
} fl_cone;

typedef struct {
    char *name; /* owned; one word without blanks */
    int32_t id; /* >= 0, unique in the surface */
    int32_t nv, nt, nc;
    fl_vec3 *v;    /* [nv] [m] */
    fl_tri *t;     /* [nt] indices into v */
    fl_cone *cone; /* [nc] */
    int32_t v_cap, t_cap, c_cap;
    int32_t duplicates;      /* elements of its file that coincided with others and were left out */
    int32_t line, last_line; /* line of its first and last triangle in a g_struct file; else 0 */
} fl_part;

typedef struct {
    int32_t n, cap;
    fl_part *part;               /* [n]; moves when a part is added */
    char *history;               /* the "#by ..." lines of its file, NULL for none */
    fl_string_table given_names; /* names given by fl_surface_add(); other names are not in use */
    int32_t *given_index;        /* [given_names.n] last known index of the part of that name */
    int32_t *next_suffix; /* [given_names.n] smallest suffix number to try for the name; 0: not used yet */
    int32_t given_cap, suffix_cap;
    int32_t n_after_add, ids_counted,
        next_id; /* n at the last addition; next_id is above the ids of parts 0 .. ids_counted */
} fl_surface;

/* Thousands of parts are found quickly if fl_surface_add() gives their names.  Parts may be removed,
 * exchanged and renamed.  The id of a part may be set before the next one is added. */

/* Adds an empty part; its id is the largest so far plus one (0 first).  Of name[0 .. len) every byte up to
 * the blank, and a leading '#', becomes '_'; an empty name becomes "part"; a name in use gets "_2", "_3", ...
 * Returns the index of the part, or -1 with FL_SYSTEM. */
int32_t fl_surface_add(fl_surface *s, const char *name, size_t len, fl_err *err);

/* Index of the part of that name (compared after the same replacements), -1 if there is none. */
int32_t fl_surface_find(const fl_surface *s, const char *name, size_t len);

/* Append to a part.  Return 0, or -1 with FL_SYSTEM.  Indices are not checked here. */
int fl_surface_vertex(fl_part *p, fl_vec3 x, fl_err *err);
int fl_surface_triangle(fl_part *p, int32_t a, int32_t b, int32_t c, fl_err *err);
int fl_surface_cone(fl_part *p, fl_cone c, fl_err *err);

/* Boxes of used vertices and of cones; empty if there are none. */
fl_aabb fl_part_aabb(const fl_part *p);
fl_aabb fl_surface_aabb(const fl_surface *s);
fl_aabb fl_cone_aabb(const fl_cone *c);

void fl_part_free(fl_part *p); /* both accept a zeroed struct and leave one */
void fl_surface_free(fl_surface *s);

#endif
