/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sizes_law.h -- names of size distributions, as a user gives them and a certificate repeats them.
 *
 *    equal                               all floes have the same area
 *    lognormal:CV                        areas, coefficient of variation CV
 *    weibull:K                           areas, shape K (1 is the exponential law)
 *    power:EXP,DMIN,DMAX[,WHAT,HOW]      diameters D = sqrt(4 a / pi) from DMIN to DMAX [m]
 *
 * Four conventions for exponents of floe sizes are in use; they differ by up to three.  WHAT is number (of
 * floes) or area (covered by them).  HOW is cumulative (of all floes larger than D) or density (per unit
 * of D):
 *    number,density      n(D) ~ D^-EXP           beta = EXP
 *    number,cumulative   N(> D) ~ D^-EXP         beta = EXP + 1    default
 *    area,density        D^2 n(D) ~ D^-EXP       beta = EXP + 2
 *    area,cumulative     A(> D) ~ D^-EXP         beta = EXP + 3
 * beta is that of sizes.h, n(D) ~ D^-beta on [DMIN, DMAX].  A cumulative law means its density, truncated
 * at DMIN and DMAX; the number above D therefore bends down near DMAX. Source: Rothrock & Thorndike, J.
 * Geophys.  Res.  89 (1984) 6477; Stern, Schweiger, Zhang & Steele, Elementa 6 (2018) 49, on conventions. */
#ifndef FL_ICE_SIZES_LAW_H
#define FL_ICE_SIZES_LAW_H
#include "base/err.h"
#include "ice/sizes.h"

enum { FL_SIZES_LAW_LEN = 160 };

/* 1 if the text is the name of a law, or starts like one. */
int fl_sizes_is_law(const char *text);

/* Parse the name of a law.
 *    name  out: the complete name, with defaults, which gives the same law
 * Returns 0, or -1 with FL_USAGE (what was found and what is expected); out and name are unchanged then. */
int fl_sizes_parse(fl_sizes *out, char name[FL_SIZES_LAW_LEN], const char *text, fl_err *err);

#endif
