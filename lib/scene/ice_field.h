/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ice_field.h -- a field of ice: the bodies of a g-polys file, g-polys(5). */
#ifndef FL_SCENE_ICE_FIELD_H
#define FL_SCENE_ICE_FIELD_H
#include <stdint.h>
#include <stdio.h>
#include "base/err.h"
#include "base/string_table.h"
#include "base/text.h"
#include "base/tool.h"
#include "geom/poly.h"

/* Version 2 has bond records; a field without them is written as version 1. */
enum { FL_ICE_FIELD_VERSION = 2 };

/* The farthest coordinate and the largest radius a file may hold [m]: squares and cubes stay finite, and one
 * ulp of it is a tenth of a micrometre. */
#define FL_ICE_FIELD_MAX_COORD 1e9

/* Where two bodies touch and may be frozen together: a candidate, which acts only through the scene's [bond]
 * section.  i < j are places in the field, not ids. */
typedef struct {
    int32_t i, j;
    double area;   /* of the common face; of touching spheres that of the smaller's great circle [m2] */
    double length; /* its horizontal length; of touching spheres the smaller diameter             [m] */
    fl_vec3 x;     /* its centroid                                                                [m] */
} fl_ice_field_bond;

/* Body i is the Minkowski sum of core[i] and a ball of radius[i].  core[i].nv is 1 for a sphere, 2 for a
 * capsule.  Order is that of the file; memory grows with the rows that are there, whatever the counts say. */
typedef struct {
    int32_t n, cap;
    int32_t *id;          /* [n] names of the bodies, >= 0, all different                  */
    int32_t *record_line; /* [n] line of the poly record, 0 for a body that was not read   */
    int32_t *material;    /* [n] number in materials, -1 when none is given                */
    int32_t *group;       /* [n] number in groups, -1 when none is given                   */
    double *radius;       /* [n] dilation radius, >= 0; > 0 where the core has no volume [m] */
    fl_poly *core;        /* [n] core, vertices in world coordinates                   [m] */
    fl_vec3 *velocity;    /* [n] velocity at the start                               [m/s] */
    fl_vec3 *spin;        /* [n] angular velocity at the start, world axes         [rad/s] */
    fl_string_table materials, groups;
    int32_t bonds, bond_cap;
    fl_ice_field_bond *bond; /* [bonds] sorted by (i, j), no pair twice */
    char *history;           /* "#by ..." lines of the file it came from, NULL for none; owned */
} fl_ice_field;

/* Append a body; the core moves into the field and *core is left zeroed.  material and group may be NULL.
 * Returns 0, or -1 with FL_SYSTEM in err, field and core as they were. */
int fl_ice_field_add(fl_ice_field *a, int32_t id, double radius, fl_poly *core, const char *material,
                     const char *group, fl_vec3 vel, fl_vec3 spin, fl_err *err);

/* Append a bond of the bodies i != j; bonds are sorted when they are read, and written in the order of their
 * adding.  Returns 0, or -1 with FL_SYSTEM in err. */
int fl_ice_field_add_bond(fl_ice_field *a, int32_t i, int32_t j, double area, double length, fl_vec3 x,
                          fl_err *err);

/* Read a file ("-" is standard input, gzip is unpacked).  Checks the syntax, that ids differ, indices and
 * radii, that a bond names two bodies of the file, a pair once and with an area and a length, and through
 * fl_poly_make() that every core is closed, convex and the right way out; corners of a core that coincide are
 * one.
 * Returns 0, or -1 with FL_INPUT ("file:line: ...", for a core the line of its poly record and its id) or
 * FL_SYSTEM; out is untouched then. */
int fl_ice_field_read(fl_ice_field *out, const char *path, fl_err *err);

/* The same from a text that was opened already, which it closes. */
int fl_ice_field_read_text(fl_ice_field *out, fl_text *in, fl_err *err);

/* Write the whole file: kind and version, the history of the field and this run's line, the bodies.  Numbers
 * read back to the same doubles.  Write errors stay in f, for fl_out_close(). */
void fl_ice_field_write(FILE *f, const fl_ice_field *a, const fl_history_line *by);

/* A number that tells fields apart: of ids, radii, corners, faces, velocities and bonds, bit for bit. */
uint64_t fl_ice_field_hash(const fl_ice_field *a);

void fl_ice_field_free(fl_ice_field *a); /* accepts a zeroed struct, leaves one */

#endif
