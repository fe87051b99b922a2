/* SPDX-License-Identifier: GPL-3.0-or-later */
/* splitting.h -- splitting of a floe by a crack that runs from a contact through it.
 *
 * A crack of length c = alpha L along a line of length L through the floe, B = area/L wide, opens with
 *     K_I h sqrt(L) = Q kQ(alpha, B/L) - F kX(alpha, B/L) + Q' kQ + S kS(alpha)
 *   Q     pair of lateral forces that opens its mouth, F the push along it, of the contact
 *   Q', S moment and tension of the line by the other contacts and inertia: Q' = 2 M/L, S = N - Q'
 *   h     thickness
 * and splits the floe if K_I stays above the toughness K_IC for all alpha from w_c/(2 L) on, w_c the width of
 * the contact.  kQ, kX and kS are edge cracks in plates by finite elements (quarter points), B/L = 1/2, 1, 2,
 * interpolated in between.  kQ has a minimum, 5.351 at B = L, so a pair alone splits from
 * Q = 0.187 K_IC h sqrt(L) on.
 *
 * The contact is a pressure p on the area S of the structure inside the floe (area_vector.h).  With S_s the
 * part on one side of the line, along it (1) and across it (2), and mu the friction there,
 *     Q_s = p (S_s2 - mu S_s1),    F_s = p (S_s1 + mu S_s2),
 * so for a round pile and uniform pressure over the half angle t, Q/F = (tan(t/2) - mu)/(2 (1 + mu
 * tan(t/2))): a push alone closes the crack, and friction decides.
 *
 * Of lines through the contact, at 45 degrees to the inward normal and less, the one that asks least
 * splits. */
#ifndef FL_FAILURE_SPLITTING_H
#define FL_FAILURE_SPLITTING_H
#include "failure/plan_polygon.h"

/* kQ, kX, kS for B/L and alpha in [0.02, 0.5]. */
double fl_split_opening(double alpha, double ratio);
double fl_split_closing(double alpha, double ratio);
double fl_split_tension(double alpha);

/* Least K_I h sqrt(L) over alpha in [from, 0.5] [N]. */
double fl_split_least(double Q, double F, double Q2, double S, double ratio, double from);

/* Loads of one line. */
typedef struct {
    double Q, F;      /* of the contact [N] */
    double tension;   /* N of the line, by others [N] */
    double moment;    /* M, opens the mouth where positive [N m] */
    double length;    /* L [m] */
    double breadth;   /* B [m] */
    double thickness; /* h [m] */
    double width;     /* w_c [m] */
} fl_split_line;

/* K_I over the line's least alpha [Pa m^0.5]. */
double fl_split_intensity(const fl_split_line *s);

#endif
