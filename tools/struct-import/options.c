/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/option.h"
#include "geom/facet.h"
#include "options.h"

static const char USAGE[] =
    "usage: struct-import [options] [FILE ...]\n"
    "Turn meshes and ready-made solids into a structure file (g_struct) for dem-solve.\n"
    "FILE is one of (STL, OBJ, OFF, PLY, VTK, g_struct, Abaqus, ANSYS, Gmsh, Nastran, SESAM, SACS, USFOS,\n"
    "OpenFAST, WAMIT, NEMOH, HAMS, HydroStar, AQWA, Tecplot, Salome, GeniE, UNV), recognised by content;\n"
    "- or nothing is standard input.\n"
    "\n";

static const struct unit {
    const char *name;
    double metres;
} UNIT[] = {{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}, {"in", 0.0254}, {"ft", 0.3048}};

static const double FAR = 1e9; /* [m] largest coordinate; its square and cube stay exact in range */

/* Parse least .. most numbers separated by commas.  Returns their count, or -1. */
static int numbers(const char *option, const char *text, int least, int most, double *x, fl_err *err)
{
    char expected[80];
    int n;
    if (most == 1) snprintf(expected, sizeof expected, "a number from %g to %g", -FAR, FAR);
    else if (least == most)
        snprintf(expected, sizeof expected, "%d numbers from %g to %g with commas", least, -FAR, FAR);
    else
        snprintf(expected, sizeof expected, "%d or %d numbers from %g to %g with commas", least, most, -FAR,
                 FAR);
    if (fl_option_numbers(option, text, ',', least, most, -FAR, FAR, expected, x, &n, err)) return -1;
    if (n != least && n != most)
        return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", expected %s", option, text, expected);
    return n;
}

/* Add an item; it gets the pending name. */
static int add_item(struct options *o, struct item it, fl_err *err)
{
    if (fl_grow(&o->item, &o->item_cap, (int64_t)o->items + 1, sizeof *o->item, err)) return -1;
    it.name = o->next_name;
    o->next_name = NULL;
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
        return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", expected radii >= 0 and not both 0", option, text);
    if (!(z0 < z1)) return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", expected Z0 < Z1", option, text);
    *it = (struct item){.kind = cylinder ? ITEM_CYLINDER : ITEM_CONE, .text = text};
    it->cone = (fl_cone){v3(axis[0], axis[1], z0), v3(axis[0], axis[1], z1), r0, r1};
    return 0;
}

static int parse_box(const char *text, struct item *it, fl_err *err)
{
    double x[6] = {0};
    if (numbers("box", text, 6, 6, x, err) < 0) return -1;
    *it = (struct item){.kind = ITEM_BOX, .text = text, .box = {v3(x[0], x[1], x[2]), v3(x[3], x[4], x[5])}};
    if (x[0] < x[3] && x[1] < x[4] && x[2] < x[5]) return 0;
    return fl_fail(err, FL_USAGE, "--box is \"%.60s\", expected X0 < X1, Y0 < Y1 and Z0 < Z1", text);
}

static int set_unit(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    for (size_t k = 0; k < sizeof UNIT / sizeof UNIT[0]; k++)
        if (strcmp(text, UNIT[k].name) == 0) {
            o->unit = UNIT[k].name;
            o->map.s = UNIT[k].metres;
            return 0;
        }
    return fl_fail(err, FL_USAGE, "--unit is \"%.60s\", expected one of mm cm m in ft", text);
}

static int pattern(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (*text == '\0') return fl_fail(err, FL_USAGE, "--part is empty, expected a pattern");
    if (fl_grow(&o->part, &o->part_cap, (int64_t)o->parts + 1, sizeof *o->part, err)) return -1;
    o->part[o->parts++] = text;
    return 0;
}

/* OLD=NEW, divided at the last "=": names in decks may contain one, new names need not. */
static int rename_as(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    const char *mid = strrchr(text, '=');
    struct alias *a;
    if (!mid || mid == text || mid[1] == '\0')
        return fl_fail(err, FL_USAGE, "--rename is \"%.60s\", expected OLD=NEW", text);
    if (fl_grow(&o->alias, &o->alias_cap, (int64_t)o->aliases + 1, sizeof *o->alias, err)) return -1;
    a = &o->alias[o->aliases];
    *a = (struct alias){.text = text, .name = mid + 1, .old = fl_alloc(mid - text + 1, 1, err)};
    if (!a->old) return -1;
    memcpy(a->old, text, (size_t)(mid - text));
    o->aliases++;
    return 0;
}

