/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "options.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/number_text.h"
#include "base/option.h"
#include "base/output_guard.h"
#include "out/packed_frames.h"

static const char USAGE[] =
    "usage: ice-view [options] FILE\n"
    "Shows what dem-solve computed: animation(5), state(5), g-polys(5) or g_struct(5).\n"
    "Without -o, --movie, --html, --vtk, --text, --packed or --info a window opens.\n"
    "\n";

static const char *const COMPONENTS[] = {"fx", "fy", "fz", "fh", NULL};

static int set_input(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (o->in) return fl_fail(err, FL_USAGE, "two inputs, %.60s and %.60s; one is expected", o->in, text);
    o->in = text;
    return 0;
}

static int set_look(void *options, const char *text, fl_err *err)
{
    return fl_look_read(&((struct options *)options)->look, text, err);
}

static int set_key(void *options, const char *text, fl_err *err)
{
    char key[80];
    const char *equals = strchr(text, '=');
    if (!equals || (size_t)(equals - text) >= sizeof key)
        return fl_fail(err, FL_USAGE, "--set is \"%.60s\", expected section.key=value, as water.shown=no",
                       text);
    memcpy(key, text, (size_t)(equals - text));
    key[equals - text] = '\0';
    return fl_look_set(&((struct options *)options)->look, key, equals + 1, "--set", FL_USAGE, err);
}

static int set_by(void *options, const char *text, fl_err *err)
{
    return fl_look_set(&((struct options *)options)->look, "colour.by", text, "--by", FL_USAGE, err);
}

static int set_size(void *options, const char *text, fl_err *err)
{
    fl_look *l = &((struct options *)options)->look;
    int w, h, end = 0;
    if (sscanf(text, "%6dx%6d%n", &w, &h, &end) != 2 || text[end] || w < 16 || h < 16 || w > 8192 || h > 8192)
        return fl_fail(err, FL_USAGE,
                       "--size is \"%.40s\", expected WIDTHxHEIGHT, each from 16 to 8192 pixels", text);
    l->picture.width = w;
    l->picture.height = h;
    return 0;
}

struct standard_view {
    const char *name;
    double azimuth, elevation;
    int parallel;
};
static const struct standard_view VIEW[] = {{"oblique", -125, 32, 0},
                                            {"plan", -90, 90, 1},
                                            {"side", -90, 0, 1},
                                            {"drift", 180, 12, 0},
                                            {"front", 0, 12, 0}};

static int set_view(void *options, const char *text, fl_err *err)
{
    fl_look *l = &((struct options *)options)->look;
    for (size_t k = 0; k < sizeof VIEW / sizeof VIEW[0]; k++) {
        if (strcmp(text, VIEW[k].name) != 0) continue;
        l->view.azimuth = VIEW[k].azimuth;
        l->view.elevation = VIEW[k].elevation;
        l->view.parallel = VIEW[k].parallel;
        return 0;
    }
    return fl_fail(err, FL_USAGE, "--view is \"%.40s\", expected oblique, plan, side, drift or front", text);
}

static int set_component(void *options, const char *text, fl_err *err)
{
    int k;
    if (fl_option_choice("component", text, COMPONENTS, &k, err)) return -1;
    ((struct options *)options)->component = COMPONENTS[k];
    return 0;
}

/* BX,BQ */
static int set_bounds(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    double x[2];
    int n;
    if (fl_option_numbers("bounds", text, ',', 2, 2, 1e-9, 1.0, "two numbers from 1e-9 to 1, in m and rad", x,
                          &n, err))
        return -1;
    o->bound_x = x[0];
    o->bound_q = x[1];
    return o->bound_q > 0.1 ? fl_fail(err, FL_USAGE, "--bounds: a rotation of more than 0.1 rad is no bound")
                            : 0;
}

#define AT(member) offsetof(struct options, member)
#define TIME_ROW(WORD, MEMBER, HELP)                                                                         \
    {                                                                                                        \
        .word = WORD, .argument = "T", .help = HELP, .kind = FL_OPTION_NUMBER, .at = AT(MEMBER),             \
        .lo = -1e15, .hi = 1e15, .expected = "a time in seconds"                                             \
    }
