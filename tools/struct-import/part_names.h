/* SPDX-License-Identifier: GPL-3.0-or-later */
/* part_names.h -- selection and renaming of parts. */
#ifndef STRUCT_IMPORT_PART_NAMES_H
#define STRUCT_IMPORT_PART_NAMES_H
#include "mesh/import_options.h"
#include "options.h"

/* The import options of a run; their members matched and available point into the struct, which must not
 * move. */
struct selection {
    fl_import_options opt;
    fl_string_table available;
};

/* Initialise with the patterns of the options.  -1 with FL_SYSTEM. */
int selection_start(struct selection *c, const struct options *o, fl_err *err);

/* After the last file: -1 with FL_INPUT if a pattern matches no part; the message lists the parts. */
int selection_check(const struct selection *c, fl_err *err);
void selection_free(struct selection *c); /* accepts a zeroed struct, leaves one */

/* Rename the parts; the first matching pattern counts.  Parts that get the same name are joined in the first
 * of them.  -1 with FL_INPUT if a pattern matches no part, or FL_SYSTEM. */
int rename_all(const struct options *o, fl_surface *s, fl_err *err);

#endif
