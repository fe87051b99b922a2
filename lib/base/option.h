/* SPDX-License-Identifier: GPL-3.0-or-later */
/* option.h -- the command line of a program, read by a table with one row for each option.
 *
 * A row names the option, its argument and its line of --help, and says where its value goes: the parser
 * converts the value, checks its range, and stores it into the options of the program at the offset of the
 * row.  A function of the program converts what no kind covers.  --help and --version are answered here.
 *
 * To add an option: a member of struct options (options.h or settings.h) and a row. */
#ifndef FL_BASE_OPTION_H
#define FL_BASE_OPTION_H
#include <stddef.h>
#include <stdint.h>
#include "base/err.h"

enum fl_option_kind {
    FL_OPTION_FLAG,    /* int: set to 1; no argument.  0: a row without kind is a flag */
    FL_OPTION_TEXT,    /* const char *: the argument, borrowed from argv            */
    FL_OPTION_WORD,    /* const char *: the same, one word of up to 200 bytes       */
    FL_OPTION_FILE,    /* const char *: the same, a file name without blanks        */
    FL_OPTION_INTEGER, /* int32_t in [lo, hi]                                       */
    FL_OPTION_NUMBER,  /* double in [lo, hi]                                        */
    FL_OPTION_TIME,    /* double > 0 [s]: a number, or one with s, min, h, d or a   */
    FL_OPTION_CHOICE,  /* int: index into `choice`                                  */
    FL_OPTION_CALL,    /* converted by `call`                                       */
    FL_OPTION_HELP,    /* prints the help; sets the int at `at` to 1; parsing ends  */
    FL_OPTION_VERSION  /* the same for the version                                  */
};

/* Converts the argument of one option (NULL where it takes none) into the options of the program.
 * 0, or -1 with FL_USAGE, FL_INPUT or FL_SYSTEM. */
typedef int fl_option_call(void *options, const char *text, fl_err *err);

typedef struct {
    const char *word;     /* long name without "--"; NULL ends the table         */
    int letter;           /* short name, 0: none                                 */
    const char *argument; /* as --help shows it; NULL: the option takes none     */
    const char *help;     /* its text in --help; "\n" starts another line        */
    enum fl_option_kind kind;
    size_t at;                 /* offset of the value in the options of the program   */
    double lo, hi;             /* range of FL_OPTION_INTEGER and FL_OPTION_NUMBER     */
    const char *expected;      /* of FL_OPTION_NUMBER: "a length not below 0"         */
    const char *const *choice; /* of FL_OPTION_CHOICE, ends with NULL                 */
    fl_option_call *call;      /* of FL_OPTION_CALL                                   */
} fl_option;

typedef struct {
    const char *program, *usage; /* usage: the text of --help above the options          */
    const fl_option *option;
    /* operand: called for each argument that is no option; NULL: such an argument is an error.
     * in_order: called in the order of the line, else after all options. */
    fl_option_call *operand;
    int in_order;
} fl_option_table;

/* The options that every program has, and the row that ends the table: it must stand last.  FLAG is 0: a row
 * without kind is a flag.  T is the struct of options of the program, with the members out, gzip, threads,
 * quiet, verbose and ended; the texts say what they do in this program. */
#define FL_COMMON_OPTIONS(T, OUT, GZIP, THREADS, QUIET, VERBOSE)                                             \
    {.word = "output",                                                                                       \
     .letter = 'o',                                                                                          \
     .argument = "FILE",                                                                                     \
     .help = OUT,                                                                                            \
     .kind = FL_OPTION_TEXT,                                                                                 \
     .at = offsetof(T, out)},                                                                                \
        {.word = "gzip", .letter = 'z', .help = GZIP, .at = offsetof(T, gzip)},                              \
        {.word = "threads",                                                                                  \
         .letter = 'j',                                                                                      \
         .argument = "N",                                                                                    \
         .help = THREADS,                                                                                    \
         .kind = FL_OPTION_INTEGER,                                                                          \
         .at = offsetof(T, threads),                                                                         \
         .lo = 1,                                                                                            \
         .hi = 1024},                                                                                        \
        {.word = "quiet", .letter = 'q', .help = QUIET, .at = offsetof(T, quiet)},                           \
        {.word = "verbose", .letter = 'v', .help = VERBOSE, .at = offsetof(T, verbose)},                     \
        {.word = "help",                                                                                     \
         .letter = 'h',                                                                                      \
         .help = "this text",                                                                                \
         .kind = FL_OPTION_HELP,                                                                             \
         .at = offsetof(T, ended)},                                                                          \
        {.word = "version", .help = "the version", .kind = FL_OPTION_VERSION, .at = offsetof(T, ended)},     \
    {                                                                                                        \
        0                                                                                                    \
    }

/* Reads the command line into *options, which holds the defaults.
 *   given  NULL, or [rows of the table]: set to 1 for each option that was given
 * 0, or -1 with FL_USAGE (an unknown option, a value missing or out of range) or what a call returned. */
int fl_options_read(const fl_option_table *t, void *options, unsigned char *given, int argc, char **argv,
                    fl_err *err);

/* Row of an option in the table, by its long name.  The name must be there. */
int fl_option_row(const fl_option_table *t, const char *word);

/* Prints the text of --help to standard output: usage, then two columns of options and texts. */
void fl_options_help(const fl_option_table *t);

/* The conversions, for FL_OPTION_CALL.  Each returns 0, or -1 with FL_USAGE and a sentence that names it. */
int fl_option_integer(const char *word, const char *text, int32_t lo, int32_t hi, int32_t *x, fl_err *err);
int fl_option_number(const char *word, const char *text, double lo, double hi, const char *expected,
                     double *x, fl_err *err);
int fl_option_time(const char *word, const char *text, double *seconds, fl_err *err);
int fl_option_choice(const char *word, const char *text, const char *const *choice, int *k, fl_err *err);
int fl_option_word(const char *word, const char *text, const char **out, fl_err *err);
int fl_option_file(const char *word, const char *text, const char **out, fl_err *err);

/* From `least` to `most` numbers in [lo, hi], divided by the character `divide`; *n: their count. */
int fl_option_numbers(const char *word, const char *text, char divide, int least, int most, double lo,
                      double hi, const char *expected, double *x, int *n, fl_err *err);

/* Calls `call` for each entry of a list with commas; an empty entry is an error. */
int fl_option_each(const char *word, const char *text, fl_option_call *call, void *options, fl_err *err);

#endif
