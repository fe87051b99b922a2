/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/array.h"
#include "base/stream.h"
#include "mesh/gstruct.h"
#include "out/frame_file.h"
#include "out/frame_state.h"
#include "out/frame_text.h"
#include "out/packed_frames.h"
#include "out/seekable.h"
#include "scene/ice_field.h"

enum { CHUNK = 1 << 20, LINE_MAX_BYTES = 1 << 20, PIECES_MAX = 100000 };
enum form { FORM_UNKNOWN, FORM_TEXT, FORM_STATE };

struct piece {
    fl_seekable *in;
    int unfinished; /* NAME.part */
};

struct fl_frame_file {
    fl_frame_data d;
    struct piece *piece;
    int32_t pieces, piece_cap;
    enum form form;
    fl_frame_text text;
    fl_frame_state state;
    char warning[400];
    char *history;
    int32_t history_len, history_cap;
    /* The line under assembly in the first pass. */
    char *buf;
    int32_t buf_len, buf_cap;
    int64_t offset; /* of buf[0] in the file */
    /* The bytes of a frame. */
    char *bytes;
    int32_t bytes_cap;
    /* Packed: the last frame decoded, -1: none. */
    fl_frame_codec codec;
    int32_t decoded;
};

const fl_frame_data *fl_frame_file_data(const fl_frame_file *f) { return &f->d; }
const char *fl_frame_file_name(const fl_frame_file *f) { return fl_seekable_name(f->piece[0].in); }
const char *fl_frame_file_warning(const fl_frame_file *f) { return f->warning[0] ? f->warning : NULL; }
const char *fl_frame_file_history(const fl_frame_file *f) { return f->history; }

static void warn_of(fl_frame_file *f, const char *name, const char *what)
{
    if (!f->warning[0]) snprintf(f->warning, sizeof f->warning, "%.200s: %s", name, what);
}

/* --- the first pass ---------------------------------------------------------------------------- */

static int first_line(fl_frame_file *f, const char *at, const char *end, fl_err *err)
{
    char kind[24] = "";
    int version = 0;
    char head[64];
    const size_t n = (size_t)(end - at) < sizeof head - 1 ? (size_t)(end - at) : sizeof head - 1;
    memcpy(head, at, n);
    head[n] = '\0';
    if (sscanf(head, "#%23s %d", kind, &version) != 2) version = 0;
    f->form = strcmp(kind, "animation") == 0 ? FORM_TEXT
              : strcmp(kind, "state") == 0   ? FORM_STATE
                                             : FORM_UNKNOWN;
    const int newest = f->form == FORM_TEXT ? 2 : 1;
    if (f->form == FORM_UNKNOWN || version < 1)
        return fl_fail(err, FL_INPUT,
                       "%s:1: this is no file of frames: its first line is not \"#animation 1\" or 2",
                       f->text.name);
    if (version > newest)
        return fl_fail(err, FL_INPUT,
                       "%s:1: version %d of %s is newer than this program, which reads up to %d",
                       f->text.name, version, kind, newest);
    return 0;
}

static int keep_history(fl_frame_file *f, const char *at, const char *end, fl_err *err)
{
    const int32_t n = (int32_t)(end - at);
    if (f->text.piece || n < 4 || memcmp(at, "#by ", 4) != 0) return 0;
    if (fl_grow(&f->history, &f->history_cap, (int64_t)f->history_len + n + 2, 1, err)) return -1;
    memcpy(f->history + f->history_len, at, (size_t)n);
    f->history_len += n;
    f->history[f->history_len++] = '\n';
    f->history[f->history_len] = '\0';
    return 0;
}

static int take_line(fl_frame_file *f, const char *at, const char *end, fl_err *err)
{
    const int64_t offset = f->offset + (at - f->buf);
    const int64_t line = f->form == FORM_STATE ? f->state.line : f->text.line;
    if (line == 0) {
        if (first_line(f, at, end, err)) return -1;
        if (f->form == FORM_STATE) f->state.line = 1;
        else f->text.line = 1;
        return 0;
    }
    if (at < end && *at == '#' && keep_history(f, at, end, err)) return -1;
    return f->form == FORM_STATE ? fl_frame_state_line(&f->state, at, end, offset, err)
                                 : fl_frame_text_line(&f->text, at, end, offset, err);
}

