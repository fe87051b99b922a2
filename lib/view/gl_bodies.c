/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <epoxy/gl.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "view/gl_bodies.h"
#include "view/gl_program.h"
#include "view/rounded_mesh.h"

enum { LEVELS = 4, VERTEX_FLOATS = 7, BALL_FLOATS = 8, TUBE_FLOATS = 10, TEXTURE_ROW = 512, TUBE_SIDES = 12 };
static const int CUTS[LEVELS] = {0, 1, 2, 6};
/* Spheres of fewer pixels than this are points; limits of drivers are 255 and more. */
#define POINT_PIXELS 120.0
/* Level from which on a mesh is made only for this many bodies, so that memory stays bounded. */
enum { FINE_BODIES = 3000 };

struct range {
    int32_t first, count; /* indices; count -1: not made */
};

struct fl_gl_bodies {
    const fl_frame_data *data;
    int32_t shapes, parts;
    struct range *range; /* [(shapes + parts) LEVELS] */
    float *vertex;       /* [VERTEX_FLOATS vertices] */
    uint32_t *index;
    int32_t vertices, vertex_cap, indices, index_cap, sent_vertices, sent_indices;
    size_t vertex_room, index_room; /* bytes on the device */
    GLuint vertex_array, vertex_buffer, index_buffer, pose, ball_array, point_array, ball_buffer, tube_array,
        tube_buffer;
    GLuint tube_index;
    int32_t pose_rows;
    float *texels;
    int32_t texel_cap;
    float *ball; /* points first, then squares */
    int32_t ball_cap, points, squares, tubes;
    GLsizei *count; /* of a draw */
    const void **offset;
    int32_t draw_cap, offset_cap;
    const fl_view_frame *frame; /* of the last load, borrowed */
    uint8_t *level;             /* [rows + parts] */
    int32_t level_cap;
};

static void describe_balls(GLuint array, GLuint buffer, size_t from, GLuint divisor)
{
    glBindVertexArray(array);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    for (GLuint k = 0; k < 2; k++) {
        glEnableVertexAttribArray(k);
        glVertexAttribPointer(k, 4, GL_FLOAT, GL_FALSE, BALL_FLOATS * sizeof(float),
                              (const void *)(from + 16 * k));
        glVertexAttribDivisor(k, divisor);
    }
}

fl_gl_bodies *fl_gl_bodies_open(fl_err *err)
{
    fl_gl_bodies *b = fl_alloc(1, sizeof *b, err);
    GLushort strip[6 * TUBE_SIDES];
    static const int size[4] = {3, 3, 1, 3};
    if (!b) return NULL;
    glGenVertexArrays(1, &b->vertex_array);
    glGenVertexArrays(1, &b->ball_array);
    glGenVertexArrays(1, &b->point_array);
    glGenVertexArrays(1, &b->tube_array);
    glGenBuffers(1, &b->vertex_buffer);
    glGenBuffers(1, &b->index_buffer);
    glGenBuffers(1, &b->ball_buffer);
    glGenBuffers(1, &b->tube_buffer);
    glGenBuffers(1, &b->tube_index);
    glBindVertexArray(b->vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, b->vertex_buffer);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, b->index_buffer);
    for (GLuint k = 0; k < 3; k++) {
        glEnableVertexAttribArray(k);
        glVertexAttribPointer(k, k < 2 ? 3 : 1, GL_FLOAT, GL_FALSE, VERTEX_FLOATS * sizeof(float),
                              (const void *)(size_t)(12 * k));
    }
    for (int k = 0; k < TUBE_SIDES; k++) {
        const int a = 2 * k, c = 2 * ((k + 1) % TUBE_SIDES), six[6] = {a, c, c + 1, a, c + 1, a + 1};
        for (int i = 0; i < 6; i++) strip[6 * k + i] = (GLushort)six[i];
    }
    glBindVertexArray(b->tube_array);
    glBindBuffer(GL_ARRAY_BUFFER, b->tube_buffer);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, b->tube_index);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof strip, strip, GL_STATIC_DRAW);
    for (GLuint k = 0, at = 0; k < 4; at += (GLuint)size[k++]) {
        glEnableVertexAttribArray(k);
        glVertexAttribPointer(k, size[k], GL_FLOAT, GL_FALSE, TUBE_FLOATS * sizeof(float),
                              (const void *)(size_t)(4 * at));
        glVertexAttribDivisor(k, 1);
    }
    return b;
}

