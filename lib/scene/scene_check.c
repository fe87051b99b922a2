/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "scene/scene_check.h"
#include "base/pi.h"
#include "law/contact_law.h"
#include "scene/unused_keys.h"
#include "scene/scene_section.h"

/* Of the force of the waves, where none is given. */
#define DEFAULT_WAVE_ERROR 0.003

enum { MODES_OF_A_PART = 8 };

static int add_missing_material(fl_scene *s, const char *name, fl_err *err)
{
    if (fl_scene_find_material(s, name) >= 0) return 0;
    return fl_section_add(s, FL_SEC_MATERIAL, name, "", err) < 0 ? -1 : 0;
}

/* Set a value to that of another key until it is given itself.  A second call sets it again: the mark
 * decides. */
static void copy_unless_given(const fl_scene_output *o, const char *key, double *value, double other)
{
    const int slot = fl_key_find(FL_SEC_OUTPUT, key) - fl_key_first(FL_SEC_OUTPUT);
    if (o->head.key[slot].line == 0 || o->head.key[slot].is_auto) *value = other;
}

static void set_default_intervals(fl_scene *s)
{
    fl_scene_output *o = &s->output;
    copy_unless_given(o, "ice_every", &o->ice_every, o->frames_every);
    copy_unless_given(o, "until", &o->until, s->run.duration);
    copy_unless_given(o, "state_every", &o->state_every, o->loads_every);
    copy_unless_given(o, "energy_every", &o->energy_every, o->loads_every);
    copy_unless_given(o, "contacts_every", &o->contacts_every, o->loads_every);
    copy_unless_given(o, "hash_every", &o->hash_every, o->loads_every);
    copy_unless_given(o, "bonds_every", &o->bonds_every, o->loads_every);
    copy_unless_given(o, "members_every", &o->members_every, o->loads_every);
}

/* Check that a material exists; place: "structure" and "boundary" are accepted too.  key is the whole
 * address, for the line of the message. */
static int check_material(const fl_scene *s, const char *key, const char *name, int place, fl_err *err)
{
    if (fl_scene_find_material(s, name) >= 0) return 0;
    if (place && (strcmp(name, "structure") == 0 || strcmp(name, "boundary") == 0)) return 0;
    return fl_scene_fail(s, key, err, "there is no [material %s]", name);
}

static int check_inputs(const fl_scene *s, fl_err *err)
{
    const int std_scene = s->n_file > 0 && strcmp(s->file[0], "<stdin>") == 0;
    const int std_ice = strcmp(s->ice.file, "-") == 0;
    const int std_structure = s->structure.head.present && strcmp(s->structure.file, "-") == 0;
    if (!s->ice.head.present || s->ice.file[0] == '\0')
        return fl_scene_fail(s, "ice.file", err,
                             "the scene has no ice: [ice] file = FILE, or --ice FILE, is expected");
    if (s->structure.head.present && !s->structure.file[0] && !s->structure.members[0])
        return fl_scene_fail(s, "structure.file", err,
                             "[structure] has no file: file = FILE, or --structure FILE, is expected");
    if (std_scene + std_ice + std_structure > 1)
        return fl_scene_fail(s, std_ice ? "ice.file" : "structure.file", err,
                             "standard input can be only one of scene, ice and structure");
    if (check_material(s, "ice.material", s->ice.material, 0, err)) return -1;
    if (s->structure.head.present && check_material(s, "structure.material", s->structure.material, 0, err))
        return -1;
    return 0;
}

static int check_outputs(const fl_scene *s, fl_err *err)
{
    const char *const key[] = {"output.frames",  "output.state",    "output.energy",    "output.contacts",
                               "output.hash",    "output.panels",   "output.events",    "output.bonds",
                               "output.members", "output.failures", "output.final_ice", "output.checkpoint"};
    const char *const path[] = {s->output.frames,   s->output.state,     s->output.energy,
                                s->output.contacts, s->output.hash,      s->output.panels,
                                s->output.events,   s->output.bonds,     s->output.members,
                                s->output.failures, s->output.final_ice, s->output.checkpoint};
    for (int k = 0; k < (int)(sizeof key / sizeof *key); k++) {
        if (strcmp(path[k], "-") == 0)
            return fl_scene_fail(s, key[k], err,
                                 "%s is \"-\", and standard output carries the loads: a file is expected",
                                 key[k]);
        for (int j = 0; j < k && path[k][0]; j++)
            if (strcmp(path[j], path[k]) == 0)
                return fl_scene_fail(s, key[k], err, "%s is \"%s\", which is %s already", key[k], path[k],
                                     key[j]);
        if (path[k][0] &&
            (strcmp(path[k], s->ice.file) == 0 || strcmp(path[k], s->structure.file) == 0 ||
             strcmp(path[k], s->structure.members) == 0 || strcmp(path[k], s->structure.modes) == 0))
            return fl_scene_fail(s, key[k], err, "%s is \"%s\", which is an input", key[k], path[k]);
    }
    return 0;
}

