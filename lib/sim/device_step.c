/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/device_step.h"
#include <stdio.h>
#include "base/array.h"
#include "gpu/gpu_outflow.h"
#include "gpu/gpu_world.h"
#include "sim/first_half.h"
#include "sim/second_half.h"
#include "sphere/contact_force.h"

/* With fewer spheres the launches take longer than a core. */
enum { FEWEST = 1000 };
/* Guests that a thread takes at a time. */
enum { GUESTS = 64 };
/* Memory that is printed with two decimals of a MiB. */
#define FEW_BYTES (100.0 * 1048576.0)

/* --- which device -------------------------------------------------------------------------------- */

static const char *const BY_NAME[] = {"auto", "cpu", "gpu", "serial"};

/* The CPU runs, for that reason, unless a device was asked for by name. */
static int take_cpu(const fl_world *w, int code, char note[FL_DEVICE_NOTE], const char *why, fl_err *err)
{
    const int32_t want = w->scene->run.device;
    snprintf(note, FL_DEVICE_NOTE, "cpu: %.300s", why);
    if (code == FL_INPUT && want != FL_DEVICE_AUTO)
        return fl_scene_fail(w->scene, "run.device", err, "%.300s", why);
    return want == FL_DEVICE_AUTO ? 0 : fl_fail(err, code, "run.device = %s: %.300s", BY_NAME[want], why);
}

static int take_engine(fl_world *w, const fl_gpu_engine *e, char note[FL_DEVICE_NOTE], fl_err *err)
{
    const double need = fl_gpu_world_bytes(w), room = e->free_bytes();
    char why[200];
    if (need > room) {
        snprintf(why, sizeof why,
                 "%.60s has %.*f MiB free and %.*f are needed: about %.0f of the %d bodies fit", e->device(),
                 room < FEW_BYTES ? 2 : 0, room / 1048576.0, need < FEW_BYTES ? 2 : 0, need / 1048576.0,
                 w->n * (room / need), w->n);
        e->close();
        return take_cpu(w, FL_SYSTEM, note, why, err);
    }
    snprintf(note, FL_DEVICE_NOTE, "%s: %.200s, about %.0f MiB", BY_NAME[w->scene->run.device], e->device(),
             need / 1048576.0);
    w->device.gpu = fl_gpu_world_make(e, err);
    return w->device.gpu ? 0 : -1;
}

int fl_device_choose(fl_world *w, char note[FL_DEVICE_NOTE], fl_err *err)
{
    const int32_t want = w->scene->run.device;
    char why[FL_GPU_WHY], text[FL_GPU_WHY];
    snprintf(note, FL_DEVICE_NOTE, "cpu: as asked for");
    if (want == FL_DEVICE_CPU) return 0;
    const char *const has = fl_gpu_world_refuses(w);
    if (has) {
        snprintf(text, sizeof text, "the scene has %s, which does not run on a device", has);
        return take_cpu(w, FL_INPUT, note, text, err);
    }
    if (want == FL_DEVICE_SERIAL) return take_engine(w, fl_gpu_serial(), note, err);
    if (want == FL_DEVICE_AUTO && w->n < FEWEST) return take_cpu(w, FL_SYSTEM, note, "few spheres", err);
    if (want == FL_DEVICE_AUTO && fl_gpu_world_has_other_water(w))
        return take_cpu(w, FL_SYSTEM, note, "waves, wind and profiles of the current are its own", err);
    const fl_gpu_engine *const e = fl_gpu_plugin(why);
    return e ? take_engine(w, e, note, err) : take_cpu(w, FL_SYSTEM, note, why, err);
}

void fl_device_free(fl_world *w)
{
    fl_gpu_world_free(w->device.gpu);
    w->device.gpu = NULL;
}

int fl_device_refresh(fl_world *w, fl_err *err)
{
    if (!w->device.gpu || !w->device.stale) return 0;
    if (fl_gpu_world_download(w->device.gpu, w, err)) return -1;
    w->device.stale = 0;
    return 0;
}

int fl_device_hand_over(fl_world *w, fl_err *err)
{
    if (!w->device.gpu) return 0;
    if (fl_device_refresh(w, err)) return -1;
    fl_gpu_world_forget(w->device.gpu);
    w->device.hand_overs++;
    return 0;
}

int64_t fl_device_hand_overs(const fl_world *w) { return w->device.hand_overs; }

int fl_device_moves(const fl_world *w, int32_t i)
{
    return w->device.gpu && fl_gpu_world_owns(w->device.gpu, i);
}

int fl_device_release(const fl_world *w, int32_t i, fl_err *err)
{
    return w->device.gpu ? fl_gpu_world_release(w->device.gpu, w, i, err) : 0;
}

