/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "options.h"
#include <math.h>
#include <string.h>
#include "base/number_text.h"
#include "base/option.h"
#include "base/tool.h"
#include "ice/pancakes.h"
#include "generator_table.h"
#include "measure.h"

static const char USAGE[] =
    "usage: voronoi-ice [options]\n"
    "A field of ice floes of a given concentration, none of which overlaps another, to a g-polys file.\n"
    "Lengths are in metres, or have a unit behind them: \"160x80 m\", \"40 cm\", \"0.7,0 kn\".  The "
    "certificate\n"
    "goes to standard error.\n"
    "\n";

/* Largest coordinate of a shape, as FL_ICE_FIELD_MAX_COORD, which holds projected ones (UTM); longest field,
 * where an ulp is a tenth of a nanometre; shortest length [m]. */
#define FAR 1e9
#define LONGEST 1e6
#define SHORTEST 1e-6

/* Exactly n lengths, separated by ','; expected describes them for the message. */
static int parse_lengths(const char *option, const char *text, int n, double lo, double hi, double *x,
                         const char *expected, fl_err *err)
{
    return measure_read(option, text, ',', n, FL_UNIT_LENGTH, lo, hi, expected, x, err);
}

static int parse_pair(const char *option, const char *text, char divide, enum fl_unit_kind kind, double lo,
                      double hi, fl_vec2 *out, const char *expected, fl_err *err)
{
    double x[2] = {0.0, 0.0};
    if (measure_read(option, text, divide, 2, kind, lo, hi, expected, x, err)) return -1;
    *out = (fl_vec2){x[0], x[1]};
    return 0;
}

static int parse_sizes(void *options, const char *text, fl_err *err)
{
    struct recipe *const o = options;
    o->sizes = NULL;
    o->sizes_file = 0;
    if (strcmp(text, "uniform") == 0) return 0;
    o->sizes_file = !fl_sizes_is_law(text);
    if (!o->sizes_file && fl_sizes_parse(&o->law, o->sizes_name, text, err)) return -1;
    if (o->sizes_file && (text[0] == '\0' || strlen(text) > 1000 || strpbrk(text, " \t\r\n\f\v")))
        return fl_fail(err, FL_USAGE,
                       "--sizes is \"%.60s\", expected a law or the name of a file without blanks", text);
    o->sizes = o->sizes_file ? text : o->sizes_name;
    return 0;
}

static int parse_keep_out(void *options, const char *text, fl_err *err)
{
    struct recipe *const o = options;
    static const char expected[] = "circle:X,Y,R or box:X0,Y0,X1,Y1 in metres";
    const size_t word = strcspn(text, ":/");
    struct keep_out k = {0};
    double x[4] = {0};
    if (text[word] != ':') { /* "a/b:c" is a file */
        if (o->structures == KEEP_OUT_MAX)
            return fl_fail(err, FL_USAGE, "more than %d files to keep out", KEEP_OUT_MAX);
        if (fl_option_file("keep-out", text, &o->structure[o->structures], err)) return -1;
        o->structures++;
        return 0;
    }
    if (o->keep_outs == KEEP_OUT_MAX)
        return fl_fail(err, FL_USAGE, "more than %d shapes to keep out", KEEP_OUT_MAX);
    if (strncmp(text, "circle:", 7) == 0) {
        if (parse_lengths("keep-out", text + 7, 3, -FAR, FAR, x, expected, err)) return -1;
        k = (struct keep_out){.circle = 1, .lo = {x[0], x[1]}, .r = x[2]};
        if (k.r <= 0.0) return fl_fail(err, FL_USAGE, "--keep-out is \"%.60s\", expected R above 0", text);
    } else if (strncmp(text, "box:", 4) == 0) {
        if (parse_lengths("keep-out", text + 4, 4, -FAR, FAR, x, expected, err)) return -1;
        k = (struct keep_out){.lo = {x[0], x[1]}, .hi = {x[2], x[3]}};
        if (!(x[0] < x[2] && x[1] < x[3]))
            return fl_fail(err, FL_USAGE, "--keep-out is \"%.60s\", expected X0 < X1 and Y0 < Y1", text);
    } else {
        return fl_fail(err, FL_USAGE, "--keep-out is \"%.60s\", expected %s", text, expected);
    }
    o->keep_out[o->keep_outs++] = k;
    return 0;
}

