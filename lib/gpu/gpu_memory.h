/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gpu_memory.h -- the memory of a world on a device, for gpu_world.c and gpu_lists.c: each pointer of the
 * view has a buffer that grows. */
#ifndef FL_GPU_GPU_MEMORY_H
#define FL_GPU_GPU_MEMORY_H
#include <stddef.h>
#include "base/err.h"
#include "gpu/gpu_engine.h"

/* Memory of the device behind a pointer of the view; its place is that of the pointer. */
typedef struct {
    void *at;
    size_t bytes;
} fl_gpu_buffer;

enum { FL_GPU_BUFFERS = sizeof(fl_gpu_view) / sizeof(void *) };

/* The faces of a mesh for a near pair. */
typedef struct {
    int32_t pair, first, n;
} fl_gpu_tiles;

struct fl_gpu_world {
    const fl_gpu_engine *e;
    fl_gpu_view v;
    fl_gpu_buffer memory[FL_GPU_BUFFERS];
    int uploaded;
    int makes_lists; /* the rows are listed on the device */
    int has_listed;  /* a row or a contact with a wall */
    int rows_newer;  /* the rows of the world are those of a list before */
    int rows_dead;   /* the device has rows of bodies that have left */
    int32_t n;       /* bodies of the arrays below */
    uint8_t *host;
    int32_t *guest, *guest_disc;
    int32_t guests, guest_discs, guest_disc_cap;
    fl_gpu_guest_state *guest_state;
    fl_gpu_guest_sum *guest_sum;
    fl_disc_wrench *guest_wrench;
    double *moves;
    uint8_t *leaves; /* [blocks] */
    int leaving;     /* some body of the device leaves */
    /* bodies near the structure, held or driven */
    int32_t *near_of;
    fl_gpu_near *near;
    fl_gpu_pair *pair, *told_pair;
    fl_gpu_piece *piece;
    int32_t nears, pairs, near_cap, pair_cap;
    int32_t *tile;          /* [tiles] of pairs on meshes */
    fl_gpu_tiles *tiles_of; /* [listed] of each of these pairs, ascending */
    int32_t tiles, tile_cap, listed, listed_cap;
    int32_t *guided_body; /* [guided] own bodies that come in */
    int32_t guided, guided_cap;
    int pairs_known; /* the CPU has evaluated them in this step, before a list was made */
};

/* Fails with the reason of the engine. */
int fl_gpu_fail(const struct fl_gpu_world *g, fl_err *err);

/* Fits the memory behind the pointer at that offset of the view, and copies from into it if it is given.
 * What was there is lost when it grows. */
int fl_gpu_put_bytes(struct fl_gpu_world *g, size_t offset, const void *from, size_t bytes, fl_err *err);
int fl_gpu_get_bytes(struct fl_gpu_world *g, void *to, const void *from, size_t bytes, fl_err *err);
/* The same, there after fl_gpu_wait() or the next fl_gpu_get_bytes(). */
int fl_gpu_get_later(struct fl_gpu_world *g, void *to, const void *from, size_t bytes, fl_err *err);
int fl_gpu_wait(struct fl_gpu_world *g, fl_err *err);
int fl_gpu_launch(struct fl_gpu_world *g, int kernel, int32_t n, fl_err *err);

/* Exchanges the pointers at two offsets of the view, and their memory. */
void fl_gpu_exchange(struct fl_gpu_world *g, size_t a, size_t b);

/* For a `g` and an `err`: copies up, makes room, copies down, runs a kernel, exchanges. */
#define FL_GPU_SIZE(member, count) ((size_t)(count) * sizeof *g->v.member)
#define FL_GPU_PUT(member, from, count)                                                                      \
    fl_gpu_put_bytes(g, offsetof(fl_gpu_view, member), from, FL_GPU_SIZE(member, count), err)
#define FL_GPU_ROOM(member, count) FL_GPU_PUT(member, NULL, count)
#define FL_GPU_GET(member, to, count) fl_gpu_get_bytes(g, to, g->v.member, FL_GPU_SIZE(member, count), err)
#define FL_GPU_GET_LATER(member, to, count)                                                                  \
    fl_gpu_get_later(g, to, g->v.member, FL_GPU_SIZE(member, count), err)
#define FL_GPU_LAUNCH(kernel, count) fl_gpu_launch(g, FL_GPU_##kernel, count, err)
#define FL_GPU_EXCHANGE(a, b) fl_gpu_exchange(g, offsetof(fl_gpu_view, a), offsetof(fl_gpu_view, b))

#endif
