/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "options.h"
#include <getopt.h>
#include <math.h>
#include <string.h>
#include "base/number_text.h"
#include "base/option.h"
#include "base/tool.h"
#include "ice/pancakes.h"
#include "generator_table.h"

static const char HELP_FIELD[] =
    "usage: voronoi-ice [options]\n"
    "A field of ice floes of a given concentration, none of which overlaps another, to a g-polys file.\n"
    "Lengths are in metres; the certificate goes to standard error.\n"
    "\n"
    "      --size AxB          sides of the field along x and y (50x50)\n"
    "      --origin X,Y        its corner of least x and y (such that the field is centred on 0,0)\n"
    "      --floes N           number of floes (200)\n"
    "      --sizes LAW         uniform (Voronoi cells), equal, lognormal:CV or weibull:K of areas,\n"
    "                          power:EXP,DMIN,DMAX[,number|area,cumulative|density] of diameters, or a FILE\n"
    "                          of sizes or of polygons (uniform)\n"
    "      --concentration C   fraction of the field that floes cover, between 0 and 1 (0.8)\n"
    "      --thickness H       of the ice (0.5); uniform:A,B, lognormal:MEAN,CV or a file of thicknesses\n"
    "      --radius R          dilation radius, the roundness of edges, below H/2 (0.05)\n"
    "      --seed N            seed of the random numbers (1)\n"
    "      --smooth N          steps of Lloyd's smoothing; 0 leaves Poisson-Voronoi cells (2)\n"
    "      --material NAME     material of the floes (ice)\n"
    "      --ice-density RHO   kg/m3, sets the draft together with the next (900)\n"
    "      --water-density RHO kg/m3 (1025)\n"
    "      --velocity VX,VY    of all floes at the start, m/s (0,0)\n"
    "      --keep-out SHAPE    remove floes that meet circle:X,Y,R or box:X0,Y0,X1,Y1; may be given 16 "
    "times\n"
    "                          or files as in g_struct(5): their waterline, with the margin, is cut out\n"
    "      --margin M          open water round the structures of --keep-out (0)\n"
    "      --outline SHAPE     of the field instead of a rectangle: disc:R, disc:R,X,Y or a file of corners\n"
    "      --lead X0,Y0,X1,Y1,WIDTH  a strip of open water; may be given 16 times\n"
    "      --grade DIR:C0,C1   concentration rising from C0 to C1 along DIR: x, y or degrees; or DIR:FILE\n"
    "      --periodic x|y|xy   periodic field: its copies fit side by side without a seam\n"
    "      --pancakes SIDES    floes round in plan, of that many sides\n"
    "      --ridge X0,Y0,X1,Y1,HS,WS,HK,WK,WB  a ridge along that line, of blocks: height and width of its\n"
    "                          sail, depth and width of its keel and that at its bottom; up to 4 times\n"
    "      --block L           size of the blocks of ridges (the thickness)\n"
    "      --porosity P        fraction of ridges without ice (0.3)\n"
    "      --bonded            no gaps, and a bond candidate for every face that two bodies share\n";
static const char HELP_OUTPUT[] =
    "      --layers N          layers of the lattice, or of rafted floes (1)\n"
    "      --diameter D        of the spheres of the lattice (0.25)\n"
    "      --certificate FILE  requested and achieved values as a table, - is standard output\n"
    "      --id NAME           name of the field in its history line; auto computes it from the bodies\n"
    "      --plot DIR          pictures of the field and of its sizes, by gnuplot, into the folder\n"
    "      --format FORMAT     of the pictures, svg or png (svg)\n"
    "  -o, --output FILE       write there, - is standard output\n"
    "  -z, --gzip              compress the file\n"
    "  -j, --threads N         threads (one per processor)\n"
    "  -q, --quiet             no certificate\n"
    "  -v, --verbose           print the stages of the work\n"
    "  -h, --help              this text\n"
    "      --version           the version\n";