void fl_gl_bodies_close(fl_gl_bodies *b)
{
    if (!b) return;
    const GLuint buffer[5] = {b->vertex_buffer, b->index_buffer, b->ball_buffer, b->tube_buffer,
                              b->tube_index};
    const GLuint array[4] = {b->vertex_array, b->ball_array, b->point_array, b->tube_array};
    glDeleteBuffers(5, buffer);
    glDeleteVertexArrays(4, array);
    if (b->pose) glDeleteTextures(1, &b->pose);
    free(b->range);
    free(b->vertex);
    free(b->index);
    free(b->texels);
    free(b->ball);
    free(b->count);
    free(b->offset);
    free(b->level);
    free(b);
}

int32_t fl_gl_bodies_point_count(const fl_gl_bodies *b) { return b->points; }
int32_t fl_gl_bodies_square_count(const fl_gl_bodies *b) { return b->squares; }

/* --- meshes ------------------------------------------------------------------------------------ */

static int begin_data(fl_gl_bodies *b, const fl_frame_data *d, fl_err *err)
{
    const int64_t n = (int64_t)(d->shapes + d->structure.n) * LEVELS;
    struct range *r = fl_alloc(n, sizeof *r, err);
    if (!r) return -1;
    for (int64_t k = 0; k < n; k++) r[k].count = -1;
    free(b->range);
    b->range = r;
    b->data = d;
    b->shapes = d->shapes;
    b->parts = d->structure.n;
    b->vertices = b->indices = b->sent_vertices = b->sent_indices = 0;
    return 0;
}

static int keep_mesh(fl_gl_bodies *b, struct range *r, const fl_rounded_mesh *m, int32_t row, fl_err *err)
{
    if (fl_grow(&b->vertex, &b->vertex_cap, (int64_t)VERTEX_FLOATS * (b->vertices + (int64_t)m->nv),
                sizeof *b->vertex, err) ||
        fl_grow(&b->index, &b->index_cap, b->indices + 3 * (int64_t)m->nt, sizeof *b->index, err))
        return -1;
    r->first = b->indices;
    r->count = 3 * m->nt;
    for (int32_t k = 0; k < m->nv; k++) {
        float *to = b->vertex + (size_t)VERTEX_FLOATS * (size_t)(b->vertices + k);
        memcpy(to, &m->v[k], 6 * sizeof *to);
        to[6] = (float)row;
    }
    for (int32_t k = 0; k < r->count; k++) b->index[b->indices + k] = (uint32_t)b->vertices + m->t[k];
    b->vertices += m->nv;
    b->indices += r->count;
    return 0;
}

static struct range *range_of(fl_gl_bodies *b, int32_t shape, int level)
{
    return &b->range[(size_t)shape * LEVELS + (size_t)level];
}

static int need_shape(fl_gl_bodies *b, const fl_frame_shape *s, int32_t row, int level, fl_err *err)
{
    struct range *r = range_of(b, (int32_t)(s - b->data->shape), level);
    fl_rounded_mesh m = {0};
    if (r->count >= 0) return 0;
    const int rc = fl_rounded_mesh_shape(&m, b->data, s, CUTS[level], err) || keep_mesh(b, r, &m, row, err);
    fl_rounded_mesh_free(&m);
    return rc ? -1 : 0;
}

static int need_part(fl_gl_bodies *b, int32_t part, double chord, fl_err *err)
{
    struct range *r = range_of(b, b->shapes + part, 0);
    fl_rounded_mesh m = {0};
    if (r->count >= 0) return 0;
    const int rc = fl_rounded_mesh_part(&m, &b->data->structure.part[part], chord, err) ||
                   keep_mesh(b, r, &m, b->frame->rows + part, err);
    fl_rounded_mesh_free(&m);
    return rc ? -1 : 0;
}

/* What has been added since the last time to the device; all of it where its buffer is too small. */
static void send_buffer(GLenum target, GLuint buffer, const void *data, size_t sent, size_t n, size_t *room)
{
    glBindBuffer(target, buffer);
    if (n > *room) {
        *room = n + n / 2;
        glBufferData(target, (GLsizeiptr)*room, NULL, GL_DYNAMIC_DRAW);
        sent = 0;
    }
    if (n > sent) glBufferSubData(target, (GLintptr)sent, (GLsizeiptr)(n - sent), (const char *)data + sent);
}

