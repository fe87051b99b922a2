/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <getopt.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/option.h"
#include "geom/facet.h"
#include "options.h"

static const char HELP[] =
    "usage: struct-import [options] [FILE ...]\n"
    "Turn meshes and ready-made solids into a structure file (g_struct) for dem-solve.\n"
    "FILE is STL, OBJ, OFF, PLY, VTK, g_struct, or a mesh of finite elements: Abaqus, ANSYS, Gmsh, Nastran,\n"
    "recognised by content; - or nothing is standard input.\n"
    "\n"
    "      --cylinder R,Z0,Z1[,X,Y]      an upright cylinder about X,Y (0,0) from Z0 to Z1 [m]\n"
    "      --cone R0,Z0,R1,Z1[,X,Y]      an upright cone, cut where both radii are above 0 [m]\n"
    "      --box X0,Y0,Z0,X1,Y1,Z1       a box of 12 triangles [m]\n"
    "  -n, --name NAME         name of the next part; at the end, of the last one\n"
    "      --part PATTERN      import only parts and sets that match; * and ? are wildcards\n"
    "      --rename OLD=NEW    rename parts that match the pattern OLD; equal names are joined\n"
    "      --subdivide         split quadratic faces into 4, 6 or 8 triangles instead of 1 or 2\n"
    "  -f, --facets N          replace cylinders and cones by triangles, N per circle\n"
    "  -u, --unit UNIT         length unit of the files: mm, cm, m, in or ft (m)\n"
    "  -s, --scale S           multiply the coordinates of the files by S (1)\n"
    "      --up AXIS           axis that points up in the files, y or z (z)\n"
    "      --mirror AXIS       mirror the files in the plane across x, y or z\n"
    "      --rotate AX,AY,AZ,DEG  turn the files about an axis through the origin\n"
    "  -t, --translate X,Y,Z   then move the contents of the files [m]\n"
    "  -w, --weld TOL          merge vertices within TOL [m] (1e-6 of the part's diagonal)\n"
    "      --fill-holes N      close holes of up to N edges (0)\n"
    "      --fill SIZE         close holes whose box is up to SIZE [m] across (0)\n"
    "      --repair            join bodies that cross, rebuild patches that cross themselves\n"
    "      --simplify DISTANCE reduce triangles within DISTANCE [m] both ways\n"
    "      --remesh LENGTH[,D] edges of about LENGTH [m], within D (LENGTH / 10) both ways\n"
    "      --raw               no cleanup: weld only\n"
    "      --strict            status 1 if a defect remains\n"
    "      --to FORMAT         g_struct, stl (ASCII), stl-binary, obj, off, ply or vtp (g_struct)\n"
    "      --plot WHERE        draw three views, into FILE.png, FILE.svg or a folder (by gnuplot)\n"
    "  -o, --output FILE       write there, - is standard output\n"
    "  -z, --gzip              compress the output\n"
    "  -j, --threads N         threads of the search for crossings; does not affect the result\n"
    "  -q, --quiet             no table and no warnings on standard error\n"
    "  -v, --verbose           more details of the cleanup\n"
    "  -h, --help              this text\n"
    "      --version           the version\n";

enum {
    CYLINDER = 256,
    CONE,
    BOX,
    PART,
    RENAME,
    SUBDIVIDE,
    UP,
    FILL_HOLES,
    RAW,
    STRICT,
    TO,
    VERSION,
    MIRROR,
    PLOT,
    FILL,
    REPAIR,
    SIMPLIFY,
    REMESH,
    ROTATE
};

