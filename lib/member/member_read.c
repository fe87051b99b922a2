/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "member/member_model.h"

/* Largest number of the file: squares and products of four of them stay finite. */
static const double FAR = 1e60;

static int read_number(fl_text *in, const char *what, double lo, double *x, fl_err *err)
{
    if (fl_text_f64(in, what, x, err)) return -1;
    if (*x >= lo && fabs(*x) <= FAR) return 0;
    return lo > -FAR ? fl_text_fail(in, err, "%s is %g, expected a number from %g to %g", what, *x, lo, FAR)
                     : fl_text_fail(in, err, "%s is %g, expected a number up to %g", what, *x, FAR);
}

static int read_positive(fl_text *in, const char *what, double *x, fl_err *err)
{
    if (read_number(in, what, 0.0, x, err)) return -1;
    return *x > 0.0 ? 0 : fl_text_fail(in, err, "%s is 0, expected a number above 0", what);
}

static int read_vector(fl_text *in, const char *const what[3], fl_vec3 *v, fl_err *err)
{
    return read_number(in, what[0], -FAR, &v->x, err) || read_number(in, what[1], -FAR, &v->y, err) ||
                   read_number(in, what[2], -FAR, &v->z, err)
               ? -1
               : 0;
}

/* A new name; its number is the number of those before it. */
static int read_new_name(fl_string_table *names, fl_text *in, const char *what, int32_t *k, fl_err *err)
{
    const char *word;
    if (fl_text_word(in, what, &word, err)) return -1;
    if (fl_string_table_find(names, word) >= 0)
        return fl_text_fail(in, err, "%s %s is there twice", what, word);
    *k = fl_string_table_add(names, word, err);
    return *k < 0 ? -1 : 0;
}

static int read_known_name(const fl_string_table *names, fl_text *in, const char *what, int32_t *k,
                           fl_err *err)
{
    const char *word;
    if (fl_text_word(in, what, &word, err)) return -1;
    *k = fl_string_table_find(names, word);
    if (*k >= 0) return 0;
    return fl_text_fail(in, err, "there is no %s %s above this line", what, word);
}

static int read_node(fl_member_model *m, fl_text *in, fl_err *err)
{
    static const char *const xyz[3] = {"x", "y", "z"};
    fl_member_node n = {.line = in->line_number};
    int32_t k;
    const char *word;
    if (read_new_name(&m->node_name, in, "node", &k, err) || read_vector(in, xyz, &n.x, err)) return -1;
    if (in->next < in->n) {
        if (fl_text_word(in, "hinge", &word, err)) return -1;
        if (strcmp(word, "hinge") != 0) return fl_text_fail(in, err, "\"%s\" found, expected hinge", word);
        n.hinge = 1;
    }
    if (fl_grow(&m->node, &m->node_cap, (int64_t)k + 1, sizeof *m->node, err)) return -1;
    m->node[k] = n;
    return 0;
}

static int read_general(fl_member_section *s, fl_text *in, fl_err *err)
{
    if (read_positive(in, "EA", &s->ea, err) || read_positive(in, "EIy", &s->eiy, err) ||
        read_positive(in, "EIz", &s->eiz, err) || read_positive(in, "GJ", &s->gj, err))
        return -1;
    if (in->next < in->n && read_number(in, "mass per length", 0.0, &s->mass, err)) return -1;
    return in->next < in->n ? read_number(in, "radius", 0.0, &s->radius, err) : 0;
}

static int read_shape(fl_member_section *s, const char *shape, fl_text *in, fl_err *err)
{
    const int pipe = strcmp(shape, "pipe") == 0;
    double a, b, e, g, rho = 0.0;
    if (read_positive(in, pipe ? "diameter" : "width", &a, err) ||
        read_positive(in, pipe ? "wall" : "height", &b, err) || read_positive(in, "E", &e, err) ||
        read_positive(in, "G", &g, err) || (in->next < in->n && read_number(in, "density", 0.0, &rho, err)))
        return -1;
    if (pipe && !(b <= 0.5 * a))
        return fl_text_fail(in, err, "the wall is %g, expected half the diameter %g at most", b, a);
    *s = pipe ? fl_member_section_pipe(a, b, e, g, rho) : fl_member_section_rectangle(a, b, e, g, rho);
    return 0;
}

