/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/frame_cdb.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "mesh/deck_lines.h"

/* --- elements ---------------------------------------------------------------------------------- */

static int is_beam(int32_t routine)
{
    return routine == 188 || routine == 189 || routine == 4 || routine == 3 || routine == 44;
}

static int is_pipe(int32_t routine) { return routine == 288 || routine == 289 || routine == 16; }

static int is_truss(int32_t routine) { return routine == 180 || routine == 8 || routine == 1; }

int fl_frame_cdb_element(fl_frame_cdb *f, int64_t id, int32_t routine, int64_t material, int64_t section,
                         int64_t real, int nodes, const int64_t *node, fl_err *err)
{
    fl_frame_model *m = f->model;
    const int line = is_beam(routine) || is_pipe(routine) || is_truss(routine);
    if (!line && routine != 21) return fl_frame_count_skipped(m, "elements of routine %d", (int)routine);
    if (nodes < (line ? 2 : 1)) return 0; /* the reader of the mesh refuses it */
    if (fl_grow(&f->line, &f->line_cap, (int64_t)f->lines + 1, sizeof *f->line, err)) return -1;
    fl_frame_cdb_line l = {
        .element = -1, .routine = routine, .material = material, .section = section, .real = real};
    if (line) {
        const int32_t k = fl_frame_element_of(m, 0, id < 1 ? -1 - (int64_t)f->lines : id, err);
        if (k < 0) return -1;
        m->element[k].truss = is_truss(routine);
        for (int s = 0; s < 2; s++)
            if ((m->element[k].node[s] = fl_frame_node_of(m, 0, node[s], err)) < 0) return -1;
        const int third = routine == 189 ? 3 : 2;
        if (is_beam(routine) && nodes > third && node[third] > 0) l.third = node[third];
        if (l.third && fl_frame_node_of(m, 0, l.third, err) < 0) return -1;
        if ((routine == 189 || routine == 289) &&
            fl_frame_count_skipped(m, "middle nodes of BEAM189 and PIPE289"))
            return -1;
        l.element = k;
    } else if ((l.node = fl_frame_node_of(m, 0, node[0], err)) < 0) return -1;
    f->line[f->lines++] = l;
    return 0;
}

int fl_frame_cdb_constant(fl_frame_cdb *f, int64_t real, int k, double x, fl_err *err)
{
    const int32_t had = f->real_id.n, at = fl_id_map_add(&f->real_id, 0, real, err);
    if (at < 0 || fl_grow(&f->constant, &f->constant_cap, (int64_t)f->real_id.n, sizeof *f->constant, err))
        return -1;
    if (f->real_id.n > had) memset(f->constant[at], 0, sizeof f->constant[at]);
    if (k < FL_FRAME_CONSTANTS) f->constant[at][k] = x;
    return 0;
}

/* --- sections ---------------------------------------------------------------------------------- */

static int32_t section_of(fl_frame_cdb *f, const char *kind, int64_t id, fl_err *err)
{
    char name[40];
    snprintf(name, sizeof name, "%s%lld", kind, (long long)id);
    return fl_frame_section_of(f->model, name, err);
}

int fl_frame_cdb_section(fl_frame_cdb *f, int64_t id, const char *type, const char *subtype,
                         char *const *word, fl_err *err)
{
    double x[6] = {0};
    fl_frame_section s = {.material = -1};
    if (id < 1) return 0;
    const int32_t k = section_of(f, "section", id, err);
    if (k < 0) return -1;
    if (f->model->section[k].form != FL_FRAME_NONE) return 0; /* a second line of data: cells of the mesh */
    for (int d = 0; d < 6; d++)
        if (*word[d + 1] && fl_deck_real(word[d + 1], &x[d])) x[d] = 0.0;
    if (strncasecmp(type, "PIPE", 4) == 0) {
        s.form = FL_FRAME_PIPE, s.size[0] = x[0], s.size[1] = x[1];
    } else if (strncasecmp(type, "LINK", 4) == 0) {
        s.form = FL_FRAME_GENERAL, s.a = x[0];
    } else if (strncasecmp(subtype, "RECT", 4) == 0) {
        s.form = FL_FRAME_RECTANGLE, s.size[0] = x[0], s.size[1] = x[1];
    } else if (strncasecmp(subtype, "CTUB", 4) == 0) {
        s.form = FL_FRAME_PIPE, s.size[0] = 2.0 * x[1], s.size[1] = x[1] - x[0];
    } else if (strncasecmp(subtype, "CSOL", 4) == 0) {
        s = fl_frame_section_rod(x[0]);
    } else if (strncasecmp(subtype, "ASEC", 4) == 0) { /* A Iyy Iyz Izz Iw J */
        s.form = FL_FRAME_GENERAL, s.a = x[0], s.iy = x[1], s.iz = x[3], s.j = x[5];
        if (x[2] != 0.0 && fl_frame_count_skipped(f->model, "SECDATA of ASEC: Iyz")) return -1;
    } else {
        return fl_frame_count_skipped(f->model, "SECTYPE %s, %s: its elements have no section", type,
                                      subtype);
    }
    f->model->section[k] = s;
    return 0;
}

