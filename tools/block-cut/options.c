/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "options.h"
#include <math.h>
#include <string.h>
#include "base/number_text.h"
#include "base/option.h"

static const char USAGE[] =
    "usage: block-cut --in MODEL [--joint 'KEY=VALUE ...'] [options]\n"
    "Cuts a model of rock into blocks by joint sets: convex blocks, the faces that lie on each other, and a\n"
    "certificate; g-polys(5).\n"
    "\n";

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

static int add_joint(void *options, const char *text, fl_err *err)
{
    struct options *o = options;
    if (o->joint_texts == REGIONS_MAX)
        return fl_fail(err, FL_USAGE, "more than %d options --joint, --joints FILE is expected", REGIONS_MAX);
    o->joint_text[o->joint_texts++] = text;
    return fl_joint_sets_add(&o->joints, text, "--joint", err);
}

static int add_joint_file(void *options, const char *text, fl_err *err)
{
    struct options *o = options;
    if (o->joint_file) return fl_fail(err, FL_USAGE, "--joints is given twice");
    o->joint_file = text;
    return fl_joint_sets_read(&o->joints, text, err);
}

static int add_region(struct options *o, const char *option, const char *text, int cut, fl_err *err)
{
    const char *is = strchr(text, '=');
    if (!is || is == text || !is[1] || is - text >= (long)sizeof o->region[0].name ||
        strcspn(text, " \t") < strlen(text))
        return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", expected NAME=REGION", option, text);
    if (o->regions == REGIONS_MAX)
        return fl_fail(err, FL_USAGE, "more than %d regions and groups", REGIONS_MAX);
    struct named_region *r = &o->region[o->regions++];
    memcpy(r->name, text, (size_t)(is - text));
    r->in = is + 1;
    r->cut = cut;
    return 0;
}

static int set_region(void *options, const char *text, fl_err *err)
{
    return add_region(options, "region", text, 1, err);
}
static int set_group(void *options, const char *text, fl_err *err)
{
    return add_region(options, "group", text, 0, err);
}

static int add_removal(void *options, const char *text, fl_err *err)
{
    struct options *o = options;
    if (o->removes == REGIONS_MAX)
        return fl_fail(err, FL_USAGE, "more than %d options --delete", REGIONS_MAX);
    return fl_option_word("delete", text, &o->remove[o->removes++], err);
}

static int set_range(const char *word, const char *text, double *x, fl_err *err)
{
    int n;
    if (fl_option_numbers(word, text, ',', 2, 2, -1e9, 1e9, "two coordinates in metres, A,B", x, &n, err))
        return -1;
    return x[0] < x[1] ? 0 : fl_fail(err, FL_USAGE, "--%s is \"%.60s\", expected A,B with A < B", word, text);
}

static int set_height(void *options, const char *text, fl_err *err)
{
    return set_range("height", text, ((struct options *)options)->z, err);
}

static int set_depth(void *options, const char *text, fl_err *err)
{
    return set_range("depth", text, ((struct options *)options)->y, err);
}

#define AT(member) offsetof(struct options, member)

static const fl_option OPTION[] = {
    {.word = "in",
     .argument = "MODEL",
     .help = "box:X0,Y0,Z0,X1,Y1,Z1, or a file: a closed mesh, or an outline",
     .kind = FL_OPTION_FILE,
     .at = AT(in)},
    {.word = "height",
     .argument = "Z0,Z1",
     .help = "the outline is a plan in x and y, between these heights",
     .kind = FL_OPTION_CALL,
     .call = set_height},
    {.word = "depth",
     .argument = "Y0,Y1",
     .help = "the outline is a profile in x and z, between these y",
     .kind = FL_OPTION_CALL,
     .call = set_depth},
    {.word = "joint",
     .argument = "SET",
     .help = "a joint set: dip=, dd= (dip direction), spacing=, origin=X,Y,Z, n=, name=,\n"
             "persistence=, meaning=skip|glue, radius=, fisher=, deviation=,\n"
             "law=normal|log-normal; may be repeated",
     .kind = FL_OPTION_CALL,
     .call = add_joint},
    {.word = "joints",
     .argument = "FILE",
     .help = "a file of joint sets, one a row",
     .kind = FL_OPTION_CALL,
     .call = add_joint_file},
    {.word = "region",
     .argument = "NAME=R",
     .help = "cut out a region (as --in) and give its blocks this group; may be repeated",
     .kind = FL_OPTION_CALL,
     .call = set_region},
    {.word = "delete",
     .argument = "NAME",
     .help = "leave out the blocks of a region",
     .kind = FL_OPTION_CALL,
     .call = add_removal},
    {.word = "group",
     .argument = "NAME=R",
     .help = "give this group to blocks whose centroid is in a region; nothing is cut",
     .kind = FL_OPTION_CALL,
     .call = set_group},
    {.word = "others",
     .argument = "NAME",
     .help = "group of all other blocks",
     .kind = FL_OPTION_WORD,
     .at = AT(group)},
    {.word = "radius",
     .argument = "R",
     .help = "dilation radius of the blocks [m] (0.001 of the least spacing)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(radius),
     .lo = 0.0,
     .hi = 1e6,
     .expected = "a length not below 0"},
    {.word = "min-thickness",
     .argument = "T",
     .help = "a thinner block is merged with a neighbour, or left out [m] (2.2 R)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(min_thickness),
     .lo = 0.0,
     .hi = 1e6,
     .expected = "a length not below 0"},
    {.word = "min-volume",
     .argument = "V",
     .help = "so is a smaller one [m3] (0)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(min_volume),
     .lo = 0.0,
     .hi = 1e18,
     .expected = "a volume not below 0"},
    {.word = "keep-slivers", .help = "keep them; with --radius 0", .at = AT(keep_slivers)},
    {.word = "seed",
     .argument = "N",
     .help = "of persistence and scatter (1)",
     .kind = FL_OPTION_CALL,
     .call = set_seed},
    {.word = "material",
     .argument = "NAME",
     .help = "of the blocks",
     .kind = FL_OPTION_WORD,
     .at = AT(material)},
    {.word = "certificate",
     .argument = "FILE",
     .help = "write counts, volumes and areas beside those expected as a table",
     .kind = FL_OPTION_FILE,
     .at = AT(certificate)},
    {.word = "plot",
     .argument = "DIR",
     .help = "draw the plan, a section and an exploded view into a folder",
     .kind = FL_OPTION_FILE,
     .at = AT(plot)},
    {.word = "format",
     .argument = "F",
     .help = "of pictures: svg or png (svg)",
     .kind = FL_OPTION_CALL,
     .call = set_format},
    FL_COMMON_OPTIONS(struct options, "write the blocks to FILE (standard output)", "compress them",
                      "number of threads (those of OMP_NUM_THREADS, or all)",
                      "no certificate on standard error", "name each sliver on standard error"),
};