#define FILE_ROW(WORD, MEMBER, ARGUMENT, HELP)                                                               \
    {                                                                                                        \
        .word = WORD, .argument = ARGUMENT, .help = HELP, .kind = FL_OPTION_FILE, .at = AT(MEMBER)           \
    }

static const fl_option OPTION[] = {
    TIME_ROW("at", at, "time of the picture (the last frame)"),
    FILE_ROW("movie", movie, "FILE", "write a film: .mp4, .mkv, .mov or .avi"),
    {.word = "fps",
     .argument = "N",
     .help = "pictures a second of the film (25)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(fps),
     .lo = 1,
     .hi = 240,
     .expected = "a number from 1 to 240"},
    TIME_ROW("from", from, "first time of a film, page or --vtk (the first frame)"),
    TIME_ROW("to", to, "last time of it (the last frame)"),
    {.word = "times",
     .argument = "X",
     .help = "seconds of the run for a second of the film (1)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(times),
     .lo = 1e-6,
     .hi = 1e6,
     .expected = "a number above 0"},
    {.word = "size",
     .argument = "WxH",
     .help = "of pictures and films (1280x720)",
     .kind = FL_OPTION_CALL,
     .call = set_size},
    {.word = "view",
     .argument = "V",
     .help = "oblique, plan, side, drift or front (oblique)",
     .kind = FL_OPTION_CALL,
     .call = set_view},
    {.word = "by",
     .argument = "WHAT",
     .help = "colour of the ice: ice, one, speed, spin, diameter, thickness, height,\n"
             "number, group, force, damage, column (ice)",
     .kind = FL_OPTION_CALL,
     .call = set_by},
    {.word = "look",
     .argument = "FILE",
     .help = "settings, look(5); may come again",
     .kind = FL_OPTION_CALL,
     .call = set_look},
    {.word = "set",
     .argument = "KEY=V",
     .help = "one setting, as water.shown=no; may come again",
     .kind = FL_OPTION_CALL,
     .call = set_key},
    {.word = "keys", .help = "print all settings with their defaults and meanings", .at = AT(keys)},
    FILE_ROW("save-look", save_look, "FILE", "write the settings of this picture, look(5)"),
    FILE_ROW("ice", ice, "FILE", "the ice file, g-polys(5): shapes of a state, groups"),
    FILE_ROW("structure", structure, "FILE", "a structure, g_struct(5), where the input has none"),
    FILE_ROW("scene", scene, "FILE", "the scene, scene(5): water level and waves"),
    FILE_ROW("loads", loads, "FILE", "load curve below the picture, loads(5)"),
    {.word = "component",
     .argument = "C",
     .help = "of the curve: fx, fy, fz or fh, horizontal (fx)",
     .kind = FL_OPTION_CALL,
     .call = set_component},
    {.word = "part",
     .argument = "NAME",
     .help = "of the curve (the sum of all)",
     .kind = FL_OPTION_TEXT,
     .at = AT(part)},
    FILE_ROW("contacts", contacts, "FILE", "force chains as tubes, contacts(5)"),
    FILE_ROW("bonds", bonds, "FILE", "damaged and broken faces, bonds(5)"),
    FILE_ROW("table", table, "FILE", "any table with columns body and colour.column, of --by column"),
    FILE_ROW("html", html, "FILE", "write a page that plays in a browser"),
    FILE_ROW("vtk", vtk, "DIR", "write files for ParaView into a folder: .pvd and .vtp"),
    FILE_ROW("panels", panels, "FILE", "of --vtk: loads on the panels of the structure, panels(5)"),
    {.word = "points", .help = "with --vtk: centres with orientation instead of shapes", .at = AT(points)},
    {.word = "every",
     .argument = "N",
     .help = "each N-th frame, of --html, --vtk, --text and --packed (1)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(every),
     .lo = 1,
     .hi = 1000000000},
    FILE_ROW("text", text, "FILE", "write the frames as text, animation(5) version 1"),
    FILE_ROW("packed", packed, "FILE", "write the frames packed, animation(5) version 2"),
    {.word = "bounds",
     .argument = "BX,BQ",
     .help = "largest errors of --packed in m and rad (1e-5,1e-5)",
     .kind = FL_OPTION_CALL,
     .call = set_bounds},
    {.word = "info", .help = "print what the file holds", .at = AT(info)},
    FL_COMMON_OPTIONS(struct options, "write a picture at --at: .png, .bmp or .jpg", "compress --text",
                      "threads that draw (all)", "no progress, no warnings",
                      "say the keys and clicks of the window"),
};

