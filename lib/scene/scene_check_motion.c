/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/scene_check_motion.h"
#include <stdio.h>
#include <string.h>
#include "scene/scene_section.h"

enum { MODES_OF_A_PART = 8 };

/* Where a message about motion is written; of: "structure" or "part NAME". */
typedef struct {
    const fl_scene *s;
    const char *of;
    fl_err *err;
} motion_check;

static int motion_fail(const motion_check *c, const char *name, const char *what)
{
    char key[3 * FL_SCENE_NAME];
    snprintf(key, sizeof key, "%s.%s", c->of, name);
    return fl_scene_fail(c->s, key, c->err, "%s: %s", key, what);
}

/* Check values of free directions: none below 0, none in a direction that is not free. */
static int check_free_values(const motion_check *c, const char *name, fl_vec3 x, uint32_t free)
{
    const double v[] = {x.x, x.y, x.z};
    for (int k = 0; k < 3; k++) {
        if (v[k] < 0.0) return motion_fail(c, name, "a value is below 0");
        if (v[k] != 0.0 && !(free >> k & 1u))
            return motion_fail(c, name, "a direction has a value that is not among the free ones");
    }
    return 0;
}

/* Waves on a floating structure. */
static int check_wave_load(const motion_check *c, const fl_scene_motion *m)
{
    const fl_vec3 a = m->added_mass;
    if (!m->waves)
        return v3_nonzero(a) ? motion_fail(c, "added_mass", "it belongs to waves = mesh, which is expected")
                             : 0;
    if (!c->s->water.head.present || c->s->water.wave == FL_WAVE_NONE)
        return motion_fail(c, "waves", "there are no waves: water.wave is expected");
    if (!m->free)
        return motion_fail(c, "waves", "they move free directions, and none is free: `free` is expected");
    if (m->hydrostatic)
        return motion_fail(c, "waves",
                           "the pressure of the water holds the hydrostatic stiffness: hydrostatic = none is "
                           "expected");
    if (a.x < 0.0 || a.y < 0.0 || a.z < 0.0) return motion_fail(c, "added_mass", "a value is below 0");
    if (v3_nonzero(a) && !(m->free & 7u))
        return motion_fail(c, "added_mass", "it applies to x, y and z, and none of them is free");
    return 0;
}

static int check_motion(const motion_check *c, const fl_scene_motion *m)
{
    const uint32_t turns = m->free >> 3;
    const double I[] = {m->inertia.x, m->inertia.y, m->inertia.z},
                 D[] = {m->damping_ratio.x, m->damping_ratio.y, m->damping_ratio.z},
                 spring[] = {m->stiffness.x + m->period.x, m->stiffness.y + m->period.y,
                             m->stiffness.z + m->period.z}; /* which directions have a spring */
    if (m->track[0] && (v3_nonzero(m->velocity) || v3_nonzero(m->spin)))
        return motion_fail(c, "track", "velocity and spin are given as well, one of the two is expected");
    if (m->free && v3_nonzero(m->spin))
        return motion_fail(
            c, "spin",
            "a body with free directions has no prescribed spin: spin or free is expected, not both");
    if (check_free_values(c, "stiffness", m->stiffness, m->free) ||
        check_free_values(c, "period", m->period, m->free) ||
        check_free_values(c, "damping", m->damping, m->free) ||
        check_free_values(c, "damping_ratio", m->damping_ratio, m->free) ||
        check_free_values(c, "turn_stiffness", m->turn_stiffness, turns) ||
        check_free_values(c, "turn_damping", m->turn_damping, turns) ||
        check_free_values(c, "inertia", m->inertia, turns))
        return -1;
    if (v3_nonzero(m->period) && v3_nonzero(m->stiffness))
        return motion_fail(c, "period", "stiffness is given as well, one of the two is expected");
    if (v3_nonzero(m->damping) && v3_nonzero(m->damping_ratio))
        return motion_fail(c, "damping_ratio", "damping is given as well, one of the two is expected");
    if ((m->hydrostatic || m->waves) && m->period.z > 0.0)
        return motion_fail(c, "period",
                           "hydrostatic stiffness acts along z as well: a stiffness is expected");
    for (int k = 0; k < 3; k++)
        if (D[k] > 0.0 && !(spring[k] > 0.0 || (k == 2 && (m->hydrostatic || m->waves))))
            return motion_fail(c, "damping_ratio", "a direction without a spring has no critical damping");
    if ((m->free & 7u) && m->mass == 0.0)
        return motion_fail(c, "mass", "free directions need a mass, and none is given");
    if (!(m->free & 7u) && m->mass != 0.0)
        return motion_fail(c, "mass", "a mass applies to free directions, and none of x y z is free");
    for (int k = 0; k < 3; k++)
        if (turns >> k & 1u && !(I[k] > 0.0))
            return motion_fail(c, "inertia", "every free rotation needs an inertia above 0");
    if ((v3_nonzero(m->coupling) || m->hydrostatic) && !(m->free & (FL_FIX_Z | FL_FIX_RX | FL_FIX_RY)))
        return motion_fail(c, m->hydrostatic ? "hydrostatic" : "coupling",
                           "it applies to z, rx and ry, and none of them is free");
    if (m->hydrostatic && !c->s->water.head.present)
        return motion_fail(c, "hydrostatic", "there is no water: [water] is expected");
    return check_wave_load(c, m);
}