/* The text is kept for the history. */
static int rotate(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    double x[4] = {0};
    if (numbers("rotate", text, 4, 4, x, err) < 0) return -1;
    if (!(v3_norm(v3(x[0], x[1], x[2])) > 0.0))
        return fl_fail(err, FL_USAGE, "--rotate is \"%.60s\", expected an axis of non-zero length", text);
    if (o->turns == TURNS) return fl_fail(err, FL_USAGE, "--rotate is given more than %d times", TURNS);
    const fl_mat3 r = fl_affine_rotation(v3(x[0], x[1], x[2]), x[3]);
    o->rotate[o->turns++] = text;
    o->map.q = fl_affine_matrix_product(&r, &o->map.q);
    return 0;
}

/* --up and --mirror apply before the turns of --rotate, whatever the order of the options. */
static void place_first(struct options *o)
{
    static const fl_mat3 y_up = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
    fl_mat3 first = fl_affine_identity().q;
    if (o->y_up) first = y_up;
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3 && o->mirror >> k & 1; j++) first.m[k][j] = -first.m[k][j];
    o->map.q = fl_affine_matrix_product(&o->map.q, &first);
}

static int remesh(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    double x[2] = {0};
    const int n = numbers("remesh", text, 1, 2, x, err);
    if (n < 0) return -1;
    o->remesh = x[0];
    o->remesh_within = n == 2 ? x[1] : x[0] / 10.0;
    if (o->remesh > 0.0 && o->remesh_within > 0.0) return 0;
    return fl_fail(err, FL_USAGE, "--remesh is \"%.60s\", expected lengths above 0", text);
}

/* --- one function for each option that has a form of its own ------------------------------------ */

static int add_file(void *options, const char *text, fl_err *err)
{
    return add_item(options, (struct item){.kind = ITEM_FILE, .path = text}, err);
}

static int add_cylinder(void *options, const char *text, fl_err *err)
{
    struct item it = {0};
    return round_solid("cylinder", text, &it, err) || add_item(options, it, err) ? -1 : 0;
}

static int add_cone(void *options, const char *text, fl_err *err)
{
    struct item it = {0};
    return round_solid("cone", text, &it, err) || add_item(options, it, err) ? -1 : 0;
}

static int add_box(void *options, const char *text, fl_err *err)
{
    struct item it = {0};
    return parse_box(text, &it, err) || add_item(options, it, err) ? -1 : 0;
}

static int set_name(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (o->next_name)
        return fl_fail(err, FL_USAGE, "--name %.60s is followed by --name %.60s without a part between them",
                       o->next_name, text);
    if (*text == '\0') return fl_fail(err, FL_USAGE, "--name is empty");
    o->next_name = text;
    return 0;
}

static int set_up_axis(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    o->y_up = strcmp(text, "y") == 0;
    if (o->y_up || strcmp(text, "z") == 0) return 0;
    return fl_fail(err, FL_USAGE, "--up is \"%.60s\", expected y or z", text);
}

static int add_mirror(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (strlen(text) != 1 || !strchr("xyz", *text))
        return fl_fail(err, FL_USAGE, "--mirror is \"%.60s\", expected x, y or z", text);
    o->mirror ^= 1 << (*text - 'x');
    return 0;
}

static int add_symmetry(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    if (strlen(text) != 1 || !strchr("xy", *text))
        return fl_fail(err, FL_USAGE, "--symmetry is \"%.60s\", expected x or y", text);
    o->symmetry |= 1 << (*text - 'x');
    return 0;
}

static int set_translation(void *options, const char *text, fl_err *err)
{
    struct options *const o = options;
    double x[3] = {0};
    if (numbers("translate", text, 3, 3, x, err) < 0) return -1;
    o->map.t = v3(x[0], x[1], x[2]);
    return 0;
}

static int set_plot(void *options, const char *text, fl_err *err)
{
    ((struct options *)options)->plot = text;
    return *text ? 0 : fl_fail(err, FL_USAGE, "--plot is empty");
}

/* --- the table --------------------------------------------------------------------------------- */

static const char *const FORMAT[] = {"g_struct", "stl", "stl-binary", "obj", "off", "ply", "vtp", NULL};

#define AT(member) offsetof(struct options, member)
#define LENGTH .lo = DBL_MIN, .hi = 1e9

