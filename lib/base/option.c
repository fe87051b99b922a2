/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/option.h"
#include "base/text.h"
#include "base/tool.h"

enum {
    OPTIONS_MAX = 100,
    OPERAND = 1,      /* getopt's code of an argument that is no option, read in order */
    LONG_ONLY = 256,  /* code of row 0 that has no letter                              */
    HELP_COLUMN = 26, /* of the texts                                                  */
    SHORT_LIST = 10   /* choices that a message lists; of more it names the nearest    */
};

/* --- conversions ------------------------------------------------------------------------------- */

int fl_option_integer(const char *word, const char *text, int32_t lo, int32_t hi, int32_t *x, fl_err *err)
{
    if (fl_number_i32(text, lo, hi, x) == 0) return 0;
    return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", expected a whole number from %d to %d", word, text, lo,
                   hi);
}

int fl_option_number(const char *word, const char *text, double lo, double hi, const char *expected,
                     double *x, fl_err *err)
{
    double value;
    if (fl_number_f64(text, &value) || !(value >= lo && value <= hi))
        return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", expected %s", word, text, expected);
    *x = value;
    return 0;
}

int fl_option_time(const char *word, const char *text, double *seconds, fl_err *err)
{
    static const struct {
        const char *unit;
        double seconds;
    } known[] = {{"", 1.0}, {"s", 1.0}, {"min", 60.0}, {"h", 3600.0}, {"d", 86400.0}, {"a", 31557600.0}};
    const size_t digits = strspn(text, "+-0123456789.eE");
    char number[40];
    if (digits < sizeof number) {
        memcpy(number, text, digits);
        number[digits] = '\0';
        for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
            double t;
            if (strcmp(text + digits, known[k].unit) != 0 || fl_number_f64(number, &t) || !(t > 0.0))
                continue;
            *seconds = t * known[k].seconds;
            return 0;
        }
    }
    return fl_fail(err, FL_USAGE, "--%s is \"%.40s\", expected a time above 0, as 90, 10min, 3h, 2d or 50a",
                   word, text);
}

static int count_choices(const char *const *choice)
{
    int n = 0;
    while (choice[n]) n++;
    return n;
}

int fl_option_choice(const char *word, const char *text, const char *const *choice, int *k, fl_err *err)
{
    const int n = count_choices(choice);
    char list[200] = "";
    for (int c = 0; c < n; c++)
        if (strcmp(text, choice[c]) == 0) {
            *k = c;
            return 0;
        }
    if (n > SHORT_LIST)
        return fl_fail(err, FL_USAGE, "--%s is \"%.40s\", the nearest that it knows is %s", word, text,
                       fl_text_nearest(text, choice, n));
    for (int c = 0; c < n; c++) {
        const size_t at = strlen(list);
        snprintf(list + at, sizeof list - at, "%s%s", c == 0 ? "" : c + 1 < n ? ", " : " or ", choice[c]);
    }
    return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", expected %s", word, text, list);
}

/* A name that goes into a history line or a record must be one word of it. */
static int one_word(const char *text, size_t most)
{
    return text[0] != '\0' && strlen(text) <= most && !strpbrk(text, " \t\r\n\f\v");
}

int fl_option_word(const char *word, const char *text, const char **out, fl_err *err)
{
    if (!one_word(text, 200))
        return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", expected one word of up to 200 bytes", word, text);
    *out = text;
    return 0;
}

int fl_option_file(const char *word, const char *text, const char **out, fl_err *err)
{
    if (!one_word(text, 1000))
        return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", expected the name of a file without blanks", word,
                       text);
    *out = text;
    return 0;
}

int fl_option_numbers(const char *word, const char *text, char divide, int least, int most, double lo,
                      double hi, const char *expected, double *x, int *n, fl_err *err)
{
    char number[64];
    const char *p = text;
    *n = 0;
    while (p) {
        const char *end = strchr(p, divide);
        const size_t len = end ? (size_t)(end - p) : strlen(p);
        if (*n == most || len >= sizeof number) goto bad;
        memcpy(number, p, len);
        number[len] = '\0';
        if (fl_number_f64(number, &x[*n]) || !(x[*n] >= lo && x[*n] <= hi)) goto bad;
        ++*n;
        p = end ? end + 1 : NULL;
    }
    if (*n >= least) return 0;
bad:
    return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", expected %s", word, text, expected);
}

int fl_option_each(const char *word, const char *text, fl_option_call *call, void *options, fl_err *err)
{
    char *entry = fl_alloc_text(text, err), *const copy = entry;
    int rc = entry ? 0 : -1;
    while (rc == 0 && entry) {
        char *comma = strchr(entry, ',');
        if (comma) *comma++ = '\0';
        rc = entry[0] ? call(options, entry, err)
                      : fl_fail(err, FL_USAGE, "--%s has an empty entry in \"%.60s\"", word, text);
        entry = comma;
    }
    free(copy);
    return rc;
}

/* --- the table --------------------------------------------------------------------------------- */

static int count_options(const fl_option_table *t)
{
    int n = 0;
    while (t->option[n].word) n++;
    return n;
}

