/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "view/playback.h"
#include "view/view_frame.h"

enum { SAMPLE_FRAMES = 9 };
#define QUANTILE 0.995

double fl_playback_start(const fl_playback *p) { return p->file ? p->data->frame[0].t : 0.0; }
double fl_playback_end(const fl_playback *p) { return p->file ? p->data->frame[p->data->frames - 1].t : 0.0; }

/* Frame k in pair[which], from memory where it is there. */
static int load_frame(fl_playback *p, int which, int32_t k, fl_err *err)
{
    if (p->pair[which].k == k && p->pair[which].rows == p->data->rows) return 0;
    if (p->pair[1 - which].k == k && p->pair[1 - which].rows == p->data->rows) {
        const fl_frame keep = p->pair[0];
        p->pair[0] = p->pair[1];
        p->pair[1] = keep;
        return 0;
    }
    return fl_frame_file_read(p->file, k, &p->pair[which], err);
}

static int jumps(const fl_playback *p, fl_vec3 d)
{
    const fl_vec3 side = v3_sub(p->box.hi, p->box.lo);
    return fabs(d.x) > 0.5 * side.x + 1e-9 || fabs(d.y) > 0.5 * side.y + 1e-9;
}

static fl_quat interpolate_rotation(fl_quat a, fl_quat b, double s)
{
    const double sign = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0.0 ? -1.0 : 1.0, r = 1.0 - s;
    return q_unit((fl_quat){r * a.w + s * sign * b.w, r * a.x + s * sign * b.x, r * a.y + s * sign * b.y,
                            r * a.z + s * sign * b.z});
}

/* Angular velocity that turns a into b in dt, by the rotation vector of b a*. */
static fl_vec3 spin_between(fl_quat a, fl_quat b, double dt)
{
    fl_quat d = q_mul(b, q_conj(a));
    if (d.w < 0.0) d = (fl_quat){-d.w, -d.x, -d.y, -d.z};
    const fl_vec3 v = v3(d.x, d.y, d.z);
    const double s = v3_norm(v);
    return s > 0.0 ? v3_scale(2.0 * atan2(s, d.w) / (s * dt), v) : v3(0, 0, 0);
}

static void mix_bodies(fl_playback *p, double s, double dt)
{
    const fl_frame *a = &p->pair[0], *b = &p->pair[1];
    fl_frame *now = &p->now;
    const fl_vec3 unknown = v3(NAN, NAN, NAN);
    for (int32_t r = 0; r < now->rows; r++) {
        const int there = a->there[r] || (b->there[r] && s >= 1.0),
                  both = a->there[r] && b->there[r] && dt > 0.0;
        const fl_frame *one = a->there[r] && s < 1.0 ? a : b->there[r] ? b : a;
        now->there[r] = (uint8_t)there;
        if (!there) continue;
        now->x[r] = one->x[r];
        now->q[r] = one->q[r];
        now->v[r] = now->w[r] = unknown;
        if (a->has_velocity) {
            now->v[r] = both ? v3_lerp(a->v[r], b->v[r], s) : one->v[r];
            now->w[r] = both ? v3_lerp(a->w[r], b->w[r], s) : one->w[r];
        }
        if (!both) continue;
        const fl_vec3 d = v3_sub(b->x[r], a->x[r]);
        if (jumps(p, d)) {
            now->x[r] = s < 0.5 ? a->x[r] : b->x[r];
            now->q[r] = s < 0.5 ? a->q[r] : b->q[r];
            continue;
        }
        now->x[r] = v3_madd(a->x[r], s, d);
        now->q[r] = interpolate_rotation(a->q[r], b->q[r], s);
        if (!a->has_velocity) {
            now->v[r] = v3_scale(1.0 / dt, d);
            now->w[r] = spin_between(a->q[r], b->q[r], dt);
        }
    }
    for (int32_t k = 0; k < now->parts; k++) {
        now->part_x[k] = v3_lerp(a->part_x[k], b->part_x[k], s);
        now->part_q[k] = interpolate_rotation(a->part_q[k], b->part_q[k], s);
    }
}