static int parse_outline(void *options, const char *text, fl_err *err)
{
    struct recipe *const o = options;
    static const char expected[] = "the name of a file, or disc:R or disc:R,X,Y in metres";
    const int centred = strncmp(text, "disc:", 5) == 0 && !strchr(text, ',');
    o->outline = NULL;
    o->disc[0] = o->disc[1] = o->disc[2] = 0.0;
    if (strncmp(text, "disc:", 5) != 0) return fl_option_file("outline", text, &o->outline, err);
    if (parse_lengths("outline", text + 5, centred ? 1 : 3, -FAR, FAR, o->disc, expected, err)) return -1;
    if (o->disc[0] >= SHORTEST && o->disc[0] <= LONGEST) return 0;
    return fl_fail(err, FL_USAGE, "--outline is \"%.60s\", expected R from %g to %g", text, SHORTEST,
                   LONGEST);
}

static int parse_lead(void *options, const char *text, fl_err *err)
{
    struct recipe *const o = options;
    double *x = o->lead[o->leads];
    if (o->leads == LEAD_MAX) return fl_fail(err, FL_USAGE, "--lead is given more than %d times", LEAD_MAX);
    if (parse_lengths("lead", text, 5, -FAR, FAR, x, "X0,Y0,X1,Y1,WIDTH in metres", err)) return -1;
    if (!(x[4] >= SHORTEST && fabs(x[2] - x[0]) + fabs(x[3] - x[1]) >= SHORTEST))
        return fl_fail(err, FL_USAGE, "--lead is \"%.60s\", expected a length and a width of %g at least",
                       text, SHORTEST);
    o->leads++;
    return 0;
}

/* "80%", "8/10" and "0.8" are equal. */
static int parse_concentration(const char *option, const char *text, double *out, fl_err *err)
{
    char word[64];
    const size_t len = strlen(text);
    double part = 1.0;
    if (len < sizeof word) {
        memcpy(word, text, len + 1);
        if (len > 1 && word[len - 1] == '%') {
            word[len - 1] = '\0';
            part = 100.0;
        } else if (len > 3 && strcmp(word + len - 3, "/10") == 0) {
            word[len - 3] = '\0';
            part = 10.0;
        }
        /* 0 and 1 are no concentrations of floes with water between them */
        if (fl_number_f64(word, out) == 0 && *out / part > 0.0 && *out / part < 1.0) {
            *out /= part;
            return 0;
        }
    }
    return fl_fail(err, FL_USAGE,
                   "--%s is \"%.60s\", expected a number between 0 and 1, as 0.8, 80%% or 8/10", option,
                   text);
}

/* DIR:C0,C1 or DIR:FILE. */
static int parse_grade(void *options, const char *text, fl_err *err)
{
    struct recipe *const o = options;
    char word[64];
    const char *rest = strchr(text, ':'), *second;
    const size_t len = rest ? (size_t)(rest - text) : 0;
    if (len == 0 || len >= sizeof word) goto bad;
    memcpy(word, text, len);
    word[len] = '\0';
    if (strcmp(word, "x") == 0) o->grade_angle = 0.0;
    else if (strcmp(word, "y") == 0) o->grade_angle = 90.0;
    else if (fl_number_f64(word, &o->grade_angle) || fabs(o->grade_angle) > 360.0) goto bad;
    o->graded = 1;
    o->grade_file = NULL;
    rest++;
    second = strchr(rest, ',');
    if (!second) return fl_option_file("grade", rest, &o->grade_file, err);
    if ((size_t)(second - rest) >= sizeof word) goto bad;
    memcpy(word, rest, (size_t)(second - rest));
    word[second - rest] = '\0';
    return parse_concentration("grade", word, &o->grade[0], err) ||
                   parse_concentration("grade", second + 1, &o->grade[1], err)
               ? -1
               : 0;
bad:
    return fl_fail(err, FL_USAGE,
                   "--grade is \"%.60s\", expected DIR:C0,C1 or DIR:FILE with DIR x, y or degrees", text);
}

