/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cuda.cu -- the engine of gpu_engine.h on one NVIDIA card: a plug-in, built by nvcc.
 *
 * Built with -fmad=false: products and sums stay apart, as with -ffp-contract=off, and sqrt and divisions of
 * doubles are those of IEEE 754.  So a kernel has the bits of gpu_serial.c. */
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <cuda_runtime.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The headers of the project are C: their inline functions are wanted on both sides. */
#define inline __host__ __device__ __forceinline__
#include "gpu/gpu_list_kernel.h"
#include "gpu/gpu_step_kernel.h"
#undef inline
#include "gpu/gpu_engine.h"

static char failure[256], card[200];
static cudaStream_t stream;

/* Keeps the sentence of a failure. */
static int check(cudaError_t e, const char *what)
{
    if (e == cudaSuccess) return 0;
    snprintf(failure, sizeof failure, "%s: %s", what, cudaGetErrorString(e));
    return -1;
}

/* The oldest cards for which there is code. */
enum { OLDEST = 75 };

static int open_engine(void)
{
    int cards = 0;
    cudaDeviceProp p;
    if (check(cudaGetDeviceCount(&cards), "no card")) return -1;
    if (cards == 0) {
        snprintf(failure, sizeof failure, "there is no card");
        return -1;
    }
    if (check(cudaGetDeviceProperties(&p, 0), "the card")) return -1;
    snprintf(card, sizeof card, "%.150s", p.name);
    if (10 * p.major + p.minor < OLDEST) {
        snprintf(failure, sizeof failure, "%.100s has compute capability %d.%d, 7.5 or more is expected",
                 p.name, p.major, p.minor);
        return -1;
    }
    return check(cudaSetDevice(0), "the card") || check(cudaStreamCreate(&stream), "the card") ? -1 : 0;
}

static const char *device_name(void) { return card; }
static const char *last_failure(void) { return failure; }

static double free_bytes(void)
{
    size_t unused = 0, all = 0;
    return cudaMemGetInfo(&unused, &all) == cudaSuccess ? (double)unused : 0.0;
}

static int alloc_bytes(void **to, size_t bytes)
{
    *to = NULL;
    if (!bytes) return 0;
    return check(cudaMalloc(to, bytes), "memory of the card") ||
                   check(cudaMemsetAsync(*to, 0, bytes, stream), "memory of the card")
               ? -1
               : 0;
}

static void release_bytes(void *p) { cudaFree(p); }

static int upload_bytes(void *to, const void *from, size_t bytes)
{
    return check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream), "copying to the card");
}

/* What comes down is collected in memory that the card reaches, so that a step waits once for all of it. */
enum { LATER_MOST = 32, STAGED_MOST = 1 << 22 };
static struct {
    void *to;
    size_t at, bytes;
} later[LATER_MOST];
static int later_count;
static char *staging;
static size_t staging_bytes, staging_used;

static int wait_engine(void)
{
    if (check(cudaStreamSynchronize(stream), "a kernel")) return -1;
    for (int k = 0; k < later_count; k++) memcpy(later[k].to, staging + later[k].at, later[k].bytes);
    later_count = 0, staging_used = 0;
    return 0;
}

static int fit_staging(size_t bytes)
{
    if (staging_used + bytes <= staging_bytes && later_count < LATER_MOST) return 0;
    if (wait_engine()) return -1;
    if (bytes <= staging_bytes) return 0;
    if (staging) cudaFreeHost(staging);
    staging = NULL, staging_bytes = 0;
    if (check(cudaMallocHost((void **)&staging, 4 * bytes), "memory for copies")) return -1;
    staging_bytes = 4 * bytes;
    return 0;
}

static int download_later(void *to, const void *from, size_t bytes)
{
    if (!bytes) return 0;
    if (bytes > STAGED_MOST)
        return check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, stream),
                     "copying from the card");
    if (fit_staging(bytes) ||
        check(cudaMemcpyAsync(staging + staging_used, from, bytes, cudaMemcpyDeviceToHost, stream),
              "copying from the card"))
        return -1;
    later[later_count].to = to, later[later_count].at = staging_used, later[later_count].bytes = bytes;
    later_count++;
    staging_used += (bytes + 255) / 256 * 256;
    if (staging_used > staging_bytes) staging_used = staging_bytes;
    return 0;
}

