/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/strip_dent.h"
#include "base/array.h"
#include "base/fast_math.h"

/* Largest q, that of a flat dent. */
#define FLAT 50.0

static fl_vec3 point_of_floe(const fl_relative_pose *r, fl_vec3 x) { return m3_tmul(r->M, v3_sub(x, r->o)); }

static inline fl_vec3 column_vector(fl_strip *q, int column, int32_t k)
{
    return v3(fl_strip_column(q, column)[k], fl_strip_column(q, column + 1)[k],
              fl_strip_column(q, column + 2)[k]);
}

static inline void set_column_vector(fl_strip *q, int column, int32_t k, fl_vec3 v)
{
    fl_strip_column(q, column)[k] = v.x;
    fl_strip_column(q, column + 1)[k] = v.y;
    fl_strip_column(q, column + 2)[k] = v.z;
}

void fl_strip_leave(fl_strip *q, const fl_wall *wall, const fl_relative_pose *r, int32_t k, double least)
{
    const double missing = -fl_strip_column(q, FL_STRIP_E)[k];
    fl_strip_column(q, FL_STRIP_LEFT)[k] = missing > least ? missing : 0.0;
    set_column_vector(q, FL_STRIP_LEFT_AT, k, point_of_floe(r, column_vector(q, FL_STRIP_CENTRE, k)));
    set_column_vector(q, FL_STRIP_LEFT_ALONG, k, m3_tmul(r->M, wall->sector[k].n));
}

/* Ice missing before the place x of a wall with the normal n, axes of the floe, by one dent [m]. */
static double missing_by(const fl_dent *d, fl_vec3 x, fl_vec3 n, fl_vec3 up)
{
    const double depth = v3_norm(d->offset), facing = v3_dot(n, d->offset) / depth;
    if (!(facing > 0.0)) return 0.0;
    const fl_vec3 m = v3_scale(1.0 / depth, d->offset), way = v3_sub(x, d->x);
    const fl_vec3 level = v3_madd(way, -v3_dot(way, up), up);
    const double in = v3_dot(way, m), aside = v3_norm(v3_madd(level, -v3_dot(level, m), m)) / d->half_width;
    if (!(aside < 1.0)) return 0.0;
    return fmax(0.0, depth * (1.0 - (aside > 0.0 ? fl_pow(aside, d->stiffening) : 0.0)) - in) * facing;
}

double fl_strip_missing_ice(const fl_world *w, const fl_pair *p, const fl_relative_pose *r, int32_t k)
{
    fl_strip *const q = p->strip;
    const fl_wall_sector *s = &w->strips.wall[p->j - w->n].sector[k];
    const fl_vec3 x = point_of_floe(r, column_vector(q, FL_STRIP_CENTRE, k)), n = m3_tmul(r->M, s->n),
                  up = m3_tmul(r->M, v3(r->R.m[2][0], r->R.m[2][1], r->R.m[2][2]));
    const fl_floe_dents *d = w->crushing.dents[p->i];
    double most = 0.0;
    if (v3_norm(v3_sub(x, column_vector(q, FL_STRIP_LEFT_AT, k))) < s->width)
        most = fl_strip_column(q, FL_STRIP_LEFT)[k];
    for (int32_t i = 0; d && i < d->n; i++) most = fmax(most, missing_by(&d->dent[i], x, n, up));
    return most;
}

int fl_strip_has_left(fl_strip *q)
{
    const double *left = fl_strip_column(q, FL_STRIP_LEFT);
    int any = 0;
    for (int32_t k = 0; k < q->n; k++) any |= left[k] > 0.0;
    return any;
}

/* The dent of the elements on the side of the deepest; these are marked as kept. */
static fl_dent dent_of_strip(fl_strip *q, const fl_wall *wall, fl_vec3 up)
{
    double *const left = fl_strip_column(q, FL_STRIP_LEFT), area = 0.0, reach = 0.0;
    int32_t deepest = 0;
    for (int32_t k = 1; k < q->n; k++)
        if (left[k] > left[deepest]) deepest = k;
    const double depth = left[deepest];
    const fl_vec3 m = column_vector(q, FL_STRIP_LEFT_ALONG, deepest),
                  x = column_vector(q, FL_STRIP_LEFT_AT, deepest);
    for (int32_t k = 0; k < q->n; k++) {
        const double facing = v3_dot(column_vector(q, FL_STRIP_LEFT_ALONG, k), m);
        if (!(left[k] > 0.0) || !(facing > 0.0)) continue;
        const fl_vec3 way = v3_sub(column_vector(q, FL_STRIP_LEFT_AT, k), x),
                      level = v3_madd(way, -v3_dot(way, up), up);
        const double aside = v3_norm(v3_madd(level, -v3_dot(level, m), m));
        reach = fmax(reach, aside + 0.5 * wall->sector[k].width * facing);
        area += left[k] * wall->sector[k].width;
        left[k] = 0.0;
    }
    const double full = area / (2.0 * reach * depth);
    return (fl_dent){x, v3_scale(depth, m), reach, full < FLAT / (1.0 + FLAT) ? full / (1.0 - full) : FLAT};
}

static int keep_one(fl_world *w, int32_t i, const fl_dent *dent, fl_err *err)
{
    fl_floe_dents **const of = &w->crushing.dents[i];
    if (!*of && !(*of = fl_alloc(1, sizeof **of, err))) return -1;
    fl_floe_dents *const d = *of;
    int32_t at = d->n, shallowest = 0;
    for (int32_t k = 0; k < d->n; k++) {
        const fl_dent *old = &d->dent[k];
        if (v3_norm(v3_sub(dent->x, old->x)) <= 0.5 * old->half_width &&
            v3_dot(dent->offset, old->offset) > 0.0 && v3_norm2(dent->offset) >= v3_norm2(old->offset) &&
            dent->half_width >= old->half_width)
            at = k;
        if (v3_norm2(old->offset) < v3_norm2(d->dent[shallowest].offset)) shallowest = k;
    }
    if (at == FL_DENTS) {
        w->crushing.dents_dropped++;
        if (v3_norm2(d->dent[shallowest].offset) > v3_norm2(dent->offset)) return 0;
        at = shallowest;
    } else if (at == d->n) {
        d->n++;
    }
    d->dent[at] = *dent;
    return 0;
}

int fl_strip_keep_dent(fl_world *w, int32_t i, fl_strip *q, const fl_wall *wall, fl_err *err)
{
    const fl_vec3 up = m3_tmul(fl_body_axes(&w->b, i), v3(0, 0, 1));
    while (fl_strip_has_left(q)) {
        const fl_dent dent = dent_of_strip(q, wall, up);
        if (keep_one(w, i, &dent, err)) return -1;
    }
    return 0;
}
