/* SPDX-License-Identifier: GPL-3.0-or-later */
/* feature_pairs.h -- which feature of one core can have a place over which feature of the other.
 *
 * A vertex, an edge or a face has a place over what lies in the prism over a face, the wedge over an edge or
 * the cone over a vertex of the other core: where it is on the right side of some planes, all of which pass
 * through edges of that core.  Many features share few planes, so that one table of heights of vertices over
 * planes has all that is asked.  Planes are kept as numbers in the frame of their own core.
 *
 * Most features of two touching cores have nothing to do with each other, and what does stays for many steps:
 * the list of those that do, or will before any point has moved by more than a margin, is made once and used
 * until then.  It only leaves out: a match that is listed in vain has no place, and those that have one come
 * in the same order whenever the list was made, so that not a bit depends on that.  Of two bodies neither are
 * sides listed that a feature is beyond by more than the margin: most planes are asked by nobody then. */
#ifndef FL_PATCH_FEATURE_PAIRS_H
#define FL_PATCH_FEATURE_PAIRS_H
#include <stdint.h>
#include "base/simd.h"
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

/* Direction constant: a plane is shifted by this much before a point is compared with it, so that a point
 * exactly on it is on the same side for every query.  Far below rounding of any distance; the three irrational
 * factors keep it from being 0 for planes along an axis or a diagonal. */
FL_SIMD_INLINE double fl_plane_tie_offset(fl_vec3 g)
{
    return 1e-300 * (0.5772156649 * g.x + 0.4342944819 * g.y + 0.6931471806 * g.z);
}

/* A list lies in one block: planes, numbers, and whole numbers of 8 bits each, or of 16 or 32 where one of
 * them would not fit.  Planes of two bodies are not kept, which would be more than half of a list: what they
 * pass through is told by four whole numbers each, and they are made for a look, for a thirtieth of its cost.
 * A match is a row of those:
 *     kind + 8 way + 16 sides     way 0: of A over B, 1: of B over A
 *     own, other                  numbers of the features
 *     column                      of the vertex, or the first of an edge; of a face how many corners it has
 *     column, factor              of an edge: its second, and which number is its fl_edge_integral_factor()
 *     row or length               over a face the row of its plane; over an edge which number is its length
 *     side ...                    2 row, or 2 row + 1 where below the plane is meant: what it must be beyond
 *     column ...                  of a face those of its corners
 * Rows and columns are those of the tables of heights, of vertices of one core over planes of the other. */
enum { FL_ROW_HEAD, FL_ROW_OWN, FL_ROW_OTHER, FL_ROW_COLUMN, FL_ROW_SECOND_COLUMN, FL_ROW_FACTOR };

/* Some of the rows of a list. */
typedef struct {
    const int32_t *row_start; /* [n] where they begin */
    const int32_t *plane[2];  /* [cuts] numbers of the planes of each way that they ask about, or NULL: any */
    int32_t n, planes[2];
} fl_row_selection;

/* Zeroed to start: nothing listed. */
struct fl_feature_pairs {
    void *block;
    int32_t size; /* of the block [B] */
    int32_t n;
    int32_t planes[2], vertices[2], numbers; /* of the tables of the two ways; factors and lengths */
    int32_t used_vertices, used_faces;       /* vertices and faces of A that the list speaks of */
    int16_t width;                           /* whole numbers of 8 bits, 1: of 16, 2: of 32 */
    uint8_t separated;                       /* the cores do not meet while it holds */
    uint8_t stores_planes;                   /* the caller's: planes are kept */
    fl_mat3 M; /* how A's frame stood to B's when it was listed, as fl_patch_points_transform() has it */
    fl_vec3 o;
    double max_shift2,
        max_turn2; /* it holds while |o - o0|^2 < shift2 and |M - M0|^2 < turn2; 0: no longer */
    double margin; /* it was listed for [m] */
    int64_t uses;  /* looks since then */
    const fl_row_selection *selection; /* borrowed: the rows that count, or NULL: all do */
    int32_t *candidate; /* [shies] the caller's: vertices of A that may come behind a surface as long, or,
                              * of a point, faces that it may meet */
    int32_t candidates, candidate_cap;
    int out_of_reach; /* the caller's: nothing of the surface is in reach */
    int single_wall;  /* the caller's: one wall at the most is */
    struct fl_mesh_under_face
        *under_face; /* of a surface: what may lie under a face of A (mesh_under_face.h), or NULL */
};