/* The law of section i: its own, or that of [contact] without names. */
static int32_t law_of(const fl_scene *s, int32_t i, int32_t all)
{
    const int law = fl_key_find(FL_SEC_CONTACT, "law") - fl_key_first(FL_SEC_CONTACT);
    return s->contact[i].head.key[law].line || all < 0 ? s->contact[i].law : s->contact[all].law;
}

/* True if a contact that section i covers has a law that uses the key. */
static int law_uses_key(const fl_scene *s, int32_t i, int32_t all, const char *key)
{
    int uses = fl_contact_law_uses(&fl_contact_laws[law_of(s, i, all)], key);
    for (int32_t k = 0; k < s->n_contact && i == all; k++)
        uses |= fl_contact_law_uses(&fl_contact_laws[law_of(s, k, all)], key);
    return uses;
}

/* Refuses a key of section i, called `at`, that is given and that none of its laws uses. */
static int check_law_key(const fl_scene *s, int32_t i, int32_t all, const char *at, const char *key,
                         int given, fl_err *err)
{
    char full[4 * FL_SCENE_NAME], laws[160] = "";
    size_t n = 0;
    if (!given || law_uses_key(s, i, all, key)) return 0;
    for (int32_t k = 0; k < fl_contact_law_count; k++)
        if (fl_contact_law_uses(&fl_contact_laws[k], key) && n < sizeof laws)
            n += (size_t)snprintf(laws + n, sizeof laws - n, "%s%s", n ? " and " : "",
                                  fl_contact_laws[k].name);
    snprintf(full, sizeof full, "%s.%s", at, key);
    return fl_scene_fail(s, full, err, "%s applies to law = %s only", key, laws);
}

static int check_contacts(const fl_scene *s, fl_err *err)
{
    const int32_t all = fl_section_named(s, FL_SEC_CONTACT, "", "");
    for (int32_t i = 0; i < s->n_contact; i++) {
        const fl_scene_contact *c = &s->contact[i];
        char at[3 * FL_SCENE_NAME], key[4 * FL_SCENE_NAME];
        snprintf(at, sizeof at, "contact%s%s%s%s", c->a[0] ? " " : "", c->a, c->b[0] ? " " : "", c->b);
        if (check_law_key(s, i, all, at, "manual_eq2", c->manual_eq2, err) ||
            check_law_key(s, i, all, at, "manual_eq18", c->manual_eq18, err))
            return -1;
        snprintf(key, sizeof key, "%s.surrogate", at);
        if (s->run.error > 0.0 && c->surrogate > 0.0)
            return fl_scene_fail(s, key, err,
                                 "run.error compares steps of different sizes, which a surrogate would "
                                 "disturb: either run.error or surrogate in [%s] is expected",
                                 at);
        if (check_law_key(s, i, all, at, "surrogate", c->surrogate > 0.0, err) ||
            check_law_key(s, i, all, at, "rolling", c->rolling > 0.0, err) ||
            check_law_key(s, i, all, at, "exponent", c->exponent != 1.0, err))
            return -1;
        if (i == all) continue;
        if (check_material(s, at, c->a, 1, err) || check_material(s, at, c->b, 1, err)) return -1;
        if (fl_scene_find_material(s, c->a) < 0 && fl_scene_find_material(s, c->b) < 0)
            return fl_scene_fail(s, at, err, "[%s] names no material: structure and boundary never touch",
                                 at);
    }
    return 0;
}

