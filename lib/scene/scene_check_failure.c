/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/scene_check_failure.h"
#include <math.h>
#include <stdio.h>
#include "law/contact_law.h"
#include "scene/scene_section.h"

/* 1 if the key of a section was given. */
static int is_given(const fl_scene_head *h, enum fl_section_id section, const char *key)
{
    return h->key[fl_key_find((int)section, key) - fl_key_first((int)section)].line != 0;
}

int fl_scene_check_failure(const fl_scene *s, fl_err *err)
{
    const fl_scene_failure *f = &s->failure;
    static const char *const OF_LAW[] = {"pressure", "pressure_area", "pressure_exponent"};
    const int on = f->head.present,
              breaks = on && (f->flexural_strength < INFINITY || f->fracture_toughness < INFINITY),
              crushes = on && f->crushing != FL_CRUSHING_NONE;
    if (!breaks && s->output.failures[0])
        return fl_scene_fail(s, "output.failures", err,
                             "floes do not break: failure.flexural_strength or failure.fracture_toughness is "
                             "expected");
    if (!on) return 0;
    for (int k = 0; k < 3 && f->pressure_law != FL_PRESSURE_USER; k++)
        if (is_given(&f->head, FL_SEC_FAILURE, OF_LAW[k])) {
            char key[64];
            snprintf(key, sizeof key, "failure.%s", OF_LAW[k]);
            return fl_scene_fail(s, key, err,
                                 "failure.pressure_law names a law with constants of its own: pressure_law = "
                                 "user is expected with %s",
                                 key);
        }
    if (crushes && f->pressure_law == FL_PRESSURE_USER && f->pressure > f->pressure_max)
        return fl_scene_fail(s, "failure.pressure_max", err,
                             "failure.pressure_max is %g Pa, at least failure.pressure, %g Pa, is expected",
                             f->pressure_max, f->pressure);
    for (int32_t a = 0; a < s->n_material && crushes; a++) {
        const fl_contact_law *law = &fl_contact_laws[fl_scene_pair(s, a, FL_SCENE_STRUCTURE).law];
        if (law->points != FL_POINTS_PATCH)
            return fl_scene_fail(
                s, "failure.crushing", err,
                "contacts of %s with the structure have the law %s, which has no area: contact.law = "
                "patch or quick is expected with failure.crushing",
                s->material[a].name, law->name);
    }
    if (f->fracture_toughness < INFINITY && !crushes)
        return fl_scene_fail(
            s, "failure.fracture_toughness", err,
            "what opens a crack follows from the area of a contact that crushes: failure.crushing "
            "= structure is expected with fracture_toughness");
    if (!breaks) return 0;
    if (s->ice.shape != FL_SHAPE_SHARP)
        return fl_scene_fail(s, "ice.shape", err,
                             "floes that break are cut along planes: ice.shape = sharp is expected with "
                             "flexural_strength or fracture_toughness");
    if (s->bond.head.present && s->bond.on)
        return fl_scene_fail(
            s, "failure.flexural_strength", err,
            "floes that start bonded break at their bonds: either bond.on or flexural_strength "
            "and fracture_toughness are expected");
    if (s->run.sleep > 0.0)
        return fl_scene_fail(s, "run.sleep", err,
                             "floes that may break do not sleep: either run.sleep or flexural_strength and "
                             "fracture_toughness are expected");
    if (s->run.error > 0.0)
        return fl_scene_fail(s, "run.error", err,
                             "run.error repeats windows, in which no floe can break: either run.error or "
                             "flexural_strength and fracture_toughness are expected");
    return 0;
}

int fl_scene_check_crushing_rate(const fl_scene *s, fl_err *err)
{
    const fl_scene_failure *f = &s->failure;
    if (!f->head.present || f->crushing == FL_CRUSHING_NONE || f->crushing_law == FL_CRUSHING_PLAIN) return 0;
    if (!s->structure.head.present)
        return fl_scene_fail(s, "failure.crushing_law", err,
                             "there is no structure that ice crushes on: [structure] is expected");
    if (f->crushing == FL_CRUSHING_ALL)
        return fl_scene_fail(s, "failure.crushing", err,
                             "ice crushes by its speed on the structure alone: crushing = structure is "
                             "expected with crushing_law = rate");
    if (f->flexural_strength < INFINITY || f->fracture_toughness < INFINITY)
        return fl_scene_fail(s, "failure.crushing_law", err,
                             "floes that break do not crush by their speed: crushing_law = plain is expected "
                             "with flexural_strength and fracture_toughness");
    if (f->creep_exponent == 2)
        return fl_scene_fail(s, "failure.creep_exponent", err, "creep_exponent is 2, 1 or 3 is expected");
    if (s->run.sleep > 0.0)
        return fl_scene_fail(
            s, "run.sleep", err,
            "ice that crushes by its speed does not sleep: either run.sleep or crushing_law = rate "
            "is expected");
    if (s->run.error > 0.0)
        return fl_scene_fail(
            s, "run.error", err,
            "run.error repeats windows with other steps, in which ice would break elsewhere: run.dt "
            "is expected with crushing_law = rate");
    if (s->bond.head.present && s->bond.on)
        return fl_scene_fail(
            s, "bond.on", err,
            "bonded floes do not crush by their speed: either bond.on or crushing_law = rate is "
            "expected");
    return 0;
}

int fl_scene_check_bonds(const fl_scene *s, fl_err *err)
{
    const fl_scene_bond *b = &s->bond;
    const int on = b->head.present && b->on;
    if (s->n_joint && s->run.sleep > 0.0)
        return fl_scene_fail(s, "run.sleep", err,
                             "blocks with joints do not sleep: either run.sleep or [joint NAME] is expected");
    if (!on && !s->n_joint && s->output.bonds[0])
        return fl_scene_fail(s, "output.bonds", err,
                             "there are no bonds: bond.on = true, or [joint NAME], is expected");
    if (!on) return 0;
    if (s->run.sleep > 0.0)
        return fl_scene_fail(s, "run.sleep", err,
                             "bonded floes do not sleep: either run.sleep or bond.on is expected");
    if (s->boundary.head.present && s->boundary.inflow == FL_INFLOW_FILE)
        return fl_scene_fail(s, "boundary.inflow", err,
                             "ice of another file would come in without bonds: boundary.inflow = ice, or "
                             "bond.on = false, is expected");
    if (b->softening == FL_SOFTENING_WEAKEN && b->energy == 0.0)
        return fl_scene_fail(s, "bond.softening", err,
                             "softening = weaken needs a fracture energy: bond.energy is expected");
    if (b->softening == FL_SOFTENING_WEAKEN && (isinf(b->normal_strength) || isinf(b->shear_strength)))
        return fl_scene_fail(
            s, "bond.softening", err,
            "softening = weaken lowers both strengths, but one is none: a number is expected");
    return 0;
}
