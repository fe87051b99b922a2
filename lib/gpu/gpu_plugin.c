/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "gpu/gpu_engine.h"

#define NAME "libfloe-cuda.so"

/* Folder of the program, or "". */
static void folder_of_program(char *path, size_t size)
{
    const ssize_t n = readlink("/proc/self/exe", path, size - 1);
    path[n > 0 ? n : 0] = '\0';
    char *const slash = strrchr(path, '/');
    if (slash) *slash = '\0';
}

/* Opens the plug-in: a file named by the environment, else the first that is there. */
static void *open_file(char *path, size_t size)
{
    static const char *const BESIDE[] = {"%s/" NAME, "%s/../lib/" NAME};
    const char *const given = getenv("FLOE_CUDA");
    char folder[512];
    if (given) {
        snprintf(path, size, "%s", given);
        return dlopen(path, RTLD_NOW | RTLD_LOCAL);
    }
    folder_of_program(folder, sizeof folder);
    for (size_t k = 0; k < sizeof BESIDE / sizeof *BESIDE; k++) {
        snprintf(path, size, k ? BESIDE[1] : BESIDE[0], folder);
        if (access(path, R_OK) == 0) return dlopen(path, RTLD_NOW | RTLD_LOCAL);
    }
    path[0] = '\0';
    return NULL;
}

const fl_gpu_engine *fl_gpu_plugin(char why[FL_GPU_WHY])
{
    char path[600];
    fl_gpu_engine_get *get = NULL;
    void *const file = open_file(path, sizeof path);
    if (!file) {
        if (path[0]) snprintf(why, FL_GPU_WHY, "%.200s", dlerror());
        else snprintf(why, FL_GPU_WHY, "there is no " NAME ", which make builds where nvcc is");
        return NULL;
    }
    void *const symbol = dlsym(file, FL_GPU_ENGINE_SYMBOL);
    memcpy(&get, &symbol, sizeof get); /* POSIX gives functions as void* */
    const fl_gpu_engine *const e = get ? get() : NULL;
    if (!e || e->version != FL_GPU_VERSION || e->view_bytes != (int32_t)sizeof(fl_gpu_view))
        snprintf(why, FL_GPU_WHY, "%.160s is of another version: make builds it anew", path);
    else if (e->open()) snprintf(why, FL_GPU_WHY, "%.200s", e->why());
    else return e;
    dlclose(file);
    return NULL;
}
