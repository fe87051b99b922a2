/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "base/pi.h"
#include "geom/affine.h"
#include "mesh/element_surface.h"
#include "mesh/frame_bdf.h"
#include "mesh/bdf_entry.h"
#include "mesh/read_bdf.h"

enum {
    MAX_DEPTH = 1000,
    NAME_MAX = 100, /* significant bytes of a name */
    CONROD = -1     /* property of rods that have none */
};

/* A coordinate system: its definition, and its frame once `state` is 2. */
typedef struct {
    char kind; /* R C S */
    int by;    /* 1: defined by grids, 2: by points in another system */
    int state; /* 0 defined, 1 being resolved, 2 resolved */
    int32_t file, line;
    int64_t other, grid[3];
    fl_vec3 point[3]; /* origin, on the third axis, in the half plane of the first axis */
    fl_mat3 axes;     /* columns */
} system_def;

/* Definition of a grid and its system: BASIC, DEFAULT (that of GRDSET), OPEN while it is resolved, or FIRST
 * plus an index in frames. */
typedef struct {
    int32_t cp, file, line;
} grid_ref;

typedef struct {
    fl_frame_model *beams; /* or NULL */
    fl_bdf_entry at;
    fl_elements e;
    fl_id_map frames; /* numbers of coordinate systems */
    system_def *frame;
    grid_ref *grid; /* [nodes] */
    int64_t grdset;
    fl_id_map pids; /* numbers of properties; until the end, the part of an element is an index in these */
    char **name;    /* [pids] names from comments, NULL for none */
    double (*radius)[2]; /* [pids] nan for none */
    char *is_fluid;      /* [pids] 1: an acoustic fluid */
    int32_t frame_cap, grid_cap, name_cap, radius_cap, fluid_cap;
} bdf_reader;

enum { OPEN = -1, DEFAULT = 0, BASIC = 1, FIRST = 2 };

/* --- recognition ---------------------------------------------------------------------------------------- */

static int starts_with(const char *p, const char *word)
{
    const size_t n = strlen(word);
    return strncasecmp(p, word, n) == 0 && strchr(" \t,*'\"=\r\n", p[n]) != NULL;
}

int fl_bdf_is(const fl_bytes *b)
{
    if (!fl_bytes_is_text(b)) return 0;
    for (const char *p = b->data; *p; p += strspn(p, "\r\n")) {
        const char *q = p + strspn(p, " \t");
        /* a line of Nastran begins with a letter, a continuation mark or a blank */
        if (*q && !isalpha((unsigned char)*q) && !strchr("$+*,\r\n", *q) && q == p) return 0;
        if (starts_with(p, "GRID")) return 1;
        if (starts_with(p, "BEGIN") && strncasecmp(p + 5 + strspn(p + 5, " \t,"), "BULK", 4) == 0) return 1;
        if (starts_with(q, "INCLUDE") && strchr("'\"", q[7 + strspn(q + 7, " \t")])) return 1;
        p += strcspn(p, "\r\n");
    }
    return 0;
}

/* --- properties ----------------------------------------------------------------------------------------- */

static int32_t property_index(bdf_reader *r, int64_t pid, fl_err *err)
{
    const int32_t had = r->pids.n, k = fl_id_map_add(&r->pids, 0, pid, err);
    if (k < had) return k;
    if (fl_grow(&r->name, &r->name_cap, (int64_t)k + 1, sizeof *r->name, err) ||
        fl_grow(&r->radius, &r->radius_cap, (int64_t)k + 1, sizeof *r->radius, err) ||
        fl_grow(&r->is_fluid, &r->fluid_cap, (int64_t)k + 1, 1, err)) {
        r->pids.n = had; /* no name to free */
        return -1;
    }
    r->name[k] = NULL;
    r->is_fluid[k] = 0;
    r->radius[k][0] = r->radius[k][1] = NAN;
    return k;
}

