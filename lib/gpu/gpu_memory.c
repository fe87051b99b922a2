/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gpu/gpu_memory.h"
#include <string.h>

int fl_gpu_fail(const struct fl_gpu_world *g, fl_err *err)
{
    return fl_fail(err, FL_SYSTEM, "%s: %.200s; the last checkpoint stands", g->e->device(), g->e->why());
}

int fl_gpu_put_bytes(struct fl_gpu_world *g, size_t offset, const void *from, size_t bytes, fl_err *err)
{
    fl_gpu_buffer *const m = &g->memory[offset / sizeof(void *)];
    if (bytes > m->bytes) {
        const size_t want = bytes + bytes / 8;
        if (m->at) g->e->release(m->at);
        *m = (fl_gpu_buffer){0};
        if (g->e->alloc(&m->at, want)) {
            const double room = g->e->free_bytes();
            return fl_fail(
                err, FL_SYSTEM,
                "%s: no memory for %.0f MiB more, %.0f MiB are free; about %.3g of the %d bodies would "
                "fit",
                g->e->device(), (double)want / 1048576.0, room / 1048576.0,
                g->n * (room / (room + (double)want)), g->n);
        }
        m->bytes = want;
    }
    memcpy((char *)&g->v + offset, &m->at, sizeof m->at);
    return from && bytes && g->e->upload(m->at, from, bytes) ? fl_gpu_fail(g, err) : 0;
}

int fl_gpu_get_bytes(struct fl_gpu_world *g, void *to, const void *from, size_t bytes, fl_err *err)
{
    return bytes && g->e->download(to, from, bytes) ? fl_gpu_fail(g, err) : 0;
}

int fl_gpu_get_later(struct fl_gpu_world *g, void *to, const void *from, size_t bytes, fl_err *err)
{
    return bytes && g->e->download_later(to, from, bytes) ? fl_gpu_fail(g, err) : 0;
}

int fl_gpu_wait(struct fl_gpu_world *g, fl_err *err) { return g->e->wait() ? fl_gpu_fail(g, err) : 0; }

int fl_gpu_launch(struct fl_gpu_world *g, int kernel, int32_t n, fl_err *err)
{
    return n > 0 && g->e->launch(kernel, n, &g->v) ? fl_gpu_fail(g, err) : 0;
}

void fl_gpu_exchange(struct fl_gpu_world *g, size_t a, size_t b)
{
    fl_gpu_buffer *const p = &g->memory[a / sizeof(void *)], *const q = &g->memory[b / sizeof(void *)];
    const fl_gpu_buffer kept = *p;
    *p = *q, *q = kept;
    memcpy((char *)&g->v + a, &p->at, sizeof p->at);
    memcpy((char *)&g->v + b, &q->at, sizeof q->at);
}
