/* SPDX-License-Identifier: GPL-3.0-or-later */
/* options.h -- the command line of voronoi-ice. */
#ifndef VORONOI_ICE_OPTIONS_H
#define VORONOI_ICE_OPTIONS_H
#include <stdint.h>
#include "base/err.h"
#include "base/tool.h"
#include "geom/polygon.h"
#include "ice/sizes_law.h"
#include "scene/ice_field.h"

enum { KEEP_OUT_MAX = 16, LEAD_MAX = 16, RIDGE_MAX = 4, FLOES_MOST = 10000000 };

struct keep_out {
    int circle;     /* else a box */
    fl_vec2 lo, hi; /* corners of the box; lo is the centre of a circle [m] */
    double r;       /* of the circle [m] */
};

struct options {
    const char *out, *material;     /* borrowed from argv */
    const char *plot, *format;      /* a folder, NULL: no pictures; svg or png */
    const char *id;                 /* NULL: none */
    char id_made[20];               /* "auto", made of the field */
    const char *certificate;        /* NULL: none is written */
    fl_vec2 size, origin, velocity; /* origin is the corner of least x and y [m, m, m/s] */
    int32_t floes, smooth;
    double concentration;
    const char *thickness_law;         /* as given: a length, a law or a file */
    double thickness, radius;          /* the one of all floes, or the largest [m] */
    double ice_density, water_density; /* [kg/m3] */
    uint64_t seed;
    struct keep_out keep_out[KEEP_OUT_MAX];
    int keep_outs;
    const char *outline;      /* file, NULL: none */
    double disc[3];           /* outline: radius (0: none) and centre [m] */
    double lead[LEAD_MAX][5]; /* x0 y0 x1 y1 width [m] */
    int leads;
    const char *structure[KEEP_OUT_MAX]; /* files of --keep-out */
    int structures;
    double margin; /* round structures [m] */
    int graded;
    double grade_angle;     /* [degrees] */
    double grade[2];        /* concentration at the two ends, when not in a file */
    const char *grade_file; /* NULL: none */
    int periodic[2];        /* along x, along y */
    int rubble;
    double ridge[RIDGE_MAX][9]; /* x0 y0 x1 y1 hs ws hk wk wb [m] */
    int ridges;
    double block, porosity; /* of ridges: size of a block [m], 0 for the thickness */
    int32_t pancakes;       /* sides of round floes, 0: not round */
    int bonded;
    int lattice; /* -1, or an fl_packing_kind */
    int32_t layers;
    double diameter; /* of the spheres of a lattice [m] */
    int gzip, quiet, verbose, threads;
    int has_origin, has_floes, has_concentration;
    const char *sizes; /* the name of a law, with nothing left out, or a file; NULL: Voronoi */
    int sizes_file;    /* it is a file */
    char sizes_name[FL_SIZES_LAW_LEN];
    fl_sizes law;   /* unless in a file */
    uint64_t given; /* which long options there were, by their numbers */
    int ended;      /* --help or --version was answered */
};

/* Defaults, then the command line.  0, or -1 with FL_USAGE in err. */
int options_parse(struct options *o, int argc, char **argv, fl_err *err);

/* The history line: everything that bears on the field, defaults included, so that it can be made again by a
 * version with other defaults. */
void options_by(const struct options *o, fl_history_line *by);

/* With --id auto the id becomes a number of the field: 16 hexadecimal digits, others for another field. */
void options_id(struct options *o, const fl_ice_field *field);

/* Of an option that is a law or the name of a file, where it is no law: -1 with FL_INPUT where there is no
 * such file, which is then more likely a law that is misspelt. */
int options_there(const char *option, const char *text, const char *wanted, fl_err *err);

#endif
