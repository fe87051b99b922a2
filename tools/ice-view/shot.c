/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shot.h"
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/array.h"
#include "base/stream.h"
#include "view/edge_smoothing.h"
#include "view/film.h"
#include "view/gl_context.h"
#include "view/gl_view.h"
#include "view/picture_file.h"

enum { PNG_LEVEL = 6 };

static int has_ending(const char *path, const char *ending)
{
    const size_t n = strlen(path), m = strlen(ending);
    return n > m && strcmp(path + n - m, ending) == 0;
}

int shot_check_name(const char *path, fl_err *err)
{
    static const char *const known[] = {".png", ".bmp", ".jpg", ".jpeg"};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
        if (has_ending(path, known[k])) return 0;
    return fl_fail(err, FL_USAGE, "-o %.200s: a picture ends in .png, .bmp or .jpg", path);
}

int shot_write(const char *path, const fl_picture *p, fl_err *err)
{
    fl_out out = {0};
    if (shot_check_name(path, err)) return -1;
    if (has_ending(path, ".jpg") || has_ending(path, ".jpeg")) return fl_film_jpg(path, p, err);
    if (fl_out_open(&out, path, 0, err)) return -1;
    if (has_ending(path, ".bmp")) fl_bmp_write(out.f, p);
    else if (fl_png_write(out.f, p, PNG_LEVEL, err)) {
        fl_out_abort(&out);
        return -1;
    }
    return fl_out_close(&out, err);
}

static const fl_sea_surface *sea_of(const struct subject *s) { return s->sea.height ? &s->sea : NULL; }

/* The picture under way: what is drawn, without the strip of the load curve, and the whole. */
struct canvas {
    fl_gl_view *gl;
    fl_gl_quality q;
    fl_picture seen, whole;
    unsigned char *luminance; /* [w h of seen] */
    fl_camera camera;
    int standing; /* the camera is that of the picture before */
};

static int canvas_open(struct canvas *k, const struct subject *s, const fl_look *l, int moving, fl_err *err)
{
    const int w = l->picture.width, h = l->picture.height, seen = h - subject_strip(s, l, w, h);
    k->q = fl_gl_view_quality(l, w, seen, moving);
    if (fl_gl_context_open(err)) return -1;
    k->gl = fl_gl_view_open(err);
    if (k->gl) k->luminance = fl_alloc((int64_t)w * seen, 1, err);
    return !k->luminance || fl_picture_make(&k->seen, w, seen, err) || fl_picture_make(&k->whole, w, h, err)
               ? -1
               : 0;
}

static void canvas_close(struct canvas *k)
{
    fl_gl_view_close(k->gl);
    fl_picture_free(&k->seen);
    fl_picture_free(&k->whole);
    free(k->luminance);
    fl_gl_context_close();
}

static int canvas_draw(struct canvas *k, const struct subject *s, const fl_look *l, double spin_seconds,
                       fl_err *err)
{
    if (!k->standing) k->camera = subject_camera(s, l, (double)k->q.w / k->q.h, spin_seconds);
    k->standing = l->view.spin == 0.0;
    return fl_gl_view_draw(k->gl, &s->shown, l, &k->camera, k->q, sea_of(s), err);
}

/* Edges, bar, time and curve on what has been read. */
static void canvas_finish(struct canvas *k, const struct subject *s, const fl_look *l, double t)
{
    if (k->q.samples == 1 && l->picture.smooth)
        fl_smooth_edges(k->seen.px, k->seen.w, k->seen.h, k->luminance, k->whole.px);
    else memcpy(k->whole.px, k->seen.px, 4 * (size_t)k->seen.w * (size_t)k->seen.h);
    subject_legend(s, l, t, &k->whole);
}

int shot_picture(struct subject *s, const struct options *o, fl_err *err)
{
    const fl_look *l = &o->look;
    struct canvas k = {0};
    int rc = -1;
    if (shot_check_name(o->out, err)) return -1;
    const double t = isnan(o->at) ? fl_playback_end(&s->play) : o->at;
    if (s->play.file && (t > fl_playback_end(&s->play) * (1 + 1e-12) || t < fl_playback_start(&s->play)))
        return fl_fail(err, FL_USAGE, "--at %g: the frames are from %g s to %g s", t,
                       fl_playback_start(&s->play), fl_playback_end(&s->play));
    if (subject_range(s, l, err) || subject_at(s, l, t, err) || subject_fit_now(s, err)) return -1;
    if (canvas_open(&k, s, l, 0, err) == 0 && canvas_draw(&k, s, l, 0.0, err) == 0 &&
        fl_gl_view_read(k.gl, &k.seen, err) == 0) {
        canvas_finish(&k, s, l, subject_time(s));
        rc = shot_write(o->out, &k.whole, err);
    }
    canvas_close(&k);
    return rc;
}

static volatile sig_atomic_t stopped;
static void on_signal(int number) { stopped = number; }

static void show_progress(const struct options *o, int64_t k, int64_t n)
{
    if (o->quiet || !isatty(STDERR_FILENO)) return;
    fprintf(stderr, "\rice-view: picture %lld of %lld", (long long)k, (long long)n);
    if (k == n) fputc('\n', stderr);
}

int shot_movie(struct subject *s, const struct options *o, fl_err *err)
{
    const fl_look *l = &o->look;
    struct canvas k = {0};
    fl_film film = {0};
    double t[2] = {0, 0};
    int rc = -1;
    if (!s->play.file) return fl_fail(err, FL_INPUT, "%s: this file has one picture, and no film", o->in);
    const double start = fl_playback_start(&s->play), end = fl_playback_end(&s->play);
    const double from = isnan(o->from) ? start : o->from, to = isnan(o->to) ? end : o->to,
                 step = o->times / o->fps;
    if (from > end || to < start)
        return fl_fail(err, FL_USAGE, "--from %g --to %g: the frames are from %g s to %g s", from, to, start,
                       end);
    const double last = fmin(to, end), first = fmax(from, start);
    const int64_t n = (int64_t)floor((last - first) / step * (1 + 1e-12)) + 1;
    if (subject_range(s, l, err) || subject_fit_all(s, first, last, err) ||
        fl_film_open(&film, o->movie, l->picture.width, l->picture.height, o->fps, err))
        return -1;
    if (canvas_open(&k, s, l, 1, err)) goto done;
    signal(SIGINT, on_signal);
    signal(SIGTERM, on_signal);
    /* Picture i is started before picture i - 1 is taken, smoothed and encoded. */
    for (int64_t i = 0; i <= n && !stopped; i++) {
        if (i < n) {
            if (subject_at(s, l, first + (double)i * step, err) ||
                canvas_draw(&k, s, l, (double)i / o->fps, err))
                goto done;
            t[i & 1] = subject_time(s);
            fl_gl_view_start_read(k.gl, (int)(i & 1));
        }
        if (i == 0) continue;
        fl_gl_view_end_read(k.gl, (int)((i - 1) & 1), &k.seen);
        canvas_finish(&k, s, l, t[(i - 1) & 1]);
        if (fl_film_add(&film, &k.whole, err)) goto done;
        show_progress(o, i, n);
    }
    if (stopped) fl_fail(err, FL_SYSTEM, "%s: stopped by a signal; nothing is left of the film", o->movie);
    else rc = fl_film_close(&film, err);
done:
    fl_film_abort(&film);
    canvas_close(&k);
    return rc;
}
