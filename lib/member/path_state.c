/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/path_state.h"
#include <inttypes.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "base/stream.h"
#include "base/text.h"

enum { VERSION = 1 };

static uint64_t hash_vector(uint64_t h, fl_vec3 a) { return fl_hash(h, &a, sizeof a); }

uint64_t fl_path_hash(const fl_path *p)
{
    const fl_member_chain *c = p->chain;
    const fl_path_options *o = &p->options;
    const int32_t choices[] = {(int32_t)o->constraint, (int32_t)o->predictor, (int32_t)o->damping};
    const int32_t control[] = {o->control_ball, o->control_axis};
    const double numbers[] = {
        o->first, o->dl,  o->dl_most,    o->dl_first, o->load_step,        (double)o->load_steps,
        o->c,     o->chi, o->resolution, o->last,     (double)o->max_steps};
    uint64_t h = FL_HASH_START;
    h = fl_hash(h, choices, sizeof choices);
    h = fl_hash(h, numbers, sizeof numbers);
    if (o->control) h = fl_hash(h, control, sizeof control);
    for (int32_t b = 0; b < c->balls; b++) {
        h = hash_vector(h, c->ball[b].x0);
        h = fl_hash(h, &c->ball[b].fixed, sizeof c->ball[b].fixed);
    }
    for (int32_t k = 0; k < c->contacts; k++) {
        const fl_member_contact *e = &c->contact[k];
        const int32_t ends[] = {e->i, e->j, e->kind};
        h = fl_hash(h, ends, sizeof ends);
        h = fl_hash(h, &e->e0, sizeof e->e0);
        h = fl_hash(h, &e->axial, sizeof e->axial);
        h = fl_hash(h, e->shear, sizeof e->shear);
        h = fl_hash(h, e->turn, sizeof e->turn);
        if (e->arms) h = hash_vector(hash_vector(h, e->arm[0]), e->arm[1]);
        if (!e->fibres) continue;
        const double yields[] = {e->fibres->section->yield, e->fibres->section->back,
                                 e->fibres->section->limit};
        h = fl_hash(h, yields, sizeof yields);
    }
    for (int32_t k = 0; k < c->loads; k++)
        h = hash_vector(hash_vector(h, c->load[k].force), c->load[k].moment);
    for (int32_t k = 0; k < c->moves; k++) h = hash_vector(hash_vector(h, c->move[k].move), c->move[k].turn);
    return h;
}

/* --- writing ----------------------------------------------------------------------------------- */

static void put_numbers(FILE *f, const char *word, const double *x, int n)
{
    char text[FL_NUMBER_LEN];
    fputs(word, f);
    for (int k = 0; k < n; k++) fprintf(f, " %s", fl_number_text(x[k], text));
    putc('\n', f);
}

static void put_state(FILE *f, const fl_path_state *s, const fl_member_chain *c)
{
    for (int32_t b = 0; b < c->balls; b++) {
        const double x[] = {s->d[b].x, s->d[b].y, s->d[b].z, s->q[b].w, s->q[b].x, s->q[b].y, s->q[b].z};
        put_numbers(f, "ball", x, 7);
    }
    for (int32_t k = 0; k < c->loads; k++) put_numbers(f, "turned", &s->turned[k].x, 3);
}

/* Pieces that yield: dissipated energy, rupture and plastic strains of each. */
static void put_fibres(FILE *f, const fl_member_chain *c)
{
    for (int32_t k = 0; k < c->yielding; k++) {
        const fl_member_fibres *s = &c->fibres[k];
        const double numbers[] = {s->dissipated, s->ruptured, s->yielded};
        put_numbers(f, "piece", numbers, 3);
        if (s->yielded) put_numbers(f, "fibres", s->plastic, s->section->n);
    }
}

int fl_path_state_write(const fl_path *p, const fl_path_table *t, const char *path, fl_err *err)
{
    fl_out out = {0};
    const fl_path_point *a = &p->point;
    const double numbers[] = {a->lambda,   a->arc,         a->length,      a->along,
                              a->residual, a->energy,      a->work,        a->balance,
                              p->dl,       p->lambda_most, p->energy_most, p->reaction_most};
    if (fl_out_open(&out, path, 0, err)) return -1;
    fprintf(out.f, "#path-state %d\nhash %016" PRIx64 "\n", VERSION, fl_path_hash(p));
    fprintf(out.f, "counts %" PRId64 " %" PRId64 " %" PRId64 " %" PRId64 " %d %d %d %d\n", a->number,
            p->first_steps, p->last_steps, p->total_steps, (int)p->damping, p->known, t->known, t->limits);
    put_numbers(out.f, "numbers", numbers, (int)(sizeof numbers / sizeof *numbers));
    put_numbers(out.f, "arc", p->s, p->known);
    put_numbers(out.f, "lambda", p->lambda, p->known);
    put_numbers(out.f, "work", p->w, p->known);
    fprintf(out.f, "watched %d\n", t->watches);
    for (int k = 0; k < t->known; k++) put_numbers(out.f, "value", t->value[k], t->watches);
    put_state(out.f, &p->before, p->chain);
    put_state(out.f, &p->last, p->chain);
    put_fibres(out.f, p->chain);
    fprintf(out.f, "rows %" PRId64 "\n", t->len);
    fwrite(t->text, 1, (size_t)t->len, out.f);
    return fl_out_close(&out, err);
}

/* --- reading ----------------------------------------------------------------------------------- */

static int get_numbers(fl_text *in, const char *word, double *x, int n, fl_err *err)
{
    if (fl_text_row_of(in, word, err)) return -1;
    for (int k = 0; k < n; k++)
        if (fl_text_f64(in, word, &x[k], err)) return -1;
    return fl_text_no_more(in, err);
}