/* Takes the complete lines of buf and keeps the rest at its start. */
static int take_lines(fl_frame_file *f, fl_err *err)
{
    char *at = f->buf, *const end = f->buf + f->buf_len;
    while (at < end && !f->text.packed) {
        char *stop = memchr(at, '\n', (size_t)(end - at));
        if (!stop) break;
        if (take_line(f, at, stop, err)) return -1;
        at = stop + 1;
    }
    memmove(f->buf, at, (size_t)(end - at));
    f->buf_len = (int32_t)(end - at);
    f->offset += at - f->buf;
    return 0;
}

/* Records of shapes in a block. */
static int take_text_block(fl_frame_file *f, fl_seekable *in, const fl_packed_block *b, int64_t at,
                           fl_err *err)
{
    int rc = -1;
    unsigned char *stored = fl_alloc(b->stored + 1, 1, err), *bytes = NULL;
    if (!stored || fl_seekable_read(in, at, stored, b->stored, err)) goto done;
    bytes = fl_packed_inflate(f->text.name, b, stored, 0, err);
    if (!bytes) goto done;
    const char *p = (const char *)bytes, *const end = p + b->inflated;
    while (p < end) {
        const char *stop = memchr(p, '\n', (size_t)(end - p));
        if (!stop) {
            fl_fail(err, FL_INPUT, "%s: a block of records does not end its last line", f->text.name);
            goto done;
        }
        if (fl_frame_text_line(&f->text, p, stop, 0, err)) goto done;
        p = stop + 1;
    }
    rc = fl_frame_text_end(&f->text, 0, err);
done:
    free(stored);
    free(bytes);
    return rc;
}

static int add_packed_frame(fl_frame_file *f, const fl_packed_frame *h, const fl_packed_block *b, int64_t at,
                            fl_err *err)
{
    fl_frame_data *const d = &f->d;
    fl_frame_entry e = {
        .t = h->t, .at = at, .size = FL_PACKED_BLOCK + b->stored, .piece = f->text.piece, .key = d->frames};
    e.bodies = h->flags & FL_PACKED_NO_BODIES ? -1 : h->n;
    if (d->frames && e.t <= d->frame[d->frames - 1].t)
        return fl_fail(err, FL_INPUT, "%s: time %g s does not follow %g s", f->text.name, e.t,
                       d->frame[d->frames - 1].t);
    if (!(h->flags & FL_PACKED_KEY)) {
        const int32_t before = d->frames ? d->frame[d->frames - 1].ice : -1;
        if (before >= 0 && d->frame[before].piece == e.piece) e.key = d->frame[before].key;
        else if (e.bodies >= 0)
            return fl_fail(err, FL_INPUT, "%s: the frame of %g s is no key, and no frame is before it",
                           f->text.name, e.t);
    }
    return fl_frame_data_add_frame(d, e, err);
}