static int check_drive(const fl_scene *s, fl_err *err)
{
    const fl_scene_boundary *b = &s->boundary;
    const double v[] = {b->drive.x, b->drive.y, b->drive.z};
    const int row = b->drive_width > 0.0, group = b->drive_group[0] != '\0';
    if (row && group)
        return fl_scene_fail(s, "boundary.drive_group", err,
                             "drive_width and drive_group both say which floes are driven: one is expected");
    if (row && b->drive_edge == 0 && !b->drive_track[0] && !(fabs(v[0]) > 0.0 || fabs(v[1]) > 0.0))
        return fl_scene_fail(s, "boundary.drive_width", err,
                             "boundary.drive has no direction along x or y: drive_edge is expected");
    for (int c = 0; c < 3 && (row || group); c++)
        if (v[c] != 0.0 && !(b->drive_fixed >> c & 1u))
            return fl_scene_fail(s, "boundary.drive", err,
                                 "boundary.drive along %c is %g m/s, and %c is not among drive_fixed",
                                 'x' + c, v[c], 'x' + c);
    return 0;
}

static int check_inflow(const fl_scene *s, fl_err *err)
{
    const fl_scene_boundary *b = &s->boundary;
    const int axis = b->inflow_from / 2;
    const double lo = axis ? b->min.y : b->min.x, hi = axis ? b->max.y : b->max.x;
    const double current = axis ? s->water.current.y : s->water.current.x;
    if (b->inflow == FL_INFLOW_FILE && b->inflow_file[0] == '\0')
        return fl_scene_fail(s, "boundary.inflow", err,
                             "boundary.inflow is file: inflow_file = FILE is expected");
    if (b->type[axis] != FL_BOUNDARY_FREE || !isfinite(lo) || !isfinite(hi))
        return fl_scene_fail(
            s, "boundary.inflow", err,
            "inflow along %c needs boundary.type = free in %c, and boundary.min and boundary.max of it",
            'x' + axis, 'x' + axis);
    if (b->inflow_speed <= 0.0 && !((b->inflow_from % 2 ? -current : current) > 0.0))
        return fl_scene_fail(s, "boundary.inflow", err,
                             "water.current does not point into the domain there: boundary.inflow_speed, or "
                             "another inflow_from, is expected");
    return 0;
}

static int check_boundary(const fl_scene *s, fl_err *err)
{
    const double lo[] = {s->boundary.min.x, s->boundary.min.y, s->boundary.min.z};
    const double hi[] = {s->boundary.max.x, s->boundary.max.y, s->boundary.max.z};
    static const char *const NAME[] = {"rigid", "elastic", "periodic"};
    int walls = 0, open = 1;
    if (!s->boundary.head.present) return 0;
    for (int c = 0; c < 3; c++) {
        walls += isfinite(lo[c]) + isfinite(hi[c]);
        open = open && s->boundary.type[c] == FL_BOUNDARY_FREE;
        if (!(lo[c] < hi[c]))
            return fl_scene_fail(s, "boundary.max", err,
                                 "boundary.max of %c is %g m, more than its min, %g m, is expected", 'x' + c,
                                 hi[c], lo[c]);
    }
    for (int c = 0; c < 3 && walls == 0 && !open; c++)
        if (s->boundary.type[c] != FL_BOUNDARY_FREE)
            return fl_scene_fail(s, "boundary.type", err,
                                 "%s %s boundary has no bounds: boundary.min or boundary.max is expected",
                                 s->boundary.type[c] == FL_BOUNDARY_ELASTIC ? "an" : "a",
                                 NAME[s->boundary.type[c]]);
    for (int c = 0; c < 3; c++)
        if (s->boundary.type[c] == FL_BOUNDARY_PERIODIC && isfinite(lo[c]) != isfinite(hi[c]))
            return fl_scene_fail(s, "boundary.type", err,
                                 "%c is periodic and has one bound: boundary.min and boundary.max of %c, or "
                                 "none of the two, are expected",
                                 'x' + c, 'x' + c);
    if (s->boundary.type[2] == FL_BOUNDARY_PERIODIC && isfinite(lo[2]) && s->water.head.present)
        return fl_scene_fail(s, "boundary.type", err,
                             "z is periodic, but [water] has one surface: only one of the two is expected");
    if (check_drive(s, err)) return -1;
    return s->boundary.inflow == FL_INFLOW_NONE ? 0 : check_inflow(s, err);
}

