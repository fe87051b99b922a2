/* SPDX-License-Identifier: GPL-3.0-or-later */
/* frame_model.h -- beams, trusses and pipes of a finite element deck as it states them: nodes, materials,
 * sections, elements with orientations, releases and offsets, supports, masses, loads; and a list of entries
 * that were skipped.
 *
 * Units are those of the deck. The axes of an element are x along it, y and z across; iz resists deflection
 * along y, iy along z. Readers fill it where import_options.h asks for it; member/member_import.h makes a
 * model of members of it. */
#ifndef FL_MESH_FRAME_MODEL_H
#define FL_MESH_FRAME_MODEL_H
#include <stdint.h>
#include "base/string_table.h"
#include "geom/vec3.h"
#include "mesh/id_map.h"

enum fl_frame_form { FL_FRAME_NONE, FL_FRAME_GENERAL, FL_FRAME_PIPE, FL_FRAME_RECTANGLE };

typedef struct {
    fl_vec3 x;
    int defined;
    int fixed;   /* freedoms x y z rx ry rz that are held, bits */
    double mass; /* of point masses */
    fl_vec3 force, moment;
} fl_frame_node;

typedef struct {
    double e, g, nu, rho; /* 0: not given; g is made of e and nu where it is not given */
} fl_frame_material;

typedef struct {
    int form;            /* enum fl_frame_form; FL_FRAME_NONE: not known */
    int32_t material;    /* -1: none */
    double a, iy, iz, j; /* FL_FRAME_GENERAL */
    double size[2];      /* pipe: outer diameter and wall; rectangle: along y, along z */
    double radius;       /* of the circle round a general section; 0: not known */
    double other_mass;   /* per length, besides that of the material */
} fl_frame_section;

typedef struct {
    int32_t node[2], section, part;
    int truss;         /* axial force alone */
    int has_y, has_z;  /* which of the next is given */
    fl_vec3 across;    /* lies in the plane of x and y, or of x and z */
    fl_vec3 offset[2]; /* from node to end, rigid */
    unsigned pins[2];  /* released moments at its ends: 1 about x, 2 about y, 4 about z */
    int64_t id;
} fl_frame_element;

typedef struct fl_frame_model {
    fl_id_map node_id, element_id;
    fl_frame_node *node;
    fl_frame_element *element; /* [element_id.n] */
    fl_string_table material_name, section_name, part_name, skipped_name;
    fl_frame_material *material;
    fl_frame_section *section;
    int32_t *skipped; /* [skipped_name.n] entries of that kind that were not carried over */
    int32_t node_cap, element_cap, material_cap, section_cap, skipped_cap;
    int32_t extra_supports, extra_loads; /* sets of them besides the first */
    int failed;                          /* memory ran out for `skipped` */
    int64_t support_set, load_set;       /* that the deck's first belong to; 0: none yet */
} fl_frame_model;

/* Index of a node, an element, or of a material, section or part of that name, added if new; -1 with
 * FL_SYSTEM. */
int32_t fl_frame_node_of(fl_frame_model *f, int32_t scope, int64_t id, fl_err *err);
int32_t fl_frame_element_of(fl_frame_model *f, int32_t scope, int64_t id, fl_err *err);
int32_t fl_frame_material_of(fl_frame_model *f, const char *name, fl_err *err);
int32_t fl_frame_section_of(fl_frame_model *f, const char *name, fl_err *err);
int32_t fl_frame_part_of(fl_frame_model *f, const char *name, fl_err *err);

/* Counts an entry that is not carried over; `what` is its card and, where it helps, why.  Returns 0; sets
 * failed without memory, which the importer reports. */
int fl_frame_count_skipped(fl_frame_model *f, const char *fmt, ...) __attribute__((format(printf, 2, 3)));

/* Constants of sections that have no form of their own.
 *   box  b along z, h along y, walls tf across y, tw across z
 *   i    height h along y, flanges b1 t1 below and b2 t2 above, web tw; torsion is sum b t3/3 */
fl_frame_section fl_frame_section_box(double b, double h, double tf, double tw);
fl_frame_section fl_frame_section_i(double h, double b1, double b2, double tw, double t1, double t2);
fl_frame_section fl_frame_section_rod(double radius);

void fl_frame_model_free(fl_frame_model *f); /* accepts a zeroed struct, leaves one */

#endif
