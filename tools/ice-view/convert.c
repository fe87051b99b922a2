/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "convert.h"
#include <math.h>
#include <stdio.h>
#include "base/stream.h"
#include "out/frame_copy.h"

static int copy_to(struct subject *s, const struct options *o, const char *path, fl_packed_writer *packed,
                   fl_err *err)
{
    fl_history_line by;
    fl_out out = {0};
    fl_frame_copy how = {isnan(o->from) ? -INFINITY : o->from, isnan(o->to) ? INFINITY : o->to, o->every,
                         packed};
    options_by(o, &by);
    if (packed) fl_history_line_add(&by, "--packed");
    else fl_history_line_add(&by, "--text");
    if (fl_out_open(&out, path, packed ? 0 : o->gzip, err)) return -1;
    if (fl_frame_copy_write(out.f, s->file, &how, &by, err) == 0) return fl_out_close(&out, err);
    fl_out_abort(&out);
    return -1;
}

int convert_frames(struct subject *s, const struct options *o, fl_err *err)
{
    if (!s->file) return fl_fail(err, FL_INPUT, "%s: this file has no frames to write", o->in);
    if (o->text && copy_to(s, o, o->text, NULL, err)) return -1;
    if (!o->packed) return 0;
    fl_packed_writer w = fl_packed_writer_make(o->bound_x, o->bound_q, FL_PACKED_KEY_EVERY);
    const int rc = copy_to(s, o, o->packed, &w, err);
    fl_packed_writer_free(&w);
    return rc;
}

int convert_info(const struct subject *s, const struct options *o, fl_err *err)
{
    const fl_frame_data *d = s->play.data;
    int32_t spheres = 0, capsules = 0;
    (void)err;
    for (int32_t r = 0; r < d->rows; r++) {
        const fl_frame_shape *shape = &d->shape[d->row_shape[r]];
        spheres += shape->nv == 1;
        capsules += shape->nv == 2;
    }
    printf("file\t%s\n", o->in);
    printf("bodies\t%d\n", d->rows);
    printf("polyhedra\t%d\nspheres\t%d\ncapsules\t%d\n", d->rows - spheres - capsules, spheres, capsules);
    printf("parts\t%d\n", d->structure.n);
    printf("frames\t%d\n", d->frames);
    if (d->frames) printf("from[s]\t%.9g\nto[s]\t%.9g\n", d->frame[0].t, d->frame[d->frames - 1].t);
    const fl_aabb b = s->play.box;
    if (b.lo.x <= b.hi.x)
        printf("x[m]\t%.6g\t%.6g\ny[m]\t%.6g\t%.6g\nz[m]\t%.6g\t%.6g\n", b.lo.x, b.hi.x, b.lo.y, b.hi.y,
               b.lo.z, b.hi.z);
    return 0;
}