/* A direction turns the surface alone. */
static int check_direction(const fl_scene *s, fl_err *err)
{
    const fl_scene_structure *t = &s->structure;
    const fl_scene_motion *m = &t->motion;
    if (!t->head.present || t->direction == 0.0) return 0;
    if (t->members[0] || t->modes[0] || s->n_mode || s->n_part || m->free || m->track[0] ||
        v3_nonzero(m->velocity) || v3_nonzero(m->spin))
        return fl_scene_fail(
            s, "structure.direction", err,
            "structure.direction turns a structure that stands: no motion, members, modes or "
            "[part NAME] is expected");
    return 0;
}

int fl_scene_check_motions(const fl_scene *s, fl_err *err)
{
    if (check_direction(s, err)) return -1;
    motion_check c = {s, "structure", err};
    if (s->structure.head.present && check_motion(&c, &s->structure.motion)) return -1;
    for (int32_t i = 0; i < s->n_part; i++) {
        char of[FL_SCENE_NAME + 8];
        snprintf(of, sizeof of, "part %s", s->part[i].name);
        c.of = of;
        if (!s->structure.head.present)
            return fl_scene_fail(s, of, err, "[%s] needs a structure: [structure] is expected", of);
        if (check_motion(&c, &s->part[i].motion)) return -1;
    }
    return 0;
}

int fl_scene_check_members(const fl_scene *s, fl_err *err)
{
    const fl_scene_structure *t = &s->structure;
    const fl_scene_motion *m = &t->motion;
    if (!t->head.present || !t->members[0]) {
        if (s->output.members[0])
            return fl_scene_fail(s, "output.members", err,
                                 "there are no members: structure.members is expected");
        return 0;
    }
    if (t->file[0])
        return fl_scene_fail(s, "structure.members", err,
                             "structure.file is given as well: one of the two is expected");
    if (strcmp(t->members, "-") == 0)
        return fl_scene_fail(s, "structure.members", err,
                             "structure.members is \"-\": a file is expected, as it is read twice");
    if (m->free || m->track[0] || v3_nonzero(m->velocity) || v3_nonzero(m->spin) || s->n_part || t->modes[0])
        return fl_scene_fail(s, s->n_part ? "part" : "structure.members", err,
                             "a structure of members moves by its own masses and supports: no %s is expected",
                             s->n_part ? "[part NAME]" : "velocity, spin, track, free or modes");
    return 0;
}