static const struct option LONG[] = {{"cylinder", required_argument, NULL, CYLINDER},
                                     {"cone", required_argument, NULL, CONE},
                                     {"box", required_argument, NULL, BOX},
                                     {"name", required_argument, NULL, 'n'},
                                     {"part", required_argument, NULL, PART},
                                     {"rename", required_argument, NULL, RENAME},
                                     {"subdivide", no_argument, NULL, SUBDIVIDE},
                                     {"facets", required_argument, NULL, 'f'},
                                     {"unit", required_argument, NULL, 'u'},
                                     {"scale", required_argument, NULL, 's'},
                                     {"up", required_argument, NULL, UP},
                                     {"mirror", required_argument, NULL, MIRROR},
                                     {"rotate", required_argument, NULL, ROTATE},
                                     {"translate", required_argument, NULL, 't'},
                                     {"weld", required_argument, NULL, 'w'},
                                     {"fill-holes", required_argument, NULL, FILL_HOLES},
                                     {"fill", required_argument, NULL, FILL},
                                     {"repair", no_argument, NULL, REPAIR},
                                     {"simplify", required_argument, NULL, SIMPLIFY},
                                     {"remesh", required_argument, NULL, REMESH},
                                     {"raw", no_argument, NULL, RAW},
                                     {"strict", no_argument, NULL, STRICT},
                                     {"to", required_argument, NULL, TO},
                                     {"plot", required_argument, NULL, PLOT},
                                     {"output", required_argument, NULL, 'o'},
                                     {"gzip", no_argument, NULL, 'z'},
                                     {"threads", required_argument, NULL, 'j'},
                                     {"quiet", no_argument, NULL, 'q'},
                                     {"verbose", no_argument, NULL, 'v'},
                                     {"help", no_argument, NULL, 'h'},
                                     {"version", no_argument, NULL, VERSION},
                                     {NULL, 0, NULL, 0}};

static const struct unit {
    const char *name;
    double metres;
} UNIT[] = {{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}, {"in", 0.0254}, {"ft", 0.3048}};

static const double FAR = 1e9; /* [m] largest coordinate; its square and cube stay exact in range */

/* Parse least .. most numbers separated by commas.  Returns their count, or -1. */
static int numbers(const char *option, const char *text, int least, int most, double *x, fl_err *err)
{
    char copy[400], odd[42] = "";
    int n = 0;
    if (strlen(text) >= sizeof copy) return fl_fail(err, FL_USAGE, "--%s is too long", option);
    strcpy(copy, text);
    for (char *p = copy, *end; p; p = end) {
        end = strchr(p, ',');
        if (end) *end++ = '\0';
        if (n < most && (fl_number_f64(p, &x[n]) || !(fabs(x[n]) <= FAR)) && !odd[0])
            snprintf(odd, sizeof odd, "%.40s", p[0] ? p : " ");
        n++;
    }
    const int right = n == most || n == least;
    if (right && !odd[0]) return n;
    if (right && most > 1)
        return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", and \"%s\" is no number from %g to %g", option,
                       text, odd, -FAR, FAR);
    if (least == most && least == 1)
        return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", a number is expected", option, text);
    if (least == most)
        return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", %d numbers with commas are expected", option, text,
                       least);
    return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", %d or %d numbers with commas are expected", option,
                   text, least, most);
}

/* Add an item; it gets the pending name. */
static int add_item(struct options *o, struct item it, const char **pending, fl_err *err)
{
    if (fl_grow(&o->item, &o->item_cap, (int64_t)o->items + 1, sizeof *o->item, err)) return -1;
    it.name = *pending;
    *pending = NULL;
    o->item[o->items++] = it;
    return 0;
}

/* --cylinder R,Z0,Z1[,X,Y] is --cone R,Z0,R,Z1[,X,Y]. */
static int round_solid(const char *option, const char *text, struct item *it, fl_err *err)
{
    const int cylinder = strcmp(option, "cylinder") == 0, least = cylinder ? 3 : 4;
    double x[6] = {0};
    const int n = numbers(option, text, least, least + 2, x, err);
    if (n < 0) return -1;
    const double *axis = n > least ? x + least : (const double[]){0.0, 0.0};
    const double r0 = x[0], z0 = x[1], r1 = cylinder ? x[0] : x[2], z1 = cylinder ? x[2] : x[3];
    if (r0 < 0.0 || r1 < 0.0 || !(r0 + r1 > 0.0))
        return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", radii >= 0 and not both 0 are expected", option,
                       text);
    if (!(z0 < z1)) return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", Z0 < Z1 is expected", option, text);
    *it = (struct item){.kind = cylinder ? ITEM_CYLINDER : ITEM_CONE, .text = text};
    it->cone = (fl_cone){v3(axis[0], axis[1], z0), v3(axis[0], axis[1], z1), r0, r1};
    return 0;
}

static int box(const char *text, struct item *it, fl_err *err)
{
    double x[6] = {0};
    if (numbers("box", text, 6, 6, x, err) < 0) return -1;
    *it = (struct item){.kind = ITEM_BOX, .text = text, .box = {v3(x[0], x[1], x[2]), v3(x[3], x[4], x[5])}};
    if (x[0] < x[3] && x[1] < x[4] && x[2] < x[5]) return 0;
    return fl_fail(err, FL_USAGE, "--box is \"%.60s\", X0 < X1, Y0 < Y1 and Z0 < Z1 is expected", text);
}