static int get_count(fl_text *in, int64_t most, int64_t *x, fl_err *err)
{
    double value;
    if (fl_text_f64(in, "count", &value, err)) return -1;
    if (!(value >= 0.0 && value <= (double)most))
        return fl_text_fail(in, err, "count %g, expected 0 to %lld", value, (long long)most);
    *x = (int64_t)value;
    return 0;
}

static int get_state(fl_text *in, fl_path_state *s, const fl_member_chain *c, fl_err *err)
{
    double x[7];
    for (int32_t b = 0; b < c->balls; b++) {
        if (get_numbers(in, "ball", x, 7, err)) return -1;
        s->d[b] = v3(x[0], x[1], x[2]);
        s->q[b] = (fl_quat){x[3], x[4], x[5], x[6]};
    }
    for (int32_t k = 0; k < c->loads; k++) {
        if (get_numbers(in, "turned", x, 3, err)) return -1;
        s->turned[k] = v3(x[0], x[1], x[2]);
    }
    return 0;
}

static int get_fibres(fl_text *in, fl_member_chain *c, fl_err *err)
{
    for (int32_t k = 0; k < c->yielding; k++) {
        fl_member_fibres *s = &c->fibres[k];
        double x[3];
        if (get_numbers(in, "piece", x, 3, err)) return -1;
        s->dissipated = x[0];
        s->ruptured = x[1] != 0.0;
        s->yielded = x[2] != 0.0;
        if (s->yielded && get_numbers(in, "fibres", s->plastic, s->section->n, err)) return -1;
    }
    return 0;
}

static int get_hash(fl_text *in, uint64_t wanted, fl_err *err)
{
    const char *word;
    char text[24];
    if (fl_text_row_of(in, "hash", err) || fl_text_word(in, "hash", &word, err)) return -1;
    snprintf(text, sizeof text, "%016" PRIx64, wanted);
    return strcmp(word, text) == 0
               ? 0
               : fl_text_fail(
                     in, err,
                     "the state is that of another model or of other options, the same are expected");
}

static int get_rows(fl_text *in, fl_path_table *t, fl_err *err)
{
    int64_t bytes;
    int more = 1;
    if (fl_text_row_of(in, "rows", err) || get_count(in, INT32_MAX / 2, &bytes, err)) return -1;
    if (fl_grow(&t->text, &t->cap, bytes + 1, 1, err)) return -1;
    t->len = 0;
    while (t->len < bytes && (more = fl_text_line(in, err)) > 0) {
        const int64_t n = (int64_t)strlen(in->line);
        if (t->len + n + 1 > bytes) break;
        memcpy(t->text + t->len, in->line, (size_t)n);
        t->len += n;
        t->text[t->len++] = '\n';
    }
    if (more < 0) return -1;
    return t->len == bytes ? 0
                           : fl_text_fail(in, err, "rows of %lld bytes expected, %lld found",
                                          (long long)bytes, (long long)t->len);
}

static int get_all(fl_text *in, fl_path *p, fl_path_table *t, fl_err *err)
{
    fl_path_point *a = &p->point;
    int64_t count[8], watches;
    double x[12];
    static const int64_t most[8] = {INT32_MAX, INT64_MAX / 4, INT64_MAX / 4, INT64_MAX / 4, 2, 4,
                                    4,         INT32_MAX};
    if (fl_text_magic(in, "path-state", VERSION, err) || get_hash(in, fl_path_hash(p), err) ||
        fl_text_row_of(in, "counts", err))
        return -1;
    for (int k = 0; k < 8; k++)
        if (get_count(in, most[k], &count[k], err)) return -1;
    if (get_numbers(in, "numbers", x, 12, err)) return -1;
    *a = (fl_path_point){.number = count[0],
                         .lambda = x[0],
                         .arc = x[1],
                         .length = x[2],
                         .along = x[3],
                         .residual = x[4],
                         .energy = x[5],
                         .work = x[6],
                         .balance = x[7]};
    p->dl = x[8];
    p->lambda_most = x[9];
    p->energy_most = x[10];
    p->reaction_most = x[11];
    p->first_steps = count[1];
    p->last_steps = count[2];
    p->total_steps = count[3];
    p->damping = (enum fl_relaxation_kind)count[4];
    p->known = (int)count[5];
    t->known = (int)count[6];
    t->limits = (int)count[7];
    if (p->known < 1 || t->known < 1 || a->number < 1) return fl_text_fail(in, err, "the state has no point");
    if (get_numbers(in, "arc", p->s, p->known, err) || get_numbers(in, "lambda", p->lambda, p->known, err) ||
        get_numbers(in, "work", p->w, p->known, err) || fl_text_row_of(in, "watched", err) ||
        get_count(in, FL_PATH_WATCH_MAX, &watches, err))
        return -1;
    if (watches != t->watches)
        return fl_text_fail(
            in, err,
            "%lld displacements are watched, %d are expected: --watch and --until have to be the same",
            (long long)watches, t->watches);
    for (int k = 0; k < t->known; k++)
        if (get_numbers(in, "value", t->value[k], t->watches, err)) return -1;
    return get_state(in, &p->before, p->chain, err) || get_state(in, &p->last, p->chain, err) ||
                   get_fibres(in, p->chain, err) || get_rows(in, t, err)
               ? -1
               : 0;
}

int fl_path_state_read(fl_path *p, fl_path_table *t, const char *path, fl_err *err)
{
    fl_text in = {0};
    int rc = fl_text_open(&in, path, err);
    if (rc == 0) rc = get_all(&in, p, t, err);
    fl_text_close(&in);
    if (rc == 0) fl_path_return(p);
    return rc;
}