static const fl_option OPTION[] = {
    {.word = "cylinder",
     .argument = "R,Z0,Z1[,X,Y]",
     .help = "an upright cylinder about X,Y (0,0) from Z0 to Z1 [m]",
     .kind = FL_OPTION_CALL,
     .call = add_cylinder},
    {.word = "cone",
     .argument = "R0,Z0,R1,Z1[,X,Y]",
     .help = "an upright cone, cut where both radii are above 0 [m]",
     .kind = FL_OPTION_CALL,
     .call = add_cone},
    {.word = "box",
     .argument = "X0,Y0,Z0,X1,Y1,Z1",
     .help = "a box of 12 triangles [m]",
     .kind = FL_OPTION_CALL,
     .call = add_box},
    {.word = "name",
     .letter = 'n',
     .argument = "NAME",
     .help = "name of the next part; at the end, of the last one",
     .kind = FL_OPTION_CALL,
     .call = set_name},
    {.word = "part",
     .argument = "PATTERN",
     .help = "import only parts and sets that match; * and ? are wildcards",
     .kind = FL_OPTION_CALL,
     .call = pattern},
    {.word = "rename",
     .argument = "OLD=NEW",
     .help = "rename parts that match the pattern OLD; equal names are joined",
     .kind = FL_OPTION_CALL,
     .call = rename_as},
    {.word = "subdivide",
     .help = "split quadratic faces into 4, 6 or 8 triangles instead of 1 or 2",
     .at = AT(subdivide)},
    {.word = "members",
     .help = "write beams, trusses and pipes of a deck as a members file",
     .at = AT(members)},
    {.word = "pieces",
     .argument = "N",
     .help = "pieces of a beam, with --members (4)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(pieces),
     .lo = 1,
     .hi = 100000},
    {.word = "facets",
     .letter = 'f',
     .argument = "N",
     .help = "replace cylinders and cones by triangles, N per circle",
     .kind = FL_OPTION_INTEGER,
     .at = AT(facets),
     .lo = 3,
     .hi = FL_FACET_CORNERS},
    {.word = "unit",
     .letter = 'u',
     .argument = "UNIT",
     .help = "length unit of the files: mm, cm, m, in or ft (m)",
     .kind = FL_OPTION_CALL,
     .call = set_unit},
    {.word = "scale",
     .letter = 's',
     .argument = "S",
     .help = "multiply the coordinates of the files by S (1)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(factor),
     LENGTH,
     .expected = "a number above 0"},
    {.word = "up",
     .argument = "AXIS",
     .help = "axis that points up in the files, y or z (z)",
     .kind = FL_OPTION_CALL,
     .call = set_up_axis},
    {.word = "mirror",
     .argument = "AXIS",
     .help = "mirror the files in the plane across x, y or z",
     .kind = FL_OPTION_CALL,
     .call = add_mirror},
    {.word = "symmetry",
     .argument = "AXIS",
     .help = "add the mirrored half of the files in the plane across x or y",
     .kind = FL_OPTION_CALL,
     .call = add_symmetry},
    {.word = "rotate",
     .argument = "AX,AY,AZ,DEG",
     .help = "turn the files about an axis through the origin",
     .kind = FL_OPTION_CALL,
     .call = rotate},
    {.word = "translate",
     .letter = 't',
     .argument = "X,Y,Z",
     .help = "then move the contents of the files [m]",
     .kind = FL_OPTION_CALL,
     .call = set_translation},
    {.word = "weld",
     .letter = 'w',
     .argument = "TOL",
     .help = "merge vertices within TOL [m] (1e-6 of the part's diagonal)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(weld),
     .lo = 0.0,
     .hi = 1e9,
     .expected = "a length >= 0"},
    {.word = "fill-holes",
     .argument = "N",
     .help = "close holes of up to N edges (0)",
     .kind = FL_OPTION_INTEGER,
     .at = AT(fill_holes),
     .lo = 0,
     .hi = 1000},
    {.word = "fill",
     .argument = "SIZE",
     .help = "close holes whose box is up to SIZE [m] across (0)",
     .kind = FL_OPTION_NUMBER,
     .at = AT(fill),
     LENGTH,
     .expected = "a length above 0"},
    {.word = "deck",
     .argument = "H",
     .help = "raise rims at the top of parts by H [m] and close them by a deck",
     .kind = FL_OPTION_NUMBER,
     .at = AT(deck),
     LENGTH,
     .expected = "a height above the rim, above 0"},
    {.word = "repair",
     .help = "join bodies that cross, rebuild patches that cross themselves",
     .at = AT(repair)},
    {.word = "simplify",
     .argument = "DISTANCE",
     .help = "reduce triangles within DISTANCE [m] both ways",
     .kind = FL_OPTION_NUMBER,
     .at = AT(simplify),
     LENGTH,
     .expected = "a length above 0"},
    {.word = "remesh",
     .argument = "LENGTH[,D]",
     .help = "edges of about LENGTH [m], within D (LENGTH / 10) both ways",
     .kind = FL_OPTION_CALL,
     .call = remesh},
    {.word = "raw", .help = "no cleanup: weld only", .at = AT(raw)},
    {.word = "strict", .help = "status 1 if a defect remains", .at = AT(strict)},
    {.word = "to",
     .argument = "FORMAT",
     .help = "g_struct, stl (ASCII), stl-binary, obj, off, ply or vtp (g_struct)",
     .kind = FL_OPTION_CHOICE,
     .at = AT(to),
     .choice = FORMAT},
    {.word = "plot",
     .argument = "WHERE",
     .help = "draw three views, into FILE.png, FILE.svg or a folder (by gnuplot)",
     .kind = FL_OPTION_CALL,
     .call = set_plot},
    FL_COMMON_OPTIONS(struct options, "write there, - is standard output", "compress the output",
                      "threads of the search for crossings; does not affect the result",
                      "no table and no warnings on standard error", "more details of the cleanup"),
};

