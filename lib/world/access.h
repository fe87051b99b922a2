/* SPDX-License-Identifier: GPL-3.0-or-later */
/* access.h -- what is read of a world, in a line or two each. */
#ifndef FL_WORLD_ACCESS_H
#define FL_WORLD_ACCESS_H
#include <math.h>
#include "world/world.h"

/* Time now [s].  Steps are of one size, or change it at times that are known exactly. */
static inline double fl_world_time(const fl_world *w) { return w->t0 + (double)(w->step - w->step0) * w->dt; }

/* The spring of a driven floe in place i: its stiffness [N/m], 0 where there is none, and how far it is drawn
 * upwards of its rest [m]. */
static inline double fl_world_spring(const fl_world *w, int32_t i, double *drawn)
{
    if (i >= w->row.n || !w->row.in[i] || (w->traffic.away && w->traffic.floe[i] >= 0)) return 0.0;
    *drawn = w->b.x[i].z - w->row.rest[i];
    return w->row.k[i];
}

/* The piece or wall that thing j is, NULL where it is a floe. */
static inline const fl_piece *fl_world_piece(const fl_world *w, int32_t j)
{
    return j < w->n ? NULL : &w->structure.piece[j - w->n];
}

/* From thing i to j, or to the image of it that is meant [m]. */
static inline fl_vec3 fl_world_way(const fl_world *w, int32_t i, int32_t j, const int32_t image[3])
{
    const fl_vec3 way = v3_sub(w->b.x[j], w->b.x[i]);
    return w->cell.wraps ? v3_add(way, fl_cell_way(&w->cell, v3(image[0], image[1], image[2]))) : way;
}

/* Pair c is watched as it is known now. */
static inline void fl_world_watch(fl_world *w, int32_t c)
{
    const fl_near *p = &w->pair[c];
    w->watch[c] = (fl_watch){p->i, p->j, p->n ? -INFINITY : p->asleep};
}

/* Whether pair c still cannot touch since it was last looked at. */
static inline int fl_world_apart(const fl_world *w, int32_t c)
{
    const fl_watch q = w->watch[c];
    return w->b.odometer[q.i] + w->b.odometer[q.j] < q.until;
}

/* Whether place i < n is empty. */
static inline int fl_world_away(const fl_world *w, int32_t i)
{
    return w->traffic.away && w->traffic.away[i];
}

/* How many there are. */
static inline int32_t fl_groups(const fl_world *w) { return (w->n + FL_BALLS_GROUP - 1) / FL_BALLS_GROUP; }

/* How many of them a thread takes in a row: where most sleep those that do not fill a register together.  No
 * more than FL_GROUPS, and no bit depends on how many it is. */
enum { FL_GROUPS = 8 };

static inline int32_t fl_groups_each(const fl_world *w) { return w->sleep.nap ? FL_GROUPS : 1; }

static inline enum fl_nap_kind fl_sleep_kind(const fl_world *w, int32_t k)
{
    return w->sleep.nap && k < w->n ? (enum fl_nap_kind)w->sleep.kind[k] : FL_AWAKE;
}

/* Whether piece or wall j is moved by what presses on it. */
static inline int fl_ride_yields(const fl_world *w, int32_t j)
{
    const int32_t m = w->ride.m.n ? w->ride.of[j - w->n] : -1;
    return m >= 0 && w->ride.m.motion[m].free != 0;
}

static inline int fl_thing_is_still(const fl_world *w, int32_t j)
{
    return j >= w->n && (w->ride.m.n == 0 || w->ride.of[j - w->n] < 0) &&
           !(w->press.panels && j < w->n + w->pieces);
}

static inline int fl_sleep_frozen(const fl_world *w, const fl_near *p)
{
    if (p->n == 0 || fl_sleep_kind(w, p->i) != FL_RESTS) return 0;
    return p->j >= w->n ? fl_thing_is_still(w, p->j) : fl_sleep_kind(w, p->j) == FL_RESTS;
}

/* What acts on thing k now, and what did before; n = 0 where nothing does or did. */
static inline fl_sink *fl_works_now(const fl_world *w, int32_t k) { return &w->sink.at[w->sink.place[k]]; }

static inline const fl_sink *fl_works_was(const fl_world *w, int32_t k)
{
    return &w->was.at[w->was.place[k]];
}

/* Room for the gain of the first kick of k; NULL where nobody will ask for it. */
static inline fl_gain *fl_works_gain(const fl_world *w, int32_t k)
{
    return w->was.place[k] ? &w->gain[w->was.place[k]] : NULL;
}

/* What the first half of the step changed of k's speeds, drag as well; 0 where nothing pressed before. */
static inline const fl_gain *fl_works_lead(const fl_world *w, int32_t k) { return &w->lead[w->was.place[k]]; }

/* It is that, if anybody may ask for it. */
static inline void fl_works_set_lead(fl_world *w, int32_t k, fl_vec3 v, fl_vec3 spin)
{
    if (w->was.place[k]) w->lead[w->was.place[k]] = (fl_gain){v, spin};
}

/* Nothing acts on thing k any longer. */
static inline void fl_works_clear(const fl_world *w, int32_t k)
{
    fl_sink *s = fl_works_now(w, k);
    if (s->n) *s = (fl_sink){0};
}

#endif
