/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gl_context.h -- OpenGL 3.3 core without a window, by EGL: Mesa's surfaceless platform, else the default
 * display. */
#ifndef FL_VIEW_GL_CONTEXT_H
#define FL_VIEW_GL_CONTEXT_H
#include "base/err.h"

/* Makes a context current in this thread.  -1 with FL_SYSTEM, which names the package that is missing. */
int fl_gl_context_open(fl_err *err);
void fl_gl_context_close(void);

#endif