/* The section of an element by its real constants. */
static fl_frame_section by_constants(int32_t routine, const double *x)
{
    fl_frame_section s = {.form = FL_FRAME_GENERAL, .material = -1, .a = x[0]};
    if (routine == 16) s = (fl_frame_section){.form = FL_FRAME_PIPE, .material = -1, .size = {x[0], x[1]}};
    if (routine == 4) { /* AREA IZZ IYY TKZ TKY THETA ISTRN IXX SHEARZ SHEARY SPIN ADDMAS */
        s.iz = x[1], s.iy = x[2], s.j = x[7] > 0.0 ? x[7] : x[1] + x[2], s.other_mass = x[11];
    }
    if (routine == 3) s.iz = s.iy = x[1], s.j = 2.0 * x[1];
    return s;
}

static int32_t material_of(fl_frame_cdb *f, int64_t id, fl_err *err)
{
    char name[40];
    snprintf(name, sizeof name, "m%lld", (long long)id);
    return fl_frame_material_of(f->model, name, err);
}

/* Each pair of section and material is a section of the frame. */
static int32_t pair_of(fl_frame_cdb *f, const fl_frame_cdb_line *l, fl_err *err)
{
    const int by_section = is_pipe(l->routine) ? l->routine != 16 : l->routine == 188 || l->routine == 189;
    fl_frame_section s = {.material = -1};
    char name[80];
    const char *kind = "section";
    int64_t id = l->section;
    int32_t k = section_of(f, "section", l->section, err);
    if (k < 0) return -1;
    s = f->model->section[k];
    if (!by_section && (s.form == FL_FRAME_NONE || !is_truss(l->routine))) {
        const int32_t at = fl_id_map_find(&f->real_id, 0, l->real);
        kind = "real", id = l->real;
        if (at >= 0) s = by_constants(l->routine, f->constant[at]);
    }
    s.material = material_of(f, l->material, err);
    snprintf(name, sizeof name, "%s%lld.m%lld", kind, (long long)id, (long long)l->material);
    if (s.material < 0 || (k = fl_frame_section_of(f->model, name, err)) < 0) return -1;
    f->model->section[k] = s;
    return k;
}

int fl_frame_cdb_finish(fl_frame_cdb *f, fl_err *err)
{
    fl_frame_model *m = f->model;
    for (int32_t k = 0; k < f->lines; k++) {
        const fl_frame_cdb_line *l = &f->line[k];
        if (l->element < 0) {
            const int32_t at = fl_id_map_find(&f->real_id, 0, l->real);
            if (at >= 0) m->node[l->node].mass += f->constant[at][0];
            continue;
        }
        fl_frame_element *e = &m->element[l->element];
        char part[40];
        snprintf(part, sizeof part, "section_%lld", (long long)l->section);
        if ((e->section = pair_of(f, l, err)) < 0 || (e->part = fl_frame_part_of(m, part, err)) < 0)
            return -1;
        if (!l->third) continue;
        const int32_t third = fl_id_map_find(&m->node_id, 0, l->third);
        e->has_z = 1;
        e->across = v3_sub(m->node[third].x, m->node[e->node[0]].x);
    }
    return 0;
}

/* --- commands ---------------------------------------------------------------------------------- */

