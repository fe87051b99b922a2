/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/mem.h"
#include "body/integrate.h"
#include "law/damping.h"
#include "law/material.h"
#include "step/interact.h"
#include "step/pairing.h"
#include "step/stance.h"

/* The one place of `core` is this much softer than a face: what a corner of one would be. */
#define FACE_OF_CORE 6.0

static fl_elastic elastic_of(const fl_scene *s, int32_t material)
{
    if (material == FL_SCENE_BOUNDARY) return (fl_elastic){INFINITY, 0.0};
    if (material == FL_SCENE_STRUCTURE) material = fl_scene_find_material(s, s->structure.material);
    return (fl_elastic){s->material[material].young, s->material[material].poisson};
}

/* Column of the law table for the partner's material. */
static int32_t column(const fl_world *w, int32_t material)
{
    return material >= 0 ? material : material == FL_SCENE_STRUCTURE ? w->materials : w->materials + 1;
}

int fl_pairing_laws(fl_world *w, fl_err *err)
{
    const fl_scene *s = w->scene;
    int asked = 0;
    w->materials = s->n_material;
    w->law = fl_alloc((int64_t)w->materials * (w->materials + 2), sizeof *w->law, err);
    if (!w->law) return -1;
    for (int32_t a = 0; a < w->materials; a++) {
        for (int32_t c = 0; c < w->materials + 2; c++) {
            const int32_t b = c < w->materials    ? c
                              : c == w->materials ? FL_SCENE_STRUCTURE
                                                  : FL_SCENE_BOUNDARY;
            const fl_scene_contact t = fl_scene_pair(s, a, b);
            const double given = t.damping;
            const double D = given >= 0.0 ? given : fl_damping_crossley(t.restitution);
            const double zeta = given >= 0.0 ? given : fl_damping_linear(t.restitution);
            const double alpha = given >= 0.0 ? given : fl_damping_tsuji(t.restitution);
            const int manual = t.law == FL_LAW_MANUAL || t.law == FL_LAW_MANUAL_SI;
            w->law[a * (w->materials + 2) + c] = (fl_touching){
                .kind = t.law,
                .exponent = t.exponent,
                .modulus = fl_material_modulus(elastic_of(s, a), elastic_of(s, b)),
                .stiffness = t.stiffness,
                .softening = t.softening,
                .friction = t.friction,
                .tangential = t.tangential,
                .rolling = manual ? 0.0 : t.rolling,
                .chi = D,
                .rest = fl_damping_rest(D),
                .zeta = zeta,
                .alpha = alpha,
                .surrogate = t.law == FL_LAW_PATCH ? t.surrogate : 0.0,
                /* Tsuji's ratio is C/(2 sqrt(K M)) = alpha/(2 sqrt(3/2)) */
                .left = manual ? fl_damping_left(fmax(zeta, alpha / sqrt(6.0)))
                               : fl_damping_crossley_left(D, 1.0),
                .literal2 = t.literal2,
                .literal18 = t.literal18,
            };
            w->rolls |= w->law[a * (w->materials + 2) + c].rolling > 0.0;
            asked |= w->law[a * (w->materials + 2) + c].surrogate > 0.0;
        }
    }
    if (asked) w->told = fl_alloc(w->threads, sizeof *w->told, err);
    return asked && !w->told ? -1 : 0;
}

const fl_touching *fl_pairing_law(const fl_world *w, int32_t i, int32_t j)
{
    return &w->law[w->material[i] * (w->materials + 2) + column(w, w->material[j])];
}

/* c of `patch` from the kappa that was given: that of the modulus which makes kappa the stiffness of a whole
 * face, or of what is round: of a capsule's end; of `core`, which it stands in for, of its one place. */
static double given_patch(const fl_world *w, int32_t i, int32_t j, double area)
{
    const fl_bodies *b = &w->b;
    const fl_touching *law = fl_pairing_law(w, i, j);
    const double kappa = law->stiffness;
    const int core = law->kind == FL_LAW_CORE, faces = b->core[i].nv > 2 && (j >= w->n || b->core[j].nv > 2);
    if (faces && !(core && law->exponent != 1.0))
        return 0.5 * (core ? FACE_OF_CORE : 1.0) * kappa / sqrt(area);
    const double modulus = kappa / fl_material_hertz(1.0, fl_material_radius(b->radius[i], b->radius[j]));
    return 0.5 * fl_material_punch(modulus, 1.0);
}

