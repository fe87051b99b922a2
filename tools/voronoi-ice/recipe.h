/* SPDX-License-Identifier: GPL-3.0-or-later */
/* recipe.h -- a recipe: all values that a field is made from, as the command line gives them. */
#ifndef VORONOI_ICE_RECIPE_H
#define VORONOI_ICE_RECIPE_H
#include <stdint.h>
#include "base/err.h"
#include "base/tool.h"
#include "geom/polygon.h"
#include "ice/sizes_law.h"
#include "scene/ice_field.h"
#include "generator.h"
#include "measure.h"

enum { KEEP_OUT_MAX = 16, LEAD_MAX = 16, RIDGE_MAX = 4, FLOES_MAX = 10000000 };

struct keep_out {
    int circle;     /* 0: a box */
    fl_vec2 lo, hi; /* corners of the box; lo is the centre of a circle [m] */
    double r;       /* of the circle [m] */
};

enum { GAPS_EVEN, GAPS_RANDOM };

struct recipe {
    const struct generator *generator;
    const char *generator_argument; /* NULL: none */
    int generator_given;            /* a generator without an argument was chosen */
    const char *out, *material;     /* borrowed from argv */
    const char *plot, *format;      /* folder of pictures, NULL: none; svg or png */
    const char *id;                 /* NULL: none */
    char id_made[20];               /* --id auto: computed from the field */
    const char *certificate;        /* file, NULL: none */
    fl_vec2 size, origin, velocity; /* origin is the corner of least x and y [m, m, m/s] */
    int32_t floes, smooth;
    double concentration;
    const char *thickness_law; /* a length, a law or a file, without unit */
    char thickness_text[MEASURE_LAW_LEN];
    double thickness, radius;          /* thickness of all floes, or the largest; dilation radius [m] */
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
    double margin; /* of open water around structures [m] */
    int graded;
    double grade_angle;         /* [degrees] */
    double grade[2];            /* concentration at the two ends, unless in a file */
    const char *grade_file;     /* NULL: none */
    int periodic[2];            /* along x, along y */
    double ridge[RIDGE_MAX][9]; /* x0 y0 x1 y1 hs ws hk wk wb [m] */
    int ridges;
    double block, porosity; /* of ridges: size of a block [m], 0 for the thickness */
    int32_t pancakes;       /* sides of round floes, 0: not round */
    int bonded;
    int32_t layers;
    double diameter; /* of the spheres of a lattice [m]; 0: from the thickness of the sheet */
    int rows_across; /* rows of the lattice along y */
    int32_t edges;   /* rows at the sides and behind that get the group edge */
    int endless;     /* whole periods along the drift, no rows behind, and the inflow in --scene */
    double flexural, compressive, young; /* of the sheet [Pa]; 0: not given */
    const char *scene;                   /* file for the bonds that give these, NULL: none */
    int gzip, quiet, verbose, threads, ended;
    int says_even;    /* --gaps even stands in the history, as the default is another */
    int gaps;         /* GAPS_EVEN, GAPS_RANDOM */
    double mean_size; /* --mean-size [m]; 0: none */
    int has_origin, has_floes, has_concentration, has_thickness; /* given on the command line */
    const char *sizes; /* full name of a law, or a file; NULL: areas of Voronoi cells */
    int sizes_file;    /* sizes is a file */
    char sizes_name[FL_SIZES_LAW_LEN];
    fl_sizes law; /* unless sizes is a file */
};

/* History line: all values that determine the field, with defaults, so that a version with other defaults can
 * make it again. */
void recipe_history(const struct recipe *o, fl_history_line *by);

/* The part of the history line that all generators of floes or blocks share: number, sizes, concentration,
 * thickness, radius, seed, smoothing. */
void recipe_history_floes(const struct recipe *o, fl_history_line *by);

/* Add "OPTION" and n numbers separated by `divide` to the history line, n at most 9. */
void recipe_history_numbers(fl_history_line *by, const char *option, char divide, int n, const double *x);

/* With --id auto, set the id to 16 hexadecimal digits computed from the field. */
void recipe_set_id(struct recipe *o, const fl_ice_field *field);

/* Check an option that is a law or the name of a file, where it is not a law.  Returns 0, or -1 with FL_INPUT
 * if there is no such file: it is more likely a misspelt law. */
int recipe_check_file(const char *option, const char *text, const char *expected, fl_err *err);

#endif
