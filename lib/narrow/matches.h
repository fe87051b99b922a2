/* SPDX-License-Identifier: GPL-3.0-or-later */
/* matches.h -- which feature of one core can have a place over which feature of the other.
 *
 * Most features of two touching cores have nothing to do with each other, and what does stays for many steps:
 * the list of those that do, or will before any point has moved by more than a margin, is made once and used
 * until then.  It only leaves out: a match that is listed in vain has no place, and those that have one come
 * in the same order whenever the list was made, so that not a bit depends on that. */
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
    int16_t kind, of_b; /* enum fl_match_kind; whether `own` is B's */
    int32_t own, other; /* numbers of the features */
} fl_match;

/* Zeroed to start: nothing listed, and valid up to a path of 0. */
struct fl_matches {
    fl_match *c;
    int32_t n, cap;
    double until;  /* up to which path the list holds [m] */
    int32_t *wall; /* [walls] the caller's: faces of a surface that is not convex, in reach as long */
    int32_t walls, wall_cap;
};

/* List what of the features a of A and b of B can come within R of each other while no point moves by more
 * than `margin` [m] against the other core: vertices of A, then of B, then edges and faces of A, then of B,
 * each over faces, edges and vertices. behind  how far below a face its prism reaches [m] path    now; until
 * is set to it and what the margin allows.  A point within reach of a core that turns moves more than the
 * core's own points, as it is farther from the centre [m] -1 when memory runs out. */
int fl_matches_list(fl_matches *l, const fl_side *A, const fl_reach *a, const fl_side *B, const fl_reach *b,
                    double R, double behind, double margin, double path);

/* The places of all that is listed, added to w.  rim_a, rim_b: widths of the fading rims of the faces of A,
 * of B [m].  -1 when memory runs out. */
int fl_matches_places(fl_places *w, const fl_matches *l, const fl_side *A, const fl_side *B, double R,
                      double behind, double rim_a, double rim_b);

void fl_matches_free(fl_matches *l);

#endif