int fl_playback_at(fl_playback *p, double t, fl_err *err)
{
    if (!p->file) return 0;
    const fl_frame_data *d = p->data;
    int32_t k = fl_frame_data_at(d, t);
    if (k > 0 && k == d->frames - 1) k--; /* the last frame is the second of its pair */
    const int32_t next = k + 1 < d->frames ? k + 1 : k;
    if (p->pair[1].k == k && next != k) { /* forward by one: what was the second is the first */
        const fl_frame keep = p->pair[0];
        p->pair[0] = p->pair[1];
        p->pair[1] = keep;
    }
    if (load_frame(p, 0, k, err) ||
        (next != k ? load_frame(p, 1, next, err) : fl_frame_file_read(p->file, k, &p->pair[1], err)))
        return -1;
    if (fl_frame_clear(&p->now, d, err)) return -1;
    const double dt = d->frame[next].t - d->frame[k].t,
                 s = dt > 0.0 ? fmin(1.0, fmax(0.0, (t - d->frame[k].t) / dt)) : 0.0;
    p->now.t = dt > 0.0 ? d->frame[k].t + s * dt : d->frame[k].t;
    p->now.k = s >= 1.0 ? next : k;
    p->now.has_velocity = p->pair[0].has_velocity;
    mix_bodies(p, s, dt);
    return 0;
}

int fl_playback_open(fl_playback *p, fl_frame_file *file, const fl_frame_data *data, fl_frame *still,
                     fl_err *err)
{
    *p = (fl_playback){.file = file, .data = file ? fl_frame_file_data(file) : data, .box = aabb_empty()};
    p->pair[0].k = p->pair[1].k = -1;
    if (!file) {
        p->now = *still;
        *still = (fl_frame){0};
        p->box = fl_view_frame_box(data, &p->now);
        return 0;
    }
    const int32_t n = p->data->frames;
    for (int32_t k = 0, last = -1; k < SAMPLE_FRAMES; k++) {
        const int32_t at = (int32_t)((int64_t)k * (n - 1) / (SAMPLE_FRAMES - 1));
        if (at == last) continue;
        last = at;
        if (fl_frame_file_read(file, at, &p->now, err)) return -1;
        p->box = aabb_join(p->box, fl_view_frame_box(p->data, &p->now));
    }
    return 0;
}

/* --- values ------------------------------------------------------------------------------------ */

double fl_shape_thickness(const fl_frame_data *d, const fl_frame_shape *s)
{
    double lo = INFINITY, hi = -INFINITY;
    for (int32_t k = 0; k < s->nv; k++) {
        lo = fmin(lo, d->vertex[s->v + k].z);
        hi = fmax(hi, d->vertex[s->v + k].z);
    }
    return hi - lo + 2.0 * s->radius;
}

/* Area from above of the core, half of the sum of |n_z| A; with its outline, of a length that two sides of
 * its box estimate, moved out by the radius. */
double fl_shape_diameter(const fl_frame_data *d, const fl_frame_shape *s)
{
    double area = 0.0;
    fl_aabb box = aabb_empty();
    const fl_vec3 *v = d->vertex + s->v;
    for (int32_t k = 0; k < s->nv; k++) box = aabb_add(box, v[k]);
    for (int32_t f = 0; f < s->nf; f++) {
        const int32_t *loop = d->loop + d->face[s->f + f], n = d->face[s->f + f + 1] - d->face[s->f + f];
        double twice = 0.0;
        for (int32_t k = 0; k < n; k++) {
            const fl_vec3 a = v[loop[k]], b = v[loop[(k + 1) % n]];
            twice += a.x * b.y - b.x * a.y;
        }
        area += 0.25 * fabs(twice);
    }
    const double around = s->nv > 1 ? PI * sqrt(fmax(area, 0.0) / PI) * 2.0 : 0.0;
    const double length = s->nf ? 0.0 : 2.0 * v3_norm(v3(box.hi.x - box.lo.x, box.hi.y - box.lo.y, 0.0));
    area += s->radius * (around + length) + PI * s->radius * s->radius;
    return 2.0 * sqrt(area / PI);
}

