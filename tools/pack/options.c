/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "options.h"
#include <math.h>
#include <string.h>
#include "base/number_text.h"
#include "base/option.h"

static const char USAGE[] =
    "usage: pack --in REGION [options]\n"
    "Fills a region with spheres, capsules or polyhedra by radius growth: a stated grading and porosity,\n"
    "and a certificate; g-polys(5).\n"
    "\n";

static const char *const DIMS[] = {"2", "3", NULL};
static const char *const STRAIGHTS[] = {"log", "linear", NULL};
static const char *const THROWS[] = {"rejection", "poisson", NULL};
static const char *const GROWS[] = {"relax", "dynamic", NULL};
static const char *const TRIMS[] = {"all", "near", "none", NULL};
static const char *const FORMATS[] = {"svg", "png", NULL};

static int set_seed(void *options, const char *text, fl_err *err)
{
    if (fl_number_u64(text, &((struct options *)options)->seed) == 0) return 0;
    return fl_fail(err, FL_USAGE, "--seed is \"%.60s\", expected a whole number from 0 to 2^64 - 1", text);
}

static int set_format(void *options, const char *text, fl_err *err)
{
    int k;
    if (fl_option_choice("format", text, FORMATS, &k, err)) return -1;
    ((struct options *)options)->format = FORMATS[k];
    return 0;
}

/* An open interval: 0 and 1 are no porosity. */
static int set_part(const char *word, const char *text, double *x, fl_err *err)
{
    if (fl_number_f64(text, x) == 0 && *x > 0.0 && *x < 1.0) return 0;
    return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", expected a number above 0 and below 1", word, text);
}

static int set_porosity(void *options, const char *text, fl_err *err)
{
    return set_part("porosity", text, &((struct options *)options)->porosity, err);
}

static int set_solid(void *options, const char *text, fl_err *err)
{
    return set_part("solid", text, &((struct options *)options)->solid, err);
}

static int add_layer(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (o->layer_count == FL_PACK_LAYERS_MAX)
        return fl_fail(err, FL_USAGE, "--layer stands more than %d times", FL_PACK_LAYERS_MAX);
    o->layer[o->layer_count++] = text;
    return 0;
}

#define AT(member) offsetof(struct options, member)

