/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/read_sacs.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "mesh/beam_deck.h"

enum { JOINT_NAME = 5, WIDEST = 12 };

/* A line of a group: a segment of its members. */
typedef struct {
    int32_t group, next;   /* next: segment of the same group, -1 */
    int32_t section[2];    /* at either end, index in k.section; -1: no section of the file */
    double length;         /* 0: the rest */
    char taper, wanted[8]; /* column 9; name of the section */
    double d, wall, e, g;
    int32_t line;
} sacs_segment;

typedef struct {
    char joint[2][JOINT_NAME];
    char group[4];
    int local;
    fl_vec3 offset[2];
    unsigned pins[2]; /* as in fl_frame_element */
    int32_t line;
} sacs_member;

typedef struct {
    fl_beam_deck k;
    fl_string_table joint, group, section_name;
    struct sacs_shape {
        char kind[4];
        double size[4];
    } * shape; /* [section_name.n] */
    sacs_segment *segment;
    int32_t *head, *tail; /* [group.n] */
    sacs_member *member;
    struct sacs_plate {
        int32_t line;
        char joint[4][JOINT_NAME];
    } * plate;
    int32_t shapes, segments, members, plates, shape_cap, segment_cap, head_cap, tail_cap, member_cap,
        plate_cap;
    double length, small;        /* metres in a unit of coordinates, and of sizes; 0: not known */
    double stress, density, rho; /* Pa in a unit of moduli, kg/m3 in one of densities */
    int32_t local_offsets, pile_heads, sliding; /* sliding: members with a released force */
} sacs_reader;

/* --- columns -------------------------------------------------------------------------------------------- */

/* Columns from..to of a line, counted from 1, without blanks around. */
static const char *cut_columns(const char *line, int32_t len, int from, int to, char *text, size_t size)
{
    int32_t n = to < len ? to - from + 1 : len - from + 1;
    if (n < 0) n = 0;
    if ((size_t)n >= size) n = (int32_t)size - 1;
    memcpy(text, line + (n ? from - 1 : 0), (size_t)n);
    text[n] = '\0';
    char *trimmed = fl_deck_trim(text);
    memmove(text, trimmed, strlen(trimmed) + 1);
    return text;
}

static int begins(const char *line, const char *word)
{
    const size_t n = strlen(word);
    return strncmp(line, word, n) == 0 && (line[n] == '\0' || strchr(" \t\r\n", line[n]) != NULL);
}

/* Same; the letters behind the word may touch it, as the flag of a MEMBER does. */
static int begins_with_letters(const char *line, const char *word)
{
    return strncmp(line, word, strlen(word)) == 0;
}

static int is_joint_line(const char *p)
{
    char text[WIDEST];
    double x;
    const int32_t len = (int32_t)strcspn(p, "\r\n");
    if (!begins(p, "JOINT") || len < 18) return 0;
    cut_columns(p, len, 7, 10, text, sizeof text);
    if (!*text || strchr(text, ' ')) return 0;
    for (int k = 0; k < 3; k++) {
        cut_columns(p, len, 12 + 7 * k, 18 + 7 * k, text, sizeof text);
        if (*text && fl_deck_real(text, &x)) return 0;
    }
    return 1;
}

int fl_sacs_is(const fl_bytes *b)
{
    int joint = 0, element = 0;
    for (const char *p = b->data; *p && !(joint && element); p += strcspn(p, "\n"), p += *p == '\n') {
        joint = joint || is_joint_line(p);
        if (element || strcspn(p, "\r\n") < 8) continue;
        element = begins_with_letters(p, "MEMBER") || begins(p, "GRUP") || begins(p, "PLATE");
    }
    return joint && element;
}

/* Columns as a number; blank is 0. */
static int column_real(sacs_reader *r, int from, int to, double *x, fl_err *err)
{
    char text[WIDEST];
    *x = 0.0;
    cut_columns(r->k.d.line, r->k.d.len, from, to, text, sizeof text);
    if (!*text || fl_deck_real(text, x) == 0) return 0;
    return fl_deck_fail(&r->k.d, err, "columns %d to %d are \"%s\", a number is expected", from, to, text);
}

/* --- lines ---------------------------------------------------------------------------------------------- */