static int read_section(fl_member_model *m, fl_text *in, fl_err *err)
{
    fl_member_section s = {0};
    int32_t k;
    double number, rho = 0.0;
    const char *shape;
    if (read_new_name(&m->section_name, in, "section", &k, err) ||
        fl_text_word(in, "form of the section", &shape, err))
        return -1;
    if (fl_number_f64(shape, &number) == 0) {
        in->next--;
        if (read_general(&s, in, err)) return -1;
    } else if (strcmp(shape, "general") == 0) {
        if (read_general(&s, in, err)) return -1;
    } else if (strcmp(shape, "pipe") == 0 || strcmp(shape, "rect") == 0) {
        if (read_shape(&s, shape, in, err)) return -1;
    } else if (strcmp(shape, "bar") == 0) {
        if (read_positive(in, "area", &number, err) || read_positive(in, "E", &s.ea, err) ||
            (in->next < in->n && read_number(in, "density", 0.0, &rho, err)))
            return -1;
        s = fl_member_section_bar(number, s.ea, rho);
    } else {
        return fl_text_fail(in, err, "section of form \"%s\", expected general, pipe, rect or bar", shape);
    }
    if (fl_grow(&m->section, &m->section_cap, (int64_t)k + 1, sizeof *m->section, err)) return -1;
    m->section[k] = s;
    return 0;
}

/* What may follow the pieces of a member: hinge-i, hinge-j, arm-i X Y Z, arm-j X Y Z, ref X Y Z, bow A y|z,
 * cylinders N. */
static int read_member_word(fl_member *b, fl_text *in, fl_err *err)
{
    static const char *const xyz[3] = {"x of ref", "y of ref", "z of ref"}, *const arm[3] = {"x of the arm",
                                                                                             "y of the arm",
                                                                                             "z of the arm"};
    const char *word, *axis;
    if (fl_text_word(in, "word", &word, err)) return -1;
    if (strcmp(word, "hinge-i") == 0 || strcmp(word, "hinge-j") == 0) {
        b->released[word[6] == 'j'] = 1;
        return 0;
    }
    if (strcmp(word, "arm-i") == 0 || strcmp(word, "arm-j") == 0)
        return read_vector(in, arm, &b->arm[word[4] == 'j'], err);
    if (strcmp(word, "ref") == 0) {
        b->has_ref = 1;
        return read_vector(in, xyz, &b->ref, err);
    }
    if (strcmp(word, "bow") == 0) {
        if (read_number(in, "amplitude", -FAR, &b->bow, err) || fl_text_word(in, "y or z", &axis, err))
            return -1;
        if (strcmp(axis, "y") != 0 && strcmp(axis, "z") != 0)
            return fl_text_fail(in, err, "bow along \"%s\", expected y or z", axis);
        b->bow_axis = axis[0] == 'y' ? 1 : 2;
        return 0;
    }
    if (strcmp(word, "cylinders") == 0)
        return fl_text_i32(in, "cylinders", 1, FL_MEMBER_PIECES_MAX, &b->cylinders, err);
    return fl_text_fail(in, err,
                        "\"%s\" found, expected hinge-i, hinge-j, arm-i, arm-j, ref, bow or cylinders", word);
}

static int read_member(fl_member_model *m, fl_text *in, fl_err *err)
{
    fl_member b = {.line = in->line_number};
    int32_t k;
    if (read_new_name(&m->member_name, in, "member", &k, err) ||
        read_known_name(&m->node_name, in, "node", &b.end[0], err) ||
        read_known_name(&m->node_name, in, "node", &b.end[1], err) ||
        read_known_name(&m->section_name, in, "section", &b.section, err) ||
        fl_text_i32(in, "pieces", 1, FL_MEMBER_PIECES_MAX, &b.pieces, err))
        return -1;
    while (in->next < in->n)
        if (read_member_word(&b, in, err)) return -1;
    if (m->part_name.n == 0 && fl_string_table_add(&m->part_name, "members", err) < 0) return -1;
    b.part = m->part_name.n - 1;
    if (m->section[b.section].bar) {
        if (b.pieces > 1)
            return fl_text_fail(in, err, "member %s is a bar in %d pieces, a mechanism; 1 piece is expected",
                                m->member_name.name[k], (int)b.pieces);
        b.released[0] = b.released[1] = 1;
    }
    if (fl_grow(&m->member, &m->member_cap, (int64_t)k + 1, sizeof *m->member, err)) return -1;
    m->member[k] = b;
    return 0;
}

