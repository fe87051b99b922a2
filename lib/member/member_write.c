/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/number_text.h"
#include "member/member_model.h"

static void put_number(FILE *f, double x)
{
    char text[FL_NUMBER_LEN];
    putc(' ', f);
    fputs(fl_number_text(x, text), f);
}

static void put_vector(FILE *f, fl_vec3 a)
{
    put_number(f, a.x);
    put_number(f, a.y);
    put_number(f, a.z);
}

/* A record of a node with three numbers and, where they are not 0, three more. */
static void put_six(FILE *f, const char *record, const char *node, fl_vec3 a, fl_vec3 b)
{
    if (!v3_nonzero(a) && !v3_nonzero(b)) return;
    fprintf(f, "%s %s", record, node);
    put_vector(f, a);
    if (v3_nonzero(b)) put_vector(f, b);
    putc('\n', f);
}

static void write_section(FILE *f, const char *name, const fl_member_section *s)
{
    static const char *const form[] = {"general", "pipe", "rect", "bar"};
    static const int numbers[] = {0, 5, 5, 3};
    fprintf(f, "section %s %s", name, form[s->form]);
    if (s->form == FL_MEMBER_GENERAL) {
        const double all[] = {s->ea, s->eiy, s->eiz, s->gj, s->mass, s->radius};
        for (int k = 0; k < 6; k++) put_number(f, all[k]);
    }
    for (int k = 0; k < numbers[s->form]; k++) put_number(f, s->given[k]);
    putc('\n', f);
    if (!(s->yield > 0.0)) return;
    fprintf(f, "yield %s", name);
    put_number(f, s->yield);
    if (s->hardening > 0.0) fputs(" hardening", f), put_number(f, s->hardening);
    if (s->limit > 0.0) fputs(" limit", f), put_number(f, s->limit);
    putc('\n', f);
}

static void write_member(FILE *f, const fl_member_model *m, int32_t k)
{
    const fl_member *b = &m->member[k];
    const int bar = m->section[b->section].bar;
    fprintf(f, "member %s %s %s %s %d", m->member_name.name[k], m->node_name.name[b->end[0]],
            m->node_name.name[b->end[1]], m->section_name.name[b->section], (int)b->pieces);
    if (b->released[0] && !bar) fputs(" hinge-i", f);
    if (b->released[1] && !bar) fputs(" hinge-j", f);
    for (int s = 0; s < 2; s++)
        if (v3_nonzero(b->arm[s])) {
            fputs(s ? " arm-j" : " arm-i", f);
            put_vector(f, b->arm[s]);
        }
    if (b->has_ref) {
        fputs(" ref", f);
        put_vector(f, b->ref);
    }
    if (b->bow_axis) {
        fputs(" bow", f);
        put_number(f, b->bow);
        fputs(b->bow_axis == 1 ? " y" : " z", f);
    }
    if (b->cylinders) fprintf(f, " cylinders %d", (int)b->cylinders);
    putc('\n', f);
}

static void write_supports(FILE *f, const char *name, int fixed)
{
    static const char *const dof[] = {"x", "y", "z", "rx", "ry", "rz"};
    if (!fixed) return;
    fprintf(f, "fix %s", name);
    if (fixed == FL_MEMBER_ALL) fputs(" clamped", f);
    else
        for (int d = 0; d < FL_MEMBER_DOFS; d++)
            if (fixed >> d & 1) fprintf(f, " %s", dof[d]);
    putc('\n', f);
}

void fl_member_model_write(FILE *f, const fl_member_model *m, const fl_history_line *by)
{
    fprintf(f, "#members %d\n", FL_MEMBERS_VERSION);
    if (m->history) fputs(m->history, f);
    if (by) fprintf(f, "%s\n", by->text);
    for (int32_t k = 0; k < m->node_name.n; k++) {
        fprintf(f, "node %s", m->node_name.name[k]);
        put_vector(f, m->node[k].x);
        fputs(m->node[k].hinge ? " hinge\n" : "\n", f);
    }
    for (int32_t k = 0; k < m->section_name.n; k++) write_section(f, m->section_name.name[k], &m->section[k]);
    /* Members are in the order of their parts, as they were read. */
    for (int32_t p = 0, k = 0; p < m->part_name.n; p++) {
        fprintf(f, "part %s\n", m->part_name.name[p]);
        for (; k < m->member_name.n && m->member[k].part == p; k++) write_member(f, m, k);
    }
    for (int32_t k = 0; k < m->node_name.n; k++) {
        const fl_member_node *n = &m->node[k];
        const char *name = m->node_name.name[k];
        write_supports(f, name, n->fixed & ~n->imposed);
        if (n->mass > 0.0) {
            fprintf(f, "mass %s", name);
            put_number(f, n->mass);
            putc('\n', f);
        }
        put_six(f, "load", name, n->force, n->moment);
        put_six(f, "move", name, n->move, n->turn);
        put_six(f, "offset", name, n->offset, v3(0, 0, 0));
    }
}
