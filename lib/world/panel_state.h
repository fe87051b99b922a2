/* SPDX-License-Identifier: GPL-3.0-or-later */
/* panel_state.h -- contact loads on the panels of the structure. */
#ifndef FL_WORLD_PANEL_STATE_H
#define FL_WORLD_PANEL_STATE_H
#include "broad/bvh.h"
#include "geom/vec3.h"

/* Where the ice presses, see panel_load.h; panels = 0 and no memory where nobody asks. */
typedef struct {
    fl_vec3 v[3], centroid; /* in the pose of the file; a cone has its middle three times [m] */
    double area;            /* [m2] */
    int32_t part;
} fl_load_panel;

/* One place of a contact. */
typedef struct {
    int32_t pair, order, i, part, panel;
    fl_vec3 force;       /* on the floe [N] */
    fl_vec3 n, point;    /* from the structure to the floe; the point, world [m] */
    double normal_force; /* [N] */
    double area;         /* of the whole contact [m2] */
    double overlap;      /* [m] */
} fl_panel_point;

typedef struct {
    fl_panel_point *point;
    int32_t *list;
    int32_t n, point_cap, list_cap;
} fl_panel_points;

typedef struct fl_load_event fl_load_event;

typedef struct {
    int32_t panels, trees, threads;
    fl_load_panel *panel;       /* [panels] part by part, triangles before cones */
    fl_aabb *box;               /* [panels] */
    fl_vec3 *impulse;           /* [panels] of the interval [N s] */
    int32_t *first;             /* [parts + 1] */
    fl_bvh *tree;               /* [parts] over the triangles of each */
    int32_t *cone;              /* [pieces + walls] panel of a cone, -1 for others */
    fl_panel_points *by_thread; /* [threads] */
    fl_panel_point *point;      /* [n_now] of all pairs, in their order */
    fl_load_event *event;       /* [events] of the interval, by floe and part */
    int32_t points, point_cap, events, event_cap;
} fl_panel_loads;

#endif