static int read_fix(fl_member_model *m, fl_text *in, fl_err *err)
{
    static const char *const dof[] = {"x", "y", "z", "rx", "ry", "rz"};
    int32_t k;
    const char *word;
    if (read_known_name(&m->node_name, in, "node", &k, err)) return -1;
    do {
        int bits = 0;
        if (fl_text_word(in, "freedom", &word, err)) return -1;
        for (int d = 0; d < FL_MEMBER_DOFS; d++)
            if (strcmp(word, dof[d]) == 0) bits = 1 << d;
        if (strcmp(word, "pinned") == 0) bits = FL_MEMBER_TRANSLATIONS;
        if (strcmp(word, "clamped") == 0) bits = FL_MEMBER_ALL;
        if (!bits)
            return fl_text_fail(in, err, "freedom \"%s\", expected x, y, z, rx, ry, rz, pinned or clamped",
                                word);
        m->node[k].fixed |= bits;
    } while (in->next < in->n);
    return 0;
}

/* load, move: three numbers and perhaps three more, which are added to those of the node. */
static int read_six(fl_member_model *m, fl_text *in, const char *const what[6], int32_t *k, fl_vec3 *a,
                    fl_vec3 *b, fl_err *err)
{
    if (read_known_name(&m->node_name, in, "node", k, err) || read_vector(in, what, a, err)) return -1;
    *b = v3(0, 0, 0);
    return in->next < in->n ? read_vector(in, what + 3, b, err) : 0;
}

static int read_load(fl_member_model *m, fl_text *in, fl_err *err)
{
    static const char *const what[6] = {"FX", "FY", "FZ", "MX", "MY", "MZ"};
    int32_t k;
    fl_vec3 f, moment;
    if (read_six(m, in, what, &k, &f, &moment, err)) return -1;
    if (m->node[k].hinge && v3_nonzero(moment))
        return fl_text_fail(in, err, "a moment on node %s, which is a hinge", m->node_name.name[k]);
    m->node[k].force = v3_add(m->node[k].force, f);
    m->node[k].moment = v3_add(m->node[k].moment, moment);
    return 0;
}

static int read_move(fl_member_model *m, fl_text *in, fl_err *err)
{
    static const char *const what[6] = {"DX", "DY", "DZ", "RX", "RY", "RZ"};
    int32_t k;
    fl_vec3 d, r;
    if (read_six(m, in, what, &k, &d, &r, err)) return -1;
    fl_member_node *n = &m->node[k];
    n->move = v3_add(n->move, d);
    n->turn = v3_add(n->turn, r);
    for (int c = 0; c < 3; c++) {
        if (v3_at(n->move, c) != 0.0) n->imposed |= 1 << c;
        if (v3_at(n->turn, c) != 0.0) n->imposed |= 8 << c;
    }
    n->fixed |= n->imposed;
    return 0;
}

static int read_offset(fl_member_model *m, fl_text *in, fl_err *err)
{
    static const char *const what[3] = {"DX", "DY", "DZ"};
    int32_t k;
    fl_vec3 d;
    if (read_known_name(&m->node_name, in, "node", &k, err) || read_vector(in, what, &d, err)) return -1;
    m->node[k].offset = v3_add(m->node[k].offset, d);
    return 0;
}

/* yield SECTION STRESS [hardening H] [limit STRAIN] */
static int read_yield(fl_member_model *m, fl_text *in, fl_err *err)
{
    int32_t k;
    const char *word;
    double stress;
    if (read_known_name(&m->section_name, in, "section", &k, err) ||
        read_positive(in, "yield stress", &stress, err))
        return -1;
    fl_member_section *s = &m->section[k];
    if (s->form == FL_MEMBER_GENERAL)
        return fl_text_fail(in, err, "section %s is general and has no fibres: expected pipe, rect or bar",
                            m->section_name.name[k]);
    s->yield = stress;
    while (in->next < in->n) {
        if (fl_text_word(in, "word", &word, err)) return -1;
        const int hardening = strcmp(word, "hardening") == 0;
        if (!hardening && strcmp(word, "limit") != 0)
            return fl_text_fail(in, err, "\"%s\" found, expected hardening or limit", word);
        if (read_positive(in, word, hardening ? &s->hardening : &s->limit, err)) return -1;
    }
    const double e = s->given[s->form == FL_MEMBER_BAR_FORM ? 1 : 2];
    if (!(s->hardening < e))
        return fl_text_fail(in, err, "hardening %g is not below E, which is %g", s->hardening, e);
    if (s->limit > 0.0 && !(s->limit * e > stress))
        return fl_text_fail(in, err, "the limit of strain %g is reached before the yield stress, at %g",
                            s->limit, stress / e);
    return 0;
}