enum {
    SIZE = 256,
    ORIGIN,
    FLOES,
    SIZES,
    CONCENTRATION,
    THICKNESS,
    RADIUS,
    SEED,
    SMOOTH,
    MATERIAL,
    ICE_DENSITY,
    WATER_DENSITY,
    VELOCITY,
    KEEP_OUT,
    CERTIFICATE,
    MARGIN,
    OUTLINE,
    LEAD,
    ID,
    PLOT,
    FORMAT,
    GRADE,
    PERIODIC,
    PANCAKES,
    RIDGE,
    BLOCK,
    POROSITY,
    BONDED,
    LAYERS,
    DIAMETER,
    VERSION,
    GENERATOR /* + row of generator_table */
};

static const struct option LONG[] = {{"size", required_argument, NULL, SIZE},
                                     {"origin", required_argument, NULL, ORIGIN},
                                     {"floes", required_argument, NULL, FLOES},
                                     {"sizes", required_argument, NULL, SIZES},
                                     {"concentration", required_argument, NULL, CONCENTRATION},
                                     {"thickness", required_argument, NULL, THICKNESS},
                                     {"radius", required_argument, NULL, RADIUS},
                                     {"seed", required_argument, NULL, SEED},
                                     {"smooth", required_argument, NULL, SMOOTH},
                                     {"material", required_argument, NULL, MATERIAL},
                                     {"ice-density", required_argument, NULL, ICE_DENSITY},
                                     {"water-density", required_argument, NULL, WATER_DENSITY},
                                     {"velocity", required_argument, NULL, VELOCITY},
                                     {"keep-out", required_argument, NULL, KEEP_OUT},
                                     {"margin", required_argument, NULL, MARGIN},
                                     {"outline", required_argument, NULL, OUTLINE},
                                     {"lead", required_argument, NULL, LEAD},
                                     {"grade", required_argument, NULL, GRADE},
                                     {"periodic", required_argument, NULL, PERIODIC},
                                     {"pancakes", required_argument, NULL, PANCAKES},
                                     {"ridge", required_argument, NULL, RIDGE},
                                     {"block", required_argument, NULL, BLOCK},
                                     {"porosity", required_argument, NULL, POROSITY},
                                     {"bonded", no_argument, NULL, BONDED},
                                     {"layers", required_argument, NULL, LAYERS},
                                     {"diameter", required_argument, NULL, DIAMETER},
                                     {"certificate", required_argument, NULL, CERTIFICATE},
                                     {"id", required_argument, NULL, ID},
                                     {"plot", required_argument, NULL, PLOT},
                                     {"format", required_argument, NULL, FORMAT},
                                     {"output", required_argument, NULL, 'o'},
                                     {"gzip", no_argument, NULL, 'z'},
                                     {"threads", required_argument, NULL, 'j'},
                                     {"quiet", no_argument, NULL, 'q'},
                                     {"verbose", no_argument, NULL, 'v'},
                                     {"help", no_argument, NULL, 'h'},
                                     {"version", no_argument, NULL, VERSION},
                                     {NULL, 0, NULL, 0}};

/* Largest coordinate of a shape, as FL_ICE_FIELD_MAX_COORD; longest field, where an ulp is a tenth of a
 * nanometre; shortest length [m]. */
#define FAR 1e9
#define LONGEST 1e6
#define SHORTEST 1e-6

/* Parse exactly n numbers after `skip` characters, separated by `by`; expected describes them for the
 * message. */
static int parse_numbers(const char *option, const char *text, int skip, char by, int n, double lo, double hi,
                         double *x, const char *expected, fl_err *err)
{
    char word[64];
    const char *p = text + skip;
    for (int k = 0; k < n; k++) {
        const char *end = k + 1 < n ? strchr(p, by) : p + strlen(p);
        const size_t len = end ? (size_t)(end - p) : sizeof word;
        if (len >= sizeof word) goto bad;
        memcpy(word, p, len);
        word[len] = '\0';
        if (fl_number_f64(word, &x[k]) || !(x[k] >= lo && x[k] <= hi)) goto bad;
        p = end + 1;
    }
    return 0;
bad:
    return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", %s is expected", option, text, expected);
}

