/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/read_openfast.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/pi.h"
#include "mesh/beam_deck.h"

enum { WORDS = 24, HEAD_LINES = 3, LONGEST_NAME = 40 };
static const unsigned ALL_MOMENTS = 7; /* pins of a spherical joint */

/* Sections by their numbers: those of each form are numbered on their own, which is the scope. */
enum { CIRCLES, RECTANGLES, CONSTANTS };

typedef struct {
    fl_beam_deck k;
    fl_id_map section_id; /* scope: one of the above; the index is that in k.section */
    fl_id_map ball_joint; /* joints at which no member is clamped */
    double down;          /* MSL2SWL */
    int growth;           /* depths with marine growth */
    char *word[WORDS];    /* of the current row */
    int words;
    char *comment;                    /* behind ! or # of the current row, NULL: none */
    char header[WORDS][FL_BEAM_NAME]; /* names of the columns of the current table */
    int columns;
} openfast_reader;

/* --- the file ------------------------------------------------------------------------------------------- */

static int has_word_in_line(const char *p, const char *end, const char *word)
{
    const size_t n = strlen(word);
    for (; p + n <= end; p++)
        if (strncasecmp(p, word, n) == 0) return 1;
    return 0;
}

/* The second word of the line at p is `word`. */
static int is_second_word(const char *p, const char *word)
{
    const size_t n = strlen(word);
    p += strspn(p, " \t");
    p += strcspn(p, " \t\r\n");
    p += strspn(p, " \t");
    return strncasecmp(p, word, n) == 0 && strchr(" \t\r\n", p[n]) != NULL;
}

int fl_openfast_is(const fl_bytes *b)
{
    const char *p = b->data, *end = p;
    for (int k = 0; k < HEAD_LINES && *end; k++) { /* a line of dashes may come first */
        end += strcspn(end, "\n");
        end += *end == '\n';
    }
    if (!has_word_in_line(p, end, "SubDyn") && !has_word_in_line(p, end, "HydroDyn")) return 0;
    for (; *p; p += strcspn(p, "\n"), p += *p == '\n')
        if (is_second_word(p, "NJoints")) return 1;
    return 0;
}

/* Splits the current line at blanks and commas; what stands behind ! or # is its comment. */
static void split_words(openfast_reader *r)
{
    char *p = r->k.d.line;
    r->words = 0;
    r->comment = strpbrk(p, "!#");
    if (r->comment) *r->comment++ = '\0';
    while (r->words < WORDS) {
        p += strspn(p, " \t,");
        if (!*p) break;
        r->word[r->words++] = p;
        p += strcspn(p, " \t,");
        if (*p) *p++ = '\0';
    }
}

/* Next line, split: 1, 0 at the end, -1. */
static int next_words(openfast_reader *r, fl_err *err)
{
    const int more = fl_deck_line(&r->k.d, err);
    if (more > 0) split_words(r);
    return more;
}

/* Reads the line of column names and the line of units. */
static int read_header(openfast_reader *r, fl_err *err)
{
    const int more = next_words(r, err);
    if (more <= 0) return more;
    r->columns = r->words;
    for (int c = 0; c < r->words; c++) snprintf(r->header[c], sizeof r->header[c], "%s", r->word[c]);
    const int units = next_words(r, err);
    /* some files write PropSetID in the line of units */
    const size_t n = units > 0 && r->words ? strlen(r->word[0]) : 0;
    if (n > 2 && strcasecmp(r->word[0] + n - 2, "ID") == 0 && r->columns > 0 && r->columns < WORDS &&
        strcasecmp(r->header[0], r->word[0]) != 0 && strcasecmp(r->header[0], "YoungE") == 0) {
        memmove(r->header[1], r->header[0], (size_t)r->columns * sizeof r->header[0]);
        snprintf(r->header[0], sizeof r->header[0], "%s", r->word[0]);
        r->columns++;
    }
    return units;
}