static int check_current(const fl_scene *s, fl_err *err)
{
    const fl_scene_water *w = &s->water;
    const int sheared = w->profile == 1 || w->profile == 2, table = w->profile == 3;
    if (!w->head.present) return 0;
    if (sheared && w->profile_depth == 0.0 && !isfinite(w->depth))
        return fl_scene_fail(
            s, "water.profile", err,
            "a current profile needs a depth: water.profile_depth or water.depth is expected");
    if (table && w->profile_file[0] == '\0')
        return fl_scene_fail(s, "water.profile", err,
                             "water.profile = table has no rows: water.profile_file is expected");
    if (!table && w->profile_file[0])
        return fl_scene_fail(s, "water.profile_file", err,
                             "water.profile_file applies to water.profile = table only");
    if (table && v3_norm(w->current) > 0.0)
        return fl_scene_fail(s, "water.current", err,
                             "the current is given twice: by water.current and by water.profile_file");
    return 0;
}

static int check_weight(const fl_scene *s, fl_err *err)
{
    const fl_vec3 g = s->run.gravity;
    if (s->water.head.present && (g.x != 0.0 || g.y != 0.0 || g.z > 0.0))
        return fl_scene_fail(s, "run.gravity", err,
                             "the water surface is level: a run.gravity along -z is expected");
    return 0;
}

/* Checks common to all kinds of waves; the program checks whether a wave would break. */
static int check_waves(const fl_scene *s, fl_err *err)
{
    const fl_scene_water *w = &s->water;
    const fl_vec3 g = s->run.gravity;
    if (!w->head.present || w->wave == FL_WAVE_NONE) return 0;
    if (s->ice.slab > 0.0)
        return fl_scene_fail(s, "ice.slab", err,
                             "spheres that stand for a slab float in still water: either ice.slab or "
                             "water.wave is expected");
    if (w->height == 0.0)
        return fl_scene_fail(s, "water.wave", err, "the waves have no height: water.height is expected");
    if (w->period == 0.0)
        return fl_scene_fail(s, "water.wave", err, "the waves have no period: water.period is expected");
    if (!(g.z < 0.0))
        return fl_scene_fail(s, "run.gravity", err, "waves need gravity: a run.gravity along -z is expected");
    if (!(0.5 * w->height < w->depth))
        return fl_scene_fail(s, "water.height", err,
                             "waves of %g m on water of %g m: less than twice the depth is expected",
                             w->height, w->depth);
    const double turn = fl_radians(w->direction), along[2] = {cos(turn), sin(turn)};
    for (int c = 0; c < 2; c++)
        if (s->boundary.head.present && s->boundary.type[c] == FL_BOUNDARY_PERIODIC && fabs(along[c]) > 1e-9)
            return fl_scene_fail(s, "water.wave", err,
                                 "waves that run along %c do not repeat with a periodic boundary: another "
                                 "boundary or water.direction is expected",
                                 'x' + c);
    return 0;
}

static int water_key_given(const fl_scene_water *w, const char *key)
{
    return w->head.key[fl_key_find(FL_SEC_WATER, key) - fl_key_first(FL_SEC_WATER)].line != 0;
}

/* The default: a number for several trains, none with what evaluates the waves otherwise. */
static void set_default_wave_error(fl_scene *s)
{
    fl_scene_water *w = &s->water;
    const int trains = w->wave == FL_WAVE_JONSWAP && w->components != 1,
              needed = w->spread > 0.0 || w->ice_decay != FL_ICE_DECAY_NONE;
    if (water_key_given(w, "wave_error")) return;
    w->wave_error = needed || (trains && w->every == 1 && s->run.sleep == 0.0) ? DEFAULT_WAVE_ERROR : 0.0;
}