static int read_mass(fl_member_model *m, fl_text *in, fl_err *err)
{
    int32_t k;
    double mass;
    if (read_known_name(&m->node_name, in, "node", &k, err) || read_number(in, "mass", 0.0, &mass, err))
        return -1;
    m->node[k].mass += mass;
    return 0;
}

static int read_part(fl_member_model *m, fl_text *in, fl_err *err)
{
    int32_t k;
    return read_new_name(&m->part_name, in, "part", &k, err);
}

static const struct {
    const char *word;
    int (*read)(fl_member_model *m, fl_text *in, fl_err *err);
} RECORD[] = {{"part", read_part}, {"node", read_node},  {"section", read_section}, {"member", read_member},
              {"fix", read_fix},   {"load", read_load},  {"move", read_move},       {"offset", read_offset},
              {"mass", read_mass}, {"yield", read_yield}};
enum { RECORDS = sizeof RECORD / sizeof *RECORD };

static int read_record(fl_member_model *m, fl_text *in, fl_err *err)
{
    const char *word, *list[RECORDS];
    if (fl_text_word(in, "record", &word, err)) return -1;
    for (int r = 0; r < RECORDS; r++) {
        list[r] = RECORD[r].word;
        if (strcmp(word, RECORD[r].word) == 0)
            return RECORD[r].read(m, in, err) || fl_text_no_more(in, err) ? -1 : 0;
    }
    return fl_text_fail(in, err, "unknown record %.40s, nearest is %s", word,
                        fl_text_nearest(word, list, RECORDS));
}

/* What only the whole file tells. */
static int check_nodes(const fl_member_model *m, fl_err *err)
{
    if (m->member_name.n == 0) return fl_fail(err, FL_INPUT, "%s: there is no member", m->file);
    char *used = fl_alloc(m->node_name.n, 1, err);
    if (!used) return -1;
    for (int32_t k = 0; k < m->member_name.n; k++)
        for (int s = 0; s < 2; s++) {
            const fl_member *b = &m->member[k];
            const int clamps = !b->released[s] && !m->node[b->end[s]].hinge;
            used[b->end[s]] = (char)(used[b->end[s]] | (clamps ? 2 : 1));
        }
    int rc = 0;
    for (int32_t k = 0; k < m->node_name.n && rc == 0; k++) {
        const fl_member_node *n = &m->node[k];
        if (!used[k])
            rc = fl_fail(err, FL_INPUT, "%s:%lld: node %s has no stiffness: no member ends there", m->file,
                         (long long)n->line, m->node_name.name[k]);
        else if (!(used[k] & 2) && v3_nonzero(n->moment))
            rc = fl_fail(err, FL_INPUT, "%s:%lld: node %s has a moment, but no member is clamped to it",
                         m->file, (long long)n->line, m->node_name.name[k]);
    }
    free(used);
    return rc;
}

int fl_member_model_read_text(fl_member_model *m, fl_text *in, fl_err *err)
{
    int more = 1, rc;
    *m = (fl_member_model){0};
    m->file = fl_alloc_text(fl_in_name(in->in), err);
    rc = m->file ? fl_text_magic(in, "members", FL_MEMBERS_VERSION, err) : -1;
    while (rc == 0 && (more = fl_text_row(in, err)) > 0) rc = read_record(m, in, err);
    if (rc == 0 && more < 0) rc = -1;
    if (rc == 0 && in->history && !(m->history = fl_alloc_text(in->history, err))) rc = -1;
    if (rc == 0) rc = check_nodes(m, err);
    for (int32_t k = 0; k < m->member_name.n && rc == 0; k++) {
        fl_vec3 e[3];
        double length;
        rc = fl_member_frame(m, k, e, &length, err);
    }
    if (rc) fl_member_model_free(m);
    return rc;
}

int fl_member_model_is(const char *path)
{
    fl_text in = {0};
    fl_err no = {0};
    const int is = strcmp(path, "-") != 0 && fl_text_open(&in, path, &no) == 0 &&
                   fl_text_magic(&in, "members", FL_MEMBERS_VERSION, &no) == 0;
    fl_text_close(&in);
    return is;
}

int fl_member_model_read(fl_member_model *m, const char *path, fl_err *err)
{
    fl_text in = {0};
    *m = (fl_member_model){0};
    const int rc = fl_text_open(&in, path, err) ? -1 : fl_member_model_read_text(m, &in, err);
    fl_text_close(&in);
    return rc;
}
