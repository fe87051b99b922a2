/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_section.h -- stiffness of the cross-sections of bars and beams.
 *
 *   pipe       outer diameter D, wall T:  A = pi T (D - T),  I = pi (D4 - (D - 2T)4)/64,  J = 2 I
 *   rectangle  B along local y, H along local z:  A = B H,  Iy = B H3/12,  Iz = H B3/12,
 *              J = a b3 [1/3 - 64/pi5 (b/a) sum tanh(n pi a/2b)/n5, n odd], a >= b the sides (Saint-Venant)
 *   bar        area alone
 * E and G are the moduli, rho the density.  Units are those of the model, which have to be consistent. */
#ifndef FL_MEMBER_MEMBER_SECTION_H
#define FL_MEMBER_MEMBER_SECTION_H

enum fl_member_form { FL_MEMBER_GENERAL, FL_MEMBER_PIPE, FL_MEMBER_RECTANGLE, FL_MEMBER_BAR_FORM };

typedef struct {
    double ea;       /* axial stiffness EA [force] */
    double eiy, eiz; /* bending about local y (deflection along z), about local z (along y) [force length2] */
    double gj;       /* torsion GJ */
    double mass;     /* per length, 0: none was given */
    double radius;   /* of the circle round the section, 0: not known */
    int bar;         /* transmits axial force alone */
    int form;        /* enum fl_member_form */
    double given[5]; /* of pipe D T E G rho, rectangle B H E G rho, bar A E rho */
} fl_member_section;

fl_member_section fl_member_section_pipe(double d, double t, double e, double g, double rho);
fl_member_section fl_member_section_rectangle(double b, double h, double e, double g, double rho);
fl_member_section fl_member_section_bar(double area, double e, double rho);

#endif
