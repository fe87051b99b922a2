/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "convert.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include "base/stream.h"
#include "out/frame_copy.h"
#include "view/page.h"
#include "view/vtk_frames.h"

enum { PATH_LEN = 4096 };

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

/* Opens DIR/NAME. */
static int open_in(fl_out *out, const char *dir, const char *name, fl_err *err)
{
    char path[PATH_LEN];
    if (snprintf(path, sizeof path, "%s/%s", dir, name) >= (int)sizeof path)
        return fl_fail(err, FL_SYSTEM, "%.60s...: the name is too long", dir);
    return fl_out_open(out, path, 0, err);
}

/* The panels of the time shown; NULL: none are given. */
static int panels_now(const struct subject *s, const struct options *o, const double (**panel)[4],
                      fl_err *err)
{
    int64_t a, b;
    *panel = NULL;
    if (!o->panels) return 0;
    fl_time_rows_at(&s->panels, s->play.now.t, &a, &b);
    if (b - a != fl_vtk_panels(&s->play.data->structure))
        return fl_fail(err, FL_INPUT, "%s: %lld panels at %g s, the structure has %lld", o->panels,
                       (long long)(b - a), s->play.now.t, (long long)fl_vtk_panels(&s->play.data->structure));
    *panel = (const double(*)[4])(const void *)(s->panels.x + 4 * a);
    return 0;
}

static int write_vtk_file(struct subject *s, const struct options *o, int structure, const char *name,
                          fl_err *err)
{
    fl_out out = {0};
    const double(*panel)[4] = NULL;
    if ((structure && panels_now(s, o, &panel, err)) || open_in(&out, o->vtk, name, err)) return -1;
    if ((structure ? fl_vtk_write_structure(out.f, &s->play, panel, err)
                   : fl_vtk_write_bodies(out.f, &s->play, s->group, o->points, err)) == 0)
        return fl_out_close(&out, err);
    fl_out_abort(&out);
    return -1;
}

static int write_collection(struct subject *s, const struct options *o, int structure, fl_err *err)
{
    const char *stem = structure ? "structure" : o->points ? "points" : "floes";
    const int32_t frames = s->file ? s->play.data->frames : 1;
    fl_out pvd = {0};
    char name[80];
    int32_t taken = 0, written = 0;
    snprintf(name, sizeof name, "%s.pvd", stem);
    if (open_in(&pvd, o->vtk, name, err)) return -1;
    fl_vtk_begin_collection(pvd.f);
    for (int32_t k = 0; k < frames; k++) {
        const double t = s->file ? s->play.data->frame[k].t : 0.0;
        if (t < o->from || t > o->to || taken++ % o->every) continue;
        snprintf(name, sizeof name, "%s-%05d.vtp", stem, written++);
        if (fl_playback_at(&s->play, t, err) || write_vtk_file(s, o, structure, name, err)) {
            fl_out_abort(&pvd);
            return -1;
        }
        fl_vtk_add_file(pvd.f, t, name);
    }
    fl_vtk_end_collection(pvd.f);
    return fl_out_close(&pvd, err);
}

int convert_vtk(struct subject *s, const struct options *o, fl_err *err)
{
    if (mkdir(o->vtk, 0777) != 0 && errno != EEXIST)
        return fl_fail(err, FL_SYSTEM, "%s: %s", o->vtk, strerror(errno));
    if (s->play.data->rows && write_collection(s, o, 0, err)) return -1;
    return s->play.data->structure.n ? write_collection(s, o, 1, err) : 0;
}

int convert_html(struct subject *s, const struct options *o, fl_err *err)
{
    const fl_curve curve = {s->curve.t, s->curve.y, s->curve.n, 0, 0, o->component};
    fl_page page = {.from = isnan(o->from) ? -INFINITY : o->from,
                    .to = isnan(o->to) ? INFINITY : o->to,
                    .every = o->every,
                    .level = o->look.water.level,
                    .curve = s->curve.n ? &curve : NULL,
                    .title = o->in};
    double lowest;
    fl_out out = {0};
    if (fl_playback_range(&s->play, FL_BY_SPEED, &lowest, &page.top_speed, err) ||
        fl_out_open(&out, o->html, 0, err))
        return -1;
    if (fl_page_write(out.f, &s->play, &page, err) == 0) return fl_out_close(&out, err);
    fl_out_abort(&out);
    return -1;
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