/* Blocks from f->offset on; hops from head to head.  What is there up to a block that is cut off is taken. */
static int take_blocks(fl_frame_file *f, fl_seekable *in, fl_err *err)
{
    unsigned char head[FL_PACKED_BLOCK + FL_PACKED_FRAME];
    for (;;) {
        const int64_t want = (int64_t)sizeof head - f->buf_len;
        int64_t k = 0;
        if (want > 0) {
            if (fl_grow(&f->buf, &f->buf_cap, (int64_t)sizeof head, 1, err)) return -1;
            k = fl_seekable_next(in, f->buf + f->buf_len, want, err);
            if (k < 0) return -1;
            f->buf_len += (int32_t)k;
            if (k > 0 && k < want) continue;
        }
        fl_packed_block b;
        fl_packed_frame h;
        if (f->buf_len < FL_PACKED_BLOCK) return f->buf_len > 0;
        memcpy(head, f->buf, f->buf_len < (int32_t)sizeof head ? (size_t)f->buf_len : sizeof head);
        if (fl_packed_block_read(head, &b))
            return fl_fail(err, FL_INPUT, "%s: no block begins at byte %" PRId64 ": the file is damaged",
                           f->text.name, f->offset);
        const int is_frame = strcmp(b.kind, "FRAM") == 0;
        if (is_frame && f->buf_len < (int32_t)sizeof head) return 1;
        if (is_frame && fl_packed_frame_read(head + FL_PACKED_BLOCK, &h))
            return fl_fail(err, FL_INPUT, "%s: the frame at byte %" PRId64 " is damaged", f->text.name,
                           f->offset);
        /* To the end of the block: its last byte must be there. */
        const int64_t size = FL_PACKED_BLOCK + b.stored, at = f->offset;
        if (size > f->buf_len) {
            char last;
            if (fl_seekable_skip(in, size - f->buf_len - 1, err)) return -1;
            k = fl_seekable_next(in, &last, 1, err);
            if (k < 0) return -1;
            if (k == 0) { /* cut off: a later pass begins with this block again */
                fl_seekable_set_back(in, at);
                f->buf_len = 0;
                return 1;
            }
            f->buf_len = 0;
        } else {
            f->buf_len -= (int32_t)size;
            memmove(f->buf, f->buf + size, (size_t)f->buf_len);
        }
        f->offset = at + size;
        if (is_frame ? add_packed_frame(f, &h, &b, at, err)
                     : take_text_block(f, in, &b, at + FL_PACKED_BLOCK, err))
            return -1;
    }
}

/* Reads on to the end of the piece.  1: it ends within a record. */
static int scan_piece(fl_frame_file *f, fl_seekable *in, fl_err *err)
{
    while (!f->text.packed) {
        if (f->buf_len > LINE_MAX_BYTES)
            return fl_fail(err, FL_INPUT, "%s: a line of more than %d bytes: the file is of another kind",
                           f->text.name, LINE_MAX_BYTES);
        if (fl_grow(&f->buf, &f->buf_cap, (int64_t)f->buf_len + CHUNK, 1, err)) return -1;
        const int64_t k = fl_seekable_next(in, f->buf + f->buf_len, CHUNK, err);
        if (k < 0) return -1;
        if (k == 0) break;
        f->buf_len += (int32_t)k;
        if (take_lines(f, err)) return -1;
    }
    if (f->text.packed) {
        if (!f->text.in_shape && fl_frame_text_end(&f->text, f->offset, err)) return -1;
        f->codec.bound_x = f->text.bound_x;
        f->codec.bound_q = f->text.bound_q;
        return take_blocks(f, in, err);
    }
    return f->buf_len > 0;
}

/* The last frame of a file that is cut off within it is not shown. */
static void drop_last_frame(fl_frame_file *f)
{
    if (f->d.frames) f->d.frames--;
}

/* The end of a piece as it is now. */
static int end_piece(fl_frame_file *f, const struct piece *p, int within, fl_err *err)
{
    const char *name = f->text.name;
    const int32_t n = f->d.frames;
    const int cut = within || fl_seekable_is_cut(p->in);
    const int next_begins = within && f->buf_len >= 6 && memcmp(f->buf, "frame ", 6) == 0;
    if (f->form == FORM_UNKNOWN && f->text.line == 0)
        return fl_fail(err, FL_INPUT, "%s: %s", name,
                       f->buf_len ? "this is no file of frames" : "the file is empty");
    if (f->form == FORM_STATE) fl_frame_state_end(&f->state, f->offset);
    else if (!f->text.packed) {
        if (f->text.in_shape && p->unfinished && n) return 0; /* it is being written */
        if (cut && f->text.in_shape)
            return fl_fail(err, FL_INPUT, "%s:%" PRId64 ": the file ends within a shape", name, f->text.line);
        if (fl_frame_text_end(&f->text, f->offset, err)) return -1;
    }
    if (cut) {
        if (!f->text.packed && n && f->d.frame[n - 1].piece == f->text.piece && !next_begins)
            drop_last_frame(f);
        if (!p->unfinished) warn_of(f, name, "the file is cut off in its last frame, which is not shown");
    } else if (p->unfinished && !f->text.packed && n > 1 && f->d.frame[n - 1].ice == n - 1 &&
               f->d.frame[n - 2].ice >= 0 &&
               f->d.frame[n - 1].bodies < f->d.frame[f->d.frame[n - 2].ice].bodies)
        drop_last_frame(f); /* it is being written */
    return 0;
}

