/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <epoxy/gl.h>
#include "view/gl_program.h"

enum { PARTS_MAX = 16, LOG_LEN = 400 };

static GLuint compile(GLenum kind, const char *const *text, fl_err *err)
{
    const char *part[PARTS_MAX] = {"#version 330 core\n"};
    GLsizei n = 1;
    GLint ok;
    char log[LOG_LEN];
    while (*text && n < PARTS_MAX) part[n++] = *text++;
    const GLuint s = glCreateShader(kind);
    glShaderSource(s, n, part, NULL);
    glCompileShader(s);
    glGetShaderiv(s, GL_COMPILE_STATUS, &ok);
    if (ok) return s;
    glGetShaderInfoLog(s, sizeof log, NULL, log);
    glDeleteShader(s);
    fl_fail(err, FL_SYSTEM, "the driver refuses a shader: %s", log);
    return 0;
}

unsigned fl_gl_program(const char *const *vertex, const char *const *fragment, fl_err *err)
{
    const GLuint v = compile(GL_VERTEX_SHADER, vertex, err),
                 f = v ? compile(GL_FRAGMENT_SHADER, fragment, err) : 0;
    GLint ok;
    char log[LOG_LEN];
    if (!f) {
        if (v) glDeleteShader(v);
        return 0;
    }
    const GLuint p = glCreateProgram();
    glAttachShader(p, v);
    glAttachShader(p, f);
    glLinkProgram(p);
    glDeleteShader(v);
    glDeleteShader(f);
    glGetProgramiv(p, GL_LINK_STATUS, &ok);
    if (ok) return p;
    glGetProgramInfoLog(p, sizeof log, NULL, log);
    glDeleteProgram(p);
    fl_fail(err, FL_SYSTEM, "the driver cannot link a shader: %s", log);
    return 0;
}

unsigned fl_gl_texture(enum fl_gl_format format, int w, int h, int linear)
{
    static const struct {
        GLint inner;
        GLenum outer, type;
    } as[] = {[FL_GL_COLOUR] = {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE},
              [FL_GL_DEPTH] = {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_FLOAT},
              [FL_GL_GREY] = {GL_R8, GL_RED, GL_UNSIGNED_BYTE},
              [FL_GL_FLOAT4] = {GL_RGBA32F, GL_RGBA, GL_FLOAT},
              [FL_GL_FLOAT1] = {GL_R32F, GL_RED, GL_FLOAT}};
    GLuint t;
    glGenTextures(1, &t);
    glBindTexture(GL_TEXTURE_2D, t);
    glTexImage2D(GL_TEXTURE_2D, 0, as[format].inner, w, h, 0, as[format].outer, as[format].type, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, linear ? GL_LINEAR : GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, linear ? GL_LINEAR : GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return t;
}

unsigned fl_gl_target(unsigned colour, unsigned depth, fl_err *err)
{
    GLuint f;
    glGenFramebuffers(1, &f);
    glBindFramebuffer(GL_FRAMEBUFFER, f);
    if (colour) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour, 0);
    if (depth) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
    if (!colour) {
        glDrawBuffer(GL_NONE);
        glReadBuffer(GL_NONE);
    }
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return f;
    glDeleteFramebuffers(1, &f);
    fl_fail(err, FL_SYSTEM, "the driver has no room for a picture of this size");
    return 0;
}

static GLint place(unsigned program, const char *name) { return glGetUniformLocation(program, name); }

void fl_gl_set_matrix(unsigned p, const char *name, const fl_mat4 *m)
{
    glUniformMatrix4fv(place(p, name), 1, GL_FALSE, m->m);
}
void fl_gl_set_float(unsigned p, const char *name, float x) { glUniform1f(place(p, name), x); }
void fl_gl_set_int(unsigned p, const char *name, int x) { glUniform1i(place(p, name), x); }
void fl_gl_set_vec2(unsigned p, const char *name, float x, float y) { glUniform2f(place(p, name), x, y); }
void fl_gl_set_vec3(unsigned p, const char *name, const float x[3]) { glUniform3fv(place(p, name), 1, x); }
void fl_gl_set_vec4(unsigned p, const char *name, const float x[4]) { glUniform4fv(place(p, name), 1, x); }

void fl_gl_bind(unsigned p, const char *sampler, int unit, unsigned texture)
{
    glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(GL_TEXTURE_2D, texture);
    glUniform1i(place(p, sampler), unit);
}
