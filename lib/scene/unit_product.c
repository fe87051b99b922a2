/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/unit_product.h"
#include <stdlib.h>
#include <string.h>
#include "base/pi.h"

static const char LETTERS[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

static const struct symbol {
    const char *name, *prefixes;
    int power[FL_DIMENSIONS], decimal; /* exponents of kg, m, s, rad */
    double mul, div;
} symbols[] = {
    {"m", "umcdk", {0, 1, 0, 0}, 0, 1, 1},   {"g", "mkM", {1, 0, 0, 0}, -3, 1, 1},
    {"t", "kM", {1, 0, 0, 0}, 3, 1, 1},      {"s", "um", {0, 0, 1, 0}, 0, 1, 1},
    {"min", "", {0, 0, 1, 0}, 0, 60, 1},     {"h", "", {0, 0, 1, 0}, 0, 3600, 1},
    {"N", "kMG", {1, 1, -2, 0}, 0, 1, 1},    {"Pa", "kMG", {1, -1, -2, 0}, 0, 1, 1},
    {"J", "kMG", {1, 2, -2, 0}, 0, 1, 1},    {"Nm", "kMG", {1, 2, -2, 0}, 0, 1, 1},
    {"Ns", "kMG", {1, 1, -1, 0}, 0, 1, 1},   {"Nms", "kMG", {1, 2, -1, 0}, 0, 1, 1},
    {"Hz", "mk", {0, 0, -1, 0}, 0, 1, 1},    {"rad", "m", {0, 0, 0, 1}, 0, 1, 1},
    {"deg", "", {0, 0, 0, 1}, 0, PI, 180.0},
};
/* Beyond these a word is no unit in use, and its size could overflow. */
#define MOST_SIZE 1e15
enum { MOST_DECIMAL = 30, N_SYMBOL = sizeof symbols / sizeof symbols[0] };

static const struct prefix {
    char letter;
    int decimal;
} prefixes[] = {{'u', -6}, {'m', -3}, {'c', -2}, {'d', -1}, {'k', 3}, {'M', 6}, {'G', 9}};

/* The symbol of a run of letters and the power of ten of its prefix; NULL if there is none. */
static const struct symbol *find_symbol(const char *run, size_t len, int *decimal)
{
    *decimal = 0;
    for (int k = 0; k < N_SYMBOL; k++)
        if (strlen(symbols[k].name) == len && strncmp(symbols[k].name, run, len) == 0) return &symbols[k];
    for (int k = 0; k < N_SYMBOL; k++) {
        const struct symbol *s = &symbols[k];
        if (strlen(s->name) != len - 1 || strncmp(s->name, run + 1, len - 1) != 0 ||
            !strchr(s->prefixes, *run))
            continue;
        for (size_t j = 0; j < sizeof prefixes / sizeof *prefixes; j++)
            if (prefixes[j].letter == *run) *decimal = prefixes[j].decimal;
        return s;
    }
    return NULL;
}

/* Twice the exponent at *at, which goes behind it; 2 where there is none. */
static int read_exponent(const char **at)
{
    static const char *const RAISED[] = {"\xC2\xB2", "\xC2\xB3"};
    const int raised = **at == '^';
    for (int k = 0; k < 2; k++)
        if (strncmp(*at, RAISED[k], 2) == 0) return *at += 2, 2 * (k + 2);
    const char *digit = *at + raised;
    if (!(*digit >= (raised ? '0' : '1') && *digit <= '9')) return raised ? -1 : 2;
    int twice = 2 * (*digit - '0');
    *at = digit + 1;
    if (raised && strncmp(*at, ".5", 2) == 0) *at += 2, twice++;
    return twice ? twice : -1;
}

/* Multiply by a factor with its exponent, of either sign.  A square root is taken of even powers of ten
 * alone: -1 for another. */
static int multiply(fl_unit_product *u, const struct symbol *s, int decimal, int twice)
{
    decimal += s->decimal;
    if (twice % 2 && (s->mul != s->div || decimal * twice % 2)) return -1;
    for (int k = 0; k < FL_DIMENSIONS; k++) u->power[k] += s->power[k] * twice;
    u->decimal += decimal * twice / 2;
    for (int k = 2; k <= twice; k += 2) u->mul *= s->mul, u->div *= s->div;
    for (int k = 2; k <= -twice; k += 2) u->mul *= s->div, u->div *= s->mul;
    return 0;
}

static int read_factor(const char **at, int sign, fl_unit_product *u)
{
    const size_t len = strspn(*at, LETTERS);
    int decimal = 0;
    const struct symbol *const s = len ? find_symbol(*at, len, &decimal) : NULL;
    if (!s) return -1;
    *at += len;
    const int twice = read_exponent(at);
    return twice < 0 ? -1 : multiply(u, s, decimal, sign * twice);
}

int fl_unit_product_read(const char *word, fl_unit_product *u)
{
    int sign = 1;
    *u = (fl_unit_product){.mul = 1.0, .div = 1.0};
    for (const char *at = word;;) {
        if (read_factor(&at, sign, u)) return -1;
        if (!(u->mul <= MOST_SIZE && u->div <= MOST_SIZE && abs(u->decimal) <= MOST_DECIMAL)) return -1;
        if (!*at) return 0;
        if (*at == '/') sign = -1, at++;
        else if (sign < 0) return -1;
        else if (*at == '.' || *at == '*') at++;
        else if (strncmp(at, "\xC2\xB7", 2) == 0) at += 2;
        else return -1;
    }
}

int fl_unit_product_same_dimensions(const fl_unit_product *a, const fl_unit_product *b)
{
    return memcmp(a->power, b->power, sizeof a->power) == 0;
}

double fl_unit_product_convert(const fl_unit_product *from, const fl_unit_product *to, double x)
{
    double mul = from->mul * to->div, div = from->div * to->mul;
    for (int k = from->decimal - to->decimal; k > 0; k--) mul *= 10.0;
    for (int k = from->decimal - to->decimal; k < 0; k++) div *= 10.0;
    return x * mul / div;
}
