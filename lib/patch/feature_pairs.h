/* SPDX-License-Identifier: GPL-3.0-or-later */
/* feature_pairs.h -- the list of feature pairs of two cores that may have patch points, kept for many steps.
 *
 * A feature (vertex, edge, face) of one core has a patch point over a feature of the other core where it lies
 * in the Voronoi region of that feature: the prism over a face, the wedge over an edge, the cone over a
 * vertex.  A region is bounded by planes through edges of its core.  Many pairs share few planes, so one
 * table of distances of vertices from planes (plane_distances.h) serves all pairs.  Planes are stored in the
 * frame of their own core.
 *
 * Most feature pairs of two touching cores are far apart, and the others stay the same for many steps.  The
 * list holds the pairs that are within reach, or may be before any point has moved by more than a margin.  It
 * is built once and used until then.  A listed pair may have no point, and the pairs with points always come
 * in the same order, so no bit of a result depends on when the list was built.  For two bodies, planes that
 * all vertices of a feature clear by more than the margin are not listed either (feature_filter.h): most
 * planes drop out. */
#ifndef FL_PATCH_FEATURE_PAIRS_H
#define FL_PATCH_FEATURE_PAIRS_H
#include <stdint.h>
#include "base/simd.h"
#include "patch/list_range.h"
#include "patch/patch_types.h"

typedef enum {
    FL_PAIR_VERTEX_FACE,
    FL_PAIR_VERTEX_EDGE,
    FL_PAIR_VERTEX_VERTEX,
    FL_PAIR_EDGE_FACE,
    FL_PAIR_EDGE_EDGE,
    FL_PAIR_EDGE_VERTEX,
    FL_PAIR_FACE_FACE
} fl_feature_pair_kind;

/* A plane of a core in the core's own frame: h = g.x - c, a length times a length but for planes of faces. */
typedef struct {
    fl_vec3 g;
    double c;
} fl_core_plane;

/* Offset that is added to the distance of a point from a plane, so that a point exactly on the plane is on
 * the same side for every query.  1e-300 is below the rounding of any distance but 0.  The three factors,
 * without a rational relation, keep it from being 0 for planes along an axis or a diagonal. */
FL_SIMD_INLINE double fl_plane_tie_offset(fl_vec3 g)
{
    return 1e-300 * (0.5772156649 * g.x + 0.4342944819 * g.y + 0.6931471806 * g.z);
}

/* Storage of a list: one block with the planes, the numbers (double), and integers of 8 bits each, or of 16
 * or 32 where one does not fit in 8.  For two bodies the planes are not stored, since they would be more than
 * half of the list: each is given by four integers (the features that it passes through) and computed at each
 * evaluation, at a thirtieth of its cost.
 *
 * A feature pair is a row of integers:
 *     kind + 8 direction + 16 sides   direction 0: feature of A over one of B, 1: of B over A
 *     own, other                      indices of the two features
 *     column                          of the vertex or of the first end of an edge; face: number of corners
 *     column, factor                  edge only: its second end; number of fl_edge_integral_factor()
 *     row or length                   over a face: row of its plane; over an edge: number of its length
 *     side ...                        2 row, or 2 row + 1 for "below the plane": where the feature must lie
 *     column ...                      face only: its corners
 * Rows are planes and columns are vertices of the table of distances of that direction. */
enum { FL_ROW_HEAD, FL_ROW_OWN, FL_ROW_OTHER, FL_ROW_COLUMN, FL_ROW_SECOND_COLUMN, FL_ROW_FACTOR };

/* A selection of the rows of a list. */
typedef struct {
    const int32_t *row_start; /* [n] where they begin */
    const int32_t *plane[2];  /* [planes] planes that they use, for each direction, or NULL: all */
    int32_t n, planes[2];
} fl_row_selection;

enum { FL_PART_MARKS = 8 };

/* Zeroed to start: no list. */
struct fl_feature_pairs {
    void *block;
    int32_t size; /* of the block [B] */
    int32_t n;
    int32_t planes[2], vertices[2], numbers; /* of the tables of both directions; factors and lengths */
    int32_t used_vertices, used_faces;       /* vertices and faces of A that the list uses */
    int16_t width;                           /* integers of 8 bits (0), 16 (1) or 32 (2) */
    /* set by the caller: the cores do not overlap while the list is valid */
    uint8_t separated;
    uint8_t stores_planes; /* set by the caller: planes are stored */
    fl_mat3 M;             /* pose of A when the list was built, as in fl_patch_points_transform() */
    fl_vec3 o;
    /* valid while |o - o0|^2 < max_shift2 [m2] and |M - M0|^2 < max_turn2; 0: invalid */
    double max_shift2, max_turn2;
    double margin;                     /* of the list [m] */
    int64_t uses;                      /* evaluations since it was built */
    const fl_row_selection *selection; /* borrowed: the rows to evaluate, or NULL: all */
    /* [candidates] set by the caller: vertices of A that may come behind a mesh while the list is valid, or,
     * for a point, faces that it may touch */
    int32_t *candidate;
    int32_t candidates, candidate_cap;
    int out_of_reach;                      /* set by the caller: nothing of the mesh is within reach */
    int single_wall;                       /* set by the caller: the point touches at most one wall */
    struct fl_mesh_under_face *under_face; /* of a mesh, owned by the caller (mesh_under_face.h), or NULL */
    /* set by the caller: lists of parts of a joined piece (mesh_contact.c), of cone `only`, or with -1 of all
     * but the marked cones, ascending */
    struct fl_feature_pairs *part;
    int32_t parts, part_cap, only, marks, mark[FL_PART_MARKS];
};

