/* SPDX-License-Identifier: GPL-3.0-or-later */
/* import_options.h -- what to take from a mesh file: which parts and sets, and how curved faces are divided.
 */
#ifndef FL_MESH_IMPORT_OPTIONS_H
#define FL_MESH_IMPORT_OPTIONS_H
#include <stdint.h>
#include "base/string_table.h"

typedef struct {
    const char *const *pattern;   /* [patterns] borrowed; a part whose name matches one of them is selected */
    int32_t patterns;             /* 0 selects every part */
    char *matched;                /* [patterns] out: 1 if a name matched; may be NULL */
    fl_string_table *available;   /* out: names that can be selected; may be NULL */
    struct fl_frame_model *frame; /* NULL, or what beams and trusses of a deck become (frame_model.h); its
                                   * reader then adds no parts */
    int has_unit;                 /* the user gave the unit of length: no hints about it */
    int subdivide;                /* split quadratic faces into triangles through their mid-side nodes */
} fl_import_options;

/* True if name matches the pattern.  "*" stands for any bytes, "?" for any one byte, all else for itself.
 * Case does not matter, as in the programs that write decks, and "_" stands for a blank too. */
int fl_pattern_matches(const char *pattern, const char *name);

/* True if the options select name.  Records it in matched and available.  opt NULL selects everything.
 * Returns 1 or 0, or -1 with FL_SYSTEM. */
int fl_import_selects(fl_import_options *opt, const char *name, fl_err *err);

/* True if parts are selected by name. */
static inline int fl_import_by_name(const fl_import_options *opt) { return opt && opt->patterns > 0; }

#endif
