/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#include "base/array.h"
#include "out/frame_codec.h"
#include "view/page.h"
#include "view/page_text.h"
#include "view/rounded_mesh.h"
#include "view/view_frame.h"

enum { BODIES_MAX = 20000, CURVE_POINTS = 2000, MANY_SPHERES = 1000 };
#define BOUND 1e-3
#define NOT_THERE (-1e4)

/* The bytes of the stream. */
struct stream {
    unsigned char *b;
    int32_t n, cap;
};

static int put_bytes(struct stream *s, const void *from, int64_t n, fl_err *err)
{
    if (fl_grow(&s->b, &s->cap, s->n + n, 1, err)) return -1;
    if (n) memcpy(s->b + s->n, from, (size_t)n);
    s->n += (int32_t)n;
    return 0;
}

static int put_word(struct stream *s, uint32_t x, fl_err *err)
{
    unsigned char b[4];
    for (int k = 0; k < 4; k++) b[k] = (unsigned char)(x >> (8 * k));
    return put_bytes(s, b, 4, err);
}

static int put_float(struct stream *s, double x, fl_err *err)
{
    const float f = (float)x;
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    return put_word(s, bits, err);
}

/* All shapes and parts one behind the other, with the number of the body of each vertex. */
struct scene_mesh {
    fl_rounded_mesh all;
    int32_t *first; /* [rows + parts + 1] vertices of a body */
};

static int make_meshes(struct scene_mesh *m, const fl_frame_data *d, fl_err *err)
{
    const int32_t bodies = d->rows + d->structure.n;
    m->first = fl_alloc((int64_t)bodies + 1, sizeof *m->first, err);
    if (!m->first) return -1;
    for (int32_t k = 0; k < bodies; k++) {
        fl_rounded_mesh one = {0};
        int bad;
        m->first[k] = m->all.nv;
        if (k < d->rows) {
            const fl_frame_shape *s = &d->shape[d->row_shape[k]];
            bad = fl_rounded_mesh_shape(&one, d, s, s->nv < 3 && d->rows < MANY_SPHERES ? 2 : 1, err);
        } else {
            const fl_aabb box = fl_part_aabb(&d->structure.part[k - d->rows]);
            bad = fl_rounded_mesh_part(&one, &d->structure.part[k - d->rows],
                                       1e-3 * v3_norm(v3_sub(box.hi, box.lo)), err);
        }
        bad = bad || fl_grow(&m->all.v, &m->all.v_cap, (int64_t)m->all.nv + one.nv, sizeof *one.v, err) ||
              fl_grow(&m->all.t, &m->all.t_cap, 3 * ((int64_t)m->all.nt + one.nt), sizeof *one.t, err);
        if (!bad) {
            if (one.nv) memcpy(m->all.v + m->all.nv, one.v, (size_t)one.nv * sizeof *one.v);
            for (int32_t t = 0; t < 3 * one.nt; t++)
                m->all.t[3 * m->all.nt + t] = (uint32_t)m->all.nv + one.t[t];
            m->all.nv += one.nv;
            m->all.nt += one.nt;
        }
        fl_rounded_mesh_free(&one);
        if (bad) return -1;
    }
    m->first[bodies] = m->all.nv;
    return 0;
}

static int put_meshes(struct stream *s, const struct scene_mesh *m, int32_t bodies, fl_err *err)
{
    for (int32_t v = 0; v < m->all.nv; v++)
        for (int k = 0; k < 3; k++)
            if (put_float(s, m->all.v[v].x[k], err)) return -1;
    for (int32_t t = 0; t < 3 * m->all.nt; t++)
        if (put_word(s, m->all.t[t], err)) return -1;
    for (int32_t b = 0; b < bodies; b++)
        for (int32_t v = m->first[b]; v < m->first[b + 1]; v++)
            if (put_float(s, b, err)) return -1;
    for (int32_t v = 0; v < m->all.nv; v++) {
        signed char n[4] = {0};
        for (int k = 0; k < 3; k++) n[k] = (signed char)lrintf(127.0f * m->all.v[v].n[k]);
        if (put_bytes(s, n, 4, err)) return -1;
    }
    return 0;
}

/* The curve over the time of the frames, in at most CURVE_POINTS steps: the least and the largest value of
 * each. */
static int put_curve(struct stream *s, const fl_curve *c, double from, double to, int32_t *points,
                     fl_err *err)
{
    int64_t i = 0;
    *points = 0;
    if (!c || !(to > from)) return 0;
    while (i < c->n && c->t[i] < from) i++;
    for (int k = 0; k < CURVE_POINTS && i < c->n; k++) {
        const double end = from + (to - from) * (k + 1) / CURVE_POINTS;
        double lo = INFINITY, hi = -INFINITY, t = 0;
        for (; i < c->n && c->t[i] <= end; i++) {
            lo = fmin(lo, c->y[i]);
            hi = fmax(hi, c->y[i]);
            t = c->t[i];
        }
        if (!(lo <= hi)) continue;
        if (put_float(s, t, err) || put_float(s, lo, err)) return -1;
        ++*points;
        if (hi == lo) continue;
        if (put_float(s, t, err) || put_float(s, hi, err)) return -1;
        ++*points;
    }
    return 0;
}

static int is_taken(const fl_page *page, double t, int32_t *count)
{
    return t >= page->from && t <= page->to && (*count)++ % page->every == 0;
}

