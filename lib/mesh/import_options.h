/* SPDX-License-Identifier: GPL-3.0-or-later */
/* import_options.h -- what the user wants of a mesh file: which parts, and how curved faces are taken. */
#ifndef FL_MESH_IMPORT_OPTIONS_H
#define FL_MESH_IMPORT_OPTIONS_H
#include <stdint.h>
#include "base/string_table.h"

typedef struct {
    const char *const *pattern; /* [patterns] borrowed; any part that is like one of them is taken */
    int32_t patterns;           /* 0 takes every part */
    char *matched;              /* [patterns] out: was anything like it?  May be NULL */
    fl_string_table *available; /* out: names of parts and sets that could be chosen.  May be NULL */
    int subdivide;              /* quadratic faces become several triangles through their mid-side nodes */
} fl_import_options;

/* Is the name like the pattern?  "*" stands for any bytes, "?" for any one byte, all else for itself; letters
 * of either case are equal, as they are to the programs that write decks, and "_" stands for a blank too. */
int fl_pattern_matches(const char *pattern, const char *name);

/* Is name wanted?  1 or 0, or -1 with FL_SYSTEM; records hit and seen.  w NULL wants everything. */
int fl_import_selects(fl_import_options *opt, const char *name, fl_err *err);

/* Are parts chosen by name? */
static inline int fl_import_by_name(const fl_import_options *w) { return w && w->patterns > 0; }

#endif