static int mode_fail(const fl_scene *s, int32_t k, const char *key, const char *what, fl_err *err)
{
    char at[3 * FL_SCENE_NAME];
    snprintf(at, sizeof at, "mode %s%s%s", s->mode[k].name, key ? "." : "", key ? key : "");
    return fl_scene_fail(s, at, err, "[mode %s]: %s", s->mode[k].name, what);
}

/* Number of modes of the part of mode k; -1 with err if one is the same as k. */
static int count_modes(const fl_scene *s, int32_t k, fl_err *err)
{
    const fl_scene_mode *m = &s->mode[k];
    char what[3 * FL_SCENE_NAME];
    int n = 0;
    for (int32_t j = 0; j < s->n_mode; j++) {
        const fl_scene_mode *other = &s->mode[j];
        if (strcmp(m->part, other->part) != 0) continue;
        n++;
        if (j >= k || m->frequency != other->frequency ||
            (m->direction != other->direction && m->direction != FL_MODE_XY &&
             other->direction != FL_MODE_XY))
            continue;
        snprintf(what, sizeof what, "it has the frequency and direction of [mode %s]", other->name);
        return mode_fail(s, k, "frequency", what, err);
    }
    return n;
}

/* The motion of a part whose section need not be there; NULL: none. */
static const fl_scene_motion *motion_of_part(const fl_scene *s, const char *part)
{
    if (!part[0]) return &s->structure.motion;
    const int32_t k = fl_section_named(s, FL_SEC_PART, part, "");
    return k < 0 ? NULL : &s->part[k].motion;
}

static int check_mode_motion(const fl_scene *s, const char *key, const fl_scene_motion *m, fl_err *err)
{
    if (m && (m->free || m->track[0] || v3_nonzero(m->velocity) || v3_nonzero(m->spin)))
        return fl_scene_fail(s, key, err, "the part has modes and `%s` as well: one of the two is expected",
                             m->free               ? "free"
                             : m->track[0]         ? "track"
                             : v3_nonzero(m->spin) ? "spin"
                                                   : "velocity");
    return 0;
}

int fl_scene_check_modes(fl_scene *s, fl_err *err)
{
    char key[2 * FL_SCENE_NAME];
    if (s->structure.head.present && s->structure.modes[0]) {
        if (s->n_mode)
            return mode_fail(s, 0, NULL, "structure.modes is given as well: one of the two is expected", err);
        if (check_mode_motion(s, "structure.modes", &s->structure.motion, err)) return -1;
    }
    for (int32_t k = 0; k < s->n_mode; k++) {
        const fl_scene_mode *m = &s->mode[k];
        snprintf(key, sizeof key, "mode %s", m->name);
        if (!s->structure.head.present)
            return mode_fail(s, k, NULL, "there is no structure: [structure] is expected", err);
        if (s->structure.members[0])
            return mode_fail(s, k, NULL,
                             "a structure of members moves by its own masses: structure.file is expected",
                             err);
        if (m->frequency == 0.0) return mode_fail(s, k, "frequency", "a frequency is expected", err);
        if (m->mass == 0.0) return mode_fail(s, k, "mass", "a mass is expected", err);
        if (m->shape == 0.0)
            return mode_fail(s, k, "shape",
                             "the waterline does not move in this mode: a shape other than 0 is expected",
                             err);
        const int n = count_modes(s, k, err);
        if (n < 0 || check_mode_motion(s, key, motion_of_part(s, m->part), err)) return -1;
        if (n > MODES_OF_A_PART) return mode_fail(s, k, NULL, "a part has at most 8 modes", err);
    }
    for (int32_t k = 0; k < s->n_mode; k++)
        if (s->mode[k].part[0] && fl_section_named(s, FL_SEC_PART, s->mode[k].part, "") < 0 &&
            fl_section_add(s, FL_SEC_PART, s->mode[k].part, "", err) < 0)
            return -1;
    return 0;
}
