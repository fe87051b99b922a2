/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ice-view -- the ice seen: frames in; a window, pictures, films, a page, files for ParaView out. */
#include <stdio.h>
#include <stdlib.h>
#include "base/stream.h"
#include "base/tool.h"
#include "convert.h"
#include "options.h"
#ifdef FL_HAVE_GL
#include "shot.h"
#endif
#include "subject.h"
#ifdef FL_HAVE_WINDOW
#include "window.h"
#endif

static int save_look(const struct options *o, fl_err *err)
{
    fl_out out = {0};
    if (fl_out_open(&out, o->save_look, 0, err)) return -1;
    fl_look_write(out.f, &o->look);
    return fl_out_close(&out, err);
}

/* What needs OpenGL. */
static int draw_all(struct subject *s, struct options *o, fl_err *err)
{
#ifdef FL_HAVE_GL
    if (o->out && shot_picture(s, o, err)) return -1;
    return o->movie ? shot_movie(s, o, err) : 0;
#else
    (void)s;
    return o->out || o->movie ? fl_fail(err, FL_SYSTEM,
                                        "no pictures: this ice-view was built without OpenGL (packages "
                                        "libepoxy-dev, libegl-dev)")
                              : 0;
#endif
}

static int show_window(struct subject *s, struct options *o, fl_err *err)
{
#ifdef FL_HAVE_WINDOW
    return window_run(s, o, err);
#else
    (void)s;
    (void)o;
    return fl_fail(
        err, FL_SYSTEM,
        "no window: this ice-view was built without it (package libsdl2-dev); -o FILE.png needs none");
#endif
}

static int run(struct options *o, fl_err *err)
{
    struct subject s;
    int rc = subject_open(&s, o, err);
    if (rc == 0 && o->info) rc = convert_info(&s, o, err);
    if (rc == 0 && (o->text || o->packed)) rc = convert_frames(&s, o, err);
    if (rc == 0 && o->save_look) rc = save_look(o, err);
    if (rc == 0 && o->html) rc = convert_html(&s, o, err);
    if (rc == 0 && o->vtk) rc = convert_vtk(&s, o, err);
    if (rc == 0) rc = draw_all(&s, o, err);
    if (rc == 0 && o->window) rc = show_window(&s, o, err);
    subject_close(&s);
    return rc;
}

int main(int argc, char **argv)
{
    struct options o;
    fl_err err = {0};
    fl_tool_begin();
    int rc = options_parse(&o, argc, argv, &err);
    if (rc == 0 && !o.ended && o.keys) fl_look_explain(stdout);
    else if (rc == 0 && !o.ended) rc = run(&o, &err);
    return fl_tool_end("ice-view", rc, &err);
}
