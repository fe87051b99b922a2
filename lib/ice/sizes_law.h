/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sizes_law.h -- the name of a law of sizes, as a user gives it and as a certificate repeats it.
 *
 *     equal                               all floes have the same area
 *     lognormal:CV                        areas, standard deviation over mean CV
 *     weibull:K                           areas, shape K (1 is the exponential law)
 *     power:EXP,DMIN,DMAX[,WHAT,HOW]      diameters D = sqrt(4 a / pi) from DMIN to DMAX [m]
 *
 * Exponents of floe sizes are told in four ways, which differ by up to three.  WHAT is number (of floes) or
 * area (that they cover), HOW is cumulative (of all floes larger than D) or density (per unit of D):
 *     number,density      n(D) ~ D^-EXP           beta = EXP
 *     number,cumulative   N(> D) ~ D^-EXP         beta = EXP + 1    where neither is said
 *     area,density        D^2 n(D) ~ D^-EXP       beta = EXP + 2
 *     area,cumulative     A(> D) ~ D^-EXP         beta = EXP + 3
 * beta is that of sizes.h, n(D) ~ D^-beta on [DMIN, DMAX].  A cumulative law means its density, cut off at
 * DMIN and DMAX; the number above D then bends down near DMAX, as it must.  Source: Rothrock & Thorndike,
 * J. Geophys. Res. 89 (1984) 6477; Stern, Schweiger, Zhang & Steele, Elementa 6 (2018) 49, on conventions. */
#ifndef FL_ICE_SIZES_LAW_H
#define FL_ICE_SIZES_LAW_H
#include "base/err.h"
#include "ice/sizes.h"

enum { FL_SIZES_LAW_LEN = 160 };

/* 1 when the text is the name of a law, or begins like one. */
int fl_sizes_is_law(const char *text);

/* Read the name of a law.
 *   name  out: the same with nothing left out, which reads as the same law
 * Returns 0, or -1 with FL_USAGE: what was found and what is expected; out and name are untouched then. */
int fl_sizes_parse(fl_sizes *out, char name[FL_SIZES_LAW_LEN], const char *text, fl_err *err);

#endif
