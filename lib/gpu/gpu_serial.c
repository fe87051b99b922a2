/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "gpu/gpu_engine.h"
#include "gpu/gpu_list_kernel.h"
#include "gpu/gpu_step_kernel.h"

static const char *failure = "";
static int backwards;

static int open_engine(void) { return 0; }
static void close_engine(void) {}
static const char *device_name(void) { return "serial launcher, one thread of the CPU"; }
static const char *last_failure(void) { return failure; }
static double free_bytes(void) { return INFINITY; }

static int alloc_bytes(void **to, size_t bytes)
{
    *to = bytes ? calloc(1, bytes) : NULL;
    if (bytes && !*to) failure = "out of memory";
    return bytes && !*to ? -1 : 0;
}

static int copy_bytes(void *to, const void *from, size_t bytes)
{
    if (bytes) memcpy(to, from, bytes);
    return 0;
}

#define LOOP(name, function)                                                                                 \
    case FL_GPU_##name:                                                                                      \
        for (int32_t k = 0; k < n; k++) function(v, backwards ? n - 1 - k : k);                              \
        break;

static int launch_kernel(int kernel, int32_t n, const fl_gpu_view *v)
{
    switch (kernel) {
        FL_GPU_KERNELS(LOOP)
    default: failure = "a kernel that is not there"; return -1;
    }
    return 0;
}

static int wait_engine(void) { return 0; }

/* By bytes from the lowest on, which keeps the order of equal keys. */
static int sort_keys(uint64_t *key, int32_t *value, int32_t n)
{
    uint64_t *const keys = malloc(((size_t)n + 1) * sizeof *keys);
    int32_t *const values = malloc(((size_t)n + 1) * sizeof *values);
    const int bad = !keys || !values;
    for (int shift = 0; shift < 64 && !bad; shift += 8) {
        int32_t first[257] = {0};
        for (int32_t k = 0; k < n; k++) first[(key[k] >> shift & 255) + 1]++;
        for (int d = 0; d < 256; d++) first[d + 1] += first[d];
        for (int32_t k = 0; k < n; k++) {
            const int32_t to = first[key[k] >> shift & 255]++;
            keys[to] = key[k], values[to] = value[k];
        }
        memcpy(key, keys, (size_t)n * sizeof *key);
        memcpy(value, values, (size_t)n * sizeof *value);
    }
    free(keys), free(values);
    if (bad) failure = "out of memory";
    return bad ? -1 : 0;
}

static int make_offsets(int32_t *count, int32_t n)
{
    int32_t sum = 0;
    for (int32_t k = 0; k < n; k++) {
        const int32_t own = count[k];
        count[k] = sum;
        sum += own;
    }
    return 0;
}

static const fl_gpu_engine SERIAL = {
    .version = FL_GPU_VERSION,
    .view_bytes = sizeof(fl_gpu_view),
    .name = "serial",
    .open = open_engine,
    .close = close_engine,
    .device = device_name,
    .why = last_failure,
    .free_bytes = free_bytes,
    .alloc = alloc_bytes,
    .release = free,
    .upload = copy_bytes,
    .download = copy_bytes,
    .download_later = copy_bytes,
    .launch = launch_kernel,
    .wait = wait_engine,
    .sort = sort_keys,
    .offsets = make_offsets,
};

const fl_gpu_engine *fl_gpu_serial(void)
{
    backwards = 0;
    return &SERIAL;
}

const fl_gpu_engine *fl_gpu_serial_backwards(void)
{
    backwards = 1;
    return &SERIAL;
}