static int parse_number(const char *option, const char *text, double lo, double hi, double *x,
                        const char *expected, fl_err *err)
{
    return parse_numbers(option, text, 0, ',', 1, lo, hi, x, expected, err);
}

static int parse_pair(const char *option, const char *text, char by, double lo, double hi, fl_vec2 *out,
                      const char *expected, fl_err *err)
{
    double x[2] = {0.0, 0.0};
    if (parse_numbers(option, text, 0, by, 2, lo, hi, x, expected, err)) return -1;
    *out = (fl_vec2){x[0], x[1]};
    return 0;
}

static int parse_sizes(struct recipe *o, const char *text, fl_err *err)
{
    o->sizes = NULL;
    o->sizes_file = 0;
    if (strcmp(text, "uniform") == 0) return 0;
    o->sizes_file = !fl_sizes_is_law(text);
    if (!o->sizes_file && fl_sizes_parse(&o->law, o->sizes_name, text, err)) return -1;
    if (o->sizes_file && (text[0] == '\0' || strlen(text) > 1000 || strpbrk(text, " \t\r\n\f\v")))
        return fl_fail(err, FL_USAGE,
                       "--sizes is \"%.60s\", a law or the name of a file without blanks is expected", text);
    o->sizes = o->sizes_file ? text : o->sizes_name;
    return 0;
}

/* A name is one word of the file format. */
static int parse_word(const char *option, const char *text, const char **out, fl_err *err)
{
    if (text[0] == '\0' || strlen(text) > 200 || strpbrk(text, " \t\r\n\f\v"))
        return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", one word of up to 200 bytes is expected", option,
                       text);
    *out = text;
    return 0;
}

/* The name of a file must be one word of the history line. */
static int parse_file(const char *option, const char *text, const char **out, fl_err *err)
{
    if (text[0] == '\0' || strlen(text) > 1000 || strpbrk(text, " \t\r\n\f\v"))
        return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", the name of a file without blanks is expected",
                       option, text);
    *out = text;
    return 0;
}

static int parse_keep_out(struct recipe *o, const char *text, fl_err *err)
{
    static const char expected[] = "circle:X,Y,R or box:X0,Y0,X1,Y1 in metres";
    const size_t word = strcspn(text, ":/");
    struct keep_out k = {0};
    double x[4] = {0};
    if (text[word] != ':') { /* "a/b:c" is a file */
        if (o->structures == KEEP_OUT_MAX)
            return fl_fail(err, FL_USAGE, "more than %d files to keep out", KEEP_OUT_MAX);
        if (parse_file("keep-out", text, &o->structure[o->structures], err)) return -1;
        o->structures++;
        return 0;
    }
    if (o->keep_outs == KEEP_OUT_MAX)
        return fl_fail(err, FL_USAGE, "more than %d shapes to keep out", KEEP_OUT_MAX);
    if (strncmp(text, "circle:", 7) == 0) {
        if (parse_numbers("keep-out", text, 7, ',', 3, -FAR, FAR, x, expected, err)) return -1;
        k = (struct keep_out){.circle = 1, .lo = {x[0], x[1]}, .r = x[2]};
        if (k.r <= 0.0) return fl_fail(err, FL_USAGE, "--keep-out is \"%.60s\", R above 0 is expected", text);
    } else if (strncmp(text, "box:", 4) == 0) {
        if (parse_numbers("keep-out", text, 4, ',', 4, -FAR, FAR, x, expected, err)) return -1;
        k = (struct keep_out){.lo = {x[0], x[1]}, .hi = {x[2], x[3]}};
        if (!(x[0] < x[2] && x[1] < x[3]))
            return fl_fail(err, FL_USAGE, "--keep-out is \"%.60s\", X0 < X1 and Y0 < Y1 is expected", text);
    } else {
        return fl_fail(err, FL_USAGE, "--keep-out is \"%.60s\", %s is expected", text, expected);
    }
    o->keep_out[o->keep_outs++] = k;
    return 0;
}

