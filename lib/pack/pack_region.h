/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pack_region.h -- the region that a packing fills: a box, a cylinder, a sphere, the inside of an outline (in
 * two dimensions) or of a closed surface.
 *
 * g(x) is the distance of x from the complement of the region, negative outside.  A body of radius r about x
 * is inside where g(x) >= r.  Where it is not, it touches the boundary at every local minimum of the distance
 * from x to the boundary below r: once for a plane, once for each of two walls in a convex corner, once for
 * an edge or a corner that points into the region.  These are the feet of the normals from x on faces, and
 * the points of edges and corners whose cone of normals holds x.
 *
 * Surfaces and outlines consist of such features (faces, edges, corners), in a tree of boxes.  The sign of g
 * is that of the nearest one: of a face by its normal, of an edge or a corner by the sum of the normals of
 * its faces, weighted with their angles at a corner.  Source: Baerentzen and Aanaes, IEEE Trans. Vis. Comput.
 * Graph. 11 (2005) 243.
 *
 * Limits: holes of an outline lie inside it and apart from each other; the parts of a surface do not
 * overlap, and its triangles do not cross. */
#ifndef FL_PACK_PACK_REGION_H
#define FL_PACK_PACK_REGION_H
#include "broad/bvh.h"
#include "geom/surface.h"
#include "ice/domain.h"
#include "scene/ice_field.h"

enum fl_region_kind { FL_REGION_BOX, FL_REGION_CYLINDER, FL_REGION_SPHERE, FL_REGION_FEATURES };

enum { FL_REGION_CONTACTS = 32 }; /* most contacts of one body with the boundary */

/* A face (three corners, in two dimensions a side with two), an edge (two) or a corner (one). */
typedef struct {
    int32_t corners; /* of its hull: 1 to 3 */
    int32_t wall;
    fl_vec3 p[3];      /* [m] */
    fl_vec3 n;         /* unit normal of a face, or sum of normals, into the region */
    int32_t out, outs; /* directions into the faces at an edge or a corner, in region->out */
    int convex;        /* an edge or corner that no body inside can touch */
} fl_region_feature;

typedef struct {
    char name[64];
    int helper; /* taken away after packing */
} fl_region_wall;

typedef struct {
    enum fl_region_kind kind;
    int dim;         /* 2 or 3; in two dimensions all z are 0 */
    fl_vec3 lo, hi;  /* box of the region [m] */
    int periodic[3]; /* directions of a box that are periodic: no walls there */
    fl_vec3 centre;  /* of cylinder (at its bottom) and sphere [m] */
    double radius;   /* of these [m] */
    double volume;   /* in two dimensions the area [m3], [m2] */
    double inradius; /* radius of the largest body inside, to about 1 % [m] */
    int32_t walls;
    fl_region_wall *wall; /* [walls] */
    int32_t features, feature_cap;
    fl_region_feature *feature; /* [features] */
    fl_vec3 *out;               /* unit vectors from an edge, or a corner, along its faces */
    int32_t outs, out_cap, wall_cap;
    fl_aabb *box; /* [features] */
    fl_bvh tree;
    fl_surface surface; /* of a surface: its triangles, outward; of an outline nothing */
    fl_domain domain;   /* of an outline */
} fl_pack_region;

/* Contact of a point with the boundary: gap the distance, negative beyond it, n into the region. */
typedef struct {
    double gap;
    fl_vec3 n;
    int32_t wall;
    int32_t feature; /* of the region; -1 for box, cylinder and sphere */
} fl_region_contact;

/* Make a region from the argument of --in: "box:X0,Y0,Z0,X1,Y1,Z1", "cylinder:R,Z0,Z1,X,Y", "sphere:R,X,Y,Z"
 * or the name of a file: an outline (two dimensions), a mesh in any format of mesh/read_mesh.h, g_struct or
 * g-polys.
 *   dim       2 or 3
 *   periodic  of a box: text of the letters x, y, z; "" for none
 * 0, or -1 with FL_USAGE, FL_INPUT (a surface that is not closed, named by its open edges; no volume) or
 * FL_SYSTEM; r is then freed. */
int fl_region_make(fl_pack_region *r, const char *in, int dim, const char *periodic, fl_err *err);

/* Mark the walls of a list with commas as helpers; "all" marks all.  -1 with FL_USAGE and the nearest name.
 * */
int fl_region_set_helpers(fl_pack_region *r, const char *names, fl_err *err);

/* g(x) [m]; exact within `reach`, else any number above it.  INFINITY: exact everywhere. */
double fl_region_distance(const fl_pack_region *r, fl_vec3 x, double reach);

/* Contacts of x with the boundary nearer than reach, in the order of walls or features.  Returns their
 * number, at most FL_REGION_CONTACTS. */
int fl_region_contacts(const fl_pack_region *r, fl_vec3 x, double reach,
                       fl_region_contact out[FL_REGION_CONTACTS]);

/* Way back of a point that is outside by less than depth, and may be by more than the reach of the contacts
 * that were sought: 1, with the nearest place of the boundary in *out, its gap being negative; 0 inside.
 * Contacts with a box, a cylinder and a sphere have it at any depth: 0. */
int fl_region_way_back(const fl_pack_region *r, fl_vec3 x, double depth, fl_region_contact *out);

/* Shortest vector equal to d up to periods. */
fl_vec3 fl_region_wrap(const fl_pack_region *r, fl_vec3 d);

/* x moved by periods into the box. */
fl_vec3 fl_region_wrap_point(const fl_pack_region *r, fl_vec3 x);

int fl_region_is_periodic(const fl_pack_region *r);

void fl_region_free(fl_pack_region *r); /* accepts a zeroed struct, leaves one */

#endif