double fl_pairing_stiffness(const fl_world *w, int32_t i, int32_t j, double *exponent)
{
    const fl_bodies *b = &w->b;
    const fl_touching *law = fl_pairing_law(w, i, j);
    const fl_piece *piece = fl_world_piece(w, j);
    const int core = law->kind == FL_LAW_CORE && !(piece && piece->kind == FL_PIECE_SHELL);
    const int32_t line = core ? 2 : 1; /* to `core` a line is round, too */
    const int round = b->core[i].nv <= line || (j < w->n && b->core[j].nv <= line);
    const double area = w->face[j] > 0.0 && w->face[j] < w->face[i] ? w->face[j] : w->face[i];
    *exponent = round ? 1.5 : core ? law->exponent : 0.0;
    if (law->stiffness > 0.0) return *exponent > 0.0 ? law->stiffness : given_patch(w, i, j, area);
    if (*exponent == 0.0) return 0.5 * law->softening * fl_material_punch(law->modulus, 1.0);
    if (*exponent == 1.0) return law->softening * fl_material_punch(law->modulus, area) / FACE_OF_CORE;
    return law->softening * fl_material_hertz(law->modulus, fl_material_radius(b->radius[i], b->radius[j]));
}

void fl_pair_start(const fl_world *w, fl_pair *p, int32_t i, int32_t j)
{
    const double mi = w->b.m[i], mj = w->b.m[j];
    *p = (fl_pair){.i = i, .j = j, .keep = 1.0, .law = fl_pairing_law(w, i, j)};
    p->k = fl_pairing_stiffness(w, i, j, &p->exponent);
    p->mass = mj > 0.0 ? mi * mj / (mi + mj) : mi;
}

double fl_pair_mass(const fl_world *w, const fl_pair *p, const fl_pair_yielding *e, fl_vec3 f, fl_vec3 ti,
                    fl_vec3 tj)
{
    if (fl_pair_is_plain(w, p)) return p->mass;
    const double yields =
                     fl_ease_along(&e->i, f, v3_scale(0.5, ti)) + fl_ease_along(&e->j, f, v3_scale(0.5, tj)),
                 mass = v3_norm2(f) / yields;
    return isfinite(mass) ? mass : p->mass; /* nothing moves */
}

double fl_pair_yields(const fl_pair_yielding *e, fl_vec3 f, fl_vec3 ti, fl_vec3 tj, double presses)
{
    const double f2 = fmax(v3_norm2(f), 0.25 * presses * presses);
    return f2 > 0.0 ? (fl_ease_along(&e->i, f, ti) + fl_ease_along(&e->j, f, tj)) / f2 : 0.0;
}

/* Of the point of a body that lies by `arm` from its centre. */
static fl_sym3 ease_at(const fl_yielding *e, fl_vec3 arm)
{
    const fl_vec3 x = {0, arm.z, -arm.y}, y = {-arm.z, 0, arm.x}, z = {arm.y, -arm.x, 0}; /* arm x axes */
    return s3_add(e->straight,
                  s3_products(x, y, z, s3_mul(e->turn, x), s3_mul(e->turn, y), s3_mul(e->turn, z)));
}

fl_sym3 fl_pair_ease(const fl_pair_yielding *e, fl_vec3 ai, fl_vec3 aj)
{
    return s3_add(ease_at(&e->i, ai), ease_at(&e->j, aj));
}

double fl_pair_turns(const fl_pair_yielding *e, fl_vec3 n)
{
    return v3_dot(n, s3_mul(s3_add(e->i.turn, e->j.turn), n));
}

void fl_pair_end(fl_pair *p)
{
    if (p->matches) fl_matches_free(p->matches);
    free(p->matches), free(p->surrogate), free(p->roll);
    p->matches = NULL;
    p->surrogate = NULL;
    p->roll = NULL;
}

/* --- near pairs and their contacts ------------------------------------------------------------- */

void fl_near_start(fl_near *q, int32_t i, int32_t j, const int32_t image[3])
{
    *q = (fl_near){.i = i, .j = j, .image = {image[0], image[1], image[2]}};
}