int fl_playback_values(fl_playback *p, int by, fl_err *err)
{
    const fl_frame *now = &p->now;
    if (fl_grow(&p->value, &p->value_cap, now->rows, sizeof *p->value, err)) return -1;
    for (int32_t r = 0; r < now->rows; r++) {
        double x = NAN;
        if (now->there[r]) {
            const fl_frame_shape *s = fl_frame_data_shape(p->data, r, now->k);
            if (by == FL_BY_SPEED) x = v3_norm(now->v[r]);
            else if (by == FL_BY_SPIN) x = v3_norm(now->w[r]);
            else if (by == FL_BY_DIAMETER) x = fl_shape_diameter(p->data, s);
            else if (by == FL_BY_THICKNESS) x = fl_shape_thickness(p->data, s);
            else if (by == FL_BY_HEIGHT) x = now->x[r].z;
            else if (by == FL_BY_NUMBER) x = s->id;
        }
        p->value[r] = x;
    }
    return 0;
}

double fl_round_up(double x)
{
    if (!(x > 0.0) || !isfinite(x)) return x;
    const double unit = pow(10.0, floor(log10(x)));
    static const double step[] = {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0};
    for (size_t k = 0; k < sizeof step / sizeof step[0]; k++)
        if (x <= step[k] * unit * (1.0 + 1e-9)) return step[k] * unit;
    return 10.0 * unit;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int fl_playback_range(fl_playback *p, int by, double *from, double *to, fl_err *err)
{
    const int32_t n = p->file ? p->data->frames : 1,
                  samples = by == FL_BY_SPEED || by == FL_BY_SPIN || by == FL_BY_HEIGHT ? SAMPLE_FRAMES : 1;
    const int signed_values = by == FL_BY_HEIGHT || by == FL_BY_NUMBER;
    double lo = INFINITY, hi = -INFINITY, *sorted = fl_alloc(p->data->rows, sizeof *sorted, err);
    if (!sorted) return -1;
    for (int32_t k = 0, last = -1; k < samples; k++) {
        const int32_t at = samples > 1 ? (int32_t)((int64_t)k * (n - 1) / (samples - 1)) : 0;
        int32_t m = 0;
        if (at == last) continue;
        last = at;
        if (p->file && fl_playback_at(p, p->data->frame[at].t, err)) goto fail;
        if (fl_playback_values(p, by, err)) goto fail;
        for (int32_t r = 0; r < p->now.rows; r++)
            if (!isnan(p->value[r])) sorted[m++] = p->value[r];
        if (!m) continue;
        qsort(sorted, (size_t)m, sizeof *sorted, compare_doubles);
        lo = fmin(lo, sorted[0]);
        hi = fmax(hi, by == FL_BY_NUMBER ? sorted[m - 1] : sorted[(int32_t)(QUANTILE * (m - 1))]);
    }
    free(sorted);
    *from = signed_values && isfinite(lo) ? lo : 0.0;
    *to = isfinite(hi) && hi > *from ? (signed_values ? hi : fl_round_up(hi)) : *from + 1.0;
    if (by == FL_BY_HEIGHT) { /* ends that four even ticks divide */
        double step = fl_round_up(0.25 * (*to - *from)), least = floor(*from / step) * step;
        if (least + 4.0 * step < *to) {
            step = fl_round_up(1.01 * step);
            least = floor(*from / step) * step;
        }
        *from = least;
        *to = least + 4.0 * step;
    }
    return 0;
fail:
    free(sorted);
    return -1;
}

const char *fl_playback_legend(const fl_playback *p, int by)
{
    switch (by) {
    case FL_BY_SPEED: return p->now.has_velocity ? "speed [m/s]" : "speed [m/s], from differences";
    case FL_BY_SPIN: return p->now.has_velocity ? "spin [rad/s]" : "spin [rad/s], from differences";
    case FL_BY_DIAMETER: return "diameter [m]";
    case FL_BY_THICKNESS: return "thickness [m]";
    case FL_BY_HEIGHT: return "height of the centre [m]";
    case FL_BY_NUMBER: return "number of the body";
    default: return "";
    }
}

void fl_playback_close(fl_playback *p)
{
    for (int k = 0; k < 2; k++) fl_frame_free(&p->pair[k]);
    fl_frame_free(&p->now);
    free(p->value);
    *p = (fl_playback){0};
}
