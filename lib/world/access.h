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
static inline double fl_driven_floe_spring(const fl_world *w, int32_t i, double *drawn)
{
    if (i >= w->driven_floes.n || !w->driven_floes.is_driven[i] ||
        (w->inflow.absent && w->inflow.source_floe[i] >= 0))
        return 0.0;
    *drawn = w->b.x[i].z - w->driven_floes.rest_height[i];
    return w->driven_floes.k[i];
}

/* The piece or wall that thing j is, NULL where it is a floe. */
static inline const fl_piece *fl_world_piece(const fl_world *w, int32_t j)
{
    return j < w->n ? NULL : &w->structure.piece[j - w->n];
}

/* From thing i to j, or to the image of it that is meant [m]. */
static inline fl_vec3 fl_separation(const fl_world *w, int32_t i, int32_t j, const int32_t image[3])
{
    const fl_vec3 way = v3_sub(w->b.x[j], w->b.x[i]);
    return w->cell.periodic ? v3_add(way, fl_periodic_cell_offset(&w->cell, v3(image[0], image[1], image[2])))
                            : way;
}

/* Pair c is watched as it is known now. */
static inline void fl_set_next_check(fl_world *w, int32_t c)
{
    const fl_neighbour_pair *p = &w->pair[c];
    w->next_check[c] = (fl_next_check){p->i, p->j, p->touching ? -INFINITY : p->free_travel};
}

/* Whether pair c still cannot touch since it was last looked at. */
static inline int fl_next_check_pending(const fl_world *w, int32_t c)
{
    const fl_next_check q = w->next_check[c];
    return w->b.odometer[q.i] + w->b.odometer[q.j] < q.free_travel;
}

/* Whether place i < n is empty. */
static inline int fl_body_absent(const fl_world *w, int32_t i)
{
    return w->inflow.absent && w->inflow.absent[i];
}

/* How many there are. */
static inline int32_t fl_block_count(const fl_world *w) { return (w->n + FL_BODY_BLOCK - 1) / FL_BODY_BLOCK; }

/* How many of them a thread takes in a row: where most sleep those that do not fill a register together.  No
 * more than FL_BLOCKS_AT_ONCE, and no bit depends on how many it is. */
enum { FL_BLOCKS_AT_ONCE = 8 };

static inline int32_t fl_blocks_per_turn(const fl_world *w) { return w->sleep.state ? FL_BLOCKS_AT_ONCE : 1; }

static inline enum fl_sleep_phase fl_sleep_phase_of(const fl_world *w, int32_t k)
{
    return w->sleep.state && k < w->n ? (enum fl_sleep_phase)w->sleep.phase[k] : FL_AWAKE;
}

/* Whether piece or wall j is moved by what presses on it. */
static inline int fl_piece_is_free(const fl_world *w, int32_t j)
{
    const int32_t m = w->moving.movers.n ? w->moving.mover_of_piece[j - w->n] : -1;
    return m >= 0 && w->moving.movers.motion[m].free_dof != 0;
}

static inline int fl_thing_is_still(const fl_world *w, int32_t j)
{
    return j >= w->n && (w->moving.movers.n == 0 || w->moving.mover_of_piece[j - w->n] < 0) &&
           !(w->panel_load.panels && j < w->n + w->pieces);
}

static inline int fl_pair_is_resting(const fl_world *w, const fl_neighbour_pair *p)
{
    if (p->touching == 0 || fl_sleep_phase_of(w, p->i) != FL_RESTING) return 0;
    return p->j >= w->n ? fl_thing_is_still(w, p->j) : fl_sleep_phase_of(w, p->j) == FL_RESTING;
}

/* What acts on thing k now, and what did before; n = 0 where nothing does or did. */
static inline fl_contact_sum *fl_sums_now(const fl_world *w, int32_t k)
{
    return &w->contact_sums.sum[w->contact_sums.slot[k]];
}

static inline const fl_contact_sum *fl_sums_before(const fl_world *w, int32_t k)
{
    return &w->previous_sums.sum[w->previous_sums.slot[k]];
}

/* Room for the gain of the first kick of k; NULL where nobody will ask for it. */
static inline fl_velocity_change *fl_kick_change(const fl_world *w, int32_t k)
{
    return w->previous_sums.slot[k] ? &w->kick_change[w->previous_sums.slot[k]] : NULL;
}

/* What the first half of the step changed of k's speeds, drag as well; 0 where nothing pressed before. */
static inline const fl_velocity_change *fl_predicted_change(const fl_world *w, int32_t k)
{
    return &w->predicted_change[w->previous_sums.slot[k]];
}

/* It is that, if anybody may ask for it. */
static inline void fl_set_predicted_change(fl_world *w, int32_t k, fl_vec3 v, fl_vec3 spin)
{
    if (w->previous_sums.slot[k])
        w->predicted_change[w->previous_sums.slot[k]] = (fl_velocity_change){v, spin};
}

/* Nothing acts on thing k any longer. */
static inline void fl_sums_clear(const fl_world *w, int32_t k)
{
    fl_contact_sum *s = fl_sums_now(w, k);
    if (s->contacts) *s = (fl_contact_sum){0};
}

#endif