static int sacs_options(sacs_reader *r, fl_err *err)
{
    char unit[4];
    cut_columns(r->k.d.line, r->k.d.len, 14, 15, unit, sizeof unit);
    r->length = 1.0, r->small = 0.01, r->stress = 1e10, r->density = 1000.0; /* m cm, 1000 kN/cm2, t/m3 */
    if (strcmp(unit, "MN") == 0 || strcmp(unit, "ME") == 0) return 0;
    if (strcmp(unit, "EN") != 0)
        return fl_deck_fail(&r->k.d, err,
                            "columns 14 and 15 of OPTIONS are \"%s\", units MN, ME (metric) or EN (feet and "
                            "inches) are expected",
                            unit);
    r->length = 0.3048, r->small = 0.0254, r->stress = 6.894757293168e9, r->density = 16.01846337396;
    fl_bytes_note(r->k.b, "feet and inches (OPTIONS EN) were converted to metres: no --unit is needed");
    return 0;
}

/* The number of a joint: its index plus one. */
static int64_t joint_number(sacs_reader *r, const char *name, fl_err *err)
{
    return fl_string_table_add(&r->joint, name, err) + (int64_t)1;
}

static int sacs_joint(sacs_reader *r, fl_err *err)
{
    char name[JOINT_NAME], fixity[8];
    double x[3], more;
    int fixed = 0;
    cut_columns(r->k.d.line, r->k.d.len, 7, 10, name, sizeof name);
    cut_columns(r->k.d.line, r->k.d.len, 55, 60, fixity, sizeof fixity);
    if (!*name || strcmp(fixity, "ELASTI") == 0) return 0;
    if (!(r->length > 0.0))
        return fl_deck_fail(&r->k.d, err,
                            "no OPTIONS line before it says the units: MN, ME (metric) or EN (feet and "
                            "inches) in its columns 14 and 15 are expected");
    for (int k = 0; k < 3; k++) {
        if (column_real(r, 12 + 7 * k, 18 + 7 * k, &x[k], err) ||
            column_real(r, 33 + 7 * k, 39 + 7 * k, &more, err))
            return -1;
        x[k] = r->length * x[k] + r->small * more;
    }
    for (int k = 0; fixity[k]; k++) fixed |= (fixity[k] == '1') << k;
    if (strcmp(fixity, "PILEHD") == 0) {
        fixed = 63;
        r->pile_heads++;
    }
    const int64_t id = joint_number(r, name, err);
    if (id < 1 || fl_elements_add_node(&r->k.e, 0, id, v3(x[0], x[1], x[2]), err) < 0) return -1;
    return fl_beam_deck_hold(&r->k, id, fixed & 63, err);
}

static int sacs_offsets(sacs_reader *r, fl_err *err)
{
    if (r->members == 0) return 0;
    sacs_member *m = &r->member[r->members - 1];
    double x[6];
    for (int k = 0; k < 6; k++)
        if (column_real(r, 36 + 6 * k, 41 + 6 * k, &x[k], err)) return -1;
    if (m->local) {
        r->local_offsets++;
        return 0;
    }
    m->offset[0] = v3(x[0], x[1], x[2]);
    m->offset[1] = v3(x[3], x[4], x[5]);
    return 0;
}

/* Six digits of one end, forces and moments along local x y z: 1 is released. */
static unsigned released_moments(sacs_reader *r, int from, int *force)
{
    unsigned pins = 0;
    for (int k = 0; k < 6 && from - 1 + k < r->k.d.len; k++) {
        if (r->k.d.line[from - 1 + k] != '1') continue;
        if (k < 3) *force = 1;
        else pins |= 1u << (k - 3);
    }
    return pins;
}

static int sacs_add_member(sacs_reader *r, fl_err *err)
{
    sacs_member m = {.line = r->k.e.line};
    const char *line = r->k.d.line;
    const int32_t len = r->k.d.len;
    char word[WIDEST];
    if (strcmp(cut_columns(line, len, 8, 14, word, sizeof word), "OFFSETS") == 0) return sacs_offsets(r, err);
    m.local = len > 6 && line[6] == '2';
    cut_columns(line, len, 8, 11, m.joint[0], sizeof m.joint[0]);
    cut_columns(line, len, 12, 15, m.joint[1], sizeof m.joint[1]);
    cut_columns(line, len, 17, 19, m.group, sizeof m.group);
    if (!m.joint[0][0] || !m.joint[1][0]) return 0;
    int force = 0;
    for (int s = 0; s < 2; s++) m.pins[s] = released_moments(r, 23 + 6 * s, &force);
    r->sliding += force;
    if (fl_grow(&r->member, &r->member_cap, (int64_t)r->members + 1, sizeof *r->member, err)) return -1;
    r->member[r->members++] = m;
    return 0;
}

