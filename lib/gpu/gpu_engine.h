/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gpu_engine.h -- what runs the kernels of gpu_view.h: a table of functions, in C, so that an engine can be a
 * plug-in.
 *
 *     serial   loops on the CPU over memory of their own (gpu_serial.c), always there: the same data flow
 *              without a card
 *     cuda     one NVIDIA card (cuda.cu), in libfloe-cuda.so beside the programs or in ../lib, by dlopen
 *
 * Calls return 0, or -1 with a sentence in why(). */
#ifndef FL_GPU_GPU_ENGINE_H
#define FL_GPU_GPU_ENGINE_H
#include <stddef.h>
#include "gpu/gpu_view.h"

/* Raised when fl_gpu_view, the kernels or this table change: a plug-in of another version is refused. */
#define FL_GPU_VERSION 6

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    int32_t version;    /* FL_GPU_VERSION */
    int32_t view_bytes; /* sizeof(fl_gpu_view) */
    const char *name;   /* "serial", "cuda" */
    int (*open)(void);  /* finds the card */
    void (*close)(void);
    const char *(*device)(void);           /* name of the card */
    const char *(*why)(void);              /* the last failure */
    double (*free_bytes)(void);            /* memory that is free [B] */
    int (*alloc)(void **to, size_t bytes); /* zeroed; 0 bytes: NULL */
    void (*release)(void *p);
    int (*upload)(void *to, const void *from, size_t bytes);
    int (*download)(void *to, const void *from, size_t bytes); /* after all that was launched before */
    int (*download_later)(void *to, const void *from,
                          size_t bytes); /* it is there after wait() or download() */
    int (*launch)(int kernel, int32_t n,
                  const fl_gpu_view *v);                   /* k = 0 .. n - 1; may return before the end */
    int (*wait)(void);                                     /* for all that was launched */
    int (*sort)(uint64_t *key, int32_t *value, int32_t n); /* by ascending keys; arrays of the device */
    int (*offsets)(int32_t *count, int32_t n);             /* n counts become the sums of those before */
} fl_gpu_engine;

/* The function that a plug-in exports, and its name. */
typedef const fl_gpu_engine *fl_gpu_engine_get(void);
#define FL_GPU_ENGINE_SYMBOL "fl_gpu_engine_cuda"

#ifdef __cplusplus
}
#endif

const fl_gpu_engine *fl_gpu_serial(void);
/* The same from the last thread to the first: a kernel must not depend on their order. */
const fl_gpu_engine *fl_gpu_serial_backwards(void);

/* The engine of the plug-in, opened; NULL, and why in text: there is none, of another version, no driver, no
 * card.  It is looked for in $FLOE_CUDA, then beside the program and in ../lib. */
enum { FL_GPU_WHY = 256 };
const fl_gpu_engine *fl_gpu_plugin(char why[FL_GPU_WHY]);

#endif
