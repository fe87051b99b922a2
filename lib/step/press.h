/* SPDX-License-Identifier: GPL-3.0-or-later */
/* press.h -- where the ice presses on the structure: on which panels, and from which floe.
 *
 * A panel is a triangle of the mesh, or a cone as a whole.  Every place of a contact has its own normal
 * force. Places that stand for a strip or for an area, places.h, are spread over it again, as an even
 * pressure with their mean and second moments, and each triangle has the share that lies over it; others fall
 * to the nearest one as a whole.  What is left of the force of the pair, friction and what rims pull, is
 * shared out in the ratio of the normal forces.  So the panels of a part have its load, to rounding.  The
 * same places, summed over the interval for each floe and part, are the events.
 *
 * w->press.panels is 0 and nothing here is called where the scene asks for neither. */
#ifndef FL_STEP_PRESS_H
#define FL_STEP_PRESS_H
#include "world/world.h"

/* One floe on one part over an interval. */
struct fl_press_event {
    int32_t id, part;
    fl_vec3 impulse; /* on the part [N s] */
    fl_vec3 across;  /* sum of the normal impulses, from the part to the floe [N s] */
    fl_vec3 at;      /* sum of normal impulse times point [N s m] */
    double weight;   /* sum of normal impulses [N s] */
    double area;     /* sum of normal impulse times area [N s m2] */
    double overlap;  /* largest [m] */
};

/* Panels of the surface, when output.panels or output.events asks.  -1 with FL_SYSTEM. */
int fl_press_make(fl_world *w, const fl_surface *surface, fl_err *err);
void fl_press_free(fl_press *s);

/* Whether panels want to know all places of pair p. */
static inline int fl_press_wants(const fl_world *w, const fl_pair *p)
{
    return w->press.panels && p->j >= w->n && p->j < w->n + w->pieces;
}

/* For pair p of a floe and a piece, evaluated just now by the calling thread: its places.
 *   scale  force of a place per unit of its pull: of `patch` dW/dU, else the stiffness
 *   chi    damping factor [s/m]
 * A thread that runs out of memory sets w->failed. */
void fl_press_note(fl_world *w, const fl_pair *p, const fl_places *s, double scale, double chi);

/* The same for a law with one contact: at, n in the frame of the piece. */
void fl_press_note_one(fl_world *w, const fl_pair *p, fl_vec3 at, fl_vec3 n, double area);

/* Before the pairs are evaluated, and after: forget, then put in the order of the pairs.  -1 with FL_SYSTEM.
 */
void fl_press_clear(fl_world *w);
int fl_press_sort(fl_world *w, fl_err *err);

/* Add h times what was found to the panels and events of the interval.  -1 with FL_SYSTEM. */
int fl_press_add(fl_world *w, double h, fl_err *err);

/* An interval ends. */
void fl_press_panels_end(fl_world *w);
void fl_press_events_end(fl_world *w);

#endif
