/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include <stdio.h>
#include "base/parallel.h"
#include "sim/energy_balance.h"
#include "support/bits.h"
#include "support/scenes.h"

uint64_t bits_of(fl_world *w)
{
    const fl_ledger *g = &w->ledger;
    fl_energy_update(w);
    const double books[] = {g->bond,        g->fracture,    g->carried,      g->kinetic,     g->gravity,
                            g->elastic,     g->hydrostatic, g->friction_now, g->damping_now, g->drag,
                            g->wind,        g->drive_now,   g->residual,     g->throughput,  w->imbalance.x,
                            w->imbalance.y, w->imbalance.z, w->impulse_sum,  w->max_overlap, w->dt_critical};
    uint64_t h = fl_hash(fl_state_hash(w), books, (int64_t)sizeof books);
    h = fl_hash(h, w->part_impulse, w->parts * (int64_t)sizeof *w->part_impulse);
    h = fl_hash(h, w->part_moment, w->parts * (int64_t)sizeof *w->part_moment);
    h = fl_hash(h, w->part_peak, w->parts * (int64_t)sizeof *w->part_peak);
    return fl_hash(h, &w->contact_steps, (int64_t)sizeof w->contact_steps);
}

void bits_of_scenes(char text[BITS_TEXT])
{
    static void (*const SCENE[])(lab *, int32_t, const char *) = {
        scene_of_everything, scene_of_periodic_cell, scene_of_seas, scene_of_spheres, scene_of_surrogates};
    int at = 0;
    for (size_t k = 0; k < sizeof SCENE / sizeof *SCENE; k++) {
        lab l;
        SCENE[k](&l, 4, "patch");
        lab_set(&l, "run.threads=1");
        lab_make(&l, 0);
        if (lab_run(&l, 120)) at += snprintf(text + at, (size_t)(BITS_TEXT - at), "failed ");
        at += snprintf(text + at, (size_t)(BITS_TEXT - at), "%016" PRIx64 "\n", bits_of(&l.w));
        lab_free(&l);
    }
}
