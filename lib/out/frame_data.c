/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "out/frame_data.h"

enum { SLOTS_LEAST = 64 };

static uint32_t hash_of(int32_t id)
{
    uint32_t h = (uint32_t)id * 0x9E3779B1u;
    return h ^ h >> 15;
}

static int32_t id_of(const fl_frame_data *d, int32_t row) { return d->shape[d->row_shape[row]].id; }

int32_t fl_frame_data_row(const fl_frame_data *d, int32_t id)
{
    if (!d->slots) return -1;
    const uint32_t mask = (uint32_t)d->slots - 1;
    for (uint32_t s = hash_of(id) & mask; d->slot[s] >= 0; s = (s + 1) & mask)
        if (id_of(d, d->slot[s]) == id) return d->slot[s];
    return -1;
}

static void insert_row(fl_frame_data *d, int32_t row)
{
    const uint32_t mask = (uint32_t)d->slots - 1;
    uint32_t s = hash_of(id_of(d, row)) & mask;
    while (d->slot[s] >= 0) s = (s + 1) & mask;
    d->slot[s] = row;
}

/* Keeps at least half of the slots free. */
static int room_for_row(fl_frame_data *d, fl_err *err)
{
    if (fl_grow(&d->row_shape, &d->row_cap, (int64_t)d->rows + 1, sizeof *d->row_shape, err)) return -1;
    if (2 * ((int64_t)d->rows + 1) <= d->slots) return 0;
    const int32_t slots = d->slots ? 2 * d->slots : SLOTS_LEAST;
    int32_t *slot = fl_alloc(slots, sizeof *slot, err);
    if (!slot) return -1;
    free(d->slot);
    d->slot = slot;
    d->slots = slots;
    memset(slot, 0xff, (size_t)slots * sizeof *slot);
    for (int32_t r = 0; r < d->rows; r++) insert_row(d, r);
    return 0;
}

const fl_frame_shape *fl_frame_data_shape(const fl_frame_data *d, int32_t row, int32_t k)
{
    const fl_frame_shape *s = &d->shape[d->row_shape[row]];
    while (s->next >= 0 && d->shape[s->next].from <= k) s = &d->shape[s->next];
    return s;
}

int fl_frame_data_add_shape(fl_frame_data *d, int32_t id, double radius, int32_t line, fl_err *err)
{
    if (fl_grow(&d->shape, &d->shape_cap, (int64_t)d->shapes + 1, sizeof *d->shape, err) ||
        fl_grow(&d->face, &d->face_cap, (int64_t)d->faces + 1, sizeof *d->face, err) || room_for_row(d, err))
        return -1;
    const int32_t row = fl_frame_data_row(d, id);
    d->face[d->faces] = d->loops;
    d->shape[d->shapes] = (fl_frame_shape){.id = id,
                                           .from = d->frames,
                                           .next = -1,
                                           .v = d->vertices,
                                           .f = d->faces,
                                           .line = line,
                                           .radius = radius};
    if (row < 0) {
        d->row_shape[d->rows] = d->shapes;
        insert_row(d, d->rows);
        d->rows++;
    } else {
        fl_frame_shape *s = &d->shape[d->row_shape[row]];
        while (s->next >= 0) s = &d->shape[s->next];
        s->next = d->shapes;
    }
    d->shapes++;
    return 0;
}

int fl_frame_data_add_vertex(fl_frame_data *d, fl_vec3 x, fl_err *err)
{
    if (fl_grow(&d->vertex, &d->vertex_cap, (int64_t)d->vertices + 1, sizeof *d->vertex, err)) return -1;
    d->vertex[d->vertices++] = x;
    d->shape[d->shapes - 1].nv++;
    return 0;
}

int fl_frame_data_add_face(fl_frame_data *d, const int32_t *v, int32_t n, fl_err *err)
{
    if (fl_grow(&d->face, &d->face_cap, (int64_t)d->faces + 2, sizeof *d->face, err) ||
        fl_grow(&d->loop, &d->loop_cap, (int64_t)d->loops + n, sizeof *d->loop, err))
        return -1;
    for (int32_t k = 0; k < n; k++) d->loop[d->loops++] = v[k];
    d->face[++d->faces] = d->loops;
    d->shape[d->shapes - 1].nf++;
    return 0;
}

int fl_frame_data_add_frame(fl_frame_data *d, fl_frame_entry e, fl_err *err)
{
    if (fl_grow(&d->frame, &d->frame_cap, (int64_t)d->frames + 1, sizeof *d->frame, err)) return -1;
    e.ice = e.bodies >= 0 ? d->frames : d->frames ? d->frame[d->frames - 1].ice : -1;
    d->frame[d->frames++] = e;
    return 0;
}

int32_t fl_frame_data_at(const fl_frame_data *d, double t)
{
    int32_t lo = 0, hi = d->frames;
    if (!d->frames) return -1;
    while (lo + 1 < hi) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (d->frame[mid].t <= t) lo = mid;
        else hi = mid;
    }
    return lo;
}

double fl_frame_data_reach(const fl_frame_data *d, const fl_frame_shape *s)
{
    double r2 = 0.0;
    for (int32_t k = 0; k < s->nv; k++) {
        const double x2 = v3_norm2(d->vertex[s->v + k]);
        if (x2 > r2) r2 = x2;
    }
    return sqrt(r2) + s->radius;
}

int fl_frame_clear(fl_frame *f, const fl_frame_data *d, fl_err *err)
{
    const int32_t parts = d->structure.n;
    int32_t cap[7];
    for (int k = 0; k < 7; k++) cap[k] = k < 5 ? f->cap : f->part_cap;
    if (fl_grow(&f->x, &cap[0], d->rows, sizeof *f->x, err) ||
        fl_grow(&f->q, &cap[1], d->rows, sizeof *f->q, err) ||
        fl_grow(&f->there, &cap[2], d->rows, sizeof *f->there, err) ||
        fl_grow(&f->v, &cap[3], d->rows, sizeof *f->v, err) ||
        fl_grow(&f->w, &cap[4], d->rows, sizeof *f->w, err) ||
        fl_grow(&f->part_x, &cap[5], parts, sizeof *f->part_x, err) ||
        fl_grow(&f->part_q, &cap[6], parts, sizeof *f->part_q, err)) {
        f->cap = f->part_cap = 0; /* the arrays differ in length; they grow again from what they are */
        return -1;
    }
    f->cap = cap[0];
    f->part_cap = cap[5];
    f->rows = d->rows;
    f->parts = parts;
    f->k = -1;
    f->has_velocity = 0;
    if (d->rows) memset(f->there, 0, (size_t)d->rows);
    for (int32_t p = 0; p < parts; p++) {
        f->part_x[p] = v3(0, 0, 0);
        f->part_q[p] = q_one();
    }
    return 0;
}

void fl_frame_free(fl_frame *f)
{
    free(f->x);
    free(f->q);
    free(f->there);
    free(f->v);
    free(f->w);
    free(f->part_x);
    free(f->part_q);
    *f = (fl_frame){0};
}

void fl_frame_data_free(fl_frame_data *d)
{
    free(d->shape);
    free(d->vertex);
    free(d->face);
    free(d->loop);
    free(d->row_shape);
    free(d->slot);
    fl_surface_free(&d->structure);
    free(d->frame);
    *d = (fl_frame_data){0};
}