static void begin_piece(fl_frame_file *f, const char *name)
{
    f->text = (fl_frame_text){.d = &f->d, .name = name, .piece = f->pieces - 1};
    f->state = (fl_frame_state){.d = &f->d, .name = name};
    f->buf_len = 0;
    f->offset = 0;
}

static int add_piece(fl_frame_file *f, const char *path, int unfinished, fl_err *err)
{
    if (fl_grow(&f->piece, &f->piece_cap, (int64_t)f->pieces + 1, sizeof *f->piece, err)) return -1;
    struct piece *p = &f->piece[f->pieces];
    *p = (struct piece){.in = fl_seekable_open(path, err), .unfinished = unfinished};
    if (!p->in) return -1;
    f->pieces++;
    const int packed_before = f->pieces > 1 && f->text.packed;
    begin_piece(f, fl_seekable_name(p->in));
    const int within = scan_piece(f, p->in, err);
    if (within >= 0 && f->pieces > 1 && f->text.packed != packed_before)
        return fl_fail(err, FL_INPUT, "%s: the files of a run are of two forms, text and packed",
                       f->text.name);
    return within < 0 || end_piece(f, p, within, err) ? -1 : 0;
}

static int readable(const char *path) { return access(path, R_OK) == 0; }

static int open_pieces(fl_frame_file *f, const char *path, fl_err *err)
{
    char *part = fl_out_part_path(path);
    char name[4096];
    int rc;
    const int use_part = strcmp(path, "-") != 0 && !readable(path) && part && readable(part);
    if (strcmp(path, "-") == 0 || readable(path) || use_part) {
        rc = add_piece(f, use_part ? part : path, use_part, err);
        free(part);
        return rc;
    }
    free(part);
    for (int k = 0; k < PIECES_MAX; k++) {
        int unfinished = 0;
        if (snprintf(name, sizeof name, "%.4000s.%d", path, k) < 0) break;
        if (!readable(name)) {
            if (snprintf(name, sizeof name, "%.4000s.%d.part", path, k) < 0 || !readable(name)) break;
            unfinished = 1;
        }
        if (add_piece(f, name, unfinished, err)) return -1;
    }
    return f->pieces ? 0 : add_piece(f, path, 0, err); /* which names what is missing */
}

/* --- shapes of a state ------------------------------------------------------------------------- */

struct shape_source {
    fl_frame_file *f;
    fl_ice_field ice;
    fl_frame_data index; /* rows are indices of the field */
    int missing;
};

/* A row of the first frame: its x is the centre that the core in the ice file is seen from. */
static int shape_of_row(void *to, int64_t line, int32_t id, fl_vec3 x, fl_quat q, fl_vec3 v, fl_vec3 w,
                        fl_err *err)
{
    struct shape_source *const s = to;
    const int32_t i = fl_frame_data_row(&s->index, id);
    (void)line, (void)q, (void)v, (void)w;
    if (i < 0) {
        s->missing++;
        return 0;
    }
    const fl_poly *p = &s->ice.core[i];
    if (fl_frame_data_add_shape(&s->f->d, id, s->ice.radius[i], 0, err)) return -1;
    s->f->d.shape[s->f->d.shapes - 1].from = 0;
    for (int32_t k = 0; k < p->nv; k++)
        if (fl_frame_data_add_vertex(&s->f->d, v3_sub(p->v[k], x), err)) return -1;
    for (int32_t k = 0; k < p->nf; k++)
        if (fl_frame_data_add_face(&s->f->d, p->loop + p->first[k], p->first[k + 1] - p->first[k], err))
            return -1;
    return 0;
}