int fl_option_row(const fl_option_table *t, const char *word)
{
    for (int k = 0; t->option[k].word; k++)
        if (strcmp(t->option[k].word, word) == 0) return k;
    abort(); /* a name in the program's own text */
}

static void print_option(const fl_option *o)
{
    char head[120];
    const char *line = o->help;
    snprintf(head, sizeof head, "  %c%c%s--%s%s%s", o->letter ? '-' : ' ', o->letter ? o->letter : ' ',
             o->letter ? ", " : "  ", o->word, o->argument ? " " : "", o->argument ? o->argument : "");
    printf("%-*s", HELP_COLUMN - 2, head);
    for (int first = 1; line; first = 0) {
        const char *end = strchr(line, '\n');
        printf("%*s%.*s\n", first ? 2 : HELP_COLUMN, "", end ? (int)(end - line) : (int)strlen(line), line);
        line = end ? end + 1 : NULL;
    }
}

void fl_options_help(const fl_option_table *t)
{
    fputs(t->usage, stdout);
    for (const fl_option *o = t->option; o->word; o++) print_option(o);
}

/* The options in the form of getopt_long(): the code of an option is its letter, or LONG_ONLY + row. */
typedef struct {
    struct option word[OPTIONS_MAX + 1];
    char letters[2 * OPTIONS_MAX + 3];
} getopt_form;

static void convert_table(getopt_form *g, const fl_option_table *t, int n)
{
    int at = 0;
    *g = (getopt_form){0};
    if (t->in_order) g->letters[at++] = '-';
    g->letters[at++] = ':';
    for (int k = 0; k < n; k++) {
        const fl_option *o = &t->option[k];
        g->word[k] = (struct option){o->word, o->argument ? required_argument : no_argument, NULL,
                                     o->letter ? o->letter : LONG_ONLY + k};
        if (!o->letter) continue;
        g->letters[at++] = (char)o->letter;
        if (o->argument) g->letters[at++] = ':';
    }
}

/* getopt_long() returned ':' or '?': says which option needs a value, takes none or is unknown. */
static int fail_option(const fl_option_table *t, int c, int code, const char *word, fl_err *err)
{
    if (c == ':') return fl_fail(err, FL_USAGE, "%.60s needs a value, see %s --help", word, t->program);
    if (!code) return fl_fail(err, FL_USAGE, "%.60s is no option, see %s --help", word, t->program);
    for (int k = 0; t->option[k].word; k++)
        if (code == LONG_ONLY + k || code == t->option[k].letter)
            return fl_fail(err, FL_USAGE, "%.60s: that option takes no value, see %s --help", word,
                           t->program);
    return fl_fail(err, FL_USAGE, "-%c is no option, see %s --help", code, t->program);
}

static int store_option(const fl_option_table *t, const fl_option *o, void *options, const char *text,
                        fl_err *err)
{
    void *const at = (char *)options + o->at;
    switch (o->kind) {
    case FL_OPTION_FLAG: *(int *)at = 1; return 0;
    case FL_OPTION_TEXT: *(const char **)at = text; return 0;
    case FL_OPTION_WORD: return fl_option_word(o->word, text, at, err);
    case FL_OPTION_FILE: return fl_option_file(o->word, text, at, err);
    case FL_OPTION_INTEGER: return fl_option_integer(o->word, text, (int32_t)o->lo, (int32_t)o->hi, at, err);
    case FL_OPTION_NUMBER: return fl_option_number(o->word, text, o->lo, o->hi, o->expected, at, err);
    case FL_OPTION_TIME: return fl_option_time(o->word, text, at, err);
    case FL_OPTION_CHOICE: return fl_option_choice(o->word, text, o->choice, at, err);
    case FL_OPTION_CALL: return o->call(options, text, err);
    case FL_OPTION_HELP: fl_options_help(t); break;
    case FL_OPTION_VERSION: fl_tool_version(t->program); break;
    }
    *(int *)at = 1;
    return 0;
}

static int read_operand(const fl_option_table *t, void *options, const char *text, fl_err *err)
{
    if (t->operand) return t->operand(options, text, err);
    return fl_fail(err, FL_USAGE, "\"%.60s\" is not expected, %s reads no file", text, t->program);
}

int fl_options_read(const fl_option_table *t, void *options, unsigned char *given, int argc, char **argv,
                    fl_err *err)
{
    const int n = count_options(t);
    getopt_form g;
    int c;
    if (n > OPTIONS_MAX) abort();
    convert_table(&g, t, n);
    opterr = 0;
    optind = 1;
    while ((c = getopt_long(argc, argv, g.letters, g.word, NULL)) != -1) {
        int row = 0;
        if (c == ':' || c == '?') return fail_option(t, c, optopt, argv[optind - 1], err);
        if (c == OPERAND) {
            if (read_operand(t, options, optarg, err)) return -1;
            continue;
        }
        while (g.word[row].val != c) row++;
        const fl_option *o = &t->option[row];
        if (given) given[row] = 1;
        if (store_option(t, o, options, optarg, err)) return -1;
        if (o->kind == FL_OPTION_HELP || o->kind == FL_OPTION_VERSION) return 0;
    }
    for (; optind < argc; optind++)
        if (read_operand(t, options, argv[optind], err)) return -1;
    return 0;
}
