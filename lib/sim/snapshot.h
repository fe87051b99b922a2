/* SPDX-License-Identifier: GPL-3.0-or-later */
/* snapshot.h -- the state of a world as text, and back: a world that goes on from it makes the steps that the
 * first would have made, to the bit.
 *
 * Held is what steps change: bodies, pairs with what friction, damping and the searches remember, water,
 * books, and the loads of the interval under way.  What follows from scene, ice and structure is not: the
 * world that reads has been made from the same ones.  Doubles are the 16 hexadecimal digits of their bits,
 * leading zeros left out, so that every bit survives, on any machine.  Rows:
 *     world     step found_at dt t0 step0 sea_time skin dt_critical dt_touching critical_body dt_safe
 *               parts total sea pairs balls
 *     books     the ledger's start, residual, throughput and sums; imbalance; sizes; worst overlap; counts
 *     told      how often surrogates told a force, and how well, where there are some
 *     part ...  impulse, moment and peak of the loads interval
 *     traffic   who has come and gone; next ... of each floe that comes in; place ... who stands in it
 *     body ...  x v L q w f t held, carried (with added mass alone), odometer, odometer at the last search
 *     nap ...   with run.sleep: who sleeps, since when and until when, what bounds it, sums of the report
 *     mover ... hash of its track, x v L q w f t held, what of its springs and dampers lasts
 *     bond ...  state, energies, keep, forces; damage, its bounds and slip of each point, unless it is whole
 *     pressed   what follows, where panels or events are asked for: panel, mark and event rows
 *     current   hash of its table, where there is one
 *     sea ...   wetted lift energy drained blown, waved with waves alone;
 *               with water.every in waves what of the last look is needed, fl_wave_sample
 *     pair ...  i j, image where space is periodic, memory, and for a pair that touches its forces,
 *               and with contact.surrogate where it was looked at last and what was learnt
 *     ball ...  i j, image where space is periodic, whether it touches, and its memory, fl_sphere_contact */
#ifndef FL_SIM_SNAPSHOT_H
#define FL_SIM_SNAPSHOT_H
#include <stdio.h>
#include "base/text.h"
#include "world/world.h"

/* Write the state between two steps.  Changes nothing; write errors stay in f. */
void fl_snapshot_write(FILE *f, fl_world *w);

/* Read it into a world that fl_world_make() built from the same scene, ice and structure; fl_step() goes on,
 * without fl_step_start().  -1 with FL_INPUT (w is then good for fl_world_free() alone) or FL_SYSTEM. */
int fl_snapshot_read(fl_world *w, fl_text *in, fl_err *err);

#endif