static int unit(struct options *o, const char *text, fl_err *err)
{
    for (size_t k = 0; k < sizeof UNIT / sizeof UNIT[0]; k++)
        if (strcmp(text, UNIT[k].name) == 0) {
            o->unit = UNIT[k].name;
            o->map.s = UNIT[k].metres;
            return 0;
        }
    return fl_fail(err, FL_USAGE, "--unit is \"%.60s\", one of mm cm m in ft is expected", text);
}

static int positive(const char *option, const char *text, double *x, fl_err *err)
{
    if (numbers(option, text, 1, 1, x, err) < 0) return -1;
    return *x > 0.0 ? 0
                    : fl_fail(err, FL_USAGE, "--%s is \"%.60s\", a number above 0 is expected", option, text);
}

static int pattern(struct options *o, const char *text, fl_err *err)
{
    if (*text == '\0') return fl_fail(err, FL_USAGE, "--part is empty, a pattern is expected");
    if (fl_grow(&o->part, &o->part_cap, (int64_t)o->parts + 1, sizeof *o->part, err)) return -1;
    o->part[o->parts++] = text;
    return 0;
}

/* OLD=NEW, divided at the last "=": names in decks contain any character, new names are chosen by the user.
 */
static int rename_as(struct options *o, const char *text, fl_err *err)
{
    const char *mid = strrchr(text, '=');
    struct alias *a;
    if (!mid || mid == text || mid[1] == '\0')
        return fl_fail(err, FL_USAGE, "--rename is \"%.60s\", OLD=NEW is expected", text);
    if (fl_grow(&o->alias, &o->alias_cap, (int64_t)o->aliases + 1, sizeof *o->alias, err)) return -1;
    a = &o->alias[o->aliases];
    *a = (struct alias){.text = text, .name = mid + 1, .old = fl_alloc(mid - text + 1, 1, err)};
    if (!a->old) return -1;
    memcpy(a->old, text, (size_t)(mid - text));
    o->aliases++;
    return 0;
}

/* The text is kept for the history. */
static int rotate(struct options *o, const char *text, fl_err *err)
{
    double x[4] = {0};
    if (numbers("rotate", text, 4, 4, x, err) < 0) return -1;
    if (!(v3_norm(v3(x[0], x[1], x[2])) > 0.0))
        return fl_fail(err, FL_USAGE, "--rotate is \"%.60s\", an axis of non-zero length is expected", text);
    if (o->turns == TURNS) return fl_fail(err, FL_USAGE, "--rotate is given more than %d times", TURNS);
    const fl_mat3 r = fl_affine_rotation(v3(x[0], x[1], x[2]), x[3]);
    o->rotate[o->turns++] = text;
    o->map.q = fl_affine_matrix_product(&r, &o->map.q);
    return 0;
}

/* --- up and --mirror apply before the turns of --rotate, whatever the order of the options. ------------- */
static void place_first(struct options *o)
{
    static const fl_mat3 y_up = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
    fl_mat3 first = fl_affine_identity().q;
    if (o->y_up) first = y_up;
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3 && o->mirror >> k & 1; j++) first.m[k][j] = -first.m[k][j];
    o->map.q = fl_affine_matrix_product(&o->map.q, &first);
}

static int remesh(struct options *o, const char *text, fl_err *err)
{
    double x[2] = {0};
    const int n = numbers("remesh", text, 1, 2, x, err);
    if (n < 0) return -1;
    o->remesh = x[0];
    o->remesh_within = n == 2 ? x[1] : x[0] / 10.0;
    if (o->remesh > 0.0 && o->remesh_within > 0.0) return 0;
    return fl_fail(err, FL_USAGE, "--remesh is \"%.60s\", lengths above 0 are expected", text);
}

static int format(struct options *o, const char *text, fl_err *err)
{
    static const char *const name[FORMATS] = {"g_struct", "stl", "stl-binary", "obj", "off", "ply", "vtp"};
    for (int k = 0; k < FORMATS; k++)
        if (strcmp(text, name[k]) == 0) {
            o->to = (enum format)k;
            return 0;
        }
    return fl_fail(err, FL_USAGE,
                   "--to is \"%.60s\", one of g_struct stl stl-binary obj off ply vtp is expected", text);
}

