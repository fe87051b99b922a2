/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <getopt.h>
#include <string.h>
#include "base/number_text.h"
#include "base/option.h"
#include "options.h"

static const char HELP[] =
    "usage: dem-solve [options] SCENE\n"
    "       dem-solve [options] --resume CHECKPOINT\n"
    "Move ice and water of a scene through time; the load on the structure goes to standard output.\n"
    "SCENE is a scene file, scene(5); - is standard input.\n"
    "\n"
    "  -s, --set KEY=VALUE     change a key of the scene, section.key=value; may be repeated\n"
    "  -i, --ice FILE          the ice, instead of ice.file; - is standard input\n"
    "  -S, --structure FILE    the structure, instead of structure.file; - is standard input\n"
    "  -o, --output FILE       write the loads there, - is standard output\n"
    "  -R, --resume FILE       go on with the run whose checkpoint this is\n"
    "  -r, --report FILE       write the closing report there instead of standard error\n"
    "  -e, --explain KEY       what a key of a scene means, its unit and default; all of a section\n"
    "      --echo              print the scene with every default, and stop\n"
    "      --plan              print which stages the scene needs, step, memory, expected time; and stop\n"
    "      --probe WITHIN      print the contacts of all pairs nearer than WITHIN metres at the start; and "
    "stop\n"
    "  -z, --gzip              compress the loads\n"
    "  -j, --threads N         threads, instead of run.threads; the result is the same for any number\n"
    "  -q, --quiet             no report and no progress on standard error\n"
    "  -v, --verbose           progress also where standard error is not a terminal\n"
    "  -h, --help              this text\n"
    "      --version           the version\n";

enum { ECHO = 256, PLAN, PROBE, VERSION };

static const struct option LONG[] = {{"set", required_argument, NULL, 's'},
                                     {"ice", required_argument, NULL, 'i'},
                                     {"structure", required_argument, NULL, 'S'},
                                     {"output", required_argument, NULL, 'o'},
                                     {"resume", required_argument, NULL, 'R'},
                                     {"report", required_argument, NULL, 'r'},
                                     {"explain", required_argument, NULL, 'e'},
                                     {"echo", no_argument, NULL, ECHO},
                                     {"plan", no_argument, NULL, PLAN},
                                     {"probe", required_argument, NULL, PROBE},
                                     {"gzip", no_argument, NULL, 'z'},
                                     {"threads", required_argument, NULL, 'j'},
                                     {"quiet", no_argument, NULL, 'q'},
                                     {"verbose", no_argument, NULL, 'v'},
                                     {"help", no_argument, NULL, 'h'},
                                     {"version", no_argument, NULL, VERSION},
                                     {NULL, 0, NULL, 0}};

static int take(struct options *o, int c, fl_err *err)
{
    switch (c) {
    case 's':
        if (o->sets == SETS_MAX) return fl_fail(err, FL_USAGE, "more than %d times --set", SETS_MAX);
        o->set[o->sets++] = optarg;
        return 0;
    case 'i': o->ice = optarg; return 0;
    case 'S': o->structure = optarg; return 0;
    case 'o': o->out = optarg; return 0;
    case 'R': o->resume = optarg; return 0;
    case 'r': o->report = optarg; return 0;
    case 'e': o->explain = optarg; return 0;
    case ECHO: o->echo = 1; return 0;
    case PLAN: o->plan = 1; return 0;
    case PROBE:
        if (fl_number_f64(optarg, &o->probe) || o->probe < 0.0)
            return fl_fail(err, FL_USAGE, "--probe is \"%.40s\", a distance in metres is expected", optarg);
        return 0;
    case 'z': o->gzip = 1; return 0;
    case 'j': return fl_option_whole("threads", optarg, 1, 1024, &o->threads, err);
    case 'q': o->quiet = 1; return 0;
    case 'v': o->verbose = 1; return 0;
    case 'h':
        fputs(HELP, stdout);
        o->ended = 1;
        return 0;
    case VERSION:
        fl_tool_version("dem-solve");
        o->ended = 1;
        return 0;
    default: return fl_fail(err, FL_USAGE, "see dem-solve --help");
    }
}

int options_parse(struct options *o, int argc, char **argv, fl_err *err)
{
    int c;
    *o = (struct options){.probe = -1.0};
    opterr = 0;
    while ((c = getopt_long(argc, argv, ":s:i:S:o:R:r:e:zj:qvh", LONG, NULL)) != -1) {
        if (c == ':' || c == '?')
            return fl_option_unknown("dem-solve", LONG, c, optopt, argv[optind - 1], err);
        if (take(o, c, err)) return -1;
        if (o->ended) return 0;
    }
    if (optind < argc) o->scene = argv[optind++];
    if (optind < argc) return fl_fail(err, FL_USAGE, "\"%.40s\" is one file too many", argv[optind]);
    if (o->resume && (o->scene || o->ice || o->structure || o->plan || o->probe >= 0.0 || o->gzip))
        return fl_fail(
            err, FL_USAGE,
            "--resume goes on with what its checkpoint holds: no scene, --ice, --structure, --gzip, "
            "--plan or --probe is expected");
    if (!o->scene && !o->explain && !o->resume)
        return fl_fail(err, FL_USAGE, "a scene file is wanted; see dem-solve --help");
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
    for (int k = 0; k < o->sets; k++)
        if (strncmp(o->set[k], "run.threads", 11) != 0 && strncmp(o->set[k], "output.", 7) != 0)
            fl_history_line_add(by, "--set '%s'", o->set[k]);
    fl_history_line_word(by, "", base_name(o->scene));
}