/* Frames as their order in a byte and their planes; every body and part in each. */
static int put_frames(struct stream *s, fl_playback *p, const fl_page *page, fl_vec3 origin, fl_err *err)
{
    const fl_frame_data *d = p->data;
    const int32_t bodies = d->rows + d->structure.n, frames = p->file ? d->frames : 1;
    fl_frame_codec codec = {.bound_x = BOUND, .bound_q = BOUND};
    int32_t *id = fl_alloc(bodies, sizeof *id, err), count = 0;
    fl_vec3 *x = fl_alloc(bodies, sizeof *x, err);
    fl_quat *q = fl_alloc(bodies, sizeof *q, err);
    int rc = -1, order;
    if (!id || !x || !q) goto done;
    for (int32_t k = 0; k < frames; k++) {
        if (p->file && !is_taken(page, d->frame[k].t, &count)) continue;
        if (fl_playback_at(p, p->file ? d->frame[k].t : 0.0, err)) goto done;
        for (int32_t b = 0; b < bodies; b++) {
            const int is_part = b >= d->rows, there = is_part || p->now.there[b];
            id[b] = b;
            x[b] = there ? v3_sub(is_part ? p->now.part_x[b - d->rows] : p->now.x[b], origin)
                         : v3(0, 0, NOT_THERE);
            q[b] = there ? (is_part ? p->now.part_q[b - d->rows] : p->now.q[b]) : q_one();
        }
        if (fl_frame_codec_encode(&codec, bodies, id, x, q, INT32_MAX, &order, err)) goto done;
        const unsigned char byte = (unsigned char)order;
        const int32_t skip = codec.since_key == 1 ? 4 * bodies : 0; /* the numbers of a key */
        if (put_bytes(s, &byte, 1, err) || put_bytes(s, codec.planes + skip, codec.planes_len - skip, err))
            goto done;
    }
    rc = 0;
done:
    fl_frame_codec_free(&codec);
    free(id);
    free(x);
    free(q);
    return rc;
}

static void write_base64(FILE *f, const unsigned char *z, size_t n)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < n; i += 3) {
        const unsigned q =
            (unsigned)z[i] << 16 | (i + 1 < n ? (unsigned)z[i + 1] << 8 : 0) | (i + 2 < n ? z[i + 2] : 0);
        putc(digit[q >> 18], f);
        putc(digit[q >> 12 & 63], f);
        putc(i + 1 < n ? digit[q >> 6 & 63] : '=', f);
        putc(i + 2 < n ? digit[q & 63] : '=', f);
    }
}

static void write_title(FILE *f, const char *title)
{
    for (; *title; title++)
        if (*title == '<') fputs("&lt;", f);
        else if (*title == '&') fputs("&amp;", f);
        else putc(*title, f);
}

int fl_page_write(FILE *f, fl_playback *p, const fl_page *page, fl_err *err)
{
    const fl_frame_data *d = p->data;
    const int32_t bodies = d->rows + d->structure.n;
    const fl_vec3 origin = v3_scale(0.5, v3_add(p->box.lo, p->box.hi));
    struct scene_mesh m = {0};
    struct stream s = {0};
    unsigned char *z = NULL;
    int32_t points = 0, frames = 0, count = 0;
    double last = 0.0, first = INFINITY, wide = 0.0, thick = 0.0;
    int rc = -1;
    if (bodies > BODIES_MAX)
        return fl_fail(err, FL_INPUT, "--html: %d bodies, a page holds up to %d", bodies, BODIES_MAX);
    if (make_meshes(&m, d, err) || put_meshes(&s, &m, bodies, err)) goto done;
    for (int32_t k = 0; k < (p->file ? d->frames : 1); k++) {
        const double t = p->file ? d->frame[k].t : 0.0;
        if (p->file && !is_taken(page, t, &count)) continue;
        if (put_float(&s, t, err)) goto done;
        first = fmin(first, t);
        last = t;
        frames++;
    }
    if (!frames) {
        fl_fail(err, FL_USAGE, "--html: there is no frame between --from and --to");
        goto done;
    }
    for (int32_t r = 0; r < d->rows; r++) {
        const fl_frame_shape *shape = &d->shape[d->row_shape[r]];
        const double a = fl_shape_diameter(d, shape), b = fl_shape_thickness(d, shape);
        wide = fmax(wide, a);
        thick = fmax(thick, b);
        if (put_float(&s, a, err) || put_float(&s, b, err)) goto done;
    }
    if (put_curve(&s, page->curve, first, last, &points, err) || put_frames(&s, p, page, origin, err))
        goto done;
    uLongf len = compressBound((uLong)s.n);
    z = fl_alloc((int64_t)len, 1, err);
    if (!z) goto done;
    if (compress2(z, &len, s.b, (uLong)s.n, 9) != Z_OK) {
        fl_fail(err, FL_SYSTEM, "out of memory for a page");
        goto done;
    }
    fputs("<!doctype html>\n<!-- SPDX-License-Identifier: GPL-3.0-or-later -->\n<html "
          "lang=\"en\"><head><meta charset=\"utf-8\"><title>",
          f);
    write_title(f, page->title);
    fprintf(f,
            "</title>\n<script>\nconst HEAD = "
            "{n:%d,parts:%d,frames:%d,nv:%d,nt:%d,loads:%d,dx:%.9g,dq:%.9g,radius:%.9g,"
            "level:%.9g,top:[%.6g,%.6g,%.6g],curve:'%s'};\nconst DATA = '",
            d->rows, d->structure.n, frames, m.all.nv, m.all.nt, points, 2.0 * BOUND, 0.25 * BOUND,
            0.5 * v3_norm(v3_sub(p->box.hi, p->box.lo)), page->level - origin.z, page->top_speed,
            fl_round_up(wide), fl_round_up(thick), page->curve ? page->curve->title : "");
    write_base64(f, z, len);
    fputs("';\n</script>\n", f);
    for (int k = 0; fl_page_text[k]; k++) fputs(fl_page_text[k], f);
    rc = 0;
done:
    fl_rounded_mesh_free(&m.all);
    free(m.first);
    free(s.b);
    free(z);
    return rc;
}