static const fl_option_table TABLE = {"block-cut", USAGE, OPTION, NULL, 0};

int options_parse(struct options *o, int argc, char **argv, fl_err *err)
{
    *o = (struct options){.z = {NAN, NAN},
                          .y = {NAN, NAN},
                          .radius = NAN,
                          .min_thickness = NAN,
                          .seed = 1,
                          .format = "svg",
                          .out = "-"};
    if (fl_options_read(&TABLE, o, NULL, argc, argv, err)) return -1;
    if (o->ended) return 0;
    if (!o->in) return fl_fail(err, FL_USAGE, "no model, --in is expected");
    if (!isnan(o->z[0]) && !isnan(o->y[0]))
        return fl_fail(err, FL_USAGE, "--height and --depth are given, one of them is expected");
    if (o->keep_slivers && !(o->radius == 0.0))
        return fl_fail(err, FL_USAGE, "--keep-slivers needs --radius 0: a sliver has no core");
    for (int32_t k = 0; k < o->removes; k++) {
        int known = 0;
        for (int32_t r = 0; r < o->regions; r++)
            known |= o->region[r].cut && strcmp(o->region[r].name, o->remove[k]) == 0;
        if (!known) return fl_fail(err, FL_USAGE, "--delete %.60s: no --region has that name", o->remove[k]);
    }
    return 0;
}

void options_free(struct options *o) { fl_joint_sets_free(&o->joints); }

static void add_number(fl_history_line *by, const char *name, double x)
{
    char text[FL_NUMBER_LEN];
    if (!isnan(x)) fl_history_line_add(by, "%s %s", name, fl_number_text(x, text));
}

static void add_pair(fl_history_line *by, const char *name, const double *x)
{
    char a[FL_NUMBER_LEN], b[FL_NUMBER_LEN];
    if (!isnan(x[0]))
        fl_history_line_add(by, "%s %s,%s", name, fl_number_text(x[0], a), fl_number_text(x[1], b));
}

void options_by(const struct options *o, fl_history_line *by)
{
    char text[700];
    fl_history_line_start(by, "block-cut");
    fl_history_line_word(by, "--in ", o->in);
    add_pair(by, "--height", o->z);
    add_pair(by, "--depth", o->y);
    for (int32_t k = 0; k < o->joint_texts; k++) fl_history_line_word(by, "--joint ", o->joint_text[k]);
    if (o->joint_file) fl_history_line_word(by, "--joints ", o->joint_file);
    for (int32_t k = 0; k < o->regions; k++) {
        snprintf(text, sizeof text, "%s=%.600s", o->region[k].name, o->region[k].in);
        fl_history_line_word(by, o->region[k].cut ? "--region " : "--group ", text);
    }
    for (int32_t k = 0; k < o->removes; k++) fl_history_line_word(by, "--delete ", o->remove[k]);
    add_number(by, "--radius", o->radius);
    add_number(by, "--min-thickness", o->min_thickness);
    if (o->min_volume > 0.0) add_number(by, "--min-volume", o->min_volume);
    if (o->keep_slivers) fl_history_line_add(by, "--keep-slivers");
    fl_history_line_add(by, "--seed %llu", (unsigned long long)o->seed);
}
