/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/stage.h"
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "sim/inflow.h"
#include "sim/zone_step.h"
#include "world/access.h"

static int begin_stage(fl_world *w, const fl_scene_stage *s, const int32_t *group, const char *const *name,
                       int32_t names, fl_err *err)
{
    int32_t g = 0;
    uint8_t *gone;
    if (!s->remove[0]) return 0;
    while (g < names && strcmp(name[g], s->remove) != 0) g++;
    if (g == names)
        return fl_fail(err, FL_INPUT, "[stage %s] removes group %s, which no body has", s->name, s->remove);
    if (!(gone = fl_alloc(w->n, 1, err))) return -1;
    for (int32_t k = 0; k < w->n; k++) gone[k] = group[k] == g;
    const int rc = fl_inflow_remove(w, gone, err);
    if (rc == 0 && w->zones.set.blocks) fl_zones_drop_absent(w);
    free(gone);
    return rc;
}

int fl_stage_update(fl_world *w, const int32_t *group, const char *const *name, int32_t names, fl_err *err)
{
    const fl_scene *s = w->scene;
    if (w->next_stage >= s->n_stage) return w->relax.settled;
    const fl_scene_stage *stage = &s->stage[w->next_stage];
    if (stage->start >= 0.0 ? fl_world_time(w) < stage->start - 0.5 * w->dt : !w->relax.settled) return 0;
    w->next_stage++;
    w->stage_step = w->step;
    w->relax.settled = 0;
    return begin_stage(w, stage, group, name, names, err);
}