/* Waves by error, directions, decay. */
static int check_wave_error(const fl_scene *s, fl_err *err)
{
    const fl_scene_water *w = &s->water;
    if (!w->head.present || w->wave == FL_WAVE_NONE) return 0;
    if (w->spread > 0.0 && w->wave == FL_WAVE_AIRY)
        return fl_scene_fail(s, "water.spread", err,
                             "a regular wave has one direction: water.wave = jonswap is expected");
    if (w->ice_decay != FL_ICE_DECAY_NONE && !isfinite(w->ice_edge))
        return fl_scene_fail(s, "water.ice_decay", err,
                             "the decay needs the edge of the ice: water.ice_edge is expected");
    if (w->ice_decay != FL_ICE_DECAY_NONE && w->spread > 0.0)
        return fl_scene_fail(s, "water.ice_decay", err,
                             "the decay is along one direction: either water.ice_decay or water.spread is "
                             "expected");
    if ((w->ice_decay == FL_ICE_DECAY_ROGERS || w->ice_decay == FL_ICE_DECAY_MEYLAN) &&
        w->ice_thickness == 0.0)
        return fl_scene_fail(s, "water.ice_decay", err,
                             "the decay needs the thickness of the ice: water.ice_thickness is expected");
    if (w->ice_decay == FL_ICE_DECAY_OWN && !(w->ice_decay_law.x > 0.0))
        return fl_scene_fail(s, "water.ice_decay", err,
                             "the decay has no law: water.ice_decay_law with C above 0 is expected");
    if (w->ice_decay == FL_ICE_DECAY_OWN && w->ice_decay_law.y != 0.0 && w->ice_thickness == 0.0)
        return fl_scene_fail(s, "water.ice_decay", err,
                             "the decay needs the thickness of the ice: water.ice_thickness is expected");
    if (w->wave_error == 0.0 && (w->spread > 0.0 || w->ice_decay != FL_ICE_DECAY_NONE))
        return fl_scene_fail(s, "water.wave_error", err,
                             "with %s the waves are evaluated by error only: a number is expected",
                             w->spread > 0.0 ? "water.spread" : "water.ice_decay");
    if (w->wave_error > 0.0 && w->every > 1)
        return fl_scene_fail(s, "water.every", err,
                             "water.wave_error chooses when the waves are evaluated: either water.every or "
                             "water.wave_error is expected");
    if (w->wave_error > 0.0 && s->run.sleep > 0.0)
        return fl_scene_fail(s, "run.sleep", err,
                             "sleeping floes evaluate the waves when they wake: water.wave_error = none is "
                             "expected");
    for (int c = 0; c < 2; c++)
        if (w->spread > 0.0 && s->boundary.head.present && s->boundary.type[c] == FL_BOUNDARY_PERIODIC)
            return fl_scene_fail(s, "water.spread", err,
                                 "waves of all directions do not repeat with a periodic boundary: another "
                                 "boundary or water.spread = none is expected");
    return 0;
}

static int check_wind(const fl_scene *s, fl_err *err)
{
    if (s->wind.head.present && s->wind.beaufort >= 0.0 && v3_norm(s->wind.velocity) > 0.0)
        return fl_scene_fail(s, "wind.beaufort", err,
                             "the wind is given twice: by wind.velocity and by wind.beaufort");
    return 0;
}

/* Ratios to a property of the body: none is negative, except -1 for auto. */
static int check_ratios(const fl_scene *s, const char *key, fl_vec3 x, fl_err *err)
{
    const double all[] = {x.x, x.y, x.z};
    for (int c = 0; c < 3; c++)
        if (all[c] < 0.0 && all[c] != -1.0)
            return fl_scene_fail(s, key, err, "%s of axis %d is %g, at least 0 or auto is expected", key,
                                 c + 1, all[c]);
    return 0;
}

/* 1 if the key of a section was given. */
static int is_given(const fl_scene_head *h, enum fl_section_id section, const char *key)
{
    return h->key[fl_key_find((int)section, key) - fl_key_first((int)section)].line != 0;
}

static int check_failure(const fl_scene *s, fl_err *err)
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

static int check_bonds(const fl_scene *s, fl_err *err)
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

static int check_statics(const fl_scene *s, fl_err *err)
{
    for (int32_t k = 0; k < s->n_stage; k++)
        if (s->stage[k].start < 0.0 && !s->run.relax)
            return fl_fail(err, FL_INPUT, "[stage %s] begins when the run has settled, and run.relax is none",
                           s->stage[k].name);
    if (s->n_stage && s->boundary.head.present && s->boundary.inflow != FL_INFLOW_NONE)
        return fl_scene_fail(s, "boundary.inflow", err,
                             "stages change a model without inflow: either is expected");
    if (s->n_stage && s->output.checkpoint[0])
        return fl_scene_fail(s, "output.checkpoint", err,
                             "a run with stages is not saved: no checkpoint is expected");
    if (!s->run.relax) return 0;
    if (s->run.sleep > 0.0)
        return fl_scene_fail(s, "run.sleep", err,
                             "run.relax brings bodies to rest: either it or run.sleep is expected");
    if (s->run.error > 0.0)
        return fl_scene_fail(s, "run.error", err,
                             "run.error is for motion in time: either it or run.relax is expected");
    if (s->output.checkpoint[0])
        return fl_scene_fail(s, "output.checkpoint", err,
                             "a run with run.relax is not saved: no checkpoint is expected");
    return 0;
}