/* So long is a row of so many vertices: full registers. */
static inline int32_t fl_feature_columns(int32_t vertices)
{
    return (vertices + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH * FL_SIMD_WIDTH;
}

/* Those of one way, where they are kept. */
static inline const fl_core_plane *fl_feature_pairs_planes(const fl_feature_pairs *l, int way)
{
    return (const fl_core_plane *)l->block + (way ? l->planes[0] : 0);
}

static inline const double *fl_feature_pairs_numbers(const fl_feature_pairs *l)
{
    return (const double *)l->block + (l->stores_planes ? 4 * ((int64_t)l->planes[0] + l->planes[1]) : 0);
}

/* Whole numbers: what planes pass through where they are not kept, */
static inline const void *fl_feature_pairs_plane_indices(const fl_feature_pairs *l)
{
    return fl_feature_pairs_numbers(l) + l->numbers;
}

/* and all others: columns of way 0, of way 1, what is used of A, rows of matches. */
static inline const void *fl_feature_pairs_integers(const fl_feature_pairs *l)
{
    const int64_t told = l->stores_planes ? 0 : 4 * ((int64_t)l->planes[0] + l->planes[1]);
    return (const char *)fl_feature_pairs_plane_indices(l) + (told << l->width);
}

/* The k-th of them; `wide` as in the list. */
static inline int32_t fl_feature_integer(const void *whole, int wide, int64_t k)
{
    return wide == 0   ? ((const uint8_t *)whole)[k]
           : wide == 1 ? ((const uint16_t *)whole)[k]
                       : ((const int32_t *)whole)[k];
}

/* Where the rows begin. */
static inline int32_t fl_feature_pairs_first_row(const fl_feature_pairs *l)
{
    return l->vertices[0] + l->vertices[1] + l->used_vertices + l->used_faces;
}

/* Of a row its kind, its sides and the numbers before them; the row behind one that begins at k. */
static inline int fl_feature_row_kind(int32_t head) { return head & 7; }
static inline int fl_feature_row_direction(int32_t head) { return head >> 3 & 1; }
static inline int32_t fl_feature_row_sides(int32_t head) { return head >> 4; }
static inline int fl_feature_row_fixed(int kind)
{
    static const uint8_t FIXED[] = {5, 5, 4, 7, 7, 6, 5};
    return FIXED[kind];
}
static inline int32_t fl_feature_row_next(const void *whole, int wide, int32_t k)
{
    const int32_t head = fl_feature_integer(whole, wide, k);
    const int kind = fl_feature_row_kind(head);
    const int32_t corners =
        kind == FL_PAIR_FACE_FACE ? fl_feature_integer(whole, wide, k + FL_ROW_COLUMN) : 0;
    return k + fl_feature_row_fixed(kind) + fl_feature_row_sides(head) + corners;
}

/* The margin to list with next [m], from how soon the last one was used up: a list costs as much as some
 * looks at it, and each of these the more, the farther it reaches; the sum is least where the margin is the
 * root of R times the way from look to look.  R is the reach; nothing but the cost depends on it. */
double fl_feature_pairs_margin(const fl_feature_pairs *l, double R);

/* List what of the features a of A and b of B can come within R of each other while no point that matters
 * moves by more than `margin` [m] against the other core: those of A, and those of B within reach of it,
 * which are no farther from A's centre than A's own and the reach.
 *   behind   how far below a face its prism reaches [m]
 *   w        where A has been entered; holds what is in work
 * -1 when memory runs out. */
int fl_feature_pairs_build(fl_feature_pairs *l, fl_patch_points *w, const fl_patch_core *A,
                           const fl_feature_set *a, const fl_patch_core *B, const fl_feature_set *b, double R,
                           double behind, double margin);

/* It is still good where A stands now, and is counted as used. */
static inline int fl_feature_pairs_valid(fl_feature_pairs *l, const fl_mat3 *M, fl_vec3 o)
{
    double turn2 = 0.0;
    if (!(v3_norm2(v3_sub(o, l->o)) < l->max_shift2)) return 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) turn2 += (M->m[i][k] - l->M.m[i][k]) * (M->m[i][k] - l->M.m[i][k]);
    if (!(turn2 < l->max_turn2)) return 0;
    l->uses++;
    return 1;
}

/* Enter of A what the list speaks of, as fl_patch_points_transform().  -1 when memory runs out. */
int fl_feature_pairs_transform(fl_patch_points *w, const fl_feature_pairs *l, const fl_poly *a, fl_mat3 M,
                               fl_vec3 o);

/* Planes of one way where they are not kept; p: the core that they are of, out: [cuts[way]]. */
void fl_feature_pairs_make_planes(const fl_feature_pairs *l, int way, const fl_poly *p, fl_core_plane *out);

/* What it takes of memory. */
double fl_feature_pairs_bytes(const fl_feature_pairs *l);

void fl_feature_pairs_free(fl_feature_pairs *l);
void fl_feature_draft_free(struct fl_feature_draft *d); /* of fl_patch_points; takes NULL */

#endif
