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

/* One thing of the command line that becomes parts, in the order given. */
struct item {
    enum item_kind kind;
    const char *path, *name; /* borrowed; name is NULL when none was given */
    const char *text;        /* the numbers of a ready-made one, as given */
    fl_cone cone;
    fl_aabb box;
};

/* What is like the pattern old becomes name. */
struct alias {
    char *old;
    const char *name, *text; /* borrowed */
};

struct options {
    struct item *item; /* [items]; standard input when none was given */
    int32_t items, item_cap;
    const char **part; /* [parts] borrowed patterns of the parts that are taken; none takes all */
    int32_t parts, part_cap;
    struct alias *alias; /* [aliases] */
    int32_t aliases, alias_cap;
    const char *out, *unit;       /* borrowed; unit is NULL when unknown */
    const char *next_name;        /* of --name, for the part that comes next; NULL: none */
    int to;                       /* enum format */
    int32_t facets;               /* 0: round solids stay what they are */
    int32_t fill_holes;           /* rims of up to this many edges are closed */
    double fill;                  /* and those whose box has a diagonal of up to this [m] */
    double simplify;              /* [m]; 0 for none */
    double remesh, remesh_within; /* length of edges, 0 for none, and how far they may stray [m] */
    int repair;
    const char *plot; /* borrowed; NULL for none */
    fl_affine map;    /* of what files hold: --up, --mirror, --unit and --scale, --rotate, --translate */
    double factor;    /* --scale alone, 1 when not given */
    const char *rotate[TURNS]; /* [turns] borrowed, as given */
    int turns, mirror;         /* bits 0, 1, 2 of mirror: x, y, z */
    double weld;               /* [m]; < 0: automatic */
    int y_up, strict, raw, subdivide;
    int gzip, quiet, verbose, threads;
    int ended; /* --help or --version was answered */
};

/* Defaults, then the command line.  0, or -1 with FL_USAGE or FL_SYSTEM in err.  Free with options_free(). */
int options_parse(struct options *o, int argc, char **argv, fl_err *err);
void options_free(struct options *o);

/* The history line: what bears on the result; files by their base names. */
void options_by(const struct options *o, fl_history_line *by);

#endif
