/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pressure.h -- local pressure: the largest force on a circular window of given area anywhere on a part. */
#ifndef FL_STAT_PRESSURE_H
#define FL_STAT_PRESSURE_H
#include "base/err.h"
#include "stat/contact_events.h"

typedef struct {
    double force;     /* F(A), sum of the forces inside [N] */
    int32_t contacts; /* number of contacts inside */
    fl_vec3 centre;   /* of the window [m] */
} fl_window;

/* Scratch, one per thread. */
typedef struct {
    struct fl_arc_end *arc_end;
    int32_t cap;
} fl_window_work;

/* The disc of area A on the surface of a part with the largest force, F(A) = max sum_c F_c, p(A) = F(A) / A.
 *
 * An optimal disc exists with a contact on its rim.  For each such contact, the centres whose disc contains
 * a given neighbour form an arc; a sweep over the ends of all arcs finds the optimum.  The surface is
 * approximated by the plane normal to that contact, with neighbours at their true distance; contacts whose
 * normals have a negative dot product are excluded.  Exact on a plane; on a cylinder of radius R distances
 * are short by (r/R)^2 / 24, r^2 = A/pi.
 *   event[n] contacts of one time; those of `part` with a compressive normal force count
 *   area     A > 0 [m^2]
 * A contact over an area a > A, or a length l > 2r, gives the window the fraction A/a or 2r/l of its force;
 * otherwise its force acts at its point.  0 (a window without contacts has force 0), or -1 with FL_SYSTEM in
 * err. Source: ISO 19906 (2019), A.8.2.5, for local pressures on areas; Chazelle & Lee 1986, Computing 36:1,
 * for the circle that holds most points. */
int fl_largest_load_window(int32_t n, const fl_contact_event *event, int32_t part, double area,
                           fl_window *best, fl_window_work *w, fl_err *err);

/* Accepts a zeroed struct and leaves one. */
void fl_window_work_free(fl_window_work *w);

/* Local pressure of massive ice, 7.40 A^-0.70 MPa up to 10 m^2 and 1.48 MPa above, in Pa.
 * Source: ISO 19906, A.8.2.5. */
double fl_pressure_iso19906(double area);

/* Least-squares fit of log p = log c - k log A to n points: p = c A^-k.  Points with p <= 0 are ignored.
 * Returns the number of points used; with fewer than two c and k are NAN. */
int32_t fl_pressure_fit(int32_t n, const double *area, const double *p, double *c, double *k);

#endif
