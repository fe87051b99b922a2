/* SPDX-License-Identifier: GPL-3.0-or-later */
/* certificate_table.h -- certificate of a field: requested values, achieved values and their distance. */
#ifndef VORONOI_ICE_CERTIFICATE_TABLE_H
#define VORONOI_ICE_CERTIFICATE_TABLE_H
#include <math.h>
#include "base/err.h"
#include "base/tool.h"

enum { CERTIFICATE_ROWS = 64 };

/* Empty columns. */
#define NOT_REQUESTED NAN
#define NO_DISTANCE NAN

struct certificate_row {
    char quantity[48];                    /* "area, smallest [m2]" */
    double requested, achieved, distance; /* NAN: none */
    int digits;                           /* of achieved on the terminal; the file has all of them */
    char text[200];                       /* requested, if it is no number: "power:2,1,100,..." */
    char note[160];                       /* last column */
};

struct certificate_table {
    int n;
    struct certificate_row row[CERTIFICATE_ROWS];
};

/* Append a row; note is a format, or NULL.  The caller adds at most CERTIFICATE_ROWS rows. */
void certificate_add(struct certificate_table *c, const char *quantity, double requested, double achieved,
                     double distance, int digits, const char *note, ...)
    __attribute__((format(printf, 7, 8)));

/* Append a row with a request that is no number; other rows give its distance. */
void certificate_add_text(struct certificate_table *c, const char *quantity, const char *requested,
                          const char *note, ...) __attribute__((format(printf, 4, 5)));

/* Print the table to standard error. */
void certificate_print(const struct certificate_table *c);

/* Write a table of kind "certificate":
 *     quantity  unit  asked  achieved  distance  note
 * quantity and unit come from quantity[].  A blank within a word is written "-", an empty field as well.
 * Returns 0, or -1 with FL_SYSTEM. */
int certificate_write(const struct certificate_table *c, const char *path, const fl_history_line *by,
                      fl_err *err);

#endif
