/* SPDX-License-Identifier: GPL-3.0-or-later */
/* panel_state.h -- contact loads on the panels of the structure (contact/panel_load.h collects them). */
#ifndef FL_WORLD_PANEL_STATE_H
#define FL_WORLD_PANEL_STATE_H
#include "broad/bvh.h"
#include "geom/vec3.h"

/* A panel: a triangle of the structure, or a cone. */
typedef struct {
    fl_vec3 v[3], centroid; /* in the pose of the file; of a cone v[] is its centroid three times [m] */
    double area;            /* [m2] */
    int32_t part;
} fl_load_panel;

/* One point of a contact with the structure. */
typedef struct {
    int32_t pair, order, i, part, panel;
    fl_vec3 force;       /* on the floe [N] */
    fl_vec3 n, point;    /* normal from structure to floe; point, world axes [m] */
    double normal_force; /* [N] */
    double area;         /* of the whole contact [m2] */
    double overlap;      /* [m] */
} fl_panel_point;

/* The points that one thread collects in a step. */
typedef struct {
    fl_panel_point *point;
    int32_t *list;
    int32_t n, point_cap, list_cap;
} fl_panel_points;

typedef struct fl_load_event fl_load_event;

/* panels = 0 and no memory where neither panels nor events are written. */
typedef struct {
    int32_t panels, trees, threads;
    fl_load_panel *panel;       /* [panels] part by part, triangles before cones */
    fl_aabb *box;               /* [panels] */
    fl_vec3 *impulse;           /* [panels] of the interval of the table [N s] */
    int32_t *first;             /* [parts + 1] panels of each part */
    fl_bvh *tree;               /* [parts] over the triangles of each part */
    int32_t *cone;              /* [pieces + walls] panel of a cone, -1 for others */
    fl_panel_points *by_thread; /* [threads] */
    fl_panel_point *point;      /* [points] of all pairs, in the order of the pairs */
    fl_load_event *event;       /* [events] of the interval, by floe and part */
    int32_t points, point_cap, events, event_cap;
} fl_panel_loads;

#endif