/* No output over an input, or over another output. */
static int check_files(const struct options *o, fl_err *err)
{
    const fl_named_path out[] = {{"--output", o->out},    {"--movie", o->movie},
                                 {"--html", o->html},     {"--text", o->text},
                                 {"--packed", o->packed}, {"--save-look", o->save_look}};
    const fl_named_path in[] = {{NULL, o->in},    {NULL, o->ice},   {NULL, o->structure},
                                {NULL, o->table}, {NULL, o->loads}, {NULL, o->contacts},
                                {NULL, o->bonds}, {NULL, o->scene}, {NULL, o->panels}};
    return fl_output_guard_check(out, sizeof out / sizeof out[0], in, sizeof in / sizeof in[0], err);
}

static const fl_option_table TABLE = {"ice-view", USAGE, OPTION, set_input, 1};

int options_parse(struct options *o, int argc, char **argv, fl_err *err)
{
    *o = (struct options){.at = NAN,
                          .from = NAN,
                          .to = NAN,
                          .fps = 25,
                          .times = 1,
                          .component = "fx",
                          .every = 1,
                          .bound_x = FL_PACKED_BOUND_X,
                          .bound_q = FL_PACKED_BOUND_Q,
                          .look = fl_look_defaults()};
    if (fl_options_read(&TABLE, o, NULL, argc, argv, err)) return -1;
    if (o->ended || o->keys) return 0;
    if (!o->in)
        return fl_fail(err, FL_USAGE, "no input, expected a file of frames, of ice or of a structure");
    if (o->points && !o->vtk) return fl_fail(err, FL_USAGE, "--points needs --vtk");
    if (o->panels && !o->vtk) return fl_fail(err, FL_USAGE, "--panels needs --vtk");
    if (o->part && !o->loads) return fl_fail(err, FL_USAGE, "--part needs --loads");
    if (o->look.colour.by == FL_BY_COLUMN && (!o->table || !o->look.colour.column[0]))
        return fl_fail(err, FL_USAGE, "--by column needs --table FILE and --set colour.column=NAME");
    if (o->look.colour.by == FL_BY_FORCE && !o->contacts)
        return fl_fail(err, FL_USAGE, "--by force needs --contacts FILE");
    if (o->look.colour.by == FL_BY_DAMAGE && !o->bonds)
        return fl_fail(err, FL_USAGE, "--by damage needs --bonds FILE");
    if (o->look.colour.by == FL_BY_GROUP && !o->ice)
        return fl_fail(err, FL_USAGE, "--by group needs --ice FILE");
    if (o->from > o->to) return fl_fail(err, FL_USAGE, "--from %g is after --to %g", o->from, o->to);
    if (check_files(o, err)) return -1;
    o->window =
        !o->out && !o->movie && !o->html && !o->vtk && !o->text && !o->packed && !o->info && !o->save_look;
    return 0;
}

void options_by(const struct options *o, fl_history_line *by)
{
    char text[FL_NUMBER_LEN];
    fl_history_line_start(by, "ice-view");
    if (o->every > 1) fl_history_line_add(by, "--every %d", o->every);
    if (!isnan(o->from)) fl_history_line_add(by, "--from %s", fl_number_text(o->from, text));
    if (!isnan(o->to)) fl_history_line_add(by, "--to %s", fl_number_text(o->to, text));
}
