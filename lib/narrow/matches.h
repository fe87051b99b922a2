/* SPDX-License-Identifier: GPL-3.0-or-later */
/* matches.h -- which feature of one core can have a place over which feature of the other.
 *
 * A vertex, an edge or a face has a place over what lies in the prism over a face, the wedge over an edge or
 * the cone over a vertex of the other core: where it is on the right side of some planes, all of which pass
 * through edges of that core.  Many features share few planes, so that one table of heights of vertices over
 * planes has all that is asked.  Planes are kept as numbers in the frame of their own core.
 *   Most features of two touching cores have nothing to do with each other, and
 * what does stays for many steps: the list of those that do, or will before any point has moved by more than
 * a margin, is made once and used until then.  It only leaves out: a match that is listed in vain has no
 * place, and those that have one come in the same order whenever the list was made, so that not a bit depends
 * on that. */
#ifndef FL_NARROW_MATCHES_H
#define FL_NARROW_MATCHES_H
#include <stdint.h>
#include "narrow/places.h"

typedef enum {
    FL_MATCH_VERTEX_FACE,
    FL_MATCH_VERTEX_EDGE,
    FL_MATCH_VERTEX_VERTEX,
    FL_MATCH_EDGE_FACE,
    FL_MATCH_EDGE_EDGE,
    FL_MATCH_EDGE_VERTEX,
    FL_MATCH_FACE_FACE
} fl_match_kind;

typedef struct {
    int16_t kind, way;  /* enum fl_match_kind; 0: of A over B, 1: of B over A */
    int32_t own, other; /* numbers of the features */
    int32_t v[2];       /* ends of an edge, or the vertex: columns of the table */
    int32_t first,
        n; /* fl_matches.side: what it must be beyond.  Of a face the columns of its corners follow */
    int32_t height; /* row of the plane of the other face */
    double factor;  /* of an edge, as fl_strips_factor() */
    double length;  /* of the other edge [m] */
} fl_match;

/* A plane of a core in the core's own frame: h = g.x - c, a length times a length but for planes of faces. */
typedef struct {
    fl_vec3 g;
    double c;
} fl_cut;

/* The table of one way: heights of vertices of one core over planes of the other. */
typedef struct {
    int32_t *vertex;
    fl_cut *cut;
    int32_t vertices, cuts, vertex_cap, cut_cap;
} fl_table;

/* Zeroed to start: nothing listed. */
struct fl_matches {
    fl_match *c;
    int32_t *side; /* 2 row, or 2 row + 1 where below the plane is meant */
    fl_table table[2];
    int32_t *used; /* [used_v + used_f] vertices and faces of A that the list speaks of */
    int32_t n, cap, sides, side_cap, used_v, used_f, used_cap;
    int32_t clear; /* the cores do not meet while it holds */
    fl_mat3 M;     /* how A's frame stood to B's when it was listed, as fl_places_enter() has it */
    fl_vec3 o;
    double shift2, turn2; /* it holds while |o - o0|^2 < shift2 and |M - M0|^2 < turn2; 0: no longer */
    double margin;        /* it was listed for [m] */
    int64_t uses;         /* looks since then */
    int32_t *wall; /* [walls + shy] the caller's: faces of a surface that is not convex, in reach as long, and
                    * vertices of A that may come behind it as long */
    int32_t walls, shy, wall_cap;
    struct fl_footing *footing; /* of a surface: what may lie under a face of A (footing.h), or NULL */
};

/* The margin to list with next [m], from how soon the last one was used up: a list costs as much as some
 * looks at it, and each of these the more, the farther it reaches; the sum is least where the margin is the
 * root of R times the way from look to look.  R is the reach; nothing but the cost depends on it. */
double fl_matches_margin(const fl_matches *l, double R);

/* List what of the features a of A and b of B can come within R of each other while no point that matters
 * moves by more than `margin` [m] against the other core: those of A, and those of B within reach of it,
 * which are no farther from A's centre than A's own and the reach.
 *   behind   how far below a face its prism reaches [m]
 *   M, o     where A stands now
 * -1 when memory runs out. */
int fl_matches_list(fl_matches *l, const fl_side *A, const fl_reach *a, const fl_side *B, const fl_reach *b,
                    double R, double behind, double margin, const fl_mat3 *M, fl_vec3 o);

/* It is still good where A stands now, and is counted as used. */
static inline int fl_matches_hold(fl_matches *l, const fl_mat3 *M, fl_vec3 o)
{
    double turn2 = 0.0;
    if (!(v3_norm2(v3_sub(o, l->o)) < l->shift2)) return 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) turn2 += (M->m[i][k] - l->M.m[i][k]) * (M->m[i][k] - l->M.m[i][k]);
    if (!(turn2 < l->turn2)) return 0;
    l->uses++;
    return 1;
}

/* Enter of A what the list speaks of, as fl_places_enter().  -1 when memory runs out. */
int fl_matches_enter(fl_places *w, const fl_matches *l, const fl_poly *a, fl_mat3 M, fl_vec3 o);

/* The places of all that is listed, added to w, where A has been entered.  rim_a, rim_b: widths of the fading
 * rims of the faces of A, of B [m].  -1 when memory runs out. */
int fl_matches_places(fl_places *w, const fl_matches *l, const fl_side *A, const fl_side *B, double R,
                      double behind, double rim_a, double rim_b);

/* What it takes of memory. */
double fl_matches_bytes(const fl_matches *l);

void fl_matches_free(fl_matches *l);

#endif