/* A row of the last frame: bodies that came in during the run have no shape in the ice file. */
static int count_missing(void *to, int64_t line, int32_t id, fl_vec3 x, fl_quat q, fl_vec3 v, fl_vec3 w,
                         fl_err *err)
{
    struct shape_source *const s = to;
    (void)line, (void)x, (void)q, (void)v, (void)w, (void)err;
    s->missing += fl_frame_data_row(&s->index, id) < 0;
    return 0;
}

static int read_bytes(fl_frame_file *f, const fl_frame_entry *e, fl_err *err)
{
    if (fl_grow(&f->bytes, &f->bytes_cap, e->size + 1, 1, err) ||
        fl_seekable_read(f->piece[e->piece].in, e->at, f->bytes, e->size, err))
        return -1;
    f->bytes[e->size] = '\n';
    return 0;
}

static int read_shapes(fl_frame_file *f, const char *shapes, fl_err *err)
{
    struct shape_source s = {.f = f};
    int rc = -1;
    if (!shapes)
        return fl_fail(err, FL_INPUT, "%s: a state has no shapes: name the ice file by --ice", f->text.name);
    if (fl_ice_field_read(&s.ice, shapes, err)) goto done;
    for (int32_t i = 0; i < s.ice.n; i++)
        if (fl_frame_data_add_shape(&s.index, s.ice.id[i], 0.0, 0, err)) goto done;
    if (f->d.frames && (read_bytes(f, &f->d.frame[0], err) ||
                        fl_frame_state_read(&f->d.frame[0], f->text.name, f->bytes, shape_of_row, &s, err)))
        goto done;
    if (s.missing) warn_of(f, shapes, "bodies of the state are not in this ice file and are not shown");
    if (f->d.frames > 1) {
        const fl_frame_entry *const last = &f->d.frame[f->d.frames - 1];
        if (read_bytes(f, last, err) ||
            fl_frame_state_read(last, f->text.name, f->bytes, count_missing, &s, err))
            goto done;
    }
    if (s.missing)
        warn_of(f, f->text.name,
                "bodies that came in during the run have no shape in the ice file and are not shown; "
                "frames of output.frames have them");
    rc = 0;
done:
    fl_ice_field_free(&s.ice);
    fl_frame_data_free(&s.index);
    return rc;
}

/* --- a frame ----------------------------------------------------------------------------------- */

struct row_target {
    const fl_frame_file *f;
    fl_frame *out;
};

static int place_row(void *to, int64_t line, int32_t id, fl_vec3 x, fl_quat q, fl_vec3 v, fl_vec3 w,
                     fl_err *err)
{
    const struct row_target *const r = to;
    const int32_t row = fl_frame_data_row(&r->f->d, id);
    if (row < 0) return 0; /* not in the ice file: the warning said so */
    if (fl_frame_set_pose(&r->f->d, r->f->text.name, line, row, x, q, r->out, err)) return -1;
    r->out->v[row] = v;
    r->out->w[row] = w;
    return 0;
}

/* The block of entry e: head, and its inflated bytes, to be freed. */
static unsigned char *read_block(fl_frame_file *f, const fl_frame_entry *e, fl_packed_block *b,
                                 fl_packed_frame *h, fl_err *err)
{
    const char *name = fl_seekable_name(f->piece[e->piece].in);
    if (read_bytes(f, e, err)) return NULL;
    const unsigned char *bytes = (const unsigned char *)f->bytes;
    if (fl_packed_block_read(bytes, b) || b->stored + FL_PACKED_BLOCK != e->size ||
        fl_packed_frame_read(bytes + FL_PACKED_BLOCK, h)) {
        fl_fail(err, FL_INPUT, "%s: has changed since it was opened", name);
        return NULL;
    }
    return fl_packed_inflate(name, b, bytes + FL_PACKED_BLOCK, FL_PACKED_FRAME, err);
}