static int apply(struct options *o, int c, const char *arg, const char **pending, fl_err *err)
{
    struct item it = {0};
    double x[3] = {0};
    switch (c) {
    case 1: return add_item(o, (struct item){.kind = ITEM_FILE, .path = arg}, pending, err);
    case CYLINDER: return round_solid("cylinder", arg, &it, err) || add_item(o, it, pending, err) ? -1 : 0;
    case CONE: return round_solid("cone", arg, &it, err) || add_item(o, it, pending, err) ? -1 : 0;
    case BOX: return box(arg, &it, err) || add_item(o, it, pending, err) ? -1 : 0;
    case 'n':
        if (*pending)
            return fl_fail(err, FL_USAGE,
                           "--name %.60s is followed by --name %.60s without a part between them", *pending,
                           arg);
        if (*arg == '\0') return fl_fail(err, FL_USAGE, "--name is empty");
        *pending = arg;
        return 0;
    case PART: return pattern(o, arg, err);
    case RENAME: return rename_as(o, arg, err);
    case SUBDIVIDE: o->subdivide = 1; return 0;
    case 'f': return fl_option_whole("facets", arg, 3, FL_FACET_CORNERS, &o->facets, err);
    case 'u': return unit(o, arg, err);
    case 's': return positive("scale", arg, &o->factor, err);
    case UP:
        o->y_up = strcmp(arg, "y") == 0;
        if (o->y_up || strcmp(arg, "z") == 0) return 0;
        return fl_fail(err, FL_USAGE, "--up is \"%.60s\", y or z is expected", arg);
    case MIRROR:
        if (strlen(arg) != 1 || !strchr("xyz", *arg))
            return fl_fail(err, FL_USAGE, "--mirror is \"%.60s\", x, y or z is expected", arg);
        o->mirror ^= 1 << (*arg - 'x');
        return 0;
    case ROTATE: return rotate(o, arg, err);
    case 't':
        if (numbers("translate", arg, 3, 3, x, err) < 0) return -1;
        o->map.t = v3(x[0], x[1], x[2]);
        return 0;
    case 'w':
        if (numbers("weld", arg, 1, 1, &o->weld, err) < 0) return -1;
        return o->weld >= 0.0 ? 0
                              : fl_fail(err, FL_USAGE, "--weld is \"%.60s\", a length >= 0 is expected", arg);
    case FILL_HOLES: return fl_option_whole("fill-holes", arg, 0, 1000, &o->fill_holes, err);
    case FILL: return positive("fill", arg, &o->fill, err);
    case REPAIR: o->repair = 1; return 0;
    case SIMPLIFY: return positive("simplify", arg, &o->simplify, err);
    case REMESH: return remesh(o, arg, err);
    case RAW: o->raw = 1; return 0;
    case STRICT: o->strict = 1; return 0;
    case TO: return format(o, arg, err);
    case PLOT: o->plot = arg; return *arg ? 0 : fl_fail(err, FL_USAGE, "--plot is empty");
    case 'o': o->out = arg; return 0;
    case 'z': o->gzip = 1; return 0;
    case 'j': return fl_option_whole("threads", arg, 1, 1024, &o->threads, err);
    case 'q': o->quiet = 1; return 0;
    case 'v': o->verbose = 1; return 0;
    case 'h':
        fputs(HELP, stdout);
        o->ended = 1;
        return 0;
    case VERSION:
        fl_tool_version("struct-import");
        o->ended = 1;
        return 0;
    default: return fl_fail(err, FL_USAGE, "see struct-import --help");
    }
}

/* Checks between options, after all have been read. */
static int finish(struct options *o, const char *pending, fl_err *err)
{
    int32_t streams = 0;
    if (o->items == 0) {
        if (add_item(o, (struct item){.kind = ITEM_FILE, .path = "-"}, &pending, err)) return -1;
    } else if (pending) {
        struct item *last = &o->item[o->items - 1];
        if (last->name)
            return fl_fail(err, FL_USAGE, "--name %.60s follows a part that is called %.60s", pending,
                           last->name);
        last->name = pending;
    }
    for (int32_t k = 0; k < o->items; k++)
        streams += o->item[k].kind == ITEM_FILE && !strcmp(o->item[k].path, "-");
    if (streams > 1) return fl_fail(err, FL_USAGE, "standard input is named %d times", streams);
    if (o->raw && o->fill_holes) return fl_fail(err, FL_USAGE, "--raw and --fill-holes exclude each other");
    if (o->raw && (o->fill > 0.0 || o->repair || o->simplify > 0.0 || o->remesh > 0.0))
        return fl_fail(err, FL_USAGE, "--raw excludes --fill, --repair, --simplify and --remesh");
    o->map.s *= o->factor;
    place_first(o);
    return 0;
}

