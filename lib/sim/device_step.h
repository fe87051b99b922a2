/* SPDX-License-Identifier: GPL-3.0-or-later */
/* device_step.h -- a step whose spheres run on a device (gpu/gpu_world.h), to the bits of the CPU's step.
 *
 * step.c calls the parts in their order.  Between two parts the CPU moves the guests of the device, evaluates
 * all pairs that are not of spheres, moves the structure and keeps the books.  After a step bodies, contacts
 * and bonds of the world are old: fl_device_refresh() is due before anything but loads is read. */
#ifndef FL_SIM_DEVICE_STEP_H
#define FL_SIM_DEVICE_STEP_H
#include "sphere/leaving.h"
#include "world/world.h"

enum { FL_DEVICE_NOTE = 400 };

/* Chooses who runs the spheres, by run.device, before the first step.  note: one sentence, who and why.  -1
 * with FL_SYSTEM: a card that was asked for by name is not there, or too small; FL_INPUT: the scene has what
 * does not run there. */
int fl_device_choose(fl_world *w, char note[FL_DEVICE_NOTE], fl_err *err);
void fl_device_free(fl_world *w);

/* Brings the world up to date.  -1 with FL_SYSTEM: the card is lost. */
int fl_device_refresh(fl_world *w, fl_err *err);

/* Brings it up to date for changes between two steps, which the device takes over before the next. */
int fl_device_hand_over(fl_world *w, fl_err *err);
/* Number of times that has been done. */
int64_t fl_device_hand_overs(const fl_world *w);

/* 1 if the device moves body i, whose state in the world is old; and if one of those has left the domain. */
int fl_device_moves(const fl_world *w, int32_t i);
int fl_device_leaves(const fl_world *w);

/* Finds the bodies of the device that have left the domain, and brings them and their partners down.  1; 0 if
 * all have to come down for that; -1 with FL_SYSTEM. */
int fl_device_find_leaving(fl_world *w, fl_leaving *l, fl_err *err);
/* After they have been taken out of the world: the device goes on without them. */
int fl_device_drop(fl_world *w, const fl_leaving *l, fl_err *err);

/* Body i, which came in, is guided no more. */
int fl_device_release(const fl_world *w, int32_t i, fl_err *err);

/* Number of bodies that the CPU moves beside the device, since the last search; -1 without a device. */
int32_t fl_device_guests(const fl_world *w);

/* Drag, kick and drift; sets the largest paths of w->blocks. */
int fl_device_first_half(fl_world *w, double h, fl_err *err);
/* Before the neighbour list is made anew, and after.  fl_device_makes_lists(): the device lists pairs of
 * spheres. */
int fl_device_makes_lists(const fl_world *w);
/* 1 if a device runs the spheres, and no pair of them and no contact with a wall was ever listed. */
int fl_device_has_listed_none(const fl_world *w);
int fl_device_before_search(fl_world *w, fl_err *err);
int fl_device_take_lists(fl_world *w, fl_err *err);
int fl_device_contacts(fl_world *w, fl_err *err);
int fl_device_sums(fl_world *w, int stiffness, fl_err *err);
/* Forces, kick and drag; the books of blocks, chunks and bonds. */
int fl_device_second_half(fl_world *w, double h, int stiffness, fl_err *err);

#endif