/* Index of the column of that name, -1.  MSpin/COSMID is found as MSpin. */
static int find_column_named(const openfast_reader *r, const char *name)
{
    const size_t n = strlen(name);
    for (int c = 0; c < r->columns; c++)
        if (strncasecmp(r->header[c], name, n) == 0 && (r->header[c][n] == '\0' || r->header[c][n] == '/'))
            return c;
    return -1;
}

static int get_real(openfast_reader *r, int c, const char *what, double *x, fl_err *err)
{
    if (c >= 0 && c < r->words && fl_deck_real(r->word[c], x) == 0) return 0;
    return fl_deck_fail(&r->k.d, err, "%s is \"%.40s\", a number is expected", what,
                        c >= 0 && c < r->words ? r->word[c] : "");
}

static int get_id(openfast_reader *r, int c, const char *what, int64_t *x, fl_err *err)
{
    if (c >= 0 && c < r->words && fl_deck_integer(r->word[c], x) == 0 && *x >= 1) return 0;
    return fl_deck_fail(&r->k.d, err, "%s is \"%.40s\", a number of 1 or more is expected", what,
                        c >= 0 && c < r->words ? r->word[c] : "");
}

/* --- tables --------------------------------------------------------------------------------------------- */

static int read_joint(openfast_reader *r, fl_err *err)
{
    int64_t id;
    double x[3];
    if (get_id(r, 0, "the joint", &id, err)) return -1;
    for (int c = 0; c < 3; c++)
        if (get_real(r, c + 1, "a coordinate of the joint", &x[c], err)) return -1;
    const int at = find_column_named(r, "JointType");
    int64_t type = 1;
    if (at >= 0 && at < r->words && (get_id(r, at, "the type of the joint", &type, err) || type > 4))
        return err->code
                   ? -1
                   : fl_deck_fail(&r->k.d, err, "JointType is %lld, 1 to 4 are expected", (long long)type);
    if (type == 4 && fl_id_map_add(&r->ball_joint, 0, id, err) < 0) return -1;
    if (r->k.frame && (type == 2 || type == 3))
        fl_frame_count_skipped(r->k.frame, "%s joints (JointType %d), whose members are clamped here",
                               type == 2 ? "universal" : "revolute", (int)type);
    return fl_elements_add_node(&r->k.e, 0, id, v3(x[0], x[1], x[2] - r->down), err) < 0 ? -1 : 0;
}

static int read_reaction(openfast_reader *r, fl_err *err)
{
    int64_t id;
    int fixed = 0;
    if (get_id(r, 0, "the joint", &id, err)) return -1;
    for (int c = 0; c < 6 && c + 1 < r->words; c++) fixed |= (strcmp(r->word[c + 1], "1") == 0) << c;
    return fl_beam_deck_hold(&r->k, id, fixed, err);
}

static int read_mass(openfast_reader *r, fl_err *err)
{
    int64_t id;
    double mass;
    if (get_id(r, 0, "the joint", &id, err) || get_real(r, 1, "the mass", &mass, err)) return -1;
    return fl_beam_deck_mass(&r->k, id, mass, err);
}

/* The comment of a row without quotes and blanks around it; a long one is a remark and no name. */
static void name_part(const openfast_reader *r, char part[FL_BEAM_NAME])
{
    const char *p = r->comment ? r->comment : "";
    p += strspn(p, " \t!#\"'");
    size_t n = strcspn(p, "\r\n");
    while (n > 0 && strchr(" \t\"'", p[n - 1])) n--;
    if (n > LONGEST_NAME) n = 0;
    snprintf(part, FL_BEAM_NAME, "%.*s", n < FL_BEAM_NAME ? (int)n : FL_BEAM_NAME - 1, p);
}

/* A wall that is not there is 0. */
static int get_wall(openfast_reader *r, int c, double *t, fl_err *err)
{
    *t = 0.0;
    return c < 0 ? 0 : get_real(r, c, "the thickness", t, err);
}