/* Length of a table row for so many vertices: full registers. */
static inline int32_t fl_feature_columns(int32_t vertices)
{
    return (vertices + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH * FL_SIMD_WIDTH;
}

/* Planes of one direction, where they are stored. */
static inline const fl_core_plane *fl_feature_pairs_planes(const fl_feature_pairs *l, int direction)
{
    return (const fl_core_plane *)l->block + (direction ? l->planes[0] : 0);
}

static inline const double *fl_feature_pairs_numbers(const fl_feature_pairs *l)
{
    return (const double *)l->block + (l->stores_planes ? 4 * ((int64_t)l->planes[0] + l->planes[1]) : 0);
}

/* Integers that give the planes, where planes are not stored. */
static inline const void *fl_feature_pairs_plane_indices(const fl_feature_pairs *l)
{
    return fl_feature_pairs_numbers(l) + l->numbers;
}

/* All other integers: columns of direction 0, of direction 1, used vertices and faces of A, rows. */
static inline const void *fl_feature_pairs_integers(const fl_feature_pairs *l)
{
    const int64_t plane_indices = l->stores_planes ? 0 : 4 * ((int64_t)l->planes[0] + l->planes[1]);
    return (const char *)fl_feature_pairs_plane_indices(l) + (plane_indices << l->width);
}

/* Integer k; width as in the list. */
static inline int32_t fl_feature_integer(const void *integers, int width, int64_t k)
{
    return width == 0   ? ((const uint8_t *)integers)[k]
           : width == 1 ? ((const uint16_t *)integers)[k]
                        : ((const int32_t *)integers)[k];
}

/* Index of the first row. */
static inline int32_t fl_feature_pairs_first_row(const fl_feature_pairs *l)
{
    return l->vertices[0] + l->vertices[1] + l->used_vertices + l->used_faces;
}

/* Fields of the first integer of a row; number of integers before its sides; index of the next row. */
static inline int fl_feature_row_kind(int32_t head) { return head & 7; }
static inline int fl_feature_row_direction(int32_t head) { return head >> 3 & 1; }
static inline int32_t fl_feature_row_sides(int32_t head) { return head >> 4; }
static inline int fl_feature_row_fixed(int kind)
{
    static const uint8_t FIXED[] = {5, 5, 4, 7, 7, 6, 5};
    return FIXED[kind];
}
static inline int32_t fl_feature_row_next(const void *integers, int width, int32_t k)
{
    const int32_t head = fl_feature_integer(integers, width, k);
    const int kind = fl_feature_row_kind(head);
    const int32_t corners =
        kind == FL_PAIR_FACE_FACE ? fl_feature_integer(integers, width, k + FL_ROW_COLUMN) : 0;
    return k + fl_feature_row_fixed(kind) + fl_feature_row_sides(head) + corners;
}

/* Margin of the next list [m].  Building a list costs as much as some evaluations, and a wider margin makes
 * each evaluation dearer.  The sum is least where the margin is proportional to the root of R times the path
 * per evaluation, which follows from the last list.  Only the cost depends on it.
 *     R   reach [m] */
double fl_feature_pairs_margin(const fl_feature_pairs *l, double R);

/* Builds the list of pairs of the features a of A and b of B that can come within reach while no point that
 * matters moves by more than `margin` against the other core.  Points that matter: those of A, and those of B
 * within reach of A, which are no farther from A's centre than A's own plus the reach.
 *     R            reach [m];  margin [m]
 *     prism_depth  how far below a face its prism extends [m]
 *     w            A has been transformed; scratch
 * -1 when memory runs out. */
int fl_feature_pairs_build(fl_feature_pairs *l, fl_patch_points *w, const fl_patch_core *A,
                           const fl_feature_set *a, const fl_patch_core *B, const fl_feature_set *b, double R,
                           double prism_depth, double margin);

/* True if the list is valid in the pose M, o; counts an evaluation. */
static inline int fl_feature_pairs_valid(fl_feature_pairs *l, const fl_mat3 *M, fl_vec3 o)
{
    if (!fl_pose_in_range(M, o, &l->M, l->o, l->max_shift2, l->max_turn2)) return 0;
    l->uses++;
    return 1;
}

/* Transforms the vertices and faces of A that the list uses, as fl_patch_points_transform().  -1 when memory
 * runs out. */
int fl_feature_pairs_transform(fl_patch_points *w, const fl_feature_pairs *l, const fl_poly *a, fl_mat3 M,
                               fl_vec3 o);

/* Computes the planes of one direction where they are not stored.
 *     p     core that has the planes;  out: [planes[direction]] */
void fl_feature_pairs_make_planes(const fl_feature_pairs *l, int direction, const fl_poly *p,
                                  fl_core_plane *out);

/* Memory of the list [B]. */
double fl_feature_pairs_bytes(const fl_feature_pairs *l);

/* Makes the list and those of its parts invalid. */
void fl_feature_pairs_forget(fl_feature_pairs *l);

void fl_feature_pairs_free(fl_feature_pairs *l);
void fl_feature_draft_free(struct fl_feature_draft *d); /* takes NULL */

#endif
