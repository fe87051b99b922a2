/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gpu/gpu_outflow.h"
#include <stdlib.h>
#include "base/array.h"
#include "body/domain_kernel.h"
#include "contact/disc_list.h"
#include "gpu/gpu_memory.h"
#include "world/access.h"

/* Element k of an array of the device, there after fl_gpu_wait(); and one into it. */
#define GET_ONE(member, k, to) fl_gpu_get_later(g, to, g->v.member + (k), sizeof *g->v.member, err)
#define PUT_ONE(member, k, from) put_one(g, g->v.member + (k), from, sizeof *g->v.member, err)

static int put_one(fl_gpu_world *g, const void *to, const void *from, size_t bytes, fl_err *err)
{
    return g->e->upload((void *)(uintptr_t)to, from, bytes) ? fl_gpu_fail(g, err) : 0;
}

/* Adds the bodies of a block that are outside. */
static int find_in_block(fl_gpu_world *g, const fl_world *w, int32_t block, fl_leaving *l, fl_err *err)
{
    const int32_t from = block * FL_BODY_BLOCK,
                  to = from + FL_BODY_BLOCK < w->n ? from + FL_BODY_BLOCK : w->n;
    fl_sphere_state s[FL_BODY_BLOCK];
    if (fl_gpu_get_bytes(g, s, g->v.state + from, (size_t)(to - from) * sizeof *s, err)) return -1;
    for (int32_t k = from; k < to; k++) {
        if (g->host[k] || w->inflow.guided[k] ||
            !fl_is_beyond(w->inflow.lo, w->inflow.hi, s[k - from].x, fl_body_extent(&w->b, k)))
            continue;
        if (fl_leaving_add_body(l, k, err)) return -1;
    }
    return 0;
}

/* 1 if body k is the device's, and away from the structure. */
static int is_apart(const fl_gpu_world *g, int32_t k)
{
    return !g->host[k] && !(g->near_of && g->near_of[k]);
}

static int has_wall(const fl_world *w, int32_t k)
{
    for (int32_t c = 0; c < w->spheres.walls; c++)
        if (w->spheres.wall[c].i == k) return 1;
    return 0;
}

typedef struct {
    fl_leaving_row row;
    fl_sphere_contact contact;
    uint8_t touches;
} told_row;

/* Adds the rows of body k that touch; in dropped[] all of them. */
static int find_rows(fl_gpu_world *g, int32_t k, fl_leaving *l, fl_err *err)
{
    int32_t end[2];
    if (fl_gpu_get_bytes(g, end, g->v.link_first + k, sizeof end, err)) return -1;
    const int32_t n = end[1] - end[0];
    int32_t *const link = fl_alloc(n, sizeof *link, err);
    told_row *const told = fl_alloc(n, sizeof *told, err);
    int bad =
        n && (!link || !told || fl_gpu_get_bytes(g, link, g->v.link + end[0], (size_t)n * sizeof *link, err));
    for (int32_t e = 0; e < n && !bad; e++) {
        const int32_t c = told[e].row.c = link[e] >> 1;
        bad = GET_ONE(row_i, c, &told[e].row.i) || GET_ONE(row_j, c, &told[e].row.j) ||
              GET_ONE(touches, c, &told[e].touches) || GET_ONE(contact, c, &told[e].contact) ||
              (g->v.row_image && fl_gpu_get_later(g, told[e].row.image, g->v.row_image + 3 * (int64_t)c,
                                                  sizeof told[e].row.image, err));
    }
    bad = bad || (n && fl_gpu_wait(g, err));
    for (int32_t e = 0; e < n && !bad; e++) {
        told[e].row.k = told[e].contact.k;
        if (told[e].touches) bad = fl_leaving_add_row(l, &told[e].row, err);
    }
    free(link), free(told);
    return bad ? -1 : 0;
}

/* Adds bond k, if it stands.  1; 0 if it ended in this step; -1. */
static int find_disc(fl_gpu_world *g, fl_world *w, int32_t k, fl_leaving *l, fl_err *err)
{
    uint8_t ended;
    fl_disc_memory m;
    if (GET_ONE(disc_ended, k, &ended) || GET_ONE(disc, k, &m) || fl_gpu_wait(g, err)) return -1;
    if (ended == FL_DISC_JUST_ENDED) return 0;
    w->discs.has_ended[k] = ended;
    fl_disc_list_set_memory(&w->discs, k, &m);
    return ended == FL_DISC_STANDS && fl_leaving_add_disc(l, w, k, err) ? -1 : 1;
}

