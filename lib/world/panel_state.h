/* SPDX-License-Identifier: GPL-3.0-or-later */
/* panel_state.h -- contact loads on the panels of the structure (contact/panel_load.h collects them). */
#ifndef FL_WORLD_PANEL_STATE_H
#define FL_WORLD_PANEL_STATE_H
#include "broad/bvh.h"
#include "geom/vec3.h"

/* A panel: a triangle of the structure, or a cone. */
typedef struct {
    fl_vec3 centroid; /* in the pose of the file [m] */
    double area;      /* [m2] */
    int32_t part;
} fl_load_panel;

/* A triangle of the surface of a piece, and the panel that bears its load. */
typedef struct {
    fl_vec3 v[3]; /* in the pose of the file [m] */
    double area;  /* [m2] */
    int32_t panel;
} fl_load_triangle;

/* One point of a contact with the structure. */
typedef struct {
    int32_t pair, order, i, part, panel;
    fl_vec3 force;       /* on the floe [N] */
    fl_vec3 n, point;    /* normal from structure to floe; point, world axes [m] */
    double normal_force; /* [N] */
    double area;         /* of the whole contact [m2] */
    double overlap;      /* [m] */
} fl_panel_point;

/* The load of a contact on one of the parts that bear it together. */
typedef struct {
    int32_t pair, order, i, j, part;
    fl_vec3 force, torque; /* on the part; about the origin of piece j, world axes [N], [N m] */
} fl_load_share;

/* The points and shares that one thread collects in a step. */
typedef struct {
    fl_panel_point *point;
    fl_load_share *share;
    int32_t *list;
    int32_t n, point_cap, list_cap, shares, share_cap;
} fl_panel_points;

typedef struct fl_load_event fl_load_event;

/* all = 0 and no memory where neither panels nor events are written and no piece is of several parts. */
typedef struct {
    int32_t all, panels; /* panels that there are, and that are written: all or 0 */
    int32_t pieces, threads;
    int shared;                 /* some piece is of several parts */
    fl_load_panel *panel;       /* [all] part by part, triangles before cones */
    fl_vec3 *impulse;           /* [panels] of the interval of the table [N s] */
    int32_t *first;             /* [parts + 1] panels of each part */
    fl_load_triangle *triangle; /* piece by piece */
    fl_aabb *box;               /* of the triangles */
    int32_t *first_triangle;    /* [pieces + 1] */
    fl_bvh *tree;               /* [pieces] over the triangles of each piece; empty for a cone by itself */
    int32_t *cone;              /* [pieces] panel of a cone by itself, -1 for others */
    fl_load_share *share;       /* [shares] of this step, by pair and part */
    int32_t shares, share_cap;
    fl_panel_points *by_thread; /* [threads] */
    fl_panel_point *point;      /* [points] of all pairs, in the order of the pairs */
    fl_load_event *event;       /* [events] of the interval, by floe and part */
    int32_t points, point_cap, events, event_cap;
} fl_panel_loads;

#endif
