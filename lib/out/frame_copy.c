/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/number_text.h"
#include "out/frame_copy.h"
#include "out/frames.h"

static void put_real(FILE *f, double x)
{
    char text[FL_NUMBER_LEN];
    putc(' ', f);
    fputs(fl_number_text(x, text), f);
}

static void put_vec3(FILE *f, fl_vec3 x)
{
    put_real(f, x.x);
    put_real(f, x.y);
    put_real(f, x.z);
}

static void put_shape(FILE *f, const fl_frame_data *d, const fl_frame_shape *s)
{
    fprintf(f, "shape %d", s->id);
    put_real(f, s->radius);
    fprintf(f, " %d %d\n", s->nv, s->nf);
    for (int32_t k = 0; k < s->nv; k++) {
        putc('v', f);
        put_vec3(f, d->vertex[s->v + k]);
        putc('\n', f);
    }
    for (int32_t k = 0; k < s->nf; k++) {
        const int32_t *first = &d->face[s->f + k];
        fprintf(f, "f %d", first[1] - first[0]);
        for (int32_t e = first[0]; e < first[1]; e++) fprintf(f, " %d", d->loop[e]);
        putc('\n', f);
    }
}

static void put_part(FILE *f, const fl_part *p)
{
    fprintf(f, "part %d %s\n", p->id, p->name);
    for (int32_t v = 0; v < p->nv; v++) {
        putc('v', f);
        put_vec3(f, p->v[v]);
        putc('\n', f);
    }
    for (int32_t t = 0; t < p->nt; t++) fprintf(f, "t %d %d %d\n", p->t[t].v[0], p->t[t].v[1], p->t[t].v[2]);
    for (int32_t c = 0; c < p->nc; c++) {
        fputs("cone", f);
        put_vec3(f, p->cone[c].p0);
        put_real(f, p->cone[c].r0);
        put_vec3(f, p->cone[c].p1);
        put_real(f, p->cone[c].r1);
        putc('\n', f);
    }
}

/* Shapes that are valid from a frame in (after, upto] on. */
static void put_shapes(FILE *f, const fl_frame_data *d, int32_t after, int32_t upto)
{
    for (int32_t s = 0; s < d->shapes; s++)
        if (d->shape[s].from > after && d->shape[s].from <= upto) put_shape(f, d, &d->shape[s]);
}

static int put_new_shapes(FILE *f, const fl_frame_data *d, int32_t after, int32_t upto,
                          fl_packed_writer *packed, fl_err *err)
{
    char *text = NULL;
    size_t n = 0;
    if (!packed) {
        put_shapes(f, d, after, upto);
        return 0;
    }
    FILE *records = open_memstream(&text, &n);
    if (!records) return fl_fail(err, FL_SYSTEM, "out of memory for frames");
    put_shapes(records, d, after, upto);
    const int rc = fclose(records) != 0 ? fl_fail(err, FL_SYSTEM, "out of memory for frames")
                                        : fl_packed_frames_text(f, packed, text, (int64_t)n, err);
    free(text);
    return rc;
}

static int is_moved(fl_vec3 x, fl_quat q) { return v3_nonzero(x) || q.w != 1.0; }

/* True if all parts are displaced by the same way and none is turned: one record does for all. */
static int moves_as_one(const fl_frame *f)
{
    for (int32_t p = 0; p < f->parts; p++)
        if (f->part_q[p].w != 1.0 || v3_nonzero(v3_sub(f->part_x[p], f->part_x[0]))) return 0;
    return f->parts > 0 && v3_nonzero(f->part_x[0]);
}

static void put_frame(FILE *f, const fl_frame_data *d, const fl_frame *a)
{
    fputs("frame", f);
    put_real(f, a->t);
    putc('\n', f);
    for (int32_t r = 0; r < a->rows; r++) {
        if (!a->there[r]) continue;
        fprintf(f, "body %d", d->shape[d->row_shape[r]].id);
        put_vec3(f, a->x[r]);
        put_real(f, a->q[r].w);
        put_vec3(f, v3(a->q[r].x, a->q[r].y, a->q[r].z));
        putc('\n', f);
    }
    if (moves_as_one(a)) {
        fputs("structure", f);
        put_vec3(f, a->part_x[0]);
        putc('\n', f);
        return;
    }
    for (int32_t p = 0; p < a->parts; p++)
        if (is_moved(a->part_x[p], a->part_q[p]))
            fl_frames_part_pose(f, d->structure.part[p].id, a->part_x[p], a->part_q[p]);
}

static int pack_frame(FILE *f, const fl_frame_data *d, const fl_frame *a, fl_packed_writer *w, fl_err *err)
{
    const int as_one = moves_as_one(a);
    fl_packed_frame_clear(w);
    for (int32_t r = 0; r < a->rows; r++)
        if (a->there[r] && fl_packed_frame_body(w, d->shape[d->row_shape[r]].id, a->x[r], a->q[r], err))
            return -1;
    for (int32_t p = 0; p < a->parts && !as_one; p++)
        if (is_moved(a->part_x[p], a->part_q[p]) &&
            fl_packed_frame_part(w, d->structure.part[p].id, a->part_x[p], a->part_q[p], err))
            return -1;
    return fl_packed_frame_write(f, w, a->t, 1, as_one ? &a->part_x[0] : NULL, err);
}

int fl_frame_copy_write(FILE *f, fl_frame_file *file, const fl_frame_copy *how, const fl_history_line *by,
                        fl_err *err)
{
    const fl_frame_data *d = fl_frame_file_data(file);
    fl_frame frame = {0};
    int32_t last = 0, taken = 0;
    int rc = -1;
    fl_write_file_header(f, "animation", how->packed ? 2 : 1, fl_frame_file_history(file), by);
    put_shapes(f, d, -1, 0);
    for (int32_t p = 0; p < d->structure.n; p++) put_part(f, &d->structure.part[p]);
    if (how->packed) fl_packed_frames_begin(f, how->packed);
    for (int32_t k = 0; k < d->frames; k++) {
        if (!(d->frame[k].t >= how->from && d->frame[k].t <= how->to) || taken++ % how->every) continue;
        if (put_new_shapes(f, d, last, k, how->packed, err) || fl_frame_file_read(file, k, &frame, err))
            goto done;
        last = k;
        if (!how->packed) put_frame(f, d, &frame);
        else if (pack_frame(f, d, &frame, how->packed, err)) goto done;
        if (ferror(f)) break; /* the output is full: fl_out_close() says so */
    }
    rc = 0;
done:
    fl_frame_free(&frame);
    return rc;
}