static int parse_outline(struct recipe *o, const char *text, fl_err *err)
{
    static const char expected[] = "disc:R or disc:R,X,Y in metres, or the name of a file,";
    const int centred = strncmp(text, "disc:", 5) == 0 && !strchr(text, ',');
    o->outline = NULL;
    o->disc[0] = o->disc[1] = o->disc[2] = 0.0;
    if (strncmp(text, "disc:", 5) != 0) return parse_file("outline", text, &o->outline, err);
    if (parse_numbers("outline", text, 5, ',', centred ? 1 : 3, -LONGEST, LONGEST, o->disc, expected, err))
        return -1;
    if (o->disc[0] >= SHORTEST) return 0;
    return fl_fail(err, FL_USAGE, "--outline is \"%.60s\", R of %g at least is expected", text, SHORTEST);
}

static int parse_lead(struct recipe *o, const char *text, fl_err *err)
{
    double *x = o->lead[o->leads];
    if (o->leads == LEAD_MAX) return fl_fail(err, FL_USAGE, "--lead is given more than %d times", LEAD_MAX);
    if (parse_numbers("lead", text, 0, ',', 5, -FAR, FAR, x, "X0,Y0,X1,Y1,WIDTH in metres", err)) return -1;
    if (!(x[4] >= SHORTEST && fabs(x[2] - x[0]) + fabs(x[3] - x[1]) >= SHORTEST))
        return fl_fail(err, FL_USAGE, "--lead is \"%.60s\", a length and a width of %g at least are expected",
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
                   "--%s is \"%.60s\", a number between 0 and 1, as 0.8, 80%% or 8/10, is expected", option,
                   text);
}

/* DIR:C0,C1 or DIR:FILE. */
static int parse_grade(struct recipe *o, const char *text, fl_err *err)
{
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
    if (!second) return parse_file("grade", rest, &o->grade_file, err);
    if ((size_t)(second - rest) >= sizeof word) goto bad;
    memcpy(word, rest, (size_t)(second - rest));
    word[second - rest] = '\0';
    return parse_concentration("grade", word, &o->grade[0], err) ||
                   parse_concentration("grade", second + 1, &o->grade[1], err)
               ? -1
               : 0;
bad:
    return fl_fail(err, FL_USAGE,
                   "--grade is \"%.60s\", DIR:C0,C1 or DIR:FILE with DIR x, y or degrees is expected", text);
}

static int parse_periodic(const char *text, int *out, fl_err *err)
{
    out[0] = strcmp(text, "x") == 0 || strcmp(text, "xy") == 0;
    out[1] = strcmp(text, "y") == 0 || strcmp(text, "xy") == 0;
    if (out[0] || out[1]) return 0;
    return fl_fail(err, FL_USAGE, "--periodic is \"%.60s\", x, y or xy is expected", text);
}

static int parse_ridge(struct recipe *o, const char *text, fl_err *err)
{
    static const char expected[] = "X0,Y0,X1,Y1,HS,WS,HK,WK,WB in metres";
    double *x = o->ridge[o->ridges];
    if (o->ridges == RIDGE_MAX)
        return fl_fail(err, FL_USAGE, "--ridge is given more than %d times", RIDGE_MAX);
    if (parse_numbers("ridge", text, 0, ',', 9, -LONGEST, LONGEST, x, expected, err)) return -1;
    for (int k = 4; k < 8; k++)
        if (!(x[k] >= SHORTEST))
            return fl_fail(err, FL_USAGE, "--ridge is \"%.60s\", heights and widths above 0 are expected",
                           text);
    if (!(fabs(x[2] - x[0]) + fabs(x[3] - x[1]) >= SHORTEST) || !(x[8] >= 0.0 && x[8] <= x[7]))
        return fl_fail(err, FL_USAGE, "--ridge is \"%.60s\", a length and a WB from 0 to WK are expected",
                       text);
    o->ridges++;
    return 0;
}

