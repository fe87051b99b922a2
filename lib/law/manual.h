/* SPDX-License-Identifier: GPL-3.0-or-later */
/* manual.h -- the contact law of the DilatedDEM manual: one formula for each pair of features in contact.
 *
 * Equations (2) and (18) are corrected; the printed ones are available by flags.  The law is not the gradient
 * of one energy: the force jumps where the pair of features changes.  It serves comparisons with results that
 * were obtained by it. */
#ifndef FL_LAW_MANUAL_H
#define FL_LAW_MANUAL_H

/* Features in contact: V vertex, E edge, F face; EP parallel edges. */
typedef enum {
    FL_MANUAL_VV,
    FL_MANUAL_VE,
    FL_MANUAL_VF,
    FL_MANUAL_EE,
    FL_MANUAL_EP,
    FL_MANUAL_EF,
    FL_MANUAL_FF
} fl_manual_kind;

typedef struct {
    fl_manual_kind kind;
    double length; /* of the overlap, for EP and EF     [m]  */
    double area;   /* of the overlap, for FF            [m2] */
    double sine;   /* of the angle of the edges, for EE      */
    double r_low;  /* radius of the side with the lower feature, of vertex, edge, face; 0: sharp     [m] */
    double r_high; /* of the other side; 0: flat                                                       [m] */
    double edge;   /* shorter of the two edges, for EE: bounds the contact ellipse                     [m] */
} fl_manual_contact;

/* Stiffness k [N/m^n] of F = k s^n; sets the exponent *n to 1 or 1.5.
 *   VV (11)  4/3 E* sqrt(R*)                     1/R* = 1/Ra + 1/Rb
 *   VE (13)  4/3 E* (Rv R*)^(1/4)
 *   VF (12)  4/3 E* sqrt(Rv)
 *   EE (14)-(18)  4/3 E* sqrt(R~), R~ = sqrt(Ra Rb)/sin; twice that R~ as printed.  The long radius
 *            is at most edge^2/(4 s), so that the ellipse stays on the edge when sin goes to 0.
 *   EP (19), EF (20)  as printed 4/3 L E* sqrt(R), L taken as a number, exponent 3/2;
 *            si: (pi/4) E* L, exponent 1 (line contact, independent of R: Johnson 1985, ch. 4)
 *   FF (25)  2 E* 1.02 sqrt(A/pi), exponent 1
 *   modulus  E* [Pa]      overlap  s [m]      si, literal18   flags */
double fl_manual_stiffness(const fl_manual_contact *c, double modulus, double overlap, int si, int literal18,
                           double *n);

/* Damping force at the approach speed u [N]: 2 zeta sqrt(M k) u for n = 1, alpha sqrt(M k) s^(1/4) u for
 * 3/2. */
double fl_manual_damping(double k, double n, double overlap, double mass, double zeta, double alpha,
                         double u);

#endif
