/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "out/state_io.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void fl_state_io_open(fl_state_io *t, const char *name)
{
    const char *word = "";
    if (t->f) {
        fputs(name, t->f);
        return;
    }
    if (t->err->code) return;
    const int more = fl_text_row(t->in, t->err);
    if (more < 0) return;
    if (!more) fl_text_fail(t->in, t->err, "the state ends early, row %s expected", name);
    else if (fl_text_word(t->in, "name of the row", &word, t->err) == 0 && strcmp(word, name) != 0)
        fl_text_fail(t->in, t->err, "\"%.40s\" found, row %s expected", word, name);
}

void fl_state_io_close(fl_state_io *t)
{
    if (t->f) putc('\n', t->f);
    else if (!t->err->code) fl_text_no_more(t->in, t->err);
}

static int parse_hex(const char *word, uint64_t *bits)
{
    *bits = 0;
    for (int k = 0; word[k]; k++) {
        const char c = word[k];
        const int digit = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
        if (digit < 0 || k == 16) return -1;
        *bits = *bits << 4 | (uint64_t)digit;
    }
    return 0;
}

void fl_state_io_real(fl_state_io *t, double *x)
{
    uint64_t bits;
    const char *word = "";
    if (t->f) {
        char text[18], *p = text + sizeof text;
        memcpy(&bits, x, sizeof bits);
        *--p = '\0';
        do *--p = "0123456789abcdef"[bits & 15];
        while (bits >>= 4);
        *--p = ' ';
        fputs(p, t->f);
        return;
    }
    if (t->err->code || fl_text_word(t->in, "number", &word, t->err)) return;
    if (parse_hex(word, &bits))
        fl_text_fail(t->in, t->err, "\"%.40s\" found, hexadecimal digits of a double expected", word);
    else memcpy(x, &bits, sizeof bits);
    if (isnan(*x)) fl_text_fail(t->in, t->err, "not a number");
}

void fl_state_io_int(fl_state_io *t, int32_t lo, int32_t hi, int32_t *x)
{
    if (t->f) fprintf(t->f, " %" PRId32, *x);
    else if (!t->err->code) fl_text_i32(t->in, "integer", lo, hi, x, t->err);
}

void fl_state_io_byte(fl_state_io *t, uint8_t hi, uint8_t *x)
{
    int32_t number = *x;
    fl_state_io_int(t, 0, hi, &number);
    *x = (uint8_t)number;
}

void fl_state_io_count(fl_state_io *t, int64_t *x)
{
    const char *word = "";
    char *end;
    if (t->f) {
        fprintf(t->f, " %" PRId64, *x);
        return;
    }
    if (t->err->code || fl_text_word(t->in, "count", &word, t->err)) return;
    const long long n = strtoll(word, &end, 10);
    if (*end || n < -1 || n > INT64_C(1) << 62)
        fl_text_fail(t->in, t->err, "\"%.40s\" found, a count expected", word);
    else *x = n;
}

void fl_state_io_vec3(fl_state_io *t, fl_vec3 *x)
{
    fl_state_io_real(t, &x->x);
    fl_state_io_real(t, &x->y);
    fl_state_io_real(t, &x->z);
}

void fl_state_io_quat(fl_state_io *t, fl_quat *q)
{
    fl_state_io_real(t, &q->w);
    fl_state_io_real(t, &q->x);
    fl_state_io_real(t, &q->y);
    fl_state_io_real(t, &q->z);
}

/* A quaternion that was written is of unit length but for rounding. */
void fl_state_io_pose(fl_state_io *t, fl_vec3 *x, fl_quat *q)
{
    fl_state_io_vec3(t, x);
    fl_state_io_quat(t, q);
    const double size = q->w * q->w + q->x * q->x + q->y * q->y + q->z * q->z;
    if (t->in && !t->err->code && !(v3_finite(*x) && fabs(size - 1.0) < 1e-9))
        fl_text_fail(t->in, t->err, "the pose is not a finite position and a unit quaternion");
}

int fl_state_io_hash(fl_state_io *t, uint64_t hash)
{
    uint64_t bits;
    const char *word = "";
    if (t->f) {
        fprintf(t->f, " %" PRIx64, hash);
        return 0;
    }
    if (t->err->code || fl_text_word(t->in, "hash", &word, t->err)) return 0;
    return parse_hex(word, &bits) || bits != hash;
}