static int sacs_group(sacs_reader *r, fl_err *err)
{
    char name[4];
    sacs_segment g = {.next = -1, .section = {-1, -1}, .line = r->k.e.line};
    const char *line = r->k.d.line;
    const int32_t len = r->k.d.len;
    cut_columns(line, len, 6, 8, name, sizeof name);
    if (!*name) return 0;
    g.taper = len > 8 ? line[8] : ' ';
    cut_columns(line, len, 10, 16, g.wanted, sizeof g.wanted);
    if (column_real(r, 18, 23, &g.d, err) || column_real(r, 24, 29, &g.wall, err) ||
        column_real(r, 31, 35, &g.e, err) || column_real(r, 36, 40, &g.g, err) ||
        column_real(r, 77, 80, &g.length, err))
        return -1;
    const int32_t had = r->group.n, at = fl_string_table_add(&r->group, name, err);
    if (at < 0 || fl_grow(&r->head, &r->head_cap, r->group.n, sizeof *r->head, err) ||
        fl_grow(&r->tail, &r->tail_cap, r->group.n, sizeof *r->tail, err) ||
        fl_grow(&r->segment, &r->segment_cap, (int64_t)r->segments + 1, sizeof *r->segment, err))
        return -1;
    g.group = at;
    r->segment[r->segments] = g;
    if (at == had) r->head[at] = r->segments;
    else r->segment[r->tail[at]].next = r->segments;
    r->tail[at] = r->segments++;
    return 0;
}

static int sacs_section(sacs_reader *r, fl_err *err)
{
    static const int FROM[4] = {50, 56, 61, 67}, TO[4] = {55, 60, 66, 71};
    char name[8];
    struct sacs_shape s = {0};
    cut_columns(r->k.d.line, r->k.d.len, 6, 12, name, sizeof name);
    if (!*name) return 0;
    cut_columns(r->k.d.line, r->k.d.len, 16, 18, s.kind, sizeof s.kind);
    const int round = strcmp(s.kind, "TUB") == 0 || strcmp(s.kind, "CON") == 0;
    for (int k = 0; round && k < 4; k++)
        if (column_real(r, FROM[k], TO[k], &s.size[k], err)) return -1;
    if (round && !(s.size[0] > 0.0))
        return fl_deck_fail(&r->k.d, err, "section %s has the diameter %g, a length above 0 is expected",
                            name, s.size[0]);
    if (strcmp(s.kind, "CON") == 0 && !(s.size[2] > 0.0))
        return fl_deck_fail(&r->k.d, err,
                            "section %s has the second diameter %g, a length above 0 is expected", name,
                            s.size[2]);
    const int32_t at = fl_string_table_add(&r->section_name, name, err);
    if (at < 0 || fl_grow(&r->shape, &r->shape_cap, r->section_name.n, sizeof *r->shape, err)) return -1;
    r->shape[at] = s;
    return 0;
}

static int sacs_add_plate(sacs_reader *r, fl_err *err)
{
    struct sacs_plate p = {.line = r->k.e.line};
    for (int k = 0; k < 4; k++)
        cut_columns(r->k.d.line, r->k.d.len, 12 + 4 * k, 15 + 4 * k, p.joint[k], sizeof p.joint[k]);
    if (!p.joint[0][0] || !p.joint[1][0] || !p.joint[2][0]) return 0;
    if (fl_grow(&r->plate, &r->plate_cap, (int64_t)r->plates + 1, sizeof *r->plate, err)) return -1;
    r->plate[r->plates++] = p;
    return 0;
}

/* Of a frame a line that is not read is counted by its first word, but for headings and titles. */
static void count_line(sacs_reader *r, const char *p)
{
    const int n = (int)strcspn(p, " ");
    if (r->k.frame && n > 0 && p[n] != '\0') fl_frame_count_skipped(r->k.frame, "%.*s", n < 8 ? n : 8, p);
}

/* Reads the lines up to END. */
static int read_sacs_lines(sacs_reader *r, fl_err *err)
{
    int more;
    while ((more = fl_deck_line(&r->k.d, err)) > 0) {
        const char *p = r->k.d.line;
        int bad = 0;
        if (begins(p, "END")) return 0;
        if (*p == '*') continue;
        if (begins(p, "OPTIONS")) bad = sacs_options(r, err);
        else if (begins(p, "LDOPT")) bad = column_real(r, 25, 32, &r->rho, err);
        else if (begins(p, "JOINT") && r->k.d.len > 6) bad = sacs_joint(r, err);
        else if (begins_with_letters(p, "MEMBER") && r->k.d.len > 7) bad = sacs_add_member(r, err);
        else if (begins(p, "GRUP") && r->k.d.len > 5) bad = sacs_group(r, err);
        else if (begins(p, "SECT") && r->k.d.len > 5) bad = sacs_section(r, err);
        else if (begins(p, "PLATE") && r->k.d.len > 6) bad = sacs_add_plate(r, err);
        else count_line(r, p);
        if (bad) return -1;
    }
    return more;
}