static int column_of_either(const openfast_reader *r, const char *a, const char *b)
{
    const int c = find_column_named(r, a);
    return c >= 0 ? c : find_column_named(r, b);
}

static int add_section_row(openfast_reader *r, int form, int64_t id, const fl_beam_section *s, fl_err *err)
{
    const int32_t had = r->section_id.n, at = fl_id_map_add(&r->section_id, form, id, err);
    if (at < 0) return -1;
    if (at < had) return fl_deck_fail(&r->k.d, err, "section %lld is defined a second time", (long long)id);
    return fl_beam_deck_section(&r->k, s, err) < 0 ? -1 : 0;
}

static int read_material(openfast_reader *r, fl_beam_section *s, fl_err *err)
{
    if (find_column_named(r, "YoungE") < 0) return 0; /* HydroDyn knows none */
    return get_real(r, find_column_named(r, "YoungE"), "YoungE", &s->material.e, err) ||
                   get_real(r, find_column_named(r, "ShearG"), "ShearG", &s->material.g, err) ||
                   get_real(r, find_column_named(r, "MatDens"), "MatDens", &s->material.rho, err)
               ? -1
               : 0;
}

/* Sizes of a section above 0, else the row is refused. */
static int get_size(openfast_reader *r, int c, const char *what, double *x, fl_err *err)
{
    if (get_real(r, c, what, x, err)) return -1;
    if (*x > 0.0) return 0;
    return fl_deck_fail(&r->k.d, err, "%s is %g, a length above 0 is expected", what, *x);
}

static int read_section(openfast_reader *r, fl_err *err)
{
    fl_beam_section s = {0};
    int64_t id;
    const int d = column_of_either(r, "XsecD", "PropD"), wall = column_of_either(r, "XsecT", "PropThck"),
              constants = find_column_named(r, "XsecAsx");
    if (get_id(r, 0, "the section", &id, err) || read_material(r, &s, err)) return -1;
    name_part(r, s.part);
    if (constants >= 0) {
        s.form = FL_FRAME_GENERAL;
        snprintf(s.name, sizeof s.name, "any%lld", (long long)id);
        snprintf(s.kind, sizeof s.kind, "member of an arbitrary section");
        if (get_real(r, find_column_named(r, "XsecA"), "XsecA", &s.a, err) ||
            get_real(r, find_column_named(r, "XsecJxx"), "XsecJxx", &s.iy, err) ||
            get_real(r, find_column_named(r, "XsecJyy"), "XsecJyy", &s.iz, err) ||
            get_real(r, find_column_named(r, "XsecJ0"), "XsecJ0", &s.j, err))
            return -1;
        return add_section_row(r, CONSTANTS, id, &s, err);
    }
    if (d >= 0) {
        s.form = FL_FRAME_PIPE;
        snprintf(s.name, sizeof s.name, "circle%lld", (long long)id);
        if (get_size(r, d, "the diameter", &s.size[0], err) || get_wall(r, wall, &s.wall[0], err)) return -1;
        return add_section_row(r, CIRCLES, id, &s, err);
    }
    int a = find_column_named(r, "XsecSa"), b = find_column_named(r, "XsecSb");
    if (a < 0) a = column_of_either(r, "XsecA", "PropA");
    if (b < 0) b = column_of_either(r, "XsecB", "PropB");
    if (a < 0 || b < 0)
        return fl_deck_fail(&r->k.d, err, "sections of columns %.40s ... %.40s are unknown", r->header[0],
                            r->columns ? r->header[r->columns - 1] : "");
    s.form = FL_FRAME_RECTANGLE;
    snprintf(s.name, sizeof s.name, "box%lld", (long long)id);
    if (get_size(r, a, "side A", &s.size[0], err) || get_size(r, b, "side B", &s.size[1], err) ||
        get_wall(r, wall, &s.wall[0], err))
        return -1;
    s.wall[1] = s.wall[0];
    return add_section_row(r, RECTANGLES, id, &s, err);
}

/* --- members -------------------------------------------------------------------------------------------- */

