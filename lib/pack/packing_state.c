/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pack/packing_state.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include "base/number_text.h"
#include "base/stream.h"
#include "base/text.h"

enum { VERSION = 1, NUMBERS = 7, BODY = 6, SHAPED = 4 };

static void put_numbers(FILE *f, const double *x, int n)
{
    char text[FL_NUMBER_LEN];
    for (int k = 0; k < n; k++) fprintf(f, " %s", fl_number_text(x[k], text));
}

int fl_packing_state_write(const fl_packing *p, const fl_growth *g, uint64_t hash, const char *path,
                           fl_err *err)
{
    fl_out out = {0};
    const double x[NUMBERS] = {g->rise,      g->s_before, g->p_before, g->strain,
                               g->jam_scale, g->reached,  g->trimmed};
    if (fl_out_open(&out, path, 0, err)) return -1;
    fprintf(out.f, "#packing-state %d\nhash %016" PRIx64 "\ngrowth %d %d %d", VERSION, hash, g->phase,
            g->jammed, g->stage);
    put_numbers(out.f, x, NUMBERS);
    put_numbers(out.f, &p->s, 1);
    putc('\n', out.f);
    for (int32_t i = 0; i < p->n; i++) {
        const double b[BODY] = {p->x[i].x, p->x[i].y, p->x[i].z, p->size[i], p->radius[i], p->bound[i]};
        fputs("body", out.f);
        put_numbers(out.f, b, BODY);
        if (p->q) {
            const double q[SHAPED] = {p->q[i].w, p->q[i].x, p->q[i].y, p->q[i].z};
            put_numbers(out.f, q, SHAPED);
            fprintf(out.f, " %d", p->shape[i]);
        }
        putc('\n', out.f);
    }
    fputs("end\n", out.f);
    return fl_out_close(&out, err);
}

static int get_numbers(fl_text *in, double *x, int n, fl_err *err)
{
    for (int k = 0; k < n; k++)
        if (fl_text_f64(in, "number", &x[k], err)) return -1;
    return 0;
}

static int read_body(fl_text *in, fl_packing *p, int32_t i, fl_err *err)
{
    double b[BODY];
    if (fl_text_row_of(in, "body", err) || get_numbers(in, b, BODY, err)) return -1;
    p->x[i] = v3(b[0], b[1], b[2]);
    p->size[i] = b[3], p->radius[i] = b[4], p->bound[i] = b[5];
    if (!(b[3] > 0.0 && b[5] > 0.0)) return fl_text_fail(in, err, "a body without a size");
    if (p->q) {
        double q[SHAPED];
        if (get_numbers(in, q, SHAPED, err)) return -1;
        p->q[i] = (fl_quat){q[0], q[1], q[2], q[3]};
        if (fl_text_i32(in, "shape", 0, p->shapes->n - 1, &p->shape[i], err)) return -1;
    }
    return fl_text_no_more(in, err);
}

static int read_all(fl_text *in, fl_packing *p, fl_growth *g, uint64_t hash, fl_err *err)
{
    const char *word;
    char expected[24];
    double x[NUMBERS + 1];
    snprintf(expected, sizeof expected, "%016" PRIx64, hash);
    if (fl_text_magic(in, "packing-state", VERSION, err) || fl_text_row_of(in, "hash", err) ||
        fl_text_word(in, "hash", &word, err))
        return -1;
    if (strcmp(word, expected) != 0)
        return fl_text_fail(in, err, "the state is that of other options or files, the same are expected");
    if (fl_text_row_of(in, "growth", err) || fl_text_i32(in, "phase", 0, FL_GROWTH_DONE, &g->phase, err) ||
        fl_text_i32(in, "jammed", 0, 1, &g->jammed, err) ||
        fl_text_i32(in, "stage", 0, INT32_MAX, &g->stage, err) || get_numbers(in, x, NUMBERS + 1, err) ||
        fl_text_no_more(in, err))
        return -1;
    g->rise = x[0], g->s_before = x[1], g->p_before = x[2], g->strain = x[3], g->jam_scale = x[4];
    g->reached = x[5], g->trimmed = x[6];
    p->s = x[7];
    if (!(p->s > 0.0 && p->s <= 2.0)) return fl_text_fail(in, err, "scale %g, expected a number to 1", p->s);
    for (int32_t i = 0; i < p->n; i++)
        if (read_body(in, p, i, err)) return -1;
    return fl_text_row_of(in, "end", err);
}

int fl_packing_state_read(fl_packing *p, fl_growth *g, uint64_t hash, const char *path, fl_err *err)
{
    fl_text in = {0};
    int rc = fl_text_open(&in, path, err);
    if (rc == 0) rc = read_all(&in, p, g, hash, err);
    fl_text_close(&in);
    return rc;
}