static int download_bytes(void *to, const void *from, size_t bytes)
{
    return download_later(to, from, bytes) || wait_engine() ? -1 : 0;
}

static void close_engine(void)
{
    if (stream) cudaStreamDestroy(stream);
    if (staging) cudaFreeHost(staging);
    stream = NULL, staging = NULL;
    staging_bytes = staging_used = 0, later_count = 0;
}

/* Threads of a block, and blocks that shall fit a multiprocessor at a time: registers are the limit.  Pairs with
 * pieces are few and take more registers than three blocks leave. */
enum { THREADS = 128, BLOCKS_AT_ONCE = 3, PAIRS_AT_ONCE = 2 };
#define AT_ONCE(name) (FL_GPU_##name == FL_GPU_PAIRS ? PAIRS_AT_ONCE : BLOCKS_AT_ONCE)

#define KERNEL(name, function)                                                                               \
    static __global__ void __launch_bounds__(THREADS, AT_ONCE(name))                                         \
        run_##name(const __grid_constant__ fl_gpu_view v, int32_t n)                                         \
    {                                                                                                        \
        const int32_t k = (int32_t)(blockIdx.x * THREADS + threadIdx.x);                                     \
        if (k < n) function(&v, k);                                                                          \
    }
FL_GPU_KERNELS(KERNEL)

#define CASE(name, function)                                                                                 \
    case FL_GPU_##name: run_##name<<<blocks, THREADS, 0, stream>>>(*v, n); break;

static int launch_kernel(int kernel, int32_t n, const fl_gpu_view *v)
{
    const unsigned blocks = (unsigned)((n + THREADS - 1) / THREADS);
    switch (kernel) {
        FL_GPU_KERNELS(CASE)
    default: snprintf(failure, sizeof failure, "a kernel that is not there"); return -1;
    }
    return check(cudaGetLastError(), "a kernel");
}

/* Memory of the two below, kept. */
static void *scratch;
static size_t scratch_bytes;

static int fit_scratch(size_t bytes)
{
    if (bytes <= scratch_bytes) return 0;
    cudaFree(scratch);
    scratch_bytes = bytes + bytes / 8;
    return check(cudaMalloc(&scratch, scratch_bytes), "memory of the card");
}

static int sort_keys(uint64_t *key, int32_t *value, int32_t n)
{
    size_t need = 0;
    const size_t room = ((size_t)n * 12 + 1023) / 512 * 512; /* sorted keys and values */
    if (check(cub::DeviceRadixSort::SortPairs(NULL, need, key, key, value, value, n, 0, 64, stream),
              "sorting") ||
        fit_scratch(room + need))
        return -1;
    uint64_t *const keys = (uint64_t *)scratch;
    int32_t *const values = (int32_t *)(keys + n);
    return check(cub::DeviceRadixSort::SortPairs((char *)scratch + room, need, key, keys, value, values, n, 0,
                                                 64, stream),
                 "sorting") ||
                   check(
                       cudaMemcpyAsync(key, keys, (size_t)n * sizeof *key, cudaMemcpyDeviceToDevice, stream),
                       "sorting") ||
                   check(cudaMemcpyAsync(value, values, (size_t)n * sizeof *value, cudaMemcpyDeviceToDevice,
                                         stream),
                         "sorting")
               ? -1
               : 0;
}

static int make_offsets(int32_t *count, int32_t n)
{
    size_t need = 0;
    return check(cub::DeviceScan::ExclusiveSum(NULL, need, count, count, n, stream), "adding up") ||
                   fit_scratch(need) ||
                   check(cub::DeviceScan::ExclusiveSum(scratch, need, count, count, n, stream), "adding up")
               ? -1
               : 0;
}

static const fl_gpu_engine CUDA = {FL_GPU_VERSION, (int32_t)sizeof(fl_gpu_view),
                                   "cuda",         open_engine,
                                   close_engine,   device_name,
                                   last_failure,   free_bytes,
                                   alloc_bytes,    release_bytes,
                                   upload_bytes,   download_bytes,
                                   download_later, launch_kernel,
                                   wait_engine,    sort_keys,
                                   make_offsets};

extern "C" const fl_gpu_engine *fl_gpu_engine_cuda(void) { return &CUDA; }
