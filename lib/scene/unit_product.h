/* SPDX-License-Identifier: GPL-3.0-or-later */
/* unit_product.h -- a unit written as a product: its dimensions and its size in SI.
 *
 *     product = factor { "." factor } { "/" factor }       "kN.m/rad", "MN.s/m3"
 *     factor  = [prefix] symbol [["^"] exponent]           exponents 1 to 9, also 0.5 and 1.5 behind "^"
 *
 * Symbols: m, g, t, s, min, h, N, Pa, J, rad, deg, Hz, and Nm, Ns, Nms for N.m, N.s, N.m.s.  Prefixes are
 * those in use with a symbol.  Forces, pressures and energies take k, M, G and no m for milli, as "mPa" is
 * far more often a slip of MPa.  "*" and the raised dot stand for ".", raised 2 and 3 for exponents.  A "."
 * behind a "/" is refused: "kN/m.s" has two meanings. */
#ifndef FL_SCENE_UNIT_PRODUCT_H
#define FL_SCENE_UNIT_PRODUCT_H

enum { FL_DIMENSIONS = 4 };

typedef struct {
    int power[FL_DIMENSIONS]; /* twice the exponents of kg, m, s, rad */
    int decimal;              /* size in SI: 10^decimal mul / div */
    double mul, div;
} fl_unit_product;

/* Parse a word.  0, or -1 if it is no such product. */
int fl_unit_product_read(const char *word, fl_unit_product *u);

int fl_unit_product_same_dimensions(const fl_unit_product *a, const fl_unit_product *b);

/* Convert x in units of `from` to units of `to`, of the same dimensions. */
double fl_unit_product_convert(const fl_unit_product *from, const fl_unit_product *to, double x);

#endif
