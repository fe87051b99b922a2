/* SPDX-License-Identifier: GPL-3.0-or-later */
/* part_names.h -- parts chosen and called by the user. */
#ifndef STRUCT_IMPORT_PART_NAMES_H
#define STRUCT_IMPORT_PART_NAMES_H
#include "mesh/import_options.h"
#include "options.h"

/* What is wished of the files: hit and seen of w are in the struct, which must not move. */
struct chosen {
    fl_import_options w;
    fl_string_table seen;
};

/* Start, with the patterns of the options.  -1 with FL_SYSTEM. */
int chosen_start(struct chosen *c, const struct options *o, fl_err *err);

/* After the last file: -1 with FL_INPUT when a pattern is like no part, naming those there are. */
int chosen_check(const struct chosen *c, fl_err *err);
void chosen_free(struct chosen *c); /* accepts a zeroed struct, leaves one */

/* Give the parts their new names: the first that is like one counts.  Parts that come to one name are joined
 * in the first of them.  -1 with FL_INPUT when nothing is like an old name, or FL_SYSTEM. */
int rename_all(const struct options *o, fl_surface *s, fl_err *err);

#endif