static int fail_length(const fl_frame_file *f, double t, fl_err *err)
{
    return fl_fail(err, FL_INPUT, "%s: the frame of %g s does not follow from those before it", f->text.name,
                   t);
}

/* Decodes the bodies of frame k, from its key or from what was decoded last. */
static int decode_bodies(fl_frame_file *f, int32_t k, fl_err *err)
{
    const fl_frame_entry *const last = &f->d.frame[k];
    const int follows = f->decoded >= last->key && f->decoded <= k && f->d.frame[f->decoded].key == last->key;
    for (int32_t j = follows ? f->decoded + 1 : last->key; j <= k; j++) {
        fl_packed_block b;
        fl_packed_frame h;
        if (f->d.frame[j].bodies < 0) continue;
        f->decoded = -1;
        unsigned char *bytes = read_block(f, &f->d.frame[j], &b, &h, err);
        if (!bytes) return -1;
        const int is_key = (h.flags & FL_PACKED_KEY) != 0;
        const int64_t size = fl_frame_codec_size(h.n, is_key);
        int rc = size > b.inflated ? fail_length(f, h.t, err)
                                   : fl_frame_codec_room(&f->codec, is_key ? h.n : f->codec.n, err);
        if (rc == 0) {
            if (!is_key && h.n != f->codec.n) rc = fail_length(f, h.t, err);
            else {
                memcpy(f->codec.planes, bytes, (size_t)size);
                if (fl_frame_codec_decode(&f->codec, h.n, is_key, h.order)) rc = fail_length(f, h.t, err);
            }
        }
        free(bytes);
        if (rc) return -1;
        f->decoded = j;
    }
    return 0;
}

static int read_packed(fl_frame_file *f, int32_t k, int32_t ice, fl_frame *out, fl_err *err)
{
    fl_packed_block b;
    fl_packed_frame h;
    const char *name = f->text.name;
    int32_t guess = 0;
    if (ice >= 0 && decode_bodies(f, ice, err)) return -1;
    for (int32_t i = 0; ice >= 0 && i < f->codec.n; i++) {
        const int32_t id = f->codec.id[i];
        const int32_t row = guess < f->d.rows && f->d.shape[f->d.row_shape[guess]].id == id
                                ? guess
                                : fl_frame_data_row(&f->d, id);
        if (row < 0 || f->d.shape[f->d.row_shape[row]].from > k)
            return fl_fail(err, FL_INPUT, "%s: frame of %g s: body %d has no shape before it", name, out->t,
                           id);
        guess = row + 1;
        if (fl_frame_set_pose(&f->d, name, 0, row, fl_frame_codec_place(&f->codec, i),
                              fl_frame_codec_rotation(&f->codec, i), out, err))
            return -1;
    }
    unsigned char *bytes = read_block(f, &f->d.frame[k], &b, &h, err);
    if (!bytes) return -1;
    const int64_t planes =
        h.flags & FL_PACKED_NO_BODIES ? 0 : fl_frame_codec_size(h.n, (h.flags & FL_PACKED_KEY) != 0);
    const int rc = planes > b.inflated ? fail_length(f, h.t, err)
                                       : fl_packed_frame_parts(&f->d, name, &h, bytes + planes,
                                                               b.inflated - planes, out, err);
    free(bytes);
    return rc;
}