/* Members come before the sections: a row waits with its numbers of sections. */
static int read_member(openfast_reader *r, fl_err *err)
{
    const int type = find_column_named(r, "MType"), geometry = find_column_named(r, "MSecGeom");
    int spin = column_of_either(r, "MSpin", "MSpinOrient");
    const int at = type >= 0 ? type : geometry;
    const char *word = at >= 0 && at < r->words ? r->word[at] : "1c";
    fl_beam b = {.part = -1};
    int64_t section[2];
    double degrees = 0.0;
    if (get_id(r, 0, "the member", &b.id, err) || get_id(r, 1, "its first joint", &b.node[0], err) ||
        get_id(r, 2, "its second joint", &b.node[1], err))
        return -1;
    if (type >= 0 && strcmp(word, "2") == 0) return fl_beam_deck_skip(&r->k, "cable", err);
    if (type >= 0 && strcmp(word, "3") == 0) return fl_beam_deck_link(&r->k, b.node[0], b.node[1], err);
    if (type >= 0 && strcmp(word, "5") == 0) return fl_beam_deck_skip(&r->k, "spring", err);
    int32_t form = CIRCLES;
    if (strcasecmp(word, "1r") == 0 || (geometry >= 0 && type < 0 && strcmp(word, "2") == 0))
        form = RECTANGLES;
    else if (type >= 0 && strcmp(word, "4") == 0) form = CONSTANTS;
    else if (strcmp(word, "1") != 0 && strcasecmp(word, "1c") != 0)
        return fl_deck_fail(&r->k.d, err, "%s of member %lld is \"%.20s\", which is unknown",
                            type >= 0 ? "MType" : "MSecGeom", (long long)b.id, word);
    if (get_id(r, 3, "its first section", &section[0], err) ||
        get_id(r, 4, "its second section", &section[1], err))
        return -1;
    if (form == RECTANGLES && spin >= 0 && spin < r->words && get_real(r, spin, "MSpin", &degrees, err))
        return -1;
    /* until finish_members(): numbers instead of indices, the form and the spin where they fit */
    b.section[0] = (int32_t)section[0];
    b.section[1] = (int32_t)section[1];
    b.scope[0] = form;
    b.across = v3(degrees, 0, 0);
    if (section[0] > INT32_MAX || section[1] > INT32_MAX)
        return fl_deck_fail(&r->k.d, err, "a section of member %lld is above %d", (long long)b.id, INT32_MAX);
    return fl_beam_deck_add(&r->k, &b, err) < 0 ? -1 : 0;
}

/* Side A of a rectangle is horizontal and along x where the member is upright; z is across it, both turned by
 * the spin. */
static fl_vec3 side_b(fl_vec3 along, double degrees)
{
    fl_vec3 a = v3_cross(v3(0, 0, 1), along);
    if (!(v3_norm(a) > 1e-6)) a = v3(1, 0, 0);
    a = v3_unit(a);
    const fl_vec3 c = v3_cross(along, a);
    const double t = degrees * PI / 180.0;
    return v3_add(v3_scale(cos(t), c), v3_scale(-sin(t), a));
}

static int finish_members(openfast_reader *r, fl_err *err)
{
    for (int32_t i = 0; i < r->k.beams; i++) {
        fl_beam *b = &r->k.beam[i];
        const int32_t form = b->scope[0];
        b->scope[0] = 0;
        for (int s = 0; s < 2; s++) {
            const int32_t at = fl_id_map_find(&r->section_id, form, b->section[s]);
            if (at < 0)
                return fl_elements_fail(&r->k.e, b->file, b->line, err,
                                        "member %lld has %s section %d, which is not defined",
                                        (long long)b->id,
                                        form == CIRCLES      ? "circular"
                                        : form == RECTANGLES ? "rectangular"
                                                             : "the",
                                        (int)b->section[s]);
            b->section[s] = at;
        }
        const int32_t i0 = fl_id_map_find(&r->k.e.node_id, 0, b->node[0]),
                      i1 = fl_id_map_find(&r->k.e.node_id, 0, b->node[1]);
        const double degrees = b->across.x;
        b->across = v3(0, 0, 0);
        for (int s = 0; s < 2; s++)
            if (fl_id_map_find(&r->ball_joint, 0, b->node[s]) >= 0) b->pins[s] = ALL_MOMENTS;
        if (form == RECTANGLES && i0 >= 0 && i1 >= 0) {
            const fl_vec3 d = v3_sub(r->k.e.x[i1], r->k.e.x[i0]);
            if (v3_norm(d) > 0.0) b->across = side_b(v3_unit(d), degrees);
        }
    }
    return 0;
}