static const fl_option OPTION[] = {
    {.word = "in",
     .argument = "REGION",
     .help = "box:X0,Y0,Z0,X1,Y1,Z1, cylinder:R,Z0,Z1,X,Y, sphere:R,X,Y,Z, or a file:\n"
             "an outline (--dim 2), a closed mesh, or g-polys(5)",
     .kind = FL_OPTION_FILE,
     .at = AT(in)},
    {.word = "dim",
     .argument = "D",
     .help = "3, or 2: discs in the plane of x and y (3)",
     .kind = FL_OPTION_CHOICE,
     .at = AT(dim),
     .choice = DIMS},
    {.word = "periodic",
     .argument = "AXES",
     .help = "directions of a box without walls, as xy",
     .kind = FL_OPTION_WORD,
     .at = AT(periodic)},
    {.word = "helper",
     .argument = "WALLS",
     .help = "walls that are taken away later, with commas, or all",
     .kind = FL_OPTION_WORD,
     .at = AT(helper)},
    {.word = "grading",
     .argument = "G",
     .help = "uniform:A,B[,number], fuller:N,A,B, single:D, or a file of kind grading",
     .kind = FL_OPTION_FILE,
     .at = AT(grading)},
    {.word = "layer",
     .argument = "REGION=G",
     .help = "part of the region with a grading of its own; may stand again, the first counts",
     .kind = FL_OPTION_CALL,
     .call = add_layer},
    {.word = "straight",
     .argument = "S",
     .help = "between two sieves the curve is straight in log d, or linear in d (log)",
     .kind = FL_OPTION_CHOICE,
     .at = AT(straight),
     .choice = STRAIGHTS},
    {.word = "porosity",
     .argument = "P",
     .help = "part of the region that stays empty; or",
     .kind = FL_OPTION_CALL,
     .call = set_porosity},
    {.word = "solid",
     .argument = "P",
     .help = "part of the region that is solid; or",
     .kind = FL_OPTION_CALL,
     .call = set_solid},
    {.word = "number",
     .argument = "N",
     .help = "number of bodies",
     .kind = FL_OPTION_INTEGER,
     .at = AT(number),
     .lo = 1,
     .hi = 1 << 27},
    {.word = "shapes",
     .argument = "S",
     .help = "sphere, capsule:R (length over diameter), or the bodies of a g-polys file (sphere)",
     .kind = FL_OPTION_FILE,
     .at = AT(shapes)},
    {.word = "throw",
     .argument = "T",
     .help = "rejection: bodies of half size do not overlap; or poisson: they may (rejection)",
     .kind = FL_OPTION_CHOICE,
     .at = AT(throwing),
     .choice = THROWS},
    {.word = "grow",
     .argument = "G",
     .help = "relax: overlaps relax without friction; or dynamic: steps with friction (relax)",
     .kind = FL_OPTION_CHOICE,
     .at = AT(grow),
     .choice = GROWS},
    {.word = "trim",
     .argument = "T",
     .help = "radii shrink until the packing is free of force: of all bodies, near helper\n"
             "walls, or none (all)",
     .kind = FL_OPTION_CHOICE,
     .at = AT(trim),
     .choice = TRIMS},
    {.word = "layers",
     .argument = "N",
     .help = "of --trim near: mean sizes from a helper wall (2)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(layers),
     .lo = 0.1,
     .hi = 1e3,
     .expected = "a number from 0.1 to 1000"},
    {.word = "gravity",
     .argument = "G",
     .help = "come to rest behind all walls under this gravity [m/s2], along -z or -y",
     .kind = FL_OPTION_NUMBER,
     .at = AT(gravity),
     .lo = 1e-6,
     .hi = 1e6,
     .expected = "an acceleration above 0"},
    {.word = "friction",
     .argument = "MU",
     .help = "of --grow dynamic and --gravity (0.5)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(friction),
     .lo = 0.0,
     .hi = 100.0,
     .expected = "a coefficient from 0 to 100"},
    {.word = "restitution",
     .argument = "E",
     .help = "of the same (0.2)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(restitution),
     .lo = 0.05,
     .hi = 1.0,
     .expected = "a number from 0.05 to 1"},
    {.word = "young",
     .argument = "E",
     .help = "modulus of the same [Pa] (1e8)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(young),
     .lo = 1.0,
     .hi = 1e13,
     .expected = "a modulus in Pa"},
    {.word = "density",
     .argument = "R",
     .help = "of the same [kg/m3] (900)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(density),
     .lo = 1e-3,
     .hi = 1e6,
     .expected = "a density in kg/m3"},
    {.word = "seed",
     .argument = "N",
     .help = "of places and orientations (1)",
     .kind = FL_OPTION_CALL,
     .call = set_seed},
    {.word = "material",
     .argument = "NAME",
     .help = "of the bodies",
     .kind = FL_OPTION_WORD,
     .at = AT(material)},
    {.word = "group",
     .argument = "NAME",
     .help = "of the bodies (--dim 2: plane)",
     .kind = FL_OPTION_WORD,
     .at = AT(group)},
    {.word = "certificate",
     .argument = "FILE",
     .help = "write what was asked and what was reached as a table",
     .kind = FL_OPTION_FILE,
     .at = AT(certificate)},
    {.word = "plot",
     .argument = "DIR",
     .help = "draw the sieve curves, a section and the fabric into a folder",
     .kind = FL_OPTION_FILE,
     .at = AT(plot)},
    {.word = "format",
     .argument = "F",
     .help = "of pictures: svg or png (svg)",
     .kind = FL_OPTION_CALL,
     .call = set_format},
    {.word = "checkpoint",
     .argument = "FILE",
     .help = "write the state at --until, or when stopped by a signal during growth",
     .kind = FL_OPTION_FILE,
     .at = AT(checkpoint)},
    {.word = "until",
     .argument = "S",
     .help = "stop growth at this scale, 0 to 1, with a checkpoint",
     .kind = FL_OPTION_NUMBER,
     .at = AT(until),
     .lo = 1e-6,
     .hi = 1.0,
     .expected = "a scale above 0, to 1"},
    {.word = "resume",
     .argument = "FILE",
     .help = "go on from such a state, with the same options and files",
     .kind = FL_OPTION_FILE,
     .at = AT(resume)},
    FL_COMMON_OPTIONS(struct options, "write the bodies to FILE (standard output)", "compress them",
                      "number of threads (those of OMP_NUM_THREADS, or all)",
                      "no certificate on standard error", "a line for each stage on standard error"),
};

static const fl_option_table TABLE = {"pack", USAGE, OPTION, NULL, 0};

