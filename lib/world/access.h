/* SPDX-License-Identifier: GPL-3.0-or-later */
/* access.h -- short accessors of a world.
 *
 * Thing k is a floe for k < n, then a piece of the structure, then a wall. */
#ifndef FL_WORLD_ACCESS_H
#define FL_WORLD_ACCESS_H
#include <math.h>
#include "world/world.h"

/* Time now [s].  dt changes only at times that are known exactly, so no rounding accumulates. */
static inline double fl_world_time(const fl_world *w) { return w->t0 + (double)(w->step - w->step0) * w->dt; }

/* Number of bonds, of faces and of spheres. */
static inline int32_t fl_world_bonds(const fl_world *w) { return w->bonds.n + w->discs.n; }
/* Those that are joints of rock. */
static inline int32_t fl_world_joints(const fl_world *w) { return w->bonds.n - w->bonds.faces; }

/* True if the floe in place i is of the driven edge. */
static inline int fl_floe_is_driven(const fl_world *w, int32_t i)
{
    const int32_t copy = w->inflow.absent ? w->inflow.source_floe[i] : -1, floe = copy < 0 ? i
                                                                                  : w->inflow.join.first
                                                                                      ? copy
                                                                                      : INT32_MAX;
    return floe < w->driven_floes.n && w->driven_floes.is_driven[floe];
}

/* Heave spring of driven floe i: returns its stiffness [N/m], 0 without a spring; *drawn is its extension
 * upwards [m]. */
static inline double fl_driven_floe_spring(const fl_world *w, int32_t i, double *drawn)
{
    if (!fl_floe_is_driven(w, i)) return 0.0;
    *drawn = w->b.x[i].z - w->driven_floes.rest_height[i];
    return w->driven_floes.k[i];
}

/* Its force downwards [N]. */
static inline double fl_driven_floe_force(const fl_world *w, int32_t i)
{
    double drawn = 0.0;
    const double k = fl_driven_floe_spring(w, i, &drawn);
    return k * drawn;
}

/* The piece or wall of thing j, NULL for a floe. */
static inline const fl_piece *fl_world_piece(const fl_world *w, int32_t j)
{
    return j < w->n ? NULL : &w->structure.piece[j - w->n];
}

/* Vector from the centre of thing i to that of j, or of its periodic image [m]. */
static inline fl_vec3 fl_separation(const fl_world *w, int32_t i, int32_t j, const int32_t image[3])
{
    const fl_vec3 way = v3_sub(w->b.x[j], w->b.x[i]);
    return w->cell.periodic ? v3_add(way, fl_periodic_cell_offset(&w->cell, v3(image[0], image[1], image[2])))
                            : way;
}

/* Update next_check[c] from near pair c. */
static inline void fl_set_next_check(fl_world *w, int32_t c)
{
    const fl_neighbour_pair *p = &w->pair[c];
    w->next_check[c] = (fl_next_check){p->i, p->j, p->touching ? -INFINITY : p->free_travel};
}

/* 0 while near pair c cannot touch: the two have not moved far enough since its last evaluation. */
static inline int fl_pair_may_touch(const fl_world *w, int32_t c)
{
    const fl_next_check q = w->next_check[c];
    return !(w->b.odometer[q.i] + w->b.odometer[q.j] < q.free_travel);
}

/* 1 if place i < n of the arrays is empty: its floe has left, or has not come in. */
static inline int fl_body_absent(const fl_world *w, int32_t i)
{
    return w->inflow.absent && w->inflow.absent[i];
}

/* End of the places that have held a floe: those beyond, for floes to come and fragments, cost no step. */
static inline int32_t fl_places_end(const fl_world *w) { return w->inflow.absent ? w->inflow.places : w->n; }

/* Number of blocks of FL_BODY_BLOCK floes. */
static inline int32_t fl_block_count(const fl_world *w)
{
    return (fl_places_end(w) + FL_BODY_BLOCK - 1) / FL_BODY_BLOCK;
}

/* Largest number of blocks that a thread takes at a time. */
enum { FL_BLOCKS_AT_ONCE = 8 };