static const fl_option_table TABLE = {"struct-import", USAGE, OPTION, add_file, 1};

/* Checks between options, after all have been read. */
static int finish(struct options *o, fl_err *err)
{
    const char *const pending = o->next_name;
    int32_t streams = 0;
    if (o->items == 0) {
        if (add_item(o, (struct item){.kind = ITEM_FILE, .path = "-"}, err)) return -1;
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
    if (o->members && (o->items != 1 || o->item[0].kind != ITEM_FILE))
        return fl_fail(err, FL_USAGE, "--members reads one deck");
    if (o->members && (o->symmetry || o->deck > 0.0 || o->turns || o->mirror || o->y_up || o->parts ||
                       o->aliases || o->plot || o->to || o->repair || o->raw || o->item[0].name))
        return fl_fail(err, FL_USAGE,
                       "--members goes with --pieces, --unit, --scale, --translate and --strict alone");
    if (o->raw && o->fill_holes) return fl_fail(err, FL_USAGE, "--raw and --fill-holes exclude each other");
    if (o->raw && (o->fill > 0.0 || o->repair || o->simplify > 0.0 || o->remesh > 0.0))
        return fl_fail(err, FL_USAGE, "--raw excludes --fill, --repair, --simplify and --remesh");
    o->map.s *= o->factor;
    place_first(o);
    return 0;
}

int options_parse(struct options *o, int argc, char **argv, fl_err *err)
{
    *o = (struct options){.out = "-", .map = fl_affine_identity(), .factor = 1.0, .weld = -1.0, .pieces = 4};
    if (fl_options_read(&TABLE, o, NULL, argc, argv, err)) return -1;
    return o->ended ? 0 : finish(o, err);
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
    if (o->members) fl_history_line_add(by, "--members");
    if (o->members && o->pieces != 4) fl_history_line_add(by, "--pieces %d", (int)o->pieces);
    if (o->subdivide) fl_history_line_add(by, "--subdivide");
    if (o->facets) fl_history_line_add(by, "--facets %d", o->facets);
    if (o->unit) fl_history_line_add(by, "--unit %s", o->unit);
    if (o->factor != 1.0) fl_history_line_add(by, "--scale %s", fl_number_text(o->factor, a));
    if (o->y_up) fl_history_line_add(by, "--up y");
    for (int k = 0; k < 3; k++)
        if (o->mirror >> k & 1) fl_history_line_add(by, "--mirror %c", 'x' + k);
    for (int k = 0; k < 2; k++)
        if (o->symmetry >> k & 1) fl_history_line_add(by, "--symmetry %c", 'x' + k);
    for (int k = 0; k < o->turns; k++) fl_history_line_add(by, "--rotate %s", o->rotate[k]);
    if (v3_norm(o->map.t) > 0.0)
        fl_history_line_add(by, "--translate %s,%s,%s", fl_number_text(o->map.t.x, a),
                            fl_number_text(o->map.t.y, b), fl_number_text(o->map.t.z, c));
    if (o->weld >= 0.0) fl_history_line_add(by, "--weld %s", fl_number_text(o->weld, a));
    if (o->fill_holes) fl_history_line_add(by, "--fill-holes %d", o->fill_holes);
    if (o->fill > 0.0) fl_history_line_add(by, "--fill %s", fl_number_text(o->fill, a));
    if (o->deck > 0.0) fl_history_line_add(by, "--deck %s", fl_number_text(o->deck, a));
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