static int name_property(bdf_reader *r, int64_t pid, const char *name, size_t n, fl_err *err)
{
    const int32_t k = property_index(r, pid, err);
    char *copy;
    if (k < 0) return -1;
    while (n > 0 && isspace((unsigned char)name[n - 1])) n--;
    if (n == 0) return 0;
    if (n > NAME_MAX) n = NAME_MAX;
    copy = fl_alloc((int64_t)n + 1, 1, err);
    if (!copy) return -1;
    memcpy(copy, name, n);
    free(r->name[k]);
    r->name[k] = copy;
    return 0;
}

/* Names of properties that preprocessors leave behind $:
 *     HMNAME PROP              7"leg" 4
 *     ANSA_NAME_COMMENT;7;PSHELL;leg;...
 *      Femap Property 7 : leg */
static int read_name_comment(void *context, const char *text, fl_err *err)
{
    bdf_reader *r = context;
    char word[16], *free_reader;
    const char *p;
    int64_t pid;
    if (strncasecmp(text, "HMNAME PROP", 11) == 0) {
        p = text + 11 + strspn(text + 11, " \t");
        pid = strtoll(p, &free_reader, 10);
        free_reader += strspn(free_reader, " \t");
        if (pid < 1 || pid > INT32_MAX || *free_reader != '"') return 0;
        return name_property(r, pid, free_reader + 1, strcspn(free_reader + 1, "\""), err);
    }
    if (strncasecmp(text, "ANSA_NAME_COMMENT;", 18) == 0) {
        pid = strtoll(text + 18, &free_reader, 10);
        if (pid < 1 || pid > INT32_MAX || free_reader[0] != ';' ||
            toupper((unsigned char)free_reader[1]) != 'P')
            return 0;
        p = strchr(free_reader + 1, ';');
        return p ? name_property(r, pid, p + 1, strcspn(p + 1, ";"), err) : 0;
    }
    if (sscanf(text, " %15s", word) == 1 && strcasecmp(word, "Femap") == 0 &&
        (p = strstr(text, "Property ")) != NULL) {
        pid = strtoll(p + 9, &free_reader, 10);
        free_reader += strspn(free_reader, " \t");
        if (pid < 1 || pid > INT32_MAX || *free_reader != ':') return 0;
        free_reader += 1 + strspn(free_reader + 1, " \t");
        return name_property(r, pid, free_reader, strlen(free_reader), err);
    }
    return 0;
}

/* Radii of round sections. */
static int read_section(bdf_reader *r, fl_err *err)
{
    const fl_bdf_entry *a = &r->at;
    const int listed = strcmp(a->name, "PBARL") == 0 || strcmp(a->name, "PBEAML") == 0;
    const char *kind = fl_bdf_field(a, 3);
    int64_t pid;
    double x[2] = {0};
    int32_t k;
    if (fl_bdf_id(a, 0, &pid, err)) return -1;
    k = property_index(r, pid, err);
    if (k < 0) return -1;
    if (listed && strcasecmp(kind, "ROD") && strcasecmp(kind, "TUBE") && strcasecmp(kind, "TUBE2")) return 0;
    if (fl_bdf_real(a, listed ? 8 : 2, &x[0], err)) return -1;
    if (strcmp(a->name, "PTUBE") == 0 && fl_bdf_real(a, 5, &x[1], err)) return -1;
    if (x[0] < 0.0 || x[1] < 0.0)
        return fl_bdf_fail(a, err, "%s %lld is %g wide, 0 or more is expected", a->name, (long long)pid,
                           fmin(x[0], x[1]));
    if (strcmp(a->name, "PTUBE") == 0) { /* outer diameters; a blank far end is as the near one */
        r->radius[k][0] = 0.5 * x[0];
        r->radius[k][1] = *fl_bdf_field(a, 5) ? 0.5 * x[1] : 0.5 * x[0];
    } else {
        r->radius[k][0] = r->radius[k][1] = listed ? x[0] : sqrt(x[0] / PI);
    }
    return 0;
}

/* PSOLID PID MID CORDM IN STRESS ISOP FCTN: PFLUID and FFLUID are fluids, which are not structure. */
static int read_solid_property(bdf_reader *r, fl_err *err)
{
    int64_t pid;
    int32_t k;
    if (fl_bdf_id(&r->at, 0, &pid, err)) return -1;
    k = property_index(r, pid, err);
    if (k < 0) return -1;
    r->is_fluid[k] = strcasecmp(fl_bdf_field(&r->at, 6), "PFLUID") == 0 ||
                     strcasecmp(fl_bdf_field(&r->at, 6), "FFLUID") == 0;
    return 0;
}