static void send_meshes(fl_gl_bodies *b)
{
    const size_t v = VERTEX_FLOATS * sizeof(float), i = sizeof *b->index;
    glBindVertexArray(b->vertex_array);
    send_buffer(GL_ARRAY_BUFFER, b->vertex_buffer, b->vertex, v * (size_t)b->sent_vertices,
                v * (size_t)b->vertices, &b->vertex_room);
    send_buffer(GL_ELEMENT_ARRAY_BUFFER, b->index_buffer, b->index, i * (size_t)b->sent_indices,
                i * (size_t)b->indices, &b->index_room);
    b->sent_vertices = b->vertices;
    b->sent_indices = b->indices;
}

/* --- a frame ----------------------------------------------------------------------------------- */

static int is_there(const fl_view_pose *p)
{
    return p->q[0] * p->q[0] + p->q[1] * p->q[1] + p->q[2] * p->q[2] + p->q[3] * p->q[3] > 0.5f;
}

static int choose_levels(fl_gl_bodies *b, const fl_view_frame *v, const fl_eye *eye, fl_err *err)
{
    const fl_frame_data *d = v->data;
    int32_t fine = 0;
    if (fl_grow(&b->level, &b->level_cap, (int64_t)v->rows + 1, 1, err)) return -1;
    for (int32_t r = 0; r < v->rows; r++) {
        const fl_frame_shape *s = fl_frame_data_shape(d, r, v->frame);
        b->level[r] = 0;
        if (s->nv < 2 || !is_there(&v->pose[r])) continue;
        const double pixels = s->radius / (eye->pixel * fl_eye_distance(eye, v->pose[r].x, v->reach[r]));
        int level = pixels < 0.25 ? 0 : pixels < 2.0 ? 1 : pixels < 6.0 ? 2 : 3;
        if (level > 1 && ++fine > FINE_BODIES) level = 1;
        if (s->nf == 2 && level < 2) level = 2; /* a flat core: its corners are lunes */
        if (need_shape(b, s, r, level, err) || (level > 1 && need_shape(b, s, r, 1, err))) return -1;
        b->level[r] = (uint8_t)level;
    }
    for (int32_t p = 0; p < v->parts; p++)
        if (need_part(b, p, 1e-4 * v->radius, err)) return -1;
    return 0;
}

static int send_poses(fl_gl_bodies *b, const fl_view_frame *v, fl_err *err)
{
    const int32_t n = v->rows + v->parts, rows = (n + TEXTURE_ROW - 1) / TEXTURE_ROW;
    if (rows == 0) return 0;
    if (fl_grow(&b->texels, &b->texel_cap, (int64_t)12 * TEXTURE_ROW * rows, sizeof *b->texels, err))
        return -1;
    memcpy(b->texels, v->pose, (size_t)n * sizeof *v->pose);
    if (rows != b->pose_rows) {
        if (b->pose) glDeleteTextures(1, &b->pose);
        b->pose = fl_gl_texture(FL_GL_FLOAT4, 3 * TEXTURE_ROW, rows, 0);
        b->pose_rows = rows;
    }
    glBindTexture(GL_TEXTURE_2D, b->pose);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 3 * TEXTURE_ROW, rows, GL_RGBA, GL_FLOAT, b->texels);
    return 0;
}