static int parse_periodic(void *options, const char *text, fl_err *err)
{
    int *const out = ((struct recipe *)options)->periodic;
    out[0] = strcmp(text, "x") == 0 || strcmp(text, "xy") == 0;
    out[1] = strcmp(text, "y") == 0 || strcmp(text, "xy") == 0;
    if (out[0] || out[1]) return 0;
    return fl_fail(err, FL_USAGE, "--periodic is \"%.60s\", expected x, y or xy", text);
}

static int parse_ridge(void *options, const char *text, fl_err *err)
{
    struct recipe *const o = options;
    static const char expected[] = "X0,Y0,X1,Y1,HS,WS,HK,WK,WB in metres";
    double *x = o->ridge[o->ridges];
    if (o->ridges == RIDGE_MAX)
        return fl_fail(err, FL_USAGE, "--ridge is given more than %d times", RIDGE_MAX);
    if (parse_lengths("ridge", text, 9, -FAR, FAR, x, expected, err)) return -1;
    for (int k = 4; k < 8; k++)
        if (!(x[k] >= SHORTEST && x[k] <= LONGEST))
            return fl_fail(err, FL_USAGE, "--ridge is \"%.60s\", expected heights and widths above 0", text);
    if (!(fabs(x[2] - x[0]) + fabs(x[3] - x[1]) >= SHORTEST) || !(x[8] >= 0.0 && x[8] <= x[7]))
        return fl_fail(err, FL_USAGE, "--ridge is \"%.60s\", expected a length and a WB from 0 to WK", text);
    o->ridges++;
    return 0;
}

/* --- one function for each option that has a form of its own ------------------------------------ */

static int set_size(void *options, const char *text, fl_err *err)
{
    return parse_pair("size", text, 'x', FL_UNIT_LENGTH, SHORTEST, LONGEST, &((struct recipe *)options)->size,
                      "AxB in metres, as 50x50", err);
}

static int set_origin(void *options, const char *text, fl_err *err)
{
    return parse_pair("origin", text, ',', FL_UNIT_LENGTH, -FAR, FAR, &((struct recipe *)options)->origin,
                      "X,Y in metres, each up to 1e9", err);
}

static int set_velocity(void *options, const char *text, fl_err *err)
{
    return parse_pair("velocity", text, ',', FL_UNIT_SPEED, -1e3, 1e3, &((struct recipe *)options)->velocity,
                      "VX,VY in m/s", err);
}

static int set_concentration(void *options, const char *text, fl_err *err)
{
    return parse_concentration("concentration", text, &((struct recipe *)options)->concentration, err);
}

static int set_porosity(void *options, const char *text, fl_err *err)
{
    return parse_concentration("porosity", text, &((struct recipe *)options)->porosity, err);
}

static int set_seed(void *options, const char *text, fl_err *err)
{
    if (fl_number_u64(text, &((struct recipe *)options)->seed) == 0) return 0;
    return fl_fail(err, FL_USAGE, "--seed is \"%.60s\", expected a whole number from 0 to 2^64 - 1", text);
}

static int parse_stress(const char *option, const char *text, double *x, fl_err *err)
{
    return measure_read(option, text, ',', 1, FL_UNIT_STRESS, 1e-300, 1e300, "a stress above 0 in Pa", x,
                        err);
}

static int set_mean_size(void *options, const char *text, fl_err *err)
{
    return parse_lengths("mean-size", text, 1, SHORTEST, LONGEST, &((struct recipe *)options)->mean_size,
                         "a length in metres", err);
}

static int set_radius(void *options, const char *text, fl_err *err)
{
    return parse_lengths("radius", text, 1, 0.0, LONGEST, &((struct recipe *)options)->radius,
                         "a length not below 0 in metres", err);
}

static int set_margin(void *options, const char *text, fl_err *err)
{
    return parse_lengths("margin", text, 1, 0.0, LONGEST, &((struct recipe *)options)->margin,
                         "a length not below 0 in metres", err);
}

static int set_block(void *options, const char *text, fl_err *err)
{
    return parse_lengths("block", text, 1, SHORTEST, LONGEST, &((struct recipe *)options)->block,
                         "a length in metres", err);
}