static int check_groups(const fl_scene *s, fl_err *err)
{
    for (int32_t i = 0; i < s->n_group; i++) {
        const fl_scene_group *g = &s->group[i];
        const double v[] = {g->velocity.x, g->velocity.y, g->velocity.z};
        char key[2 * FL_SCENE_NAME];
        snprintf(key, sizeof key, "group %s.velocity", g->name);
        for (int c = 0; c < 3; c++)
            if (v[c] != 0.0 && !(g->fixed >> c & 1u))
                return fl_scene_fail(
                    s, key, err,
                    "group.velocity along %c is %g m/s, and %c is not among the fixed directions", 'x' + c,
                    v[c], 'x' + c);
    }
    return 0;
}

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
    if (m->hydrostatic && m->period.z > 0.0)
        return motion_fail(c, "period",
                           "hydrostatic stiffness acts along z as well: a stiffness is expected");
    for (int k = 0; k < 3; k++)
        if (D[k] > 0.0 && !(spring[k] > 0.0 || (k == 2 && m->hydrostatic)))
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
    return 0;
}

static int check_motions(const fl_scene *s, fl_err *err)
{
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

/* A structure of members has no other motion, and no other pieces. */
static int check_members(const fl_scene *s, fl_err *err)
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

/* Each part with a mode gets a section of its own. */
static int check_modes(fl_scene *s, fl_err *err)
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

/* What crushing by speed excludes. */
static int check_crushing_rate(const fl_scene *s, fl_err *err)
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

/* What a track of the drive excludes. */
static int check_drive_track(const fl_scene *s, fl_err *err)
{
    const fl_scene_boundary *b = &s->boundary;
    if (!b->head.present || !b->drive_track[0]) return 0;
    if (v3_nonzero(b->drive))
        return fl_scene_fail(s, "boundary.drive_track", err,
                             "boundary.drive is given as well: one of the two is expected");
    if (b->drive_width > 0.0 && b->drive_edge == 0)
        return fl_scene_fail(s, "boundary.drive_track", err,
                             "a track has no rear: boundary.drive_edge is expected");
    if (s->run.sleep > 0.0)
        return fl_scene_fail(
            s, "boundary.drive_track", err,
            "floes that follow a track do not sleep: either drive_track or run.sleep is expected");
    return 0;
}

int fl_scene_check(fl_scene *s, fl_err *err)
{
    if (add_missing_material(s, "ice", err) || add_missing_material(s, "steel", err)) return -1;
    set_default_intervals(s);
    if (s->run.dt > s->run.duration)
        return fl_scene_fail(s, "run.dt", err, "run.dt is %g s, at most the duration, %g s, is expected",
                             s->run.dt, s->run.duration);
    if (s->run.error > 0.0 && s->run.sleep > 0.0)
        return fl_scene_fail(s, "run.sleep", err,
                             "run.error repeats windows with other steps, in which no floe can sleep: either "
                             "run.error or run.sleep is expected");
    if (s->water.head.present && s->water.every > 1 && s->run.sleep > 0.0)
        return fl_scene_fail(
            s, "water.every", err,
            "sleeping floes (run.sleep) evaluate the water when they wake: water.every = 1 is expected");
    if (s->run.error > 0.0 && s->run.dt > 0.0)
        return fl_scene_fail(s, "run.error", err,
                             "run.error chooses the step and run.dt sets it: only one of them is expected");
    if (fl_scene_check_unused(s, err) || check_inputs(s, err) || check_outputs(s, err) ||
        check_contacts(s, err))
        return -1;
    set_default_wave_error(s);
    return check_boundary(s, err) || check_current(s, err) || check_weight(s, err) || check_waves(s, err) ||
                   check_wave_error(s, err) || check_wind(s, err) || check_bonds(s, err) ||
                   check_failure(s, err) || check_members(s, err) || check_modes(s, err) ||
                   check_crushing_rate(s, err) || check_drive_track(s, err) ||
                   check_ratios(s, "water.added_mass", s->water.added_mass, err) ||
                   check_ratios(s, "water.added_inertia", s->water.added_inertia, err) ||
                   check_groups(s, err) || check_motions(s, err) || check_statics(s, err)
               ? -1
               : 0;
}