/* --- grids and coordinate systems ----------------------------------------------------------------------- */

static int32_t system_index(bdf_reader *r, int64_t id, fl_err *err)
{
    const int32_t k = fl_id_map_add(&r->frames, 0, id, err);
    const int32_t had = r->frame_cap;
    if (k < 0 || fl_grow(&r->frame, &r->frame_cap, (int64_t)k + 1, sizeof *r->frame, err)) return -1;
    if (r->frame_cap > had) memset(r->frame + had, 0, (size_t)(r->frame_cap - had) * sizeof *r->frame);
    return k;
}

static int read_grid(bdf_reader *r, fl_err *err)
{
    const fl_bdf_entry *a = &r->at;
    int64_t id, cp;
    fl_vec3 x;
    int32_t k, f = BASIC;
    if (fl_bdf_id(a, 0, &id, err) || fl_bdf_integer(a, 1, -1, &cp, err) || fl_bdf_point(a, 2, &x, err))
        return -1;
    if (cp < -1)
        return fl_bdf_fail(a, err, "field 3 of GRID is \"%.40s\", 0 or more is expected", fl_bdf_field(a, 1));
    if (cp > 0 && (f = system_index(r, cp, err)) < 0) return -1;
    r->e.file = a->file;
    r->e.line = a->line;
    k = fl_elements_add_node(&r->e, 0, id, x, err);
    if (k < 0 || fl_grow(&r->grid, &r->grid_cap, (int64_t)r->e.node_id.n, sizeof *r->grid, err)) return -1;
    r->grid[k] = (grid_ref){cp < 0 ? DEFAULT : cp == 0 ? BASIC : FIRST + f, a->file, a->line};
    return 0;
}

/* CORD1x CID G1 G2 G3, and a second system on the same line; CORD2x CID RID A1 A2 A3 B1 B2 B3 C1 C2 C3. */
static int read_system(bdf_reader *r, fl_err *err)
{
    const fl_bdf_entry *a = &r->at;
    const int by = a->name[4] - '0';
    for (int k = 0; k < (by == 1 ? 8 : 1); k += 4) {
        system_def f = {.kind = a->name[5], .by = by, .file = a->file, .line = a->line};
        int64_t id;
        int32_t at;
        if (k && *fl_bdf_field(a, k) == '\0') break;
        if (fl_bdf_id(a, k, &id, err)) return -1;
        for (int i = 0; i < 3; i++)
            if (by == 1 ? fl_bdf_id(a, k + 1 + i, &f.grid[i], err)
                        : fl_bdf_point(a, 2 + 3 * i, &f.point[i], err))
                return -1;
        if (by == 2 && fl_bdf_integer(a, 1, 0, &f.other, err)) return -1;
        at = system_index(r, id, err);
        if (at < 0) return -1;
        r->frame[at] = f;
    }
    return 0;
}

/* The line, or the grid, that refers to a system; for messages. */
typedef struct {
    int32_t file, line;
    int64_t grid;
} referrer;

static int resolve_system(bdf_reader *r, int64_t id, int depth, system_def **out, referrer referrer_of,
                          fl_err *err);

/* Convert x from a system to the basic one. */
static int to_basic(bdf_reader *r, int64_t id, fl_vec3 *x, int depth, referrer referrer_of, fl_err *err)
{
    system_def *f = NULL;
    fl_vec3 y = *x;
    if (id == 0) return 0;
    if (resolve_system(r, id, depth, &f, referrer_of, err)) return -1;
    if (f->kind != 'R') { /* quarter turns are exact */
        const fl_mat3 about = fl_affine_rotation(v3(0, 0, 1), f->kind == 'C' ? x->y : x->z);
        if (f->kind == 'C') y = v3_add(m3_mul(about, v3(x->x, 0, 0)), v3(0, 0, x->z));
        else y = m3_mul(about, m3_mul(fl_affine_rotation(v3(0, 1, 0), x->y), v3(0, 0, x->x)));
    }
    *x = v3_add(f->point[0], m3_mul(f->axes, y));
    if (isfinite(x->x) && isfinite(x->y) && isfinite(x->z)) return 0;
    return fl_elements_fail(&r->e, referrer_of.file, referrer_of.line, err,
                            "coordinate system %lld leads beyond all numbers", (long long)id);
}