static int set_diameter(void *options, const char *text, fl_err *err)
{
    return parse_lengths("diameter", text, 1, SHORTEST, LONGEST, &((struct recipe *)options)->diameter,
                         "a length in metres", err);
}

static int parse_density(const char *option, const char *text, double *x, fl_err *err)
{
    return measure_read(option, text, ',', 1, FL_UNIT_DENSITY, 1.0, 1e5, "a density in kg/m3", x, err);
}

static int set_ice_density(void *options, const char *text, fl_err *err)
{
    return parse_density("ice-density", text, &((struct recipe *)options)->ice_density, err);
}

static int set_water_density(void *options, const char *text, fl_err *err)
{
    return parse_density("water-density", text, &((struct recipe *)options)->water_density, err);
}

/* A law with a unit is kept in metres, as the history has it. */
static int set_thickness(void *options, const char *text, fl_err *err)
{
    struct recipe *const o = options;
    o->thickness_law = o->thickness_text;
    if (measure_law(text, o->thickness_text) == 0) return 0;
    if (strpbrk(text, " \t"))
        return fl_fail(
            err, FL_USAGE,
            "--thickness is \"%.60s\", expected a length, as 0.4 or \"40 cm\", a law or the name of a file",
            text);
    return fl_option_file("thickness", text, &o->thickness_law, err);
}

static int set_gaps(void *options, const char *text, fl_err *err)
{
    int *const gaps = &((struct recipe *)options)->gaps;
    *gaps = strcmp(text, "random") == 0 ? GAPS_RANDOM : GAPS_EVEN;
    if (*gaps == GAPS_RANDOM || strcmp(text, "even") == 0) return 0;
    return fl_fail(err, FL_USAGE, "--gaps is \"%.60s\", expected even or random", text);
}

static int set_flexural(void *options, const char *text, fl_err *err)
{
    return parse_stress("flexural", text, &((struct recipe *)options)->flexural, err);
}

static int set_compressive(void *options, const char *text, fl_err *err)
{
    return parse_stress("compressive", text, &((struct recipe *)options)->compressive, err);
}

static int set_young(void *options, const char *text, fl_err *err)
{
    return parse_stress("young", text, &((struct recipe *)options)->young, err);
}

static int set_rows(void *options, const char *text, fl_err *err)
{
    static const char *const WAYS[] = {"along", "across", NULL};
    return fl_option_choice("rows", text, WAYS, &((struct recipe *)options)->rows_across, err);
}

static int set_format(void *options, const char *text, fl_err *err)
{
    static const char *const FORMATS[] = {"svg", "png", NULL};
    int k;
    if (fl_option_choice("format", text, FORMATS, &k, err)) return -1;
    ((struct recipe *)options)->format = FORMATS[k];
    return 0;
}

/* --- the table --------------------------------------------------------------------------------- */

#define AT(member) offsetof(struct recipe, member)

