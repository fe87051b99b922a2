/* SPDX-License-Identifier: GPL-3.0-or-later */
/* certificate_table.h -- the certificate as a table: what was asked, what was achieved, how far the two are apart. */
#ifndef VORONOI_ICE_CERTIFICATE_TABLE_H
#define VORONOI_ICE_CERTIFICATE_TABLE_H
#include <math.h>
#include "base/err.h"
#include "base/tool.h"

enum { CERTIFY_ROWS = 64 };

/* Columns for which there is nothing to say. */
#define NOT_ASKED NAN
#define NO_DISTANCE NAN

struct certify_row {
    char what[48];                    /* "area, smallest [m2]"                                  */
    double asked, achieved, distance; /* NAN: none                                              */
    int digits;                       /* of achieved on the terminal; the file has all of them  */
    char word[200];                   /* asked, where it is no number: "power:2,1,100,..."      */
    char note[160];                   /* behind it on the terminal, last in the file            */
};

struct certify {
    int n;
    struct certify_row row[CERTIFY_ROWS];
};

/* Add a row; note may be NULL, else it is a format.  More than CERTIFY_ROWS are a defect of the caller. */
void certify_add(struct certify *c, const char *what, double asked, double achieved, double distance,
                 int digits, const char *note, ...) __attribute__((format(printf, 7, 8)));

/* Add a row that asked for something that is no number; others tell how near to it the field has come. */
void certify_add_word(struct certify *c, const char *what, const char *asked, const char *note, ...)
    __attribute__((format(printf, 4, 5)));

/* The table, to standard error. */
void certify_print(const struct certify *c);

/* The same as a table of kind "certificate":
 *     quantity  unit  asked  achieved  distance  note
 * in which what[] gives quantity and unit, blanks are written "-" within a word and "-" stands for nothing.
 * Returns 0, or -1 with FL_SYSTEM. */
int certify_write(const struct certify *c, const char *path, const fl_history_line *by, fl_err *err);

#endif
