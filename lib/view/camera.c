/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "view/camera.h"

/* The camera never looks straight down or up: its sideways would have no direction. */
#define STEEPEST 1.57070

fl_mat4 fl_mat4_mul(fl_mat4 a, fl_mat4 b)
{
    fl_mat4 c;
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) {
            float s = 0.0f;
            for (int k = 0; k < 4; k++) s += a.m[4 * k + i] * b.m[4 * j + k];
            c.m[4 * j + i] = s;
        }
    return c;
}

static fl_mat4 perspective(double field, double aspect, double near, double far)
{
    const double f = 1.0 / tan(0.5 * field);
    return (fl_mat4){{(float)(f / aspect), 0, 0, 0, 0, (float)f, 0, 0, 0, 0,
                      (float)((far + near) / (near - far)), -1, 0, 0, (float)(2 * far * near / (near - far)),
                      0}};
}

static fl_mat4 parallel(double half_w, double half_h, double near, double far)
{
    return (fl_mat4){{(float)(1 / half_w), 0, 0, 0, 0, (float)(1 / half_h), 0, 0, 0, 0,
                      (float)(-2 / (far - near)), 0, 0, 0, (float)(-(far + near) / (far - near)), 1}};
}

static fl_mat4 look_at(fl_vec3 eye, fl_vec3 ahead, fl_vec3 *right, fl_vec3 *up)
{
    const fl_vec3 f = v3_unit(ahead), s = v3_unit(v3_cross(f, v3(0, 0, 1))), u = v3_cross(s, f);
    *right = s;
    *up = u;
    return (fl_mat4){{(float)s.x, (float)u.x, (float)-f.x, 0, (float)s.y, (float)u.y, (float)-f.y, 0,
                      (float)s.z, (float)u.z, (float)-f.z, 0, (float)-v3_dot(s, eye), (float)-v3_dot(u, eye),
                      (float)v3_dot(f, eye), 1}};
}

static fl_vec3 backward(const fl_camera *c)
{
    const double e = fmax(-STEEPEST, fmin(STEEPEST, c->elevation));
    return v3(cos(e) * cos(c->azimuth), cos(e) * sin(c->azimuth), sin(e));
}

fl_eye fl_camera_eye(const fl_camera *c, int w, int h, fl_vec3 centre, double radius)
{
    const fl_vec3 back = backward(c), ahead = v3_neg(back), eye = v3_madd(c->at, c->distance, back);
    const double depth = v3_dot(v3_sub(centre, eye), ahead), half = tan(0.5 * c->field) * c->distance;
    fl_vec3 right, up;
    fl_eye out = {.parallel = c->parallel};
    double near = depth - 1.05 * radius, far = depth + 1.05 * radius;
    if (!c->parallel) {
        far = fmax(far, 0.1 * c->distance);
        near = fmax(near, fmax(0.004 * c->distance, 2e-4 * far));
    }
    if (far <= near) far = near + radius;
    out.view = look_at(eye, ahead, &right, &up);
    out.projection = c->parallel ? parallel(half * w / h, half, near, far)
                                 : perspective(c->field, (double)w / h, near, far);
    out.both = fl_mat4_mul(out.projection, out.view);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            out.inverse_turn.m[4 * i + j] = i < 3 && j < 3 ? out.view.m[4 * j + i] : i == j;
    out.eye[0] = (float)eye.x;
    out.eye[1] = (float)eye.y;
    out.eye[2] = (float)eye.z;
    out.ahead[0] = (float)ahead.x;
    out.ahead[1] = (float)ahead.y;
    out.ahead[2] = (float)ahead.z;
    out.pixel = 2.0 * tan(0.5 * c->field) * (c->parallel ? c->distance : 1.0) / h;
    return out;
}

double fl_eye_distance(const fl_eye *eye, const float p[3], double reach)
{
    const double x = p[0] - eye->eye[0], y = p[1] - eye->eye[1], z = p[2] - eye->eye[2];
    return eye->parallel ? 1.0 : fmax(1e-9, fmax(0.02 * reach, sqrt(x * x + y * y + z * z) - reach));
}

void fl_camera_ray(const fl_camera *c, int w, int h, double px, double py, fl_vec3 *from, fl_vec3 *along)
{
    const fl_vec3 back = backward(c), ahead = v3_neg(back), eye = v3_madd(c->at, c->distance, back);
    const double half = tan(0.5 * c->field), x = (2.0 * (px + 0.5) / w - 1.0) * half * w / h,
                 y = (1.0 - 2.0 * (py + 0.5) / h) * half;
    fl_vec3 right, up;
    (void)look_at(eye, ahead, &right, &up);
    const fl_vec3 off = v3_add(v3_scale(x, right), v3_scale(y, up));
    *from = c->parallel ? v3_madd(eye, c->distance, off) : eye;
    *along = v3_unit(c->parallel ? ahead : v3_add(ahead, off));
}