/* Number of blocks that a thread takes at a time: several where floes may sleep, so that those awake fill
 * the vector registers.  No bit of a result depends on it. */
static inline int32_t fl_blocks_per_turn(const fl_world *w) { return w->sleep.state ? FL_BLOCKS_AT_ONCE : 1; }

/* Sleep phase of thing k; pieces and walls are awake. */
static inline enum fl_sleep_phase fl_sleep_phase_of(const fl_world *w, int32_t k)
{
    return w->sleep.state && k < w->n ? (enum fl_sleep_phase)w->sleep.phase[k] : FL_AWAKE;
}

/* 1 if the structure is one of members. */
static inline int fl_structure_has_members(const fl_world *w) { return w->moving.members.cylinders > 0; }

/* 1 if some part of the structure moves. */
static inline int fl_structure_moves(const fl_world *w)
{
    return w->moving.movers.n > 0 || fl_structure_has_members(w);
}

/* 1 if piece or wall j moves, by a mover or as a member. */
static inline int fl_piece_moves(const fl_world *w, int32_t j)
{
    if (fl_structure_has_members(w)) return j < w->n + w->pieces;
    return w->moving.movers.n > 0 && w->moving.mover_of_piece[j - w->n] >= 0;
}

/* 1 if contact forces move piece or wall j: it is of a member, or its mover has free directions. */
static inline int fl_piece_is_free(const fl_world *w, int32_t j)
{
    if (fl_structure_has_members(w)) return j < w->n + w->pieces;
    const int32_t m = w->moving.movers.n ? w->moving.mover_of_piece[j - w->n] : -1;
    return m >= 0 && w->moving.movers.motion[m].free_dof != 0;
}

/* 1 if floes may rest against thing j: a piece or wall that stands still, of one part, and whose panel loads
 * are not written. */
static inline int fl_thing_is_still(const fl_world *w, int32_t j)
{
    return j >= w->n && !fl_piece_moves(w, j) && !(w->panel_load.panels && j < w->n + w->pieces) &&
           !w->structure.piece[j - w->n].several_parts;
}

/* 1 if near pair p is not evaluated: the two touch and both rest, or one rests and the other stands still. */
static inline int fl_pair_is_resting(const fl_world *w, const fl_neighbour_pair *p)
{
    if (p->touching == 0 || fl_sleep_phase_of(w, p->i) != FL_RESTING) return 0;
    return p->j >= w->n ? fl_thing_is_still(w, p->j) : fl_sleep_phase_of(w, p->j) == FL_RESTING;
}

/* Contact sums of thing k in this step and in the step before; .contacts = 0 without contacts. */
static inline fl_contact_sum *fl_sums_now(const fl_world *w, int32_t k)
{
    return &w->contact_sums.sum[w->contact_sums.slot[k]];
}

static inline const fl_contact_sum *fl_sums_before(const fl_world *w, int32_t k)
{
    return &w->previous_sums.sum[w->previous_sums.slot[k]];
}

/* Where to store the velocity change by the first kick of thing k; NULL if nothing will read it. */
static inline fl_velocity_change *fl_kick_change(const fl_world *w, int32_t k)
{
    return w->previous_sums.slot[k] ? &w->kick_change[w->previous_sums.slot[k]] : NULL;
}

/* Velocity change of thing k by the first half of the step, with drag; 0 without contacts in the step
 * before. */
static inline const fl_velocity_change *fl_predicted_change(const fl_world *w, int32_t k)
{
    return &w->predicted_change[w->previous_sums.slot[k]];
}

/* Store that change, if it will be read. */
static inline void fl_set_predicted_change(fl_world *w, int32_t k, fl_vec3 v, fl_vec3 spin)
{
    if (w->previous_sums.slot[k])
        w->predicted_change[w->previous_sums.slot[k]] = (fl_velocity_change){v, spin};
}

/* Set the contact sums of thing k to 0. */
static inline void fl_sums_clear(const fl_world *w, int32_t k)
{
    fl_contact_sum *s = fl_sums_now(w, k);
    if (s->contacts) *s = (fl_contact_sum){0};
}

#endif