/* --- all tables ----------------------------------------------------------------------------------------- */

static const struct {
    const char *name;
    int (*row)(openfast_reader *r, fl_err *err);
} TABLES[] = {{"NJoints", read_joint},        {"NMembers", read_member},      {"NPropSets", read_section},
              {"NPropSetsCyl", read_section}, {"NPropSetsRec", read_section}, {"NXPropSets", read_section},
              {"NReact", read_reaction},      {"NCmass", read_mass}};

static int read_table(openfast_reader *r, size_t t, int64_t rows, fl_err *err)
{
    int more = read_header(r, err);
    for (int64_t k = 0; more > 0 && k < rows; k++) {
        more = next_words(r, err);
        if (more > 0 && r->words == 0)
            return fl_deck_fail(&r->k.d, err, "%s promises %lld rows, and row %lld is empty", TABLES[t].name,
                                (long long)rows, (long long)k + 1);
        if (more > 0 && TABLES[t].row(r, err)) return -1;
    }
    if (more == 0 && rows > 0)
        return fl_deck_fail(&r->k.d, err, "%s promises %lld rows, and the file ends before", TABLES[t].name,
                            (long long)rows);
    return more < 0 ? -1 : 0;
}

static int read_tables(openfast_reader *r, fl_err *err)
{
    int more;
    while ((more = next_words(r, err)) > 0) {
        int64_t rows;
        double x;
        if (r->words < 2) continue;
        if (strcasecmp(r->word[1], "MSL2SWL") == 0) {
            if (fl_deck_real(r->word[0], &x) == 0) r->down = x;
            else if (strcasecmp(r->word[0], "default") && strcasecmp(r->word[0], "\"default\""))
                return fl_deck_fail(&r->k.d, err, "MSL2SWL is \"%.40s\", a number is expected", r->word[0]);
        }
        if (fl_deck_integer(r->word[0], &rows) || rows < 0) continue;
        if (strcasecmp(r->word[1], "NMGDepths") == 0) r->growth = rows > 0;
        for (size_t t = 0; t < sizeof TABLES / sizeof *TABLES; t++)
            if (strcasecmp(r->word[1], TABLES[t].name) == 0) {
                if (read_table(r, t, rows, err)) return -1;
                break;
            }
    }
    return more;
}

int fl_openfast_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    openfast_reader r = {0};
    (void)name; /* members know their parts */
    int rc = -1;
    if (fl_beam_deck_start(&r.k, b, opt, err)) return -1;
    if (read_tables(&r, err) || finish_members(&r, err)) goto done;
    if (r.k.beams == 0 && r.k.e.node_id.n == 0) {
        fl_bytes_fail(b, err, "no members: a body of potential flow has panels, as a WAMIT .gdf");
        goto done;
    }
    if (r.down != 0.0)
        fl_bytes_note(b, "z is from mean sea level and was moved by %g to still water (MSL2SWL)", -r.down);
    if (r.growth) fl_bytes_note(b, "marine growth is not added to the diameters");
    rc = fl_beam_deck_finish(&r.k, s, err);
done:
    fl_beam_deck_free(&r.k);
    fl_id_map_free(&r.section_id);
    fl_id_map_free(&r.ball_joint);
    return rc;
}