/* --- checks between options ----------------------------------------------------------------------------- */

static int is_given(uint64_t given, int c) { return (int)(given >> (c - SIZE) & 1); }

/* Reject the n options, which have no effect as `why` says. */
static int reject_options(uint64_t given, const char *why, int n, const int *rejected, fl_err *err)
{
    for (int k = 0; k < n; k++)
        if (is_given(given, rejected[k]))
            for (const struct option *l = LONG; l->name; l++)
                if (l->val == rejected[k])
                    return fl_fail(err, FL_USAGE, "--%s has no effect %s", l->name, why);
    return 0;
}

/* Select the generator that was given first in the table, and reject options that it does not read. */
static int select_generator(struct recipe *o, uint64_t given, const struct option *all, fl_err *err)
{
    int row = 0;
    while (row < generator_count - 1 && !is_given(given, GENERATOR + row)) row++;
    o->generator = &generator_table[row];
    for (const struct option *l = all; l->name; l++) {
        if (l->val < SIZE || l->val == GENERATOR + row || !is_given(given, l->val)) continue;
        if (generator_reads(o->generator, l->name)) continue;
        if (o->generator->name)
            return fl_fail(err, FL_USAGE, "--%s has no effect beside --%s", l->name, o->generator->name);
        for (int k = 0; k < generator_count; k++)
            if (generator_reads(&generator_table[k], l->name))
                return fl_fail(err, FL_USAGE, "--%s has no effect without --%s", l->name,
                               generator_table[k].name);
    }
    return 0;
}

static int check_water(const struct recipe *o, uint64_t given, fl_err *err)
{
    static const int without[] = {SIZE, ORIGIN}, within[] = {MARGIN};
    if (o->outline || o->disc[0] > 0.0) {
        if (reject_options(given, "beside --outline", 2, without, err)) return -1;
        if (o->outline && strcmp(o->outline, "-") == 0)
            return fl_fail(err, FL_USAGE,
                           "--outline is \"-\", a file is expected: a pipe cannot be named again");
    }
    return o->structures ? 0 : reject_options(given, "without the file of a structure", 1, within, err);
}

static int check_graded(const struct recipe *o, uint64_t given, fl_err *err)
{
    static const int without[] = {CONCENTRATION, SIZES, BONDED}, none[] = {SIZES, BONDED, OUTLINE, LEAD};
    static const int round[] = {SIZES, BONDED, GRADE};
    if (o->pancakes && reject_options(given, "beside --pancakes", 3, round, err)) return -1;
    if (o->graded && reject_options(given, "beside --grade", 3, without, err)) return -1;
    if (!o->periodic[0] && !o->periodic[1]) return 0;
    if (o->structures)
        return fl_fail(err, FL_USAGE,
                       "--keep-out of a file has no effect beside --periodic, a shape is expected");
    return reject_options(given, "beside --periodic", 4, none, err);
}

static int check_ridges(const struct recipe *o, uint64_t given, fl_err *err)
{
    static const int with_ridge[] = {SIZES, PERIODIC}, without_ridge[] = {BLOCK, POROSITY};
    if (!o->ridges) return reject_options(given, "without --ridge", 2, without_ridge, err);
    return reject_options(given, "beside --ridge", 2, with_ridge, err);
}