/* Convert a grid to the basic system, once. */
static int resolve_grid(bdf_reader *r, int32_t k, int depth, fl_err *err)
{
    grid_ref *g = &r->grid[k];
    const int32_t cp = g->cp;
    if (cp == BASIC) return 0;
    if (cp == OPEN)
        return fl_elements_fail(&r->e, g->file, g->line, err,
                                "grid %lld stands in a coordinate system that it defines",
                                (long long)r->e.node_id.id[k]);
    g->cp = OPEN;
    if (to_basic(r, cp == DEFAULT ? r->grdset : r->frames.id[cp - FIRST], &r->e.x[k], depth,
                 (referrer){g->file, g->line, r->e.node_id.id[k]}, err))
        return -1;
    g->cp = BASIC;
    return 0;
}

/* Resolve a system, after those that define it. */
static int resolve_system(bdf_reader *r, int64_t id, int depth, system_def **out, referrer referrer_of,
                          fl_err *err)
{
    const int32_t at = fl_id_map_find(&r->frames, 0, id);
    system_def *f = at < 0 ? NULL : &r->frame[at];
    if ((!f || !f->by) && referrer_of.grid)
        return fl_elements_fail(&r->e, referrer_of.file, referrer_of.line, err,
                                "grid %lld refers to coordinate system %lld, which is not defined",
                                (long long)referrer_of.grid, (long long)id);
    if (!f || !f->by)
        return fl_elements_fail(&r->e, referrer_of.file, referrer_of.line, err,
                                "coordinate system %lld is not defined", (long long)id);
    *out = f;
    if (f->state == 2) return 0;
    if (f->state == 1)
        return fl_elements_fail(&r->e, f->file, f->line, err, "coordinate system %lld is defined by itself",
                                (long long)id);
    if (depth == MAX_DEPTH)
        return fl_elements_fail(&r->e, f->file, f->line, err,
                                "coordinate systems are defined in one another more than %d deep", MAX_DEPTH);
    f->state = 1;
    for (int i = 0; i < 3; i++) {
        if (f->by == 1) {
            const int32_t k = fl_id_map_find(&r->e.node_id, 0, f->grid[i]);
            if (k < 0 || isnan(r->e.x[k].x))
                return fl_elements_fail(&r->e, f->file, f->line, err, "grid %lld is not defined",
                                        (long long)f->grid[i]);
            if (resolve_grid(r, k, depth + 1, err)) return -1;
            f->point[i] = r->e.x[k];
        } else if (to_basic(r, f->other, &f->point[i], depth + 1, (referrer){f->file, f->line, 0}, err)) {
            return -1;
        }
    }
    const fl_vec3 z = v3_unit(v3_sub(f->point[1], f->point[0]));
    const fl_vec3 y = v3_unit(v3_cross(z, v3_unit(v3_sub(f->point[2], f->point[0])))), x = v3_cross(y, z);
    if (!(v3_norm(z) > 0.5) || !(v3_norm(y) > 0.5))
        return fl_elements_fail(&r->e, f->file, f->line, err,
                                "the points of coordinate system %lld lie on one line", (long long)id);
    f->axes = (fl_mat3){{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
    f->state = 2;
    return 0;
}

/* --- elements ------------------------------------------------------------------------------------------- */

static const struct {
    const char *name;
    enum fl_shape linear, quadratic; /* quadratic: FL_SHAPES if there is none */
} ELEMENT[] = {{"CTRIA3", FL_TRI3, FL_SHAPES},       {"CTRIAR", FL_TRI3, FL_SHAPES},
               {"CTRIA6", FL_TRI3, FL_TRI6},         {"CPLSTN3", FL_TRI3, FL_SHAPES},
               {"CPLSTS3", FL_TRI3, FL_SHAPES},      {"CQUAD4", FL_QUAD4, FL_SHAPES},
               {"CQUADR", FL_QUAD4, FL_SHAPES},      {"CQUAD8", FL_QUAD4, FL_QUAD8},
               {"CQUAD", FL_QUAD4, FL_QUAD9},        {"CSHEAR", FL_QUAD4, FL_SHAPES},
               {"CPLSTN4", FL_QUAD4, FL_SHAPES},     {"CPLSTS4", FL_QUAD4, FL_SHAPES},
               {"CTETRA", FL_TET4, FL_TET10},        {"CPYRAM", FL_PYRAMID5, FL_PYRAMID13},
               {"CPYRA", FL_PYRAMID5, FL_PYRAMID13}, {"CPENTA", FL_WEDGE6, FL_WEDGE15},
               {"CHEXA", FL_HEX8, FL_HEX20},         {"CBAR", FL_LINE2, FL_SHAPES},
               {"CBEAM", FL_LINE2, FL_SHAPES},       {"CROD", FL_LINE2, FL_SHAPES},
               {"CTUBE", FL_LINE2, FL_SHAPES},       {"CONROD", FL_LINE2, FL_SHAPES}};

/* Nastran lists the mid-side nodes between bottom and top before those of the top, elements.h behind them. */
static void reorder_mids(enum fl_shape shape, int64_t *node)
{
    const int n = shape == FL_HEX20 ? 4 : shape == FL_WEDGE15 ? 3 : 0;
    int64_t *upright = node + fl_shape_corners(shape) + n, *top = upright + n;
    for (int k = 0; k < n; k++) {
        const int64_t keep = upright[k];
        upright[k] = top[k];
        top[k] = keep;
    }
}

static int read_element(bdf_reader *r, enum fl_shape linear, enum fl_shape quadratic, fl_err *err)
{
    const fl_bdf_entry *a = &r->at;
    const int rod = strcmp(a->name, "CONROD") == 0, first = rod ? 1 : 2, corners = fl_shape_nodes(linear);
    enum fl_shape shape = linear;
    int64_t id, pid = CONROD, node[20];
    int32_t p, k;
    if (fl_bdf_id(a, 0, &id, err)) return -1;
    if (!rod && (fl_bdf_integer(a, 1, id, &pid, err) || pid < 1))
        return fl_bdf_fail(a, err, "field 3 of %s is \"%.40s\", a property is expected", a->name,
                           fl_bdf_field(a, 1));
    p = property_index(r, pid, err);
    if (p < 0) return -1;
    for (int i = 0; i < corners; i++)
        if (fl_bdf_id(a, first + i, &node[i], err)) return -1;
    for (int i = corners; quadratic < FL_SHAPES && i < fl_shape_nodes(quadratic); i++) {
        if (fl_bdf_integer(a, first + i, 0, &node[i], err)) return -1;
        if (node[i]) shape = quadratic;
    }
    reorder_mids(shape, node);
    r->e.file = a->file;
    r->e.line = a->line;
    k = fl_elements_add(&r->e, 0, id, shape, p, node, err);
    if (k < 0 || fl_grow(&r->grid, &r->grid_cap, (int64_t)r->e.node_id.n, sizeof *r->grid, err)) return -1;
    if (rod) {
        double area;
        if (fl_bdf_real(a, 4, &area, err)) return -1;
        if (area < 0.0) return fl_bdf_fail(a, err, "CONROD %lld has the area %g", (long long)id, area);
        return fl_elements_set_radius(&r->e, k, sqrt(area / PI), sqrt(area / PI), err);
    }
    return 0;
}

/* Elements without a surface, by the beginning of their names. */
static int has_no_surface(const char *name)
{
    static const char *const family[] = {
        "CELAS",  "CDAMP",  "CMASS",  "CONM",    "CBUSH",  "CGAP",   "CVISC",  "CWELD",  "CFAST",
        "CSEAM",  "CRAC",   "CTRIAX", "CQUADX",  "CHBDY",  "CHACAB", "CHACBR", "CBEND",  "CBEAM3",
        "CDUM",   "CAXIF",  "CSLOT",  "CFLUID",  "CCONE",  "CINT",   "RBE",    "RBAR",   "RROD",
        "RTRPLT", "RJOINT", "RSPLIN", "RSSCON",  "PLOTEL", "GENEL",  "CPLSTN", "CPLSTS", "CSPOT",
        "CACINF", "CIFHEX", "CIFPEN", "CIFQUAD", "CDUMMY", "CNGRET"};
    for (size_t k = 0; k < sizeof family / sizeof *family; k++)
        if (strncmp(name, family[k], strlen(family[k])) == 0) return 1;
    return 0;
}

/* True for a model of its own behind BEGIN: [BULK] SUPER=1, AUXMODEL=1, ARBMODEL=1, MODULE=1.  SUPER=0 is the
 * residual structure itself. */
static int begins_other_model(const char *line, const char **what)
{
    static const char *const model[] = {"SUPER", "AUXMODEL", "ARBMODEL", "MODULE"};
    const char *p = line + strspn(line, " \t") + 5;
    p += strspn(p, " \t,");
    if (strncasecmp(p, "BULK", 4) == 0) p += 4 + strspn(p + 4, " \t,");
    for (size_t k = 0; k < sizeof model / sizeof *model; k++) {
        const size_t n = strlen(model[k]);
        const char *number = p + n;
        if (strncasecmp(p, model[k], n) != 0 || isalpha((unsigned char)p[n])) continue;
        *what = model[k];
        number += strspn(number, " \t=");
        return strspn(number, "0") == 0 || isdigit((unsigned char)number[strspn(number, "0")]);
    }
    return 0;
}

/* --- the deck ------------------------------------------------------------------------------------------- */

static int read_entry(bdf_reader *r, fl_err *err)
{
    const fl_bdf_entry *a = &r->at;
    const char *name = a->name, *what;
    int64_t cp;
    if (strcmp(name, "GRID") == 0) return read_grid(r, err);
    for (size_t k = 0; k < sizeof ELEMENT / sizeof *ELEMENT; k++)
        if (strcmp(name, ELEMENT[k].name) == 0)
            return read_element(r, ELEMENT[k].linear, ELEMENT[k].quadratic, err);
    if (strlen(name) == 6 && strncmp(name, "CORD", 4) == 0 && strchr("12", name[4]) && strchr("RCS", name[5]))
        return read_system(r, err);
    if (strcmp(name, "GRDSET") == 0) {
        if (fl_bdf_integer(a, 1, 0, &cp, err)) return -1;
        if (cp < 0) return fl_bdf_fail(a, err, "GRDSET names coordinate system %lld", (long long)cp);
        r->grdset = cp;
        return 0;
    }
    if (strcmp(name, "PTUBE") == 0 || strcmp(name, "PBARL") == 0 || strcmp(name, "PBEAML") == 0 ||
        strcmp(name, "PROD") == 0)
        return read_section(r, err);
    if (name[0] == '=')
        return fl_bdf_fail(a, err, "replication (=) is not read: export all grids and elements written out");
    if (strcmp(name, "BEGIN") == 0 && begins_other_model(a->deck.line, &what))
        return fl_bdf_fail(a, err, "BEGIN %s is not read: export one model, without superelements or others",
                           what);
    if (strcmp(name, "PSOLID") == 0) return read_solid_property(r, err);
    if (has_no_surface(name)) return fl_elements_skip(&r->e, name, err);
    return 0;
}

/* Convert all grids to the basic system. */
static int resolve_grids(bdf_reader *r, fl_err *err)
{
    for (int32_t k = 0; k < r->e.node_id.n; k++) {
        if (isnan(r->e.x[k].x) || r->grid[k].cp == BASIC || (r->grid[k].cp == DEFAULT && r->grdset == 0))
            continue;
        if (resolve_grid(r, k, 0, err)) return -1;
    }
    return 0;
}

/* Turn properties into parts; a repeated name gets the number of its property appended. */
static int name_parts(bdf_reader *r, fl_err *err)
{
    int32_t *part = fl_alloc(r->pids.n, sizeof *part, err);
    int rc = -1;
    if (!part) return -1;
    for (int32_t k = 0; k < r->pids.n; k++) part[k] = -1;
    for (int32_t i = 0; i < r->e.element_id.n; i++) {
        fl_element *el = &r->e.element[i];
        const int32_t k = el->part;
        if (r->is_fluid[k]) {
            el->part = -1;
            if (fl_elements_skip(&r->e, "solids of PFLUID", err)) goto done;
            continue;
        }
        if (part[k] < 0) {
            const long long pid = r->pids.id[k];
            char name[NAME_MAX + 40];
            if (pid < 0) snprintf(name, sizeof name, "conrod");
            else if (!r->name[k]) snprintf(name, sizeof name, "property_%lld", pid);
            else if (fl_string_table_find(&r->e.parts, r->name[k]) < 0)
                snprintf(name, sizeof name, "%s", r->name[k]);
            else snprintf(name, sizeof name, "%s_%lld", r->name[k], pid);
            part[k] = fl_string_table_add(&r->e.parts, name, err);
            if (part[k] < 0) goto done;
        }
        el->part = part[k];
        if ((el->shape == FL_LINE2 || el->shape == FL_LINE3) && !isnan(r->radius[k][0]) &&
            fl_elements_set_radius(&r->e, i, r->radius[k][0], r->radius[k][1], err))
            goto done;
    }
    rc = 0;
done:
    free(part);
    return rc;
}

/* Positions of the grids of the frame, and orientations by a grid. */
static void place_frame(bdf_reader *r)
{
    fl_frame_model *f = r->beams;
    for (int32_t k = 0; k < f->node_id.n; k++) {
        const int32_t at = fl_id_map_find(&r->e.node_id, 0, f->node_id.id[k]);
        if (at < 0 || isnan(r->e.x[at].x)) continue;
        f->node[k].x = r->e.x[at];
        f->node[k].defined = 1;
    }
    for (int32_t k = 0; k < f->element_id.n; k++) {
        fl_frame_element *e = &f->element[k];
        if (e->has_y != 2) continue;
        e->across = v3_sub(f->node[(int32_t)e->across.x].x, f->node[e->node[0]].x);
        e->has_y = 1;
    }
}

static void free_reader(bdf_reader *r)
{
    for (int32_t k = 0; k < r->pids.n; k++) free(r->name[k]);
    fl_bdf_entry_free(&r->at);
    fl_elements_free(&r->e);
    fl_id_map_free(&r->frames);
    fl_id_map_free(&r->pids);
    free(r->frame);
    free(r->grid);
    free(r->name);
    free(r->radius);
    free(r->is_fluid);
}

int fl_bdf_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    bdf_reader r = {.at = {.comment = read_name_comment}};
    int rc = -1, more;
    (void)name; /* every element has a property or is a CONROD */
    r.at.context = &r;
    if (fl_elements_start(&r.e, fl_in_name(b->in), err)) goto done;
    fl_deck_start(&r.at.deck, &r.e, b);
    if (opt) r.beams = opt->frame;
    r.at.frame = r.beams != NULL;
    while ((more = fl_bdf_next(&r.at, err)) > 0)
        if (read_entry(&r, err) || (r.beams && fl_frame_bdf_entry(r.beams, &r.at, err))) goto done;
    if (more < 0) goto done;
    if (r.at.missing)
        fl_bytes_note(b, "%d INCLUDE before BEGIN BULK could not be read and were skipped", r.at.missing);
    fl_bdf_entry_free(&r.at); /* saves the memory of a second copy of a large deck */
    free(b->data);
    b->data = NULL;
    b->n = b->cap = 0;
    if (resolve_grids(&r, err)) goto done;
    if (r.beams) {
        place_frame(&r);
        rc = 0;
        goto done;
    }
    if (name_parts(&r, err)) goto done;
    rc = fl_elements_surface(&r.e, s, b, opt, err);
done:
    free_reader(&r);
    return rc;
}