/* The options of all generators; those that select one of them are put before the output options. */
static const fl_option FIELD_OPTION[] = {
    {.word = "size",
     .argument = "AxB",
     .help = "sides of the field along x and y (50x50)",
     .kind = FL_OPTION_CALL,
     .call = set_size},
    {.word = "origin",
     .argument = "X,Y",
     .help = "its corner of least x and y (such that the field is centred on 0,0)",
     .kind = FL_OPTION_CALL,
     .call = set_origin},
    {.word = "floes",
     .argument = "N",
     .help = "number of floes (200)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(floes),
     .lo = 1,
     .hi = FLOES_MAX},
    {.word = "mean-size",
     .argument = "L",
     .help = "in place of --floes: root of the mean area of the floes, as \"14 m\"",
     .kind = FL_OPTION_CALL,
     .call = set_mean_size},
    {.word = "sizes",
     .argument = "LAW",
     .help = "uniform (Voronoi cells), equal, lognormal:CV or weibull:K of areas,\n"
             "power:EXP,DMIN,DMAX[,number|area,cumulative|density] of diameters, or a FILE\n"
             "of sizes or of polygons (uniform)",
     .kind = FL_OPTION_CALL,
     .call = parse_sizes},
    {.word = "concentration",
     .argument = "C",
     .help = "fraction of the field that floes cover, between 0 and 1 (0.8)",
     .kind = FL_OPTION_CALL,
     .call = set_concentration},
    {.word = "thickness",
     .argument = "H",
     .help = "of the ice (0.5); uniform:A,B, lognormal:MEAN,CV or a file of thicknesses",
     .kind = FL_OPTION_CALL,
     .call = set_thickness},
    {.word = "radius",
     .argument = "R",
     .help = "dilation radius, the roundness of edges, below H/2 (0.05)",
     .kind = FL_OPTION_CALL,
     .call = set_radius},
    {.word = "seed",
     .argument = "N",
     .help = "seed of the random numbers (1)",
     .kind = FL_OPTION_CALL,
     .call = set_seed},
    {.word = "smooth",
     .argument = "N",
     .help = "steps of Lloyd's smoothing; 0 leaves Poisson-Voronoi cells (2)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(smooth),
     .lo = 0,
     .hi = 10000},
    {.word = "gaps",
     .argument = "HOW",
     .help = "even, or random: floes touch here and there (random below 0.9)",
     .kind = FL_OPTION_CALL,
     .call = set_gaps},
    {.word = "material",
     .argument = "NAME",
     .help = "material of the floes (ice)",
     .kind = FL_OPTION_WORD,
     .at = AT(material)},
    {.word = "ice-density",
     .argument = "RHO",
     .help = "kg/m3, sets the draft together with the next (900)",
     .kind = FL_OPTION_CALL,
     .call = set_ice_density},
    {.word = "water-density",
     .argument = "RHO",
     .help = "kg/m3 (1025)",
     .kind = FL_OPTION_CALL,
     .call = set_water_density},
    {.word = "velocity",
     .argument = "VX,VY",
     .help = "of all floes at the start, m/s (0,0)",
     .kind = FL_OPTION_CALL,
     .call = set_velocity},
    {.word = "keep-out",
     .argument = "SHAPE",
     .help = "remove floes that meet circle:X,Y,R or box:X0,Y0,X1,Y1; may be given 16 times\n"
             "or files as in g_struct(5): their waterline, with the margin, is cut out",
     .kind = FL_OPTION_CALL,
     .call = parse_keep_out},
    {.word = "margin",
     .argument = "M",
     .help = "open water round the structures of --keep-out (0)",
     .kind = FL_OPTION_CALL,
     .call = set_margin},
    {.word = "outline",
     .argument = "SHAPE",
     .help = "of the field instead of a rectangle: disc:R, disc:R,X,Y or a file of corners",
     .kind = FL_OPTION_CALL,
     .call = parse_outline},
    {.word = "lead",
     .argument = "X0,Y0,X1,Y1,WIDTH",
     .help = "a strip of open water; may be given 16 times",
     .kind = FL_OPTION_CALL,
     .call = parse_lead},
    {.word = "grade",
     .argument = "DIR:C0,C1",
     .help = "concentration rising from C0 to C1 along DIR: x, y or degrees; or DIR:FILE",
     .kind = FL_OPTION_CALL,
     .call = parse_grade},
    {.word = "periodic",
     .argument = "x|y|xy",
     .help = "periodic field: its copies fit side by side without a seam",
     .kind = FL_OPTION_CALL,
     .call = parse_periodic},
    {.word = "pancakes",
     .argument = "SIDES",
     .help = "floes round in plan, of that many sides",
     .kind = FL_OPTION_INTEGER,
     .at = AT(pancakes),
     .lo = FL_PANCAKES_MIN_SIDES,
     .hi = FL_PANCAKES_MAX_SIDES},
    {.word = "ridge",
     .argument = "X0,Y0,X1,Y1,HS,WS,HK,WK,WB",
     .help = "a ridge along that line, of blocks: height and width of its\n"
             "sail, depth and width of its keel and that at its bottom; up to 4 times",
     .kind = FL_OPTION_CALL,
     .call = parse_ridge},
    {.word = "block",
     .argument = "L",
     .help = "size of the blocks of ridges (the thickness)",
     .kind = FL_OPTION_CALL,
     .call = set_block},
    {.word = "porosity",
     .argument = "P",
     .help = "fraction of ridges without ice (0.3)",
     .kind = FL_OPTION_CALL,
     .call = set_porosity},
    {.word = "bonded",
     .help = "no gaps, and a bond candidate for every face that two bodies share",
     .at = AT(bonded)},
};