static int set_constant(fl_frame_cdb *f, const char *label, const char *material, const char *value,
                        fl_err *err)
{
    int64_t id;
    double x;
    if (fl_deck_integer(material, &id) || fl_deck_real(value, &x)) return 0;
    const int32_t k = material_of(f, id, err);
    if (k < 0) return -1;
    fl_frame_material *m = &f->model->material[k];
    if (strcasecmp(label, "EX") == 0) m->e = x;
    else if (strcasecmp(label, "GXY") == 0) m->g = x;
    else if (strcasecmp(label, "PRXY") == 0 || strcasecmp(label, "NUXY") == 0) m->nu = x;
    else if (strcasecmp(label, "DENS") == 0) m->rho = x;
    return 0;
}

static int set_freedom(fl_frame_cdb *f, char *const *word, int load, fl_err *err)
{
    static const char *const held[] = {"UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"};
    static const char *const pushed[] = {"FX", "FY", "FZ", "MX", "MY", "MZ"};
    int64_t id;
    double x = 0.0;
    if (fl_deck_integer(word[1], &id) || id < 1)
        return fl_frame_count_skipped(f->model, "%s of other than one node", word[0]);
    const int32_t k = fl_frame_node_of(f->model, 0, id, err);
    if (k < 0) return -1;
    fl_frame_node *n = &f->model->node[k];
    if (*word[3] && fl_deck_real(word[3], &x)) x = 0.0;
    double *const to[] = {&n->force.x, &n->force.y, &n->force.z, &n->moment.x, &n->moment.y, &n->moment.z};
    for (int d = 0; d < 6; d++) {
        if (load && strcasecmp(word[2], pushed[d]) == 0) *to[d] += x;
        if (!load && (strcasecmp(word[2], held[d]) == 0 || strcasecmp(word[2], "ALL") == 0))
            n->fixed |= 1 << d;
    }
    if (!load && x != 0.0)
        return fl_frame_count_skipped(f->model, "D: imposed displacements; the freedom is held");
    return 0;
}

/* Commands that say nothing about the structure. */
static int says_nothing(const char *word)
{
    static const char *const no[] = {
        "/PREP7", "/COM",  "/TITLE",    "/UNITS",      "/NOPR",    "/GO",    "/GOPR", "FINISH", "*IF",
        "*ENDIF", "*GET",  "*SET",      "NUMOFF",      "SHPP",     "CSYS",   "LOCAL", "EXTOPT", "MPTEMP",
        "TREF",   "CMGRP", "SECOFFSET", "SECCONTROLS", "SECBLOCK", "KEYOPT", "DOF",   "ANTYPE", "SOLVE",
        "/SOLU",  "/EXIT", "/BATCH",    "*DO",         "*ENDDO",   "ERESX",  "ACEL",  "OMEGA",  "TIME",
        "BFUNIF", "IRLF",  "LSWRITE",   "/WB",         "_WB",      "/INPUT"};
    for (size_t k = 0; k < sizeof no / sizeof *no; k++)
        if (strcasecmp(word, no[k]) == 0) return 1;
    return word[0] == '/';
}

int fl_frame_cdb_command(fl_frame_cdb *f, char *const *word, int64_t constants, fl_err *err)
{
    if (strcasecmp(word[0], "MP") == 0) return set_constant(f, word[1], word[2], word[3], err);
    if (strcasecmp(word[0], "MPDATA") == 0) {
        const int blocked = strncasecmp(word[1], "R5", 2) == 0, from = blocked ? 3 : 1;
        int64_t place;
        if (fl_deck_integer(word[from + 2], &place) || place != 1) return 0; /* of other temperatures */
        return set_constant(f, word[from], word[from + 1], word[from + 3], err);
    }
    if (strcasecmp(word[0], "D") == 0) return set_freedom(f, word, 0, err);
    if (strcasecmp(word[0], "F") == 0) return set_freedom(f, word, 1, err);
    if (strcasecmp(word[0], "RMORE") == 0) {
        for (int k = 0; k < 6; k++) {
            double x;
            if (*word[k + 1] && fl_deck_real(word[k + 1], &x) == 0 &&
                fl_frame_cdb_constant(f, constants, 6 + k, x, err))
                return -1;
        }
        return 0;
    }
    return says_nothing(word[0]) ? 0 : fl_frame_count_skipped(f->model, "%s", word[0]);
}

void fl_frame_cdb_free(fl_frame_cdb *f)
{
    fl_id_map_free(&f->real_id);
    free(f->constant), free(f->line);
}