static int check_targets(const struct options *o, fl_err *err)
{
    const int porosity = !isnan(o->porosity), solid = !isnan(o->solid), number = o->number > 0;
    if (porosity + solid + number > 1)
        return fl_fail(err, FL_USAGE,
                       "--%s and --%s are given, one of --porosity, --solid and --number is expected",
                       porosity ? "porosity" : "solid", number ? "number" : "solid");
    return 0;
}

int options_parse(struct options *o, int argc, char **argv, fl_err *err)
{
    const fl_growth_options usual = fl_growth_defaults();
    *o = (struct options){.periodic = "",
                          .helper = "",
                          .shapes = "sphere",
                          .dim = 1,
                          .porosity = NAN,
                          .solid = NAN,
                          .layers = usual.layers,
                          .friction = 0.5,
                          .young = 1e8,
                          .density = 900.0,
                          .restitution = 0.2,
                          .seed = 1,
                          .format = "svg",
                          .out = "-"};
    if (fl_options_read(&TABLE, o, NULL, argc, argv, err)) return -1;
    if (o->ended) return 0;
    o->dim += 2;
    if (!o->in) return fl_fail(err, FL_USAGE, "no region, --in is expected");
    if (!options_graded(o) && strcmp(o->shapes, "sphere") == 0)
        return fl_fail(err, FL_USAGE, "no sizes, --grading is expected");
    if (check_targets(o, err)) return -1;
    if (o->layer_count && isnan(options_solid(o)))
        return fl_fail(err, FL_USAGE, "--layer needs --porosity or --solid");
    if (o->dim == 2 && strcmp(o->shapes, "sphere") != 0)
        return fl_fail(err, FL_USAGE, "--shapes with --dim 2, three dimensions are expected");
    if (o->trim == FL_TRIM_NEAR && !*o->helper)
        return fl_fail(err, FL_USAGE, "--trim near needs --helper, the walls near which radii shrink");
    if (o->until > 0.0 && !o->checkpoint) return fl_fail(err, FL_USAGE, "--until needs --checkpoint");
    if (o->checkpoint && o->grow == GROW_DYNAMIC)
        return fl_fail(err, FL_USAGE, "--checkpoint is for --grow relax");
    if (!o->group && o->dim == 2) o->group = "plane";
    return 0;
}

int options_graded(const struct options *o) { return o->grading || o->layer_count; }

double options_solid(const struct options *o) { return !isnan(o->porosity) ? 1.0 - o->porosity : o->solid; }

static void add_option(fl_history_line *by, const char *name, double x, double usual)
{
    char text[FL_NUMBER_LEN];
    if (x != usual && !isnan(x)) fl_history_line_add(by, "%s %s", name, fl_number_text(x, text));
}

void options_by(const struct options *o, fl_history_line *by)
{
    fl_history_line_start(by, "pack");
    fl_history_line_word(by, "--in ", o->in);
    if (o->dim == 2) fl_history_line_add(by, "--dim 2");
    if (*o->periodic) fl_history_line_word(by, "--periodic ", o->periodic);
    if (*o->helper) fl_history_line_word(by, "--helper ", o->helper);
    if (o->grading) fl_history_line_word(by, "--grading ", o->grading);
    for (int k = 0; k < o->layer_count; k++) fl_history_line_word(by, "--layer ", o->layer[k]);
    if (o->straight) fl_history_line_add(by, "--straight linear");
    add_option(by, "--porosity", o->porosity, 0.0);
    add_option(by, "--solid", o->solid, 0.0);
    if (o->number) fl_history_line_add(by, "--number %d", o->number);
    if (strcmp(o->shapes, "sphere") != 0) fl_history_line_word(by, "--shapes ", o->shapes);
    if (o->throwing) fl_history_line_add(by, "--throw poisson");
    if (o->grow) fl_history_line_add(by, "--grow dynamic");
    if (o->trim) fl_history_line_add(by, "--trim %s", TRIMS[o->trim]);
    if (o->trim == FL_TRIM_NEAR) add_option(by, "--layers", o->layers, 2.0);
    add_option(by, "--gravity", o->gravity, 0.0);
    if (o->grow || o->gravity > 0.0) {
        add_option(by, "--friction", o->friction, 0.5);
        add_option(by, "--restitution", o->restitution, 0.2);
        add_option(by, "--young", o->young, 1e8);
        add_option(by, "--density", o->density, 900.0);
    }
    fl_history_line_add(by, "--seed %llu", (unsigned long long)o->seed);
}