/* Layers of floes; those of a lattice have no such limits. */
static int check_layers(const struct recipe *o, uint64_t given, fl_err *err)
{
    static const int with_layers[] = {SIZES, BONDED, RIDGE};
    if (o->layers == 1 || o->generator->name) return 0;
    if (o->structures) return fl_fail(err, FL_USAGE, "--keep-out of a file has no effect beside --layers");
    return reject_options(given, "beside --layers", 3, with_layers, err);
}

static int check_bonded(const struct recipe *o, uint64_t given, fl_err *err)
{
    static const int without[] = {CONCENTRATION};
    return o->bonded ? reject_options(given, "beside --bonded, which fills the field", 1, without, err) : 0;
}

static int apply_common(struct recipe *o, int c, const char *arg, fl_err *err)
{
    switch (c) {
    case SIZE:
        return parse_pair("size", arg, 'x', SHORTEST, LONGEST, &o->size, "AxB in metres, as 50x50,", err);
    case ORIGIN:
        o->has_origin = 1;
        return parse_pair("origin", arg, ',', -LONGEST, LONGEST, &o->origin, "X,Y in metres", err);
    case FLOES: o->has_floes = 1; return fl_option_whole("floes", arg, 1, FLOES_MAX, &o->floes, err);
    case SIZES: return parse_sizes(o, arg, err);
    case CONCENTRATION:
        o->has_concentration = 1;
        return parse_concentration("concentration", arg, &o->concentration, err);
    case THICKNESS: return parse_file("thickness", arg, &o->thickness_law, err);
    case RADIUS: return parse_number("radius", arg, 0.0, LONGEST, &o->radius, "a length not below 0", err);
    case SEED:
        if (fl_number_u64(arg, &o->seed) == 0) return 0;
        return fl_fail(err, FL_USAGE, "--seed is \"%.60s\", a whole number from 0 to 2^64 - 1 is expected",
                       arg);
    case SMOOTH: return fl_option_whole("smooth", arg, 0, 10000, &o->smooth, err);
    case MATERIAL: return parse_word("material", arg, &o->material, err);
    case ICE_DENSITY: return parse_number("ice-density", arg, 1.0, 1e5, &o->ice_density, "kg/m3", err);
    case WATER_DENSITY: return parse_number("water-density", arg, 1.0, 1e5, &o->water_density, "kg/m3", err);
    case VELOCITY: return parse_pair("velocity", arg, ',', -1e3, 1e3, &o->velocity, "VX,VY in m/s", err);
    case KEEP_OUT: return parse_keep_out(o, arg, err);
    case MARGIN: return parse_number("margin", arg, 0.0, LONGEST, &o->margin, "a length not below 0", err);
    case OUTLINE: return parse_outline(o, arg, err);
    case LEAD: return parse_lead(o, arg, err);
    case GRADE: return parse_grade(o, arg, err);
    case PERIODIC: return parse_periodic(arg, o->periodic, err);
    case PANCAKES:
        return fl_option_whole("pancakes", arg, FL_PANCAKES_MIN_SIDES, FL_PANCAKES_MAX_SIDES, &o->pancakes,
                               err);
    case RIDGE: return parse_ridge(o, arg, err);
    case BLOCK: return parse_number("block", arg, SHORTEST, LONGEST, &o->block, "a length", err);
    case POROSITY: return parse_concentration("porosity", arg, &o->porosity, err);
    case BONDED: o->bonded = 1; return 0;
    case LAYERS: return fl_option_whole("layers", arg, 1, 1000, &o->layers, err);
    case DIAMETER: return parse_number("diameter", arg, SHORTEST, LONGEST, &o->diameter, "a length", err);
    case CERTIFICATE: o->certificate = arg; return 0;
    case ID: return parse_word("id", arg, &o->id, err);
    case PLOT: o->plot = arg; return 0;
    case FORMAT:
        o->format = arg;
        if (strcmp(arg, "svg") == 0 || strcmp(arg, "png") == 0) return 0;
        return fl_fail(err, FL_USAGE, "--format is \"%.60s\", svg or png is expected", arg);
    case 'o': o->out = arg; return 0;
    case 'z': o->gzip = 1; return 0;
    case 'j': return fl_option_whole("threads", arg, 1, 1024, &o->threads, err);
    case 'q': o->quiet = 1; return 0;
    case 'v': o->verbose = 1; return 0;
    default: return fl_fail(err, FL_USAGE, "see voronoi-ice --help");
    }
}

