/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include "view/gl_context.h"

static EGLDisplay display = EGL_NO_DISPLAY;
static EGLContext context = EGL_NO_CONTEXT;

int fl_gl_context_open(fl_err *err)
{
    static const EGLint want[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                  EGL_NONE};
    static const EGLint core[] = {EGL_CONTEXT_MAJOR_VERSION,
                                  3,
                                  EGL_CONTEXT_MINOR_VERSION,
                                  3,
                                  EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                  EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                  EGL_NONE};
    EGLint major, minor, n = 0;
    EGLConfig config = NULL;
    /* libepoxy ends the process where the library is missing, so it is looked for first. */
    void *egl = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL);
    if (!egl) return fl_fail(err, FL_SYSTEM, "no pictures: there is no EGL library (package libegl1)");
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (display == EGL_NO_DISPLAY) display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor))
        return fl_fail(err, FL_SYSTEM, "no pictures: EGL finds no driver (package libgl1-mesa-dri)");
    if (!eglBindAPI(EGL_OPENGL_API)) return fl_fail(err, FL_SYSTEM, "no pictures: this EGL has no OpenGL");
    if (!eglChooseConfig(display, want, &config, 1, &n) || n < 1) config = EGL_NO_CONFIG_KHR;
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, core);
    if (context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
        return fl_fail(err, FL_SYSTEM, "no pictures: the driver has no OpenGL 3.3 core without a window");
    return 0;
}

void fl_gl_context_close(void)
{
    if (display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    eglTerminate(display);
    display = EGL_NO_DISPLAY;
    context = EGL_NO_CONTEXT;
}