int fl_device_leaves(const fl_world *w) { return w->device.gpu && fl_gpu_world_leaves(w->device.gpu); }

int fl_device_find_leaving(fl_world *w, fl_leaving *l, fl_err *err)
{
    return w->device.gpu ? fl_gpu_world_find_leaving(w->device.gpu, w, l, err) : 0;
}

int fl_device_drop(fl_world *w, const fl_leaving *l, fl_err *err)
{
    return fl_gpu_world_drop(w->device.gpu, w, l, err);
}

int32_t fl_device_guests(const fl_world *w)
{
    int32_t n = -1;
    if (w->device.gpu) fl_gpu_world_guests(w->device.gpu, &n);
    return n;
}

/* --- the step ------------------------------------------------------------------------------------ */

static void note_moves(fl_world *w, int32_t k)
{
    fl_update_two_largest(w->blocks[0].largest_moves, w->b.odometer[k] - w->odometer_at_search[k]);
}

int fl_device_first_half(fl_world *w, double h, fl_err *err)
{
    fl_gpu_world *const g = w->device.gpu;
    int32_t n;
    if (fl_gpu_world_first_half(g, w, err)) return -1;
    const int32_t *const guest = fl_gpu_world_guests(g, &n);
    w->device.stale = 1;
#pragma omp parallel for schedule(static) num_threads(w->team.n) if (w->team.n > 1 && n > GUESTS)
    for (int32_t from = 0; from < n; from += GUESTS) {
        const int32_t to = n - from < GUESTS ? n : from + GUESTS;
        fl_bodies_first_half(w, guest + from, to - from, h);
        for (int32_t k = from; k < to; k++) fl_sphere_states_update(w, guest[k], guest[k] + 1, h);
    }
    for (int32_t k = 0; k < fl_block_count(w); k++)
        w->blocks[k].largest_moves[0] = w->blocks[k].largest_moves[1] = 0.0;
    if (fl_gpu_world_moves(g, w->blocks[0].largest_moves, err)) return -1;
    for (int32_t k = 0; k < n; k++) note_moves(w, guest[k]);
    return 0;
}

int fl_device_makes_lists(const fl_world *w)
{
    return w->device.gpu && fl_gpu_world_makes_lists(w->device.gpu);
}

int fl_device_has_listed_none(const fl_world *w)
{
    return w->device.gpu && fl_gpu_world_has_listed_none(w->device.gpu);
}

int fl_device_before_search(fl_world *w, fl_err *err)
{
    return fl_device_makes_lists(w) ? fl_gpu_world_download_bodies(w->device.gpu, w, err)
                                    : fl_device_refresh(w, err);
}

int fl_device_take_lists(fl_world *w, fl_err *err) { return fl_gpu_world_upload(w->device.gpu, w, err); }

int fl_device_contacts(fl_world *w, fl_err *err) { return fl_gpu_world_contacts(w->device.gpu, w, err); }

int fl_device_sums(fl_world *w, int stiffness, fl_err *err)
{
    return fl_gpu_world_sums(w->device.gpu, w, stiffness, err);
}

/* First guest of block b or of a later one. */
static int32_t first_guest(const int32_t *guest, int32_t n, int32_t b)
{
    int32_t lo = 0, hi = n;
    while (lo < hi) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (guest[mid] / FL_BODY_BLOCK < b) lo = mid + 1;
        else hi = mid;
    }
    return lo;
}

static void end_guests(fl_world *w, const int32_t *guest, int32_t from, int32_t to, double h,
                       fl_gpu_guest_work *work)
{
    for (int32_t k = from; k < to; k++) {
        const fl_body_block one = fl_body_second_half(w, guest[k], h);
        work[k] =
            (fl_gpu_guest_work){one.contact_force, one.damping_work, one.friction_work, one.not_finite < 0};
    }
}

int fl_device_second_half(fl_world *w, double h, int stiffness, fl_err *err)
{
    fl_gpu_world *const g = w->device.gpu;
    int32_t n;
    const int32_t *const guest = fl_gpu_world_guests(g, &n);
    fl_gpu_guest_work *const work = fl_alloc(n, sizeof *work, err);
    int bad = (n && !work) || fl_gpu_world_second_half(g, w, stiffness, err);
    const int32_t blocks = bad ? 0 : fl_block_count(w);
#pragma omp parallel for schedule(static) num_threads(w->team.n) if (w->team.n > 1 && n > GUESTS)
    for (int32_t b = 0; b < blocks; b++) /* guests of a block share its sums */
        end_guests(w, guest, first_guest(guest, n, b), first_guest(guest, n, b + 1), h, work);
    bad = bad || fl_gpu_world_finish(g, w, work, stiffness, err);
    free(work);
    w->device.stale = 1;
    return bad ? -1 : 0;
}
