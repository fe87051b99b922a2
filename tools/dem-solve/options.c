/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/option.h"
#include "options.h"

static const char USAGE[] =
    "usage: dem-solve [options] SCENE\n"
    "       dem-solve [options] --resume CHECKPOINT\n"
    "       dem-solve --again TABLE\n"
    "Move ice and water of a scene through time; the load on the structure goes to standard output.\n"
    "SCENE is a scene file, scene(5); - is standard input.\n"
    "\n";

static int add_set(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (o->sets == SETS_MAX) return fl_fail(err, FL_USAGE, "--set is given more than %d times", SETS_MAX);
    o->set[o->sets++] = text;
    return 0;
}

static int set_scene(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (o->scene) return fl_fail(err, FL_USAGE, "\"%.40s\" is one file too many", text);
    o->scene = text;
    return 0;
}

#define AT(member) offsetof(struct options, member)

static const fl_option OPTION[] = {
    {.word = "set",
     .letter = 's',
     .argument = "KEY=VALUE",
     .help = "change a key of the scene, section.key=value; may be repeated",
     .kind = FL_OPTION_CALL,
     .call = add_set},
    {.word = "ice",
     .letter = 'i',
     .argument = "FILE",
     .help = "the ice, instead of ice.file; - is standard input",
     .kind = FL_OPTION_TEXT,
     .at = AT(ice)},
    {.word = "structure",
     .letter = 'S',
     .argument = "FILE",
     .help = "the structure, instead of structure.file; - is standard input",
     .kind = FL_OPTION_TEXT,
     .at = AT(structure)},
    {.word = "direction",
     .argument = "ANGLE",
     .help = "ice, current, wind and waves come turned by this angle in platform axes, 30deg:\n"
             "structure.direction",
     .kind = FL_OPTION_TEXT,
     .at = AT(direction)},
    {.word = "resume",
     .letter = 'R',
     .argument = "FILE",
     .help = "continue the run whose checkpoint this is",
     .kind = FL_OPTION_TEXT,
     .at = AT(resume)},
    {.word = "again",
     .argument = "TABLE",
     .help = "print the scene of the run that wrote this table, and stop",
     .kind = FL_OPTION_TEXT,
     .at = AT(again)},
    {.word = "report",
     .letter = 'r',
     .argument = "FILE",
     .help = "write the closing report there instead of standard error",
     .kind = FL_OPTION_TEXT,
     .at = AT(report)},
    {.word = "explain",
     .letter = 'e',
     .argument = "KEY",
     .help = "what a key of a scene means, its unit and default; all of a section",
     .kind = FL_OPTION_TEXT,
     .at = AT(explain)},
    {.word = "echo", .help = "print the scene with every default, and stop", .at = AT(echo)},
    {.word = "plan",
     .help = "print the stages that the scene needs, step, memory and expected time, and stop",
     .at = AT(plan)},
    {.word = "probe",
     .argument = "WITHIN",
     .help = "print the contacts at the start of all pairs nearer than WITHIN metres, and stop",
     .kind = FL_OPTION_NUMBER,
     .at = AT(probe),
     .lo = 0.0,
     .hi = HUGE_VAL,
     .expected = "a distance in metres"},
    {.word = "force",
     .help = "run values that no ice on earth has, and bodies that overlap or lie inside the structure",
     .at = AT(force)},
    {.word = "factor",
     .argument = "KEY",
     .help = "search the factor by which a strength may be divided until the model fails: friction,\n"
             "strength, or joint.NAME.friction, .cohesion, .tension; a table of trials",
     .kind = FL_OPTION_WORD,
     .at = AT(factor)},
    FL_COMMON_OPTIONS(struct options, "write the loads there, - is standard output", "compress the loads",
                      "threads, instead of run.threads; the result is the same for any number",
                      "no report and no progress on standard error",
                      "progress also where standard error is not a terminal"),
};

static const fl_option_table TABLE = {"dem-solve", USAGE, OPTION, set_scene, 0};

int options_parse(struct options *o, int argc, char **argv, fl_err *err)
{
    *o = (struct options){.probe = -1.0};
    if (fl_options_read(&TABLE, o, NULL, argc, argv, err)) return -1;
    if (o->ended) return 0;
    if (o->resume && (o->factor || o->scene || o->ice || o->direction || o->structure || o->plan ||
                      o->probe >= 0.0 || o->gzip))
        return fl_fail(err, FL_USAGE,
                       "--resume continues what its checkpoint holds: it excludes a scene, --ice, "
                       "--structure, --direction, "
                       "--gzip, --plan and --probe");
    if (o->again && (o->scene || o->resume || o->ice || o->structure))
        return fl_fail(
            err, FL_USAGE,
            "--again takes the scene of its table: it excludes a scene, --ice, --structure and --resume");
    if (!o->scene && !o->explain && !o->resume && !o->again)
        return fl_fail(err, FL_USAGE, "expected a scene file; see dem-solve --help");
    return 0;
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

void options_by(const struct options *o, fl_history_line *by)
{
    fl_history_line_start(by, "dem-solve");
    if (o->ice) fl_history_line_word(by, "--ice ", base_name(o->ice));
    if (o->structure) fl_history_line_word(by, "--structure ", base_name(o->structure));
    if (o->direction) fl_history_line_word(by, "--direction ", o->direction);
    for (int k = 0; k < o->sets; k++)
        if (strncmp(o->set[k], "run.threads", 11) != 0 && strncmp(o->set[k], "output.", 7) != 0)
            fl_history_line_add(by, "--set '%s'", o->set[k]);
    fl_history_line_word(by, "", base_name(o->scene));
}