static const fl_option OUTPUT_OPTION[] = {
    {.word = "layers",
     .argument = "N",
     .help = "layers of the lattice, or of rafted floes (1)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(layers),
     .lo = 1,
     .hi = 1000},
    {.word = "diameter",
     .argument = "D",
     .help = "of the spheres of the lattice (0.25, or from --thickness)",
     .kind = FL_OPTION_CALL,
     .call = set_diameter},
    {.word = "rows",
     .argument = "WAY",
     .help = "of the lattice, along or across x (along)",
     .kind = FL_OPTION_CALL,
     .call = set_rows},
    {.word = "edges",
     .argument = "N",
     .help = "rows of spheres at the sides and behind that get the group edge (0)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(edges),
     .lo = 0,
     .hi = 1000},
    {.word = "endless",
     .help = "a lattice that its copies continue: whole periods along the drift; --scene gets the inflow",
     .at = AT(endless)},
    {.word = "flexural",
     .argument = "S",
     .help = "strength in bending of a bonded sheet, as 0.7MPa: sets the bonds of --scene",
     .kind = FL_OPTION_CALL,
     .call = set_flexural},
    {.word = "compressive",
     .argument = "S",
     .help = "or its strength in compression in the plane",
     .kind = FL_OPTION_CALL,
     .call = set_compressive},
    {.word = "young",
     .argument = "E",
     .help = "its modulus in bending, as 1GPa",
     .kind = FL_OPTION_CALL,
     .call = set_young},
    {.word = "scene",
     .argument = "FILE",
     .help = "sections of a scene for the sheet: slab, densities, bonds, contacts",
     .kind = FL_OPTION_TEXT,
     .at = AT(scene)},
    {.word = "certificate",
     .argument = "FILE",
     .help = "requested and achieved values as a table, - is standard output",
     .kind = FL_OPTION_TEXT,
     .at = AT(certificate)},
    {.word = "id",
     .argument = "NAME",
     .help = "name of the field in its history line; auto computes it from the bodies",
     .kind = FL_OPTION_WORD,
     .at = AT(id)},
    {.word = "plot",
     .argument = "DIR",
     .help = "pictures of the field and of its sizes, by gnuplot, into the folder",
     .kind = FL_OPTION_TEXT,
     .at = AT(plot)},
    {.word = "format",
     .argument = "FORMAT",
     .help = "of the pictures, svg or png (svg)",
     .kind = FL_OPTION_CALL,
     .call = set_format},
    FL_COMMON_OPTIONS(struct recipe, "write there, - is standard output", "compress the file",
                      "threads (one per processor)", "no certificate", "print the stages of the work"),
};

enum {
    FIELD_OPTIONS = sizeof FIELD_OPTION / sizeof *FIELD_OPTION,
    OUTPUT_OPTIONS = sizeof OUTPUT_OPTION / sizeof *OUTPUT_OPTION,
    GENERATORS_MAX = 20
};

/* What was given on the command line, by the rows of a table. */
struct command_line {
    fl_option option[FIELD_OPTIONS + GENERATORS_MAX + OUTPUT_OPTIONS];
    fl_option_table table;
    unsigned char given[FIELD_OPTIONS + GENERATORS_MAX + OUTPUT_OPTIONS];
};

/* The option of each generator with a name: it stores the argument, or that it was given. */
static void list_options(struct command_line *c)
{
    int n = FIELD_OPTIONS;
    *c = (struct command_line){.table = {"voronoi-ice", USAGE, NULL, NULL, 0}};
    memcpy(c->option, FIELD_OPTION, sizeof FIELD_OPTION);
    for (int k = 0; k < generator_count && k < GENERATORS_MAX; k++) {
        const struct generator *g = &generator_table[k];
        if (!g->name) continue;
        c->option[n++] = (fl_option){.word = g->name,
                                     .argument = g->argument,
                                     .help = g->help,
                                     .kind = g->argument ? FL_OPTION_TEXT : FL_OPTION_FLAG,
                                     .at = g->argument ? AT(generator_argument) : AT(generator_given)};
    }
    memcpy(c->option + n, OUTPUT_OPTION, sizeof OUTPUT_OPTION);
    c->table.option = c->option;
}

