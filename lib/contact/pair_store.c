/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "contact/pair_law.h"
#include "contact/pair_store.h"
#include "patch/mesh_under_face.h"

void fl_pair_init(const fl_world *w, fl_pair *p, int32_t i, int32_t j)
{
    const double mi = w->b.m[i], mj = w->b.m[j];
    *p = (fl_pair){.i = i, .j = j, .radius_factor = 1.0, .law = fl_pair_law_of(w, i, j)};
    p->k = fl_pair_stiffness(w, i, j, &p->exponent);
    p->mass = mj > 0.0 ? mi * mj / (mi + mj) : mi;
}

void fl_pair_free(fl_pair *p)
{
    if (p->feature_pairs) fl_mesh_under_face_free_pairs(p->feature_pairs);
    free(p->feature_pairs), free(p->surrogate), free(p->rolling);
    p->feature_pairs = NULL;
    p->surrogate = NULL;
    p->rolling = NULL;
}

/* --- near pairs and their contacts ------------------------------------------------------------- */

void fl_neighbour_pair_init(fl_neighbour_pair *q, int32_t i, int32_t j, const int32_t image[3])
{
    *q = (fl_neighbour_pair){.i = i, .j = j, .image = {image[0], image[1], image[2]}};
}

void fl_neighbour_pair_expand(const fl_world *w, const fl_neighbour_pair *q, fl_pair *p)
{
    fl_pair_init(w, p, q->i, q->j);
    for (int axis = 0; axis < 3; axis++) p->image[axis] = q->image[axis];
    p->cores_overlap = q->cores_overlap;
    p->has_axis = q->has_axis;
    p->axis = v3(q->axis[0], q->axis[1], q->axis[2]);
    p->free_travel = q->free_travel;
    p->mode = (fl_mode)q->mode;
    p->cache.n = q->cache_size;
    for (int k = 0; k < 4; k++) p->cache.a[k] = q->cache_a[k], p->cache.b[k] = q->cache_b[k];
}

/* What others read of it. */
static void tell(fl_neighbour_pair *q, const fl_pair *p)
{
    q->touching = p->touching != 0;
    q->cores_overlap = p->cores_overlap != 0;
    q->free_travel = p->free_travel;
}

/* Room of its own for p, by any thread. */
static int hold(fl_world *w, fl_neighbour_pair *q, const fl_pair *p)
{
    fl_pair_store *s = &w->pair_store;
    fl_pair_slot *slot = NULL;
    fl_err lost = {0};
#pragma omp critical(fl_pair_store)
    {
        if (!s->free && !fl_grow(&s->block, &s->cap, (int64_t)s->blocks + 1, sizeof *s->block, &lost)) {
            fl_pair_slot *block = fl_alloc(FL_PAIR_BLOCK, sizeof *block, &lost);
            for (int k = 0; block && k < FL_PAIR_BLOCK; k++) block[k].next = s->free, s->free = &block[k];
            if (block) s->block[s->blocks++] = block;
        }
        slot = s->free;
        if (slot) s->free = slot->next;
    }
    if (!slot) return -1;
    slot->pair = *p;
    q->contact = &slot->pair;
    tell(q, p);
    return 0;
}

static void let_go(fl_world *w, fl_neighbour_pair *q)
{
    fl_pair_slot *slot = (fl_pair_slot *)(void *)q->contact;
    if (!slot) return;
    q->contact = NULL;
#pragma omp critical(fl_pair_store)
    {
        slot->next = w->pair_store.free;
        w->pair_store.free = slot;
    }
}

_Static_assert(sizeof(fl_neighbour_pair) <= 64, "a near pair is a line of the cache");

/* x to single precision, towards 0: an axis of such gets no longer, and stays what it is the next time.  By
 * its bits: a compiler may take a number to float and back for nothing. */
static double shorter(double x)
{
    uint64_t bits;
    if (!(fabs(x) >= 0x1p-126)) return 0.0;
    memcpy(&bits, &x, sizeof bits);
    bits &= ~UINT64_C(0x1fffffff);
    memcpy(&x, &bits, sizeof bits);
    return x;
}

/* Keep of p what lasts while it does not touch. */
static void leave(fl_world *w, fl_neighbour_pair *q, fl_pair *p)
{
    fl_pair_free(p); /* what kept it from rolling */
    tell(q, p);
    q->has_axis = p->has_axis != 0;
    q->axis[0] = (float)p->axis.x, q->axis[1] = (float)p->axis.y, q->axis[2] = (float)p->axis.z;
    q->mode = (uint8_t)p->mode;
    q->cache_size = (uint8_t)(p->cache.n & 7);
    for (int k = 0; k < 4; k++)
        q->cache_a[k] = (uint8_t)p->cache.a[k], q->cache_b[k] = (uint8_t)p->cache.b[k];
    let_go(w, q);
}

void fl_neighbour_pair_free(fl_world *w, fl_neighbour_pair *q)
{
    if (q->contact) fl_pair_free(q->contact);
    let_go(w, q);
}

/* It has to be told more of than fl_neighbour_pair can: it touches, has a list, has been frozen, or a core has so many
 * vertices that the cache of the query of distances does not fit. */
static int wants_own(const fl_world *w, const fl_pair *p)
{
    return p->touching || p->feature_pairs || p->surrogate || p->bond || w->b.core[p->i].nv > UINT8_MAX ||
           w->b.core[p->j].nv > UINT8_MAX;
}

int fl_neighbour_pair_store(fl_world *w, fl_neighbour_pair *q, fl_pair *p)
{
    if (!p->touching) /* whether it has room of its own or not: a state that is read tells only one of the two */
        p->axis = v3(shorter(p->axis.x), shorter(p->axis.y), shorter(p->axis.z));
    if (!wants_own(w, p)) {
        leave(w, q, p);
    } else if (p == q->contact) {
        tell(q, p);
    } else if (hold(w, q, p)) {
        fl_pair_free(p);
        return -1;
    }
    return 0;
}

void fl_neighbour_pairs_free(fl_world *w)
{
    for (int32_t c = 0; c < w->n_pair; c++) fl_neighbour_pair_free(w, &w->pair[c]);
    for (int32_t k = 0; k < w->pair_store.blocks; k++) free(w->pair_store.block[k]);
    free(w->pair_store.block), free(w->pair);
    w->pair_store = (fl_pair_store){0};
    w->pair = NULL;
    w->n_pair = 0;
}
