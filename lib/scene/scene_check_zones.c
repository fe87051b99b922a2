/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/scene_check_zones.h"

enum { ZONES_YIELD = 1 }; /* law = mohr-coulomb */

/* The material of the bodies must have strengths; those named in records of bodies are checked with them. */
static int check_strengths(const fl_scene *s, fl_err *err)
{
    int any = 0;
    for (int32_t k = 0; k < s->n_material; k++) {
        const fl_scene_material *m = &s->material[k];
        any |= m->cohesion >= 0.0 && m->friction_angle >= 0.0;
        if ((m->cohesion >= 0.0) != (m->friction_angle >= 0.0))
            return fl_fail(err, FL_INPUT, "[material %s] has %s and no %s", m->name,
                           m->cohesion >= 0.0 ? "a cohesion" : "a friction_angle",
                           m->cohesion >= 0.0 ? "friction_angle" : "cohesion");
        if (m->dilation > m->friction_angle && m->friction_angle >= 0.0)
            return fl_fail(
                err, FL_INPUT,
                "[material %s] has a dilation of %g degrees, at most its friction_angle, %g, is expected",
                m->name, m->dilation, m->friction_angle);
    }
    if (any || s->zones.law != ZONES_YIELD) return 0;
    return fl_scene_fail(s, "zones.law", err,
                         "zones.law is mohr-coulomb and no [material NAME] has cohesion and friction_angle");
}

int fl_scene_check_zones(const fl_scene *s, fl_err *err)
{
    const fl_scene_zones *z = &s->zones;
    if (check_strengths(s, err)) return -1;
    if (!z->head.present) {
        if (s->output.zones[0])
            return fl_scene_fail(s, "output.zones", err, "no block is divided: [zones] is expected");
        return 0;
    }
    if (!(z->size > 0.0)) return fl_scene_fail(s, "zones.size", err, "[zones] has no size");
    const struct {
        int present;
        const char *what;
    } other[] = {{s->water.head.present, "[water]"},
                 {s->wind.head.present, "[wind]"},
                 {s->failure.head.present, "[failure]"},
                 {s->bond.head.present && s->bond.on, "[bond]"},
                 {s->boundary.head.present && s->boundary.inflow != FL_INFLOW_NONE, "an inflow"},
                 {s->run.sleep > 0.0, "run.sleep"},
                 {s->run.error > 0.0, "run.error"},
                 {s->run.device == FL_DEVICE_GPU || s->run.device == FL_DEVICE_SERIAL, "run.device"}};
    for (int k = 0; k < (int)(sizeof other / sizeof *other); k++)
        if (other[k].present)
            return fl_scene_fail(s, "zones.size", err, "blocks with zones do not go together with %s",
                                 other[k].what);
    const int32_t *side = z->wave_side % 2 ? z->max_side : z->min_side;
    if (v3_nonzero(z->wave_stress) && side[z->wave_side / 2] != FL_ZONE_SIDE_QUIET)
        return fl_scene_fail(s, "zones.wave_stress", err,
                             "a wave comes in through a quiet side, and zones.%s is not quiet in %c",
                             z->wave_side % 2 ? "max_side" : "min_side", 'x' + z->wave_side / 2);
    return 0;
}