/* Spheres: those that fit a point first, then squares, from the end backward. */
static int send_balls(fl_gl_bodies *b, const fl_view_frame *v, const fl_eye *eye, fl_err *err)
{
    int32_t front = 0, n = 0;
    for (int32_t r = 0; r < v->rows; r++)
        n += is_there(&v->pose[r]) && fl_frame_data_shape(v->data, r, v->frame)->nv == 1;
    b->points = b->squares = 0;
    if (n == 0) return 0;
    if (fl_grow(&b->ball, &b->ball_cap, (int64_t)BALL_FLOATS * n, sizeof *b->ball, err)) return -1;
    int32_t back = n;
    for (int32_t r = 0; r < v->rows; r++) {
        const fl_view_pose *p = &v->pose[r];
        if (!is_there(p)) continue;
        const fl_frame_shape *s = fl_frame_data_shape(v->data, r, v->frame);
        if (s->nv != 1) continue;
        /* A point vanishes when its centre leaves the picture. */
        const float *m = eye->both.m;
        const float cx = m[0] * p->x[0] + m[4] * p->x[1] + m[8] * p->x[2] + m[12];
        const float cy = m[1] * p->x[0] + m[5] * p->x[1] + m[9] * p->x[2] + m[13];
        const float cw = m[3] * p->x[0] + m[7] * p->x[1] + m[11] * p->x[2] + m[15];
        const int inside = cx > -0.98f * cw && cx < 0.98f * cw && cy > -0.98f * cw && cy < 0.98f * cw;
        const double pixels = 2.0 * s->radius / (eye->pixel * fl_eye_distance(eye, p->x, v->reach[r]));
        const int square = pixels > POINT_PIXELS || (!inside && pixels > 4.0);
        float *to = b->ball + (size_t)BALL_FLOATS * (size_t)(square ? --back : front++);
        memcpy(to, p->x, 3 * sizeof *to);
        to[3] = (float)s->radius;
        memcpy(to + 4, p->colour, 4 * sizeof *to);
    }
    b->points = front;
    b->squares = n - front;
    glBindBuffer(GL_ARRAY_BUFFER, b->ball_buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(BALL_FLOATS * sizeof *b->ball * (size_t)n), b->ball,
                 GL_STREAM_DRAW);
    describe_balls(b->point_array, b->ball_buffer, 0, 0);
    describe_balls(b->ball_array, b->ball_buffer, BALL_FLOATS * sizeof *b->ball * (size_t)front, 1);
    return 0;
}

int fl_gl_bodies_load(fl_gl_bodies *b, const fl_view_frame *v, const fl_eye *eye, fl_err *err)
{
    b->frame = v;
    if ((b->data != v->data || b->shapes != v->data->shapes || b->parts != v->data->structure.n) &&
        begin_data(b, v->data, err))
        return -1;
    if (choose_levels(b, v, eye, err) || send_poses(b, v, err) || send_balls(b, v, eye, err)) return -1;
    send_meshes(b);
    b->tubes = v->tubes;
    if (v->tubes) {
        glBindBuffer(GL_ARRAY_BUFFER, b->tube_buffer);
        glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(sizeof *v->tube * (size_t)v->tubes), v->tube,
                     GL_STREAM_DRAW);
    }
    return 0;
}

void fl_gl_bodies_meshes(fl_gl_bodies *b, unsigned program, enum fl_gl_what what, int coarse)
{
    const fl_view_frame *v = b->frame;
    const int32_t room = (what == FL_GL_ICE ? v->rows : v->parts) + 1;
    int32_t n = 0;
    fl_err lost = {0};
    if (fl_grow(&b->count, &b->draw_cap, room, sizeof *b->count, &lost) ||
        fl_grow(&b->offset, &b->offset_cap, room, sizeof *b->offset, &lost))
        return;
    for (int32_t r = 0; r < (what == FL_GL_ICE ? v->rows : v->parts); r++) {
        int32_t shape = b->shapes + r;
        int level = 0;
        if (what == FL_GL_ICE) {
            const fl_frame_shape *s = fl_frame_data_shape(v->data, r, v->frame);
            if (s->nv < 2 || !is_there(&v->pose[r])) continue;
            shape = (int32_t)(s - v->data->shape);
            level = coarse && b->level[r] > 1 && s->nf != 2 ? 1 : b->level[r];
        }
        const struct range *g = range_of(b, shape, level);
        if (g->count <= 0) continue;
        b->count[n] = g->count;
        b->offset[n++] = (const void *)(sizeof *b->index * (size_t)g->first);
    }
    if (n == 0) return;
    fl_gl_bind(program, "pose", 0, b->pose);
    glBindVertexArray(b->vertex_array);
    glMultiDrawElements(GL_TRIANGLES, b->count, GL_UNSIGNED_INT, (const void *const *)b->offset, n);
}

void fl_gl_bodies_points(fl_gl_bodies *b)
{
    if (!b->points) return;
    glBindVertexArray(b->point_array);
    glEnable(GL_PROGRAM_POINT_SIZE);
    glDrawArrays(GL_POINTS, 0, b->points);
}

void fl_gl_bodies_squares(fl_gl_bodies *b)
{
    if (!b->squares) return;
    glBindVertexArray(b->ball_array);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, b->squares);
}

void fl_gl_bodies_tubes(fl_gl_bodies *b)
{
    if (!b->tubes) return;
    glBindVertexArray(b->tube_array);
    glDrawElementsInstanced(GL_TRIANGLES, 6 * TUBE_SIDES, GL_UNSIGNED_SHORT, NULL, b->tubes);
}
