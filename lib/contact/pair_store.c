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
    const fl_pair_spring s = fl_pair_stiffness(w, i, j);
    p->k = s.k;
    p->exponent = s.exponent;
    p->points = (int32_t)fl_pair_points(w, i, j, s);
    p->mass = mj > 0.0 ? mi * mj / (mi + mj) : mi;
    p->load_part = j < w->n ? -1 : w->structure.piece[j - w->n].part;
}

void fl_pair_free(fl_pair *p)
{
    if (p->feature_pairs) fl_mesh_under_face_free_pairs(p->feature_pairs);
    free(p->feature_pairs), free(p->surrogate), free(p->rolling), free(p->strip), free(p->crush);
    if (p->quick_list) fl_quick_list_free(p->quick_list);
    free(p->quick_list);
    p->quick_list = NULL;
    p->crush = NULL;
    p->feature_pairs = NULL;
    p->surrogate = NULL;
    p->rolling = NULL;
    p->strip = NULL;
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

/* Copies to q what other modules read there. */
static void copy_state(fl_neighbour_pair *q, const fl_pair *p)
{
    q->touching = p->touching != 0;
    q->cores_overlap = p->cores_overlap != 0;
    q->free_travel = p->free_travel;
}

/* Copies p into a contact record of q; any thread. */
static int take_record(fl_world *w, fl_neighbour_pair *q, const fl_pair *p)
{
    fl_pair_store *s = &w->pair_store;
    fl_pair_slot *slot = NULL;
    fl_err lost = {0};
#pragma omp critical(fl_pair_store)
    {
        if (!s->free && !fl_grow(&s->block, &s->cap, (int64_t)s->blocks + 1, sizeof *s->block, &lost)) {
            fl_pair_slot *block = fl_alloc(FL_PAIR_SLOTS, sizeof *block, &lost);
            for (int k = 0; block && k < FL_PAIR_SLOTS; k++) block[k].next = s->free, s->free = &block[k];
            if (block) s->block[s->blocks++] = block;
        }
        slot = s->free;
        if (slot) s->free = slot->next;
    }
    if (!slot) return -1;
    slot->pair = *p;
    q->contact = &slot->pair;
    copy_state(q, p);
    return 0;
}

static void release_record(fl_world *w, fl_neighbour_pair *q)
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

/* Rounds x to single precision towards 0: the axis gets no longer, and a second rounding changes nothing.  It
 * works on the bits, since a compiler may drop a conversion to float and back. */
static double round_to_float(double x)
{
    uint64_t bits;
    if (!(fabs(x) >= 0x1p-126)) return 0.0;
    memcpy(&bits, &x, sizeof bits);
    bits &= ~UINT64_C(0x1fffffff);
    memcpy(&x, &bits, sizeof bits);
    return x;
}

/* Stores in q what lasts while the pair does not touch, and releases its contact record. */
static void store_in_neighbour(fl_world *w, fl_neighbour_pair *q, fl_pair *p)
{
    fl_pair_free(p);
    copy_state(q, p);
    q->has_axis = p->has_axis != 0;
    q->axis[0] = (float)p->axis.x, q->axis[1] = (float)p->axis.y, q->axis[2] = (float)p->axis.z;
    q->mode = (uint8_t)p->mode;
    q->cache_size = (uint8_t)(p->cache.n & 7);
    for (int k = 0; k < 4; k++)
        q->cache_a[k] = (uint8_t)p->cache.a[k], q->cache_b[k] = (uint8_t)p->cache.b[k];
    release_record(w, q);
}

void fl_neighbour_pair_free(fl_world *w, fl_neighbour_pair *q)
{
    if (q->contact) fl_pair_free(q->contact);
    release_record(w, q);
}

/* True if fl_neighbour_pair cannot hold the pair: it touches, has a list of features or was bonded, or a core
 * has so many vertices that the cache of the distance query does not fit. */
static int needs_record(const fl_world *w, const fl_pair *p)
{
    return p->touching || p->feature_pairs || p->quick_list || p->surrogate || p->bond || p->crush ||
           w->b.core[p->i].nv > UINT8_MAX || w->b.core[p->j].nv > UINT8_MAX;
}

int fl_neighbour_pair_put_back(fl_world *w, fl_neighbour_pair *q, fl_pair *p)
{
    if (!p->touching) /* with or without a record: a checkpoint stores only one of the two */
        p->axis = v3(round_to_float(p->axis.x), round_to_float(p->axis.y), round_to_float(p->axis.z));
    if (!needs_record(w, p)) {
        store_in_neighbour(w, q, p);
    } else if (p == q->contact) {
        copy_state(q, p);
    } else if (take_record(w, q, p)) {
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
