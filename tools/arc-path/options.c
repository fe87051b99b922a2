/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "options.h"
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/option.h"
#include "member/member_modes.h"

static const char USAGE[] =
    "usage: arc-path [options] MODEL\n"
    "The equilibrium path of a structure of bars and beams past its limits, members(5) to path(5).\n"
    "\n";

static const char *const CONSTRAINTS[] = {"total", "increment", "displacement", "load", NULL};
static const char *const PREDICTORS[] = {"chord", "load", NULL};
static const char *const FORMATS[] = {"svg", "png", NULL};

static int set_model(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (o->model)
        return fl_fail(err, FL_USAGE, "two models, %.60s and %.60s; one is expected", o->model, text);
    o->model = text;
    return 0;
}

/* "2%" and "0.02" are equal. */
static int set_first(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    char word[64];
    const size_t len = strlen(text);
    double x, part = 1.0;
    if (len > 0 && len < sizeof word) {
        memcpy(word, text, len + 1);
        if (word[len - 1] == '%') {
            word[len - 1] = '\0';
            part = 100.0;
        }
        if (fl_number_f64(word, &x) == 0 && x != 0.0 && x / part > -1e6 && x / part < 1e6) {
            o->path.first = x / part;
            return 0;
        }
    }
    return fl_fail(err, FL_USAGE, "--first is \"%.60s\", expected a load factor other than 0, as 0.02 or 2%%",
                   text);
}

static int set_increment(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    o->path.dl = 0.0;
    return strcmp(text, "auto") == 0
               ? 0
               : fl_option_number("dl", text, 1e-60, 1e60, "auto or a length above 0", &o->path.dl, err);
}

static int set_damping(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (strcmp(text, "kinetic") == 0) o->path.damping = FL_RELAXATION_KINETIC;
    else if (strcmp(text, "adaptive") == 0) o->path.damping = FL_RELAXATION_ADAPTIVE;
    else if (strncmp(text, "viscous:", 8) == 0) {
        o->path.damping = FL_RELAXATION_VISCOUS;
        return fl_option_number("damping", text + 8, 1e-9, 1.9, "viscous:C with C above 0 and below 2",
                                &o->path.c, err);
    } else
        return fl_fail(err, FL_USAGE, "--damping is \"%.60s\", expected kinetic, adaptive or viscous:C",
                       text);
    return 0;
}

static int set_until(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    const char *equals = strrchr(text, '=');
    struct until *u = &o->until[o->untils];
    if (o->untils == UNTIL_MAX)
        return fl_fail(err, FL_USAGE, "--until is given more than %d times", UNTIL_MAX);
    if (!equals || equals == text || (size_t)(equals - text) >= sizeof u->name ||
        fl_number_f64(equals + 1, &u->value))
        return fl_fail(err, FL_USAGE,
                       "--until is \"%.60s\", expected COLUMN=VALUE, as apex.z=-50 or lambda=1", text);
    memcpy(u->name, text, (size_t)(equals - text));
    u->name[equals - text] = '\0';
    o->untils++;
    return 0;
}

static int add_watch(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (o->watches == WATCH_MAX) return fl_fail(err, FL_USAGE, "--watch names more than %d", WATCH_MAX);
    o->watch[o->watches] = fl_alloc_text(text, err);
    if (!o->watch[o->watches]) return -1;
    o->watches++;
    return 0;
}

static int set_watch(void *options, const char *text, fl_err *err)
{
    return fl_option_each("watch", text, add_watch, options, err);
}

static int add_shape(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (o->shapes == SHAPES_MAX)
        return fl_fail(err, FL_USAGE, "--shapes names more than %d points", SHAPES_MAX);
    return fl_option_integer("shapes", text, 1, INT32_MAX, &o->shape_at[o->shapes++], err);
}

static int set_shapes(void *options, const char *text, fl_err *err)
{
    return fl_option_each("shapes", text, add_shape, options, err);
}

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

#define AT(member) offsetof(struct options, member)

