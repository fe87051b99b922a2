/* SPDX-License-Identifier: GPL-3.0-or-later */
/* measure.h -- numbers of options with one unit behind them, as scenes take it: "14 m", "160x80 m", "0.7,0
 * kn". */
#ifndef VORONOI_ICE_MEASURE_H
#define VORONOI_ICE_MEASURE_H
#include "base/err.h"
#include "base/number_text.h"
#include "scene/scene_unit.h"

/* Room for the text of a law, a word and two numbers. */
enum { MEASURE_LAW_LEN = 2 * FL_NUMBER_LEN + 16 };

/* Exactly n numbers, separated by `divide`, each from lo to hi in the first unit of the kind after
 * conversion. expected describes them for the message.  Returns 0, or -1 with FL_USAGE. */
int measure_read(const char *option, const char *text, char divide, int n, enum fl_unit_kind kind, double lo,
                 double hi, const char *expected, double *x, fl_err *err);

/* A law of lengths with a unit, as "40 cm", "uniform:20,60 cm" or "lognormal:50,0.3 cm", in metres and
 * without it. Returns 0; or -1 if the text has no such form, as where it has no unit or is the name of a
 * file. */
int measure_law(const char *text, char law[MEASURE_LAW_LEN]);

#endif