int fl_frame_file_read(fl_frame_file *f, int32_t k, fl_frame *out, fl_err *err)
{
    const fl_frame_entry *const e = &f->d.frame[k];
    const int32_t ice = e->ice;
    if (fl_frame_clear(out, &f->d, err)) return -1;
    out->t = e->t;
    out->k = k;
    int rc;
    if (f->form == FORM_STATE) {
        struct row_target to = {f, out};
        out->has_velocity = 1;
        rc = read_bytes(f, e, err) || fl_frame_state_read(e, f->text.name, f->bytes, place_row, &to, err);
    } else if (f->text.packed) rc = read_packed(f, k, ice, out, err);
    else {
        const char *name = fl_seekable_name(f->piece[e->piece].in);
        rc = read_bytes(f, e, err) || fl_frame_text_read(&f->d, e, name, f->bytes, ice == k, 1, out, err);
        if (rc == 0 && ice >= 0 && ice != k) {
            const fl_frame_entry *const i = &f->d.frame[ice];
            rc =
                read_bytes(f, i, err) || fl_frame_text_read(&f->d, i, fl_seekable_name(f->piece[i->piece].in),
                                                            f->bytes, 1, 0, out, err);
        }
    }
    if (rc) out->k = -1;
    return rc ? -1 : 0;
}

/* --- open and close ---------------------------------------------------------------------------- */

fl_frame_file *fl_frame_file_open(const char *path, const char *shapes, fl_err *err)
{
    fl_frame_file *f = fl_alloc(1, sizeof *f, err);
    if (!f) return NULL;
    f->decoded = -1;
    if (open_pieces(f, path, err) || (f->form == FORM_STATE && read_shapes(f, shapes, err))) goto fail;
    if (!f->d.frames) {
        fl_fail(err, FL_INPUT, "%s: the file has no frame", f->text.name);
        goto fail;
    }
    return f;
fail:
    fl_frame_file_close(f);
    return NULL;
}

int fl_frame_file_add_structure(fl_frame_file *f, const char *path, fl_err *err)
{
    if (f->d.structure.n)
        return fl_fail(err, FL_INPUT, "%s: the file has a structure of its own", f->text.name);
    return fl_gstruct_read(&f->d.structure, path, err);
}

int fl_frame_file_is(const char *path)
{
    char head[12] = "", part[4096];
    fl_err lost = {0};
    if (strcmp(path, "-") == 0) return 1;
    if (!readable(path)) {
        snprintf(part, sizeof part, "%.4000s.0", path);
        if (readable(part)) return 1;
        snprintf(part, sizeof part, "%.4000s.0.part", path);
        if (readable(part)) return 1;
        snprintf(part, sizeof part, "%.4000s.part", path);
    }
    fl_in *in = fl_in_open(readable(path) ? path : part, &lost);
    if (!in) return 0;
    int64_t n = 0, k;
    while (n < 10 && (k = fl_in_read(in, head + n, 10 - n, &lost)) > 0) n += k;
    fl_in_close(in);
    return strncmp(head, "#animation", 10) == 0 || strncmp(head, "#state ", 7) == 0;
}

int32_t fl_frame_file_extend(fl_frame_file *f, fl_err *err)
{
    const int32_t before = f->d.frames;
    struct piece *const p = &f->piece[f->pieces - 1];
    if (!p->unfinished || f->form == FORM_STATE) return 0;
    if (!f->text.packed && f->d.frames) { /* the last frame may have grown: read it again */
        const fl_frame_entry e = f->d.frame[f->d.frames - 1];
        f->d.frames--;
        f->text.in_frame = 0;
        f->text.line = e.line - 1;
        f->buf_len = 0;
        f->offset = e.at;
        fl_seekable_set_back(p->in, e.at);
    }
    const int within = scan_piece(f, p->in, err);
    if (within < 0) return -1;
    if (!f->text.packed) {
        if (fl_frame_text_end(&f->text, f->offset, err)) return -1;
        if (f->d.frames > before) f->d.frames--; /* it may still be under way */
    }
    return f->d.frames - before;
}

void fl_frame_file_close(fl_frame_file *f)
{
    if (!f) return;
    for (int32_t k = 0; k < f->pieces; k++) fl_seekable_close(f->piece[k].in);
    free(f->piece);
    fl_frame_data_free(&f->d);
    fl_frame_codec_free(&f->codec);
    free(f->history);
    free(f->buf);
    free(f->bytes);
    free(f);
}
