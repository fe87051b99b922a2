/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gpu_world.h -- the spheres of a world on a device: its memory, what goes up and down, what is launched.
 *
 * The device moves the spheres that only meet spheres, walls and bonds, dry or in still water.  All other
 * bodies are guests: those near the structure, driven ones, ones with fixed directions, floes that are no
 * spheres, places of bodies that are not there, and all bodies in waves, wind and other waters.
 * The CPU moves them with its own code, while the device evaluates rows and bonds:
 *
 *     fl_gpu_world_first_half()   own bodies: drag, kick, drift.  The caller does the same for guests
 *     fl_gpu_world_contacts()     states of guests up; rows, walls and bonds are launched
 *     fl_gpu_world_sums()         sums of guests down, and how many bonds ended
 *     fl_gpu_world_second_half()  own bodies: sums, kick, drag are launched.  The caller does the guests
 *     fl_gpu_world_finish()       their works go up; sums of blocks, chunks and runs of bonds come down
 *
 * When the skin is used up the CPU lists walls and all other pairs (sim/neighbour_list.h), and the device its
 * rows (gpu_lists.h), or where it cannot, the CPU those as well: fl_gpu_world_download_bodies(), or
 * fl_gpu_world_download(), the search, then fl_gpu_world_upload(). */
#ifndef FL_GPU_GPU_WORLD_H
#define FL_GPU_GPU_WORLD_H
#include "gpu/gpu_engine.h"
#include "world/world.h"

typedef struct fl_gpu_world fl_gpu_world;

/* Why the scene of w cannot run on a device, as words after "has" ("waves"); NULL if it can. */
const char *fl_gpu_world_refuses(const fl_world *w);

/* 1 if all bodies are guests, since the device has no kernel of their water. */
int fl_gpu_world_has_other_water(const fl_world *w);

/* Bytes that n bodies with that many rows and bonds take on the device, an estimate before the run. */
double fl_gpu_world_bytes(const fl_world *w);

/* A world on engine e, which is open.  NULL with FL_SYSTEM. */
fl_gpu_world *fl_gpu_world_make(const fl_gpu_engine *e, fl_err *err);
void fl_gpu_world_free(fl_gpu_world *g); /* closes the engine; accepts NULL */

/* "serial launcher, ...", or the name of the card. */
const char *fl_gpu_world_device(const fl_gpu_world *g);

/* Copies the lists, and all bodies and bonds, after a search within a step; the first step begins with it. */
int fl_gpu_world_upload(fl_gpu_world *g, fl_world *w, fl_err *err);

/* Copies bodies, contacts and bonds into the world; or bodies and contacts with walls alone. */
int fl_gpu_world_download(fl_gpu_world *g, fl_world *w, fl_err *err);
int fl_gpu_world_download_bodies(fl_gpu_world *g, fl_world *w, fl_err *err);

/* 1 if the device moves body k, whose state in the world is that of the last download; and whether such a
 * body has left the domain in the last step. */
int fl_gpu_world_owns(const fl_gpu_world *g, int32_t k);
int fl_gpu_world_leaves(const fl_gpu_world *g);

/* Body k is guided no more. */
int fl_gpu_world_release(fl_gpu_world *g, const fl_world *w, int32_t k, fl_err *err);

/* The world has been changed between two steps, after a download: all of it goes up before the next. */
void fl_gpu_world_forget(fl_gpu_world *g);

/* 1 if the device lists the rows. */
int fl_gpu_world_makes_lists(const fl_gpu_world *g);

/* 1 if no row and no contact with a wall was ever listed, here or on the CPU. */
int fl_gpu_world_has_listed_none(const fl_gpu_world *g);

/* The bodies that the CPU moves, ascending. */
const int32_t *fl_gpu_world_guests(const fl_gpu_world *g, int32_t *n);

int fl_gpu_world_first_half(fl_gpu_world *g, fl_world *w, fl_err *err);
/* The two largest paths of own bodies since the last search, after the first half. */
int fl_gpu_world_moves(fl_gpu_world *g, double largest[2], fl_err *err);
int fl_gpu_world_contacts(fl_gpu_world *g, fl_world *w, fl_err *err);
int fl_gpu_world_sums(fl_gpu_world *g, fl_world *w, int stiffness, fl_err *err);
int fl_gpu_world_second_half(fl_gpu_world *g, fl_world *w, int stiffness, fl_err *err);
/* work[n]: of each guest. */
int fl_gpu_world_finish(fl_gpu_world *g, fl_world *w, const fl_gpu_guest_work *work, int stiffness,
                        fl_err *err);

#endif