/* --- checks between options ----------------------------------------------------------------------------- */

static int is_given(const struct command_line *c, const char *option)
{
    return c->given[fl_option_row(&c->table, option)];
}

/* Reject the options, which have no effect as `why` says; the list ends with NULL. */
static int reject_options(const struct command_line *c, const char *why, const char *const *rejected,
                          fl_err *err)
{
    for (; *rejected; rejected++)
        if (is_given(c, *rejected)) return fl_fail(err, FL_USAGE, "--%s has no effect %s", *rejected, why);
    return 0;
}

/* Select the generator that was given first in the table, and reject options that it does not read. */
static int select_generator(struct recipe *o, const struct command_line *c, fl_err *err)
{
    int row = 0;
    while (row < generator_count - 1 && !is_given(c, generator_table[row].name)) row++;
    const struct generator *const g = o->generator = &generator_table[row];
    if (g->name && g->check && g->check(o->generator_argument, err)) return -1;
    for (int k = 0; c->option[k].word; k++) {
        const char *word = c->option[k].word;
        if (!c->given[k] || c->option[k].letter || (g->name && strcmp(word, g->name) == 0)) continue;
        if (generator_reads(g, word)) continue;
        if (g->name) return fl_fail(err, FL_USAGE, "--%s has no effect beside --%s", word, g->name);
        for (int j = 0; j < generator_count; j++)
            if (generator_reads(&generator_table[j], word))
                return fl_fail(err, FL_USAGE, "--%s has no effect without --%s", word,
                               generator_table[j].name);
    }
    return 0;
}

/* Floes are cut round structures, but those of periodic fields removed whole. */
static int cuts_structures(const struct recipe *o)
{
    return o->structures && !o->periodic[0] && !o->periodic[1];
}

static int check_water(const struct recipe *o, const struct command_line *c, fl_err *err)
{
    static const char *const without[] = {"size", "origin", "gaps", NULL}, *const within[] = {"margin", NULL};
    static const char *const whole[] = {"gaps", NULL};
    if (o->outline || o->disc[0] > 0.0) {
        if (reject_options(c, "beside --outline", without, err)) return -1;
        if (o->outline && strcmp(o->outline, "-") == 0)
            return fl_fail(err, FL_USAGE,
                           "--outline is \"-\", expected a file: a pipe cannot be named again");
    }
    if (!o->structures) return reject_options(c, "without the file of a structure", within, err);
    return cuts_structures(o) ? reject_options(c, "beside --keep-out of a file", whole, err) : 0;
}

static int check_graded(const struct recipe *o, const struct command_line *c, fl_err *err)
{
    static const char *const without[] = {"concentration", "sizes", "bonded", NULL}, *const none[] = {
                                                                                         "sizes", "bonded",
                                                                                         "outline", "lead",
                                                                                         NULL};
    static const char *const round[] = {"sizes", "bonded", "grade", NULL};
    if (o->pancakes && reject_options(c, "beside --pancakes", round, err)) return -1;
    if (o->graded && reject_options(c, "beside --grade", without, err)) return -1;
    if (!o->periodic[0] && !o->periodic[1]) return 0;
    return reject_options(c, "beside --periodic", none, err);
}

static int check_ridges(const struct recipe *o, const struct command_line *c, fl_err *err)
{
    static const char *const with_ridge[] = {"sizes", "periodic", NULL}, *const without_ridge[] = {
                                                                             "block", "porosity", NULL};
    if (!o->ridges) return reject_options(c, "without --ridge", without_ridge, err);
    return reject_options(c, "beside --ridge", with_ridge, err);
}

/* Layers of floes; those of a lattice have no such limits. */
static int check_layers(const struct recipe *o, const struct command_line *c, fl_err *err)
{
    static const char *const with_layers[] = {"sizes", "bonded", "ridge", NULL};
    if (o->layers == 1 || o->generator->name) return 0;
    if (o->structures) return fl_fail(err, FL_USAGE, "--keep-out of a file has no effect beside --layers");
    return reject_options(c, "beside --layers", with_layers, err);
}

