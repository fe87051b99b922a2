/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/path_table.h"
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"

enum { WATCHED = 12 };
static const char *const DOF[WATCHED] = {"x", "y", "z", "rx", "ry", "rz", "fx", "fy", "fz", "mx", "my", "mz"};

int fl_path_watch_parse(fl_path_watch *w, const fl_member_model *m, const char *text, fl_err *err)
{
    const char *dot = strrchr(text, '.');
    char name[200];
    if (!dot || (size_t)(dot - text) >= sizeof name)
        return fl_fail(err, FL_USAGE, "\"%.60s\" is no displacement, expected NODE.x to .rz or .fx to .mz",
                       text);
    memcpy(name, text, (size_t)(dot - text));
    name[dot - text] = '\0';
    w->node = fl_string_table_find(&m->node_name, name);
    if (w->node < 0) return fl_fail(err, FL_USAGE, "%s has no node \"%.60s\"", m->file, name);
    for (w->dof = 0; w->dof < WATCHED; w->dof++)
        if (strcmp(dot + 1, DOF[w->dof]) == 0) return 0;
    return fl_fail(err, FL_USAGE, "\"%.60s\" is no displacement, expected NODE.x to .rz or .fx to .mz", text);
}

void fl_path_table_watch_loads(fl_path_table *t, const fl_member_model *m)
{
    for (int32_t k = 0; k < m->node_name.n; k++)
        for (int c = 0; c < FL_MEMBER_DOFS && t->watches < FL_PATH_WATCH_MAX; c++) {
            const fl_member_node *n = &m->node[k];
            const double load = c < 3 ? v3_at(n->force, c) : v3_at(n->moment, c - 3);
            if (load != 0.0 || (n->imposed >> c & 1)) t->watch[t->watches++] = (fl_path_watch){k, c};
            if ((n->imposed >> c & 1) && t->watches < FL_PATH_WATCH_MAX)
                t->watch[t->watches++] = (fl_path_watch){k, 6 + c};
        }
}

/* Rotation vector of the smaller of both angles. */
static fl_vec3 rotation_of(fl_quat q)
{
    const fl_vec3 v = v3(q.x, q.y, q.z);
    const double s = v3_norm(v), angle = 2.0 * atan2(s, fabs(q.w));
    return s > 0.0 ? v3_scale((q.w < 0.0 ? -angle : angle) / s, v) : v;
}

double fl_path_watch_value(const fl_path_watch *w, const fl_member_chain *c)
{
    const fl_member_ball *b = &c->ball[w->node];
    const fl_member_resist *r = &c->resist[w->node];
    if (w->dof >= 9) return v3_at(r->m, w->dof - 9);
    if (w->dof >= 6) return v3_at(r->f, w->dof - 6);
    return w->dof < 3 ? v3_at(b->d, w->dof) : v3_at(rotation_of(b->q), w->dof - 3);
}

const char *fl_path_watch_name(const fl_path_watch *w, const fl_member_model *m, char *buf, size_t size)
{
    snprintf(buf, size, "%.200s.%s", m->node_name.name[w->node], DOF[w->dof]);
    return buf;
}

void fl_path_table_header(FILE *f, const fl_path_table *t, const fl_member_model *m,
                          const fl_history_line *by)
{
    char name[220];
    fl_write_file_header(f, "path", 1, NULL, by);
    fputs("point\tlambda\tarc\tlength\talong\tsteps\tnegative\tresidual\tenergy\tbalance\thint", f);
    for (int k = 0; k < t->watches; k++)
        fprintf(f, "\t%s", fl_path_watch_name(&t->watch[k], m, name, sizeof name));
    putc('\n', f);
}

static int add_text(fl_path_table *t, fl_err *err, const char *fmt, ...)
    __attribute__((format(printf, 3, 4)));
static int add_text(fl_path_table *t, fl_err *err, const char *fmt, ...)
{
    enum { LINE = 512 };
    va_list list;
    if (fl_grow(&t->text, &t->cap, t->len + LINE, 1, err)) return -1;
    va_start(list, fmt);
    const int n = vsnprintf(t->text + t->len, LINE, fmt, list);
    va_end(list);
    t->len += n < LINE ? n : LINE - 1;
    return 0;
}

static int add_number(fl_path_table *t, double x, fl_err *err)
{
    char text[FL_NUMBER_LEN];
    return add_text(t, err, "\t%s", isfinite(x) ? fl_number_text(x, text) : "-");
}

/* Hint of the first that applies; "-" for none. */
static const char *hint_word(int hint)
{
    return hint & FL_PATH_HINT_MAXIMUM   ? "maximum"
           : hint & FL_PATH_HINT_MINIMUM ? "minimum"
           : hint & FL_PATH_HINT_JUMP    ? "jump"
           : hint & FL_PATH_HINT_KINK    ? "kink"
                                         : "-";
}

/* A line below the row: load factor of the limit, its error of interpolation, and the watched displacements
 * there. */
static int add_limit(fl_path_table *t, const fl_path *p, const fl_member_model *m, fl_err *err)
{
    const fl_path_point *a = &p->point;
    char text[3][FL_NUMBER_LEN], name[220];
    const int n = p->known < t->known ? p->known : t->known;
    const int use = n < 4 ? n : 4;
    const double *s = &p->s[p->known - use];
    if (add_text(t, err, "#limit %s lambda=%s error=%s arc=%s", hint_word(a->hint),
                 fl_number_text(a->limit, text[0]), fl_number_text(a->limit_error, text[1]),
                 fl_number_text(a->limit_arc, text[2])))
        return -1;
    for (int k = 0; k < t->watches; k++) {
        double y[4];
        for (int i = 0; i < use; i++) y[i] = t->value[t->known - use + i][k];
        if (add_text(t, err, " %s=%s", fl_path_watch_name(&t->watch[k], m, name, sizeof name),
                     fl_number_text(fl_arc_polynomial(use, s, y, a->limit_arc), text[0])))
            return -1;
    }
    t->limits++;
    return add_text(t, err, "\n");
}

int fl_path_table_add(fl_path_table *t, const fl_path *p, const fl_member_model *m, fl_err *err)
{
    const fl_path_point *a = &p->point;
    if (t->known == 4) {
        memmove(t->value[0], t->value[1], 3 * sizeof t->value[0]);
        t->known = 3;
    }
    for (int k = 0; k < t->watches; k++) t->value[t->known][k] = fl_path_watch_value(&t->watch[k], p->chain);
    t->known++;
    if (a->number == 0) return 0;
    if (add_text(t, err, "%" PRId64, a->number) || add_number(t, a->lambda, err) ||
        add_number(t, a->arc, err) || add_number(t, a->length, err) || add_number(t, a->along, err) ||
        add_text(t, err, "\t%" PRId64 "\t%" PRId64, a->steps, a->negative) ||
        add_number(t, a->residual, err) || add_number(t, a->energy, err) || add_number(t, a->balance, err) ||
        add_text(t, err, "\t%s", hint_word(a->hint)))
        return -1;
    for (int k = 0; k < t->watches; k++)
        if (add_number(t, t->value[t->known - 1][k], err)) return -1;
    if (add_text(t, err, "\n")) return -1;
    return a->hint & (FL_PATH_HINT_MAXIMUM | FL_PATH_HINT_MINIMUM) ? add_limit(t, p, m, err) : 0;
}

void fl_path_table_free(fl_path_table *t)
{
    free(t->text);
    *t = (fl_path_table){0};
}
