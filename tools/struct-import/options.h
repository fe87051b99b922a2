/* SPDX-License-Identifier: GPL-3.0-or-later */
/* options.h -- the command line of struct-import. */
#ifndef STRUCT_IMPORT_OPTIONS_H
#define STRUCT_IMPORT_OPTIONS_H
#include <stdint.h>
#include "base/err.h"
#include "base/tool.h"
#include "geom/affine.h"
#include "geom/surface.h"

enum { TURNS = 16 };
enum item_kind { ITEM_FILE, ITEM_CYLINDER, ITEM_CONE, ITEM_BOX };
enum format { TO_G_STRUCT, TO_STL, TO_STL_BINARY, TO_OBJ, TO_OFF, TO_PLY, TO_VTP, FORMATS };

/* An item of the command line that becomes parts, in the given order. */
struct item {
    enum item_kind kind;
    const char *path, *name; /* borrowed; name is NULL if none was given */
    const char *text;        /* the numbers of a ready-made solid, as given */
    fl_cone cone;
    fl_aabb box;
};

/* Parts whose names match the pattern old are renamed. */
struct alias {
    char *old;
    const char *name, *text; /* borrowed */
};

struct options {
    struct item *item; /* [items]; standard input if none was given */
    int32_t items, item_cap;
    const char **part; /* [parts] borrowed patterns of selected parts; none selects all */
    int32_t parts, part_cap;
    struct alias *alias; /* [aliases] */
    int32_t aliases, alias_cap;
    const char *out, *unit;       /* borrowed; unit is NULL if unknown */
    const char *next_name;        /* of --name, for the next part; NULL: none */
    int to;                       /* enum format */
    int32_t facets;               /* per circle; 0 keeps round solids */
    int32_t fill_holes;           /* largest number of edges of a hole to close */
    double fill;                  /* [m] largest diagonal of the box of a hole to close */
    double simplify;              /* [m]; 0 for none */
    double remesh, remesh_within; /* [m] length of edges, 0 for none, and their largest deviation */
    int repair;
    const char *plot; /* borrowed; NULL for none */
    fl_affine map;    /* applied to files: --up, --mirror, --unit and --scale, --rotate, --translate */
    double factor;    /* of --scale alone */
    const char *rotate[TURNS]; /* [turns] borrowed, as given */
    int turns, mirror;         /* bits 0, 1, 2 of mirror: x, y, z */
    double weld;               /* [m]; < 0: automatic */
    int members;               /* write a model of members */
    int32_t pieces;            /* of a member */
    int symmetry;              /* bits 0, 1: mirrored halves in x = 0, y = 0 are added */
    double deck;               /* [m] by which rims are raised; 0 for none */
    int y_up, strict, raw, subdivide;
    int gzip, quiet, verbose, threads;
    int ended; /* --help or --version was answered */
};

/* Set defaults and parse the command line.  0, or -1 with FL_USAGE or FL_SYSTEM in err.  Free with
 * options_free(). */
int options_parse(struct options *o, int argc, char **argv, fl_err *err);
void options_free(struct options *o);

/* The history line: all options that affect the result; files by their base names. */
void options_by(const struct options *o, fl_history_line *by);

#endif
