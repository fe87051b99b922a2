/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>
#include "base/number_text.h"
#include "ice/sizes_law.h"

/* Bounds for which areas, their sums and their logarithms are finite: diameters [m], exponents, the shape
 * of a Weibull law (below the least one the mean of a law exceeds any field), coefficients of variation. */
#define SHORTEST 1e-6
#define LONGEST 1e6
#define STEEPEST 20.0
#define SHAPE_LEAST 0.1
#define SHAPE_MOST 100.0
#define CV_LEAST 1e-3
#define CV_MOST 100.0

static const char *const LAWS[] = {"equal", "lognormal", "weibull", "power"};
enum { LAWS_N = 4, WORDS = 5, WORD_LEN = 64 };

static int starts_with(const char *text, const char *law)
{
    const size_t n = strlen(law);
    return strncmp(text, law, n) == 0 && (text[n] == '\0' || text[n] == ':');
}

int fl_sizes_is_law(const char *text)
{
    for (int k = 0; k < LAWS_N; k++)
        if (starts_with(text, LAWS[k])) return 1;
    return 0;
}

static int fail_law(fl_err *err, const char *text, const char *what)
{
    return fl_fail(err, FL_USAGE, "--sizes is \"%.80s\", %s is expected", text, what);
}

/* Split the text after the colon at commas.  Returns the number of words, -1 if there are too many or too
 * long ones. */
static int split_words(const char *text, char word[WORDS][WORD_LEN])
{
    const char *p = strchr(text, ':');
    int n = 0;
    if (!p) return 0;
    for (p++;; p++) {
        const size_t len = strcspn(p, ",");
        if (n == WORDS || len >= WORD_LEN) return -1;
        memcpy(word[n], p, len);
        word[n++][len] = '\0';
        p += len;
        if (*p == '\0') return n;
    }
}

static int parse_number(const char *word, double lo, double hi, double *x)
{
    return fl_number_f64(word, x) || !(*x >= lo && *x <= hi);
}

static int parse_power(fl_sizes *s, char *name, const char *text, int n, char word[WORDS][WORD_LEN],
                       fl_err *err)
{
    static const char form[] =
        "power:EXP,DMIN,DMAX,number|area,cumulative|density with EXP from -20 to 20 and "
        "0 < DMIN < DMAX in metres";
    const char *what = n == 5 ? word[3] : "number", *how = n == 5 ? word[4] : "cumulative";
    char t[3][FL_NUMBER_LEN];
    double e = 0.0;
    if ((n != 3 && n != 5) || parse_number(word[0], -STEEPEST, STEEPEST, &e) ||
        parse_number(word[1], SHORTEST, LONGEST, &s->dmin) ||
        parse_number(word[2], SHORTEST, LONGEST, &s->dmax) || !(s->dmin < s->dmax))
        return fail_law(err, text, form);
    if ((strcmp(what, "number") != 0 && strcmp(what, "area") != 0) ||
        (strcmp(how, "cumulative") != 0 && strcmp(how, "density") != 0))
        return fail_law(err, text, form);
    s->kind = FL_SIZES_POWER;
    s->beta = e + (what[0] == 'a' ? 2.0 : 0.0) + (how[0] == 'c' ? 1.0 : 0.0);
    snprintf(name, FL_SIZES_LAW_LEN, "power:%s,%s,%s,%s,%s", fl_number_text(e, t[0]),
             fl_number_text(s->dmin, t[1]), fl_number_text(s->dmax, t[2]), what, how);
    return 0;
}

int fl_sizes_parse(fl_sizes *out, char name[FL_SIZES_LAW_LEN], const char *text, fl_err *err)
{
    fl_sizes s = {.mean = 1.0};
    char word[WORDS][WORD_LEN], t[FL_NUMBER_LEN], full[FL_SIZES_LAW_LEN] = "equal";
    const int n = split_words(text, word);
    if (starts_with(text, "equal")) {
        if (strcmp(text, "equal") != 0) return fail_law(err, text, "equal");
        s.kind = FL_SIZES_EQUAL;
    } else if (starts_with(text, "lognormal")) {
        if (n != 1 || parse_number(word[0], CV_LEAST, CV_MOST, &s.cv))
            return fail_law(err, text, "lognormal:CV with CV from 0.001 to 100");
        s.kind = FL_SIZES_LOGNORMAL;
        snprintf(full, sizeof full, "lognormal:%s", fl_number_text(s.cv, t));
    } else if (starts_with(text, "weibull")) {
        if (n != 1 || parse_number(word[0], SHAPE_LEAST, SHAPE_MOST, &s.k))
            return fail_law(err, text, "weibull:K with K from 0.1 to 100");
        s.kind = FL_SIZES_WEIBULL;
        snprintf(full, sizeof full, "weibull:%s", fl_number_text(s.k, t));
    } else if (starts_with(text, "power")) {
        if (parse_power(&s, full, text, n, word, err)) return -1;
    } else {
        return fail_law(err, text, "equal, lognormal:CV, weibull:K or power:EXP,DMIN,DMAX,...");
    }
    *out = s;
    memcpy(name, full, sizeof full);
    return 0;
}
