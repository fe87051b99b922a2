/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "view/view_frame.h"

static float grain_of(int32_t id)
{
    uint32_t h = (uint32_t)id * 0x9E3779B1u;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 12;
    return (float)(h >> 24) / 255.0f;
}

static double part_reach(const fl_part *p)
{
    const fl_aabb b = fl_part_aabb(p);
    const fl_vec3 far = v3(fmax(fabs(b.lo.x), fabs(b.hi.x)), fmax(fabs(b.lo.y), fabs(b.hi.y)),
                           fmax(fabs(b.lo.z), fabs(b.hi.z)));
    return v3_norm(far);
}

int fl_view_frame_make(fl_view_frame *v, const fl_frame_data *d, fl_aabb box, fl_err *err)
{
    const int64_t n = (int64_t)d->rows + d->structure.n;
    fl_view_pose *pose = fl_alloc(n, sizeof *pose, err);
    float *reach = pose ? fl_alloc(n, sizeof *reach, err) : NULL;
    if (!reach) {
        free(pose);
        return -1;
    }
    free(v->pose);
    free(v->reach);
    v->pose = pose;
    v->reach = reach;
    v->data = d;
    v->rows = d->rows;
    v->parts = d->structure.n;
    if (!(box.lo.x <= box.hi.x)) box = (fl_aabb){v3(-1, -1, -1), v3(1, 1, 1)};
    v->origin = v3_scale(0.5, v3_add(box.lo, box.hi));
    v->centre = v3(0, 0, 0);
    v->radius = fmax(1e-9, 0.5 * v3_norm(v3_sub(box.hi, box.lo)));
    for (int32_t r = 0; r < v->rows; r++) {
        pose[r].speck = grain_of(d->shape[d->row_shape[r]].id);
        reach[r] = (float)fl_frame_data_reach(d, &d->shape[d->row_shape[r]]);
    }
    for (int32_t p = 0; p < v->parts; p++) reach[v->rows + p] = (float)part_reach(&d->structure.part[p]);
    return 0;
}

fl_aabb fl_view_frame_box(const fl_frame_data *d, const fl_frame *f)
{
    fl_aabb box = aabb_empty();
    for (int32_t r = 0; r < f->rows; r++) {
        if (!f->there[r]) continue;
        const double reach = fl_frame_data_reach(d, fl_frame_data_shape(d, r, f->k));
        const fl_vec3 far = v3(reach, reach, reach);
        /* A floe is flat: its sphere would raise the box, so the core is followed where it is small. */
        const fl_frame_shape *s = fl_frame_data_shape(d, r, f->k);
        if (s->nv <= 64) {
            const fl_mat3 R = q_matrix(f->q[r]);
            for (int32_t k = 0; k < s->nv; k++) {
                const fl_vec3 x = v3_add(f->x[r], m3_mul(R, d->vertex[s->v + k])),
                              g = v3(s->radius, s->radius, s->radius);
                box = aabb_add(aabb_add(box, v3_sub(x, g)), v3_add(x, g));
            }
        } else box = aabb_add(aabb_add(box, v3_sub(f->x[r], far)), v3_add(f->x[r], far));
    }
    for (int32_t p = 0; p < f->parts; p++) {
        const fl_aabb b = fl_part_aabb(&d->structure.part[p]);
        const fl_mat3 R = q_matrix(f->part_q[p]);
        if (!(b.lo.x <= b.hi.x)) continue;
        for (int k = 0; k < 8; k++) {
            const fl_vec3 c = v3(k & 1 ? b.hi.x : b.lo.x, k & 2 ? b.hi.y : b.lo.y, k & 4 ? b.hi.z : b.lo.z);
            box = aabb_add(box, v3_add(f->part_x[p], m3_mul(R, c)));
        }
    }
    return box;
}

int fl_view_frame_add_tube(fl_view_frame *v, fl_vec3 a, fl_vec3 b, double r, fl_rgb c, fl_err *err)
{
    if (fl_grow(&v->tube, &v->tube_cap, (int64_t)v->tubes + 1, sizeof *v->tube, err)) return -1;
    fl_tube *t = &v->tube[v->tubes++];
    const fl_vec3 p = v3_sub(a, v->origin), q = v3_sub(b, v->origin);
    *t = (fl_tube){
        {(float)p.x, (float)p.y, (float)p.z}, {(float)q.x, (float)q.y, (float)q.z}, (float)r, {0, 0, 0}};
    for (int k = 0; k < 3; k++) t->colour[k] = (float)c.c[k] / 255.0f;
    return 0;
}

/* Where a ray enters the core of a shape moved out by its radius, in the axes of the body; -1: not at all. */
static double enters(const fl_frame_data *d, const fl_frame_shape *s, fl_vec3 from, fl_vec3 along)
{
    double t0 = 0.0, t1 = INFINITY;
    for (int32_t f = 0; f < s->nf; f++) {
        const int32_t *loop = d->loop + d->face[s->f + f], n = d->face[s->f + f + 1] - d->face[s->f + f];
        const fl_vec3 *v = d->vertex + s->v;
        fl_vec3 area = v3(0, 0, 0);
        for (int32_t k = 2; k < n; k++)
            area = v3_add(area, v3_cross(v3_sub(v[loop[k - 1]], v[loop[0]]), v3_sub(v[loop[k]], v[loop[0]])));
        area = v3_unit(area);
        const double away = v3_dot(area, v3_sub(v[loop[0]], from)) + s->radius, speed = v3_dot(area, along);
        if (speed < 0.0) t0 = fmax(t0, away / speed);
        else if (speed > 0.0) t1 = fmin(t1, away / speed);
        else if (away < 0.0) return -1.0;
    }
    return t0 <= t1 ? t0 : -1.0;
}

int32_t fl_view_frame_pick(const fl_view_frame *v, fl_vec3 from, fl_vec3 along)
{
    int32_t found = -1;
    double best = INFINITY;
    from = v3_sub(from, v->origin);
    for (int32_t r = 0; r < v->rows; r++) {
        const fl_view_pose *p = &v->pose[r];
        const fl_quat q = {p->q[3], p->q[0], p->q[1], p->q[2]};
        const fl_vec3 way = v3_sub(v3(p->x[0], p->x[1], p->x[2]), from);
        const double ahead = v3_dot(way, along), off2 = v3_norm2(way) - ahead * ahead,
                     r2 = (double)v->reach[r] * v->reach[r];
        if (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z < 0.5 || off2 > r2 || ahead < -v->reach[r])
            continue;
        const fl_frame_shape *s = fl_frame_data_shape(v->data, r, v->frame);
        const double t =
            s->nf ? enters(v->data, s, q_rotate(q_conj(q), v3_neg(way)), q_rotate(q_conj(q), along))
                  : ahead - sqrt(fmax(0.0, r2 - off2));
        if (t >= 0.0 && t < best) {
            best = t;
            found = r;
        }
    }
    return found;
}

void fl_view_frame_free(fl_view_frame *v)
{
    free(v->pose);
    free(v->reach);
    free(v->tube);
    *v = (fl_view_frame){0};
}