static void print_help(void)
{
    fputs(HELP_FIELD, stdout);
    for (int k = 0; k < generator_count; k++) {
        const struct generator *g = &generator_table[k];
        char head[40];
        if (!g->name) continue;
        snprintf(head, sizeof head, "--%s%s%s", g->name, g->argument ? " " : "",
                 g->argument ? g->argument : "");
        printf("      %-19s %s\n", head, g->help);
    }
    fputs(HELP_OUTPUT, stdout);
}

/* Options of getopt: the common ones, then one for each generator with a name. */
enum { COMMON = sizeof LONG / sizeof LONG[0] - 1, GENERATORS_MAX = 64 - (GENERATOR - SIZE) };

static void list_options(struct option all[COMMON + GENERATORS_MAX + 1])
{
    int n = COMMON;
    memcpy(all, LONG, COMMON * sizeof *all);
    for (int k = 0; k < generator_count && k < GENERATORS_MAX; k++) {
        const struct generator *g = &generator_table[k];
        if (g->name)
            all[n++] =
                (struct option){g->name, g->argument ? required_argument : no_argument, NULL, GENERATOR + k};
    }
    all[n] = (struct option){NULL, 0, NULL, 0};
}

/* Apply one option.  *ended is set where it was --help or --version. */
static int apply_option(struct recipe *o, int *ended, int c, const char *arg, fl_err *err)
{
    *ended = c == 'h' || c == VERSION;
    if (c == 'h') print_help();
    if (c == VERSION) fl_tool_version("voronoi-ice");
    if (*ended) return 0;
    if (c < GENERATOR) return apply_common(o, c, arg, err);
    o->generator_argument = arg;
    return generator_table[c - GENERATOR].check ? generator_table[c - GENERATOR].check(arg, err) : 0;
}

int options_parse(struct recipe *o, int *ended, int argc, char **argv, fl_err *err)
{
    struct option all[COMMON + GENERATORS_MAX + 1];
    uint64_t given = 0; /* bit c - SIZE: long option c */
    int c;
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
    list_options(all);
    opterr = 0;
    while (!*ended && (c = getopt_long(argc, argv, ":o:zj:qvh", all, NULL)) != -1) {
        if (c == ':' || c == '?')
            return fl_option_unknown("voronoi-ice", all, c, optopt, argv[optind - 1], err);
        if (c >= SIZE) given |= UINT64_C(1) << (c - SIZE);
        if (apply_option(o, ended, c, optarg, err)) return -1;
    }
    if (*ended) return 0;
    if (optind < argc)
        return fl_fail(err, FL_USAGE, "\"%.60s\" is not expected, voronoi-ice reads no file", argv[optind]);
    if (o->certificate && strcmp(o->certificate, "-") == 0 && strcmp(o->out, "-") == 0)
        return fl_fail(err, FL_USAGE,
                       "--certificate - and the field both go to standard output: -o is expected");
    if (!o->has_origin) o->origin = (fl_vec2){-0.5 * o->size.x, -0.5 * o->size.y};
    if (select_generator(o, given, all, err) || check_water(o, given, err) || check_graded(o, given, err) ||
        check_layers(o, given, err) || check_ridges(o, given, err) || check_bonded(o, given, err))
        return -1;
    if (!(o->ice_density < o->water_density))
        return fl_fail(err, FL_USAGE, "--ice-density %g is not below --water-density %g: the floes sink",
                       o->ice_density, o->water_density);
    return 0;
}
