/* SPDX-License-Identifier: GPL-3.0-or-later */
/* panel_load.h -- where the ice presses on the structure: on which panels, and from which floe.
 *
 * A panel is a triangle of the mesh, or a cone as a whole.  Every place of a contact has its own normal
 * force. Places that stand for a strip or for an area, patch_points.h, are spread over it again, as an even
 * pressure with their mean and second moments, and each triangle has the share that lies over it; others fall
 * to the nearest one as a whole.  What is left of the force of the pair, friction and what rims pull, is
 * shared out in the ratio of the normal forces.  So the panels of a part have its load, to rounding.  The
 * same places, summed over the interval for each floe and part, are the events.
 *
 * w->press.panels is 0 and nothing here is called where the scene asks for neither. */
#ifndef FL_CONTACT_PANEL_LOAD_H
#define FL_CONTACT_PANEL_LOAD_H
#include "world/world.h"

/* One floe on one part over an interval. */
struct fl_load_event {
    int32_t id, part;
    fl_vec3 impulse;        /* on the part [N s] */
    fl_vec3 normal_impulse; /* sum of the normal impulses, from the part to the floe [N s] */
    fl_vec3 impulse_point;  /* sum of normal impulse times point [N s m] */
    double impulse_sum;     /* sum of normal impulses [N s] */
    double impulse_area;    /* sum of normal impulse times area [N s m2] */
    double max_overlap;     /* largest [m] */
};

/* Panels of the surface, when output.panels or output.events asks.  -1 with FL_SYSTEM. */
int fl_panels_make(fl_world *w, const fl_surface *surface, fl_err *err);
void fl_panels_free(fl_panel_loads *s);

/* Whether panels want to know all places of pair p. */
static inline int fl_panels_need_points(const fl_world *w, const fl_pair *p)
{
    return w->panel_load.panels && p->j >= w->n && p->j < w->n + w->pieces;
}

/* For pair p of a floe and a piece, evaluated just now by the calling thread: its places.
 *   scale  force of a place per unit of its pull: of `patch` dW/dU, else the stiffness
 *   chi    damping factor [s/m]
 * A thread that runs out of memory sets w->failed. */
void fl_panels_record_points(fl_world *w, const fl_pair *p, const fl_patch_points *s, double scale,
                             double chi);

/* The same for a law with one contact: at, n in the frame of the piece. */
void fl_panels_record_point(fl_world *w, const fl_pair *p, fl_vec3 at, fl_vec3 n, double area);

/* Before the pairs are evaluated, and after: forget, then put in the order of the pairs.  -1 with FL_SYSTEM.
 */
void fl_panels_clear(fl_world *w);
int fl_panels_sort(fl_world *w, fl_err *err);

/* Add h times what was found to the panels and events of the interval.  -1 with FL_SYSTEM. */
int fl_panels_accumulate(fl_world *w, double h, fl_err *err);

/* An interval ends. */
void fl_panels_end_interval(fl_world *w);
void fl_events_end_interval(fl_world *w);

#endif