static const fl_option OPTION[] = {
    {.word = "first",
     .argument = "F",
     .help = "load factor of the first point, below the limit: 0.02 or 2% (2%)",
     .kind = FL_OPTION_CALL,
     .call = set_first},
    {.word = "dl",
     .argument = "L",
     .help = "increment of the constraint, or auto (auto)",
     .kind = FL_OPTION_CALL,
     .call = set_increment},
    {.word = "dl-most",
     .argument = "L",
     .help = "its largest value where it is chosen",
     .kind = FL_OPTION_NUMBER,
     .at = AT(path.dl_most),
     .lo = 0.0,
     .hi = 1e60,
     .expected = "a length not below 0"},
    {.word = "resolution",
     .argument = "R",
     .help = "distance of the load factor from the line of the last two points,\n"
             "over its largest value, that dl is chosen for (0.01)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(path.resolution),
     .lo = 1e-6,
     .hi = 1.0,
     .expected = "a number from 1e-6 to 1"},
    {.word = "until",
     .argument = "COLUMN=V",
     .help = "end at the first point where the column reaches V; may come again",
     .kind = FL_OPTION_CALL,
     .call = set_until},
    {.word = "points",
     .argument = "N",
     .help = "end after N points (1000)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(points),
     .lo = 1,
     .hi = 1000000},
    {.word = "constraint",
     .argument = "C",
     .help = "total, increment, displacement or load (total)",
     .kind = FL_OPTION_CHOICE,
     .at = AT(constraint),
     .choice = CONSTRAINTS},
    {.word = "control",
     .argument = "NODE.x",
     .help = "hold the displacement of this loaded freedom: displacement control of it",
     .kind = FL_OPTION_FILE,
     .at = AT(control)},
    {.word = "predictor",
     .argument = "P",
     .help = "chord, or load: --load-steps of --load-step each (chord)",
     .kind = FL_OPTION_CHOICE,
     .at = AT(predictor),
     .choice = PREDICTORS},
    {.word = "load-step",
     .argument = "F",
     .help = "load factor of one load step (0.001)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(path.load_step),
     .lo = 1e-12,
     .hi = 1e6,
     .expected = "a number above 0"},
    {.word = "load-steps",
     .argument = "N",
     .help = "load steps of a point (10)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(load_steps),
     .lo = 1,
     .hi = 1000000},
    {.word = "damping",
     .argument = "D",
     .help = "kinetic, adaptive or viscous:C (kinetic)",
     .kind = FL_OPTION_CALL,
     .call = set_damping},
    {.word = "tolerance",
     .argument = "X",
     .help = "unbalanced force of a point, over load and largest load factor (1e-4)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(path.chi),
     .lo = 1e-12,
     .hi = 0.1,
     .expected = "a number from 1e-12 to 0.1"},
    {.word = "max-steps",
     .argument = "N",
     .help = "steps after which a point is begun again with half dl (chosen)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(max_steps),
     .lo = 1,
     .hi = INT32_MAX},
    {.word = "watch",
     .argument = "LIST",
     .help = "displacements NODE.x to .rz and forces NODE.fx to .mz, with commas\n"
             "(displacements along the loads)",
     .kind = FL_OPTION_CALL,
     .call = set_watch},
    {.word = "scatter",
     .argument = "A",
     .help = "offset every free node by A times a normal number along x, y and z",
     .kind = FL_OPTION_NUMBER,
     .at = AT(scatter),
     .lo = 0.0,
     .hi = 1e60,
     .expected = "a length not below 0"},
    {.word = "seed", .argument = "N", .help = "of --scatter (1)", .kind = FL_OPTION_CALL, .call = set_seed},
    {.word = "shape",
     .argument = "FILE",
     .help = "offset the nodes by the displacements of a table of --plot",
     .kind = FL_OPTION_FILE,
     .at = AT(shape)},
    {.word = "amplitude",
     .argument = "A",
     .help = "largest offset of --shape",
     .kind = FL_OPTION_NUMBER,
     .at = AT(amplitude),
     .lo = -1e60,
     .hi = 1e60,
     .expected = "a length"},
    {.word = "plot",
     .argument = "DIR",
     .help = "draw load against displacement, and shapes, into a folder",
     .kind = FL_OPTION_FILE,
     .at = AT(plot)},
    {.word = "reference",
     .argument = "FILE",
     .help = "curve to draw beside it: along and lambda, two columns",
     .kind = FL_OPTION_FILE,
     .at = AT(reference)},
    {.word = "shapes",
     .argument = "LIST",
     .help = "points whose shape is drawn, with commas",
     .kind = FL_OPTION_CALL,
     .call = set_shapes},
    {.word = "frames",
     .argument = "FILE",
     .help = "write the shape of every point as a frame of ice-view",
     .kind = FL_OPTION_FILE,
     .at = AT(frames)},
    {.word = "format",
     .argument = "F",
     .help = "of pictures: svg or png (svg)",
     .kind = FL_OPTION_CALL,
     .call = set_format},
    {.word = "checkpoint",
     .argument = "FILE",
     .help = "write the state at the end, or when stopped by a signal",
     .kind = FL_OPTION_FILE,
     .at = AT(checkpoint)},
    {.word = "resume",
     .argument = "FILE",
     .help = "go on from such a state, with the same model and options",
     .kind = FL_OPTION_FILE,
     .at = AT(resume)},
    {.word = "modes",
     .argument = "N",
     .help = "write the N lowest modes about the start, in place of the path",
     .kind = FL_OPTION_INTEGER,
     .at = AT(modes),
     .lo = 1,
     .hi = FL_MEMBER_MODES_MOST},
    {.word = "ratio",
     .argument = "Z",
     .help = "damping ratio in the table of modes (0)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(ratio),
     .lo = 0.0,
     .hi = 1.0,
     .expected = "a number from 0 to 1"},
    FL_COMMON_OPTIONS(struct options, "write the table to FILE (standard output)", "compress it",
                      "threads of models with thousands of balls (those of OMP_NUM_THREADS, or all)",
                      "no summary on standard error", "a line for each point on standard error"),
};