static int find_discs(fl_gpu_world *g, fl_world *w, int32_t k, fl_leaving *l, fl_err *err)
{
    const fl_disc_list *s = &w->discs;
    int rc = 1;
    if (!s->n) return 1;
    for (int64_t at = s->first_i[k]; at < s->first_i[k + 1] && rc == 1; at++)
        rc = find_disc(g, w, (int32_t)at, l, err);
    for (int64_t at = s->first_j[k]; at < s->first_j[k + 1] && rc == 1; at++)
        rc = find_disc(g, w, s->of[at], l, err);
    return rc;
}

/* Brings body k down. */
static int bring(fl_gpu_world *g, fl_world *w, int32_t k, fl_err *err)
{
    fl_bodies *b = &w->b;
    fl_environment *sea = &w->sea;
    fl_sphere_state *const s = &w->spheres.state[k];
    if (GET_ONE(state, k, s) || GET_ONE(L, k, &b->L[k]) || GET_ONE(q, k, &b->q[k]) ||
        GET_ONE(f, k, &b->f[k]) || GET_ONE(t, k, &b->t[k]) || GET_ONE(odometer, k, &b->odometer[k]) ||
        GET_ONE(sum, k, &w->spheres.sum[k]) ||
        (sea->water &&
         (GET_ONE(wetted_area, k, &sea->wetted_area[k]) || GET_ONE(buoyancy, k, &sea->buoyancy[k]) ||
          GET_ONE(drag_loss, k, &sea->drag_loss[k]))) ||
        (b->heave_mass &&
         (GET_ONE(heave_mass, k, &b->heave_mass[k]) || GET_ONE(heave_work, k, &b->heave_work[k]))) ||
        fl_gpu_wait(g, err))
        return -1;
    b->x[k] = s->x, b->v[k] = s->v, b->w[k] = s->w;
    return 0;
}

int fl_gpu_world_find_leaving(fl_gpu_world *g, fl_world *w, fl_leaving *l, fl_err *err)
{
    for (int32_t k = 0; k < g->v.blocks; k++)
        if (g->leaves[k] && find_in_block(g, w, k, l, err)) return -1;
    for (int32_t k = 0; k < l->bodies; k++) {
        const int32_t i = l->body[k];
        if (!is_apart(g, i) || w->first_pair_of_body[i] < w->first_pair_of_body[i + 1] || has_wall(w, i))
            return 0;
        const int rc = find_rows(g, i, l, err) ? -1 : find_discs(g, w, i, l, err);
        if (rc != 1) return rc;
    }
    fl_leaving_sort(l);
    for (int32_t k = 0; k < l->n_touched; k++)
        if (!is_apart(g, l->touched[k])) return 0;
    for (int32_t k = 0; k < l->n_touched; k++)
        if (bring(g, w, l->touched[k], err)) return -1;
    return 1;
}

/* The place of body k is of no body from now on. */
static int drop_body(fl_gpu_world *g, int32_t k, fl_err *err)
{
    const fl_sphere_sum none = {0};
    g->host[k] = FL_GPU_EMPTY;
    return PUT_ONE(host, k, &g->host[k]) || PUT_ONE(sum, k, &none) ? -1 : 0;
}

/* No row of body k touches again: it is where no body is. */
static int set_away(fl_gpu_world *g, const fl_world *w, int32_t k, fl_err *err)
{
    fl_sphere_state s = w->spheres.state[k];
    s.x = v3(NAN, NAN, NAN);
    return PUT_ONE(state, k, &s);
}

static int drop_disc(fl_gpu_world *g, int32_t k, fl_err *err)
{
    const uint8_t ended = FL_DISC_ENDED, whole = 0;
    const fl_disc_wrench none = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    return PUT_ONE(disc_ended, k, &ended) || PUT_ONE(disc_whole, k, &whole) || PUT_ONE(disc_out, k, &none)
               ? -1
               : 0;
}

int fl_gpu_world_drop(fl_gpu_world *g, fl_world *w, const fl_leaving *l, fl_err *err)
{
    const uint8_t no = 0;
    for (int32_t k = 0; k < l->bodies; k++)
        if (drop_body(g, l->body[k], err) || set_away(g, w, l->body[k], err)) return -1;
    for (int32_t k = 0; k < l->rows; k++)
        if (PUT_ONE(touches, l->row[k].c, &no)) return -1;
    for (int32_t k = 0; k < l->discs; k++)
        if (drop_disc(g, l->disc[k], err)) return -1;
    if (FL_GPU_PUT(again, l->touched, l->n_touched) || FL_GPU_LAUNCH(SUM_AGAIN, l->n_touched)) return -1;
    for (int32_t k = 0; k < l->n_touched; k++) {
        const int32_t i = l->touched[k];
        if (g->host[i]) continue;
        if (GET_ONE(sum, i, &w->spheres.sum[i]) || GET_ONE(f, i, &w->b.f[i]) || GET_ONE(t, i, &w->b.t[i]))
            return -1;
    }
    g->rows_dead = g->rows_newer = 1;
    return fl_gpu_wait(g, err);
}
