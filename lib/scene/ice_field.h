/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ice_field.h -- an ice field: the bodies and bonds of a g-polys file, g-polys(5). */
#ifndef FL_SCENE_ICE_FIELD_H
#define FL_SCENE_ICE_FIELD_H
#include <stdint.h>
#include <stdio.h>
#include "base/err.h"
#include "base/string_table.h"
#include "base/text.h"
#include "base/tool.h"
#include "geom/poly.h"

/* Version 2 has bond records, version 3 joint records; a field is written as the oldest version that has its
 * records. */
enum { FL_ICE_FIELD_VERSION = 3 };

/* Largest coordinate and radius in a file [m]: squares and cubes are finite, and one ulp is a tenth of a
 * micrometre. */
#define FL_ICE_FIELD_MAX_COORD 1e9

/* A bond candidate: two bodies that touch and may be bonded by the [bond] section of a scene. i < j are
 * indices in the field, not ids. */
typedef struct {
    int32_t i, j;
    double area;   /* of the common face; of touching spheres the area of the smaller great circle [m2] */
    double length; /* horizontal length of the face; of touching spheres the smaller diameter [m] */
    fl_vec3 x;     /* centroid of the face [m] */
} fl_ice_field_bond;

/* A joint: face fi of body i lies on face fj of body j, i < j, indices in the field.  Its law is that of the
 * section [joint NAME] of the scene. */
typedef struct {
    int32_t i, j, fi, fj;
    int32_t name; /* index in joint_names */
} fl_ice_field_joint;

/* Body i is the Minkowski sum of core[i] and a ball of radius[i]. core[i].nv is 1 for a sphere, 2 for a
 * capsule.  The order is that of the file; memory grows with the rows read, independent of announced
 * counts. */
typedef struct {
    int32_t n, cap;
    int32_t *id;          /* [n] ids of the bodies, >= 0, all different */
    int32_t *record_line; /* [n] line of the poly record, 0 if the body was not read */
    int32_t *material;    /* [n] index in materials, -1: none */
    int32_t *group;       /* [n] index in groups, -1: none */
    double *radius;       /* [n] dilation radius, >= 0; > 0 if the core has no volume [m] */
    fl_poly *core;        /* [n] core, vertices in world coordinates                   [m] */
    fl_vec3 *velocity;    /* [n] initial velocity [m/s] */
    fl_vec3 *spin;        /* [n] initial angular velocity, world axes [rad/s] */
    fl_string_table materials, groups;
    int32_t bonds, bond_cap;
    fl_ice_field_bond *bond; /* [bonds] sorted by (i, j), no pair twice */
    int32_t joints, joint_cap;
    fl_ice_field_joint *joint; /* [joints] sorted by (i, j), no pair twice */
    fl_string_table joint_names;
    char *history; /* "#by ..." lines of the file that was read, NULL for none; owned */
} fl_ice_field;

/* Append a body; the core moves into the field and *core is left zeroed. material and group may be NULL.
 * Returns 0, or -1 with FL_SYSTEM; field and core are unchanged then. */
int fl_ice_field_add(fl_ice_field *a, int32_t id, double radius, fl_poly *core, const char *material,
                     const char *group, fl_vec3 vel, fl_vec3 spin, fl_err *err);

/* Append a bond of the bodies i != j.  Reading sorts bonds; writing keeps the order of addition.  Returns
 * 0, or -1 with FL_SYSTEM. */
int fl_ice_field_add_bond(fl_ice_field *a, int32_t i, int32_t j, double area, double length, fl_vec3 x,
                          fl_err *err);

/* Append a joint of face fi of body i and face fj of body j, i != j.  Order and failure as above. */
int fl_ice_field_add_joint(fl_ice_field *a, int32_t i, int32_t j, int32_t fi, int32_t fj, const char *name,
                           fl_err *err);

/* Read a file ("-" is standard input, gzip is unpacked).  Checks syntax, unique ids, indices and radii;
 * bonds (two bodies of the file, a pair once, area and length above 0); and with fl_poly_make() that every
 * core is closed, convex and oriented outward.  Coincident corners of a core are merged.  Returns 0, or -1
 * with FL_INPUT ("file:line: ...", for a core the line of its poly record and its id) or FL_SYSTEM; out is
 * unchanged then. */
int fl_ice_field_read(fl_ice_field *out, const char *path, fl_err *err);

/* The same from an open text, which is closed. */
int fl_ice_field_read_text(fl_ice_field *out, fl_text *in, fl_err *err);

/* Write the file: kind and version, the history of the field and the line of this run, the bodies.
 * Numbers read back to the same doubles.  Write errors stay in f, for fl_out_close(). */
void fl_ice_field_write(FILE *f, const fl_ice_field *a, const fl_history_line *by);

/* Hash of ids, radii, corners, faces, velocities and bonds, bit for bit. */
uint64_t fl_ice_field_hash(const fl_ice_field *a);

void fl_ice_field_free(fl_ice_field *a); /* accepts a zeroed struct, leaves a zeroed one */

#endif
