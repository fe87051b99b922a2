/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "out/restart.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "base/stream.h"

enum { FAST_GZIP = 2 }; /* level: a checkpoint is written often and read seldom */

/* The whole file as one text.  fl_hash() reads words of eight bytes and pads the last one, so the file is
 * hashed in one piece. */
static int compose_text(char **text, size_t *n, const char *history, const fl_restart_part *part, int parts)
{
    FILE *f = open_memstream(text, n);
    if (!f) return -1;
    fprintf(f, "#checkpoint %d\n%s", FL_RESTART_VERSION, history);
    for (int k = 0; k < parts; k++) {
        fprintf(f, "part %s %" PRId64 "\n", part[k].name, part[k].n);
        fwrite(part[k].text, 1, (size_t)part[k].n, f);
    }
    const int bad = ferror(f);
    return fclose(f) || bad ? -1 : 0;
}

int fl_restart_write(const char *path, const char *history, const fl_restart_part *part, int parts,
                     fl_err *err)
{
    fl_out out = {0};
    char *text = NULL;
    size_t n = 0;
    int rc = -1;
    if (compose_text(&text, &n, history, part, parts)) fl_fail(err, FL_SYSTEM, "out of memory for %s", path);
    else if (fl_out_open(&out, path, FAST_GZIP, err) == 0) {
        fwrite(text, 1, n, out.f);
        fprintf(out.f, "end %016" PRIx64 "\n", fl_hash(FL_HASH_START, text, (int64_t)n));
        rc = fl_out_close(&out, err);
    }
    free(text);
    return rc;
}

/* --- read -------------------------------------------------------------------------------------- */

static int read_bytes(fl_restart *r, int64_t *n, fl_err *err)
{
    fl_in *in = fl_in_open(r->path, err);
    int64_t k = 1;
    *n = 0;
    while (in && k > 0) {
        if (fl_grow(&r->data, &r->cap, *n + (1 << 16) + 1, 1, err)) break;
        k = fl_in_read(in, r->data + *n, 1 << 16, err);
        if (k > 0) *n += k;
    }
    fl_in_close(in);
    if (err->code) return -1;
    r->data[*n] = '\0';
    return 0;
}

static int fail_file(const fl_restart *r, fl_err *err, const char *what)
{
    return fl_fail(err, FL_INPUT, "%s: %s", r->path, what);
}

/* First line and history, by the reader of all other files. */
static int read_head(fl_restart *r, int64_t n, int64_t *at, fl_err *err)
{
    fl_text head = {0};
    const char *p = r->data;
    if (fl_text_open_bytes(&head, r->path, r->data, n, err)) return -1;
    if (fl_text_magic(&head, "checkpoint", FL_RESTART_VERSION, err) == 0) {
        p = memchr(p, '\n', (size_t)n);
        while (p && strncmp(p + 1, "#by ", 4) == 0) p = strchr(p + 1, '\n');
        if (!p) fail_file(r, err, "the checkpoint is cut short");
    }
    r->version = head.version;
    fl_text_close(&head);
    if (err->code) return -1;
    const char *first = strchr(r->data, '\n') + 1;
    r->history = fl_alloc(p - first + 2, 1, err);
    if (!r->history) return -1;
    if (p + 1 > first) memcpy(r->history, first, (size_t)(p + 1 - first));
    *at = p + 1 - r->data;
    return 0;
}

/* The last line is "end HASH"; *n becomes the number of bytes before it. */
static int check_end(const fl_restart *r, int64_t *n, fl_err *err)
{
    enum { END = 4 + 16 + 1 };
    char expected[END + 1];
    if (*n < END || r->data[*n - END - 1] != '\n' || strncmp(r->data + *n - END, "end ", 4) != 0)
        return fail_file(r, err, "the checkpoint is cut short: its last line is not \"end HASH\"");
    *n -= END;
    snprintf(expected, sizeof expected, "end %016" PRIx64 "\n", fl_hash(FL_HASH_START, r->data, *n));
    if (memcmp(expected, r->data + *n, END) != 0)
        return fail_file(r, err, "the checkpoint is damaged: its hash does not match its content");
    return 0;
}

static int read_parts(fl_restart *r, int64_t at, int64_t n, fl_err *err)
{
    while (at < n) {
        fl_restart_part *part = &r->part[r->parts];
        uint64_t bytes;
        char number[24];
        int used = 0;
        if (r->parts == FL_RESTART_PARTS ||
            sscanf(r->data + at, "part %15s %23[0-9]%n", part->name, number, &used) != 2 ||
            r->data[at + used] != '\n' || fl_number_u64(number, &bytes))
            return fail_file(r, err, "line \"part NAME BYTES\" expected between the parts of the checkpoint");
        at += used + 1;
        if (at > n || bytes > (uint64_t)(n - at))
            return fail_file(r, err, "a part of the checkpoint is cut short");
        part->text = r->data + at;
        part->n = (int64_t)bytes;
        at += part->n;
        r->parts++;
    }
    return 0;
}

int fl_restart_read(fl_restart *r, const char *path, fl_err *err)
{
    fl_restart got = {.path = path};
    int64_t n, at;
    if (read_bytes(&got, &n, err) || read_head(&got, n, &at, err) || check_end(&got, &n, err) ||
        read_parts(&got, at, n, err)) {
        fl_restart_free(&got);
        return -1;
    }
    *r = got;
    return 0;
}

int fl_restart_current(const fl_restart *r, fl_err *err)
{
    if (r->version == FL_RESTART_VERSION) return 0;
    return fl_fail(
        err, FL_INPUT,
        "%s:1: checkpoint version %d is older than this program, which reads version %d: resume with the "
        "program that wrote it, or run from the start",
        r->path, r->version, FL_RESTART_VERSION);
}

void fl_restart_free(fl_restart *r)
{
    free(r->data);
    free(r->history);
    *r = (fl_restart){0};
}

const fl_restart_part *fl_restart_find(const fl_restart *r, const char *name)
{
    for (int k = 0; k < r->parts; k++)
        if (strcmp(r->part[k].name, name) == 0) return &r->part[k];
    return NULL;
}

int fl_restart_open(const fl_restart *r, const char *name, fl_text *text, fl_err *err)
{
    const fl_restart_part *part = fl_restart_find(r, name);
    if (!part) return fl_fail(err, FL_INPUT, "%s: the checkpoint has no part %s", r->path, name);
    return fl_text_open_bytes(text, r->path, part->text, part->n, err);
}