static int check_bonded(const struct recipe *o, const struct command_line *c, fl_err *err)
{
    static const char *const without[] = {"concentration", "gaps", NULL};
    return o->bonded ? reject_options(c, "beside --bonded, which fills the field", without, err) : 0;
}

/* The number of floes that gives the mean size; a law of sizes is scaled to it, as by --floes. */
static int use_mean_size(struct recipe *o, const struct command_line *c, fl_err *err)
{
    static const char *const other[] = {"floes", "outline", "grade", "pancakes", NULL};
    if (!(o->mean_size > 0.0)) return 0;
    if (reject_options(c, "beside --mean-size", other, err)) return -1;
    const double covered = (o->bonded ? 1.0 : o->concentration) * o->size.x * o->size.y;
    const double n = covered / (o->mean_size * o->mean_size);
    if (!(n >= 0.5 && n <= FLOES_MAX))
        return fl_fail(err, FL_USAGE, "--mean-size %g would give %.3g floes, 1 to %d are expected",
                       o->mean_size, n, FLOES_MAX);
    o->floes = (int32_t)(n + 0.5);
    o->has_floes = 1;
    return 0;
}

/* Concentration below which floes drift apart and touch here and there; above it they have no room. */
#define RANDOM_BELOW 0.9

/* --gaps even is what other kinds of ice have anyway, so it may stand beside any option. */
static void note_gaps(const struct recipe *o, struct command_line *c, int *asked)
{
    const int row = fl_option_row(&c->table, "gaps");
    *asked = c->given[row];
    if (o->gaps == GAPS_EVEN) c->given[row] = 0;
}

/* Floes of an open field have random gaps, unless asked otherwise. */
static void choose_gaps(struct recipe *o, int asked)
{
    const int usual = !o->generator->name && !o->outline && !(o->disc[0] > 0.0) && !cuts_structures(o) &&
                      !o->bonded && !o->graded && !o->ridges && o->layers == 1 &&
                      o->concentration < RANDOM_BELOW;
    if (usual && !asked) o->gaps = GAPS_RANDOM;
    o->says_even = usual && o->gaps == GAPS_EVEN;
}

int options_parse(struct recipe *o, int *ended, int argc, char **argv, fl_err *err)
{
    struct command_line c;
    int gaps_asked;
    *ended = 0;
    *o = (struct recipe){.out = "-",
                         .format = "svg",
                         .material = "ice",
                         .size = {50.0, 50.0},
                         .floes = 200,
                         .smooth = 2,
                         .concentration = 0.8,
                         .porosity = 0.3,
                         .thickness_law = "0.5",
                         .radius = 0.05,
                         .layers = 1,
                         .diameter = 0.25,
                         .ice_density = 900.0,
                         .water_density = 1025.0,
                         .seed = 1};
    list_options(&c);
    if (fl_options_read(&c.table, o, c.given, argc, argv, err)) return -1;
    *ended = o->ended;
    if (*ended) return 0;
    note_gaps(o, &c, &gaps_asked);
    o->has_origin = is_given(&c, "origin");
    o->has_floes = is_given(&c, "floes");
    o->has_concentration = is_given(&c, "concentration");
    o->has_thickness = is_given(&c, "thickness");
    if (o->has_thickness && !is_given(&c, "diameter")) o->diameter = 0.0;
    if (o->certificate && strcmp(o->certificate, "-") == 0 && strcmp(o->out, "-") == 0)
        return fl_fail(err, FL_USAGE,
                       "--certificate - and the field both go to standard output: expected -o");
    if (!o->has_origin) o->origin = (fl_vec2){-0.5 * o->size.x, -0.5 * o->size.y};
    if (select_generator(o, &c, err) || check_water(o, &c, err) || check_graded(o, &c, err) ||
        check_layers(o, &c, err) || check_ridges(o, &c, err) || check_bonded(o, &c, err) ||
        use_mean_size(o, &c, err))
        return -1;
    choose_gaps(o, gaps_asked);
    if (!(o->ice_density < o->water_density))
        return fl_fail(err, FL_USAGE, "--ice-density %g is not below --water-density %g: the floes sink",
                       o->ice_density, o->water_density);
    return 0;
}