/* --- sections ------------------------------------------------------------------------------------------- */

/* Section of one end of a segment: 0 is end A. */
static int32_t end_section(sacs_reader *r, const sacs_segment *g, int end, int32_t number, fl_err *err)
{
    fl_beam_section s = {.form = FL_FRAME_PIPE};
    const int32_t at = *g->wanted ? fl_string_table_find(&r->section_name, g->wanted) : -1;
    const int cone = at >= 0 && strcmp(r->shape[at].kind, "CON") == 0;
    s.material.e = g->e * r->stress;
    s.material.g = g->g * r->stress;
    s.material.rho = r->rho * r->density;
    snprintf(s.name, sizeof s.name, "%s_%d%s", r->group.name[g->group], (int)number + 1, end ? "_B" : "");
    if (at >= 0 && !cone && strcmp(r->shape[at].kind, "TUB") != 0) {
        s.form = FL_FRAME_NONE;
        snprintf(s.kind, sizeof s.kind, "member with a %s section", r->shape[at].kind);
    } else if (at >= 0) {
        s.size[0] = r->small * r->shape[at].size[cone && end ? 2 : 0];
        s.wall[0] = r->small * r->shape[at].size[cone && end ? 3 : 1];
    } else if (g->d > 0.0) {
        s.size[0] = r->small * g->d;
        s.wall[0] = r->small * g->wall;
    } else if (*g->wanted) {
        s.form = FL_FRAME_NONE;
        snprintf(s.kind, sizeof s.kind, "member with a section of a library");
    } else {
        r->k.e.line = g->line;
        return fl_deck_fail(&r->k.d, err, "group %s has the diameter %g, a length above 0 is expected",
                            r->group.name[g->group], g->d);
    }
    return fl_beam_deck_section(&r->k, &s, err);
}

/* Sections of all segments.  A line with B in column 9 and the next with E are one cone. */
static int make_sections(sacs_reader *r, fl_err *err)
{
    for (int32_t i = 0; i < r->segments; i++) {
        sacs_segment *g = &r->segment[i];
        const int32_t next = g->next;
        const sacs_segment *last =
            g->taper == 'B' && next >= 0 && r->segment[next].taper == 'E' ? &r->segment[next] : g;
        if ((g->section[0] = end_section(r, g, 0, i, err)) < 0) return -1;
        g->section[1] = g->section[0];
        const int32_t shape = *g->wanted ? fl_string_table_find(&r->section_name, g->wanted) : -1;
        const int cone = shape >= 0 && strcmp(r->shape[shape].kind, "CON") == 0;
        if (last == g && !cone) continue;
        if ((g->section[1] = end_section(r, last, 1, i, err)) < 0) return -1;
        if (r->k.section[g->section[1]].form != r->k.section[g->section[0]].form)
            g->section[1] = g->section[0];
        if (last != g) g->next = last->next;
    }
    return 0;
}

/* --- members -------------------------------------------------------------------------------------------- */

/* Length that each segment without one takes; 0 where the given lengths fill the member. */
static double rest_length(const sacs_reader *r, int32_t head, double whole)
{
    double given = 0.0;
    int rest = 0, n = 0;
    for (int32_t i = head; i >= 0; i = r->segment[i].next, n++) {
        given += r->length * r->segment[i].length;
        rest += !(r->segment[i].length > 0.0);
    }
    if (n == 1) return whole;
    return rest && given < whole ? (whole - given) / rest : 0.0;
}