int options_parse(struct options *o, int argc, char **argv, fl_err *err)
{
    const char *pending = NULL; /* name for the next part */
    int c;
    *o = (struct options){.out = "-", .map = fl_affine_identity(), .factor = 1.0, .weld = -1.0};
    opterr = 0;
    /* "-": files are returned in their order among the options, as arguments of an option of code 1 */
    while (!o->ended && (c = getopt_long(argc, argv, "-:n:f:u:s:t:w:o:zj:qvh", LONG, NULL)) != -1) {
        if (c == ':' || c == '?')
            return fl_option_unknown("struct-import", LONG, c, optopt, argv[optind - 1], err);
        if (apply(o, c, optarg, &pending, err)) return -1;
    }
    for (; !o->ended && optind < argc; optind++) /* behind "--" */
        if (apply(o, 1, argv[optind], &pending, err)) return -1;
    return o->ended ? 0 : finish(o, pending, err);
}

void options_free(struct options *o)
{
    for (int32_t k = 0; k < o->aliases; k++) free(o->alias[k].old);
    free(o->alias);
    free(o->part);
    free(o->item);
}

void options_by(const struct options *o, fl_history_line *by)
{
    static const char *const option[] = {"", "--cylinder ", "--cone ", "--box "};
    char a[FL_NUMBER_LEN], b[FL_NUMBER_LEN], c[FL_NUMBER_LEN];
    fl_history_line_start(by, "struct-import");
    for (int32_t k = 0; k < o->parts; k++) fl_history_line_word(by, "--part ", o->part[k]);
    for (int32_t k = 0; k < o->aliases; k++) fl_history_line_word(by, "--rename ", o->alias[k].text);
    if (o->subdivide) fl_history_line_add(by, "--subdivide");
    if (o->facets) fl_history_line_add(by, "--facets %d", o->facets);
    if (o->unit) fl_history_line_add(by, "--unit %s", o->unit);
    if (o->factor != 1.0) fl_history_line_add(by, "--scale %s", fl_number_text(o->factor, a));
    if (o->y_up) fl_history_line_add(by, "--up y");
    for (int k = 0; k < 3; k++)
        if (o->mirror >> k & 1) fl_history_line_add(by, "--mirror %c", 'x' + k);
    for (int k = 0; k < o->turns; k++) fl_history_line_add(by, "--rotate %s", o->rotate[k]);
    if (v3_norm(o->map.t) > 0.0)
        fl_history_line_add(by, "--translate %s,%s,%s", fl_number_text(o->map.t.x, a),
                            fl_number_text(o->map.t.y, b), fl_number_text(o->map.t.z, c));
    if (o->weld >= 0.0) fl_history_line_add(by, "--weld %s", fl_number_text(o->weld, a));
    if (o->fill_holes) fl_history_line_add(by, "--fill-holes %d", o->fill_holes);
    if (o->fill > 0.0) fl_history_line_add(by, "--fill %s", fl_number_text(o->fill, a));
    if (o->repair) fl_history_line_add(by, "--repair");
    if (o->simplify > 0.0) fl_history_line_add(by, "--simplify %s", fl_number_text(o->simplify, a));
    if (o->remesh > 0.0)
        fl_history_line_add(by, "--remesh %s,%s", fl_number_text(o->remesh, a),
                            fl_number_text(o->remesh_within, b));
    if (o->raw) fl_history_line_add(by, "--raw");
    for (int32_t k = 0; k < o->items; k++) {
        const struct item *it = &o->item[k];
        const char *slash = it->path ? strrchr(it->path, '/') : NULL;
        if (it->name) fl_history_line_word(by, "--name ", it->name);
        fl_history_line_word(by, option[it->kind],
                             it->kind == ITEM_FILE ? slash ? slash + 1 : it->path : it->text);
    }
}
