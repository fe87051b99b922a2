/* SPDX-License-Identifier: GPL-3.0-or-later */
/* panel_load.h -- loads on the panels of the structure, and load events of each floe on each part.
 *
 * A panel is a triangle of the mesh, or a whole cone.  Each contact point has its own normal force.
 * - Points that stand for a strip or an area (patch_points.h) are spread over it as an even pressure with
 *   the same mean and second moments.  Each triangle gets the share that lies over it.
 * - Other points go to the nearest triangle.
 * - The rest of the force of the pair, which is friction and the pull of rims, is distributed in proportion
 *   to the normal forces.
 * So the panels of a part sum up to its load, to rounding.  The same points, summed over an interval for
 * each floe and part, are the events.
 *
 * A piece joined of several parts (structure/region.h) has one contact with a floe.  If only triangles of one
 * part are near, that part bears it.  Else the points are recorded in any case, and each part bears the forces
 * of its points; what they leave of the moment goes by the normal forces.  Such a contact has no surrogate, and
 * nothing rests on such a piece.
 *
 * Without output.panels, output.events and joined parts, w->panel_load.all is 0 and nothing here is called. */
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
    double max_overlap;     /* [m] */
};

/* Makes the panels of the surface if output.panels or output.events is set, or a piece is of several parts.
 * -1 with FL_SYSTEM. */
int fl_panels_make(fl_world *w, const fl_surface *surface, fl_err *err);
void fl_panels_free(fl_panel_loads *s);

/* True if the panels need the contact points of pair p. */
static inline int fl_panels_need_points(const fl_world *w, const fl_pair *p)
{
    return (w->panel_load.panels && p->j >= w->n && p->j < w->n + w->pieces) ||
           p->load_part == FL_LOAD_SHARED;
}

/* Sets p->load_part of a pair with a piece of several parts, from its contact points. */
void fl_load_find_part(fl_world *w, fl_pair *p, const fl_patch_points *s);

/* The part of piece j that is nearest to x, world axes. */
int32_t fl_load_part_at(fl_world *w, int32_t j, fl_vec3 x);

/* Records the contact points of pair p of a floe and a piece, which the calling thread has just evaluated.
 *   scale  force of a point per unit of its weight: dW/dU of a patch, else the stiffness
 *   chi    damping factor [s/m]
 * Sets w->failed when memory runs out. */
void fl_panels_record_points(fl_world *w, const fl_pair *p, const fl_patch_points *s, double scale,
                             double chi);

/* The same for a law with one contact of the area given [m2]; at, n in the frame of the piece. */
void fl_panels_record_point(fl_world *w, const fl_pair *p, fl_vec3 at, fl_vec3 n, double area);

/* Clears points and shares before the pairs are evaluated, and sorts them by pair afterwards.  -1 with
 * FL_SYSTEM. */
void fl_panels_clear(fl_world *w);
int fl_panels_sort(fl_world *w, fl_err *err);

/* Adds h [s] times the recorded forces to the panels and events of the interval.  -1 with FL_SYSTEM. */
int fl_panels_accumulate(fl_world *w, double h, fl_err *err);

/* Ends an interval: clears the impulses, or the events. */
void fl_panels_end_interval(fl_world *w);
void fl_events_end_interval(fl_world *w);

#endif