static int place_member(sacs_reader *r, const sacs_member *m, int64_t id, fl_err *err)
{
    int32_t at[2];
    fl_vec3 x[2];
    r->k.e.line = m->line;
    for (int s = 0; s < 2; s++) {
        const int32_t joint = fl_string_table_find(&r->joint, m->joint[s]);
        at[s] = joint < 0 ? -1 : fl_id_map_find(&r->k.e.node_id, 0, joint + (int64_t)1);
        if (at[s] < 0) return fl_beam_deck_skip(&r->k, "member of a joint that is not there", err);
        x[s] = v3_madd(r->k.e.x[at[s]], r->small, m->offset[s]);
    }
    const int32_t group = fl_string_table_find(&r->group, m->group);
    if (group < 0)
        return fl_deck_fail(&r->k.d, err, "member %s-%s has group \"%s\", which is not defined", m->joint[0],
                            m->joint[1], m->group);
    const double whole = v3_norm(v3_sub(x[1], x[0])), rest = rest_length(r, r->head[group], whole);
    if (!(whole > 0.0))
        return fl_deck_fail(&r->k.d, err, "member %s-%s has no length", m->joint[0], m->joint[1]);
    const int32_t part = fl_string_table_add(&r->k.e.parts, m->group, err);
    const int single = r->segment[r->head[group]].next < 0;
    double done = 0.0;
    fl_beam b = {.id = id, .part = part, .piece = single ? 0 : 1};
    b.node[0] = r->k.e.node_id.id[at[0]];
    b.offset[0] = v3_scale(r->small, m->offset[0]);
    b.pins[0] = m->pins[0];
    for (int32_t i = r->head[group]; i >= 0 && part >= 0; i = r->segment[i].next, b.piece++) {
        const sacs_segment *g = &r->segment[i];
        done += single ? whole : g->length > 0.0 ? r->length * g->length : rest;
        b.section[0] = g->section[0];
        b.section[1] = g->section[1];
        if (g->next < 0 || done >= whole * (1.0 - 1e-9)) {
            b.node[1] = r->k.e.node_id.id[at[1]];
            b.scope[1] = 0;
            b.offset[1] = v3_scale(r->small, m->offset[1]);
            b.pins[1] = m->pins[1];
            return fl_beam_deck_add(&r->k, &b, err) < 0 ? -1 : 0;
        }
        if (!(g->length > 0.0) && !(rest > 0.0)) continue;
        const double w = done / whole;
        b.node[1] = fl_beam_deck_node(&r->k, v3_madd(x[0], w, v3_sub(x[1], x[0])), err);
        b.scope[1] = 1;
        if (b.node[1] < 0 || fl_beam_deck_add(&r->k, &b, err) < 0) return -1;
        b.node[0] = b.node[1];
        b.scope[0] = 1;
        b.offset[0] = v3(0, 0, 0);
        b.pins[0] = 0;
    }
    return -1;
}

static int place_plate(sacs_reader *r, const struct sacs_plate *p, int64_t id, fl_err *err)
{
    const int corners = p->joint[3][0] ? 4 : 3;
    const int32_t part = fl_string_table_add(&r->k.e.parts, "plates", err);
    int64_t node[4];
    r->k.e.line = p->line;
    for (int k = 0; k < corners; k++) {
        const int32_t joint = fl_string_table_find(&r->joint, p->joint[k]);
        if (joint < 0 || fl_id_map_find(&r->k.e.node_id, 0, joint + (int64_t)1) < 0)
            return fl_beam_deck_skip(&r->k, "plate of a joint that is not there", err);
        node[k] = joint + (int64_t)1;
    }
    return part < 0 || fl_elements_add(&r->k.e, 0, id, corners == 3 ? FL_TRI3 : FL_QUAD4, part, node, err) < 0
               ? -1
               : 0;
}

int fl_sacs_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    sacs_reader r = {0};
    int rc = -1;
    (void)name; /* members know their groups */
    if (fl_beam_deck_start(&r.k, b, opt, err)) return -1;
    if (read_sacs_lines(&r, err) || make_sections(&r, err)) goto done;
    for (int32_t i = 0; i < r.members; i++)
        if (place_member(&r, &r.member[i], i + 1, err)) goto done;
    for (int32_t i = 0; i < r.plates; i++)
        if (place_plate(&r, &r.plate[i], (int64_t)r.members + i + 1, err)) goto done;
    if (r.local_offsets)
        fl_bytes_note(b, "offsets of %d members are in local axes and were ignored", r.local_offsets);
    if (r.sliding && r.k.frame)
        fl_bytes_note(b, "released forces of %d members are not carried over, their moments are", r.sliding);
    if (r.pile_heads && r.k.frame) fl_bytes_note(b, "%d pile heads are clamped", r.pile_heads);
    rc = fl_beam_deck_finish(&r.k, s, err);
done:
    fl_beam_deck_free(&r.k);
    fl_string_table_free(&r.joint);
    fl_string_table_free(&r.group);
    fl_string_table_free(&r.section_name);
    free(r.shape), free(r.segment), free(r.head), free(r.tail), free(r.member), free(r.plate);
    return rc;
}
