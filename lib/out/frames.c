/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "out/frames.h"
#include "base/number_text.h"

static void put_real(FILE *f, double x)
{
    char text[FL_NUMBER_LEN];
    putc(' ', f);
    fputs(fl_number_text(x, text), f);
}

static void put_vec3(FILE *f, fl_vec3 a)
{
    put_real(f, a.x);
    put_real(f, a.y);
    put_real(f, a.z);
}

static void put_vertex(FILE *f, fl_vec3 x)
{
    putc('v', f);
    put_vec3(f, x);
    putc('\n', f);
}

void fl_frames_shape(FILE *f, const fl_poses *s, int32_t i)
{
    const fl_poly *p = &s->b->core[i];
    const fl_mat3 R = q_matrix(s->q0[i]);
    fprintf(f, "shape %d", s->id[i]);
    put_real(f, s->b->radius[i]);
    fprintf(f, " %d %d\n", p->nv, p->nf);
    for (int32_t v = 0; v < p->nv; v++) put_vertex(f, m3_mul(R, p->v[v]));
    for (int32_t k = 0; k < p->nf; k++) {
        fprintf(f, "f %d", p->first[k + 1] - p->first[k]);
        for (int32_t e = p->first[k]; e < p->first[k + 1]; e++) fprintf(f, " %d", p->loop[e]);
        putc('\n', f);
    }
}

void fl_frames_header(FILE *f, const char *history, const fl_history_line *by, const fl_poses *s,
                      const fl_surface *surface, const fl_packed_writer *packed)
{
    fl_write_file_header(f, "animation", packed ? 2 : 1, history, by);
    for (int32_t c = 0; c < s->b->n; c++)
        if (fl_poses_body(s, c) >= 0) fl_frames_shape(f, s, fl_poses_body(s, c));
    for (int32_t k = 0; surface && k < surface->n; k++) {
        const fl_part *p = &surface->part[k];
        fprintf(f, "part %d %s\n", p->id, p->name);
        for (int32_t v = 0; v < p->nv; v++) put_vertex(f, p->v[v]);
        for (int32_t t = 0; t < p->nt; t++)
            fprintf(f, "t %d %d %d\n", p->t[t].v[0], p->t[t].v[1], p->t[t].v[2]);
        for (int32_t c = 0; c < p->nc; c++) {
            fputs("cone", f);
            put_vec3(f, p->cone[c].p0);
            put_real(f, p->cone[c].r0);
            put_vec3(f, p->cone[c].p1);
            put_real(f, p->cone[c].r1);
            putc('\n', f);
        }
    }
    if (packed) fl_packed_frames_begin(f, packed);
}

int fl_frames_packed_bodies(fl_packed_writer *w, const fl_poses *s, fl_err *err)
{
    for (int32_t c = 0; c < s->b->n; c++) {
        const int32_t i = fl_poses_body(s, c);
        if (i < 0) continue;
        if (fl_packed_frame_body(w, s->id[i], fl_poses_position(s, i), q_mul(s->b->q[i], q_conj(s->q0[i])),
                                 err))
            return -1;
    }
    return 0;
}

void fl_frames_frame(FILE *f, double t, const fl_poses *s, fl_vec3 displacement, int ice)
{
    fputs("frame", f);
    put_real(f, t);
    putc('\n', f);
    for (int32_t c = 0; ice && c < s->b->n; c++) {
        const int32_t i = fl_poses_body(s, c);
        if (i < 0) continue;
        const fl_quat q = q_mul(s->b->q[i], q_conj(s->q0[i]));
        fprintf(f, "body %d", s->id[i]);
        put_vec3(f, fl_poses_position(s, i));
        put_real(f, q.w);
        put_vec3(f, v3(q.x, q.y, q.z));
        putc('\n', f);
    }
    if (v3_nonzero(displacement)) {
        fputs("structure", f);
        put_vec3(f, displacement);
        putc('\n', f);
    }
}

void fl_frames_part_pose(FILE *f, int32_t id, fl_vec3 x, fl_quat q)
{
    fprintf(f, "moved %d", id);
    put_vec3(f, x);
    put_real(f, q.w);
    put_vec3(f, v3(q.x, q.y, q.z));
    putc('\n', f);
}