static const fl_option_table TABLE = {"arc-path", USAGE, OPTION, set_model, 1};

int options_parse(struct options *o, int argc, char **argv, fl_err *err)
{
    *o = (struct options){
        .path = fl_path_defaults(), .points = 1000, .load_steps = 10, .seed = 1, .format = "svg", .out = "-"};
    if (fl_options_read(&TABLE, o, NULL, argc, argv, err)) return -1;
    if (o->ended) return 0;
    o->path.constraint = (enum fl_arc_constraint)o->constraint;
    o->path.predictor = (enum fl_path_predictor)o->predictor;
    o->path.load_steps = o->load_steps;
    o->path.max_steps = o->max_steps;
    if (o->control && o->constraint != FL_ARC_TOTAL && o->constraint != FL_ARC_DISPLACEMENT)
        return fl_fail(err, FL_USAGE, "--control is displacement control, --constraint %.20s is another",
                       CONSTRAINTS[o->constraint]);
    if (o->control) o->path.constraint = FL_ARC_DISPLACEMENT;
    for (int k = 0; k < o->untils; k++)
        if (strcmp(o->until[k].name, "lambda") == 0) o->path.last = o->until[k].value;
    if (!o->model) return fl_fail(err, FL_USAGE, "no model, expected a file of kind members");
    if (o->ratio > 0.0 && !o->modes)
        return fl_fail(err, FL_USAGE, "--ratio needs --modes, of whose table it is a column");
    if (o->frames && o->resume)
        return fl_fail(err, FL_USAGE, "--frames has all points from the first on, --resume is not for it");
    if (o->modes && (o->plot || o->frames || o->checkpoint || o->resume || o->watches || o->untils))
        return fl_fail(err, FL_USAGE,
                       "--modes follows no path: --plot, --frames, --checkpoint, --resume, --watch and "
                       "--until are not for it");
    if (o->reference && !o->plot)
        return fl_fail(err, FL_USAGE, "--reference needs --plot, the folder of the picture");
    if (o->shapes && !o->plot)
        return fl_fail(err, FL_USAGE, "--shapes needs --plot, the folder of the pictures");
    if ((o->shape != NULL) != (o->amplitude != 0.0))
        return fl_fail(err, FL_USAGE, "--shape and --amplitude come together");
    return 0;
}

void options_free(struct options *o)
{
    for (int k = 0; k < o->watches; k++) free(o->watch[k]);
    o->watches = 0;
}

static void add_option(fl_history_line *by, const char *name, double x, double usual)
{
    char text[FL_NUMBER_LEN];
    if (x != usual) fl_history_line_add(by, "%s %s", name, fl_number_text(x, text));
}

void options_by(const struct options *o, fl_history_line *by)
{
    const fl_path_options usual = fl_path_defaults(), *p = &o->path;
    fl_history_line_start(by, "arc-path");
    fl_history_line_word(by, "", o->model);
    add_option(by, "--first", p->first, usual.first);
    add_option(by, "--dl", p->dl, usual.dl);
    add_option(by, "--dl-most", p->dl_most, usual.dl_most);
    add_option(by, "--resolution", p->resolution, usual.resolution);
    if (p->constraint != usual.constraint)
        fl_history_line_add(by, "--constraint %s", CONSTRAINTS[p->constraint]);
    if (o->control) fl_history_line_word(by, "--control ", o->control);
    if (p->predictor != usual.predictor) {
        fl_history_line_add(by, "--predictor %s --load-steps %lld", PREDICTORS[p->predictor],
                            (long long)p->load_steps);
        add_option(by, "--load-step", p->load_step, -1.0);
    }
    if (p->damping == FL_RELAXATION_ADAPTIVE) fl_history_line_add(by, "--damping adaptive");
    if (p->damping == FL_RELAXATION_VISCOUS) add_option(by, "--damping viscous, c", p->c, -1.0);
    add_option(by, "--tolerance", p->chi, usual.chi);
    add_option(by, "--scatter", o->scatter, 0.0);
    if (o->scatter > 0.0) fl_history_line_add(by, "--seed %llu", (unsigned long long)o->seed);
    if (o->modes) fl_history_line_add(by, "--modes %d", (int)o->modes);
    add_option(by, "--ratio", o->ratio, 0.0);
    if (o->shape) {
        fl_history_line_word(by, "--shape ", o->shape);
        add_option(by, "--amplitude", o->amplitude, 0.0);
    }
}