void fl_near_pair(const fl_world *w, const fl_near *q, fl_pair *p)
{
    fl_pair_start(w, p, q->i, q->j);
    for (int axis = 0; axis < 3; axis++) p->image[axis] = q->image[axis];
    p->deep = q->deep;
    p->has_axis = q->has_axis;
    p->axis = v3(q->axis[0], q->axis[1], q->axis[2]);
    p->asleep = q->asleep;
    p->mode = (fl_mode)q->mode;
    p->cache.n = q->cached;
    for (int k = 0; k < 4; k++) p->cache.a[k] = q->a[k], p->cache.b[k] = q->b[k];
}

/* What others read of it. */
static void tell(fl_near *q, const fl_pair *p)
{
    q->n = p->n != 0;
    q->deep = p->deep != 0;
    q->asleep = p->asleep;
}

/* Room of its own for p, by any thread. */
static int hold(fl_world *w, fl_near *q, const fl_pair *p)
{
    fl_pair_store *s = &w->contacts;
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
    q->full = &slot->pair;
    tell(q, p);
    return 0;
}

static void let_go(fl_world *w, fl_near *q)
{
    fl_pair_slot *slot = (fl_pair_slot *)(void *)q->full;
    if (!slot) return;
    q->full = NULL;
#pragma omp critical(fl_pair_store)
    {
        slot->next = w->contacts.free;
        w->contacts.free = slot;
    }
}

_Static_assert(sizeof(fl_near) <= 64, "a near pair is a line of the cache");

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
static void leave(fl_world *w, fl_near *q, fl_pair *p)
{
    fl_pair_end(p); /* what kept it from rolling */
    tell(q, p);
    q->has_axis = p->has_axis != 0;
    q->axis[0] = (float)p->axis.x, q->axis[1] = (float)p->axis.y, q->axis[2] = (float)p->axis.z;
    q->mode = (uint8_t)p->mode;
    q->cached = (uint8_t)(p->cache.n & 7);
    for (int k = 0; k < 4; k++) q->a[k] = (uint8_t)p->cache.a[k], q->b[k] = (uint8_t)p->cache.b[k];
    let_go(w, q);
}

void fl_near_end(fl_world *w, fl_near *q)
{
    if (q->full) fl_pair_end(q->full);
    let_go(w, q);
}

/* It has to be told more of than fl_near can: it touches, has a list, has been frozen, or a core has so many
 * vertices that the cache of the query of distances does not fit. */
static int wants_own(const fl_world *w, const fl_pair *p)
{
    return p->n || p->matches || p->surrogate || p->bond || w->b.core[p->i].nv > UINT8_MAX ||
           w->b.core[p->j].nv > UINT8_MAX;
}

int fl_near_keep(fl_world *w, fl_near *q, fl_pair *p)
{
    if (!p->n) /* whether it has room of its own or not: a state that is read tells only one of the two */
        p->axis = v3(shorter(p->axis.x), shorter(p->axis.y), shorter(p->axis.z));
    if (!wants_own(w, p)) {
        leave(w, q, p);
    } else if (p == q->full) {
        tell(q, p);
    } else if (hold(w, q, p)) {
        fl_pair_end(p);
        return -1;
    }
    return 0;
}

void fl_near_awake(fl_world *w, int32_t c, int32_t thread, const fl_told *t, double dt, int survey)
{
    fl_near *q = &w->pair[c];
    fl_pair made, *p = q->full;
    if (fl_stance_apart(w, q)) {
        if (p) fl_near_keep(w, q, p); /* what has no room of its own needs none */
        return;
    }
    if (!p) fl_near_pair(w, q, p = &made);
    p->at = c;
    fl_interact_look(w, p, thread, t, dt, survey);
    if (fl_near_keep(w, q, p)) {
#pragma omp atomic write
        w->failed = 1;
    }
}

void fl_near_free(fl_world *w)
{
    for (int32_t c = 0; c < w->n_pair; c++) fl_near_end(w, &w->pair[c]);
    for (int32_t k = 0; k < w->contacts.blocks; k++) free(w->contacts.block[k]);
    free(w->contacts.block), free(w->pair);
    w->contacts = (fl_pair_store){0};
    w->pair = NULL;
    w->n_pair = 0;
}
